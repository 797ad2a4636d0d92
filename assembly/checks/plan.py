"""An independent look at a plan: walks its steps over the data and lists what is wrong."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from aag_cad.families import EDGES
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import kind_of, parts_at
from aag_cad.parts.marks import shells_of
from aag_cad.parts.model import Gridshell, Part, Shell, ridge_parts, shell_parts
from assembly.base.locking_order import LockingOrder
from assembly.base.segments import Segmentation
from assembly.base.steps import Plan, Step
from assembly.checks.stability import locking_problems, prop_problems, travel_problems
from assembly.checks.walking import ancestors, numbering_problems, once_problems


def _once(plan: Plan, gridshell: Gridshell) -> Iterator[str]:
    yield from once_problems(plan, index_of(gridshell).parts)
    beams = index_of(gridshell).beams.keys()
    moved = Counter(mark for step in plan.steps for mark in step.assemblies if mark in beams)
    for mark in sorted(beams):
        if moved[mark] != 1:
            yield f"{mark}: laid {moved[mark]} times, expected once"


def _places(plan: Plan, gridshell: Gridshell) -> dict[str, tuple[Step, int]]:
    """Return where each part and beam comes into the structure: its step and its turn in it.

    Planks and blocks of a beam come in when the beam is laid.
    """
    places = {mark: (step, i) for step in plan.steps for i, mark in enumerate(step.marks)}
    beams = index_of(gridshell).beams
    for step in plan.steps:
        places |= {mark: (step, i) for i, mark in enumerate(step.assemblies) if mark in beams}
    for mark in (mark for mark in beams if mark in places):
        places |= {plank: places[mark] for plank in beams[mark].planks if plank in places}
    return places


def _layering(shell: Shell, places: dict[str, tuple[Step, int]]) -> Iterator[tuple[str, str, str]]:
    """Yield (first, then, joint) for all planks that cross between different layers before the shell is shaped.

    The lower one comes first; where one of them is slid in, it comes after the one that it passes.
    """
    slid = {mark for mark, (step, _) in places.items() if step.phase == "slide"}
    planks = index_of(shell).planks
    for joint in shell.joints:
        members = [planks[mark] for mark in joint.members if mark in planks and planks[mark].family not in EDGES]
        for lower in members:
            for upper in members:
                if lower.layer < upper.layer and lower.mark in places and upper.mark in places:
                    pair = (lower.mark, upper.mark)
                    if not slid.issuperset(pair):
                        yield (*(reversed(pair) if lower.mark in slid else pair), joint.mark)


def _covering(shell: Shell) -> set[str]:
    """Return the marks of what covers a shell: bars, strips, blocks on geodesics, and the screws of all these."""
    joints = [joint for joint in shell.joints if joint.kind == "cover"]
    blocks = index_of(shell).blocks.keys()
    held = {mark for joint in joints for mark in joint.fasteners}
    held |= {joint.mark for joint in joints if joint.mark in blocks}
    return held | {part.mark for part in parts_at(shell_parts(shell), "cover")}


def _orders(plan: Plan, shell: Shell, places: dict[str, tuple[Step, int]]) -> Iterator[tuple[str, Step, Step]]:
    """Yield (reason, earlier step, later step) for all that must follow something else in a shell."""
    at = {mark: step for mark, (step, _) in places.items()}
    made = {mark: step for step in plan.steps for mark in step.marks}
    hoists = [step for step in plan.steps if step.phase == "hoist" and shell.mark in step.assemblies]
    stands = [step for step in plan.steps if step.phase == "stand" and shell.mark in step.assemblies]
    divides = [step for step in plan.steps if step.phase == "divide" and shell.mark in step.assemblies]
    if len(hoists) != 1 or not stands:
        return
    hoist = hoists[0]
    screws, bolts = index_of(shell).screws.keys(), index_of(shell).bolts.keys()
    blocks, studs = index_of(shell).blocks.keys(), index_of(shell).studs.keys()
    for plank in shell.planks:
        if plank.beam and plank.mark in made and plank.beam in at:
            yield f"{plank.mark} is part of {plank.beam}", made[plank.mark], at[plank.beam]
        if plank.mark in at:
            edge, laid = plank.family in EDGES, at[plank.mark]
            yield (f"{plank.mark} is an edge plank", hoist, laid) if edge else (f"{plank.mark} is laid", laid, hoist)
    for joint in shell.joints:
        in_beam = any(mark in blocks for mark in joint.members)
        for fastener in (mark for mark in joint.fasteners if mark in at):
            needs = [mark for mark in joint.members if not (in_beam and fastener in bolts) or mark in blocks]
            yield from ((f"{fastener} joins {mark}", at[mark], at[fastener]) for mark in needs if mark in at)
            if fastener in screws:
                yield f"{fastener} fixes the shape", hoist, at[fastener]
            if fastener in bolts and joint.kind == "AA":
                yield f"{fastener} holds a stud", at[fastener], hoist
        for mark in joint.members:
            if mark in studs and mark in at:
                yield f"{mark} is a stud", at[mark], hoist
                yield from ((f"{mark} holds {plank}", at[plank], at[mark]) for plank in joint.members if plank in at)
    feet = {mark for joint in shell.joints if joint.kind == "foot" for mark in joint.fasteners}
    covering = _covering(shell)
    for part in shell_parts(shell):
        if part.mark not in at or part.mark in covering:
            continue
        if part.mark in feet:
            yield from (
                (f"{part.mark} bolts a shoe to the shell", stand, at[part.mark]) for stand in _own(stands, at, part)
            )
        elif kind_of(part).place == "ground":
            yield from ((f"{part.mark} carries the shell", at[part.mark], stand) for stand in stands)
        else:
            yield from ((f"{part.mark} is part of the stiff shell", at[part.mark], then) for then in divides or stands)


def _own(stands: Sequence[Step], at: Mapping[str, Step], part: Part) -> Sequence[Step]:
    """Return the step in which a bolt of a shoe is put in if it stands the shell, else all that do."""
    return [stand for stand in stands if stand.id == at[part.mark].id] or stands


def _shell_problems(plan: Plan, shell: Shell, places: dict[str, tuple[Step, int]]) -> Iterator[str]:
    forced = ancestors(plan)
    hoists = [step for step in plan.steps if step.phase == "hoist" and shell.mark in step.assemblies]
    if len(hoists) != 1 or not hoists[0].held:
        yield f"{shell.mark}: expected one hoist step" + (" with a hold point" if hoists else "")
    for lower, upper, joint in _layering(shell, places):
        (first, turn), (second, later_turn) = places[lower], places[upper]
        if first.id == second.id and turn > later_turn:
            yield f"{joint}: {upper} is laid before {lower} in step {first.id}, but lies on it"
        elif first.id != second.id and first.id not in forced[second.id]:
            does = "passes" if second.phase == "slide" else "lies on"
            yield f"{joint}: {upper} in step {second.id} {does} {lower}, but nothing forces step {first.id} before it"
    for reason, first, second in _orders(plan, shell, places):
        if first.id != second.id and first.id not in forced[second.id]:
            yield f"{reason}, but nothing forces step {first.id} before step {second.id}"


def _ridges(plan: Plan, gridshell: Gridshell) -> Iterator[str]:
    forced, at = ancestors(plan), {mark: step for step in plan.steps for mark in step.marks}
    stood = [(mark, step) for step in plan.steps if step.phase in ("stand", "splice") for mark in step.assemblies]
    for part in (part for part in ridge_parts(gridshell) if part.mark in at):
        for shell in shells_of(part.mark):
            steps = [step.id for mark, step in stood if mark == shell]
            if not steps or not forced[at[part.mark].id].issuperset(steps):
                yield f"{part.mark}: nothing forces the standing of {shell} before step {at[part.mark].id}"
    for joint in gridshell.joints:
        for member, fastener in ((m, f) for f in joint.fasteners for m in joint.members if m in at and f in at):
            first, second = at[member].id, at[fastener].id
            if first != second and first not in forced[second]:
                yield f"{fastener} joins {member}, but nothing forces step {first} before step {second}"


def _cover(plan: Plan, gridshell: Gridshell) -> Iterator[str]:
    """Yield what is covered before all shells stand and all ridges are joined."""
    forced, at = ancestors(plan), {mark: step for step in plan.steps for mark in step.marks}
    before = [step.id for step in plan.steps if step.phase in ("stand", "splice", "ridges")]
    for shell in gridshell.shells:
        for mark in sorted(_covering(shell) & set(at)):
            missed = [first for first in before if first not in forced[at[mark].id]]
            if missed:
                yield f"{mark} covers {shell.mark}, but nothing forces step {missed[0]} before step {at[mark].id}"


def check_plan(
    plan: Plan,
    gridshell: Gridshell,
    segmentation: Segmentation | None = None,
    locking: Sequence[LockingOrder] = (),
) -> list[str]:
    """Return what is wrong with a plan for a gridshell, one line each; an empty list if nothing is.

    Every part in exactly one step, every beam laid once, numbers and predecessors in order, and everything that must
    come first (what lies below, what a slid plank passes, what a fastener joins, studs and their bolts before the
    hoisting, the shaping before the screws, the feet before the shell, the shells before their ridges, all of them
    before the cover) forced by predecessors. Shells that ``segmentation`` cuts are parted once and stand segment by
    segment, on props that hold each one's centre of gravity, each beside one that stands (``travel_problems``). What
    ``locking`` asks for is done: the order of fixing, props under the hoisted shell and under the standing one until
    the ridges are joined (``locking_problems``, ``prop_problems``).
    """
    places = _places(plan, gridshell)
    problems = [*numbering_problems(plan), *_once(plan, gridshell)]
    for shell in gridshell.shells:
        problems += list(_shell_problems(plan, shell, places))
        problems += list(travel_problems(plan, shell, segmentation))
    for order in locking:
        problems += [*locking_problems(plan, gridshell, order), *prop_problems(plan, order)]
    return [*problems, *_ridges(plan, gridshell), *_cover(plan, gridshell)]
