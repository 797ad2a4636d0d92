"""Plans of gridshells of many sizes, crews and lorries keep their promises; each is checked by the independent walk."""

from collections import Counter

from hypothesis import given, settings
from hypothesis import strategies as st

from aag_cad.design import design_text, parse_design
from aag_cad.parts.model import all_parts
from aag_cad.pipeline import gridshell_of
from assembly.base.segments import Limits
from assembly.checks.disassembly import check_disassembly
from assembly.checks.plan import check_plan
from assembly.plan.assembly_plan import plan_of
from assembly.plan.planned import planned_of
from assembly.plan.schedule import people_curve

TEXT = design_text("vault")


@settings(max_examples=5)
@given(
    geodesics=st.sampled_from([6, 8]),
    sector=st.integers(45, 60),
    offset=st.sampled_from([0.3, 0.5, 0.7]),
    people=st.integers(2, 7),
    width=st.sampled_from([2000.0, 4600.0]),
    edges_first=st.booleans(),
)
def test_each_part_comes_once_in_an_order_that_can_be_built(
    geodesics: int, sector: int, offset: float, people: int, width: float, edges_first: bool
) -> None:
    text = TEXT.replace("geodesics = 14 ", f"geodesics = {geodesics} ").replace("people = 4", f"people = {people}")
    text = text.replace("sector_deg = 60.0", f"sector_deg = {sector}")
    text = text.replace("row_offset = 0.5", f"row_offset = {offset}")
    design = parse_design(text)
    gridshell = gridshell_of(design)
    limits = Limits(12000.0, width, 2600.0, 3000.0)
    planned = planned_of(gridshell, design.crew, limits, edges_first=edges_first)
    assert check_plan(planned.plan, gridshell, planned.segmentation, planned.locking) == []
    assert check_disassembly(planned.down, gridshell) == []
    for plan in (planned.plan, planned.down):
        counted = Counter(mark for step in plan.steps for mark in step.marks)
        assert set(counted) == {part.mark for part in all_parts(gridshell)}
        assert set(counted.values()) == {1}
    for schedule in (planned.schedule, planned.down_schedule):
        assert max(people_at for _, people_at in people_curve(schedule)) <= people
        assert schedule.makespan >= schedule.lower_bound
    again = plan_of(gridshell, people, 25.0, locking=planned.locking, segmentation=planned.segmentation)
    assert again.steps == planned.plan.steps
