"""The best way to load a body into a box: extents and axes of the pose that leaves most room."""

import math
from functools import cache

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from aag_cad.units import Floats, Vector, vector
from assembly.base.segments import Pose

_TILTS = 400
_TURNS = 18
_STARTS = 3
_FIRST_STEP, _LAST_STEP = math.radians(4.0), math.radians(0.02)
_GOLDEN = math.pi * (3.0 - math.sqrt(5.0))


def hull_points(points: Floats) -> Floats:
    """Return the corners (k, 3) or (k, 2) of the convex hull of points; all of them if they lie in a plane or line."""
    try:
        return np.asarray(points[ConvexHull(points).vertices])
    except QhullError:
        return points


def turned_rectangle(points: Floats, length: float, width: float) -> tuple[float, float]:
    """Return (filling, angle) of the rectangle length x width that a set of points (n, 2) fills least; exact.

    Between two angles at which a side lies on an edge of the hull, both extents are arcs of sinusoids and so concave:
    the least of the greater of the two is where a side lies on an edge, or where both are equally filled.
    """
    polygon = hull_points(points)
    edges = np.roll(polygon, -1, axis=0) - polygon
    angles = np.unique(np.concatenate([np.arctan2(edges[:, 1], edges[:, 0]) % (math.pi / 2.0), [0.0, math.pi / 2.0]]))
    middles = (angles[1:] + angles[:-1]) / 2.0
    along = np.column_stack([np.cos(middles), np.sin(middles)])
    across = np.column_stack([-np.sin(middles), np.cos(middles)])
    first, second = (
        polygon[np.argmax(heights, axis=0)] - polygon[np.argmin(heights, axis=0)]
        for heights in (polygon @ along.T, polygon @ across.T)
    )
    best = (math.inf, 0.0)
    for turn, (a, b) in ((0.0, (first / length, second / width)), (math.pi / 2.0, (first / width, second / length))):
        equal = np.arctan2(b[:, 1] - a[:, 0], a[:, 1] + b[:, 0])
        inside = np.clip((equal + math.pi / 2.0) % math.pi - math.pi / 2.0, angles[:-1], angles[1:])
        for tried in (angles[:-1], inside, angles[1:]):
            c, s = np.cos(tried), np.sin(tried)
            filled = np.maximum(a[:, 0] * c + a[:, 1] * s, b[:, 1] * c - b[:, 0] * s)
            i = int(np.argmin(filled))
            # Turned by a right angle the second axis is the one that takes the length.
            best = min(best, (float(filled[i]), float(tried[i]) + turn))
    return best


def _cross(a: Floats, b: Floats) -> Floats:
    """Return the cross product of two vectors (3,); numpy's own is written for arrays of them and ten times slower."""
    (x, y, z), (u, v, w) = a.tolist(), b.tolist()
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u])


def _plan_axes(up: Floats) -> tuple[Floats, Floats]:
    """Return two unit axes (3,) across an upward axis."""
    first = _cross(up, np.eye(3)[int(np.argmin(np.abs(up)))])
    first /= math.sqrt(float(first @ first))
    return first, _cross(up, first)


@cache
def _even_tilts() -> tuple[Floats, Floats]:
    """Return upward axes (n, 3) spread evenly over the hemisphere, and two axes (n, 2, 3) across each."""
    i = np.arange(_TILTS) + 0.5
    z, turn = i / _TILTS, _GOLDEN * i
    flat = np.sqrt(1.0 - z**2)
    ups = np.column_stack([flat * np.cos(turn), flat * np.sin(turn), z])
    return ups, np.array([_plan_axes(up) for up in ups])


def _tilted(points: Floats, up: Floats, room: Floats) -> Pose:
    """Return the best pose with a given upward axis: exact in the turn about it."""
    x, y = _plan_axes(up)
    plan = np.column_stack([points @ x, points @ y])
    height = float(np.ptp(points @ up))
    filling, angle = turned_rectangle(plan, float(room[0]), float(room[1]))
    along = math.cos(angle) * x + math.sin(angle) * y
    across = _cross(up, along)
    size = (float(np.ptp(points @ along)), float(np.ptp(points @ across)), height)
    return Pose((vector(along), vector(across), vector(up)), size, max(filling, height / float(room[2])))


def _starts(points: Floats, room: Floats) -> Floats:
    """Return the most promising upward axes (k, 3) of an even set over the hemisphere, and the body's own axes."""
    even, even_frames = _even_tilts()
    own = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)[2]
    ups = np.concatenate([own, even])
    frames = np.concatenate([[_plan_axes(up) for up in own], even_frames])
    phi = np.arange(_TURNS) * math.pi / _TURNS
    along = np.cos(phi)[:, None] * frames[:, None, 0] + np.sin(phi)[:, None] * frames[:, None, 1]
    widths = np.ptp(points @ along.reshape(-1, 3).T, axis=0).reshape(len(ups), _TURNS)
    across = np.roll(widths, -_TURNS // 2, axis=1)
    plan = np.maximum(widths / room[0], across / room[1]).min(axis=1)
    filling = np.maximum(plan, np.ptp(points @ ups.T, axis=0) / room[2])
    return np.asarray(ups[np.argsort(filling, kind="stable")[:_STARTS]])


def best_pose(points: Floats, room: Vector, enough: float = 0.0) -> Pose:
    """Return the pose in which a body of points (n, 3) fills a box of length x width x height least.

    Any side may be up. For one upward axis the turn about it is exact (``turned_rectangle``); the axis itself comes
    from an even set over the hemisphere, refined to 0.02 degrees. So a pose that fits does fit, and another that fits
    may in rare cases be missed. The search ends at the first pose with a filling of at most ``enough``.
    """
    corners, limits = hull_points(points), np.array(room)
    best: Pose | None = None
    for start in _starts(corners, limits):
        pose, step = _tilted(corners, start, limits), _FIRST_STEP
        while step > _LAST_STEP and pose.filling > enough:
            up, (x, y) = np.array(pose.axes[2]), _plan_axes(np.array(pose.axes[2]))
            around = [math.cos(k * math.pi / 4) * x + math.sin(k * math.pi / 4) * y for k in range(8)]
            ways = [math.cos(step) * up + math.sin(step) * way for way in around]
            nearer = min((_tilted(corners, way, limits) for way in ways), key=lambda p: p.filling)
            if nearer.filling < pose.filling - 1e-9:
                pose = nearer
            else:
                step /= 2.0
        if best is None or pose.filling < best.filling:
            best = pose
        if best.filling <= enough:
            break
    assert best is not None
    return best
