"""Sheets bent along straight rulings: the formed sheet, its flat pattern, its mesh, and how deep points lie in it."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from aag_cad.geometry.surface import dot, unit
from aag_cad.parts.model import Strip
from aag_cad.parts.shapes.shape import Shape
from aag_cad.parts.triangles import Mesh, polygon_area, tube
from aag_cad.units import Floats

OUTLINE_SPACING = 25.0
MESH_SPACING = 60.0
_FACE_SPACING, _EDGE_SPACING = 30.0, 12.0
_DEGREE = 5
_FINE_PER_SAMPLE = 8
_ON_CUT = 1e-6
_NARROW = 1e-6
_SEARCH = 129
_ALONG_CUT = 33
_NEWTON_STEPS = 12
_STILL = 1e-8
# Strips alike in all shells are unrolled once; a vault has a dozen or two, every list asks for their sizes.
_REMEMBERED = 128

# How far points (n, 3) lie inside a limit, mm, (n,).
Limit: TypeAlias = Callable[[Floats], Floats]


@dataclass(frozen=True, eq=False)
class Sheet:
    """A strip as functions of the ruling's parameter u: 0 the first, 1 the last; v goes from left (0) to right (1).

    ``edges`` gives the ends of the ruling at mid-thickness, (2, 3); ``normal`` the sheet's normal, not yet of length 1;
    ``flat`` the ends in the flat pattern, (2, 2). ``lower`` and ``upper`` are the corners of the cuts in the flat
    pattern, (k, 2), from left to right.
    """

    thickness: float
    edges: BSpline
    normal: BSpline
    flat: BSpline
    lower: Floats
    upper: Floats

    def formed(self, u: Floats, v: Floats, height: Floats | float) -> Floats:
        """Return points (n, 3) of the formed sheet at rulings u, fractions v and heights over mid-thickness, (n,)."""
        ends, normal = np.asarray(self.edges(u)), unit(np.asarray(self.normal(u)))
        middle = ends[:, 0] + v[:, None] * (ends[:, 1] - ends[:, 0])
        return np.asarray(middle + np.broadcast_to(height, u.shape)[:, None] * normal)

    def flattened(self, u: Floats, v: Floats) -> Floats:
        """Return points (n, 2) of the flat pattern at rulings u and fractions v, (n,)."""
        ends = np.asarray(self.flat(u))
        return np.asarray(ends[:, 0] + v[:, None] * (ends[:, 1] - ends[:, 0]))


@dataclass(frozen=True, eq=False)
class FlatPattern:
    """The sheet as it is cut: x along the ribs from the lower end, y to the right edge, seen from outside; mm, mm2.

    ``outline`` (n, 2) runs counter-clockwise without repeating its first point: ``left`` edge upwards, ``upper`` cut,
    ``right`` edge downwards, ``lower`` cut; those four run upwards or from left to right. A sagitta is the largest
    distance of an edge from its chord, positive where the edge is concave.
    """

    outline: Floats
    left: Floats
    right: Floats
    lower: Floats
    upper: Floats
    length: float
    width: float
    left_length: float
    right_length: float
    left_sagitta: float
    right_sagitta: float
    area: float


def _unrolled(edges: BSpline, normal: BSpline, u: Floats) -> BSpline:
    """Return the flat ends (2, 2) of the rulings as a spline, from the geodesic curvature of the left edge.

    The right edge follows from length and angle of each ruling; that it keeps its own length proves the sheet
    developable.
    """
    ends, first, second = (np.asarray(edges(u, nu=order)) for order in (0, 1, 2))
    across = ends[:, 1] - ends[:, 0]
    speed = np.linalg.norm(first[:, 0], axis=1)
    tangent, up = unit(first[:, 0]), unit(np.asarray(normal(u)))
    side = np.cross(up, tangent)
    turning = make_interp_spline(u, dot(second[:, 0], side) / speed, k=_DEGREE).antiderivative()(u)
    along = np.column_stack([np.cos(turning), np.sin(turning)])
    beside = np.column_stack([-np.sin(turning), np.cos(turning)])
    start = make_interp_spline(u, speed[:, None] * along, k=_DEGREE).antiderivative()(u)
    end = start + dot(across, tangent)[:, None] * along + dot(across, side)[:, None] * beside
    return make_interp_spline(u, np.stack([start, end], axis=1), k=_DEGREE)


def _corners(flat: BSpline, cut: tuple[float, ...]) -> Floats:
    ends, v = np.asarray(flat(np.array(cut))), np.linspace(0.0, 1.0, len(cut))[:, None]
    return np.asarray(ends[:, 0] + v * (ends[:, 1] - ends[:, 0]))


def _aligned(flat: BSpline, strip: Strip) -> BSpline:
    """Return the flat pattern turned and moved so that its middle line runs along x and its lowest corner has x = 0."""
    middle = np.asarray(flat(np.array([max(strip.lower), min(strip.upper)]))).mean(axis=1)
    along = unit(middle[1] - middle[0])
    turn = np.array([along, [-along[1], along[0]]])
    corner = _corners(flat, strip.lower) @ turn.T
    origin = np.array([corner[:, 0].min(), (turn @ middle[0])[1]])
    return BSpline(flat.t, flat.c @ turn.T - origin, flat.k)


def sheet_of(strip: Strip) -> Sheet:
    """Return a strip as functions of the ruling's parameter and the fraction along the ruling."""
    return _sheet(replace(strip, mark=""))


@lru_cache(maxsize=_REMEMBERED)
def _sheet(strip: Strip) -> Sheet:
    count = len(strip.left.stations)
    u = np.linspace(0.0, 1.0, count)
    edges = make_interp_spline(u, np.stack([strip.left.points, strip.right.points], axis=1), k=_DEGREE)
    normal = make_interp_spline(u, strip.left.normals, k=_DEGREE)
    fine = np.linspace(0.0, 1.0, _FINE_PER_SAMPLE * (count - 1) + 1)
    flat = _aligned(_unrolled(edges, normal, fine), strip)
    return Sheet(strip.thickness, edges, normal, flat, _corners(flat, strip.lower), _corners(flat, strip.upper))


def rulings_through(sheet: Sheet, points: Floats) -> tuple[Floats, Floats]:
    """Return the rulings u and the fractions v, each (n,), that points (n, 2) of the flat pattern lie at."""
    grid = np.linspace(0.0, 1.0, _SEARCH)
    ends = np.asarray(sheet.flat(grid))
    u = grid[np.argmin(np.abs(_flat_cross(points[:, None] - ends[:, 0], ends[:, 1] - ends[:, 0])), axis=1)]
    for _ in range(_NEWTON_STEPS):
        ends, rate = np.asarray(sheet.flat(u)), np.asarray(sheet.flat(u, nu=1))
        gap, ruling = points - ends[:, 0], ends[:, 1] - ends[:, 0]
        slope = -_flat_cross(rate[:, 0], ruling) + _flat_cross(gap, rate[:, 1] - rate[:, 0])
        u = u - _flat_cross(gap, ruling) / slope
    ends = np.asarray(sheet.flat(u))
    gap, ruling = points - ends[:, 0], ends[:, 1] - ends[:, 0]
    return u, np.asarray((gap * ruling).sum(axis=1) / (ruling**2).sum(axis=1))


def _flat_cross(a: Floats, b: Floats) -> Floats:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def depth_inside(sheet: Sheet, limit: Limit, u: Floats, v: Floats) -> Floats:
    """Return how far the nearer of both faces lies inside a limit at rulings u and fractions v, (n,)."""
    half = sheet.thickness / 2.0
    return np.minimum(limit(sheet.formed(u, v, -half)), limit(sheet.formed(u, v, half)))


def along_cut(sheet: Sheet, cut: tuple[float, ...]) -> tuple[Floats, Floats]:
    """Return rulings and fractions, each (n,), of points along a cut that is straight in the flat pattern."""
    corners = sheet.flattened(np.array(cut), np.linspace(0.0, 1.0, len(cut)))
    t = np.linspace(0.0, len(cut) - 1.0, (len(cut) - 1) * (_ALONG_CUT - 1) + 1)
    points = np.column_stack([np.interp(t, np.arange(len(cut)), corners[:, axis]) for axis in (0, 1)])
    return rulings_through(sheet, points)


def _inside_cuts(sheet: Sheet) -> list[tuple[Floats, Floats]]:
    """Return (point, inward unit normal), each (2,), of every straight cut."""
    lines = []
    for corners, sign in ((sheet.lower, 1.0), (sheet.upper, -1.0)):
        for start, end in pairwise(corners):
            along = unit(end - start)
            lines.append((start, sign * np.array([along[1], -along[0]])))
    return lines


def ruling_spans(sheet: Sheet, u: Floats) -> Floats:
    """Return the fractions (n, 2) between which the rulings u (n,) lie inside the cuts; empty ones have from > to."""
    ends = np.asarray(sheet.flat(u))
    spans = np.tile([0.0, 1.0], (len(u), 1))
    for point, inward in _inside_cuts(sheet):
        first, last = ((ends - point) @ inward).T
        first, last = (np.where(np.abs(d) < _ON_CUT, 0.0, d) for d in (first, last))
        slope = np.where(first == last, 1.0, last - first)
        meets = -first / slope
        spans[:, 0] = np.where((first < 0.0) & (last >= 0.0), np.maximum(spans[:, 0], meets), spans[:, 0])
        spans[:, 1] = np.where((first >= 0.0) & (last < 0.0), np.minimum(spans[:, 1], meets), spans[:, 1])
        spans[(first < 0.0) & (last < 0.0)] = [1.0, 0.0]
    return spans


def _levels(strip: Strip, spacing: float) -> Floats:
    """Return the parameters of rulings about every ``spacing`` mm, with those of all corners."""
    low, high = min(strip.lower), max(strip.upper)
    count = max(2, math.ceil((high - low) * strip.left.length / spacing) + 1)
    return np.unique(np.concatenate([np.linspace(low, high, count), strip.lower, strip.upper]))


def strip_mesh(strip: Strip, spacing: float = MESH_SPACING) -> Mesh:
    """Return the formed strip as a closed mesh in the coordinates of its shell, facets along the rulings.

    A slanting cut ends in a corner: there a ruling is no longer than the thickness is wide, and two points remain.
    """
    sheet, u = sheet_of(strip), _levels(strip, spacing)
    spans, half = ruling_spans(sheet, u), strip.thickness / 2.0
    rings = np.stack(
        [
            sheet.formed(u, spans[:, side], height)
            for side, height in ((0, -half), (1, -half), (1, half), (0, half))
        ],
        axis=1,
    )  # fmt: skip
    raw = tube(rings)
    names = np.arange(len(raw.vertices)).reshape(-1, 4)
    narrow = spans[:, 1] - spans[:, 0] < _NARROW
    names[narrow] = names[narrow][:, [0, 0, 3, 3]]
    faces = names.ravel()[raw.faces]
    apart = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    used, renamed = np.unique(faces[apart], return_inverse=True)
    return Mesh(raw.vertices[used], renamed.reshape(-1, 3).astype(np.int64))


def _trimmed_edge(sheet: Sheet, strip: Strip, side: int) -> Floats:
    """Return an edge of the flat pattern from its lower to its upper corner, about every 25 mm, (n, 2)."""
    low, high = strip.lower[-side], strip.upper[-side]
    count = max(2, math.ceil((high - low) * strip.left.length / OUTLINE_SPACING) + 1)
    return np.asarray(sheet.flat(np.linspace(low, high, count)))[:, side]


def _arc_length(sheet: Sheet, strip: Strip, side: int) -> float:
    low, high = strip.lower[-side], strip.upper[-side]
    nodes, weights = np.polynomial.legendre.leggauss(6)
    panels = np.linspace(low, high, _FINE_PER_SAMPLE * len(strip.left.stations))
    half = np.diff(panels) / 2.0
    inner = panels[:-1, None] + half[:, None] * (nodes + 1.0)
    speed = np.linalg.norm(np.asarray(sheet.flat(inner.ravel(), nu=1))[:, side], axis=1).reshape(inner.shape)
    return float(half @ speed @ weights)


def chord_offsets(edge: Floats) -> tuple[Floats, Floats]:
    """Return how far along its chord and how far left of it the points of a flat edge (n, 2) lie, each (n,)."""
    along = unit(edge[-1] - edge[0])
    gap = edge - edge[0]
    return np.asarray(gap @ along), np.asarray(gap @ np.array([-along[1], along[0]]))


def _sagitta(edge: Floats, inward: float) -> float:
    offsets = inward * chord_offsets(edge)[1]
    return float(offsets[np.argmax(np.abs(offsets))])


def flat_pattern(strip: Strip) -> FlatPattern:
    """Return the unrolled strip with its long concave edges (paper section 3.2, Fig. 8e)."""
    return _pattern(replace(strip, mark=""))


@lru_cache(maxsize=_REMEMBERED)
def _pattern(strip: Strip) -> FlatPattern:
    sheet = sheet_of(strip)
    left, right = (_trimmed_edge(sheet, strip, side) for side in (0, 1))
    outline = np.concatenate([left, sheet.upper[1:], right[-2::-1], sheet.lower[-2:0:-1]])
    size = np.ptp(outline, axis=0)
    return FlatPattern(
        outline=outline,
        left=left,
        right=right,
        lower=sheet.lower,
        upper=sheet.upper,
        length=float(size[0]),
        width=float(size[1]),
        left_length=_arc_length(sheet, strip, 0),
        right_length=_arc_length(sheet, strip, 1),
        left_sagitta=_sagitta(left, 1.0),
        right_sagitta=_sagitta(right, -1.0),
        area=polygon_area(outline),
    )


def strip_sizes(strip: Strip) -> tuple[float, float, float]:
    """Return length and largest width of the flat pattern, and the thickness, mm."""
    flat = flat_pattern(strip)
    return flat.length, flat.width, strip.thickness


def strip_volume(strip: Strip) -> float:
    """Return the volume, mm3: bending about mid-thickness keeps area x thickness."""
    return flat_pattern(strip).area * strip.thickness


def sheet_radius(strip: Strip) -> float:
    """Return the smallest radius to which the sheet is bent across its rulings, mm; infinite if it stays flat."""
    sheet, u = sheet_of(strip), _levels(strip, OUTLINE_SPACING)
    normal = np.asarray(sheet.normal(u))
    up = unit(normal)
    slope = np.asarray(sheet.normal(u, nu=1)) / np.linalg.norm(normal, axis=1)[:, None]
    turning = np.linalg.norm(slope - dot(slope, up)[:, None] * up, axis=1)
    ends, first = np.asarray(sheet.edges(u)), np.asarray(sheet.edges(u, nu=1))
    forward = np.cross(unit(ends[:, 1] - ends[:, 0]), up)
    speed = np.array([dot(first[:, side], forward) for side in (0, 1)])
    bending = float((turning / speed.min(axis=0)).max())
    return 1.0 / bending if bending > 0.0 else math.inf


def strip_depth(strip: Strip, points: Floats) -> Floats:
    """Return how deep points (n, 3) near a strip lie inside its sheet, mm, (n,); negative outside.

    The ruling plane (ruling and normal) that holds a point is found by Newton's method; there the depth is measured to
    the two faces, and in the flat pattern to the edges and cuts. Points that are far off are so by rough figures.
    """
    sheet = sheet_of(strip)
    middles = (strip.left.points + strip.right.points) / 2.0
    nearest = np.argmin((middles**2).sum(axis=1) - 2.0 * points @ middles.T, axis=1)
    height = dot(points - strip.left.points[nearest], strip.left.normals[nearest])
    depth = strip.thickness / 2.0 - np.abs(height)
    near = depth > -_rise(strip)
    if near.any():
        depth[near] = _near_depth(sheet, points[near], nearest[near] / (len(middles) - 1.0))
    return depth


def _rise(strip: Strip) -> float:
    """Return what the sheet rises at most over the tangent plane of a ruling on the way to the next one, mm."""
    return max(
        float((np.linalg.norm(np.diff(edge.normals, axis=0), axis=1) * np.diff(edge.stations)).max() / 2.0)
        for edge in (strip.left, strip.right)
    )


def _near_depth(sheet: Sheet, points: Floats, guess: Floats) -> Floats:
    """Return how deep points (n, 3) lie inside the sheet, (n,), from guesses of their rulings."""
    u = guess
    frame = BSpline(sheet.edges.t, np.concatenate([sheet.edges.c, sheet.normal.c[:, None]], axis=1), sheet.edges.k)
    for _ in range(_NEWTON_STEPS):
        (left, right, normal), first = np.moveaxis(frame(u), 1, 0), np.asarray(sheet.edges(u, nu=1))
        ruling = unit(right - left)
        forward = np.cross(ruling, unit(normal))
        v = dot(points - left, ruling) / np.linalg.norm(right - left, axis=1)
        speed = (1.0 - v) * dot(first[:, 0], forward) + v * dot(first[:, 1], forward)
        ahead = dot(points - left, forward)
        step = np.clip(u + ahead / speed, -0.02, 1.02) - u
        u = u + step
        if np.all(np.abs(step) < _STILL):
            break
    left, right, normal = np.moveaxis(frame(u), 1, 0)
    v = dot(points - left, right - left) / dot(right - left, right - left)
    depth = sheet.thickness / 2.0 - np.abs(dot(points - left, unit(normal)))
    ends, slope = np.asarray(sheet.flat(u)), np.asarray(sheet.flat(u, nu=1))
    flat = ends[:, 0] + v[:, None] * (ends[:, 1] - ends[:, 0])
    for side, sign in ((0, 1.0), (1, -1.0)):
        depth = np.minimum(depth, sign * _flat_cross(unit(slope[:, side]), flat - ends[:, side]))
    for point, inward in _inside_cuts(sheet):
        depth = np.minimum(depth, (flat - point) @ inward)
    # A point past the last ruling stays ahead of it, and is outside by that much at least.
    return np.where(np.abs(ahead) > 1e-3, np.minimum(depth, -np.abs(ahead)), depth)


def strip_points(strip: Strip, face_spacing: float = _FACE_SPACING, edge_spacing: float = _EDGE_SPACING) -> Floats:
    """Return points on the surface of a formed strip, (n, 3): on both faces, and closer along its edges and cuts."""
    sheet, half = sheet_of(strip), strip.thickness / 2.0
    rulings = _levels(strip, face_spacing)
    spans = ruling_spans(sheet, rulings)
    widest = float(np.linalg.norm(strip.right.points - strip.left.points, axis=1).max())
    t = np.linspace(0.0, 1.0, max(2, math.ceil(widest / face_spacing) + 1))
    u = [np.repeat(rulings, len(t))]
    v = [(spans[:, :1] + t * (spans[:, 1:] - spans[:, :1])).ravel()]
    close = _levels(strip, edge_spacing)
    for side in (0, 1):
        u.append(close)
        v.append(ruling_spans(sheet, close)[:, side])
    every_u, every_v = np.concatenate(u), np.concatenate(v)
    return np.concatenate([sheet.formed(every_u, every_v, height) for height in (-half, half)])


SHEET = Shape[Strip](
    name="sheet",
    sizes=strip_sizes,
    section=lambda strip: strip_sizes(strip)[1] * strip.thickness,
    gross_volume=strip_volume,
    volume=strip_volume,
    mesh=strip_mesh,
    points=strip_points,
    depths=strip_depth,
    lines=lambda strip: (strip.left, strip.right),
)
