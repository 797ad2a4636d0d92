"""Gauss and mean curvature of a surface from its fundamental forms, to test with."""

from aag_cad.geometry.surface import Forms
from aag_cad.units import Floats


def gauss_curvature(forms: Forms) -> Floats:
    """Return K = (LN - M^2) / (EG - F^2), (n,) 1/mm2; asymptotic curves exist where it is negative."""
    return (forms.L * forms.N - forms.M**2) / (forms.E * forms.G - forms.F**2)


def mean_curvature(forms: Forms) -> Floats:
    """Return H = (EN - 2FM + GL) / 2(EG - F^2), (n,) 1/mm."""
    return (forms.E * forms.N - 2 * forms.F * forms.M + forms.G * forms.L) / (2 * (forms.E * forms.G - forms.F**2))
