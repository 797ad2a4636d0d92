"""The reference vault, worked out once for each process of a run and built once for all of them."""

import os
from pathlib import Path

import pytest
from builds import build_vault, made_once
from hypothesis import settings

from aag_cad.design import Design, load_design
from aag_cad.geometry.revolution import AsymptoticChart
from aag_cad.network.build import shell_network
from aag_cad.network.model import CurveNetwork
from aag_cad.parts.build import gridshell_from
from aag_cad.parts.model import Gridshell, Shell
from aag_cad.pipeline import chart_of

# A slow machine is no error, and a failure must come again in the next run.
settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.load_profile("repeatable")


# Files that take long begin first, so that no process of a run is left with one at the end.
LONG_FILES = (
    "test_main_job.py", "test_fig2_designs.py", "test_ifc_checks.py", "test_sequence_booklet.py", "test_step.py",
    "test_booklet_language.py", "test_optimised_vault.py", "test_command_line.py", "test_plan_command.py",
)  # fmt: skip


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Sort the tests by file, the long ones first; each file keeps its order."""
    places = {name: place for place, name in enumerate(LONG_FILES)}
    items.sort(key=lambda item: places.get(item.path.name, len(places)))


@pytest.fixture(scope="session")
def run_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder that all processes of a run share."""
    own = tmp_path_factory.getbasetemp()
    return own.parent if "PYTEST_XDIST_WORKER" in os.environ else own


@pytest.fixture(scope="session")
def vault_build(run_folder: Path) -> Path:
    """The folder of a build of the vault in a process of its own, all outputs."""
    return made_once(run_folder / "vault-build", lambda folder: build_vault(folder, "1"))


@pytest.fixture(scope="session")
def design() -> Design:
    """The shipped design of the reference vault."""
    return load_design("vault")


@pytest.fixture(scope="session")
def chart(design: Design) -> AsymptoticChart:
    """The surface of one shell in its asymptotic chart (s, theta)."""
    return chart_of(design)


@pytest.fixture(scope="session")
def network(design: Design, chart: AsymptoticChart) -> CurveNetwork:
    """The curves and crossings of one shell."""
    return shell_network(design, chart)


@pytest.fixture(scope="session")
def gridshell(design: Design, network: CurveNetwork) -> Gridshell:
    """The whole vault: all parts and joints of its three shells."""
    return gridshell_from(design, network)


@pytest.fixture(scope="session")
def shell(gridshell: Gridshell) -> Shell:
    """The first shell of the vault, S1."""
    return gridshell.shells[0]
