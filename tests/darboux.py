"""Curves on surfaces, to test with: Darboux frame, normal and geodesic curvature, geodesic torsion (paper, 1.1)."""

from dataclasses import dataclass

import numpy as np
from curvatures import fundamental_forms

from aag_cad.geometry.surface import Jet, dot, unit_normals
from aag_cad.units import Floats


@dataclass(frozen=True, eq=False)
class ParameterCurve:
    """A curve in the parameter plane: u, v and their first and second derivatives by one parameter; each (n,) float."""

    u: Floats
    v: Floats
    du: Floats
    dv: Floats
    ddu: Floats
    ddv: Floats


@dataclass(frozen=True, eq=False)
class Darboux:
    """Darboux frame (t, b = n x t, n), each (n, 3), with speed |c'| and the three curvatures, each (n,) 1/mm."""

    tangent: Floats
    binormal: Floats
    normal: Floats
    speed: Floats
    normal_curvature: Floats
    geodesic_curvature: Floats
    geodesic_torsion: Floats


def darboux(jet: Jet, curve: ParameterCurve) -> Darboux:
    """Return frame and curvatures of a curve on a surface from the surface's 2-jet along it.

    kappa_n and kappa_g are the projections of the curvature vector on the normal and on b = n x t, so that
    kappa^2 = kappa_n^2 + kappa_g^2 (paper section 1.1); tau_g = -n'.b is the twist of a plank that follows the curve.
    """
    first = jet.du * curve.du[:, None] + jet.dv * curve.dv[:, None]
    second = (
        jet.duu * (curve.du**2)[:, None]
        + 2 * jet.duv * (curve.du * curve.dv)[:, None]
        + jet.dvv * (curve.dv**2)[:, None]
        + jet.du * curve.ddu[:, None]
        + jet.dv * curve.ddv[:, None]
    )
    normal = unit_normals(jet)
    speed = np.linalg.norm(first, axis=1)
    tangent = first / speed[:, None]
    binormal = np.cross(normal, tangent)
    forms = fundamental_forms(jet)
    a, b = curve.du / speed, curve.dv / speed
    torsion = (
        (forms.F * forms.L - forms.E * forms.M) * a**2
        + (forms.G * forms.L - forms.E * forms.N) * a * b
        + (forms.G * forms.M - forms.F * forms.N) * b**2
    ) / np.sqrt(forms.E * forms.G - forms.F**2)
    return Darboux(
        tangent=tangent,
        binormal=binormal,
        normal=normal,
        speed=speed,
        normal_curvature=dot(second, normal) / speed**2,
        geodesic_curvature=dot(second, binormal) / speed**2,
        geodesic_torsion=-torsion,
    )
