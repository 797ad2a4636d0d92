"""The order in which woven planks are laid, and which of them are slid in along their own axis between the others."""

import math
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby

import networkx as nx

from aag_cad.findings import Finding
from assembly.graph_problems import refuse_problems
from assembly.language import Language, say
from assembly.laying_units import Crossing, Unit, crossings_of, units_of
from assembly.sliding import End, Hindrance, Sliding, Why, slidings

__all__ = ["Crossing", "Interlacing", "Slide", "interlacing"]


@dataclass(frozen=True)
class Slide:
    """A unit that is slid in when the others lie: with its other end first, from beyond ``end``.

    ``free`` is the length of open floor beyond that end (infinite if nothing lies there), ``radius`` the smallest to
    which it bends, mm (infinite if it stays straight); ``crossings`` are the joints in the order that it passes them.
    """

    unit: str
    end: End
    free: float
    crossings: tuple[str, ...]
    radius: float = math.inf


@dataclass(frozen=True)
class Interlacing:
    """Who lies on whom, what must lie first, which units are slid in, in their order, and what cannot be laid.

    ``precedence`` is acyclic and holds every unit but those ``left_out``: an edge leads from what must lie first to
    what comes later; its ``joints`` say where. To a unit that is slid in, edges lead from all that it passes.
    """

    crossings: tuple[Crossing, ...]
    precedence: "nx.DiGraph[str]"
    slides: tuple[Slide, ...]
    findings: tuple[Finding, ...]
    left_out: tuple[str, ...]


def _circles(graph: "nx.DiGraph[str]") -> list[list[str]]:
    """Return the units of each knot in which everybody lies, by way of others, on everybody; sorted."""
    return sorted(sorted(part) for part in nx.strongly_connected_components(graph) if len(part) > 1)


def _in_circle(graph: "nx.DiGraph[str]", unit: str, removed: Collection[str]) -> bool:
    """Return whether a way leads from a unit back to itself past the units that are removed."""
    waiting, seen = [unit], {unit}
    while waiting:
        for follower in graph.successors(waiting.pop()):
            if follower == unit:
                return True
            if follower not in seen and follower not in removed:
                seen.add(follower)
                waiting.append(follower)
    return False


def _without_needless(graph: "nx.DiGraph[str]", removed: Iterable[str]) -> list[str]:
    """Return those of the removed units that must stay out of an acyclic rest: the others are put back in turn."""
    out = set(removed)
    for unit in sorted(out):
        if not _in_circle(graph, unit, out - {unit}):
            out.remove(unit)
    return sorted(out)


def _greedy(knot: "nx.DiGraph[str]", sliding: Collection[str]) -> list[str]:
    """Return units whose removal leaves no circle: in each knot that is left, the one with most ways through it."""
    rest = knot.copy()
    chosen = []
    while circles := _circles(rest):
        for circle in circles:
            part = rest.subgraph(circle)
            unit = min(
                (mark for mark in circle if mark in sliding),
                key=lambda mark: (-part.in_degree(mark) * part.out_degree(mark), mark),
            )
            chosen.append(unit)
        rest.remove_nodes_from(chosen)
    return _without_needless(knot, chosen)


def _chosen(knot: "nx.DiGraph[str]", sliding: Collection[str], units: Mapping[str, Unit]) -> list[str]:
    """Return which units of a knot are slid in: as few as a greedy choice finds, of one family if that takes no more."""
    found = _greedy(knot, sliding)
    able = sorted((units[mark].family, mark) for mark in knot if mark in sliding)
    for _, listed in groupby(able, key=lambda pair: pair[0]):
        family = [mark for _, mark in listed]
        rest = knot.copy()
        rest.remove_nodes_from(family)
        if nx.is_directed_acyclic_graph(rest):
            members = _without_needless(knot, family)
            mixed = len({units[mark].family for mark in found}) > 1
            if len(members) < len(found) or (len(members) == len(found) and mixed):
                found = members
    return found


def _relations(crossings: Iterable[Crossing]) -> "nx.DiGraph[str]":
    """Return an edge from each unit to each that lies on it, with their ``joints``."""
    where: dict[tuple[str, str], list[str]] = defaultdict(list)
    for crossing in crossings:
        where[crossing.lower, crossing.upper].append(crossing.joint)
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from(sorted({mark for pair in where for mark in pair}))
    for (lower, upper), joints in sorted(where.items()):
        graph.add_edge(lower, upper, joints=tuple(joints))
    return graph


def _precedence(
    units: Iterable[str], relations: "nx.DiGraph[str]", slides: Iterable[str], left_out: Collection[str]
) -> "nx.DiGraph[str]":
    """Return what must lie before what: what lies below, and before a slide all that it passes."""
    turn = {mark: i + 1 for i, mark in enumerate(slides)}
    where: dict[tuple[str, str], set[str]] = defaultdict(set)
    for lower, upper, joints in relations.edges(data="joints"):
        if lower not in left_out and upper not in left_out:
            swapped = turn.get(lower, 0) > turn.get(upper, 0)
            where[(upper, lower) if swapped else (lower, upper)] |= set(joints)
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from(sorted(set(units) - set(left_out)))
    for (first, then), joints in sorted(where.items()):
        graph.add_edge(first, then, joints=tuple(sorted(joints)))
    return graph


def _slide(sliding: Sliding, crossings: Iterable[Crossing], in_place: Collection[str]) -> Slide:
    passed = sorted(
        (at.upper_mm, at.joint) if at.upper == sliding.unit else (at.lower_mm, at.joint)
        for at in crossings
        if sliding.unit in (at.lower, at.upper) and {at.lower, at.upper} - {sliding.unit} <= set(in_place)
    )
    joints = dict.fromkeys(joint for _, joint in (passed[::-1] if sliding.end == "end" else passed))
    return Slide(sliding.unit, sliding.end, sliding.free, tuple(joints), sliding.radius)


def _slides(
    chosen: list[str], found: Mapping[str, Sliding], crossings: Iterable[Crossing], laid: Collection[str]
) -> Iterator[Slide]:
    """Yield the slides in their order; each passes what was laid and what was slid in before it."""
    by_unit: dict[str, list[Crossing]] = defaultdict(list)
    for crossing in crossings:
        by_unit[crossing.lower].append(crossing)
        by_unit[crossing.upper].append(crossing)
    in_place = set(laid)
    for unit in chosen:
        yield _slide(found[unit], by_unit[unit], in_place)
        in_place.add(unit)


def _reason(language: Language, hindrance: Hindrance, marks: list[str]) -> str:
    return say(
        language,
        f"graph.interlacing.{hindrance.why}",
        marks=", ".join(marks),
        found=f"{hindrance.found:.0f}",
        needed=f"{hindrance.needed:.0f}",
    )


def _reasons(circle: Iterable[str], found: Mapping[str, Sliding], language: Language) -> Iterator[str]:
    """Yield why the units of a circle cannot be slid in, those with the same figures in one sentence."""
    told: dict[Hindrance, list[str]] = defaultdict(list)
    for mark in circle:
        for hindrance in found[mark].hindrances:
            told[hindrance].append(mark)
    order: tuple[Why, ...] = ("upright", "kept", "unknown", "radius", "length")
    for hindrance in sorted(told, key=lambda h: (order.index(h.why), told[h])):
        yield _reason(language, hindrance, told[hindrance])


def _finding(
    knot: "nx.DiGraph[str]", circle: list[str], found: Mapping[str, Sliding], language: Language
) -> Finding:
    """Return the error that names a circle, one shortest way round in it with its joints, and what hinders its units."""
    links = [
        say(language, "graph.interlacing.link", upper=upper, lower=lower, joints=", ".join(knot[lower][upper]["joints"]))
        for lower, upper in _shortest_circle(knot)
    ]
    what = say(
        language,
        "graph.interlacing.circle",
        links="; ".join(links),
        reasons="; ".join(_reasons(circle, found, language)),
    )
    remedy = say(language, "graph.interlacing.remedy")
    return Finding("AAG951", "error", ", ".join(circle), what, 0.0, 1.0, "", remedy)


def _shortest_circle(knot: "nx.DiGraph[str]") -> list[tuple[str, str]]:
    """Return the edges of a shortest circle through the first unit of a knot."""
    first = min(knot)
    ways = [nx.shortest_path(knot, follower, first) for follower in sorted(knot.successors(first))]
    way = [first, *min(ways, key=len)]
    return list(zip(way[:-1], way[1:], strict=True))


def interlacing(graph: "nx.MultiGraph[str]", language: Language = "en") -> Interlacing:
    """Return the order of laying the units of a graph and the slides that it needs; see ``docs/interlacing.md``.

    The graph is that of a gridshell, of one of its shells or any other with the attributes of
    ``assembly.graph_problems``; PlanError with its faults if it lacks them. A circle that no slide resolves is an
    AAG951 in ``findings``.
    """
    refuse_problems(graph)
    units = units_of(graph)
    crossings, meetings = crossings_of(graph)
    relations = _relations(crossings)
    knots = _circles(relations)
    tied = [mark for knot in knots for mark in knot]
    found = slidings(tied, units, crossings, meetings)
    able = {mark for mark in tied if not found[mark].hindrances}
    fixed = relations.subgraph(mark for mark in tied if mark not in able)
    stuck = _circles(fixed)
    left_out = {mark for circle in stuck for mark in circle}
    free = relations.subgraph(set(relations) - left_out)
    chosen = [mark for knot in _circles(free) for mark in _chosen(free.subgraph(knot), able, units)]
    slides = tuple(_slides(chosen, found, crossings, set(units) - left_out - set(chosen)))
    return Interlacing(
        crossings=crossings,
        precedence=_precedence(units, relations, chosen, left_out),
        slides=slides,
        findings=tuple(_finding(fixed.subgraph(circle), circle, found, language) for circle in stuck),
        left_out=tuple(sorted(left_out)),
    )
