"""A shorter path along points: crossings undone (2-opt) and short pieces moved (Or-opt) until nothing helps.

Croes 1958, Or 1976; each point tries only its nearest ones (Bentley 1992), and no move turns more than a bounded piece
of the path, so that the time grows with the number of points.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot

import numpy as np
from scipy.spatial import KDTree

from aag_cad.units import Floats

NEAREST = 8
LONGEST_TURN = 1000
LONGEST_PIECE = 3
# mm; what gains less is rounding.
_GAIN = 1e-6


@dataclass(frozen=True)
class _Path:
    """The points, the nearest ones of each, the path along them and the place of each in it; -1 is beyond an end."""

    x: list[float]
    y: list[float]
    near: list[list[int]]
    points: list[int]
    places: list[int]

    def gap(self, a: int, b: int) -> float:
        """Return the distance of two points; nobody walks beyond an end."""
        return 0.0 if a < 0 or b < 0 else hypot(self.x[a] - self.x[b], self.y[a] - self.y[b])

    def at(self, place: int) -> int:
        """Return the point at a place of the path."""
        return self.points[place] if 0 <= place < len(self.points) else -1


def _put(path: _Path, first: int, piece: list[int]) -> None:
    path.points[first : first + len(piece)] = piece
    for place, point in enumerate(piece, start=first):
        path.places[point] = place


def _uncross(path: _Path, a: int) -> tuple[int, ...]:
    """Turn a piece of the path round if that makes a way from a shorter; return the points at the changed ways."""
    i = path.places[a]
    for side in (1, -1):
        b = path.at(i + side)
        way = path.gap(a, b)
        for c in path.near[a]:
            if way - path.gap(a, c) <= _GAIN:
                break
            j = path.places[c]
            e = path.at(j + side)
            if path.gap(a, c) + path.gap(b, e) - way - path.gap(c, e) >= -_GAIN:
                continue
            first, last = (min(i, j) + 1, max(i, j)) if side == 1 else (min(i, j), max(i, j) - 1)
            if last - first < LONGEST_TURN:
                _put(path, first, path.points[first : last + 1][::-1])
                return a, b, c, e
    return ()


def _shift(path: _Path, i: int, k: int, gap: int, piece: list[int]) -> bool:
    """Put a piece, now at places i to k, between the places gap and gap + 1; False if that is too far away."""
    if gap > k:
        if gap - i >= LONGEST_TURN:
            return False
        _put(path, i, path.points[k + 1 : gap + 1] + piece)
    else:
        if k - gap > LONGEST_TURN:
            return False
        _put(path, gap + 1, piece + path.points[gap + 1 : i])
    return True


def _move(path: _Path, a: int) -> tuple[int, ...]:
    """Move a piece of up to three points that ends at a, next to a near point, if that helps; return who is touched."""
    here, count = path.places[a], len(path.points)
    for more in range(LONGEST_PIECE):
        for i, k in ((here, here + more), (here - more, here))[: 2 if more else 1]:
            if i < 0 or k >= count:
                continue
            b, p, q = path.points[k if i == here else i], path.at(i - 1), path.at(k + 1)
            saved = path.gap(p, path.points[i]) + path.gap(path.points[k], q) - path.gap(p, q)
            for c in path.near[a]:
                if saved - path.gap(a, c) <= _GAIN:
                    break
                j = path.places[c]
                if i <= j <= k:
                    continue
                for side in (1, -1):
                    f = path.at(j + side)
                    if i <= j + side <= k or path.gap(a, c) + path.gap(b, f) - path.gap(c, f) >= saved - _GAIN:
                        continue
                    piece = path.points[i : k + 1]
                    starts_at_a = side == 1
                    if (piece[0] == a) != starts_at_a:
                        piece = piece[::-1]
                    if _shift(path, i, k, j if side == 1 else j - 1, piece):
                        return a, b, p, q, c, f
    return ()


def shorter_path(points: Floats, path: Sequence[int]) -> tuple[int, ...]:
    """Return a path along all points (n, 2), no longer than a given one (their indices in order), free at both ends."""
    count = len(path)
    if count < 3:
        return tuple(path)
    nearest = np.asarray(KDTree(points).query(points, k=min(count, NEAREST + 1))[1])
    places = [0] * count
    for place, point in enumerate(path):
        places[point] = place
    x, y = points.T.tolist()
    walk = _Path(x, y, [[b for b in near if b != a] for a, near in enumerate(nearest.tolist())], list(path), places)
    waiting, queued = deque(path), [True] * count
    while waiting:
        a = waiting.popleft()
        queued[a] = False
        touched = _uncross(walk, a) or _move(walk, a)
        for point in touched:
            if point >= 0 and not queued[point]:
                queued[point] = True
                waiting.append(point)
    return tuple(walk.points)
