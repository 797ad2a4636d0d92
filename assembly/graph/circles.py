"""Who lies on whom, the circles in it, and few units whose removal leaves none."""

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping
from itertools import groupby, pairwise

import networkx as nx

from aag_cad.language import Text, text
from assembly.graph.laying_units import Overlap


def relations(units: Iterable[str], overlaps: Iterable[Overlap]) -> "nx.DiGraph[str]":
    """Return the units with an edge from each to each that lies on it, and the ``joints`` at which it does."""
    where: dict[tuple[str, str], list[str]] = defaultdict(list)
    for overlap in overlaps:
        where[overlap.lower, overlap.upper].append(overlap.joint)
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from(sorted(set(units)))
    for (lower, upper), joints in sorted(where.items()):
        graph.add_edge(lower, upper, joints=tuple(joints))
    return graph


def knots(graph: "nx.DiGraph[str]") -> list[list[str]]:
    """Return the units of each strongly connected component of more than one: each lies, by others, on each; sorted."""
    return sorted(sorted(part) for part in nx.strongly_connected_components(graph) if len(part) > 1)


def part_of(graph: "nx.DiGraph[str]", marks: Collection[str]) -> "nx.DiGraph[str]":
    """Return the part of a graph between some units, in the order of their marks: views of networkx have no order."""
    part: nx.DiGraph[str] = nx.DiGraph()
    part.add_nodes_from(sorted(marks))
    for lower in sorted(marks):
        for upper in sorted(graph[lower]):
            if upper in part:
                part.add_edge(lower, upper, joints=graph[lower][upper]["joints"])
    return part


def circle_links(knot: "nx.DiGraph[str]") -> tuple[Text, ...]:
    """Return a shortest circle through the first unit of a knot: who lies on whom, and at which joints."""
    first = min(knot)
    ways = [nx.shortest_path(knot, follower, first) for follower in sorted(knot[first])]
    return tuple(
        text("graph.interlacing.link", upper=upper, lower=lower, joints=", ".join(knot[lower][upper]["joints"]))
        for lower, upper in pairwise([first, *min(ways, key=len)])
    )


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


def _through(graph: "nx.DiGraph[str]", knot: Collection[str]) -> Callable[[str], tuple[int, str]]:
    """Return what sorts the units of a knot by how many ways lead in and out of them within it, most first."""

    def order(mark: str) -> tuple[int, str]:
        inwards = sum(other in knot for other in graph.predecessors(mark))
        return -inwards * sum(other in knot for other in graph.successors(mark)), mark

    return order


def _greedy(knot: "nx.DiGraph[str]", allowed: Collection[str]) -> list[str]:
    """Return units whose removal leaves no circle: in each knot that is left, the one with most ways through it."""
    rest = knot.copy()
    chosen: list[str] = []
    while left := knots(rest):
        for marks in left:
            chosen.append(min((mark for mark in marks if mark in allowed), key=_through(rest, set(marks))))
        rest.remove_nodes_from(chosen)
    return _without_needless(knot, chosen)


def few_out(knot: "nx.DiGraph[str]", allowed: Collection[str], family: Mapping[str, str]) -> list[str]:
    """Return few of the allowed units of a knot whose removal leaves no circle, sorted; not always the fewest.

    The greedy choice, or units of one family if that takes no more of them. Every circle must hold an allowed unit.
    """
    found = _greedy(knot, allowed)
    able = sorted((family[mark], mark) for mark in knot if mark in allowed)
    for _, listed in groupby(able, key=lambda pair: pair[0]):
        members = [mark for _, mark in listed]
        if nx.is_directed_acyclic_graph(part_of(knot, set(knot) - set(members))):
            needed = _without_needless(knot, members)
            mixed = len({family[mark] for mark in found}) > 1
            if (len(needed), not mixed) < (len(found), mixed):
                found = needed
    return found
