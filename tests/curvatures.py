"""Gauss and mean curvature of a surface from its fundamental forms, to test with."""

from dataclasses import dataclass

from aag_cad.geometry.surface import Jet, dot, unit_normals
from aag_cad.units import Floats


@dataclass(frozen=True, eq=False)
class Forms:
    """Coefficients of the first (E, F, G) and second (L, M, N) fundamental form; each (n,) float."""

    E: Floats
    F: Floats
    G: Floats
    L: Floats
    M: Floats
    N: Floats


def fundamental_forms(jet: Jet) -> Forms:
    """Return both fundamental forms at the points of a jet (paper section 1.1)."""
    normal = unit_normals(jet)
    return Forms(
        E=dot(jet.du, jet.du),
        F=dot(jet.du, jet.dv),
        G=dot(jet.dv, jet.dv),
        L=dot(jet.duu, normal),
        M=dot(jet.duv, normal),
        N=dot(jet.dvv, normal),
    )


def gauss_curvature(forms: Forms) -> Floats:
    """Return K = (LN - M^2) / (EG - F^2), (n,) 1/mm2; asymptotic curves exist where it is negative."""
    return (forms.L * forms.N - forms.M**2) / (forms.E * forms.G - forms.F**2)


def mean_curvature(forms: Forms) -> Floats:
    """Return H = (EN - 2FM + GL) / 2(EG - F^2), (n,) 1/mm."""
    return (forms.E * forms.N - 2 * forms.F * forms.M + forms.G * forms.L) / (2 * (forms.E * forms.G - forms.F**2))
