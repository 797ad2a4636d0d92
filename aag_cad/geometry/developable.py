"""Developable surfaces through two curves: which points a straight ruling joins."""

import numpy as np

from aag_cad.errors import SurfaceError
from aag_cad.geometry.framed import FramedCurve, nearest_station
from aag_cad.geometry.surface import dot, unit
from aag_cad.units import Floats

_STEPS = 30
_CONVERGED = 1e-9
_FLAT = 1e-9
_MIN_SAMPLES = 13


def _tangents(curve: FramedCurve, stations: Floats) -> tuple[Floats, Floats, Floats]:
    """Return points, unit tangents and the derivatives of the tangents by the station, each (n, 3)."""
    first, second = curve.point_spline(stations, nu=1), curve.point_spline(stations, nu=2)
    speed = np.linalg.norm(first, axis=1)[:, None]
    tangent = first / speed
    turning = second / speed - dot(second, tangent)[:, None] * tangent / speed
    return curve.point_spline(stations), tangent, turning


def ruling_stations(left: FramedCurve, right: FramedCurve, stations: Floats) -> Floats:
    """Return the stations (n,) on ``right`` that straight rulings join with those on ``left``, (n,).

    A ruled surface is developable where both tangents and the ruling lie in one plane: det(T_L, T_R, P_R - P_L) = 0,
    solved by Newton's method from the nearest point. SurfaceError if the surface is a plane there or has no ruling, or
    if rulings cross.
    """
    start, tangent, _ = _tangents(left, stations)
    found = nearest_station(right, start)
    step = np.zeros_like(found)
    for _ in range(_STEPS):
        point, other, turning = _tangents(right, found)
        ruling = unit(point - start)
        across = np.cross(ruling, tangent)
        slope = dot(turning, across)
        if np.any(np.abs(slope) < _FLAT):
            raise SurfaceError(
                "surface: two neighbouring geodesics are straight side by side, so that the sheet between them has no "
                "one direction of bending; let the surface bend along them, or set facade.cover = false"
            )
        step = dot(other, across) / slope
        found = found - step
        if np.all(np.abs(step) < _CONVERGED):
            break
    crossing = np.any(np.diff(found) * np.diff(stations) <= 0.0)
    if crossing or np.any(np.abs(step) > 1e3 * _CONVERGED):
        raise SurfaceError(
            "surface: no developable sheet spans two neighbouring geodesics, its rulings cross or run off; choose more "
            "pattern.geodesics or set facade.cover = false"
        )
    return found


def shared_range(left: FramedCurve, right: FramedCurve) -> tuple[float, float]:
    """Return the stations of ``left`` between which every ruling ends on ``right``; SurfaceError if there are none."""
    ends = ruling_stations(right, left, right.stations[[0, -1]])
    low, high = max(0.0, float(ends[0])), min(left.length, float(ends[1]))
    if low >= high:
        raise SurfaceError("surface: no straight ruling joins two neighbouring geodesics; set facade.cover = false")
    return low, high


def ruled_edges(
    left: FramedCurve, right: FramedCurve, low: float, high: float, spacing: float
) -> tuple[FramedCurve, FramedCurve]:
    """Return both curves sampled at the ends of shared rulings, with the normals of the sheet between them.

    The samples stand at equal arc lengths, about ``spacing`` mm, between the stations ``low`` and ``high`` of ``left``.
    The normal of a developable surface is the same all along a ruling; it turns to the side of the left curve's.
    """
    ours = np.linspace(low, high, max(_MIN_SAMPLES, int(np.ceil((high - low) / spacing)) + 1))
    theirs = ruling_stations(left, right, ours)
    start, tangent, _ = _tangents(left, ours)
    end, other, _ = _tangents(right, theirs)
    ruling = end - start
    normals = unit(unit(np.cross(tangent, ruling)) + unit(np.cross(other, ruling)))
    normals = normals * np.sign(dot(normals, left.normal_spline(ours)))[:, None]
    return FramedCurve(ours - ours[0], start, normals), FramedCurve(theirs - theirs[0], end, normals)
