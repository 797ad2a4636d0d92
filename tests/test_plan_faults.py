"""Plans are walked through by those who did not make them, in every build: what they find is an error finding."""

import json
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from aag_cad.cli import app
from aag_cad.design import Design, load_design
from aag_cad.parts.model import Gridshell
from aag_cad.pipeline import checked_plans, gridshell_of
from assembly.base.segments import Segmentation
from assembly.base.steps import Plan, Step
from assembly.booklet.plan_file import gridshell_pieces, plan_file, plan_json
from assembly.checks.findings import disassembly_faults, plan_faults, schedule_faults
from assembly.plan.planned import Planned, limits_of
from assembly.transport.findings import standing_finding


@pytest.fixture(scope="module")
def planned(gridshell: Gridshell, design: Design) -> Planned:
    return checked_plans(gridshell, design.crew, limits_of(design.transport))


Damage = Callable[[Plan], Plan]


def step_changed(step_id: str, **changes: object) -> Damage:
    def damage(plan: Plan) -> Plan:
        assert any(step.id == step_id for step in plan.steps)
        steps = (replace(s, **changes) if s.id == step_id else s for s in plan.steps)  # type: ignore[arg-type]
        return replace(plan, steps=tuple(steps))

    return damage


def step_left_out(step_id: str) -> Damage:
    return lambda plan: replace(plan, steps=tuple(step for step in plan.steps if step.id != step_id))


def part_lost(mark: str) -> Damage:
    def without(step: Step) -> Step:
        return replace(step, marks=tuple(other for other in step.marks if other != mark))

    return lambda plan: replace(plan, steps=tuple(map(without, plan.steps)))


UP: dict[str, Damage] = {
    "a part is in no step": part_lost("S1-G-05"),
    "a screw is in no step": part_lost("S2-K-001-W1"),
    "a beam is never laid": step_changed("S1.lay.1", assemblies=()),
    "a shell is never hoisted": step_left_out("S2.hoist"),
    "the hoist ends without a check": step_changed("S1.hoist", held=False),
    "the hoist stands on no props": step_changed("S1.hoist", props=()),
    "the shell stands before it is stiff": step_changed("site.stand.S1", predecessors=()),
    "the ridge is joined before its shells stand": step_changed("site.ridge.S1.S2", predecessors=()),
    "the cover comes before the ridges": step_changed("site.cover.S3", predecessors=()),
    "a step has the number of another": step_changed("S3.tighten", number=1),
    "two steps have one id": step_changed("S1.stud.2", id="S1.stud.1"),
    "upper beams are laid before the geodesics": step_changed("S1.lay.5", predecessors=()),
}
DOWN: dict[str, Damage] = {
    "a plank never leaves": part_lost("S1-G-05"),
    "ridges are opened before the shells are propped": step_changed("site.down.ridge.S2.S3", predecessors=()),
    "a hanging shell is on no props": step_changed("S1.down.hang", props=()),
    "two shells hang at a time": step_changed("S2.down.hang", predecessors=("site.down.lift.S2",)),
}


def test_the_plans_of_the_vault_have_no_fault(planned: Planned) -> None:
    assert [found.text for found in planned.findings if found.severity == "error"] == []


@pytest.mark.parametrize("name", UP)
def test_a_damaged_plan_is_an_error_finding(name: str, planned: Planned, gridshell: Gridshell) -> None:
    found = plan_faults(UP[name](planned.plan), gridshell, planned.segmentation, planned.locking)
    assert found
    assert {(one.code, one.severity) for one in found} == {("AAG981", "error")}
    assert all(one.found >= 1.0 > one.allowed and "plan it again" in one.text for one in found)


@pytest.mark.parametrize("name", DOWN)
def test_a_damaged_plan_of_taking_down_is_an_error_finding(name: str, planned: Planned, gridshell: Gridshell) -> None:
    found = disassembly_faults(DOWN[name](planned.down), gridshell)
    assert {(one.code, one.severity) for one in found} == {("AAG982", "error")}


def test_faults_of_one_kind_are_one_finding_with_their_number(planned: Planned, gridshell: Gridshell) -> None:
    lost = planned.plan
    for mark in ("S1-G-05", "S1-G-06", "S2-G-07"):
        lost = part_lost(mark)(lost)
    (found, *_) = (one for one in plan_faults(lost, gridshell, None, ()) if "no step adds it" in one.text)
    assert (found.mark, found.found) == ("S1-G-05", 3.0)


def test_the_command_ends_with_exit_code_1_on_a_damaged_file(
    planned: Planned, gridshell: Gridshell, design: Design, tmp_path: Path
) -> None:
    pieces = gridshell_pieces(gridshell)
    good = plan_json(plan_file(planned.plan, planned.schedule, design.crew, pieces, planned.segmentation))
    data = json.loads(good)
    for each in data["steps"]:
        if each["step"]["id"] == "S1.hoist":
            each["step"]["held"] = False
    (tmp_path / "good.json").write_text(good, encoding="utf-8")
    (tmp_path / "bad.json").write_text(json.dumps(data), encoding="utf-8")
    runner = CliRunner()
    assert runner.invoke(app, ["check", "vault", "--plan", str(tmp_path / "good.json")]).exit_code == 0
    told = runner.invoke(app, ["check", "vault", "--json", "--plan", str(tmp_path / "bad.json")])
    assert told.exit_code == 1
    assert [row["code"] for row in json.loads(told.stdout) if row["severity"] == "error"] == ["AAG981"]


def test_the_times_of_a_plan_are_walked_through_too(planned: Planned) -> None:
    plan, people = planned.plan, planned.schedule.people
    times = {step.id: (step.start_minute, step.end_minute) for step in planned.schedule.steps}
    down = {step.id: (step.start_minute, step.end_minute) for step in planned.down_schedule.steps}
    assert schedule_faults(plan, times, people) == schedule_faults(planned.down, down, people) == ()
    second = next(step for step in plan.steps if step.predecessors)
    for bad, crew, told in (
        (times | {second.id: (0, 1)}, people, f"{second.id}: begins at minute 0"),
        (times | {"S1.hoist": (-1, -1)}, people, "S1.hoist: from minute -1 to -1"),
        (times | {"S1.hoist": times["S1.hoist"][::-1]}, people, "no end before its start"),
        (times, people - 1, f"{people} people, allowed 1 to {people - 1}"),
        (dict.fromkeys(times, (0, 10)), people, f"allowed {people}"),
    ):
        found = schedule_faults(plan, bad, crew)
        assert {(one.code, one.severity) for one in found} == {("AAG984", "error")}
        assert any(told in one.text for one in found), told


def test_what_is_no_plan_is_refused_with_its_file_before_anything_is_built(
    planned: Planned, gridshell: Gridshell, design: Design, tmp_path: Path
) -> None:
    data = json.loads(plan_json(plan_file(planned.plan, planned.schedule, design.crew, gridshell_pieces(gridshell))))
    data["steps"][5]["step"]["title"]["key"] = "no.such.key"
    for name, text, told in (
        ("words.json", json.dumps(data), "steps.5: 'no.such.key' has no words"),
        ("list.json", "[]", "schema_version"),
        ("cut.json", "{", "not valid JSON"),
    ):
        (tmp_path / name).write_text(text, encoding="utf-8")
        result = CliRunner().invoke(app, ["check", "vault", "--plan", str(tmp_path / name)])
        assert result.exit_code == 2
        assert f"{name}: " in result.stderr
        assert told in result.stderr
        assert "audit" not in result.stderr


@pytest.fixture(scope="module")
def cut(tmp_path_factory: pytest.TempPathFactory) -> tuple[Gridshell, Planned]:
    """A low lorry: shells of six geodesics are cut in two, and no two studs and feet hold their first segments."""
    path = tmp_path_factory.mktemp("low") / "low.toml"
    shutil.copyfile(Path(__file__).parent.parent / "templates" / "designs" / "vault.toml", path)
    text = path.read_text(encoding="utf-8")
    for old, new in (
        ("geodesics = 14", "geodesics = 6"),
        ("height = 2600.0", "height = 1150.0"),
        ("sector_deg = 60.0", "sector_deg = 60.0"),
    ):
        assert old in text
        text = text.replace(old, new, 1)
    path.write_text(text, encoding="utf-8")
    design = load_design(str(path))
    gridshell = gridshell_of(design)
    return gridshell, checked_plans(gridshell, design.crew, limits_of(design.transport))


def test_segments_stand_on_props_that_hold_them(cut: tuple[Gridshell, Planned]) -> None:
    _, planned = cut
    segments = planned.segmentation.segments
    assert len(segments) == 6
    assert all(segment.standing_margin > 0.0 for segment in segments)
    assert [found.text for found in planned.findings if found.severity == "error"] == []


def test_props_that_cannot_hold_a_segment_are_a_finding_and_so_is_its_plan(cut: tuple[Gridshell, Planned]) -> None:
    gridshell, planned = cut
    segment = planned.segmentation.segments[0]
    assert standing_finding(segment) is None
    falling = replace(segment, standing_margin=-213.0)
    found = standing_finding(falling)
    assert found is not None
    assert (found.code, found.severity, found.mark, found.found) == ("AAG966", "error", "S1.1", -213.0)
    x, y = (f"{value:.0f}" for value in segment.centre[:2])
    assert f"around x = {x}, y = {y} mm" in found.text
    # The same two studs that did not hold it: the walk over the plan sees it fall.
    bad = step_changed("site.stand.S1.1", props=tuple(p for p in _stand(planned, "S1.1").props if "-N-" in p.joint) * 2)
    faults = plan_faults(bad(planned.plan), gridshell, planned.segmentation, planned.locking)
    assert any("it falls" in fault.text for fault in faults)


def _stand(planned: Planned, segment: str) -> Step:
    return next(step for step in planned.plan.steps if step.phase == "stand" and step.segments == (segment,))


def test_each_prop_says_which_segment_bears_on_it(cut: tuple[Gridshell, Planned]) -> None:
    _, planned = cut
    segmentation: Segmentation = planned.segmentation
    props = {segment.name: segment.props for segment in segmentation.segments}
    for step in planned.plan.steps:
        if step.phase == "divide":
            assert {(prop.joint, prop.holds) for prop in step.props} == {
                (joint, name) for name in step.segments for joint in props[name]
            }
