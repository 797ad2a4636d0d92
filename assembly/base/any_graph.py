"""Any networkx graph of parts and joints as the one kind that the planner works on: an undirected multigraph."""

from collections.abc import Mapping
from typing import Any

import networkx as nx


def add_joint(graph: "nx.MultiGraph[str]", a: str, b: str, key: str | None, values: Mapping[str, Any]) -> None:
    """Add an edge with its attributes, whatever they are called; without a key it gets a number."""
    # Not as keywords: others may have attributes of the names of the parameters.
    new = graph.add_edge(a, b, key)
    graph.edges[a, b, new].update(values)


def as_multigraph(graph: "nx.Graph[str]") -> "nx.MultiGraph[str]":
    """Return a Graph, DiGraph, MultiGraph or MultiDiGraph as an undirected multigraph; what is one comes back itself.

    A crossing directed from a to b that does not say which of the two lies ``above`` says that b does. Two edges of one
    key that run either way with the same attributes, as ``to_directed`` makes them, are one that says nothing. The
    given graph stays as it is. Nodes and attributes are not looked at: see ``assembly.graph.faults``.
    """
    if not graph.is_directed():
        return graph if isinstance(graph, nx.MultiGraph) else nx.MultiGraph(graph)
    directed: nx.MultiDiGraph[str] = nx.MultiDiGraph(graph)
    found: nx.MultiGraph[str] = nx.MultiGraph()
    found.graph.update(directed.graph)
    found.add_nodes_from(directed.nodes(data=True))
    for a, b, key, values in directed.edges(keys=True, data=True):
        edge, taken = dict(values), found.has_edge(a, b, key)
        if a != b and directed.get_edge_data(b, a, key) == values:
            if taken:
                continue
        elif edge.get("kind") == "crossing" and edge.get("above") is None:
            edge["above"] = b
        if taken and isinstance(key, str):
            # The key names the joint of an edge that names none.
            edge.setdefault("joint", key)
        add_joint(found, a, b, None if taken else key, edge)
    return found
