"""Where a segment is slung and propped, and what keeps it stiff until it is joined again."""

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Literal

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from aag_cad.units import Floats
from assembly.base.segments import Brace, Lifting

LEAST_MARGIN = 100.0
STIFF_GEODESICS = 3
_MOST_STUDS = 60
_PROPPED = 16
_OVERHANG = 100.0
# A triangle of which twice the area is below this part of its longest side squared is a line in plan.
_FLAT = 1e-6


def _margins(corners: Floats, centre: Floats) -> tuple[Floats, Floats]:
    """Return for triangles (n, 3, 3) how far inside the plumb line of a point is (n,), and their planes' height there.

    The margin is negative where the plumb line is outside; the height above the point is nan where a triangle is
    upright.
    """
    plan, point = corners[:, :, :2], centre[:2]
    sides = np.roll(plan, -1, axis=1) - plan
    to_point = point - plan
    twice = sides[:, :, 0] * to_point[:, :, 1] - sides[:, :, 1] * to_point[:, :, 0]
    lengths = np.linalg.norm(sides, axis=2)
    area = twice.sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        margins = (np.sign(area)[:, None] * twice / lengths).min(axis=1)
        weights = np.roll(twice, -1, axis=1) / area[:, None]
        heights = (weights * corners[:, :, 2]).sum(axis=1) - centre[2]
    flat = np.abs(area) > _FLAT * lengths.max(axis=1) ** 2
    return np.where(flat & np.isfinite(margins), margins, -np.inf), heights


def lifting_points(studs: Mapping[str, Floats], centre: Floats) -> Lifting:
    """Return the three joints that hold a centre of gravity (3,) best: above it if they can, then with most margin.

    Points are in vault coordinates, z up. Of more than 60 studs evenly many are tried.
    """
    marks = sorted(studs)
    marks = marks[:: -(-len(marks) // _MOST_STUDS)] if marks else marks
    triples = np.array(list(combinations(range(len(marks)), 3)), dtype=np.int64).reshape(-1, 3)
    if not len(triples):
        return Lifting((), -np.inf, False)
    points = np.array([studs[mark] for mark in marks])
    margins, heights = _margins(points[triples], centre)
    above = (margins >= LEAST_MARGIN) & (np.nan_to_num(heights, nan=-1.0) > 0.0)
    tried = np.where(above, margins, -np.inf) if above.any() else margins
    best = int(np.argmax(np.round(tried, 3)))
    if margins[best] < LEAST_MARGIN:
        return Lifting((), float(margins[best]), False)
    return Lifting(tuple(marks[i] for i in triples[best].tolist()), float(margins[best]), bool(above[best]))


def margin_inside(plan: Floats, point: Floats) -> float:
    """Return how far inside the convex hull of points (n, 2) a point (2,) is, mm; negative outside."""
    try:
        sides = ConvexHull(plan).equations
    except QhullError:
        return -np.inf
    return float(-(sides[:, :2] @ point + sides[:, 2]).max())


def standing_margin(feet: Sequence[Floats], props: Sequence[Floats], centre: Floats) -> float:
    """Return how far the plumb line of a centre (3,) runs inside feet and props (3,), in plan, mm; negative outside."""
    return margin_inside(np.array([point[:2] for point in (*feet, *props)]).reshape(-1, 2), centre[:2])


def standing_props(
    feet: Sequence[Floats], studs: Mapping[str, Floats], blocks: Mapping[str, Floats], centre: Floats
) -> tuple[str, ...]:
    """Return the joints under which props hold what stands on its feet: two studs if any two of them do.

    The plumb line of the centre of gravity (3,) runs inside feet and props with most margin in plan, of the sixteen
    highest studs; of like pairs the higher one. Where no two studs hold it, two of all studs and blocks, then three.
    Points (3,) with z up; none without feet or two studs.
    """
    highest = sorted(studs, key=lambda mark: (-round(float(studs[mark][2]), 3), mark))[:_PROPPED]
    if not feet or len(highest) < 2:
        return ()
    points = dict(studs) | dict(blocks)

    def margin(marks: tuple[str, ...]) -> float:
        return round(standing_margin(feet, [points[mark] for mark in marks], centre), 0)

    def worth(marks: tuple[str, ...]) -> tuple[float, float]:
        return margin(marks), round(sum(float(points[mark][2]) for mark in marks), 3)

    best: tuple[str, ...] = max(combinations(highest, 2), key=worth)
    for count in (2, 3):
        if margin(best) <= 0:
            best = max(combinations(_outer(points), count), key=worth, default=best)
    return best


def _outer(points: Mapping[str, Floats]) -> list[str]:
    """Return the joints at the corners of the convex hull of all, in plan: no others hold a plumb line better."""
    marks = sorted(points)
    plan = np.array([points[mark][:2] for mark in marks])
    try:
        corners = np.sort(ConvexHull(plan).vertices)
    except QhullError:
        return marks
    return [marks[int(i)] for i in corners]


def _between(kind: Literal["bar", "tie", "diagonal"], start: str, end: str, studs: Mapping[str, Floats]) -> Brace:
    span = float(np.linalg.norm(studs[end] - studs[start]))
    return Brace(kind, start, end, round(span + 2.0 * _OVERHANG, 1))


def braces(
    points: Mapping[str, Floats],
    columns: Mapping[int, list[str]],
    cut_sides: Mapping[int, bool],
    ends: tuple[list[str], list[str]],
) -> tuple[Brace, ...]:
    """Return the temporary bracing of a segment.

    ``points`` are joints in vault coordinates; ``columns`` the studs of each bay from the lowest to the highest;
    ``cut_sides`` the bays beside a cut, and whether the geodesic of the line stays there. Each cut gets a tie, and a
    bar where its geodesic is missing. ``ends`` are the outermost columns of a segment with fewer than three geodesics,
    else empty: it gets two diagonals, because a grid of beams alone is a mechanism.
    """
    found = []
    for bay, keeps in cut_sides.items():
        column = columns.get(bay, [])
        if len(column) > 1:
            found += [] if keeps else [_between("bar", column[0], column[-1], points)]
            found.append(_between("tie", column[0], column[-1], points))
    if all(ends):
        first, last = ends
        found += [_between("diagonal", a, b, points) for a, b in ((first[0], last[-1]), (first[-1], last[0]))]
    return tuple(found)
