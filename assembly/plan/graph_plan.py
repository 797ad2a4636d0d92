"""The plan of laying and joining any graph of parts and joints on the floor (``assembly.graph.faults``)."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from unicodedata import name

import networkx as nx

from aag_cad.findings import Finding
from aag_cad.language import Figure, Text, text
from aag_cad.parts.marks import short_in
from assembly.base.errors import PlanError
from assembly.base.lifters import lifters_of, lifting_findings
from assembly.base.mark_ranges import named_in
from assembly.base.phases import Phase
from assembly.base.steps import Plan
from assembly.graph.interlacing import Interlacing, interlacing
from assembly.graph.laying_units import Unit, units_of
from assembly.graph.whole import whole_graph
from assembly.laying.joining import Joining, joinings
from assembly.laying.order import FlatOrder, flat_order_of, groups_of
from assembly.plan.slide_work import slide_title, told_slide
from assembly.plan.work import LAID_A_STEP, PAIR, Work, steps_from

JOINTS_A_STEP = 24
_FEW = 4
# The scripts of the letters that the fonts of the booklets have.
_PRINTED = ("LATIN", "GREEK", "CYRILLIC", "MICRO", "FEMININE", "MASCULINE")


@dataclass(frozen=True)
class _Basis:
    """What the steps are made from; ``kits`` are all parts of each unit, planks first, then its blocks and bolts."""

    graph: "nx.MultiGraph[str]"
    units: Mapping[str, Unit]
    kits: Mapping[str, tuple[str, ...]]
    woven: Interlacing
    order: FlatOrder

    def work(self, name: str, phase: Phase, shell: str, title: Text, marks: tuple[str, ...]) -> Work:
        """Return a piece of work that as yet waits for nothing."""
        name = f"{shell}.{name}" if shell else name
        return Work(name, phase, title, text(f"phases.{phase}"), shell, marks=marks)


def _says(key: str, **figures: Figure) -> Text:
    """Return a text of the table ``plan`` in ``words/graph.toml``."""
    return text(f"graph.plan.{key}", **figures)


def unit_kits(graph: "nx.MultiGraph[str]", units: Mapping[str, Unit]) -> dict[str, tuple[str, ...]]:
    """Return all parts of each unit: what is laid first, then what is put together with a beam."""
    laid = {part for unit in units.values() for part in unit.parts}
    added: dict[str, list[str]] = defaultdict(list)
    for mark in sorted(mark for mark in graph if mark not in laid):
        added[graph.nodes[mark].get("beam", "")].append(mark)
    return {mark: (*unit.parts, *added.get(mark, ())) for mark, unit in units.items()}


def unit_weights(
    graph: "nx.MultiGraph[str]", kits: Mapping[str, tuple[str, ...]], units: Mapping[str, Unit]
) -> dict[str, tuple[float, float]]:
    """Return (kg, mm) of every part, and of every unit with its kit."""
    parts = {mark: (float(node["mass_kg"]), float(node["length_mm"])) for mark, node in graph.nodes(data=True)}
    made = {mark: (sum(parts[part][0] for part in kit), units[mark].length) for mark, kit in kits.items()}
    return parts | made


def _steps_of(marks: Iterable[str], steps: Mapping[str, str]) -> tuple[str, ...]:
    """Return the steps of those of some marks that have one, in their order; ``steps`` gives them in that order."""
    found = {steps[mark] for mark in marks if mark in steps}
    return tuple(step for step in dict.fromkeys(steps.values()) if step in found)


def _laying(basis: _Basis, steps: dict[str, str]) -> Iterator[Work]:
    """Yield the laying of runs in groups; ``steps`` learns the step of each unit."""
    counts: dict[str, int] = defaultdict(int)
    for group in (group for run in basis.order.runs for group in groups_of(run, LAID_A_STEP)):
        first = basis.units[group[0]]
        counts[first.shell] += 1
        below = sorted({low for unit in group for low in basis.woven.precedence.predecessors(unit)})
        beneath = sorted({basis.units[unit].family for unit in below})
        stack = "-".join(part for part in (first.shell, first.family) if part)
        order = tuple(short_in(mark, first.shell) for mark in group)
        beams = tuple(unit for unit in group if unit not in basis.graph)
        onto = named_in(below, first.shell) if "" in beneath else ", ".join(beneath)
        marks = tuple(mark for unit in group for mark in basis.kits[unit])
        title = _says("lay.title", marks=named_in(group, first.shell))
        work = basis.work(f"lay.{counts[first.shell]}", "lay", first.shell, title, marks)
        notes = [
            _says("lay.stack", stack=stack, marks=order) if stack else _says("lay.carry", marks=order),
            _says("lay.over", below=onto) if below else _says("lay.floor"),
        ]
        if beams:
            notes.insert(0, _says("lay.make", marks=tuple(short_in(mark, first.shell) for mark in beams)))
        yield replace(work, assemblies=beams, after=_steps_of(below, steps), notes=tuple(notes))
        steps |= dict.fromkeys(group, work.id)


def _sliding(basis: _Basis, steps: dict[str, str]) -> Iterator[Work]:
    """Yield the slides, one step each."""
    counts: dict[str, int] = defaultdict(int)
    for slide in basis.order.slides:
        unit = basis.units[slide.unit]
        counts[unit.shell] += 1
        name, marks = f"slide.{counts[unit.shell]}", basis.kits[unit.mark]
        work = told_slide(
            basis.work(name, "slide", unit.shell, slide_title(slide, unit.shell), marks), slide, unit.length
        )
        beams = (unit.mark,) if unit.mark not in basis.graph else ()
        after = _steps_of(basis.woven.precedence.predecessors(unit.mark), steps)
        yield replace(work, assemblies=beams, after=after)
        steps[unit.mark] = work.id


def _joined(names: tuple[str, ...]) -> Figure:
    return names if len(names) <= _FEW else _says("several", count=len(names), first=names[0], last=names[-1])


def _joining(basis: _Basis, found: Sequence[Joining], steps: dict[str, str]) -> Iterator[Work]:
    """Yield the joining along the path; ``steps`` gives the step of each unit, and learns those of other parts.

    A step waits for all that its parts are tied to, and for the slides past these: they need the others loose.
    """
    home = {mark: unit for unit, kit in basis.kits.items() for mark in kit}
    slid = {slide.unit for slide in basis.order.slides}
    past: dict[str, list[str]] = defaultdict(list)
    for unit in sorted(slid):
        for other in basis.woven.precedence.predecessors(unit):
            past[other].append(unit)
    runs: dict[tuple[str, str], list[Joining]] = defaultdict(list)
    for joining in found:
        runs[joining.shell, joining.kind].append(joining)
    counts: dict[str, int] = defaultdict(int)
    for (shell, _), run in runs.items():
        for group in groups_of(run, JOINTS_A_STEP):
            counts[shell] += 1
            marks = tuple(mark for joining in group for mark in joining.marks)
            order = tuple(short_in(joining.joint, shell) for joining in group)
            title = _says("join.title", joints=_joined(order))
            work = basis.work(f"join.{counts[shell]}", "join", shell, title, marks)
            tied = {other for mark in marks for other in basis.graph[mark]} - set(marks)
            units = {home[other] for other in tied if other in home}
            waits = {*units, *(unit for other in units for unit in past[other]), *(tied - home.keys())}
            notes = (_says("join.order", joints=order),)
            yield replace(work, least_crew=PAIR, after=_steps_of(waits, steps), notes=notes)
            steps |= dict.fromkeys(marks, work.id)


def _unprinted(marks: Iterable[str]) -> Iterator[Finding]:
    """Yield the note on marks with letters of scripts that the fonts of the PDF do not have (AAG957)."""
    strange = [mark for mark in marks if any(c.isalpha() and not name(c, "").startswith(_PRINTED) for c in mark)]
    if strange:
        what, remedy = _says("letters.what"), _says("letters.remedy")
        yield Finding("AAG957", "note", ", ".join(strange), what, float(len(strange)), 0.0, "", remedy)


def _waiting(marks: Sequence[str]) -> tuple[Finding, ...]:
    if not marks:
        return ()
    what, remedy = text("graph.plan.waiting.what"), text("graph.plan.waiting.remedy")
    return (Finding("AAG956", "error", ", ".join(marks), what, float(len(marks)), 0.0, "", remedy),)


def graph_plan(graph: "nx.Graph[str]", people: int, lift_limit: float) -> Plan:
    """Return the plan of laying any networkx graph on the floor, sliding in what is woven and joining it loosely.

    For a crew of ``people`` who lift at most ``lift_limit`` kg each. Runs are laid in groups of at most 7, each slide
    is a step of its own, and at most 24 joints are joined in a step. ``findings`` name what cannot be laid (AAG951) or
    put in (AAG956), which is in no step, what is heavy (AAG955), and marks that the PDF cannot print (AAG957).
    PlanError if the graph is empty or has faults, a part is tied to nothing, or the crew is empty.
    """
    lifters, whole = lifters_of(people, lift_limit), whole_graph(graph)
    if not whole:
        raise PlanError("graph: no nodes, at least 1 needed: give it the parts that are to be put together")
    woven, units = interlacing(whole, later=()), units_of(whole)
    order, kits = flat_order_of(whole, woven, later=()), unit_kits(whole, units)
    basis, weights = _Basis(whole, units, kits, woven, order), unit_weights(whole, kits, units)
    placed = {mark: unit for unit, kit in kits.items() for mark in kit}
    found, waiting = joinings(whole, units, placed, woven.left_out, woven.overlaps)
    step_of: dict[str, str] = {}
    works = [*_laying(basis, step_of), *_sliding(basis, step_of), *_joining(basis, found, step_of)]
    alone = (mark for mark in weights if placed.get(mark, mark) == mark and mark not in woven.left_out)
    lifted = {mark: weights[mark] for mark in alone}
    findings = (*woven.findings, *_waiting(waiting), *lifting_findings(lifted, lifters), *_unprinted(whole))
    return Plan(str(whole.name), tuple(steps_from(works, weights, lifters)), findings)
