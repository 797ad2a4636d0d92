"""How long the vault takes to be cut from boards, and from its own old planks."""

from pytest_benchmark.fixture import BenchmarkFixture

from aag_cad.design import Design
from aag_cad.parts.model import Gridshell
from aag_cad.shop.finger_joints import board_rules, plank_pieces
from aag_cad.shop.offcuts import OldPlank, reused_planks
from aag_cad.shop.purchases import purchases_of
from aag_cad.shop.stock import cutting_plan


def test_boards_of_the_vault(benchmark: BenchmarkFixture, gridshell: Gridshell, design: Design) -> None:
    planks = [plank for shell in gridshell.shells for plank in shell.planks]
    pieces = plank_pieces(planks, design.stock)[0]
    assert benchmark(cutting_plan, pieces, board_rules(design.stock)).proven


def test_all_purchases_of_the_vault(benchmark: BenchmarkFixture, gridshell: Gridshell, design: Design) -> None:
    assert not benchmark(purchases_of, gridshell, design).refused


def test_the_lower_beams_from_their_own_old_planks(
    benchmark: BenchmarkFixture, gridshell: Gridshell, design: Design
) -> None:
    planks = [plank for plank in gridshell.shells[0].planks if plank.family == "A1"]
    old = [OldPlank(f"old {plank.mark}", plank.blank, "ash", "D50") for plank in planks]
    stock = design.stock.model_copy(update={"accept_old_holes": True})
    assert len(benchmark(reused_planks, planks, old, stock)) == len(planks)
