"""The reference vault, built once for all tests."""

import pytest
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
