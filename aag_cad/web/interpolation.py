"""The smooth surface through a web: a tensor-product B-spline over the grid, with its A and G curves."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import NdBSpline, make_interp_spline

from aag_cad.errors import SurfaceError
from aag_cad.geometry.surface import Jet
from aag_cad.units import Floats
from aag_cad.web.web import Web


@dataclass(frozen=True, eq=False)
class InterpolatedSurface:
    """A C2 surface X(u, v) through the vertices of a web: vertex (i, j) is X(u0 + i step, v0 + j step).

    Its A lines are v = c +- u, its G lines v = const, as in the charts of surfaces of revolution. ``knots`` and
    ``degrees`` are those of u - u0 and v - v0, ``origin`` is (u0, v0); ``control`` (rows, columns, 3) are the control
    points, mm.
    """

    step: float
    degrees: tuple[int, int]
    knots: tuple[Floats, Floats]
    control: Floats
    origin: tuple[float, float]

    @property
    def ranges(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The ranges of u and v."""
        (u, v), (u0, v0) = self.knots, self.origin
        return (float(u[0]) + u0, float(u[-1]) + u0), (float(v[0]) + v0, float(v[-1]) + v0)

    @property
    def domain(self) -> tuple[float, float]:
        """The range of u."""
        return self.ranges[0]

    def jet(self, u: Floats, v: Floats) -> Jet:
        """Return the 2-jet at the parameters u, v, each (n,) float; SurfaceError outside the web."""
        places = []
        for name, given, knots, origin in zip("uv", (u, v), self.knots, self.origin, strict=True):
            values, low, high = given - origin, float(knots[0]), float(knots[-1])
            # A hair's breadth outside is rounding, not a point outside the web.
            slack = 1e-9 * (high - low)
            wrong = ~((values >= low - slack) & (values <= high + slack))
            if np.any(wrong):
                raise SurfaceError(
                    f"web: the point {name} = {float(given[wrong][0]):.4f} lies outside the web, which covers {name} "
                    f"from {low + origin:.4f} to {high + origin:.4f}; add rows or columns to the web"
                )
            places.append(np.clip(values, low, high))
        spline = NdBSpline(self.knots, self.control, self.degrees)
        at = np.column_stack(places)
        orders = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
        return Jet(*(np.asarray(spline(at, nu=order), dtype=np.float64) for order in orders))


def interpolated_surface(web: Web, step: float, origin: tuple[float, float] = (0.0, 0.0)) -> InterpolatedSurface:
    """Return the B-spline surface through all vertices of a web, quintic where the web has six rows and columns.

    ``step`` is the parameter length of a cell, equal in both directions, so that the diagonals of the grid are
    v = c +- u; ``origin`` are the parameters of vertex (0, 0). A web of n < 6 rows is one polynomial piece of degree
    n - 1 in that direction.
    """
    if not (math.isfinite(step) and step > 0.0):
        raise SurfaceError(f"web: the step {step!r} of the interpolation must be positive")
    rows, columns = web.vertices.shape[:2]
    if min(rows, columns) < 3:
        raise SurfaceError(f"web: {rows} x {columns} vertices; a surface needs at least 3 x 3: refine the web")
    degrees = min(5, rows - 1), min(5, columns - 1)
    by_u = make_interp_spline(step * np.arange(rows), web.vertices, k=degrees[0], axis=0)
    by_v = make_interp_spline(step * np.arange(columns), by_u.c, k=degrees[1], axis=1)
    # SciPy keeps the axis of interpolation first among the coefficients.
    control = np.moveaxis(by_v.c, 0, 1)
    return InterpolatedSurface(step, degrees, (by_u.t, by_v.t), np.ascontiguousarray(control), origin)
