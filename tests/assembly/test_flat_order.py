"""The flat layout: lower beams, geodesics, upper beams, each from side to side, then the studs on the shortest path."""

import math
from itertools import pairwise

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from spanning import spanning_tree_length

from aag_cad.parts.marks import parse_mark
from aag_cad.parts.model import Gridshell, Shell
from assembly.base.errors import PlanError
from assembly.base.shell_axes import shell_view, sweep_direction
from assembly.graph.files import graph_text, read_graph
from assembly.graph.gridshell_graph import assembly_graph
from assembly.graph.interlacing import Interlacing, interlacing
from assembly.laying.order import FlatOrder, courses, flat_order_of, flat_orders, groups_of, row_groups, stud_rows
from assembly.laying.walking import path_length


@pytest.fixture(scope="module")
def orders(gridshell: Gridshell) -> dict[str, FlatOrder]:
    return flat_orders(gridshell)


@pytest.fixture(scope="module")
def order(orders: dict[str, FlatOrder]) -> FlatOrder:
    """The order of laying the first shell."""
    return orders["S1"]


def test_a_shell_is_laid_in_three_runs(order: FlatOrder) -> None:
    runs = order.runs
    assert [{parse_mark(mark).family for mark in run} for run in runs] == [{"A1"}, {"G"}, {"A2"}]


def test_all_beams_and_geodesics_are_laid_once_and_no_edge_plank(shell: Shell, order: FlatOrder) -> None:
    laid = [mark for run in order.runs for mark in run]
    assert sorted(laid) == sorted({plank.beam or plank.mark for plank in shell.planks if plank.family != "E"})


def test_what_lies_below_comes_first_at_every_crossing(shell: Shell, order: FlatOrder) -> None:
    turn = {mark: i for i, mark in enumerate(mark for run in order.runs for mark in run)}
    planks = {plank.mark: plank for plank in shell.planks}
    for joint in shell.joints:
        crossing = [planks[mark] for mark in joint.members if mark in planks and planks[mark].family != "E"]
        upwards = sorted(crossing, key=lambda plank: plank.layer)
        turns = [turn[plank.beam or plank.mark] for plank in upwards]
        assert turns == sorted(turns)


def test_each_run_goes_across_the_shell_from_neighbour_to_neighbour(order: FlatOrder) -> None:
    for run in order.runs:
        assert list(run) in (sorted(run), sorted(run, reverse=True))


def test_the_vault_is_laid_from_three_stacks_before_its_foot(shell: Shell, order: FlatOrder) -> None:
    """The middles of all lines lie nearer to the foot line than to the sides."""
    axes = shell_view(shell).axes[:2]
    feet = [float(axes[1] @ np.array(joint.point)) for joint in shell.joints if joint.kind == "foot"]
    assert sorted(order.stacks) == [("S1", "A1"), ("S1", "A2"), ("S1", "G")]
    assert all(place[1] < min(feet) - 900.0 for place in order.stacks.values())
    assert order.slides == ()


def test_the_crew_of_the_vault_walks_hardly_more_than_the_least(shell: Shell, order: FlatOrder) -> None:
    """Measured: 294.9 m of at least 289.9 m; with single rows of studs it was 322.6 m."""
    axes = shell_view(shell).axes[:2]
    curves = {item.mark: item.curve for item in (*shell.beams, *shell.planks)}
    carried = 0.0
    for mark in (mark for run in order.runs for mark in run):
        middle = curves[mark].point_spline(np.array([0.0, curves[mark].length])).mean(axis=0) @ axes.T
        carried += 2.0 * math.dist(order.stacks["S1", parse_mark(mark).family], middle)
    studs = {stud.mark: np.array(stud.frame.origin) @ axes.T for stud in shell.studs}
    path = np.array([studs[mark] for row in order.rows for mark in row])
    walked, least = carried + path_length(path), carried + spanning_tree_length(path)
    assert walked == pytest.approx(294_900.0, abs=100.0)
    assert least <= walked <= 1.02 * least


def test_the_sweep_begins_at_the_first_geodesic(shell: Shell) -> None:
    across = sweep_direction(shell)
    flat = sorted((plank for plank in shell.planks if plank.family == "G"), key=lambda plank: plank.mark)
    middles = [float(plank.curve.point_spline(plank.curve.length / 2.0) @ across) for plank in flat]
    assert middles == sorted(middles)


def test_the_view_is_right_handed_with_the_foot_at_the_bottom(shell: Shell) -> None:
    axes = shell_view(shell).axes
    # Rotations are orthonormal to rounding.
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) > 0.0
    up = {joint.mark: float(axes[1] @ np.array(joint.point)) for joint in shell.joints}
    feet = [up[joint.mark] for joint in shell.joints if joint.kind == "foot"]
    assert max(feet) < np.mean(list(up.values()))


def test_rows_of_studs_rise_from_the_foot_and_each_row_is_level(shell: Shell) -> None:
    rows = stud_rows(shell)
    height = {stud.mark: stud.frame.origin[2] for stud in shell.studs}
    assert sorted(mark for row in rows for mark in row) == sorted(height)
    for row, above in pairwise(rows):
        assert max(height[mark] for mark in row) < min(height[mark] for mark in above)
    for row in rows:
        # The rows of the vault are circles about a vertical axis.
        assert np.ptp([height[mark] for mark in row]) < 1e-6


def test_two_close_rows_of_the_vault_are_set_in_zigzag(shell: Shell, order: FlatOrder) -> None:
    rows, walked = stud_rows(shell), order.rows
    pairs = [sorted(mark for row in rows[i : i + 2] for mark in row) for i in range(0, len(rows), 2)]
    assert [sorted(row) for row in walked] == pairs
    direction = sweep_direction(shell)
    along = {stud.mark: float(np.array(stud.frame.origin) @ direction) for stud in shell.studs}
    ways = [along[row[-1]] > along[row[0]] for row in walked]
    assert all(way != after for way, after in pairwise(ways))


def test_rows_far_apart_are_walked_one_by_one() -> None:
    places = {f"{i}.{j}": (400.0 * j, 1000.0 * i) for i in range(4) for j in range(5)}
    rows = [[f"{i}.{j}" for j in range(5)] for i in range(4)]
    assert courses(rows, places) == tuple(tuple(row[:: 1 if i % 2 == 0 else -1]) for i, row in enumerate(rows))
    assert courses(rows[:1], places) == (tuple(rows[0]),)


@pytest.fixture(scope="module")
def graph(gridshell: Gridshell) -> "nx.MultiGraph[str]":
    return assembly_graph(gridshell)


@pytest.fixture(scope="module")
def woven(graph: "nx.MultiGraph[str]") -> Interlacing:
    return interlacing(graph)


def test_the_graph_of_the_vault_is_laid_as_its_shells_are(
    gridshell: Gridshell, graph: "nx.MultiGraph[str]", woven: Interlacing, orders: dict[str, FlatOrder]
) -> None:
    order = flat_order_of(graph, woven)
    assert order.runs == tuple(run for shell in gridshell.shells for run in orders[shell.mark].runs)


def test_edge_planks_are_laid_only_when_asked_for(graph: "nx.MultiGraph[str]", woven: Interlacing) -> None:
    laid = {unit for run in flat_order_of(graph, woven, later=()).runs for unit in run}
    without = {unit for run in flat_order_of(graph, woven).runs for unit in run}
    assert {parse_mark(mark).family for mark in laid - without} == {"E"}


def test_planks_that_are_slid_in_come_last() -> None:
    graph = read_graph(graph_text("kagome"))
    woven = interlacing(graph)
    order = flat_order_of(graph, woven)
    slid = {slide.unit for slide in woven.slides}
    assert slid
    assert order.slides == woven.slides
    assert sorted(unit for run in order.runs for unit in run) == sorted(set(graph) - slid)


def test_what_cannot_be_laid_is_in_no_run() -> None:
    graph = read_graph(graph_text("impossible"))
    woven = interlacing(graph)
    assert woven.left_out
    laid = {unit for run in flat_order_of(graph, woven).runs for unit in run}
    assert laid == set(graph) - set(woven.left_out)


def test_a_circle_that_is_not_interlaced_is_refused_by_its_marks() -> None:
    graph = read_graph(graph_text("kagome"))
    woven = interlacing(graph)
    circle = nx.DiGraph(woven.precedence)
    one, other = next(iter(woven.precedence.edges))
    circle.add_edge(other, one)
    with pytest.raises(PlanError, match=f"{min(one, other)}.*circle"):
        flat_order_of(graph, Interlacing(woven.overlaps, circle, (), (), ()))


@given(st.lists(st.integers(), max_size=60), st.integers(1, 12))
def test_groups_keep_the_order_and_are_as_even_as_can_be(items: list[int], most: int) -> None:
    groups = groups_of(items, most)
    assert [item for group in groups for item in group] == items
    sizes = [len(group) for group in groups]
    assert all(0 < size <= most for size in sizes)
    assert not sizes or max(sizes) - min(sizes) <= 1
    assert len(groups) == -(-len(items) // most)


@given(st.lists(st.integers(1, 40), min_size=1, max_size=20), st.integers(1, 24))
def test_rows_are_grouped_whole_in_their_order(sizes: list[int], most: int) -> None:
    rows = [tuple(f"{i}.{j}" for j in range(size)) for i, size in enumerate(sizes)]
    groups = row_groups(rows, most)
    assert [mark for group in groups for row in group for mark in row] == [mark for row in rows for mark in row]
    assert all(groups)
    # A group may overshoot by no more than half a piece at either end.
    assert all(sum(len(row) for row in group) <= 2 * most for group in groups)
