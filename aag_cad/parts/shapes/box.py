"""Boxes: blocks of timber and of concrete, drilled through their thickness or not at all."""

from dataclasses import dataclass

import numpy as np

from aag_cad.parts.forms import Hole
from aag_cad.parts.shapes.shape import Shape
from aag_cad.parts.triangles import Mesh, circle_area, prism
from aag_cad.units import Floats

FACE_SPACING = 12.0
_EDGE_SPACING = 4.0


@dataclass(frozen=True)
class Box:
    """A box about the origin in x (length) and y (width), from ``low`` to ``high`` in z; holes run along z."""

    length: float
    width: float
    low: float
    high: float
    holes: tuple[Hole, ...] = ()

    @property
    def thickness(self) -> float:
        """What it measures along z, mm."""
        return self.high - self.low


def _grid(length: float, spacing: float) -> Floats:
    return np.linspace(-length / 2.0, length / 2.0, max(2, int(np.ceil(length / spacing)) + 1))


def box_points(length: float, width: float, thickness: float) -> Floats:
    """Return points on the surface of a box about the origin, closer along its long edges, (n, 3)."""
    x, y, z = (_grid(size, FACE_SPACING) for size in (length, width, thickness))
    edge = _grid(length, _EDGE_SPACING)
    grids = ((x, y, z[[0, -1]]), (x, y[[0, -1]], z), (x[[0, -1]], y, z), (edge, y[[0, -1]], z[[0, -1]]))
    return np.concatenate([np.stack(np.meshgrid(*grid, indexing="ij"), axis=-1).reshape(-1, 3) for grid in grids])


def _volume(box: Box) -> float:
    bored = box.thickness * sum(circle_area(hole.diameter) for hole in box.holes)
    return box.width * box.thickness * box.length - bored


def _mesh(box: Box) -> Mesh:
    x, y = box.length / 2.0, box.width / 2.0
    return prism(np.array([(-x, -y), (x, -y), (x, y), (-x, y)]), box.low, box.high)


def _points(box: Box) -> Floats:
    middle = np.array([0.0, 0.0, (box.low + box.high) / 2.0])
    return np.asarray(box_points(box.length, box.width, box.thickness) + middle)


def _depths(box: Box, points: Floats) -> Floats:
    x, y, z = points.T
    sides = [box.length / 2.0 - np.abs(x), box.width / 2.0 - np.abs(y), z - box.low, box.high - z]
    return np.asarray(np.minimum.reduce(sides))


BOX = Shape[Box](
    name="box",
    sizes=lambda box: (box.length, box.width, box.thickness),
    section=lambda box: box.width * box.thickness,
    volume=_volume,
    mesh=_mesh,
    points=_points,
    depths=_depths,
    holes=lambda box: box.holes,
)
