"""The A and G curves of an interpolated web as framed curves, and how far its A curves are from asymptotic."""

import numpy as np
from darboux import ParameterCurve, darboux

from aag_cad.errors import SurfaceError
from aag_cad.geometry.framed import FramedCurve, framed_curve
from aag_cad.geometry.surface import unit_normals
from aag_cad.units import Floats
from aag_cad.web.interpolation import InterpolatedSurface, interpolated_surface
from aag_cad.web.web import Web

_SAMPLES_PER_CELL = 4


def surface_line(surface: InterpolatedSurface, slope: int, intercept: float) -> FramedCurve:
    """Return the line v = intercept + slope u over the whole web, by rising u, with the surface's normals.

    Slope +1 and -1 give A curves, 0 gives a G curve. SurfaceError if it misses the web.
    """
    (low, high), (left, right) = surface.ranges
    if slope:
        ends = sorted(((left - intercept) / slope, (right - intercept) / slope))
        low, high = max(low, ends[0]), min(high, ends[1])
    outside = not slope and not left <= intercept <= right
    if outside or high - low < 1e-6 * surface.step:
        raise SurfaceError(f"web: the line v = {intercept:.4f} {slope:+d} u misses the web; choose another intercept")

    def evaluate(u: Floats) -> tuple[Floats, Floats]:
        jet = surface.jet(u, intercept + slope * u)
        return jet.point, unit_normals(jet)

    rough = evaluate(np.linspace(low, high, 50))[0]
    return framed_curve(evaluate, low, high, float(np.linalg.norm(np.diff(rough, axis=0), axis=1).sum()))


def a_curve_normal_curvature(web: Web) -> float:
    """Return the largest |kappa_n| of both families of A curves on the interpolated surface, 1/mm.

    It is zero on a perfect web. One cell at the border is left out, where nothing holds the spline from outside.
    SurfaceError if nothing is left.
    """
    rows, columns = web.vertices.shape[:2]
    if min(rows, columns) < 5:
        raise SurfaceError(
            f"web: {rows} x {columns} vertices; without the border cells at least 5 x 5 are needed to measure curvature"
        )
    surface = interpolated_surface(web, 1.0)
    u, v = (
        grid.ravel()
        for grid in np.meshgrid(
            *(np.linspace(1.0, n - 2.0, _SAMPLES_PER_CELL * (n - 3) + 1) for n in (rows, columns)), indexing="ij"
        )
    )
    jet = surface.jet(u, v)
    one, zero = np.ones_like(u), np.zeros_like(u)
    return max(
        float(np.abs(darboux(jet, ParameterCurve(u, v, one, sign * one, zero, zero)).normal_curvature).max())
        for sign in (1.0, -1.0)
    )
