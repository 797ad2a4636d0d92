"""Which faces of a picture are hidden, and the order in which the others are painted over each other."""

import heapq
from dataclasses import dataclass

import numpy as np

from aag_cad.units import Floats, Ints

_CELL = 1.6
_TOUCH = 6.0
_MOST_SAMPLES = 200


@dataclass(frozen=True, eq=False)
class Samples:
    """Points spread over faces on the sheet: cell of the sheet, index of the face, distance from the eye; each (n,)."""

    cell: Ints
    face: Ints
    depth: Floats


def _counts(flat: Floats) -> Ints:
    """Return how many samples each face (n, 4, 2) needs along its first and second side, (n, 2): one a cell."""
    sides = np.linalg.norm(flat - np.roll(flat, -1, axis=1), axis=2)
    longest = np.stack([np.maximum(sides[:, 1], sides[:, 3]), np.maximum(sides[:, 0], sides[:, 2])], axis=1)
    return np.clip(np.ceil(longest / _CELL).astype(np.int64), 2, _MOST_SAMPLES)


def _spread(flat: Floats, depth: Floats, counts: Ints) -> tuple[Floats, Floats]:
    """Return places (n, s, 2) and distances (n, s) of counts[0] x counts[1] samples in the middles of their cells."""
    u, v = (g.ravel() for g in np.meshgrid(*((np.arange(n) + 0.5) / n for n in counts.tolist()), indexing="ij"))
    weights = np.stack([(1 - u) * (1 - v), (1 - u) * v, u * v, u * (1 - v)])
    return np.einsum("ncj,cs->nsj", flat, weights), np.asarray(depth @ weights)


def samples_of(flat: Floats, depth: Floats) -> Samples:
    """Return samples of faces with sheet corners (n, 4, 2) and corner distances (n, 4)."""
    counts = _counts(flat)
    kinds, kind = np.unique(counts, axis=0, return_inverse=True)
    places, depths, owners = [], [], []
    for i, pair in enumerate(kinds):
        faces = np.flatnonzero(kind.ravel() == i)
        place, distance = _spread(flat[faces], depth[faces], pair)
        places.append(place.reshape(-1, 2))
        depths.append(distance.ravel())
        owners.append(np.repeat(faces, distance.shape[1]))
    cells = np.floor(np.concatenate(places) / _CELL).astype(np.int64)
    cells -= cells.min(axis=0)
    keys = cells[:, 1] * (cells[:, 0].max() + 1) + cells[:, 0]
    return Samples(keys, np.concatenate(owners), np.concatenate(depths))


def unhidden(samples: Samples) -> Ints:
    """Return the faces of which some sample is nearest to the eye in its cell of the sheet."""
    nearest = np.full(int(samples.cell.max()) + 1, np.inf)
    np.minimum.at(nearest, samples.cell, samples.depth)
    return np.unique(samples.face[samples.depth <= nearest[samples.cell] + _TOUCH])


def covers_of(samples: Samples, count: int) -> Ints:
    """Return pairs (m, 2) of faces, the second of which covers the first in more cells than the other way round."""
    order = np.lexsort((-samples.depth, samples.cell))
    cell, face, depth = samples.cell[order], samples.face[order], samples.depth[order]
    over = (cell[1:] == cell[:-1]) & (face[1:] != face[:-1]) & (depth[:-1] - depth[1:] > _TOUCH)
    far, near = face[:-1][over], face[1:][over]
    low, high = np.minimum(far, near), np.maximum(far, near)
    pairs, where = np.unique(low * count + high, return_inverse=True)
    votes = np.zeros(len(pairs))
    np.add.at(votes, where, np.where(far == low, 1.0, -1.0))
    first, second = pairs // count, pairs % count
    decided = votes != 0.0
    return np.asarray(
        np.column_stack([np.where(votes > 0, first, second), np.where(votes > 0, second, first)])[decided]
    )


def painting_order(covers: Ints, depth: Floats) -> list[int]:
    """Return the faces so that each comes before those that cover it, and else from the farthest to the nearest.

    Where faces cover each other in a circle, the farthest of those left is painted first.
    """
    above: list[list[int]] = [[] for _ in depth]
    open_below = [0] * len(depth)
    for lower, upper in covers.tolist():
        above[lower].append(upper)
        open_below[upper] += 1
    far_first = np.argsort(-depth, kind="stable").tolist()
    rank = [0] * len(depth)
    for place, face in enumerate(far_first):
        rank[face] = place
    ready = [rank[face] for face in far_first if open_below[face] == 0]
    done, next_left = [False] * len(depth), 0
    order: list[int] = []
    while len(order) < len(depth):
        while not ready:
            if not done[far_first[next_left]]:
                ready.append(next_left)
            next_left += 1
        face = far_first[heapq.heappop(ready)]
        if done[face]:
            continue
        done[face] = True
        order.append(face)
        for upper in above[face]:
            open_below[upper] -= 1
            if open_below[upper] == 0 and not done[upper]:
                heapq.heappush(ready, rank[upper])
    return order
