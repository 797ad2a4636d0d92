"""How long each step takes: the person-minutes of what is done in it, shared by its people.

The times are those of ``[crew.minutes]`` in the design (``aag_cad.design_tables.Minutes``); as shipped they are our
estimate, to be replaced by measured times.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

import networkx as nx

from aag_cad.design_making import Minutes
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import kind_named, kind_of, minutes_key
from aag_cad.parts.model import Gridshell, JointKind, Shell
from aag_cad.parts.quantities import sizes
from aag_cad.units import MM_PER_M
from assembly.base.any_graph import as_multigraph
from assembly.base.errors import PlanError
from assembly.base.phases import PHASE, is_down
from assembly.base.steps import Plan, Step
from assembly.graph.laying_units import is_laid, units_of


@dataclass(frozen=True)
class StepWork:
    """What is done in a step: how often each kind of work (a key of ``Minutes``), and what of it is undone.

    Carrying counts metres of length. What is ``undone`` takes the share ``Minutes.removal`` of its time.
    """

    done: Mapping[str, float]
    undone: Mapping[str, float]


@dataclass(frozen=True)
class _Handled:
    """What steps handle, by mark: the key of ``Minutes`` of each part, the length of what is carried by its metres, mm.

    ``bolts`` are those of each shell by kind of joint.
    """

    kinds: Mapping[str, str]
    lengths: Mapping[str, float]
    bolts: Mapping[str, Mapping[JointKind, int]]


def _bolt_counts(shell: Shell) -> dict[JointKind, int]:
    bolts, counts = index_of(shell).bolts.keys(), Counter[JointKind]()
    for joint in shell.joints:
        counts[joint.kind] += sum(mark in bolts for mark in joint.fasteners)
    return dict(counts)


def _of_gridshell(gridshell: Gridshell) -> _Handled:
    parts = index_of(gridshell).parts
    long = {mark: sizes(part)[0] for mark, part in parts.items() if kind_of(part).long}
    beams = {beam.mark: beam.curve.length for shell in gridshell.shells for beam in shell.beams}
    kinds = {mark: minutes_key(part) for mark, part in parts.items()}
    return _Handled(kinds, long | beams, {shell.mark: _bolt_counts(shell) for shell in gridshell.shells})


def _of_graph(graph: "nx.MultiGraph[str]") -> _Handled:
    """Return what the steps of a graph handle: a beam is made where it is laid, so that its planks are not carried.

    A single plank takes the time of a geodesic, whatever the table of kinds does not know that of a bolt.
    """
    units = units_of(graph)
    kinds, lengths = dict[str, str](), {mark: unit.length for mark, unit in units.items()}
    for mark, node in graph.nodes(data=True):
        row = kind_named(node["kind"])
        if is_laid(node):
            kinds[mark] = "plank" if node.get("beam") else "geodesic"
        else:
            kinds[mark] = row.minutes or row.key if row else "bolt"
            if row and row.long:
                lengths[mark] = float(node["length_mm"])
    return _Handled(kinds, lengths, {})


def _work_with(known: _Handled, stands: Mapping[str, int], step: Step) -> StepWork:
    """Return what is done in a step; ``stands`` says in how many a shell is stood up, more than one if in segments."""
    row, down = PHASE[step.phase], is_down(step.phase)
    handled, done = Counter[str](), defaultdict[str, float](float)
    for mark in step.marks:
        if mark not in known.kinds:
            raise PlanError(f"{mark}: step {step.id} handles it, but there is no such part: plan it again")
        handled[known.kinds[mark]] += 1
    beams = [mark for mark in step.assemblies if mark in known.lengths and mark not in known.kinds]
    handled["beam"] += len(beams)
    measured = [mark for mark in step.assemblies if mark in known.kinds]
    done["carry"] = sum(known.lengths.get(mark, 0.0) for mark in (*step.marks, *beams, *measured)) / MM_PER_M
    done["measure"] += len(measured)
    if row.tightens:
        done["tighten"] += handled["bolt"]
    bolts = known.bolts.get(step.shell, {})
    done["tighten"] += sum(bolts.get(kind, 0) for kind in row.gone_over)
    if row.once:
        parts = stands[step.assemblies[0]] if step.phase == "stand" else 1
        done[row.once] += 1.0 / parts
    if row.undone:
        handled[row.undone] += 1
    done["extra"] += len(step.extras)
    undone = dict(handled) if down else {}
    for kind, count in ({} if down else handled).items():
        done[kind] += count
    return StepWork(*({kind: n for kind, n in sorted(each.items()) if n} for each in (done, undone)))


def step_works(plan: Plan, whole: "Gridshell | nx.Graph[str]") -> dict[str, StepWork]:
    """Return what is done in each step of a plan of putting together or of taking down, by the step's id.

    ``whole`` is the gridshell or graph that it is the plan of. PlanError with the mark of a part that it does not have.
    """
    known = _of_gridshell(whole) if isinstance(whole, Gridshell) else _of_graph(as_multigraph(whole))
    stands = Counter(mark for step in plan.steps if step.phase == "stand" for mark in step.assemblies)
    works = map(partial(_work_with, known, stands), plan.steps)
    return {step.id: work for step, work in zip(plan.steps, works, strict=True)}


def person_minutes(step: Step, work: StepWork, minutes: Minutes) -> float:
    """Return the person-minutes of a step, with the time in which each of its people gets ready."""
    times: dict[str, float] = minutes.model_dump()
    done = sum(count * times[kind] for kind, count in work.done.items())
    undone = sum(count * times[kind] for kind, count in work.undone.items())
    return step.crew * minutes.setup + done + minutes.removal * undone


def step_minutes(plan: Plan, whole: "Gridshell | nx.Graph[str]", minutes: Minutes) -> dict[str, int]:
    """Return the minutes that each step takes its people, by its id: whole ones, rounded up, at least 1."""
    works = step_works(plan, whole)
    # Less than a second over a whole minute comes from rounding.
    spans = {s.id: person_minutes(s, works[s.id], minutes) / s.crew for s in plan.steps}
    return {step: max(1, math.ceil(span - 1.0 / 60.0)) for step, span in spans.items()}
