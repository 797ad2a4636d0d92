"""Taking the vault down: each part leaves once, and nothing is let go before something else holds it."""

from collections import Counter
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from aag_cad.geometry.framed import FramedCurve
from aag_cad.parts.forms import Blank, CrossSection
from aag_cad.parts.marks import shell_of
from aag_cad.parts.model import Gridshell, Plank, Shell, all_parts
from assembly.base.errors import PlanError
from assembly.base.phases import DOWN_PHASES
from assembly.base.steps import Plan, StepProp
from assembly.booklet.step_words import step_words
from assembly.checks.disassembly import check_disassembly
from assembly.plan.assembly_plan import plan_of
from assembly.plan.disassembly import disassembly_of, stored_energy
from assembly.plan.shape_control import prop_points, sling_points


@pytest.fixture(scope="module")
def down(gridshell: Gridshell) -> Plan:
    return disassembly_of(gridshell, 4, 25.0)


def before(plan: Plan, step_id: str) -> set[str]:
    """Return all steps that must be done before a step."""
    steps = {step.id: step for step in plan.steps}
    found: set[str] = set()
    waiting = [step_id]
    while waiting:
        new = set(steps[waiting.pop()].predecessors) - found
        found |= new
        waiting += new
    return found


def test_every_part_of_the_vault_leaves_in_exactly_one_step(down: Plan, gridshell: Gridshell) -> None:
    left = Counter(mark for step in down.steps for mark in step.marks)
    assert left == Counter(part.mark for part in all_parts(gridshell))


def test_the_plan_has_no_fault(down: Plan, gridshell: Gridshell) -> None:
    assert check_disassembly(down, gridshell) == []


@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("people", [1, 7])
def test_fewer_shells_and_other_crews_have_a_sound_plan(gridshell: Gridshell, count: int, people: int) -> None:
    shells = gridshell.shells[:count]
    joined = {f"R{a}{b}" for a in range(1, count + 1) for b in range(a + 1, count + 1)}
    fewer = replace(
        gridshell,
        shells=shells,
        blades=tuple(blade for blade in gridshell.blades if blade.mark[:3] in joined),
        bolts=tuple(bolt for bolt in gridshell.bolts if bolt.mark[:3] in joined),
        joints=tuple(joint for joint in gridshell.joints if joint.mark[:3] in joined),
    )
    found = disassembly_of(fewer, people, 25.0)
    assert check_disassembly(found, fewer) == []
    assert max(step.crew for step in found.steps) <= people


def test_all_shells_are_propped_before_the_first_ridge_opens(down: Plan) -> None:
    for step in down.steps:
        if step.id.startswith("site.down.ridge"):
            assert {f"site.down.prop.S{i}" for i in (1, 2, 3)} <= before(down, step.id)
            assert {f"site.down.cover.S{i}" for i in (1, 2, 3)} <= before(down, step.id)


def test_screws_come_out_while_the_shell_hangs_and_before_it_is_lowered(down: Plan, gridshell: Gridshell) -> None:
    screws = {screw.mark for screw in gridshell.shells[0].screws}
    (cover,) = (step for step in down.steps if step.id == "site.down.cover.S1")
    out = [step for step in down.steps if step.shell == "S1" and screws & set(step.marks)]
    assert set().union(*(step.marks for step in (cover, *out))) >= screws
    for step in out:
        assert "S1.down.hang" in before(down, step.id)
        assert step.id in before(down, "S1.down.lower")


def test_a_shell_bears_on_props_from_before_its_ridges_open_until_it_is_lowered(
    down: Plan, gridshell: Gridshell
) -> None:
    """Two rows along the ridges, from beside the crown down, and one across the middle; no sling hangs on a prop."""
    for shell in gridshell.shells:
        props, joints = prop_points(shell), {joint.mark: joint for joint in shell.joints}
        assert len(set(props)) == len(props) == 9
        crown = max(joint.point[2] for joint in shell.joints if joint.kind == "boundary")
        assert max(joints[mark].point[2] for mark in props) == crown
        assert not set(props) & set(sling_points(shell))
        for step in down.steps:
            told = [prop for prop in step.props if shell_of(prop.joint) == shell.mark or prop.holds == shell.mark]
            works = step.shell == shell.mark or (not step.shell and shell.mark in step.assemblies)
            bears = step.phase in (
                "prop", "open ridges", "lift off", "hang", "release geodesics", "pull edge planks", "lower"
            )  # fmt: skip
            assert told == ([StepProp(mark, shell.mark) for mark in props] if works and bears else [])


def test_a_shell_without_upper_edges_is_propped_under_its_uppermost_studs(shell: Shell) -> None:
    bare = replace(shell, joints=tuple(joint for joint in shell.joints if joint.kind != "boundary"))
    props = prop_points(bare)
    assert len(set(props)) == 6
    assert set(props) <= {stud.mark for stud in shell.studs}
    height = {stud.mark: stud.frame.origin[2] for stud in shell.studs}
    assert max(height[mark] for mark in props) == pytest.approx(max(height.values()))


def test_one_shell_hangs_at_a_time(down: Plan) -> None:
    assert "S1.down.lower" in before(down, "S2.down.hang")
    assert "S2.down.lower" in before(down, "S3.down.hang")


def test_the_layers_come_off_from_the_top_and_the_passports_are_last(down: Plan, gridshell: Gridshell) -> None:
    phases: list[str] = [step.phase for step in down.steps if step.shell == "S1"]
    assert list(dict.fromkeys(phases)) == [
        "hang", "release geodesics", "pull edge planks", "lower", "take off beams", "take off geodesics", "unbolt",
        "pull studs", "passports",
    ]  # fmt: skip
    off = [mark for step in down.steps if step.id.startswith("S1.down.off") for mark in (*step.assemblies, *step.marks)]
    families = [mark[3:5].rstrip("-") for mark in off if mark.count("-") == 2]
    assert list(dict.fromkeys(families)) == ["A2", "G", "A1"]
    last = next(step for step in down.steps if step.id == "S1.down.measure")
    assert set(last.assemblies) == {plank.mark for plank in gridshell.shells[0].planks}
    assert {step.id for step in down.steps if step.shell == "S1"} - {last.id} <= before(down, last.id)


def test_it_is_not_the_assembly_run_backwards(down: Plan, gridshell: Gridshell) -> None:
    """The lower halves of the studs leave on the trestles, after the beams that they were set through on the floor."""
    up = plan_of(gridshell, 4, 25.0)
    assert "S1.lay.6" in before(up, "S1.stud.1")
    assert "S1.down.off.6" in before(down, "S1.down.stud.6")


def test_phases_are_those_of_taking_down_and_the_same_gridshell_gives_the_same_plan(
    down: Plan, gridshell: Gridshell
) -> None:
    phases: set[str] = {step.phase for step in down.steps}
    assert phases == set(DOWN_PHASES)
    assert disassembly_of(gridshell, 4, 25.0) == down


def test_the_energy_of_a_plank_bent_to_a_circle_is_that_of_a_beam_in_pure_bending(
    gridshell: Gridshell, shell: Shell
) -> None:
    """U = E I L / 2 R^2 for a plank that lies on a cylinder of 5 m radius, without twist."""
    radius, length, width, thick = 5000.0, 3000.0, 100.0, 12.0
    stations = np.linspace(0.0, length, 31)
    angle = stations / radius
    normals = np.column_stack([np.sin(angle), np.zeros(31), np.cos(angle)])
    curve = FramedCurve(stations, radius * normals, normals)
    blank = Blank(length, CrossSection(width, thick), ())
    plank = Plank("S1-G-01", "G", 0, False, "", curve, blank, ())
    energy = stored_energy(replace(shell, planks=(plank,)), gridshell.timber)
    exact = gridshell.timber.modulus * width * thick**3 / 12.0 * length / (2.0 * radius**2) / 1000.0
    assert energy == pytest.approx(exact, rel=1e-5)


def test_the_crew_is_told_how_far_a_shell_springs_back(down: Plan, gridshell: Gridshell) -> None:
    (hang,) = (step for step in down.steps if step.id == "S1.down.hang")
    energy = stored_energy(gridshell.shells[0], gridshell.timber)
    assert any(f"up to {energy:.0f} J" in line for line in step_words(hang, "en").instructions)
    assert hang.held
    assert step_words(hang, "en").hold


@pytest.mark.parametrize(("people", "lift"), [(0, 25.0), (4, 0.0), (4, float("nan"))])
def test_a_crew_that_cannot_lift_is_refused(gridshell: Gridshell, people: int, lift: float) -> None:
    with pytest.raises(PlanError, match=r"crew\.people"):
        disassembly_of(gridshell, people, lift)


def _changed(plan: Plan, step_id: str, **changes: object) -> Plan:
    steps = (replace(step, **changes) if step.id == step_id else step for step in plan.steps)  # type: ignore[arg-type]
    return replace(plan, steps=tuple(steps))


def _marks(plan: Plan, step_id: str) -> tuple[str, ...]:
    return next(step.marks for step in plan.steps if step.id == step_id)


def _without(plan: Plan, step_id: str) -> Plan:
    steps = tuple(
        replace(step, predecessors=tuple(each for each in step.predecessors if each != step_id))
        for step in plan.steps
        if step.id != step_id
    )
    return replace(plan, steps=tuple(replace(step, number=i) for i, step in enumerate(steps, start=1)))


def _reversed(plan: Plan, step_id: str) -> Plan:
    return _changed(plan, step_id, marks=_marks(plan, step_id)[::-1])


FAULTS: list[tuple[Callable[[Plan], Plan], str]] = [
    (lambda plan: _without(plan, "S1.down.off.3"), "S1-G-14: leaves 0 times, expected 1"),
    (lambda plan: _without(plan, "S1.down.measure"), "S1-A1-01-L: is measured 0 times, expected 1"),
    (lambda plan: _without(plan, "site.down.prop.S2"), "S2: has a step 'prop' 0 times, expected 1"),
    (lambda plan: _without(plan, "S1.down.hang"), "S1: has a step 'hang' 0 times, expected 1"),
    (lambda plan: _changed(plan, "S1.down.off.3", marks=("S1-G-99",)), "S1-G-99: leaves 1 times, expected 0"),
    (lambda plan: _changed(plan, "site.down.ridge.S2.S3", predecessors=()), "S2 leans on its neighbours"),
    (lambda plan: _changed(plan, "site.down.lift.S1", predecessors=()), "S1 is joined along a ridge"),
    (lambda plan: _changed(plan, "site.down.prop.S1", predecessors=()), "S1-V-001-W1 loads S1"),
    (lambda plan: _changed(plan, "S1.down.release.1", predecessors=()), "keeps the shape of S1 until it hangs"),
    (lambda plan: _changed(plan, "S2.down.hang", predecessors=("site.down.lift.S2",)), "S1 and S2: nothing forces one"),
    (lambda plan: _changed(plan, "S1.down.lower", predecessors=()), "must be out before the nodes turn"),
    (lambda plan: _changed(plan, "S1.down.off.1", predecessors=()), "beams carry S1 until it lies flat"),
    (lambda plan: _changed(plan, "S1.down.off.3", predecessors=("S1.down.lower",)), "lies on S1-G-14 at"),
    (lambda plan: _changed(plan, "S1.down.stud.6", predecessors=()), "holds S1 until it lies flat"),
    (lambda plan: _changed(plan, "S1.down.unbolt.6", predecessors=("S1.down.off.6",)), "S1-A1-01-L of S1-A1-01"),
    (lambda plan: _reversed(plan, "S1.down.unbolt.1"), "but comes later in step S1.down.unbolt.1"),
    (lambda plan: _changed(plan, "S1.down.measure", predecessors=()), "S1-A1-01-L is measured, but nothing forces"),
    (lambda plan: _changed(plan, "site.down.feet", predecessors=()), "S1-C-01 carries S1"),
    (lambda plan: _changed(plan, "S1.down.release.1", props=()), "its centre is not over its feet and props"),
    (
        lambda plan: _changed(plan, "site.down.ridge.S1.S2", props=(StepProp("S1-K-198", "S1"),)),
        "S2: step site.down.ridge.S1.S2 lets",
    ),
    (lambda plan: _changed(plan, "S1.down.off.2", number=7), "step S1.down.off.2: number 7"),
]


@pytest.mark.parametrize(("damage", "complaint"), FAULTS)
def test_the_check_finds_a_damaged_plan(
    down: Plan, gridshell: Gridshell, damage: Callable[[Plan], Plan], complaint: str
) -> None:
    problems = check_disassembly(damage(down), gridshell)
    assert any(complaint in problem for problem in problems), problems[:5]
