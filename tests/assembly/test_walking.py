"""What is walked on the floor: stacks, paths from stud to stud, and the bounds that no path undercuts."""

import math
from itertools import pairwise, permutations, product

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from spanning import spanning_tree_length

from aag_cad.units import Floats
from assembly.base.shell_axes import best_plane
from assembly.laying.footpath import shorter_path
from assembly.laying.walking import (
    STACK_MARGIN,
    STACK_PACE,
    Line,
    alternated,
    best_stack,
    path_length,
    serpentine,
    stack_places,
    stepped_over,
    sweep_order,
)

# The heuristic has no proven ratio; this is what it keeps on every case that is tried here.
RATIO = 1.15

places = st.tuples(st.integers(0, 40), st.integers(0, 40)).map(lambda p: (250.0 * p[0], 250.0 * p[1]))


def points_of(least: int, most: int) -> st.SearchStrategy[Floats]:
    listed = st.lists(places, min_size=least, max_size=most, unique=True)
    return listed.map(lambda found: np.array(found, dtype=np.float64).reshape(-1, 2))


def serpentine_path(points: Floats) -> list[int]:
    return [i for row in serpentine(points) for i in row]


@given(points_of(0, 60))
def test_a_path_visits_every_stud_once_and_is_never_longer_than_the_serpentine(points: Floats) -> None:
    whole = serpentine_path(points)
    found = shorter_path(points, whole)
    assert sorted(whole) == sorted(found) == list(range(len(points)))
    # Rounding of at most 60 additions of 10 m each.
    assert path_length(points[list(found)]) <= path_length(points[whole]) + 1e-6
    assert spanning_tree_length(points) <= path_length(points[list(found)]) + 1e-6


@settings(max_examples=60)
@given(points_of(2, 7))
def test_the_path_along_few_studs_is_nearly_the_best_of_all_permutations(points: Floats) -> None:
    found = path_length(points[list(shorter_path(points, serpentine_path(points)))])
    ways = np.linalg.norm(points[:, None] - points[None], axis=2).tolist()
    orders = (order for order in permutations(range(len(points))) if order[0] < order[-1])
    assert found <= RATIO * min(sum(ways[a][b] for a, b in pairwise(order)) for order in orders) + 1e-6


@given(points_of(2, 12))
def test_the_spanning_tree_is_that_of_the_complete_graph(points: Floats) -> None:
    graph: nx.Graph[int] = nx.Graph()
    graph.add_weighted_edges_from(
        (i, j, math.dist(points[i], points[j])) for i, j in product(range(len(points)), repeat=2) if i < j
    )
    # Coordinates are rounded to 1 um before.
    assert spanning_tree_length(points) == pytest.approx(nx.minimum_spanning_tree(graph).size("weight"), abs=0.1)


@pytest.mark.parametrize(("across", "up"), [(1, 1), (1, 9), (7, 1), (6, 11)])
def test_a_square_grid_is_walked_without_a_detour(across: int, up: int) -> None:
    """The serpentine along m x n studs of one spacing is a spanning tree itself: m n - 1 spacings."""
    points = np.array([(500.0 * i, 500.0 * j) for i in range(across) for j in range(up)])
    whole = path_length(points[serpentine_path(points)])
    assert whole == pytest.approx(500.0 * (across * up - 1))
    assert spanning_tree_length(points) == pytest.approx(whole)


@given(st.lists(points_of(1, 4), min_size=1, max_size=5))
def test_no_other_turning_of_whole_rows_is_shorter(found: list[Floats]) -> None:
    points = np.vstack(found)
    numbers = iter(range(len(points)))
    rows = [tuple(next(numbers) for _ in row) for row in found]
    turned = alternated(rows, points)
    assert [sorted(row) for row in turned] == [sorted(row) for row in rows]
    ways = product(*((row, row[::-1]) for row in rows))
    best = min(path_length(points[[i for row in way for i in row]]) for way in ways)
    # 1 um for each row is no reason to turn it.
    assert path_length(points[[i for row in turned for i in row]]) == pytest.approx(best, abs=0.01)


@given(points_of(2, 20))
def test_stacks_lie_a_metre_off_the_floor_and_a_metre_apart(points: Floats) -> None:
    found = stack_places(points)
    low, high = points.min(axis=0), points.max(axis=0)
    outside = np.maximum(low - found, found - high).max(axis=1)
    np.testing.assert_allclose(outside, STACK_MARGIN, atol=1e-3)
    for a, b in pairwise([*found, found[0]]):
        assert math.dist(a, b) <= STACK_PACE + 1e-3


@given(points_of(1, 20), points_of(2, 20))
def test_no_other_place_for_a_stack_takes_fewer_metres(calls: Floats, floor: Floats) -> None:
    found = stack_places(floor)
    best = best_stack(found, calls)
    sums = [sum(math.dist(place, call) for call in calls) for place in found]
    assert sums[best] == pytest.approx(min(sums), abs=0.01)


def test_the_stack_of_upright_lines_lies_before_the_middle_one() -> None:
    """Nine lines 1 m apart, 6 m long: 4 m from the middle of the fifth, k m aside of the others, not 1 to 9 m away."""
    middles = np.array([(1000.0 * i, 3000.0) for i in range(9)])
    floor = np.array([(0.0, 0.0), (8000.0, 6000.0)])
    found = stack_places(floor)
    assert found[best_stack(found, middles)].tolist() == [4000.0, -1000.0]


def test_nobody_steps_over_a_line_who_begins_at_the_far_side() -> None:
    lines = [Line((1000.0 * i, 0.0), (1000.0 * i, 6000.0), 6000.0) for i in range(6)]
    from_the_left = stepped_over(lines, (-1000.0, 3000.0))
    assert from_the_left == (6 * 5 // 2, 0)
    assert stepped_over(lines[::-1], (-1000.0, 3000.0)) == from_the_left[::-1]


@given(st.permutations(range(7)), st.floats(0.0, math.pi))
def test_lines_are_swept_from_side_to_side_whatever_their_marks(order: list[int], turn: float) -> None:
    along, across = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
    lines = {}
    for place, number in enumerate(order):
        start, end = 700.0 * place * across, 700.0 * place * across + 5000.0 * along
        ends = (start, end) if number % 2 else (end, start)
        (x, y), (u, v) = (end.tolist() for end in ends)
        lines[f"G-{number}"] = Line((x, y), (u, v), 5000.0)
    swept = [order.index(int(mark[2:])) for mark in sweep_order(lines)]
    assert swept in (sorted(swept), sorted(swept, reverse=True))


def test_a_plank_waits_in_line_beyond_the_end_that_it_is_slid_in_at() -> None:
    line = Line((0.0, 0.0), (3000.0, 4000.0), 5000.0)
    assert line.before("start") == pytest.approx((-1500.0, -2000.0))
    assert line.before("end") == pytest.approx((4500.0, 6000.0))


@given(st.floats(0.0, 1.3), st.floats(0.0, 6.3))
def test_a_tilted_floor_is_seen_square_on(tilt: float, turn: float) -> None:
    flat = np.array([(x, y, 0.0) for x in (0.0, 1000.0, 5000.0) for y in (0.0, 2000.0, 3000.0)])
    lean = np.array([[1.0, 0.0, 0.0], [0.0, np.cos(tilt), -np.sin(tilt)], [0.0, np.sin(tilt), np.cos(tilt)]])
    spin = np.array([[np.cos(turn), -np.sin(turn), 0.0], [np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]])
    points = flat @ lean.T @ spin.T
    axes = best_plane(points)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(axes) > 0.0
    seen = points @ axes[:2].T
    spans = np.linalg.norm(seen[:, None] - seen[None], axis=2)
    # Planes within 3e-5 rad of level are taken for level: 1e-9 of the lengths.
    np.testing.assert_allclose(spans, np.linalg.norm(flat[:, None] - flat[None], axis=2), rtol=1e-6, atol=1e-3)
