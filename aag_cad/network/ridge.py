"""The ridge planes between neighbouring shells, and the geodesics that follow them at a set-back."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline
from scipy.optimize import brentq

from aag_cad.errors import NetworkError
from aag_cad.geometry.geodesic import geodesic_between
from aag_cad.geometry.surface import Chart, Surface
from aag_cad.units import Floats

_SETBACK_TOLERANCE = 0.05


def ridge_distance(points: Floats, shells: int) -> Floats:
    """Return the distance of points (n, 3) from the nearer ridge plane, mm, (n,); positive inside the shell.

    The shell looks from its axis along +x to the centre; its ridge planes are vertical through the centre, at
    +-180/shells degrees from the direction -x. A single shell has none: the distance is infinite.
    """
    if shells == 1:
        return np.full(len(points), np.inf)
    half = math.pi / shells
    return -math.sin(half) * points[:, 0] - math.cos(half) * np.abs(points[:, 1])


def surface_points(chart: Surface, s: Floats, theta: Floats) -> Floats:
    """Return points (n, 3) of a chart."""
    return chart.jet(s, theta).point


def ridge_coordinate(chart: Chart, theta: float, shells: int, distance: float) -> float:
    """Return s where the meridian theta comes within ``distance`` mm of the ridge plane; NetworkError if never."""
    low, high = 0.0, chart.domain[1]

    def gap(s: float) -> float:
        point = surface_points(chart, np.array([s]), np.array([theta]))
        return float(ridge_distance(point, shells)[0]) - distance

    if -distance < gap(low) <= 0.0:
        raise NetworkError(
            f"boundary.ridge_setback: {distance:.0f} mm from the ridge plane lie under the ground line at "
            f"{math.degrees(theta):.1f} degrees; reduce it"
        )
    if gap(low) <= 0.0:
        raise NetworkError(
            f"shells.axis_distance: the neck of the shell already crosses the ridge plane at {math.degrees(theta):.1f} "
            "degrees; enlarge axis_distance or narrow sector_deg"
        )
    if gap(high) >= 0.0:
        raise NetworkError(
            f"shells.axis_distance: the surface ends before it reaches the ridge plane at {math.degrees(theta):.1f} "
            "degrees; reduce axis_distance or lengthen the meridian"
        )
    return float(brentq(gap, low, high, xtol=1e-13))


@dataclass(frozen=True, eq=False)
class RidgeLine:
    """The right ridge geodesic (theta >= 0), from past the side to the crown: t in [0, 1] -> (s, theta).

    ``height`` gives s by |theta|; the left ridge is its mirror image.
    """

    path: Callable[[Floats], tuple[Floats, Floats]]
    height: BSpline


def ridge_line(chart: Chart, shells: int, side: float, setback: float) -> RidgeLine:
    """Return the geodesic from theta = side to the crown (theta = 0) that keeps ``setback`` mm to the ridge plane.

    Both ends keep the same distance; the geodesic between them bends towards the plane, so they start further away.
    """
    t = np.linspace(0.0, 1.0, 201)
    distance = setback
    for _ in range(10):
        path = geodesic_between(
            chart,
            np.array([ridge_coordinate(chart, side, shells, distance), side]),
            np.array([ridge_coordinate(chart, 0.0, shells, distance), 0.0]),
        )
        s, theta = path(t)
        nearest = float(ridge_distance(surface_points(chart, s, theta), shells).min())
        if abs(nearest - setback) < _SETBACK_TOLERANCE:
            return RidgeLine(path, make_interp_spline(theta[::-1], s[::-1], k=5))
        distance += setback - nearest
    raise NetworkError(
        f"boundary.ridge_setback: no geodesic keeps {setback:g} mm from the ridge plane; "
        "narrow sector_deg or enlarge ridge_setback"
    )
