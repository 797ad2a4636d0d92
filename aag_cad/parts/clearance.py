"""How deep the points of a new part would lie inside parts that already stand somewhere."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from aag_cad.parts.forms import Frame
from aag_cad.parts.mesh import depths_in, frame_matrix, moved, part_matrix, placed, shell_mesh, surface_points
from aag_cad.parts.model import Part
from aag_cad.parts.products import part_frame
from aag_cad.units import Floats, Vector

_NEAR = 500.0
_MARGIN = 1.0
# What steel may press into timber, mm: less than its own half thickness, or it would seem free inside.
CONTACT = 0.2


@dataclass(frozen=True, eq=False)
class Obstacle:
    """A part that stands in the way: boxes (n, 2, 3) of its stretches, matrix (4, 4) to the common coordinates."""

    part: Part
    boxes: Floats
    matrix: Floats


def obstacles(parts: Iterable[Part], placement: Frame) -> list[Obstacle]:
    """Return parts of a shell as obstacles in the coordinates that its placement is given in."""
    found = []
    for part in parts:
        vertices = placed(shell_mesh(part), placement).vertices
        matrix = frame_matrix(placement) @ part_matrix(part)
        found.append(Obstacle(part, _boxes(vertices, part_frame(part) is None), matrix))
    return found


def _boxes(vertices: Floats, long: bool) -> Floats:
    """Return the box of a part, or of every two rings of four vertices of a long one, (n, 2, 3)."""
    pieces = [vertices[i : i + 8] for i in range(0, len(vertices) - 4, 4)] if long else [vertices]
    return np.array([(piece.min(axis=0), piece.max(axis=0)) for piece in pieces])


def near_parts(parts: Iterable[Part], points: Sequence[Vector]) -> list[Part]:
    """Return the parts with a frame that stand within half a metre of the polyline through points near the top."""
    line = _dense(np.array(points)) if len(points) else np.zeros((0, 3))
    found = []
    for part in parts:
        frame = part_frame(part)
        if frame is None or (len(line) and np.linalg.norm(line - np.array(frame.origin), axis=1).min() < _NEAR):
            found.append(part)
    return found


def _dense(points: Floats) -> Floats:
    """Return a point cloud in which no point is farther than 100 mm from the next."""
    order = points[np.argsort(points[:, 1], kind="stable")]
    pieces = []
    for a, b in pairwise(order):
        count = max(2, int(np.linalg.norm(b - a) / 100.0) + 1)
        pieces.append(a + np.linspace(0.0, 1.0, count)[:, None] * (b - a))
    return np.concatenate([order, *pieces])


def placed_points(part: Part) -> Floats:
    """Return points on the surface of a part (n, 3) in the coordinates that its frame is given in."""
    return moved(surface_points(part), part_matrix(part))


def is_free(points: Floats, among: Iterable[Obstacle], limit: float = CONTACT) -> bool:
    """Return whether none of points (n, 3) lies deeper than ``limit`` mm inside an obstacle."""
    low, high = points.min(axis=0), points.max(axis=0)
    for obstacle in among:
        hit = np.all((obstacle.boxes[:, 0] < high) & (obstacle.boxes[:, 1] > low), axis=1)
        if not hit.any():
            continue
        inside = np.ones((len(points), int(hit.sum())), dtype=bool)
        for along, box in zip(points.T, obstacle.boxes[hit].T, strict=True):
            inside &= (along[:, None] > box[0] - _MARGIN) & (along[:, None] < box[1] + _MARGIN)
        near = points[inside.any(axis=1)]
        if len(near):
            local = (near - obstacle.matrix[:3, 3]) @ obstacle.matrix[:3, :3]
            if depths_in(obstacle.part, local).max() > limit:
                return False
    return True
