"""A plan written as JSON comes back equal; a damaged file is refused with the place of the fault."""

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from making import a_step

from aag_cad.design_making import Crew
from aag_cad.errors import AagError
from aag_cad.findings import Finding
from aag_cad.language import LANGUAGES
from aag_cad.parts.model import Gridshell
from assembly.base.errors import PlanError
from assembly.base.phases import PHASES
from assembly.base.steps import Plan, Step
from assembly.booklet.plan_file import plan_file, plan_json, read_plan
from assembly.plan.assembly_plan import plan_of
from assembly.plan.schedule import schedule_of

texts = st.text(max_size=12)
listed = st.lists(texts, max_size=4).map(tuple)
steps = st.builds(
    Step,
    number=st.integers(1, 999),
    id=texts,
    phase=st.sampled_from(PHASES),
    title=texts,
    shell=texts,
    marks=listed,
    assemblies=listed,
    tools=listed,
    crew=st.integers(0, 40),
    predecessors=listed,
    instructions=listed,
    hold=texts,
    props=listed,
    extras=listed,
)
numbers = st.floats(allow_nan=False, allow_infinity=False)
findings = st.builds(
    Finding,
    code=texts,
    severity=st.sampled_from(["error", "warning", "note"]),
    mark=texts,
    what=texts,
    found=numbers,
    allowed=numbers,
    unit=texts,
    remedy=texts,
)
plans = st.builds(
    Plan,
    name=texts,
    steps=st.lists(steps, max_size=4).map(tuple),
    language=st.sampled_from(LANGUAGES),
    findings=st.lists(findings, max_size=2).map(tuple),
)


@given(plans)
def test_any_plan_comes_back_equal(plan: Plan) -> None:
    assert read_plan(plan_json(plan)) == plan


def test_the_plan_of_the_vault_comes_back_equal(gridshell: Gridshell) -> None:
    plan = plan_of(gridshell, 4, 25.0)
    assert read_plan(plan_json(plan)) == plan


def _file(**changes: Any) -> str:
    plan = Plan("vault", (a_step(1, "Hoist", "hoist", shell="S1", assemblies=("S1",)),))
    crew = Crew.model_validate({"people": 1, "lift_limit": 25.0})
    data = json.loads(plan_json(plan_file(plan, schedule_of(plan, {"s1": 60}, 1), crew, ())))
    data["steps"][0]["step"] |= changes
    return json.dumps(data)


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("{", "not valid JSON"),
        ("[]", "schema_version"),
        ('{"schema_version": 99}', "schema_version must be 2"),
        ('{"schema_version": 2, "name": "vault"}', "missing keys.*steps"),
        ('{"schema_version": 2, "name": "v", "language": "fr", "steps": []}', "language: 'fr' is none of 'en', 'de'"),
        ('{"schema_version": 2, "name": "vault", "steps": [{}]}', r"steps\[0\]: .*missing keys"),
        (_file(phase="lunch"), r"steps\[0\]\.phase: 'lunch'"),
        (_file(crew="4"), r"steps\[0\]\.crew: expected int, found '4'"),
        (_file(crew=True), r"steps\[0\]\.crew: expected int, found True"),
        (_file(marks=[1]), r"steps\[0\]\.marks"),
        (_file(hold=None), r"steps\[0\]\.hold"),
    ],
)
def test_a_damaged_file_is_refused_with_the_place(text: str, place: str) -> None:
    with pytest.raises(PlanError, match=place):
        read_plan(text)


def test_a_plan_error_is_an_error_of_the_toolkit_and_a_wrong_value() -> None:
    assert issubclass(PlanError, AagError)
    assert issubclass(PlanError, ValueError)
