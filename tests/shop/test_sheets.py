"""Strips on sheets: each strip lies whole on one sheet, clear of the others, its ribs along the sheet."""

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aag_cad.parts.triangles import polygon_area
from aag_cad.shop.sheets import SheetPlan, SheetRules, sheet_plan
from aag_cad.units import Floats

RULES = SheetRules(980.0, (3000.0, 4000.0, 5000.0, 6000.0, 7000.0), 5.0)
Strips = list[tuple[str, Floats]]


def strip(length: float, foot: float, top: float, hollow: float = 0.0) -> Floats:
    """Return a strip from its foot to its top width with both long edges hollow by so much in the middle."""
    x = np.linspace(0.0, length, 41)
    half = (foot + (top - foot) * x / length) / 2.0 - 4.0 * hollow * x * (length - x) / length**2
    return np.concatenate([np.column_stack([x, -half]), np.column_stack([x, half])[::-1]])


def lying(plan: SheetPlan, strips: Strips) -> dict[int, dict[str, Floats]]:
    """Return the outlines as they lie on each sheet."""
    of = dict(strips)
    return {
        number: {
            placed.mark: (-of[placed.mark] if placed.turned else of[placed.mark]) + np.array([placed.x, placed.y])
            for placed in sheet.strips
        }
        for number, sheet in enumerate(plan.sheets)
    }


def inside(points: Floats, outline: Floats) -> np.ndarray:
    """Return whether points (n, 2) lie inside an outline (m, 2): a ray crosses it an odd number of times."""
    a, b = outline, np.roll(outline, -1, axis=0)
    above = (a[:, 1] > points[:, 1:2]) != (b[:, 1] > points[:, 1:2])
    with np.errstate(divide="ignore", invalid="ignore"):
        x = a[:, 0] + (points[:, 1:2] - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
    return np.asarray((above & (points[:, :1] < x)).sum(axis=1) % 2 == 1)


def check(plan: SheetPlan, strips: Strips, rules: SheetRules) -> None:
    placed = [placed.mark for sheet in plan.sheets for placed in sheet.strips]
    assert sorted(placed) == sorted(mark for mark, _ in strips if mark not in plan.refused)
    for number, outlines in lying(plan, strips).items():
        for outline in outlines.values():
            assert outline.min() >= -1e-6
            assert outline[:, 0].max() <= plan.sheets[number].length + 1e-6
            assert outline[:, 1].max() <= rules.width + 1e-6
        for first, second in combinations(outlines.values(), 2):
            assert not inside(first, second).any()
            assert not inside(second, first).any()
            gaps = np.linalg.norm(first[:, None] - second[None], axis=2)
            # The gap is kept across or along the ribs; at an edge as steep as 1 in 4 it is 0.97 of that.
            assert gaps.min() >= 0.97 * rules.gap
    assert plan.bound <= plan.bought + 1e-6


def test_a_strip_comes_from_the_shortest_sheet_that_holds_it() -> None:
    plan = sheet_plan([("S1-P-01", strip(3650.0, 410.0, 700.0, 8.0))], RULES)
    assert [sheet.length for sheet in plan.sheets] == [4000.0]
    assert plan.proven


def test_two_narrow_strips_lie_side_by_side() -> None:
    strips = [("S1-P-01", strip(3600.0, 480.0, 480.0)), ("S1-P-02", strip(3800.0, 490.0, 490.0))]
    plan = sheet_plan(strips, RULES)
    check(plan, strips, RULES)
    assert [(sheet.length, len(sheet.strips)) for sheet in plan.sheets] == [(4000.0, 2)]
    assert plan.first_fit_decreasing == 8000.0


def test_wedges_fit_only_when_one_is_turned_end_for_end() -> None:
    """One edge square to the ends of 410 and 560 mm: 1120 mm side by side, but 970 turned, and 5 mm gap."""
    wedge = np.array([[0.0, 0.0], [3800.0, 0.0], [3800.0, 560.0], [0.0, 410.0]])
    strips = [(f"S1-P-{i:02d}", wedge) for i in (1, 2)]
    plan = sheet_plan(strips, RULES)
    check(plan, strips, RULES)
    (sheet,) = plan.sheets
    assert sorted(placed.turned for placed in sheet.strips) == [False, True]
    assert len(sheet_plan(strips, SheetRules(974.0, RULES.lengths, 5.0)).sheets) == 2


def test_hollow_edges_leave_no_room_where_the_ends_meet() -> None:
    """Hollow by 30 mm the strips are narrower in the middle, but their ends still meet: 980 mm hold 487 twice."""
    ends = [[("S1-P-01", strip(3800.0, w, w, 30.0)), ("S1-P-02", strip(3800.0, w, w, 30.0))] for w in (487.0, 488.0)]
    assert [len(sheet_plan(strips, RULES).sheets) for strips in ends] == [1, 2]


def test_short_strips_follow_one_another_on_a_long_sheet() -> None:
    """Two of 3497 and a gap of 5 are 6999 mm: one sheet of 7 m, not two of 4 m."""
    strips = [(f"S1-P-{i:02d}", strip(3497.0, 600.0, 700.0)) for i in (1, 2)]
    plan = sheet_plan(strips, RULES)
    check(plan, strips, RULES)
    assert [sheet.length for sheet in plan.sheets] == [7000.0]


def test_strips_that_no_sheet_holds_are_named() -> None:
    strips = [
        ("S1-P-01", strip(4000.0, 500.0, 990.0)),
        ("S1-P-02", strip(7500.0, 500.0, 700.0)),
        ("S1-P-03", strip(4000.0, 500.0, 700.0)),
    ]
    plan = sheet_plan(strips, RULES)
    assert plan.refused == ("S1-P-01", "S1-P-02")
    check(plan, strips, RULES)


def test_three_shells_of_thirteen_strips_are_proven() -> None:
    lengths = (3550, 3600, 3700, 3850, 4000, 4200, 4400, 4200, 4000, 3850, 3700, 3600, 3550)
    strips = [
        (f"S{shell}-P-{i:02d}", strip(float(length), 400.0, 430.0 + (length - 3550) * 0.3, 8.0))
        for shell in (1, 2, 3)
        for i, length in enumerate(lengths, start=1)
    ]
    plan = sheet_plan(strips, RULES)
    check(plan, strips, RULES)
    assert plan.proven
    assert len(plan.sheets) < 39
    assert plan.bought < plan.first_fit_decreasing
    total = sum(polygon_area(outline) for _, outline in strips)
    assert plan.waste_percent == pytest.approx(100.0 * (1.0 - total / (980.0 * plan.bought)))
    assert sheet_plan(strips[::-1], RULES) == plan


def test_no_strips_need_no_sheets() -> None:
    plan = sheet_plan([], RULES)
    assert (plan.sheets, plan.bought, plan.waste_percent) == ((), 0.0, 0.0)


@settings(max_examples=25)
@given(
    sizes=st.lists(
        st.tuples(st.integers(900, 4000), st.integers(200, 700), st.integers(200, 700), st.integers(0, 30)),
        min_size=1,
        max_size=6,
    )
)
def test_any_strips_lie_on_their_sheets_without_touching(sizes: list[tuple[int, int, int, int]]) -> None:
    strips = [(f"S1-P-{i + 1:02d}", strip(*(float(v) for v in size))) for i, size in enumerate(sizes)]
    plan = sheet_plan(strips, RULES)
    check(plan, strips, RULES)
    assert plan.bought <= plan.first_fit_decreasing
