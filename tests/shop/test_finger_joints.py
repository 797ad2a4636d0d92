"""Finger joints: only where a plank is longer than every board, clear of holes, ends and the sibling's joint."""

from dataclasses import replace

import pytest

from aag_cad.design import Design, load_design
from aag_cad.design_making import Stock
from aag_cad.parts.forms import Hole
from aag_cad.parts.model import Gridshell, Plank
from aag_cad.pipeline import gridshell_of
from aag_cad.shop.finger_joints import board_rules, joint_stations, plank_pieces

STOCK = Stock(lengths=(5020.0,), finger_joint=True)


def hole(station: float) -> Hole:
    return Hole(station, 0.0, 9.0, "bolt", "")


@pytest.fixture(scope="module")
def column() -> list[Plank]:
    return [plank for shell in gridshell_of(load_design("column")).shells for plank in shell.planks]


def test_a_plank_that_a_board_holds_has_no_joint() -> None:
    assert joint_stations(5000.0, (), STOCK) == ()


def test_the_joint_lies_as_far_from_the_holes_as_it_can() -> None:
    """Holes of 9 mm at 3000 and 3400: the middle 3200 is clear of them by 200 - 4.5 - 7.5 = 188 mm."""
    joints = joint_stations(7000.0, [hole(100.0 * i) for i in range(1, 70) if not 30 < i < 34], STOCK)
    assert joints is not None
    assert [joint.station for joint in joints] == pytest.approx([3200.0], abs=1.0)
    assert joints[0].clear == pytest.approx(188.0, abs=1.0)


def test_where_holes_are_everywhere_there_is_no_place() -> None:
    assert joint_stations(7000.0, [hole(100.0 * i) for i in range(1, 70)], STOCK) is None


def test_each_joint_costs_its_fingers() -> None:
    """Pieces of at most 5 m that share 15 mm give 9985 mm; a plank of 12 m takes three, which share twice."""
    plank_of = {length: joint_stations(length, (), STOCK) for length in (7000.0, 9985.0, 9990.0, 12000.0)}
    assert {length: len(joints or ()) for length, joints in plank_of.items()} == {
        7000.0: 1, 9985.0: 1, 9990.0: 2, 12000.0: 2,
    }  # fmt: skip


def test_the_planks_of_the_column_are_jointed_clear_of_holes_and_of_their_siblings(column: list[Plank]) -> None:
    stock = load_design("column").stock
    pieces, joints, refused = plank_pieces(column, stock)
    assert not refused
    of = {plank.mark: plank for plank in column}
    longest = board_rules(stock).longest_cut
    assert {joint.mark for joint in joints} == {plank.mark for plank in column if plank.blank.length > longest}
    assert all(piece.length <= longest for piece in pieces)
    for joint in joints:
        blank = of[joint.mark].blank
        clear = [abs(joint.station - h.station) - h.diameter / 2.0 - stock.finger_length / 2.0 for h in blank.holes]
        assert min(clear) >= joint.clear - 0.1 >= stock.finger_clearance - 0.1
        assert stock.finger_spacing <= joint.station <= blank.length - stock.finger_spacing
        sibling = joint.mark[:-1] + {"L": "R", "R": "L"}.get(joint.mark[-1], "")
        apart = [abs(joint.station - other.station) for other in joints if other.mark == sibling]
        assert min(apart, default=1e9) >= stock.finger_spacing
    for mark, plank in of.items():
        mine = [piece for piece in pieces if piece.mark == mark]
        shared = stock.finger_length * (len(mine) - 1)
        assert sum(piece.length for piece in mine) == pytest.approx(plank.blank.length + shared, abs=0.2)


def test_a_plank_that_is_too_long_is_named_with_the_joint_that_it_needs(gridshell: Gridshell, design: Design) -> None:
    """Boards of 6 m at most: 16 planks of a shell are longer, and the finding says where each can be jointed."""
    planks = gridshell.shells[0].planks
    stock = design.stock.model_copy(update={"lengths": (4000.0, 6000.0)})
    long = sorted(plank.mark for plank in planks if plank.blank.length > 5980.0)
    pieces, joints, refused = plank_pieces(planks, stock)
    assert len(long) == 16
    assert [refusal.mark for refusal in refused] == long
    assert not joints
    assert not {piece.mark for piece in pieces} & set(long)
    assert all("finger-joint it at" in refusal.remedy and "clear of the holes" in refusal.remedy for refusal in refused)
    jointed = plank_pieces(planks, stock.model_copy(update={"finger_joint": True}))
    assert not jointed[2]
    assert sorted({joint.mark for joint in jointed[1]}) == long


def test_a_plank_without_a_place_for_a_joint_says_so(gridshell: Gridshell, design: Design) -> None:
    plank = max(gridshell.shells[0].planks, key=lambda plank: plank.blank.length)
    full = replace(plank, blank=replace(plank.blank, holes=tuple(hole(50.0 * i) for i in range(1, 130))))
    stock = design.stock.model_copy(update={"lengths": (6000.0,), "finger_joint": True})
    (refusal,) = plank_pieces([full], stock)[2]
    assert "no place for a finger joint" in refusal.remedy
