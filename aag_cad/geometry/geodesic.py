"""Geodesics of any surface: the initial-value and the two-point problem."""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root

from aag_cad.errors import NetworkError
from aag_cad.geometry.surface import Surface, dot, fundamental_forms
from aag_cad.units import Floats

_TOLERANCE = 1e-11


def geodesic_acceleration(surface: Surface, u: Floats, v: Floats, du: Floats, dv: Floats) -> tuple[Floats, Floats]:
    """Return (u'', v'') of the geodesic through (u, v) with direction (u', v'), each (n,): kappa_g = 0, |c'| constant."""
    jet = surface.jet(u, v)
    forms = fundamental_forms(jet)
    pull = jet.duu * (du**2)[:, None] + 2 * jet.duv * (du * dv)[:, None] + jet.dvv * (dv**2)[:, None]
    a, b = -dot(jet.du, pull), -dot(jet.dv, pull)
    determinant = forms.E * forms.G - forms.F**2
    return (forms.G * a - forms.F * b) / determinant, (forms.E * b - forms.F * a) / determinant


@dataclass(frozen=True, eq=False)
class GeodesicPath:
    """A geodesic in the parameter plane over t in [0, 1]: ``parameters(t)`` gives u and v, each (n,)."""

    start: Floats
    direction: Floats
    solution: object

    def parameters(self, t: Floats) -> tuple[Floats, Floats]:
        """Return u and v at the times t (n,); t a little outside [0, 1] continues the geodesic."""
        state = np.asarray(self.solution(t))  # type: ignore[operator]
        return state[0], state[1]


def shoot(surface: Surface, start: Floats, direction: Floats, before: float = 0.0, after: float = 0.0) -> GeodesicPath:
    """Return the geodesic from start (2,) with velocity direction (2,) over t in [-before, 1 + after].

    The geodesic equation is integrated by DOP853 at a relative tolerance of 1e-11.
    """

    def slope(_t: float, state: Floats) -> Floats:
        u, v, du, dv = (state[i : i + 1] for i in range(4))
        ddu, ddv = geodesic_acceleration(surface, u, v, du, dv)
        return np.concatenate([du, dv, ddu, ddv])

    def run(end: float) -> object:
        state = np.concatenate([start, direction])
        return solve_ivp(
            slope, (0.0, end), state, method="DOP853", rtol=_TOLERANCE, atol=_TOLERANCE, dense_output=True
        ).sol

    forward, backward = run(1.0 + after), run(-before) if before else None

    def solution(t: Floats) -> Floats:
        ahead = np.asarray(forward(np.maximum(t, 0.0)))  # type: ignore[operator]
        if backward is None:
            return ahead
        behind = np.asarray(backward(np.minimum(t, 0.0)))  # type: ignore[operator]
        return np.where(t < 0.0, behind, ahead)

    return GeodesicPath(start, direction, solution)


def geodesic_between(
    surface: Surface, start: Floats, end: Floats, before: float = 0.0, after: float = 0.0
) -> GeodesicPath:
    """Return the geodesic between the parameter points start and end, each (2,), reached at t = 0 and t = 1.

    ``before`` and ``after`` lengthen it past its ends by these fractions; NetworkError if the shooting fails.
    """

    def miss(direction: Floats) -> Floats:
        u, v = shoot(surface, start, direction).parameters(np.array([1.0]))
        return np.array([u[0] - end[0], v[0] - end[1]])

    found = root(miss, end - start, method="hybr", tol=1e-12)
    if not np.all(np.abs(miss(found.x)) < 1e-9):
        raise NetworkError(
            f"no geodesic found from (s, theta) = ({start[0]:.4f}, {start[1]:.4f}) to ({end[0]:.4f}, {end[1]:.4f}); "
            "move the ridge end or narrow the sector"
        )
    return shoot(surface, start, np.asarray(found.x), before, after)
