"""An independent look at a plan of taking down: walks its steps over the data and lists what is wrong."""

from collections import Counter
from collections.abc import Iterator
from itertools import combinations, product
from typing import TypeAlias

import numpy as np

from aag_cad.parts.index import index_of
from aag_cad.parts.marks import parse_mark
from aag_cad.parts.model import Bolt, Gridshell, Joint, Part, Shell, all_joints
from assembly.base.steps import Plan, Step
from assembly.checks.walking import ancestors, numbering_problems, surrounds

# A place in the plan: the step, and the turn in it. A rule: why, what comes first, what then.
_Place: TypeAlias = tuple[str, int]
_Rule: TypeAlias = tuple[str, _Place, _Place]

_LETTING_GO = ("open ridges", "lift off", "hang", "release geodesics", "pull edge planks", "lower")


def _once(plan: Plan, gridshell: Gridshell) -> Iterator[str]:
    """Yield what does not leave once: parts, beams off the flat shell, shells off their feet, planks measured."""
    planks = index_of(gridshell).planks.keys()
    shells = index_of(gridshell).shells.keys()
    beams = index_of(gridshell).beams.keys()
    wanted = (
        ("leaves", index_of(gridshell).parts.keys(), Counter(m for step in plan.steps for m in step.marks)),
        ("is taken off", beams, _moved(plan, "take off beams")),
        ("is measured", planks, _moved(plan, "passports")),
        *(
            ("has a step '" + phase + "'", shells, _moved(plan, phase))
            for phase in ("prop", "lift off", "hang", "lower")
        ),
    )
    for verb, marks, found in wanted:
        for mark in sorted(marks | set(found)):
            times, due = found[mark], int(mark in marks)
            if times != due:
                yield f"{mark}: {verb} {times} times, expected {due}"


def _moved(plan: Plan, phase: str) -> Counter[str]:
    return Counter(mark for step in plan.steps if step.phase == phase for mark in step.assemblies)


def _places(plan: Plan, gridshell: Gridshell) -> tuple[dict[str, _Place], dict[str, _Place]]:
    """Return where each part leaves the plan, and where each plank leaves its place in the shell.

    A plank of a beam leaves its place when the beam is taken off, once all parts that leave in that step are out.
    """
    leaves = {mark: (step.id, i) for step in plan.steps for i, mark in enumerate(step.marks)}
    off = {
        mark: (step.id, len(step.marks) + i)
        for step in plan.steps
        if step.phase == "take off beams"
        for i, mark in enumerate(step.assemblies)
    }
    planks = index_of(gridshell).planks
    lying = {mark: off.get(plank.beam) or leaves.get(mark) for mark, plank in planks.items()}
    return leaves, {mark: place for mark, place in lying.items() if place is not None}


def _nearest_beam(shell: Shell, joint: Joint, bolt: Bolt) -> str:
    """Return the beam that a bolt of a stud passes through: the one whose centre line is nearest to the bolt."""
    middle = np.array(bolt.frame.origin) + bolt.grip / 2.0 * np.array(bolt.frame.z)
    distances = {
        beam.mark: float(np.linalg.norm(beam.curve.point_spline(place.station) - middle))
        for beam in shell.beams
        for place in beam.joints
        if place.joint == joint.mark
    }
    return min(distances, key=lambda mark: (distances[mark], mark))


def _fastened(gridshell: Gridshell, leaves: dict[str, _Place], lying: dict[str, _Place]) -> Iterator[_Rule]:
    """Yield (reason, first, then) for each fastener and what it holds; a stud's bolts go with the beam that they hold.

    The bolts of the lowest beam of a stud hold the stud only: both go to the trestles in that beam. A threaded rod
    stands in its block until the shoe is off.
    """
    for joint in (joint for joint in all_joints(gridshell) if joint.kind not in ("AA", "footing")):
        for fastener, member in product(joint.fasteners, joint.members):
            block_bolt = joint.kind in ("AG", "boundary") and parse_mark(fastener).letter == "B"
            then = leaves.get(member) if block_bolt else lying.get(member, leaves.get(member))
            # A block bolt holds block and planks of its beam; the flat plank on the block is held by the screw.
            if block_bolt and not parse_mark(member).part and member in lying:
                continue
            if fastener in leaves and then is not None:
                yield f"{fastener} holds {member}", leaves[fastener], then
    for shell in gridshell.shells:
        index = index_of(shell)
        for joint in (joint for joint in shell.joints if joint.kind == "AA"):
            listed = {index.planks[m].beam for m in joint.members if m in index.planks}
            beams = sorted(listed, key=lambda mark: index.beams[mark].layer)
            for fastener in (mark for mark in joint.fasteners if mark in leaves and joint.mark in leaves):
                yield f"{fastener} holds {joint.mark}", leaves[fastener], leaves[joint.mark]
                beam = _nearest_beam(shell, joint, index.bolts[fastener])
                for plank in index.beams[beam].planks:
                    place = lying if beam != beams[0] else leaves
                    if plank in place:
                        yield f"{fastener} holds {plank} of {beam}", leaves[fastener], place[plank]


def _covered(gridshell: Gridshell, lying: dict[str, _Place]) -> Iterator[_Rule]:
    """Yield the order of planks that cross; edge planks are drawn out lengthwise between the others."""
    planks, edges = index_of(gridshell).planks, index_of(gridshell).edges
    for joint in (joint for shell in gridshell.shells for joint in shell.joints):
        members = [mark for mark in joint.members if mark in lying]
        for upper, lower in product(members, members):
            if planks[upper].layer > planks[lower].layer and not {upper, lower} & edges.keys():
                yield f"{upper} lies on {lower} at {joint.mark}", lying[upper], lying[lower]


def _steps(plan: Plan, phase: str, unit: str = "") -> list[Step]:
    """Return the steps of a phase; with a unit only those of its chapter or that move it."""
    found = (step for step in plan.steps if step.phase == phase)
    return [step for step in found if not unit or unit == step.shell or unit in step.assemblies]


def _standing(plan: Plan, shell: Shell, leaves: dict[str, _Place]) -> Iterator[_Rule]:
    """Yield what holds a standing shell: its cover goes first, its props bear before ridges and feet let go."""
    props = [(step.id, 0) for step in _steps(plan, "prop")]
    lifts = [(step.id, -1) for step in _steps(plan, "lift off", shell.mark)]
    opened = [(step.id, 0) for step in _steps(plan, "open ridges")]
    covering = {mark for joint in shell.joints if joint.kind == "cover" for mark in joint.fasteners}
    bars: tuple[Part, ...] = (*shell.mullions, *shell.strips, *shell.clamps)
    covering |= {part.mark for part in bars}
    for mark, prop in product(sorted(covering & set(leaves)), props):
        yield f"{mark} loads {shell.mark}", leaves[mark], prop
    yield from ((f"{shell.mark} leans on its neighbours", prop, then) for prop in props for then in (*opened, *lifts))
    for ridge, lift in product(_steps(plan, "open ridges", shell.mark), lifts):
        yield f"{shell.mark} is joined along a ridge", (ridge.id, 0), lift
    bolted = {mark for joint in shell.joints if joint.kind == "foot" for mark in joint.fasteners}
    carrying: tuple[Part, ...] = (*shell.shoes, *shell.rods, *shell.footings)
    feet = bolted | {part.mark for part in carrying}
    for mark, lift in product(sorted(feet & set(leaves)), lifts):
        yield f"{mark} carries {shell.mark}", lift, leaves[mark]


def _hanging(plan: Plan, shell: Shell, leaves: dict[str, _Place]) -> Iterator[_Rule]:
    """Yield what keeps a shell in shape until it hangs, and what must be out or loose before it comes down flat."""
    covering = {mark for joint in shell.joints if joint.kind == "cover" for mark in joint.fasteners}
    chain = [_steps(plan, phase, shell.mark)[:1] for phase in ("lift off", "hang", "lower")]
    if not all(chain):
        return
    lift, hang, lower = ((step[0].id, -1) for step in chain)
    yield f"{shell.mark} is off its feet before it hangs", lift, hang
    yield f"{shell.mark} hangs before it is lowered", hang, lower
    bracing = index_of(shell).screws.keys() - covering
    bracing |= index_of(shell).edges.keys() | index_of(shell).straps.keys()
    for mark in sorted(bracing & set(leaves)):
        yield f"{mark} keeps the shape of {shell.mark} until it hangs", hang, leaves[mark]
        yield f"{mark} must be out before the nodes turn", leaves[mark], lower
    for mark in sorted(index_of(shell).studs.keys() & set(leaves)):
        yield f"{mark} holds {shell.mark} until it lies flat", lower, leaves[mark]
    for step in (step for beam in shell.beams for step in _steps(plan, "take off beams", beam.mark)):
        yield f"beams carry {shell.mark} until it lies flat", lower, (step.id, 0)


def _one_by_one(plan: Plan, forced: dict[str, set[str]]) -> Iterator[str]:
    """Yield pairs of shells that may hang at the same time: one set of hoists serves all."""
    ends = {mark: step.id for step in plan.steps if step.phase == "lower" for mark in step.assemblies}
    hung = {mark: step.id for step in plan.steps if step.phase == "hang" for mark in step.assemblies}
    for a, b in combinations(sorted(set(ends) & set(hung)), 2):
        if ends[a] not in forced[hung[b]] and ends[b] not in forced[hung[a]]:
            yield f"{a} and {b}: nothing forces one to be lowered before the other hangs, but the hoists serve one"


def _propped(plan: Plan, shell: Shell) -> Iterator[str]:
    """Yield the steps that let go of what holds a shell while its centre of gravity is not over its feet and props."""
    joints = index_of(shell).joints
    feet = {joint.mark for joint in shell.joints if joint.kind == "foot"}
    lengths = np.array([plank.curve.length for plank in shell.planks])
    middles = np.array([plank.curve.points.mean(axis=0) for plank in shell.planks])
    centre = lengths @ middles / lengths.sum()
    for step in (step for phase in _LETTING_GO for step in _steps(plan, phase, shell.mark)):
        under = feet | {mark for mark in step.propped if mark in joints}
        if not surrounds(np.array([joints[mark].point for mark in sorted(under)])[:, :2], centre[:2]):
            yield f"{shell.mark}: step {step.id} lets go of it, but its centre is not over its feet and props"


def _measured(plan: Plan, leaves: dict[str, _Place]) -> Iterator[_Rule]:
    for step in _steps(plan, "passports"):
        yield from ((f"{mark} is measured", leaves[mark], (step.id, 0)) for mark in step.assemblies if mark in leaves)


def check_disassembly(plan: Plan, gridshell: Gridshell) -> list[str]:
    """Return what is wrong with a plan of taking a gridshell down, one line each; an empty list if nothing is.

    Every part leaves exactly once; nothing is taken from under what lies on it or before its fasteners are out; what
    holds a shell (cover off, ridges, foot bolts, screws, edge planks, studs) goes only when props, slings or the floor
    hold it instead, forced by predecessors, and these stand so that the shell cannot tip; one shell hangs at a time;
    every plank is measured after it has left.
    """
    leaves, lying = _places(plan, gridshell)
    forced = ancestors(plan)
    problems = [*numbering_problems(plan), *_once(plan, gridshell), *_one_by_one(plan, forced)]
    rules = [*_fastened(gridshell, leaves, lying), *_covered(gridshell, lying), *_measured(plan, leaves)]
    for shell in gridshell.shells:
        rules += [*_standing(plan, shell, leaves), *_hanging(plan, shell, leaves)]
        problems += _propped(plan, shell)
    for reason, (first, turn), (then, later) in rules:
        if first == then and turn > later:
            problems.append(f"{reason}, but comes later in step {first}")
        elif first != then and first not in forced.get(then, set()):
            problems.append(
                f"{reason}, but nothing forces step {first or '(missing)'} before step {then or '(missing)'}"
            )
    return list(dict.fromkeys(problems))
