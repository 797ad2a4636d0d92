"""An independent look at what holds a shell: the order of fixing, props, and the segments of shells that are cut."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from aag_cad.parts.index import index_of
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Gridshell, Shell
from assembly.base.locking_order import LockingOrder
from assembly.base.phases import Phase
from assembly.base.segments import Segment, Segmentation
from assembly.base.steps import Plan, Step
from assembly.checks.walking import ancestors, surrounds

_LEAST_PROPS = 2


def _steps(plan: Plan, phase: Phase, shell: str) -> list[Step]:
    return [step for step in plan.steps if step.phase == phase and (step.shell == shell or shell in step.assemblies)]


def _held(shell: Shell, segment: Segment, props: Sequence[str]) -> bool:
    """Return whether the plumb line of a segment runs inside its feet and props, in plan."""
    matrix = frame_matrix(shell.placement)
    own = set(segment.geodesics)
    points = [
        matrix[:3, :3] @ np.array(joint.point) + matrix[:3, 3]
        for joint in shell.joints
        if joint.mark in props or (joint.kind == "foot" and own & set(joint.members))
    ]
    return bool(points) and surrounds(np.array(points)[:, :2], np.array(segment.centre)[:2])


def _stand_problems(
    shell: Shell, segment: Segment, stands: Sequence[Step], parted: str, forced: set[str]
) -> Iterator[str]:
    name = segment.name
    if len(stands) != 1 or not stands[0].held:
        yield f"{name}: expected one stand step" + (" with a hold point" if stands else "")
    for stand in stands:
        if parted not in forced:
            yield f"{name}: stands in step {stand.id}, but nothing forces the parting of {shell.mark} before it"
        if len(stand.propped) < _LEAST_PROPS or not set(stand.propped) <= index_of(shell).joints.keys():
            yield f"{name}: step {stand.id} names {len(stand.propped)} props of {shell.mark}, expected at least 2"
        elif not _held(shell, segment, stand.propped):
            yield f"{name}: its centre of gravity is outside its feet and the props of step {stand.id}: it falls"


def _shoe_problems(plan: Plan, shell: Shell, segment: Segment, forced: dict[str, set[str]]) -> Iterator[str]:
    """Yield the bolts of a segment's shoes that are put in before it stands."""
    own = set(segment.geodesics)
    stood = {step.id for step in plan.steps if step.phase == "stand" and segment.name in step.segments}
    bolts = {m for joint in shell.joints if joint.kind == "foot" and own & set(joint.members) for m in joint.fasteners}
    for step in plan.steps:
        for mark in (mark for mark in step.marks if mark in bolts and not stood & {step.id, *forced[step.id]}):
            yield f"{mark} bolts a shoe of {segment.name}, but nothing forces its standing before step {step.id}"


def _cut_problems(plan: Plan, shell: Shell, own: Sequence[Segment]) -> Iterator[str]:
    """Yield what is wrong with the parting, the standing and the joining of the segments of one shell."""
    forced = ancestors(plan)
    divides, joins = _steps(plan, "divide", shell.mark), _steps(plan, "splice", shell.mark)
    if len(divides) != 1 or not (divides[0].held and divides[0].extras and divides[0].props):
        yield f"{shell.mark}: expected one divide step with hold point, props and what it takes out"
    parted = divides[0].id if divides else ""
    found_stands = _steps(plan, "stand", shell.mark)
    stands = {s.name: [step for step in found_stands if step.segments == (s.name,)] for s in own}
    strays = {step.id for step in found_stands} - {step.id for steps in stands.values() for step in steps}
    yield from (f"{shell.mark}: step {stray} stands what is no segment of it" for stray in sorted(strays))
    for segment in own:
        found = stands[segment.name]
        yield from _stand_problems(shell, segment, found, parted, forced[found[0].id] if found else set())
        yield from _shoe_problems(plan, shell, segment, forced)
    order = [step.id for step in plan.steps]
    first = min((order.index(steps[0].id) for steps in stands.values() if steps), default=-1)
    names = [segment.name for segment in own]
    beside = {a: {names[i - 1], names[(i + 1) % len(names)]} for i, a in enumerate(names)}
    for name, steps in stands.items():
        near = {step.id for other in beside[name] for step in stands[other]}
        if steps and order.index(steps[0].id) != first and not near & forced[steps[0].id]:
            yield f"{name}: nothing forces a segment beside it to stand before step {steps[0].id}"
    for a, b in pairwise(names):
        own_joins = [step for step in joins if set(step.segments) == {a, b}]
        if len(own_joins) != 1 or not own_joins[0].extras:
            yield f"{a}, {b}: expected one splice step that says what it puts in"
        for step in own_joins:
            missing = [s for s in (a, b) if not {stand.id for stand in stands[s]} & forced[step.id]]
            yield from (f"{s}: joined in step {step.id}, but nothing forces its standing before" for s in missing)


def travel_problems(plan: Plan, shell: Shell, segmentation: Segmentation | None) -> Iterator[str]:
    """Yield what is wrong with the journey of a shell: whole, it stands once and is never parted.

    A cut shell is parted once; every segment stands once with a hold point, on at least two props inside which and its
    feet its plumb line runs, after the first one always beside one that stands; neighbours are joined once, both there.
    """
    own = [s for s in segmentation.segments if s.shell == shell.mark] if segmentation else []
    if len(own) > 1:
        yield from _cut_problems(plan, shell, own)
        return
    stands = _steps(plan, "stand", shell.mark)
    if len(stands) != 1 or not stands[0].held:
        yield f"{shell.mark}: expected one stand step" + (" with a hold point" if stands else "")
    parted = (*_steps(plan, "divide", shell.mark), *_steps(plan, "splice", shell.mark))
    yield from (f"{shell.mark}: travels whole, but step {step.id} is there" for step in parted)


def prop_problems(plan: Plan, order: LockingOrder) -> Iterator[str]:
    """Yield props that a finished shell needs until its neighbours hold it and that no stand or ridge step names."""
    wanted = {prop.joint for prop in order.released.props}
    stands = _steps(plan, "stand", order.shell)
    under = {joint for step in stands for joint in step.propped}
    for joint in sorted(wanted - under) if stands else ():
        yield f"{order.shell}: stands without the prop under {joint}, and sinks by {order.released.displacement:.0f} mm"
    for step in (step for step in plan.steps if step.phase == "ridges" and order.shell in step.assemblies):
        for joint in sorted(wanted - set(step.propped)):
            yield f"{order.shell}: the prop under {joint} is not named in step {step.id}, before its ridges are joined"


def _fixed_in(plan: Plan, gridshell: Gridshell, order: LockingOrder) -> dict[str, Step]:
    """Return the step in which each flat plank of a shell gets its screws into blocks."""
    index = index_of(index_of(gridshell).shells[order.shell])
    found: dict[str, Step] = {}
    for step in plan.steps:
        for screw in (mark for mark in step.marks if mark in index.screws and mark in index.joint_of_fastener):
            joint = index.joint_of_fastener[screw]
            flat = (mark for mark in joint.members if mark in index.planks and not index.planks[mark].upright)
            found |= dict.fromkeys(flat if joint.kind != "cover" else (), step)
    return found


def locking_problems(plan: Plan, gridshell: Gridshell, order: LockingOrder) -> Iterator[str]:
    """Yield what breaks the locking order of a shell: planks fixed too soon, steps without the props of their state."""
    forced, fixed = ancestors(plan), _fixed_in(plan, gridshell, order)
    steps = [(group, [fixed[mark] for mark in group.marks if mark in fixed]) for group in order.steps]
    for (_, before), (group, after) in pairwise(steps):
        for first, then in ((first, then) for first in before for then in after):
            if first.id != then.id and first.id not in forced[then.id]:
                yield f"{', '.join(group.marks)}: fixed in step {then.id}, but nothing forces step {first.id} before it"
    state = order.steps[0]
    for step in _steps(plan, "hoist", order.shell):
        yield from _missing(step, {*order.hoists, *(prop.joint for prop in state.props)})
    seen: set[str] = set()
    for before_state, (_, after) in zip(order.steps, steps[1:], strict=False):
        for step in (step for step in after if step.id not in seen):
            seen.add(step.id)
            yield from _missing(step, {*order.hoists, *(prop.joint for prop in before_state.props)})
    for step in _steps(plan, "tighten", order.shell):
        yield from _missing(step, set(order.hoists))


def _missing(step: Step, wanted: set[str]) -> Iterator[str]:
    for joint in sorted(wanted - set(step.propped)):
        yield f"step {step.id}: the shell needs a prop under {joint}, which it does not name"
