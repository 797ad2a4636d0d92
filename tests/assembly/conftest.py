"""All plans of the reference vault in both languages, made once for all tests of printed matter."""

from dataclasses import replace

import pytest

from aag_cad.design import Design
from aag_cad.parts.model import Gridshell
from assembly.plan.assembly_plan import plan_of
from assembly.plan.disassembly import disassembly_of
from assembly.plan.planned import Planned, planned_of


@pytest.fixture(scope="session")
def planned(design: Design, gridshell: Gridshell) -> Planned:
    """The plans of the vault for its crew, in English."""
    return planned_of(gridshell, design.crew)


@pytest.fixture(scope="session")
def german(design: Design, gridshell: Gridshell, planned: Planned) -> Planned:
    """The same plans in German; locking, segments and schedules have no words."""
    people, lift = design.crew.people, design.crew.lift_limit
    up = plan_of(gridshell, people, lift, locking=planned.locking, segmentation=planned.segmentation, language="de")
    return replace(planned, plan=up, down=disassembly_of(gridshell, people, lift, language="de"))
