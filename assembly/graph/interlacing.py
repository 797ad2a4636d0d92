"""The order in which woven planks are laid, and which of them are slid in along their own axis between the others."""

import math
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass

import networkx as nx

from aag_cad.families import EDGES
from aag_cad.findings import Finding
from aag_cad.language import Text, text
from assembly.base.any_graph import as_multigraph
from assembly.base.errors import PlanError
from assembly.graph.circles import circle_links, few_out, knots, part_of, relations
from assembly.graph.faults import graph_problems, refuse
from assembly.graph.laying_units import Overlap, overlaps_of, units_of
from assembly.graph.sliding import End, Hindrance, Sliding, Why, slidings


@dataclass(frozen=True)
class Slide:
    """A unit that is slid in when the others lie: with its other end first, from beyond ``end``.

    ``free`` is the length of open floor beyond that end (infinite if nothing lies there), ``radius`` the smallest to
    which it bends, mm (infinite if it stays straight); ``passed`` are the crossings in the order that it passes them.
    """

    unit: str
    end: End
    free: float
    passed: tuple[Overlap, ...]
    radius: float = math.inf

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints in the order that it passes them."""
        return tuple(dict.fromkeys(at.joint for at in self.passed))


@dataclass(frozen=True)
class Interlacing:
    """Who lies on whom, what must lie first, which units are slid in, in their order, and what cannot be laid.

    ``precedence`` is acyclic and holds every unit but those ``left_out``: an edge leads from what must lie first to
    what comes later; its ``joints`` say where. To a unit that is slid in, edges lead from all that it passes.
    """

    overlaps: tuple[Overlap, ...]
    precedence: "nx.DiGraph[str]"
    slides: tuple[Slide, ...]
    findings: tuple[Finding, ...]
    left_out: tuple[str, ...]


def _precedence(lying: "nx.DiGraph[str]", slides: Iterable[str], left_out: Collection[str]) -> "nx.DiGraph[str]":
    """Return what must lie before what: what lies below, and before a slide all that it passes."""
    turn = {mark: i + 1 for i, mark in enumerate(slides)}
    where: dict[tuple[str, str], set[str]] = defaultdict(set)
    for lower in lying:
        for upper, edge in lying[lower].items():
            if lower not in left_out and upper not in left_out:
                swapped = turn.get(lower, 0) > turn.get(upper, 0)
                where[(upper, lower) if swapped else (lower, upper)] |= set(edge["joints"])
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from(mark for mark in lying if mark not in left_out)
    for (first, then), joints in sorted(where.items()):
        graph.add_edge(first, then, joints=tuple(sorted(joints)))
    return graph


def _slide(sliding: Sliding, overlaps: Iterable[Overlap], in_place: Collection[str]) -> Slide:
    def place(at: Overlap) -> tuple[float, str]:
        return at.upper_mm if at.upper == sliding.unit else at.lower_mm, at.joint

    passed = [at for at in overlaps if {at.lower, at.upper} - {sliding.unit} <= set(in_place)]
    passed.sort(key=place, reverse=sliding.end == "end")
    return Slide(sliding.unit, sliding.end, sliding.free, tuple(passed), sliding.radius)


def _slides(
    chosen: list[str], found: Mapping[str, Sliding], overlaps: Iterable[Overlap], laid: Collection[str]
) -> Iterator[Slide]:
    """Yield the slides in their order; each passes what was laid and what was slid in before it."""
    by_unit: dict[str, list[Overlap]] = defaultdict(list)
    for overlap in overlaps:
        by_unit[overlap.lower].append(overlap)
        by_unit[overlap.upper].append(overlap)
    in_place = set(laid)
    for unit in chosen:
        yield _slide(found[unit], by_unit[unit], in_place)
        in_place.add(unit)


def _reasons(knot: Iterable[str], found: Mapping[str, Sliding]) -> Iterator[Text]:
    """Yield why the units of a knot cannot be slid in, those with the same figures in one sentence."""
    told: dict[Hindrance, list[str]] = defaultdict(list)
    for mark in knot:
        for hindrance in found[mark].hindrances:
            told[hindrance].append(mark)
    order: tuple[Why, ...] = ("upright", "kept", "unknown", "radius", "length")
    for hindrance in sorted(told, key=lambda h: (order.index(h.why), told[h])):
        figures = {"found": hindrance.found, "needed": hindrance.needed}
        yield text(f"graph.interlacing.{hindrance.why}", marks=", ".join(told[hindrance]), **figures)


def _finding(knot: "nx.DiGraph[str]", found: Mapping[str, Sliding]) -> Finding:
    """Return the error that names a knot, a shortest circle in it with its joints, and what hinders its units."""
    what = text("graph.interlacing.circle", links=circle_links(knot), reasons=tuple(_reasons(knot, found)))
    return Finding("AAG951", "error", ", ".join(knot), what, 0.0, 1.0, "", text("graph.interlacing.remedy"))


def interlacing(graph: "nx.Graph[str]", later: Collection[str] | None = None) -> Interlacing:
    """Return the order of laying the units of a graph and the slides that it needs; see ``docs/interlacing.md``.

    The graph is that of a gridshell, of one of its shells or any other networkx graph with the attributes of
    ``assembly.graph.faults``; PlanError with its faults if it lacks them. ``later`` are units that do not lie on the
    floor yet and so are in nobody's way, edge planks (family E) if it is None. A circle that no slide resolves is an
    AAG951 in ``findings``.
    """
    several = as_multigraph(graph)
    refuse(graph_problems(several))
    units = units_of(several)
    absent = {mark for mark, unit in units.items() if unit.family in EDGES} if later is None else set(later)
    overlaps, meetings = overlaps_of(several)
    lying = relations(units, overlaps)
    tied = {mark for knot in knots(lying) for mark in knot}
    found = slidings(sorted(tied), units, overlaps, meetings, absent)
    fixed = part_of(lying, {mark for mark in tied if found[mark].hindrances})
    stuck = knots(fixed)
    left_out = {mark for knot in stuck for mark in knot}
    free = part_of(lying, tied - left_out)
    able, families = set(found) - set(fixed), {mark: unit.family for mark, unit in units.items()}
    chosen = [mark for knot in knots(free) for mark in few_out(part_of(free, knot), able, families)]
    return Interlacing(
        overlaps=overlaps,
        precedence=_precedence(lying, chosen, left_out),
        slides=tuple(_slides(chosen, found, overlaps, set(units) - left_out - set(chosen))),
        findings=tuple(_finding(part_of(fixed, knot), found) for knot in stuck),
        left_out=tuple(sorted(left_out)),
    )


def refuse_left_out(found: Interlacing) -> None:
    """Raise PlanError with all circles of a weave that no slide resolves, if there are any."""
    if found.findings:
        raise PlanError("\n".join(finding.text for finding in found.findings))
