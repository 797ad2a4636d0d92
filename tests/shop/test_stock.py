"""Cutting stock: every piece is cut, no board is overfilled, and no plan buys less."""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aag_cad.design import Design
from aag_cad.parts.model import Gridshell
from aag_cad.shop.finger_joints import board_rules, plank_pieces
from aag_cad.shop.stock import CuttingPlan, Piece, StockRules, cutting_plan, grouped_pieces


def pieces(*lengths: float) -> list[Piece]:
    return [Piece(f"P{i:03d}", length) for i, length in enumerate(lengths)]


def demand(counts: dict[float, int]) -> list[Piece]:
    return pieces(*(length for length, count in counts.items() for _ in range(count)))


def partitions(items: Sequence[Any]) -> Iterator[list[list[Any]]]:
    """Yield every way to put items into heaps."""
    if not items:
        yield []
        return
    for rest in partitions(items[1:]):
        for i, heap in enumerate(rest):
            yield [*rest[:i], [items[0], *heap], *rest[i + 1 :]]
        yield [[items[0]], *rest]


def price(cuts: Sequence[float], rules: StockRules) -> float:
    """Return the length of the shortest stock for the cuts of one board, or infinity."""
    filled = 2.0 * rules.trim + sum(cuts) + rules.kerf * (len(cuts) - 1)
    return min((length for length in rules.lengths if length >= filled - 1e-6), default=math.inf)


def least_by_trial(lengths: Sequence[float], rules: StockRules) -> float:
    """Return the least that any plan buys: every grouping of planks to cuts, every packing of cuts on boards."""
    return min(
        sum(price(board, rules) for board in boards)
        for groups in partitions(lengths)
        if all(len(group) <= rules.planks_per_board for group in groups)
        for boards in partitions([max(group) for group in groups])
    )


def check(plan: CuttingPlan, wanted: Sequence[Piece], rules: StockRules) -> None:
    cut = [piece for board in plan.boards for place in board.cuts for piece in place.pieces]
    assert Counter(cut) + Counter(plan.refused) == Counter(wanted)
    for board in plan.boards:
        assert board.length in rules.lengths
        at = rules.trim
        for place in board.cuts:
            assert place.position == pytest.approx(at, abs=1e-6)
            assert 1 <= len(place.pieces) <= rules.planks_per_board
            assert place.length == max(piece.length for piece in place.pieces)
            at = place.position + place.length + rules.kerf
        assert at - rules.kerf + rules.trim <= board.length + 1e-6
    area = sum(piece.length for piece in cut) / rules.planks_per_board
    assert area <= plan.bought + 1e-6
    assert plan.bound <= plan.bought <= plan.first_fit_decreasing
    assert plan.waste == pytest.approx(plan.bought - area)


def test_the_rolls_of_chvatal() -> None:
    """Chvatal, Linear Programming (1983), chapter 13: rolls of 100 inches, relaxation 452.25, optimum 453."""
    plan = cutting_plan(demand({45.0: 97, 36.0: 610, 31.0: 395, 14.0: 211}), StockRules((100.0,), 0.0, 0.0))
    assert plan.relaxation == pytest.approx(45225.0)
    assert (plan.bought, plan.bound, plan.proven) == (45300.0, 45300.0, True)


def test_the_paper_rolls_of_5600_mm() -> None:
    """An instance printed in many places: thirteen widths, 219 rolls, 73 of the mill's rolls are the optimum."""
    widths = (1380, 1520, 1560, 1710, 1820, 1880, 1930, 2000, 2050, 2100, 2140, 2150, 2200)
    counts = (22, 25, 12, 14, 18, 18, 20, 10, 12, 14, 16, 18, 20)
    wanted = demand({float(width): count for width, count in zip(widths, counts, strict=True)})
    plan = cutting_plan(wanted, StockRules((5600.0,), 0.0, 0.0))
    assert (len(plan.boards), plan.proven) == (73, True)


def test_first_fit_decreasing_can_be_beaten() -> None:
    """Boards of 10 for four 4 and eight 3: the rule of thumb begins with 4 + 4 and wastes 2; 4 + 3 + 3 is full."""
    plan = cutting_plan(demand({4.0: 4, 3.0: 8}), StockRules((10.0,), 0.0, 0.0))
    assert (plan.bought, plan.first_fit_decreasing, plan.proven) == (40.0, 50.0, True)


def test_kerf_and_trimmed_ends_are_paid() -> None:
    """Two pieces of 495 with a kerf of 5 and ends of 5 mm need 1005 mm, not 1000."""
    rules = StockRules((1000.0, 1005.0), 5.0, 5.0)
    assert [board.length for board in cutting_plan(pieces(495.0, 495.0), rules).boards] == [1005.0]
    assert [board.length for board in cutting_plan(pieces(492.5, 492.5), rules).boards] == [1000.0]


def test_the_two_planks_of_a_cut_come_from_one_board() -> None:
    """Five planks of a length are three cuts: the sixth plank has no use."""
    plan = cutting_plan(pieces(*[900.0] * 5), StockRules((1000.0,), 4.0, 10.0, planks_per_board=2))
    assert [len(cut.pieces) for board in plan.boards for cut in board.cuts] == [2, 2, 1]
    assert plan.waste == 3000.0 - 5 * 450.0


@settings(max_examples=25)
@given(
    lengths=st.lists(st.integers(20, 95), min_size=1, max_size=5),
    stock=st.sets(st.sampled_from([100, 130, 170]), min_size=1),
    kerf=st.integers(0, 4),
    planks=st.integers(1, 2),
)
def test_no_plan_found_by_trying_all_is_better(lengths: list[int], stock: set[int], kerf: int, planks: int) -> None:
    """Every pairing of planks and every packing is tried: grouping neighbours by length gives nothing away."""
    rules = StockRules(tuple(float(length) for length in sorted(stock)), float(kerf), 2.0, planks)
    wanted = pieces(*(float(length) for length in lengths))
    plan = cutting_plan(wanted, rules)
    check(plan, wanted, rules)
    assert plan.proven
    assert plan.bought == least_by_trial([float(length) for length in lengths], rules)


@settings(max_examples=40)
@given(
    lengths=st.lists(st.integers(9000, 75000), min_size=0, max_size=25),
    stock=st.sets(st.sampled_from([3000.0, 4000.0, 4500.0, 6000.0, 7000.0]), min_size=1),
    kerf=st.sampled_from([0.0, 3.2, 4.0]),
    trim=st.sampled_from([0.0, 10.0]),
    planks=st.integers(1, 3),
)
def test_every_plan_gives_exactly_what_is_wanted(
    lengths: list[int], stock: set[float], kerf: float, trim: float, planks: int
) -> None:
    rules = StockRules(tuple(sorted(stock)), kerf, trim, planks)
    wanted = pieces(*(length / 10.0 for length in lengths))
    plan = cutting_plan(wanted, rules)
    check(plan, wanted, rules)
    assert {piece.mark for piece in plan.refused} == {p.mark for p in wanted if p.length > rules.longest_cut}


def test_the_order_of_the_pieces_does_not_matter() -> None:
    wanted = pieces(*(1000.0 + 37.0 * (i % 11) for i in range(40)))
    rules = StockRules((4000.0, 5000.0), 4.0, 10.0, 2)
    assert cutting_plan(wanted, rules) == cutting_plan(wanted[::-1], rules)


def test_groups_are_neighbours_by_length() -> None:
    groups = grouped_pieces(pieces(5.0, 9.0, 7.0, 8.0, 6.0), 2)
    assert [[piece.length for piece in group] for group in groups] == [[9.0, 8.0], [7.0, 6.0], [5.0]]


def test_the_vault_is_cut_with_the_least_length_of_board_and_that_is_proven(
    gridshell: Gridshell, design: Design
) -> None:
    """183 planks of 841 m from boards 25 x 100 split in two (paper, section 3): at least 420 m of board."""
    planks = [plank for shell in gridshell.shells for plank in shell.planks]
    wanted, joints, refused = plank_pieces(planks, design.stock)
    plan = cutting_plan(wanted, board_rules(design.stock))
    check(plan, wanted, board_rules(design.stock))
    assert (len(wanted), joints, refused) == (183, (), ())
    assert plan.proven
    assert plan.waste_percent < 10.0
