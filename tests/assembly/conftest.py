"""All plans of the reference vault, made once for all tests of printed matter."""

import pytest

from aag_cad.design import Design
from aag_cad.parts.model import Gridshell
from assembly.plan.planned import Planned, planned_of


@pytest.fixture(scope="session")
def planned(design: Design, gridshell: Gridshell) -> Planned:
    """The plans of the vault for its crew."""
    return planned_of(gridshell, design.crew)
