"""A plan for shells that are cut for the journey: parted once, standing beside each other on props, joined again."""

import re
from collections import Counter
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from damage import changed, moved, without

from aag_cad.design import Design, load_design
from aag_cad.language import printed
from aag_cad.parts.model import Gridshell, all_parts
from aag_cad.pipeline import gridshell_of
from aag_cad.units import Floats
from assembly.base.locking_order import LockingOrder
from assembly.base.segments import Brace, Limits, Segmentation
from assembly.base.steps import Bracing, Plan, PropsAway, SplicePut, Step, StepProp, WholeShell, carried
from assembly.booklet.step_words import step_words
from assembly.checks.disassembly import check_disassembly
from assembly.checks.plan import check_plan
from assembly.locking.order import locking_orders
from assembly.plan.assembly_plan import plan_of
from assembly.plan.disassembly import disassembly_of
from assembly.plan.durations import step_minutes
from assembly.plan.parting import divide_works
from assembly.plan.piece_weights import piece_weights
from assembly.plan.schedule import schedule_of
from assembly.plan.site_work import site_works
from assembly.transport.lifting import margin_inside, standing_margin, standing_props
from assembly.transport.seams import seams, standing_order
from assembly.transport.segments import segments

LORRY = Limits(12000.0, 2400.0, 2600.0, 3000.0)
NARROW = Limits(12000.0, 2400.0, 2400.0, 3000.0)


@pytest.fixture(scope="module")
def pair(gridshell: Gridshell) -> Gridshell:
    """Two shells of the vault that meet along a ridge."""
    return replace(gridshell, shells=gridshell.shells[:2], blades=(), bolts=(), joints=())


@pytest.fixture(scope="module")
def cut(pair: Gridshell) -> Segmentation:
    return segments(pair, LORRY)


@pytest.fixture(scope="module")
def locking(pair: Gridshell) -> tuple[LockingOrder, ...]:
    return locking_orders(pair)


@pytest.fixture(scope="module")
def plan(pair: Gridshell, cut: Segmentation, locking: tuple[LockingOrder, ...]) -> Plan:
    return plan_of(pair, 4, 25.0, locking=locking, segmentation=cut)


def step(plan: Plan, step_id: str) -> Step:
    return next(step for step in plan.steps if step.id == step_id)


def said(step: Step) -> tuple[str, ...]:
    """Return what the card of a step says of its extras."""
    return step_words(step, "en").extras


def _braced(step: Step) -> list[tuple[str, Brace]]:
    return [(extra.segment, extra.brace) for extra in step.extras if isinstance(extra, Bracing)]


def _props(*joints: str) -> tuple[StepProp, ...]:
    return tuple(StepProp(joint, "S1.1") for joint in joints)


def _carried(step: Step) -> list[str]:
    return carried(step.phase, (), step.assemblies, step.segments)


def test_a_plan_with_cut_shells_has_no_fault(
    plan: Plan, pair: Gridshell, cut: Segmentation, locking: tuple[LockingOrder, ...]
) -> None:
    assert check_plan(plan, pair, cut, locking) == []


def test_what_is_opened_for_the_journey_is_not_added_twice(plan: Plan, pair: Gridshell) -> None:
    placed = Counter(mark for step in plan.steps for mark in step.marks)
    assert placed == Counter(part.mark for part in all_parts(pair))
    assert all(not step.marks for step in plan.steps if step.phase in ("divide", "splice"))


def test_the_middle_of_a_shell_stands_first_and_each_next_segment_is_joined_at_once(plan: Plan) -> None:
    own = [step.id for step in plan.steps if step.phase in ("stand", "splice") and "S1" in step.assemblies]
    assert own == [
        "site.stand.S1.2", "site.stand.S1.3", "site.splice.S1.3.S1.2", "site.stand.S1.1", "site.splice.S1.1.S1.2",
    ]  # fmt: skip


def test_of_four_segments_the_higher_inner_one_stands_first(pair: Gridshell) -> None:
    plan = segments(replace(pair, shells=pair.shells[:1]), NARROW)
    order = [segment.name for segment, _ in standing_order(pair.shells[0], plan)]
    assert order == ["S1.2", "S1.3", "S1.1", "S1.4"]


def test_the_last_segment_of_a_closed_ring_is_joined_on_both_sides() -> None:
    column = gridshell_of(load_design("column"))
    plan = segments(column, Limits(50000.0, 50000.0, 50000.0, 400.0))
    assert len(seams(column.shells[0], plan)) == len(plan.segments) == 2
    beside = [len(joined) for _, joined in standing_order(column.shells[0], plan)]
    assert beside == [0, 2]
    works = {work.id: work for work in site_works(column, {"S1": "S1.divide"}, plan)}
    assert any("closes the ring" in printed(note, "en") for note in works["site.stand.S1.2"].notes)


def test_every_splice_is_made_once_taken_out_once_and_put_in_once(plan: Plan, cut: Segmentation) -> None:
    for splice in (splice for splice in cut.splices if splice.kind == "block"):
        shell, beam, joint = splice.member[:2], splice.member[3:], splice.joint[3:]
        own = [s for s in plan.steps if shell in (s.shell, *s.assemblies)]
        put = Counter(
            (s.phase, extra.work)
            for s in own
            for extra in s.extras
            if isinstance(extra, SplicePut) and (extra.member, extra.joint) == (splice.member, splice.joint)
        )
        assert put == {("prefabricate", "made"): 1, ("divide", "divide"): 1, ("splice", "splice"): 1}
        told = Counter(s.phase for s in own for extra in said(s) if re.search(rf"\b{beam} at {joint}\b", extra))
        assert told == {"prefabricate": 1, "divide": 1, "splice": 1}
        (made,) = (s for s in own if s.phase == "prefabricate" and splice.cuts[0].plank in s.marks)
        assert any(f"cut along {splice.line[3:]}" in x and f"{beam} at {joint}" in x for x in said(made))


def test_bracing_goes_on_before_the_journey_and_comes_off_when_a_segment_is_joined(
    plan: Plan, cut: Segmentation
) -> None:
    for shell in ("S1", "S2"):
        parted = step(plan, f"{shell}.divide")
        on = [x.removeprefix("put on ") for x in said(parted) if x.startswith("put on ")]
        joins = [s for s in plan.steps if s.phase == "splice" and shell in s.assemblies]
        off = [x.removeprefix("take off ") for s in joins for x in said(s) if x.startswith("take off ")]
        assert Counter(on) == Counter(off)
        braced = Counter((s.name, brace) for s in cut.segments if s.shell == shell for brace in s.braces)
        assert Counter(_braced(parted)) == braced == Counter(x for s in joins for x in _braced(s))
        assert len(on) == sum(len(segment.braces) for segment in cut.segments if segment.shell == shell)
        middle = [x for x in said(joins[0]) if x.startswith(f"take off {shell}.2")]
        assert not middle


def test_fasteners_of_no_segment_belong_to_one_seam(pair: Gridshell, cut: Segmentation) -> None:
    found = Counter(mark for shell in pair.shells for seam in seams(shell, cut) for mark in seam.fasteners)
    assert found == Counter(cut.site)


def test_each_segment_gets_the_bolts_of_its_own_shoes(plan: Plan, pair: Gridshell, cut: Segmentation) -> None:
    joints = {joint.mark: joint for joint in pair.shells[0].joints}
    for segment in (segment for segment in cut.segments if segment.shell == "S1"):
        for mark in step(plan, f"site.stand.{segment.name}").marks:
            assert set(joints[mark.rpartition("-")[0]].members) & set(segment.geodesics)


def test_props_hold_every_segment_and_stay_until_the_last_ridge(plan: Plan, locking: tuple[LockingOrder, ...]) -> None:
    stands = [s for s in plan.steps if s.phase == "stand"]
    assert all(len(s.props) >= 2 for s in stands)
    crown = {prop.joint for order in locking for prop in order.released.props}
    assert crown
    assert crown <= {joint for s in stands for joint in s.propped}
    assert all(prop.holds in s.segments for s in stands for prop in s.props)
    last = [s for s in plan.steps if s.phase == "ridges"][-1]
    assert crown <= set(last.propped)
    (away,) = (extra for extra in last.extras if isinstance(extra, PropsAway))
    assert set(away.joints) == {joint for s in stands for joint in s.propped}
    assert all(joint in " ".join(said(last)) for joint in away.joints)


def test_a_whole_shell_stands_on_the_prop_of_its_locking_order(
    pair: Gridshell, locking: tuple[LockingOrder, ...]
) -> None:
    whole = plan_of(pair, 4, 25.0, locking=locking)
    assert check_plan(whole, pair, None, locking) == []
    for order in locking:
        props = tuple(StepProp(prop.joint, order.shell) for prop in order.released.props)
        assert step(whole, f"site.stand.{order.shell}").props == props
    assert divide_works(pair, pair.shells[0], None, "S1.tighten") == ()


def test_both_languages_tell_the_same_extras_in_their_own_words(plan: Plan) -> None:
    for each in plan.steps:
        ours, theirs = said(each), step_words(each, "de").extras
        assert len(ours) == len(theirs) == len(each.extras)
        assert not set(ours) & set(theirs)


def test_ids_mean_nothing_so_that_a_plan_may_call_its_steps_as_it_likes(
    design: Design, plan: Plan, pair: Gridshell, cut: Segmentation, locking: tuple[LockingOrder, ...]
) -> None:
    """The check, the times and the schedule of the crew go by phases, marks and segments alone."""
    names = {each.id: f"x{len(plan.steps) - i}" for i, each in enumerate(plan.steps)}
    renamed = replace(
        plan,
        steps=tuple(
            replace(each, id=names[each.id], predecessors=tuple(names[before] for before in each.predecessors))
            for each in plan.steps
        ),
    )
    assert check_plan(renamed, pair, cut, locking) == []
    minutes, again = (step_minutes(each, pair, design.crew.minutes) for each in (plan, renamed))
    assert again == {names[name]: spent for name, spent in minutes.items()}
    first, second = (schedule_of(each, spent, 4) for each, spent in ((plan, minutes), (renamed, again)))
    assert [replace(when, id=names[when.id]) for when in first.steps] == list(second.steps)


def test_the_margin_inside_a_square_is_the_distance_to_its_nearest_side() -> None:
    square = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)])
    assert margin_inside(square, np.array([1.0, 2.0])) == pytest.approx(1.0)
    assert margin_inside(square, np.array([5.0, 2.0])) == pytest.approx(-1.0)
    assert margin_inside(square[:2], np.array([1.0, 0.0])) == -np.inf


def test_where_feet_and_studs_are_in_one_line_blocks_beside_it_are_propped() -> None:
    """No two of the studs hold what stands there; on the blocks its plumb line runs 300 mm from the feet."""

    def along(*xs: float, y: float = 0.0, z: float = 0.0) -> list[Floats]:
        return [np.array([x, y, z]) for x in xs]

    feet, centre = along(0.0, 1000.0), np.array([500.0, 300.0, 800.0])
    studs = dict(zip("abc", along(0.0, 500.0, 1000.0, z=1500.0), strict=True))
    blocks = dict(zip("de", along(0.0, 1000.0, y=1000.0, z=1000.0), strict=True))
    assert standing_props(feet, studs, blocks, centre) == ("d", "e")
    assert standing_margin(feet, list(blocks.values()), centre) == pytest.approx(300.0)


FAULTS: list[tuple[Callable[[Plan], Plan], str]] = [
    (lambda p: without(p, "S1.divide"), "S1: expected one divide step"),
    (lambda p: changed(p, "S1.divide", extras=()), "S1: expected one divide step with hold point, props and what"),
    (lambda p: changed(p, "S1.divide", props=()), "S1: expected one divide step with hold point, props and what"),
    (lambda p: changed(p, "S1.divide", predecessors=()), "is part of the stiff shell, but nothing forces"),
    (lambda p: without(p, "site.stand.S1.2"), "S1.2: expected one stand step"),
    (lambda p: changed(p, "site.stand.S1.2", held=False), "S1.2: expected one stand step with a hold point"),
    (lambda p: changed(p, "site.stand.S1.2", segments=("S1.4",)), "stands what is no segment of it"),
    (
        lambda p: changed(p, "site.stand.S1.2", predecessors=("site.feet", "S1.tighten")),
        "S1.2: stands in step site.stand.S1.2, but nothing forces the parting of S1",
    ),
    (lambda p: changed(p, "site.stand.S1.1", props=()), "S1.1: step site.stand.S1.1 names 0 props"),
    (
        lambda p: changed(p, "site.stand.S1.1", props=_props("S2-N-082", "S2-N-064")),
        "names 2 props of S1, expected",
    ),
    # Studs at its foot hold nothing: the centre of gravity lies further in.
    (
        lambda p: changed(p, "site.stand.S1.1", props=_props("S1-N-001", "S1-N-007")),
        "S1.1: its centre of gravity is outside",
    ),
    (
        lambda p: changed(p, "site.stand.S1.3", predecessors=("site.feet", "S1.divide")),
        "S1.3: nothing forces a segment beside it to stand",
    ),
    (lambda p: without(p, "site.splice.S1.3.S1.2"), "S1.2, S1.3: expected one splice step"),
    (lambda p: changed(p, "site.splice.S1.3.S1.2", extras=()), "S1.2, S1.3: expected one splice step"),
    (
        lambda p: changed(p, "site.splice.S1.1.S1.2", predecessors=("site.stand.S1.2",)),
        "S1.1: joined in step site.splice.S1.1.S1.2, but nothing forces its standing",
    ),
    (lambda p: moved(p, "S1-F-01-B1", "site.stand.S1.2"), "S1-F-01-B1 bolts a shoe of S1.1"),
    (
        lambda p: changed(p, "site.stand.S1.2", props=_props("S1-N-086", "S1-N-088")),
        "S1: stands without the prop under S1-K-",
    ),
    (lambda p: changed(p, "site.ridge.S1.S2", props=()), "is not named in step site.ridge.S1.S2"),
    (lambda p: changed(p, "S1.hoist", props=()), "step S1.hoist: the shell needs a prop under"),
    (lambda p: changed(p, "S1.fix.1", props=()), "step S1.fix.1: the shell needs a prop under"),
    (lambda p: changed(p, "S1.tighten", props=()), "step S1.tighten: the shell needs a prop under"),
    (lambda p: changed(p, "S1.fix.2", predecessors=("S1.edge.upper",)), "but nothing forces step S1.fix.1 before it"),
    (lambda p: changed(p, "S1.fix.1", predecessors=("S1.hoist",)), "but nothing forces step S1.edge.upper before it"),
    (lambda p: moved(p, "S1-N-040-B1", "S1.tighten"), "S1-N-040-B1 holds a stud, but nothing forces"),
    (
        lambda p: changed(p, "site.cover.S1", predecessors=("site.stand.S1.2", "site.stand.S2.2")),
        "covers S1, but nothing forces step",
    ),
]


@pytest.mark.parametrize(("damage", "complaint"), FAULTS)
def test_the_check_finds_a_damaged_journey(
    plan: Plan,
    pair: Gridshell,
    cut: Segmentation,
    locking: tuple[LockingOrder, ...],
    damage: Callable[[Plan], Plan],
    complaint: str,
) -> None:
    assert any(complaint in problem for problem in check_plan(damage(plan), pair, cut, locking))


def test_a_shell_that_travels_whole_must_not_be_parted(plan: Plan, pair: Gridshell) -> None:
    problems = check_plan(plan, pair)
    assert "S1: travels whole, but step S1.divide is there" in problems
    assert "S1: expected one stand step with a hold point" in problems


def _with_slide(plan: Plan, geodesic: str) -> Plan:
    """Slide a geodesic in after all beams are laid, instead of laying it."""
    shell = geodesic[:2]
    laid = [s for s in plan.steps if s.shell == shell and s.phase.startswith("lay")][-1]
    steps: list[Step] = []
    for old in plan.steps:
        steps.append(replace(old, marks=tuple(mark for mark in old.marks if mark != geodesic)))
        if old.id == laid.id:
            slide = replace(old, id=f"{shell}.slide.1", phase="slide", marks=(geodesic,), assemblies=())
            steps.append(replace(slide, predecessors=(laid.id,)))
        elif old.id == f"{shell}.stud.1":
            steps[-1] = replace(steps[-1], predecessors=(f"{shell}.slide.1",))
    return replace(plan, steps=tuple(replace(s, number=i) for i, s in enumerate(steps, start=1)))


def test_a_geodesic_may_be_slid_in_after_the_beams_above_it(plan: Plan, pair: Gridshell, cut: Segmentation) -> None:
    slid = _with_slide(plan, "S1-G-05")
    assert check_plan(slid, pair, cut) == []
    early = changed(slid, "S1.slide.1", predecessors=("S1.lay.1",))
    assert any("S1-G-05 in step S1.slide.1 passes" in problem for problem in check_plan(early, pair, cut))


def test_a_segment_is_carried_and_not_its_shell(plan: Plan, pair: Gridshell, cut: Segmentation) -> None:
    """A segment of 93 kg is for four people of 25 kg; the shell of 319 kg would need lifting gear."""
    weights = piece_weights(pair, cut)
    for segment in cut.segments:
        stand = step(plan, f"site.stand.{segment.name}")
        assert _carried(stand) == [segment.name]
        assert weights[segment.name] == (segment.mass, 0.0)
        assert not any("stiff shell" in line for line in step_words(stand, "en").instructions)
    assert _carried(step(plan, "S1.divide")) == ["S1.1", "S1.2", "S1.3"]
    assert not any(_carried(s) for s in plan.steps if s.phase == "splice")
    assert sum(weights[f"S1.{i}"][0] for i in (1, 2, 3)) < weights["S1"][0]


def test_splices_come_out_with_their_beams_and_edge_planks_when_the_gridshell_is_taken_down(
    pair: Gridshell, cut: Segmentation
) -> None:
    down = disassembly_of(pair, 4, 25.0, segmentation=cut)
    assert check_disassembly(down, pair) == []
    for splice in cut.splices:
        member = splice.member[3:]
        phases = [
            s.phase
            for s in down.steps
            for extra in said(s)
            if set(s.marks) & {at.plank for at in splice.cuts} and re.search(rf": {member}\b", extra)
            if f" {splice.line[3:]}" in extra
        ]
        assert phases == ["unbolt" if splice.kind == "block" else "pull edge planks"]
        put = [
            (s.phase, extra.work, {at.plank for at in extra.stations} <= set(s.marks))
            for s in down.steps
            for extra in s.extras
            if isinstance(extra, SplicePut) and (extra.member, extra.line) == (splice.member, splice.line)
        ]
        assert put == [(phases[0], "unmade", True)]
    first, *_ = (s for s in down.steps if s.phase == "lift off")
    assert "S1.1, S1.2, S1.3" in said(first)[0]
    assert [extra.segments for extra in first.extras if isinstance(extra, WholeShell)] == [("S1.1", "S1.2", "S1.3")]
    assert not any(s.extras for s in disassembly_of(pair, 4, 25.0).steps)
