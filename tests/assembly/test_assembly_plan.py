"""The plan of the vault, walked step by step: each part once, nothing before what it rests on (paper section 3.2)."""

from collections import Counter
from collections.abc import Callable
from dataclasses import replace

import pytest
from damage import changed, moved, without

from aag_cad.language import LANGUAGES
from aag_cad.parts.marks import parse_mark
from aag_cad.parts.model import Bolt, Gridshell, Part, all_joints, all_parts, ridge_parts
from assembly.base.errors import PlanError
from assembly.base.steps import Plan, Step
from assembly.booklet.step_words import step_title, step_words
from assembly.checks.plan import check_plan
from assembly.plan.assembly_plan import plan_of
from assembly.plan.piece_weights import piece_weights
from assembly.plan.site_work import site_works

PEOPLE, LIFT = 4, 25.0


@pytest.fixture(scope="module")
def plan(gridshell: Gridshell) -> Plan:
    return plan_of(gridshell, PEOPLE, LIFT)


def steps_of(plan: Plan, shell: str, *phases: str) -> list[Step]:
    return [step for step in plan.steps if step.shell == shell and (not phases or step.phase in phases)]


def test_every_part_of_the_vault_comes_in_exactly_one_step(plan: Plan, gridshell: Gridshell) -> None:
    placed = Counter(mark for step in plan.steps for mark in step.marks)
    assert placed == Counter(part.mark for part in all_parts(gridshell))


def test_the_plan_has_no_fault(plan: Plan, gridshell: Gridshell) -> None:
    assert check_plan(plan, gridshell) == []


def test_a_crew_walking_the_steps_never_misses_a_part(plan: Plan, gridshell: Gridshell) -> None:
    """Do the steps one by one on the bare data: what a step needs must lie there already."""
    joints = {joint.mark: joint for joint in all_joints(gridshell)}
    blocks = {block.mark for shell in gridshell.shells for block in shell.blocks}
    beam_of = {plank.mark: plank.beam for shell in gridshell.shells for plank in shell.planks if plank.beam}
    made: set[str] = set()
    laid: set[str] = set()
    for step in plan.steps:
        made.update(step.marks)
        for unit in step.assemblies:
            if unit in beam_of.values():
                assert all(plank in made for plank, beam in beam_of.items() if beam == unit)
                laid.add(unit)
        for mark in step.marks:
            part = parse_mark(mark)
            if part.part[:1] not in ("B", "W", "T"):
                continue
            joint = joints[mark.rpartition("-")[0]]
            block_bolt = part.part[0] == "B" and any(member in blocks for member in joint.members)
            for member in joint.members:
                if block_bolt and member not in blocks and member not in beam_of:
                    continue
                assert member in made
                assert block_bolt or member not in beam_of or beam_of[member] in laid


def test_the_phases_of_a_shell_follow_the_paper(plan: Plan) -> None:
    for shell in ("S1", "S2", "S3"):
        phases = list(dict.fromkeys(step.phase for step in steps_of(plan, shell)))
        assert phases == [
            "prefabricate", "lay A1", "lay G", "lay A2", "studs", "hoist", "edge planks", "fix geodesics", "tighten",
        ]  # fmt: skip
    assert list(dict.fromkeys(step.phase for step in steps_of(plan, ""))) == ["feet", "stand", "ridges", "cover"]


def test_steel_comes_with_the_work_that_needs_it(plan: Plan, gridshell: Gridshell) -> None:
    """Straps with the upper edge planks; blocks, rods and shoes before any shell stands; bolts of shoes as it stands.

    Blades with their ridge, when both of its shells stand.
    """
    added = {mark: step for step in plan.steps for mark in step.marks}
    for shell in gridshell.shells:
        assert {added[strap.mark].id for strap in shell.straps} == {f"{shell.mark}.edge.upper"}
        feet: list[str] = [part.mark for parts in (shell.footings, shell.rods, shell.shoes) for part in parts]
        assert {added[mark].id for mark in feet} == {"site.feet"}
        bolts = {mark for joint in shell.joints if joint.kind == "foot" for mark in joint.fasteners}
        assert {added[mark].id for mark in bolts} == {f"site.stand.{shell.mark}"}
    for part in ridge_parts(gridshell):
        pair = sorted(part.mark[1:3])
        assert added[part.mark].id == f"site.ridge.S{pair[0]}.S{pair[1]}"


def test_the_cover_comes_last(plan: Plan, gridshell: Gridshell) -> None:
    phases = [step.phase for step in plan.steps]
    covering = [step for step in plan.steps if step.phase == "cover"]
    assert len(covering) == len(gridshell.shells)
    assert all(phase == "cover" for phase in phases[len(phases) - len(covering) :])
    added = {mark for step in covering for mark in step.marks}
    for shell in gridshell.shells:
        cover: tuple[Part, ...] = (*shell.mullions, *shell.strips, *shell.clamps)
        fixed = [joint for joint in shell.joints if joint.kind == "cover"]
        blocks = {joint.mark for joint in fixed if joint.mark in joint.members}
        screws = {mark for joint in fixed for mark in joint.fasteners}
        assert {part.mark for part in cover} | blocks | screws <= added


def test_tools_fit_the_nuts_of_each_step(plan: Plan) -> None:
    """M8 takes a 13 mm spanner, the M16 rods of the feet one of 24 mm, which nobody carries up to the nodes."""
    tools = {step.phase: step_words(step, "en").tools for step in plan.steps}
    spanners = {phase: [tool for tool in listed if "spanner" in tool] for phase, listed in tools.items()}
    for phase in ("prefabricate", "studs", "tighten", "ridges"):
        assert spanners[phase] == ["two 13 mm spanners"]
    assert spanners["stand"] == ["two 13 mm spanners and two 24 mm spanners"]


def test_the_bolts_named_at_the_studs_are_those_of_the_studs(plan: Plan) -> None:
    for step in (step for step in plan.steps if step.phase == "studs"):
        words = " ".join(step_words(step, "en").instructions)
        assert "(Bolt M8 x 65, a washer" in words
        assert "M8 x 40" not in words


def test_a_shell_makes_a_readable_booklet(plan: Plan) -> None:
    for shell in ("S1", "S2", "S3"):
        assert 20 <= len(steps_of(plan, shell)) <= 30
        for step in steps_of(plan, shell, "prefabricate"):
            assert len({mark[:8] for mark in step.marks if "-A" in mark}) <= 4


def test_no_screw_is_driven_and_no_edge_goes_in_before_the_shell_has_its_shape(plan: Plan) -> None:
    for shell in ("S1", "S2", "S3"):
        (hoist,) = steps_of(plan, shell, "hoist")
        early = [mark for step in steps_of(plan, shell) if step.number < hoist.number for mark in step.marks]
        assert not [mark for mark in early if parse_mark(mark).part[:1] == "W" or parse_mark(mark).family == "E"]
        assert hoist.marks == ()
        assert hoist.held
        assert step_words(hoist, "en").hold


def test_a_geodesic_gets_all_its_screws_in_one_step_from_both_sides(plan: Plan, gridshell: Gridshell) -> None:
    """A geodesic is stiff when it is screwed to the beams under it and over it: locking orders count on both."""
    shell = gridshell.shells[0]
    screws, blocks = {screw.mark for screw in shell.screws}, {block.mark for block in shell.blocks}
    held: dict[str, set[str]] = {}
    for joint in (joint for joint in shell.joints if joint.kind == "AG" and blocks & set(joint.members)):
        (geodesic,) = (mark for mark in joint.members if parse_mark(mark).family == "G")
        held.setdefault(geodesic, set()).update(mark for mark in joint.fasteners if mark in screws)
    steps = steps_of(plan, "S1", "fix geodesics")
    for marks in held.values():
        assert sum(marks <= set(step.marks) for step in steps) == 1


def test_identical_shells_are_put_together_alike(plan: Plan) -> None:
    def told(shell: str) -> list[tuple[object, ...]]:
        return [
            (
                step.id[3:],
                step.phase,
                *(step_title(step, language).replace(shell, "") for language in LANGUAGES),
                step.crew,
                [mark[3:] for mark in step.marks],
            )
            for step in steps_of(plan, shell)
        ]

    assert told("S1") == told("S2") == told("S3")


def test_the_same_gridshell_gives_the_same_plan(plan: Plan, gridshell: Gridshell) -> None:
    assert plan_of(gridshell, PEOPLE, LIFT) == plan


@pytest.mark.parametrize("count", [1, 2])
def test_fewer_shells_have_a_sound_plan(gridshell: Gridshell, count: int) -> None:
    fewer = replace(gridshell, shells=gridshell.shells[:count], blades=(), bolts=(), joints=())
    found = plan_of(fewer, PEOPLE, LIFT)
    assert check_plan(found, fewer) == []
    assert len(steps_of(found, "", "ridges")) == count - 1


def test_nobody_lifts_more_than_allowed(gridshell: Gridshell) -> None:
    weights = piece_weights(gridshell)
    for step in plan_of(gridshell, 2, 5.0).steps:
        lifted = step.assemblies or step.marks
        heavy = max((weights[mark][0] for mark in lifted), default=0.0)
        assert 1 <= step.crew <= 2
        if step.phase not in ("hoist", "stand", "ridges"):
            assert heavy <= step.crew * 5.0 or step.gear
        assert step.gear == ("lifting gear" in step_words(step, "en").tools)


def test_a_lone_carpenter_gets_a_plan_too(gridshell: Gridshell) -> None:
    assert {step.crew for step in plan_of(gridshell, 1, 25.0).steps} == {1}


@pytest.mark.parametrize(("people", "lift"), [(0, 25.0), (4, 0.0), (4, float("nan"))])
def test_a_crew_that_cannot_lift_is_refused(gridshell: Gridshell, people: int, lift: float) -> None:
    with pytest.raises(PlanError, match=r"crew\.people"):
        plan_of(gridshell, people, lift)


def test_a_part_that_no_joint_names_is_refused_by_its_mark(gridshell: Gridshell) -> None:
    shell = gridshell.shells[0]
    stray = replace(shell.bolts[0], mark="S1-N-999-B1")
    assert isinstance(stray, Bolt)
    damaged = replace(gridshell, shells=(replace(shell, bolts=(*shell.bolts, stray)), *gridshell.shells[1:]))
    with pytest.raises(PlanError, match="S1-N-999-B1"):
        plan_of(damaged, PEOPLE, LIFT)


def _swapped(plan: Plan, a: str, b: str) -> Plan:
    at = {step.id: i for i, step in enumerate(plan.steps)}
    steps = list(plan.steps)
    steps[at[a]], steps[at[b]] = steps[at[b]], steps[at[a]]
    return replace(plan, steps=tuple(replace(step, number=i) for i, step in enumerate(steps, start=1)))


FAULTS: list[tuple[Callable[[Plan], Plan], str]] = [
    (lambda plan: without(plan, "S1.lay.4"), "S1-G-14: no step adds it"),
    (lambda plan: changed(plan, "S1.lay.3", marks=("S1-G-01", "S1-G-01")), "S1-G-01: 2 steps add it"),
    (lambda plan: changed(plan, "S1.lay.3", marks=("S1-G-99",)), "S1-G-99: a step adds it, but"),
    (lambda plan: changed(plan, "S1.lay.3", predecessors=()), "nothing forces step S1.lay.1 before"),
    (lambda plan: changed(plan, "S1.hoist", predecessors=()), "is a stud, but nothing forces"),
    (lambda plan: changed(plan, "S1.hoist", held=False), "S1: expected one hoist step with a hold point"),
    (lambda plan: changed(plan, "S1.edge.lower", predecessors=()), "S1-E-01 is an edge plank, but nothing forces"),
    (lambda plan: changed(plan, "S2.tighten", predecessors=()), "S2-G-01 is part of the stiff shell"),
    (lambda plan: _swapped(plan, "S1.lay.3", "S1.lay.5"), "does not come before it"),
    (lambda plan: changed(plan, "S1.lay.1", assemblies=("S1-A1-01",)), "S1-A1-02: laid 0 times"),
    (lambda plan: changed(plan, "S1.lay.2", number=3), "step S1.lay.2: number 3, expected 8"),
    (lambda plan: without(plan, "S1.edge.upper"), "S1-R-01: no step adds it"),
    (lambda plan: changed(plan, "S1.tighten", predecessors=("S1.edge.lower",)), "S1-R-01 is part of the stiff shell"),
    (lambda plan: changed(plan, "site.stand.S2", predecessors=("S2.tighten",)), "S2-C-05 carries the shell"),
    (lambda plan: moved(plan, "S2-F-05-B1", "S2.tighten"), "S2-F-05-B1 bolts a shoe to the shell"),
    (lambda plan: moved(plan, "S3-C-14-T1", "S3.make.1"), "S3-C-14-T1 joins S3-F-14, but nothing forces"),
    (lambda plan: moved(plan, "R12-03", "S1.tighten"), "R12-03: nothing forces the standing of S1 before"),
    (lambda plan: moved(plan, "R23-03-B2", "site.feet"), "R23-03-B2 joins R23-03, but nothing forces"),
    (
        lambda plan: changed(plan, "site.ridge.S1.S2", predecessors=("site.stand.S1",)),
        "R12-01-B1: nothing forces the standing of S2 before",
    ),
    (lambda plan: moved(plan, "S1-D-05", "site.stand.S1"), "S1-D-05 covers S1, but nothing forces"),
    (lambda plan: moved(plan, "S1-P-13", "site.ridge.S1.S2"), "S1-P-13 covers S1, but nothing forces"),
    (
        lambda plan: changed(plan, "site.cover.S2", predecessors=("site.stand.S2",)),
        "S2-M-01 covers S2, but nothing forces step site.stand.S1",
    ),
]


@pytest.mark.parametrize(("damage", "complaint"), FAULTS)
def test_the_check_finds_a_damaged_plan(
    plan: Plan, gridshell: Gridshell, damage: Callable[[Plan], Plan], complaint: str
) -> None:
    assert any(complaint in problem for problem in check_plan(damage(plan), gridshell))


def test_blades_join_the_shells_that_they_name_once_both_stand(gridshell: Gridshell) -> None:
    blades = tuple(blade for blade in gridshell.blades if blade.mark in ("R23-01", "R23-02"))
    joints = tuple(joint for joint in gridshell.joints if joint.mark in ("R23-01", "R23-02"))
    stiff = {shell.mark: f"{shell.mark}.tighten" for shell in gridshell.shells}
    works = {work.id: work for work in site_works(replace(gridshell, blades=blades, joints=joints), stiff)}
    bolts = tuple(f"{blade}-B{i}" for blade in ("R23-01", "R23-02") for i in (1, 2, 3, 4))
    assert works["site.ridge.S2.S3"].marks == ("R23-01", "R23-02", *bolts)
    assert {"site.stand.S2", "site.stand.S3"} <= set(works["site.ridge.S2.S3"].after)
    assert "site.ridge.S1.S2" not in works
