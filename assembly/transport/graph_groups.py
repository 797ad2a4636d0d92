"""Any graph of parts in groups that fit the transport: Kernighan-Lin bisection until all do; good, not exact."""

from collections.abc import Iterator, Sequence
from typing import TypeAlias

import networkx as nx
import numpy as np

from aag_cad.units import Floats
from assembly.base.any_graph import as_multigraph
from assembly.base.errors import PlanError
from assembly.base.segments import Limits
from assembly.transport.loading import best_pose

Halves: TypeAlias = tuple[list[str], list[str]]

_SEED = 0
_ROUNDING = 1e-9


def _simple(graph: "nx.MultiGraph[str]") -> "nx.Graph[str]":
    """Return the graph with one edge for each pair of parts; its weight is how many joints tie them."""
    simple: nx.Graph[str] = nx.Graph()
    simple.add_nodes_from(sorted(graph))
    for a, b in sorted(tuple(sorted(edge)) for edge in graph.edges()):
        if a != b:
            simple.add_edge(a, b, weight=simple.get_edge_data(a, b, {"weight": 0})["weight"] + 1)
    return simple


def _fits(graph: "nx.MultiGraph[str]", nodes: list[str], limits: Limits) -> bool:
    if sum(float(graph.nodes[node]["mass_kg"]) for node in nodes) > limits.load:
        return False
    return best_pose(_points(graph, nodes), limits.room, 1.0).filling <= 1.0 + _ROUNDING


def _points(graph: "nx.MultiGraph[str]", nodes: Sequence[str]) -> Floats:
    return np.array([graph.nodes[node]["position"] for node in nodes], dtype=np.float64)


def _slices(graph: "nx.MultiGraph[str]", nodes: list[str]) -> Halves:
    """Return two halves of equal mass along the longest extent of the positions."""
    points = _points(graph, nodes)
    centred = points - points.mean(axis=0)
    along = np.round(centred @ np.linalg.svd(centred, full_matrices=False)[2][0], 6)
    order = sorted(range(len(nodes)), key=lambda i: (along[i], nodes[i]))
    masses = np.cumsum([float(graph.nodes[nodes[i]]["mass_kg"]) for i in order])
    middle = min(int(np.argmin(np.abs(masses - masses[-1] / 2.0))) + 1, len(nodes) - 1)
    low, high = sorted(sorted(nodes[i] for i in side) for side in (order[:middle], order[middle:]))
    return low, high


def _halves(graph: "nx.MultiGraph[str]", simple: "nx.Graph[str]", nodes: list[str], limits: Limits) -> Halves:
    """Return two slices, bettered by Kernighan-Lin unless that makes a half larger than it may be."""
    sliced = _slices(graph, nodes)
    found = nx.algorithms.community.kernighan_lin_bisection(
        simple.subgraph(nodes), partition=(set(sliced[0]), set(sliced[1])), weight="weight", seed=_SEED
    )
    low, high = sorted(sorted(side) for side in found)

    def filling(halves: Halves) -> float:
        return max(1.0, *(best_pose(_points(graph, half), limits.room).filling for half in halves))

    return (low, high) if filling((low, high)) <= filling(sliced) else sliced


def _divided(
    graph: "nx.MultiGraph[str]", simple: "nx.Graph[str]", nodes: list[str], limits: Limits
) -> Iterator[frozenset[str]]:
    if _fits(graph, nodes, limits):
        yield frozenset(nodes)
        return
    if len(nodes) == 1:
        mass = float(graph.nodes[nodes[0]]["mass_kg"])
        raise PlanError(
            f"{nodes[0]}: {mass:g} kg, at most {limits.load:g} kg travel; raise the load or divide the part"
        )
    for half in _halves(graph, simple, nodes, limits):
        yield from _divided(graph, simple, half, limits)


def partition_graph(graph: "nx.Graph[str]", limits: Limits) -> tuple[frozenset[str], ...]:
    """Return groups of nodes, each light and small enough to travel, that cut few joints.

    Any networkx graph whose nodes carry ``mass_kg`` and ``position`` (mm), such as
    ``assembly.graph.gridshell_graph.assembly_graph``.
    The size is that of the positions: where parts stand out past them, give limits less by that. Halves of equal mass
    are exchanged node by node (Kernighan and Lin), which keeps their node counts, unless a half outgrows the transport
    by it. Groups come in the order of their first marks. PlanError if a node lacks an attribute or is too heavy by
    itself.
    """
    several = as_multigraph(graph)
    for node in sorted(several):
        missing = sorted({"mass_kg", "position"} - set(several.nodes[node]))
        if missing:
            raise PlanError(f"{node}: no {' and no '.join(missing)}; give every node mass_kg (kg) and position (mm)")
    if not several:
        return ()
    groups = _divided(several, _simple(several), sorted(several), limits)
    return tuple(sorted(groups, key=min))
