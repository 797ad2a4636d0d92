"""A weave is the same weave as a Graph, DiGraph, MultiGraph or MultiDiGraph: a crossing may be directed upwards."""

from copy import deepcopy
from typing import Any

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from weaving import Weave, graph_of, weaves

from assembly.base.any_graph import as_multigraph
from assembly.base.errors import PlanError
from assembly.base.segments import Limits
from assembly.checks.graph_plan import check_graph_plan
from assembly.graph.faults import graph_problems
from assembly.graph.files import graph_json, graph_text, graphml, read_graph, read_graphml
from assembly.graph.interlacing import interlacing
from assembly.graph.whole import whole_graph
from assembly.plan.graph_plan import graph_plan
from assembly.transport.graph_groups import partition_graph

TYPES = (nx.Graph, nx.DiGraph, nx.MultiGraph, nx.MultiDiGraph)
PLANK = {"kind": "plank", "mass_kg": 5.0, "length_mm": 2000.0}


def retold(graph: "nx.MultiGraph[str]", kind: type["nx.Graph[str]"]) -> "nx.Graph[str]":
    """Return a graph as one of another type; if that is directed, its crossings say by direction who lies above."""
    told = kind(name=graph.name)
    told.add_nodes_from(deepcopy(list(graph.nodes(data=True))))
    for a, b, key, edge in graph.edges(keys=True, data=True):
        ends, values = (a, b), dict(edge)
        if told.is_directed() and values.get("above"):
            upper = values.pop("above")
            ends = (b, a) if upper == a else (a, b)
        told.add_edge(*ends, **({"key": key} if told.is_multigraph() else {}), **values)
    return told


def snapshot(graph: "nx.Graph[str]") -> tuple[Any, ...]:
    return deepcopy((graph.graph, dict(graph.nodes(data=True)), list(graph.edges(data=True))))


def bolted(weave: Weave) -> "nx.MultiGraph[str]":
    """Return a weave with a bolt at every crossing."""
    graph = whole_graph(graph_of(weave))
    for i, (a, b) in enumerate(list(graph.edges())):
        graph.add_node(f"bolt {i}", kind="bolt", mass_kg=0.1, length_mm=60.0, position=(100.0 * i, 0.0, 0.0))
        for plank in (a, b):
            graph.add_edge(plank, f"bolt {i}", kind="bolted", joint=f"K{i}")
    return graph


@given(weaves(most=6), st.sampled_from(TYPES))
def test_a_weave_has_one_plan_whatever_type_its_graph_has(weave: Weave, kind: Any) -> None:
    graph = bolted(weave)
    if not graph:
        return
    told = retold(graph, kind)
    before, plan = snapshot(told), graph_plan(graph, 3, 25.0)
    assert graph_plan(told, 3, 25.0) == plan
    assert check_graph_plan(plan, told, 3) == check_graph_plan(plan, graph, 3) == []
    assert interlacing(told).slides == interlacing(graph).slides
    assert nx.utils.graphs_equal(whole_graph(told), whole_graph(graph))
    assert graph_json(told) == graph_json(graph)
    assert graphml(told) == graphml(graph)
    limits = Limits(9e3, 9e3, 9e3, 8.0, 8.0)
    assert partition_graph(told, limits) == partition_graph(graph, limits)
    assert snapshot(told) == before


@pytest.mark.parametrize("kind", TYPES)
def test_kagome_has_one_plan_whatever_type_its_graph_has(kind: Any) -> None:
    graph = read_graph(graph_text("kagome"))
    assert graph_plan(retold(graph, kind), 4, 25.0) == graph_plan(graph, 4, 25.0)


@pytest.mark.parametrize("kind", TYPES)
def test_graphml_of_networkx_itself_is_read_with_its_directions(kind: Any) -> None:
    """Written by the library's own writer, from nodes with points as three numbers."""
    graph = read_graph(graph_text("kagome"))
    told = retold(read_graphml(graphml(graph)), kind)
    for _, node in told.nodes(data=True):
        for name in ("start", "end", "position"):
            node |= {f"{name}_{axis}": x for axis, x in zip("xyz", node.pop(name), strict=True)}
        del node["layer"]
    read = read_graphml("\n".join(nx.generate_graphml(told)))
    assert graph_plan(read, 4, 25.0) == graph_plan(graph, 4, 25.0)


def crossing(*edges: tuple[str, str, dict[str, Any]], layers: tuple[int | None, int | None] = (None, None)) -> Any:
    graph: nx.MultiDiGraph[str] = nx.MultiDiGraph()
    ends = {"A": ((0.0, 0.0, 0.0), (2000.0, 0.0, 0.0)), "B": ((900.0, -1000.0, 0.0), (900.0, 1000.0, 0.0))}
    for layer, (mark, (start, end)) in zip(layers, ends.items(), strict=True):
        graph.add_node(mark, **PLANK, start=start, end=end, layer=layer)
    for a, b, values in edges:
        graph.add_edge(a, b, **({"kind": "crossing"} | values))
    return graph


@pytest.mark.parametrize(
    ("edge", "first"),
    [(("A", "B", {}), "A"), (("B", "A", {}), "B"), (("A", "B", {"above": "A"}), "B"), (("A", "B", {"above": ""}), "")],
)
def test_what_an_edge_says_itself_counts_more_than_its_direction(edge: Any, first: str) -> None:
    lying = list(interlacing(crossing(edge)).precedence.edges)
    assert [lower for lower, _ in lying] == ([first] if first else [])


def test_the_direction_of_a_crossing_counts_more_than_the_layers() -> None:
    assert list(interlacing(crossing(("A", "B", {}), layers=(1, 0))).precedence.edges) == [("A", "B")]


def test_an_edge_that_runs_either_way_has_no_direction() -> None:
    """As ``to_directed`` makes them of an undirected graph: then the layers tell, or nothing does."""
    both = ("A", "B", {}), ("B", "A", {})
    assert list(interlacing(crossing(*both, layers=(1, 0))).precedence.edges) == [("B", "A")]
    (problem,) = graph_problems(crossing(*both))
    assert (problem.where, problem.attribute) == ("edge A - B", "layer")
    graph = whole_graph(read_graph(graph_text("kagome")))
    assert nx.utils.graphs_equal(whole_graph(graph.to_directed()), graph)


def test_two_edges_of_one_key_that_run_either_way_are_two_of_that_joint() -> None:
    graph = crossing(("A", "B", {"key": "J"}), ("B", "A", {"key": "J", "kind": "bolted"}))
    found = whole_graph(graph).edges(keys=True, data=True)
    assert {key: (edge["kind"], edge["joint"]) for _, _, key, edge in found} == {
        "J": ("crossing", "J"), "J bolted": ("bolted", "J"),
    }  # fmt: skip


def test_a_multigraph_is_taken_as_it_is() -> None:
    graph: nx.MultiGraph[str] = nx.MultiGraph()
    assert as_multigraph(graph) is graph


@pytest.mark.parametrize("kind", TYPES)
@pytest.mark.parametrize("mark", [7, ("A", 1), "", "two\nlines"])
def test_a_node_that_is_no_text_is_refused_by_name(kind: Any, mark: Any) -> None:
    graph = kind()
    graph.add_node("A", kind="bolt", mass_kg=1.0, length_mm=60.0)
    graph.add_node(mark, kind="bolt", mass_kg=1.0, length_mm=60.0)
    graph.add_edge("A", mark, kind="bolted")
    for take in (lambda: graph_plan(graph, 2, 25.0), lambda: graph_json(graph), lambda: graphml(graph)):
        with pytest.raises(PlanError, match="a text that is not empty; name the node by a text"):
            take()


def test_a_graph_without_nodes_is_refused() -> None:
    with pytest.raises(PlanError, match="graph: no nodes"):
        graph_plan(nx.Graph(), 2, 25.0)


def test_what_a_bolt_lacks_is_told_before_anything_is_planned() -> None:
    graph = crossing(("A", "B", {}))
    graph.add_node("K", kind="bolt", length_mm=60.0)
    graph.add_edge("A", "K", kind="bolted")
    with pytest.raises(PlanError, match="K: mass_kg is missing"):
        graph_plan(graph, 2, 25.0)


def test_points_may_be_arrays_and_lengths_whole_numbers() -> None:
    graph = crossing(("A", "B", {}))
    for node in graph.nodes.values():
        node |= {"start": np.array(node["start"]), "end": np.array(node["end"]), "length_mm": 2000}
    assert graph_plan(graph, 2, 25.0) == graph_plan(crossing(("A", "B", {})), 2, 25.0)
    graph.nodes["A"]["end"] = graph.nodes["A"]["start"]
    (problem,) = graph_problems(graph)
    assert (problem.where, problem.attribute) == ("A", "end")
