"""Geodesics of any surface between two points."""

from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_bvp

from aag_cad.errors import NetworkError
from aag_cad.geometry.surface import Surface, dot
from aag_cad.units import Floats

_TOLERANCE = 1e-10
_MAX_NODES = 20_000


def geodesic_acceleration(surface: Surface, u: Floats, v: Floats, du: Floats, dv: Floats) -> tuple[Floats, Floats]:
    """Return (u'', v'') of the geodesic through (u, v) with velocity (u', v'), each (n,): kappa_g = 0."""
    jet = surface.jet(u, v)
    e, f, g = dot(jet.du, jet.du), dot(jet.du, jet.dv), dot(jet.dv, jet.dv)
    pull = jet.duu * (du**2)[:, None] + 2 * jet.duv * (du * dv)[:, None] + jet.dvv * (dv**2)[:, None]
    a, b = -dot(jet.du, pull), -dot(jet.dv, pull)
    determinant = e * g - f**2
    return (g * a - f * b) / determinant, (e * b - f * a) / determinant


def geodesic_between(surface: Surface, start: Floats, end: Floats) -> Callable[[Floats], tuple[Floats, Floats]]:
    """Return the geodesic between the parameter points start and end, each (2,), as a function t in [0, 1] -> (u, v).

    The two-point problem of the geodesic equation, solved by collocation; NetworkError if it does not converge.
    """

    def slope(_t: Floats, state: Floats) -> Floats:
        u, v, du, dv = state
        return np.array([du, dv, *geodesic_acceleration(surface, u, v, du, dv)])

    def ends(first: Floats, last: Floats) -> Floats:
        return np.concatenate([first[:2] - start, last[:2] - end])

    t = np.linspace(0.0, 1.0, 65)
    straight = start[:, None] + np.multiply.outer(end - start, t)
    guess = np.vstack([straight, np.repeat((end - start)[:, None], len(t), axis=1)])
    found = solve_bvp(slope, ends, t, guess, tol=_TOLERANCE, bc_tol=_TOLERANCE, max_nodes=_MAX_NODES)
    if not found.success:
        raise NetworkError(
            f"no geodesic found from (s, theta) = ({start[0]:.4f}, {start[1]:.4f}) to ({end[0]:.4f}, {end[1]:.4f}): "
            f"{found.message}; move the end of the ridge plank or narrow the sector"
        )

    def path(t: Floats) -> tuple[Floats, Floats]:
        state = np.asarray(found.sol(t))
        return state[0], state[1]

    return path
