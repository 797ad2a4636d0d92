"""How long the solids of one shell and the STEP file of the vault take."""

from pathlib import Path

from pytest_benchmark.fixture import BenchmarkFixture
from solid_figures import straight_blank

from aag_cad.export.cad.step import write_step
from aag_cad.parts.model import Gridshell
from aag_cad.solids.planks import formed_plank
from aag_cad.solids.products import product_solids


def test_formed_planks_of_one_shell(benchmark: BenchmarkFixture, gridshell: Gridshell) -> None:
    planks = gridshell.shells[0].planks
    solids = benchmark(lambda: [formed_plank(plank) for plank in planks])
    assert len(solids) == len(planks)


def test_straight_blanks_of_one_shell(benchmark: BenchmarkFixture, gridshell: Gridshell) -> None:
    planks = gridshell.shells[0].planks
    solids = benchmark(lambda: [straight_blank(plank) for plank in planks])
    assert len(solids) == len(planks)


def test_solids_of_all_products(benchmark: BenchmarkFixture, gridshell: Gridshell) -> None:
    assert benchmark(product_solids, gridshell)


def test_step_file_of_the_vault(benchmark: BenchmarkFixture, gridshell: Gridshell, tmp_path: Path) -> None:
    benchmark(write_step, gridshell, tmp_path / "vault.step")
    assert (tmp_path / "vault.step").stat().st_size < 15e6
