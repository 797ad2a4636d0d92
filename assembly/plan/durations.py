"""How long each step takes: the person-minutes of what is done in it, shared by its people.

The times are those of ``[crew.minutes]`` in the design (``aag_cad.design_tables.Minutes``); as shipped they are our
estimate, to be replaced by measured times.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

from aag_cad.design_making import Minutes
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import kind_of, minutes_key
from aag_cad.parts.model import Gridshell, JointKind, Part, Shell
from aag_cad.parts.quantities import sizes
from aag_cad.units import MM_PER_M
from assembly.base.errors import PlanError
from assembly.base.phases import PHASE, is_down
from assembly.base.steps import Plan, Step


@dataclass(frozen=True)
class StepWork:
    """What is done in a step: how often each kind of work (a key of ``Minutes``), and what of it is undone.

    Carrying counts metres of length. What is ``undone`` takes the share ``Minutes.removal`` of its time.
    """

    done: Mapping[str, float]
    undone: Mapping[str, float]


@dataclass(frozen=True)
class _Lengths:
    """Parts by mark, lengths of beams and planks in mm, the bolts of each shell by kind of joint.

    ``stands``: in how many steps each shell is stood up; more than one where it travels in segments.
    """

    parts: Mapping[str, Part]
    lengths: Mapping[str, float]
    bolts: Mapping[str, Mapping[JointKind, int]]
    stands: Mapping[str, int]


def _bolt_counts(shell: Shell) -> dict[JointKind, int]:
    bolts, counts = index_of(shell).bolts.keys(), Counter[JointKind]()
    for joint in shell.joints:
        counts[joint.kind] += sum(mark in bolts for mark in joint.fasteners)
    return dict(counts)


def _lengths(gridshell: Gridshell, plan: Plan) -> _Lengths:
    parts = index_of(gridshell).parts
    long = {mark: sizes(part)[0] for mark, part in parts.items() if kind_of(part).long}
    beams = {beam.mark: beam.curve.length for shell in gridshell.shells for beam in shell.beams}
    stands = Counter(mark for step in plan.steps if step.phase == "stand" for mark in step.assemblies)
    return _Lengths(parts, long | beams, {shell.mark: _bolt_counts(shell) for shell in gridshell.shells}, stands)


def _work_with(known: _Lengths, step: Step) -> StepWork:
    """Return what is done in a step."""
    row, down = PHASE[step.phase], is_down(step.phase)
    handled, done = Counter[str](), defaultdict[str, float](float)
    for mark in step.marks:
        part = known.parts.get(mark)
        if part is None:
            raise PlanError(f"{mark}: step {step.id} handles it, but the gridshell has no such part: plan it again")
        handled[minutes_key(part)] += 1
    beams = [mark for mark in step.assemblies if mark in known.lengths and mark not in known.parts]
    handled["beam"] += len(beams)
    measured = [mark for mark in step.assemblies if mark in known.parts]
    done["carry"] = sum(known.lengths.get(mark, 0.0) for mark in (*step.marks, *beams, *measured)) / MM_PER_M
    done["measure"] += len(measured)
    if row.tightens:
        done["tighten"] += handled["bolt"]
    bolts = known.bolts.get(step.shell, {})
    done["tighten"] += sum(bolts.get(kind, 0) for kind in row.gone_over)
    if row.once:
        parts = known.stands[step.assemblies[0]] if step.phase == "stand" else 1
        done[row.once] += 1.0 / parts
    if row.undone:
        handled[row.undone] += 1
    done["extra"] += len(step.extras)
    undone = dict(handled) if down else {}
    for kind, count in ({} if down else handled).items():
        done[kind] += count
    return StepWork(*({kind: n for kind, n in sorted(each.items()) if n} for each in (done, undone)))


def step_works(plan: Plan, gridshell: Gridshell) -> dict[str, StepWork]:
    """Return what is done in each step of a plan of assembly or of taking down, by the step's id.

    PlanError with the mark of a part that the gridshell does not have.
    """
    works = map(partial(_work_with, _lengths(gridshell, plan)), plan.steps)
    return {step.id: work for step, work in zip(plan.steps, works, strict=True)}


def person_minutes(step: Step, work: StepWork, minutes: Minutes) -> float:
    """Return the person-minutes of a step, with the time in which each of its people gets ready."""
    times: dict[str, float] = minutes.model_dump()
    done = sum(count * times[kind] for kind, count in work.done.items())
    undone = sum(count * times[kind] for kind, count in work.undone.items())
    return step.crew * minutes.setup + done + minutes.removal * undone


def step_minutes(plan: Plan, gridshell: Gridshell, minutes: Minutes) -> dict[str, int]:
    """Return the minutes that each step takes its people, by its id: whole ones, rounded up, at least 1."""
    works = step_works(plan, gridshell)
    # Less than a second over a whole minute comes from rounding.
    spans = {s.id: person_minutes(s, works[s.id], minutes) / s.crew for s in plan.steps}
    return {step: max(1, math.ceil(span - 1.0 / 60.0)) for step, span in spans.items()}
