"""Folded plates of steel, mitred at their folds."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from aag_cad.geometry.surface import dot, unit
from aag_cad.parts.forms import FoldedPlate
from aag_cad.parts.shapes.shape import Shape
from aag_cad.parts.triangles import tube
from aag_cad.units import Floats

_POINT_SPACING = 4.0


@dataclass(frozen=True, eq=False)
class Legs:
    """The straight legs of a folded plate: starts (n, 3), directions and thickness directions (n, 3), lengths (n,)."""

    start: Floats
    direction: Floats
    normal: Floats
    length: Floats


def plate_legs(plate: FoldedPlate) -> Legs:
    """Return the legs of a folded plate in the order of its line; each thickness direction is leg x width (y)."""
    points = np.array([(x, 0.0, z) for x, z in plate.line])
    steps = np.diff(points, axis=0)
    directions = unit(steps)
    return Legs(points[:-1], directions, np.cross(directions, [0.0, 1.0, 0.0]), np.linalg.norm(steps, axis=1))


def developed_length(plate: FoldedPlate) -> float:
    """Return the length of the plate before it is folded, along its centre line, mm."""
    return float(plate_legs(plate).length.sum())


def plate_rings(plate: FoldedPlate) -> Floats:
    """Return the mitred section at every point of the line, (n, 4, 3): (-y, -t), (y, -t), (y, t), (-y, t)."""
    legs = plate_legs(plate)
    before = np.concatenate([legs.normal[:1], legs.normal])
    after = np.concatenate([legs.normal, legs.normal[-1:]])
    mitre = (before + after) / (1.0 + dot(before, after))[:, None]
    points = np.concatenate([legs.start, legs.start[-1:] + legs.length[-1] * legs.direction[-1:]])
    across, half = np.array([0.0, plate.width / 2.0, 0.0]), plate.thickness / 2.0
    lower, upper = points - half * mitre, points + half * mitre
    return np.stack([lower - across, lower + across, upper + across, upper - across], axis=1)


def plate_volume(plate: FoldedPlate) -> float:
    """Return the volume less the holes, mm3; mitred folds keep section x length."""
    bored = sum(np.pi / 4.0 * hole.diameter**2 for hole in plate.holes)
    return float(plate.thickness * (developed_length(plate) * plate.width - bored))


def hole_axes(plate: FoldedPlate) -> tuple[Floats, Floats]:
    """Return the centres (n, 3) of the holes at mid-thickness and their axes (n, 3)."""
    legs = plate_legs(plate)
    ends = np.cumsum(legs.length)
    stations = np.array([hole.station for hole in plate.holes])
    which = np.minimum(np.searchsorted(ends, stations), len(ends) - 1)
    along = stations - (ends[which] - legs.length[which])
    centres = legs.start[which] + along[:, None] * legs.direction[which]
    centres[:, 1] = [hole.offset for hole in plate.holes]
    return centres, legs.normal[which]


def plate_depth(plate: FoldedPlate, points: Floats) -> Floats:
    """Return how deep points (n, 3) lie inside the plate, mm, (n,); negative outside."""
    legs = plate_legs(plate)
    depths = []
    for start, direction, normal, length in zip(legs.start, legs.direction, legs.normal, legs.length, strict=True):
        gap = points - start
        along, height = gap @ direction, gap @ normal
        sides = [along, length - along, plate.thickness / 2.0 - np.abs(height), plate.width / 2.0 - np.abs(gap[:, 1])]
        depths.append(np.minimum.reduce(sides))
    return np.asarray(np.maximum.reduce(depths))


def leg_points(plate: FoldedPlate, spacing: float) -> Floats:
    """Return points on both faces of the plate and midway between them, about every ``spacing`` mm, (n, 3)."""
    rings = plate_rings(plate)
    points = []
    for first, last in pairwise(rings):
        size = np.linalg.norm(last.mean(axis=0) - first.mean(axis=0))
        u = np.linspace(0.0, 1.0, max(2, int(np.ceil(size / spacing)) + 1))[:, None, None]
        ring = (1.0 - u) * first + u * last
        v = np.linspace(0.0, 1.0, max(2, int(np.ceil(plate.width / spacing)) + 1))[:, None]
        left, right = (ring[:, 0], ring[:, 3]), (ring[:, 1], ring[:, 2])
        for share in (0.0, 0.5, 1.0):
            a, b = ((1.0 - share) * side[0] + share * side[1] for side in (left, right))
            points.append((a[:, None] + v * (b - a)[:, None]).reshape(-1, 3))
    return np.concatenate(points)


FOLDED_PLATE = Shape[FoldedPlate](
    name="folded plate",
    sizes=lambda plate: (developed_length(plate), plate.width, plate.thickness),
    section=lambda plate: plate.width * plate.thickness,
    volume=plate_volume,
    mesh=lambda plate: tube(plate_rings(plate)),
    points=lambda plate: leg_points(plate, _POINT_SPACING),
    depths=plate_depth,
    holes=lambda plate: plate.holes,
)
