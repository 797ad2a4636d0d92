"""Closed triangle meshes: sweeps, prisms and polygons; faces turn outwards. Areas of circles and hexagons."""

import math
from dataclasses import dataclass

import numpy as np

from aag_cad.units import Floats, Ints

_ROUND_SIDES = 12


@dataclass(frozen=True, eq=False)
class Mesh:
    """A closed triangle mesh: vertices (n, 3) float, faces (m, 3) int, counter-clockwise from outside."""

    vertices: Floats
    faces: Ints

    @property
    def volume(self) -> float:
        """The enclosed volume by the divergence theorem, mm3; positive if the faces turn outwards."""
        a, b, c = (self.vertices[self.faces[:, i]] for i in range(3))
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def joined(meshes: list[Mesh]) -> Mesh:
    """Return several meshes as one (their volumes must not overlap)."""
    starts = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes[:-1]])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.faces + start for mesh, start in zip(meshes, starts, strict=True)]),
    )


def tube(rings: Floats) -> Mesh:
    """Return the closed mesh over rings (k, m, 3) of a convex section, counter-clockwise seen against the sweep.

    Facing quads are split along the same physical diagonal for rings of four, so that thin planks keep their volume.
    """
    count, sides, _ = rings.shape
    faces = []
    for i in range(count - 1):
        for j in range(sides):
            a, b = i * sides + j, i * sides + (j + 1) % sides
            c, d = b + sides, a + sides
            faces += [(a, b, c), (a, c, d)] if j % 4 < 2 else [(a, b, d), (b, c, d)]
    last = (count - 1) * sides
    faces += [(0, j + 1, j) for j in range(1, sides - 1)]
    faces += [(last, last + j, last + j + 1) for j in range(1, sides - 1)]
    return Mesh(rings.reshape(-1, 3), np.array(faces, dtype=np.int64))


def prism(outline: Floats, low: float, high: float) -> Mesh:
    """Return the prism over a convex outline (m, 2), counter-clockwise, between two heights."""
    ring = np.column_stack([outline, np.zeros(len(outline))])
    return tube(np.array([ring + np.array([0.0, 0.0, low]), ring + np.array([0.0, 0.0, high])]))


def regular_polygon(sides: int, across_flats: float) -> Floats:
    """Return a regular polygon (sides, 2), counter-clockwise, with a flat whose outward normal is +x."""
    angles = (np.arange(sides) - 0.5) * 2.0 * math.pi / sides
    return across_flats / 2.0 / math.cos(math.pi / sides) * np.column_stack([np.cos(angles), np.sin(angles)])


def round_polygon(diameter: float) -> Floats:
    """Return a polygon of twelve sides with the area of the circle."""
    area = math.pi * diameter**2 / 4.0
    return regular_polygon(_ROUND_SIDES, 2.0 * math.sqrt(area / (_ROUND_SIDES * math.tan(math.pi / _ROUND_SIDES))))


def polygon_area(corners: Floats) -> float:
    """Return the area inside a plane polygon (n, 2), mm2."""
    (x, y), (u, v) = corners.T, np.roll(corners, -1, axis=0).T
    return abs(float(np.sum(x * v - u * y))) / 2.0


def hexagon_area(across_flats: float) -> float:
    """Return the area of a regular hexagon, mm2."""
    return math.sqrt(3.0) / 2.0 * across_flats**2


def circle_area(diameter: float) -> float:
    """Return the area of a circle, mm2."""
    return math.pi / 4.0 * diameter**2
