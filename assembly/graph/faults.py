"""What is wrong with a graph of parts and joints before anything is planned with it; every fault, not only the first.

A node needs ``kind`` (text), ``mass_kg`` and ``length_mm``; what is laid on the floor, a plank or an end of a crossing,
also ``start`` and ``end``. A crossing needs ``above`` or nodes in different layers. All else of
``assembly.graph.gridshell_graph.PartNode`` and ``JointEdge`` may be left out: ``family``, ``shell``, ``beam`` and
``joint_kind`` are then "", ``layer`` None, ``upright`` False, ``slides`` whatever ``upright`` is not, ``position`` the
middle between the ends, ``joint`` the key of the edge or its two marks, the stations of a crossing those where its
straight lines come nearest. Where ``depth_mm`` or ``min_radius_mm`` is left out, no bend can be checked, and the plank
is slid in only where it stays straight; without ``width_mm`` it is drawn as a line, and only with both of these it has
a section in the booklet. Attributes of other names are kept and not looked at.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, TypeGuard, get_args

import networkx as nx
import numpy as np

from assembly.base.any_graph import as_multigraph
from assembly.base.errors import PlanError
from assembly.graph.laying_units import is_laid, upper_of

EdgeKind: TypeAlias = Literal["crossing", "coupled", "bolted", "screwed", "seated", "bladed"]
EDGE_KINDS: tuple[EdgeKind, ...] = get_args(EdgeKind)
_SHOWN = 8


@dataclass(frozen=True)
class GraphProblem:
    """A fault of a graph: node or edge, attribute, the value found, what is allowed, and the remedy."""

    where: str
    attribute: str
    value: str
    allowed: str
    remedy: str

    @property
    def text(self) -> str:
        """The fault in one line."""
        return f"{self.where}: {self.attribute} {self.value}, allowed: {self.allowed}; {self.remedy}"


_Rule: TypeAlias = tuple[Callable[[Any], bool], str]


def _number(value: Any) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def is_point(value: Any) -> bool:
    """Return whether a value is a point in space, mm."""
    return isinstance(value, tuple | list | np.ndarray) and len(value) == 3 and all(map(_number, value))


def _same(start: Any, end: Any) -> bool:
    return is_point(start) and is_point(end) and tuple(start) == tuple(end)


_TEXT: _Rule = (lambda value: isinstance(value, str) and value.isprintable(), "a text in one line")
_NAME: _Rule = (
    lambda value: isinstance(value, str) and value.isprintable() and value != "",
    "a text that is not empty",
)
_TRUTH: _Rule = (lambda value: isinstance(value, bool), "true or false")
_PLACE: _Rule = (is_point, "three finite numbers, mm")
_POSITIVE: _Rule = (lambda value: _number(value) and value > 0, "a finite number above 0")
_NOT_NEGATIVE: _Rule = (lambda value: _number(value) and value >= 0, "a finite number, 0 or more")
_FINITE: _Rule = (_number, "a finite number, mm")
_TEXT_OR_NONE: _Rule = (lambda value: value is None or isinstance(value, str), "a text or none")
_LAYER: _Rule = (
    lambda value: value is None or (isinstance(value, int) and not isinstance(value, bool)),
    "a whole number, rising outwards, or none",
)

_NODE: Mapping[str, _Rule] = {
    "kind": _NAME, "family": _TEXT, "shell": _TEXT, "beam": _TEXT, "layer": _LAYER, "mass_kg": _NOT_NEGATIVE,
    "length_mm": _POSITIVE, "position": _PLACE, "start": _PLACE, "end": _PLACE, "upright": _TRUTH,
    "width_mm": _POSITIVE, "depth_mm": _POSITIVE, "min_radius_mm": _POSITIVE, "slides": _TRUTH,
}  # fmt: skip
_EDGE: Mapping[str, _Rule] = {
    "kind": (lambda value: value in EDGE_KINDS, ", ".join(EDGE_KINDS)),
    "joint": _NAME, "joint_kind": _TEXT, "above": _TEXT_OR_NONE, "below_mm": _FINITE, "above_mm": _FINITE,
}  # fmt: skip


def _wrong(where: str, values: Mapping[str, Any], needed: tuple[str, ...], rules: Mapping[str, _Rule]) -> Iterator[
    GraphProblem
]:  # fmt: skip
    for name, (fits, allowed) in rules.items():
        if name not in values:
            if name in needed:
                yield GraphProblem(where, name, "is missing", allowed, f"give it {name}")
        elif not fits(values[name]):
            yield GraphProblem(where, name, repr(values[name]), allowed, f"correct its {name}")


def _crossing(
    graph: "nx.MultiGraph[str]", ends: tuple[str, str], where: str, edge: Mapping[str, Any]
) -> Iterator[GraphProblem]:
    above, nodes = edge.get("above"), [graph.nodes[end] for end in ends]
    if above is not None and above not in ("", *ends):
        allowed = f"{ends[0]}, {ends[1]}, or empty where they meet"
        yield GraphProblem(where, "above", repr(above), allowed, "name the upper one of the two")
        return
    upper = upper_of(graph, *ends, dict(edge))
    if upper is None:
        found = f"{nodes[0].get('layer')} and {nodes[1].get('layer')}"
        remedy = f"give the crossing above ({ends[0]} or {ends[1]}), or its planks different layers"
        yield GraphProblem(where, "layer", found, "two different layers", remedy)
    elif upper:
        for name, mark in (("below_mm", ends[upper == ends[0]]), ("above_mm", upper)):
            length, station = graph.nodes[mark].get("length_mm"), edge.get(name)
            if _number(length) and _number(station) and not 0.0 <= station <= length:
                yield GraphProblem(
                    where, name, repr(station), f"0 to {length:g} mm along {mark}", f"correct its {name}"
                )


def _node(mark: object, values: Mapping[str, Any], laid: bool) -> Iterator[GraphProblem]:
    needed = ("kind", "mass_kg", "length_mm", "start", "end") if laid else ("kind", "mass_kg", "length_mm")
    yield from _wrong(str(mark), values, needed, _NODE)
    if not _NAME[0](mark):
        yield GraphProblem(repr(mark), "mark", repr(mark), _NAME[1], "name the node by a text")
    elif "start" in values and _same(values["start"], values.get("end")):
        found = repr(values["end"])
        yield GraphProblem(str(mark), "end", found, "another point than start", "give both ends of the line")


def _edge(graph: "nx.MultiGraph[str]", a: str, b: str, values: Mapping[str, Any]) -> Iterator[GraphProblem]:
    where = f"edge {a} - {b}" + (f" at {values['joint']}" if values.get("joint") else "")
    yield from _wrong(where, values, ("kind",), _EDGE)
    if a == b:
        yield GraphProblem(where, "ends", str(a), "two different nodes", "leave the edge out")
    elif values.get("kind") == "crossing":
        yield from _crossing(graph, (a, b), where, values)


def graph_problems(graph: "nx.Graph[str]") -> tuple[GraphProblem, ...]:
    """Return every fault of any networkx graph by its nodes, then its edges, each in the order of their marks."""
    several = as_multigraph(graph)
    edges = list(several.edges(keys=True, data=True))
    crossing = {end for a, b, _, values in edges if values.get("kind") == "crossing" for end in (a, b)}
    found: list[tuple[tuple[str, ...], GraphProblem]] = []
    for mark, values in several.nodes(data=True):
        found += [(("node", str(mark)), p) for p in _node(mark, values, mark in crossing or is_laid(values))]
    for a, b, key, values in edges:
        order = ("with", *sorted((str(a), str(b))), str(key))
        found += [(order, problem) for problem in _edge(several, a, b, values)]
    return tuple(problem for _, problem in sorted(found, key=lambda pair: pair[0]))


def refuse(problems: tuple[GraphProblem, ...]) -> None:
    """Raise PlanError with the first faults and the count of the rest, if there are any."""
    if problems:
        rest = len(problems) - _SHOWN
        shown = [problem.text for problem in problems[:_SHOWN]] + ([f"and {rest} more"] if rest > 0 else [])
        raise PlanError(f"{len(problems)} fault{'s' * (len(problems) > 1)} in the graph:\n" + "\n".join(shown))
