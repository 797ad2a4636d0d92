"""Where solids of different parts run into each other, and how deep."""

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from aag_cad.parts.forms import UNMOVED
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import shaped
from aag_cad.parts.mesh import depths_in, frame_matrix, moved, part_matrix, surface_points
from aag_cad.parts.model import Gridshell, Part, all_joints, ridge_parts, shell_parts
from aag_cad.units import Floats, Vector, vector

_STRETCH = 250.0
_BETWEEN = -1


@dataclass(frozen=True)
class Clash:
    """Two parts of which one reaches into the other: the marks, the depth in mm and the deepest point."""

    first: str
    second: str
    depth: float
    point: Vector


@dataclass(frozen=True, eq=False)
class _Piece:
    """A part, or a stretch of a plank: points on its surface (n, 3) and their box (2, 3), vault coordinates."""

    body: int
    points: Floats
    box: Floats


@dataclass(frozen=True, eq=False)
class _Body:
    """A part with the key of its product, its shell, and the matrix (4, 4) from product to vault coordinates."""

    part: Part
    key: str
    shell: int
    matrix: Floats


def _pieces(index: int, body: _Body, groups: list[Floats]) -> Iterator[_Piece]:
    """Yield groups of a part's surface points, given in product coordinates, where the part is."""
    for group in groups:
        points = moved(group, body.matrix)
        yield _Piece(index, points, np.array([points.min(axis=0), points.max(axis=0)]))


def _point_groups(part: Part) -> list[Floats]:
    """Return a part's surface points, those of a long part in stretches of about 250 mm so that boxes stay tight."""
    points, (shape, form) = surface_points(part), shaped(part)
    if not (lines := shape.lines(form)):
        return [points]
    curve = lines[0]
    order = np.argsort(points @ (curve.points[-1] - curve.points[0]), kind="stable")
    return np.array_split(points[order], max(1, round(curve.length / _STRETCH)))


def _near_pairs(boxes: Floats) -> Iterator[tuple[int, int]]:
    """Yield the index pairs of overlapping boxes (n, 2, 3), by a sweep along x."""
    order = np.argsort(boxes[:, 0, 0], kind="stable")
    low, high = boxes[order, 0], boxes[order, 1]
    for i in range(len(order)):
        last = int(np.searchsorted(low[:, 0], high[i, 0], side="right"))
        inside = np.all((low[i + 1 : last] < high[i]) & (high[i + 1 : last] > low[i]), axis=1)
        for j in np.nonzero(inside)[0]:
            yield int(order[i]), int(order[i + 1 + j])


def _inside(points: Floats, box: Floats) -> NDArray[np.bool_]:
    """Return which of points (n, 3) lie inside a box (2, 3), (n,); by columns, which is quicker than ``np.all``."""
    (x, y, z), (low, high) = points.T, box.tolist()
    return np.asarray((x > low[0]) & (x < high[0]) & (y > low[1]) & (y < high[1]) & (z > low[2]) & (z < high[2]))


def _own_pairs(gridshell: Gridshell) -> set[tuple[str, str]]:
    """Return (fastener, member) for every bolt and screw and the members of its own joint."""
    return {
        (fastener, member)
        for joint in all_joints(gridshell)
        for fastener in joint.fasteners
        for member in joint.members
    }


def clashes(gridshell: Gridshell, limit: float) -> list[Clash]:
    """Return the pairs of parts that reach more than ``limit`` mm into each other, deepest first, vault coordinates.

    Broad phase by bounding boxes; then points on each surface (every 12 mm, along edges every 4 mm) are taken into the
    other part's own coordinates, where their depth is exact. A bolt or screw belongs into the members of its own joint
    and is not held against them.
    """
    shells, keys, twins = gridshell.shells, index_of(gridshell).keys, index_of(gridshell).twins
    wholes = [(i, shell.placement, shell_parts(shell)) for i, shell in enumerate(shells)]
    wholes.append((_BETWEEN, UNMOVED, ridge_parts(gridshell)))
    bodies = [
        _Body(part, keys[part.mark], i, frame_matrix(placement) @ part_matrix(part))
        for i, placement, parts in wholes
        for part in parts
    ]
    # What happens inside a shell happens inside its twins.
    own, repeated = _own_pairs(gridshell), {i for i, shell in enumerate(shells) if twins[shell.mark] != shell.mark}
    samples = {body.key: _point_groups(body.part) for body in {body.key: body for body in bodies}.values()}
    pieces = [piece for index, body in enumerate(bodies) for piece in _pieces(index, body, samples[body.key])]
    inside: dict[int, list[tuple[int, Floats]]] = defaultdict(list)
    for i, j in _near_pairs(np.array([piece.box for piece in pieces])):
        a, b = bodies[pieces[i].body], bodies[pieces[j].body]
        marks = (a.part.mark, b.part.mark)
        if a is b or marks in own or marks[::-1] in own or (a.shell == b.shell and a.shell in repeated):
            continue
        for one, other in ((pieces[i], pieces[j]), (pieces[j], pieces[i])):
            near = one.points[_inside(one.points, other.box)]
            if len(near):
                inside[other.body].append((one.body, near))
    deepest: dict[tuple[int, int], Clash] = {}
    for index, groups in sorted(inside.items()):
        body, points = bodies[index], np.concatenate([group for _, group in groups])
        owners = np.repeat([owner for owner, _ in groups], [len(group) for _, group in groups])
        depths = depths_in(body.part, (points - body.matrix[:3, 3]) @ body.matrix[:3, :3])
        for k in np.nonzero(depths > limit)[0]:
            pair = (min(index, int(owners[k])), max(index, int(owners[k])))
            if pair not in deepest or deepest[pair].depth < depths[k]:
                first, second = (bodies[i].part.mark for i in pair)
                deepest[pair] = Clash(first, second, float(depths[k]), vector(points[k]))
    return sorted(deepest.values(), key=lambda clash: (-clash.depth, clash.first, clash.second))
