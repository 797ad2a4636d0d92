"""Hexagonal prisms: the studs of the nodes, drilled across."""

import math
from functools import lru_cache

import numpy as np

from aag_cad.parts.model import Stud
from aag_cad.parts.shapes.box import FACE_SPACING
from aag_cad.parts.shapes.shape import Shape
from aag_cad.parts.triangles import Mesh, hexagon_area, prism, regular_polygon
from aag_cad.units import Floats

_CHORDS = 64
# The studs of a shell have few kinds of holes, and many lists ask for their masses.
_HOLES = 1024


@lru_cache(maxsize=_HOLES)
def _cross_hole_volume(across_flats: float, angle: float, diameter: float) -> float:
    """Return what a hole through the axis of a hexagonal prism takes away: chords weighted by the hole's depth, mm3.

    Gauss-Chebyshev quadrature of the second kind: exact where the hole enters and leaves through single flats.
    """
    k = np.arange(1, _CHORDS + 1) * math.pi / (_CHORDS + 1)
    offset, weight = diameter / 2.0 * np.cos(k), math.pi / (_CHORDS + 1) * np.sin(k) ** 2
    towards = np.arange(6) * math.pi / 3.0 - angle
    towards = towards[np.cos(towards) > 1e-12]
    reach = (across_flats / 2.0 - np.multiply.outer(offset, np.sin(towards))) / np.cos(towards)
    chord = reach.min(axis=1) + reach[::-1].min(axis=1)
    return float(diameter**2 / 2.0 * (weight @ chord))


def _volume(stud: Stud) -> float:
    bored = sum(_cross_hole_volume(stud.across_flats, hole.angle, hole.diameter) for hole in stud.holes)
    return hexagon_area(stud.across_flats) * stud.length - bored


def _mesh(stud: Stud) -> Mesh:
    return prism(regular_polygon(6, stud.across_flats), -stud.length / 2.0, stud.length / 2.0)


def column_points(mesh: Mesh) -> Floats:
    """Return points on the walls over the lowest ring of a mesh along z, and its vertices, (n, 3)."""
    low, high = mesh.vertices[:, 2].min(), mesh.vertices[:, 2].max()
    ring = mesh.vertices[np.isclose(mesh.vertices[:, 2], low)]
    heights = np.linspace(low, high, max(2, int((high - low) / FACE_SPACING) + 1))
    walls = np.concatenate([ring[:, :2]] * len(heights))
    return np.concatenate([np.column_stack([walls, np.repeat(heights, len(ring))]), mesh.vertices])


def _depths(stud: Stud, points: Floats) -> Floats:
    angles = np.arange(6) * np.pi / 3.0
    flats = points[:, :2] @ np.array([np.cos(angles), np.sin(angles)])
    ends = stud.length / 2.0 - np.abs(points[:, 2])
    return np.asarray(np.minimum(stud.across_flats / 2.0 - flats.max(axis=1), ends))


PRISM = Shape[Stud](
    name="prism",
    sizes=lambda stud: (stud.length, stud.across_flats, stud.across_flats),
    section=lambda stud: hexagon_area(stud.across_flats),
    volume=_volume,
    mesh=_mesh,
    points=lambda stud: column_points(_mesh(stud)),
    depths=_depths,
    holes=lambda stud: stud.holes,
)
