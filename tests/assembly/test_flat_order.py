"""The flat layout: lower beams, geodesics, upper beams, studs, each across the shell in the order of the marks."""

from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from aag_cad.parts.marks import parse_mark
from aag_cad.parts.model import Shell
from assembly.flat import flat_order, groups_of, row_groups
from assembly.view import shell_view, sweep_direction


def test_a_shell_is_laid_in_three_runs(shell: Shell) -> None:
    runs = flat_order(shell).runs
    assert [{parse_mark(mark).family for mark in run} for run in runs] == [{"A1"}, {"G"}, {"A2"}]


def test_all_beams_and_geodesics_are_laid_once_and_no_edge_plank(shell: Shell) -> None:
    laid = [mark for run in flat_order(shell).runs for mark in run]
    assert sorted(laid) == sorted({plank.beam or plank.mark for plank in shell.planks if plank.family != "E"})


def test_what_lies_below_comes_first_at_every_crossing(shell: Shell) -> None:
    turn = {mark: i for i, mark in enumerate(mark for run in flat_order(shell).runs for mark in run)}
    planks = {plank.mark: plank for plank in shell.planks}
    for joint in shell.joints:
        crossing = [planks[mark] for mark in joint.members if mark in planks and planks[mark].family != "E"]
        order = sorted(crossing, key=lambda plank: plank.layer)
        turns = [turn[plank.beam or plank.mark] for plank in order]
        assert turns == sorted(turns)


def test_each_run_goes_across_the_shell_in_the_order_of_its_marks(shell: Shell) -> None:
    for run in flat_order(shell).runs:
        assert list(run) == sorted(run)


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
    rows = flat_order(shell).rows
    height = {stud.mark: stud.frame.origin[2] for stud in shell.studs}
    assert sorted(mark for row in rows for mark in row) == sorted(height)
    for row, above in pairwise(rows):
        assert max(height[mark] for mark in row) < min(height[mark] for mark in above)
    for row in rows:
        # The rows of the vault are circles about a vertical axis.
        assert np.ptp([height[mark] for mark in row]) < 1e-6


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
