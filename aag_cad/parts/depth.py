"""Points on the surface of every kind of part, and how deep given points lie inside it."""

from collections.abc import Iterable

import numpy as np
from scipy.spatial import cKDTree

from aag_cad.geometry.surface import dot
from aag_cad.parts.fasteners import BoltPiece, bolt_pieces, rod_pieces
from aag_cad.parts.forming import blank_points, formed_points, plank_axes
from aag_cad.parts.mesh import product_mesh
from aag_cad.parts.model import (
    Blade,
    Bolt,
    ClampingBar,
    CouplingBlock,
    FlatBar,
    Footing,
    Mullion,
    Part,
    Plank,
    Rod,
    Screw,
    Shoe,
    Strap,
    Strip,
    Stud,
)
from aag_cad.parts.plates import leg_points, plate_depth
from aag_cad.parts.strips import strip_depth, strip_points
from aag_cad.units import Floats

_BARS = Plank | Mullion | ClampingBar | Strap
_FACE_SPACING = 12.0
_SHEET_SPACING = 30.0
_EDGE_SPACING = 4.0


def _grid(length: float, spacing: float) -> Floats:
    return np.linspace(-length / 2.0, length / 2.0, max(2, int(np.ceil(length / spacing)) + 1))


def _box_points(length: float, width: float, thickness: float) -> Floats:
    """Return points on the surface of a box about the origin, closer along its long edges."""
    x, y, z = _grid(length, _FACE_SPACING), _grid(width, _FACE_SPACING), _grid(thickness, _FACE_SPACING)
    faces = [
        np.stack(np.meshgrid(x, y, z[[0, -1]], indexing="ij"), axis=-1).reshape(-1, 3),
        np.stack(np.meshgrid(x, y[[0, -1]], z, indexing="ij"), axis=-1).reshape(-1, 3),
        np.stack(np.meshgrid(x[[0, -1]], y, z, indexing="ij"), axis=-1).reshape(-1, 3),
        np.stack(np.meshgrid(_grid(length, _EDGE_SPACING), y[[0, -1]], z[[0, -1]], indexing="ij"), axis=-1).reshape(
            -1, 3
        ),
    ]
    return np.concatenate(faces)


def surface_points(part: Part) -> Floats:
    """Return points on the surface of a part in product coordinates, (n, 3)."""
    if isinstance(part, _BARS):
        section = part.blank.section
        points = _box_points(part.blank.length, section.width, section.thickness)
        return formed_points(part, points + np.array([part.blank.length / 2.0, 0.0, 0.0]))
    if isinstance(part, CouplingBlock):
        return _box_points(part.length, part.width, part.thickness)
    if isinstance(part, Footing):
        return np.asarray(_box_points(part.length, part.width, part.height) - [0.0, 0.0, part.height / 2.0])
    if isinstance(part, Strip):
        return strip_points(part, _SHEET_SPACING, _FACE_SPACING)
    if isinstance(part, Shoe | Blade):
        return leg_points(part.plate, _EDGE_SPACING)
    mesh = product_mesh(part)
    low, high = mesh.vertices[:, 2].min(), mesh.vertices[:, 2].max()
    ring = mesh.vertices[np.isclose(mesh.vertices[:, 2], low)]
    heights = np.linspace(low, high, max(2, int((high - low) / _FACE_SPACING) + 1))
    walls = np.concatenate([ring[:, :2]] * len(heights))
    return np.concatenate([np.column_stack([walls, np.repeat(heights, len(ring))]), mesh.vertices])


def _blank_depths(bar: FlatBar, blank: Floats) -> Floats:
    """Return how deep points (n, 3) of the straight blank's coordinates lie inside it, (n,)."""
    (x, y, z), section = blank.T, bar.blank.section
    sides = [x, bar.blank.length - x, section.width / 2.0 - np.abs(y), section.thickness / 2.0 - np.abs(z)]
    return np.asarray(np.minimum.reduce(sides))


def _rough_depths(bar: FlatBar, points: Floats) -> tuple[Floats, float]:
    """Return depths (n,) in the straight bar that touches a formed one at the nearest sample, and their error, mm.

    Points farther from the curve than the section reaches get minus infinity. Between two samples the bar turns by the
    angle between their frames; half of it acts over the reach at most, so that the whole of it is on the safe side.
    """
    stations, section = bar.curve.stations, bar.blank.section
    away, nearest = cKDTree(bar.curve.points).query(points)
    reach = float(np.hypot(np.diff(stations).max() / 2.0, np.hypot(section.width, section.thickness) / 2.0))
    centre, *axes = plank_axes(bar, stations)
    turn = max(float(np.linalg.norm(np.diff(axis, axis=0), axis=1).max()) for axis in axes)
    depths = np.full(len(points), -np.inf)
    near = np.flatnonzero(away <= reach)
    at = np.asarray(nearest)[near]
    gap = points[near] - centre[at]
    x, y, z = (dot(gap, axis[at]) for axis in axes)
    depths[near] = _blank_depths(bar, np.column_stack([stations[at] + x, y, z]))
    return depths, reach * turn


def _bar_depths(bar: FlatBar, points: Floats) -> Floats:
    """Return depths in a formed bar; those of points that are surely outside are rough."""
    depths, error = _rough_depths(bar, points)
    near = depths > -error
    if near.any():
        depths[near] = _blank_depths(bar, blank_points(bar, points[near]))
    return depths


def _threaded_depth(pieces: Iterable[BoltPiece], points: Floats) -> Floats:
    radius, height = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    depths = [np.minimum.reduce([p.size / 2.0 - radius, height - p.low, p.high - height]) for p in pieces]
    return np.asarray(np.maximum.reduce(depths))


def depths_in(part: Part, points: Floats) -> Floats:
    """Return how deep points (n, 3) in product coordinates lie inside a part, mm, (n,); negative outside."""
    if isinstance(part, _BARS):
        return _bar_depths(part, points)
    if isinstance(part, CouplingBlock):
        size = np.array([part.length, part.width, part.thickness]) / 2.0
        return np.asarray((size - np.abs(points)).min(axis=1))
    if isinstance(part, Stud):
        angles = np.arange(6) * np.pi / 3.0
        flats = points[:, :2] @ np.array([np.cos(angles), np.sin(angles)])
        ends = part.length / 2.0 - np.abs(points[:, 2])
        return np.asarray(np.minimum(part.across_flats / 2.0 - flats.max(axis=1), ends))
    if isinstance(part, Bolt):
        return _threaded_depth(bolt_pieces(part), points)
    if isinstance(part, Rod):
        return _threaded_depth(rod_pieces(part), points)
    if isinstance(part, Shoe | Blade):
        return plate_depth(part.plate, points)
    if isinstance(part, Footing):
        sides = [part.length / 2.0 - np.abs(points[:, 0]), part.width / 2.0 - np.abs(points[:, 1])]
        return np.asarray(np.minimum.reduce([*sides, -points[:, 2], points[:, 2] + part.height]))
    if isinstance(part, Screw):
        inside = part.diameter / 2.0 - np.hypot(points[:, 0], points[:, 1])
        return np.asarray(np.minimum.reduce([inside, points[:, 2], part.length - points[:, 2]]))
    return strip_depth(part, points)
