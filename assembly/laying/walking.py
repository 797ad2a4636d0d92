"""What is walked when a shell is laid out flat: from stacks beside the floor to the lines, and from stud to stud.

The model of paper section 3.2: a crew carries each beam or geodesic from the stack of its family, 1 m beside the floor,
to the middle of its line and walks back; studs are carried along, and reached one from the next. All points lie on the
floor, (n, 2) mm.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from scipy.spatial import KDTree

from aag_cad.units import Floats

Point: TypeAlias = tuple[float, float]

STACK_MARGIN = 1000.0
STACK_PACE = 1000.0
# Coordinates are rounded to this many decimals of a mm, so that points that are level stay so on every machine.
_DECIMALS = 3
_SAME = 1e-3
_ROW_HEIGHTS = (0.5, 1.5, 3.5)


@dataclass(frozen=True)
class Line:
    """Where a beam or geodesic lies on the floor: from start to end, and how long it is, mm."""

    start: Point
    end: Point
    length: float

    @property
    def middle(self) -> Point:
        """The point midway between its ends."""
        return (self.start[0] + self.end[0]) / 2.0, (self.start[1] + self.end[1]) / 2.0

    def before(self, end: str) -> Point:
        """Return the middle of the piece when it lies in line, outside, before it is slid in at its ``end``."""
        near, far = (self.start, self.end) if end == "start" else (self.end, self.start)
        out = np.subtract(near, far)
        long = float(np.hypot(*out)) or 1.0
        x, y = (np.array(near) + out / long * self.length / 2.0).tolist()
        return x, y


def on_floor(points: Floats) -> Floats:
    """Return points of the floor rounded to 1 um."""
    return np.asarray(np.round(points, _DECIMALS))


def stack_places(points: Floats) -> Floats:
    """Return the places for a stack (m, 2): at most 1 m apart round the rectangle of points, 1 m outside it."""
    low, high = points.min(axis=0) - STACK_MARGIN, points.max(axis=0) + STACK_MARGIN
    corners = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
    sides = []
    for a, b in zip(np.array(corners), np.roll(corners, -1, axis=0), strict=True):
        count = int(np.ceil(np.abs(b - a).max() / STACK_PACE))
        sides.append(a + (b - a) * (np.arange(count) / count)[:, None])
    return on_floor(np.vstack(sides))


def best_stack(places: Floats, calls: Floats) -> int:
    """Return which of the places (m, 2) lies nearest to all calls (k, 2), by the sum of its distances to them.

    A call is a way to the stack or from it. Of equal places the first one counts.
    """
    sums = [float(np.round(np.hypot(*(calls - place).T).sum(), _DECIMALS)) for place in places]
    return int(np.argmin(sums))


def sweep_order(lines: Mapping[str, Line]) -> tuple[str, ...]:
    """Return lines of one run from side to side, across their mean direction, rightwards or else upwards."""
    marks = sorted(lines)
    ends = np.array([np.subtract(lines[mark].end, lines[mark].start) for mark in marks])
    # Lines have no sense: doubled angles add up where the directions of opposite lines would cancel.
    doubled = np.sum((ends[:, 0] + 1j * ends[:, 1]) ** 2) if marks else 0j
    turn = np.angle(doubled) / 2.0
    along = np.array([np.cos(turn), np.sin(turn)])
    across = np.array([along[1], -along[0]])
    across *= 1.0 if (round(across[0], 6), across[1]) > (0.0, 0.0) else -1.0
    middles = np.array([lines[mark].middle for mark in marks]).reshape(-1, 2)
    keys = np.round(np.column_stack([middles @ across, middles @ along]), 1).tolist()
    return tuple(mark for _, mark in sorted(zip(keys, marks, strict=True)))


def _crossed(stack: Floats, target: Floats, starts: Floats, ends: Floats) -> Floats:
    """Return 1.0 for each line from starts to ends (n, 2) that the straight way from the stack to a target crosses."""

    def side(a: Floats, b: Floats, c: Floats) -> Floats:
        u, v = b - a, c - a
        return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])

    apart = side(stack, target, starts) * side(stack, target, ends) < 0.0
    return np.asarray(apart & (side(starts, ends, stack) * side(starts, ends, target) < 0.0), dtype=np.float64)


def stepped_over(order: Sequence[Line], stack: Point) -> tuple[int, int]:
    """Return how many laid lines people step over on their ways to a run: laid in this order, and in the other."""
    starts, ends = (np.array([getattr(line, end) for line in order]).reshape(-1, 2) for end in ("start", "end"))
    forward = backward = 0.0
    for i, line in enumerate(order):
        crossed = _crossed(np.array(stack), np.array(line.middle), starts, ends)
        forward += crossed[:i].sum()
        backward += crossed[i + 1 :].sum()
    return int(forward), int(backward)


def path_length(points: Floats) -> float:
    """Return the length of the path along points (n, 2) in their order, mm."""
    return float(np.hypot(*np.diff(points, axis=0).T).sum()) if len(points) > 1 else 0.0


def _bands(values: Floats, others: Floats, height: float) -> tuple[tuple[int, ...], ...]:
    """Return indices in bands of at most a height by rising values, each band sorted by the others."""
    order = np.lexsort((others, values))
    bands: list[list[int]] = []
    for i in order.tolist():
        if bands and values[i] - values[bands[-1][0]] <= height:
            bands[-1].append(i)
        else:
            bands.append([i])
    return tuple(tuple(sorted(band, key=lambda i: (others[i], i))) for band in bands)


def alternated(rows: Sequence[Sequence[int]], points: Floats) -> tuple[tuple[int, ...], ...]:
    """Return whole rows in their order, each forwards or backwards so that the path along all of them is shortest.

    The first row stays as it is if that is no longer. Exact: the best way on from each end of each row is known, from
    the last row back to the first.
    """

    def step(a: int, b: int) -> float:
        return math.dist(points[a], points[b])

    turns, ahead = list[tuple[int, int]](), (0.0, 0.0)
    for row, above in pairwise(rows[::-1]):
        ends = enumerate((row[0], row[-1]))
        ways = [(step(above[-1], enter) + ahead[j], step(above[0], enter) + ahead[j]) for j, enter in ends]
        totals = list(zip(*ways, strict=True))
        # A way that is not shorter by 1 um is no better: rounding must not turn the rows.
        chosen = [int(total[1] < total[0] - _SAME) for total in totals]
        turns.append((chosen[0], chosen[1]))
        ahead = totals[0][chosen[0]], totals[1][chosen[1]]
    way = int(ahead[1] < ahead[0] - _SAME)
    found = []
    for row in rows:
        found.append(tuple(row[::-1] if way else row))
        way = turns.pop()[way] if turns else way
    return tuple(found)


def serpentine(points: Floats) -> tuple[tuple[int, ...], ...]:
    """Return points (n, 2) in rows or in columns, walked to and fro: the shortest of six such ways.

    Rows and columns are as high as half the usual distance from a point to its nearest, which keeps the rows of a
    regular pattern apart, or three times that, which takes two rows of a rhombic pattern in zigzag, or seven times,
    which suits scattered points (strips of width 1.7 over the root of their density: Daganzo 1984).
    """
    if len(points) < 2:
        return tuple((i,) for i in range(len(points)))
    spacing = float(np.median(np.asarray(KDTree(points).query(points, k=2)[0])[:, 1])) or 1.0
    best: tuple[float, tuple[tuple[int, ...], ...]] | None = None
    for share in _ROW_HEIGHTS:
        for axis in (1, 0):
            rows = alternated(_bands(points[:, axis], points[:, 1 - axis], share * spacing), points)
            long = path_length(points[[i for row in rows for i in row]])
            if best is None or long < best[0] - _SAME:
                best = long, rows
    assert best is not None
    return best[1]
