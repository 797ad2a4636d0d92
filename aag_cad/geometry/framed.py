"""Curves in space that carry a surface normal, as quintic splines by arc length."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline
from scipy.spatial import cKDTree

from aag_cad.geometry.surface import dot, unit
from aag_cad.units import Floats

SAMPLE_SPACING = 150.0
_MIN_SAMPLES = 13
_FINE_PER_SAMPLE = 8


@dataclass(frozen=True, eq=False)
class FramedCurve:
    """A curve sampled by arc length: stations (n,) from 0, points (n, 3), unit surface normals (n, 3); mm."""

    stations: Floats
    points: Floats
    normals: Floats

    def __repr__(self) -> str:
        """Return length and number of samples."""
        return f"FramedCurve of {self.length:.1f} mm, {len(self.stations)} samples"

    @property
    def length(self) -> float:
        """Arc length in mm."""
        return float(self.stations[-1])

    @cached_property
    def point_spline(self) -> BSpline:
        """The quintic interpolating spline of the points by arc length."""
        return make_interp_spline(self.stations, self.points, k=5)

    @cached_property
    def normal_spline(self) -> BSpline:
        """The quintic interpolating spline of the normals by arc length."""
        return make_interp_spline(self.stations, self.normals, k=5)

    def __eq__(self, other: object) -> bool:
        """Return whether all samples are equal bit for bit."""
        return isinstance(other, FramedCurve) and all(
            np.array_equal(a, b)
            for a, b in (
                (self.stations, other.stations),
                (self.points, other.points),
                (self.normals, other.normals),
            )
        )

    def __hash__(self) -> int:
        """Return a hash by length and ends, so that functions of curves can remember what they gave."""
        return hash((len(self.stations), self.length, *self.points[0].tolist(), *self.points[-1].tolist()))


@dataclass(frozen=True, eq=False)
class Frames:
    """Points and right-handed frames (tangent, binormal = normal x tangent, normal); each (n, 3) float, or (3,)."""

    point: Floats
    tangent: Floats
    binormal: Floats
    normal: Floats


@dataclass(frozen=True, eq=False)
class Curvatures:
    """Normal curvature, geodesic curvature and geodesic torsion; each (n,) 1/mm."""

    normal: Floats
    geodesic: Floats
    torsion: Floats


def frames_at(curve: FramedCurve, stations: Floats) -> Frames:
    """Return points and Darboux frames of a curve at stations (n,)."""
    tangent = unit(curve.point_spline(stations, nu=1))
    raw = curve.normal_spline(stations)
    normal = unit(raw - dot(raw, tangent)[:, None] * tangent)
    return Frames(curve.point_spline(stations), tangent, np.cross(normal, tangent), normal)


def frame_at(curve: FramedCurve, station: float) -> Frames:
    """Return point and Darboux frame of a curve at one station; each (3,)."""
    frames = frames_at(curve, np.array([station]))
    return Frames(frames.point[0], frames.tangent[0], frames.binormal[0], frames.normal[0])


def curvatures_at(curve: FramedCurve, stations: Floats) -> Curvatures:
    """Return kappa_n, kappa_g and tau_g = -n'.b of a curve at stations (n,), from its splines."""
    frames = frames_at(curve, stations)
    speed = np.linalg.norm(curve.point_spline(stations, nu=1), axis=1)
    second = curve.point_spline(stations, nu=2) / (speed**2)[:, None]
    turning = curve.normal_spline(stations, nu=1) / speed[:, None]
    return Curvatures(
        normal=dot(second, frames.normal),
        geodesic=dot(second, frames.binormal),
        torsion=-dot(turning, frames.binormal),
    )


def framed_curve(
    evaluate: Callable[[Floats], tuple[Floats, Floats]], start: float, end: float, rough_length: float
) -> FramedCurve:
    """Return the curve t -> (points, normals) over [start, end] resampled at equal arc lengths.

    ``rough_length`` (mm) sets the number of samples: about one every 150 mm, at least 13.
    """
    count = max(_MIN_SAMPLES, math.ceil(rough_length / SAMPLE_SPACING) + 1)
    fine = np.linspace(start, end, _FINE_PER_SAMPLE * (count - 1) + 1)
    spline = make_interp_spline(fine, evaluate(fine)[0], k=5)
    nodes, weights = np.polynomial.legendre.leggauss(6)
    half = np.diff(fine) / 2.0
    inner = fine[:-1, None] + half[:, None] * (nodes + 1.0)
    speed = np.linalg.norm(spline(inner.ravel(), nu=1), axis=1).reshape(inner.shape)
    arc = np.concatenate([[0.0], np.cumsum(half * (speed @ weights))])
    arc_of = make_interp_spline(fine, arc, k=5)
    stations = np.linspace(0.0, float(arc[-1]), count)
    t = np.interp(stations, arc, fine)
    for _ in range(6):
        t = t - (arc_of(t) - stations) / arc_of(t, nu=1)
    t[0], t[-1] = start, end
    points, normals = evaluate(t)
    tangent = unit(spline(t, nu=1))
    normals = unit(normals - dot(normals, tangent)[:, None] * tangent)
    return FramedCurve(stations, points, normals)


def offset_curve(
    curve: FramedCurve, along_normal: float, along_binormal: float, start: float, end: float
) -> FramedCurve:
    """Return c + h n + e b over the stations [start, end] of c, by its own arc length and with its own frame.

    The own frame keeps the surface normal as far as it can stand at a right angle to the offset curve: so a plank
    on it is a straight plank that was only bent and twisted.
    """

    def evaluate(stations: Floats) -> tuple[Floats, Floats]:
        frames = frames_at(curve, stations)
        return frames.point + along_normal * frames.normal + along_binormal * frames.binormal, frames.normal

    return framed_curve(evaluate, start, end, end - start)


def nearest_station(curve: FramedCurve, points: Floats, guess: Floats | None = None) -> Floats:
    """Return the stations (n,) whose normal planes hold the points (n, 3).

    By Newton's method from a guess (n,), without one from the samples that are nearest to the points.
    """
    stations = curve.stations[cKDTree(curve.points).query(points)[1]] if guess is None else guess.astype(float)
    for _ in range(20):
        gap = curve.point_spline(stations) - points
        first, second = curve.point_spline(stations, nu=1), curve.point_spline(stations, nu=2)
        step = dot(gap, first) / (dot(first, first) + dot(gap, second))
        stations = stations - step
        if np.all(np.abs(step) < 1e-10):
            break
    return stations
