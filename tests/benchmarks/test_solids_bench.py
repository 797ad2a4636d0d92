"""How long the solids of one shell and the STEP file of the vault take."""

from pathlib import Path

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from aag_cad.design import Design
from aag_cad.export.step import write_step
from aag_cad.parts.model import Gridshell
from aag_cad.pipeline import gridshell_of
from aag_cad.solids.planks import formed_plank, straight_blank
from aag_cad.solids.products import product_solids


@pytest.fixture(scope="module")
def solids_vault(design: Design) -> Gridshell:
    """Return the gridshell of the reference vault."""
    return gridshell_of(design)


def test_formed_planks_of_one_shell(benchmark: BenchmarkFixture, solids_vault: Gridshell) -> None:
    planks = solids_vault.shells[0].planks
    solids = benchmark(lambda: [formed_plank(plank) for plank in planks])
    assert len(solids) == len(planks)


def test_straight_blanks_of_one_shell(benchmark: BenchmarkFixture, solids_vault: Gridshell) -> None:
    planks = solids_vault.shells[0].planks
    solids = benchmark(lambda: [straight_blank(plank) for plank in planks])
    assert len(solids) == len(planks)


def test_solids_of_all_products(benchmark: BenchmarkFixture, solids_vault: Gridshell) -> None:
    assert benchmark(product_solids, solids_vault)


def test_step_file_of_the_vault(benchmark: BenchmarkFixture, solids_vault: Gridshell, tmp_path: Path) -> None:
    solids = product_solids(solids_vault)
    benchmark(write_step, solids_vault, tmp_path / "vault.step", solids)
    assert (tmp_path / "vault.step").stat().st_size < 15e6
