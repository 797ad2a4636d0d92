"""Any graph of parts and joints made whole: its faults refused, its defaults filled in, its nodes and edges sorted."""

from collections.abc import Iterable, Mapping
from typing import Any, TypeAlias

import networkx as nx
import numpy as np

from assembly.base.any_graph import add_joint, as_multigraph
from assembly.graph.faults import graph_problems, refuse
from assembly.graph.laying_units import is_laid, joint_name

Attributes: TypeAlias = dict[str, Any]

POINTS = ("position", "start", "end")
_NUMBERS = ("mass_kg", "length_mm", "width_mm", "depth_mm", "min_radius_mm", "below_mm", "above_mm")


def in_our_types(values: Mapping[str, Any]) -> Attributes:
    """Return attributes with points as tuples and whole numbers as floats where they stand for lengths or masses."""
    read = dict(values)
    for name in POINTS:
        if isinstance(read.get(name), list | tuple | np.ndarray):
            read[name] = tuple(float(x) if type(x) is int else x for x in read[name])
    for name in _NUMBERS:
        if type(read.get(name)) is int:
            read[name] = float(read[name])
    return read


def free_key(graph: "nx.MultiGraph[str]", a: str, b: str, keys: Iterable[str]) -> str | None:
    """Return the first of some keys that no edge between two nodes has, or None."""
    return next((key for key in keys if not graph.has_edge(a, b, key)), None)


def completed(graph: "nx.MultiGraph[str]") -> "nx.MultiGraph[str]":
    """Return a faultless graph with its defaults, sorted; edges without a key get their joint's mark, or more of it."""
    full: nx.MultiGraph[str] = nx.MultiGraph(name=str(graph.graph.get("name", "")))
    for mark in sorted(graph):
        node: Attributes = {"family": "", "shell": "", "beam": "", "layer": None} | in_our_types(graph.nodes[mark])
        if is_laid(node):
            middle = tuple((a + b) / 2.0 for a, b in zip(node["start"], node["end"], strict=True))
            node = {"position": middle, "upright": False, **node}
        full.add_nodes_from([(mark, node)])
    edges = ((*sorted((a, b)), key, values) for a, b, key, values in graph.edges(keys=True, data=True))
    for a, b, key, values in sorted(edges, key=lambda edge: (*edge[:2], not isinstance(edge[2], str), str(edge[2]))):
        joint = joint_name(a, b, key, values)
        kind = f"{joint} {values['kind']}"
        keys = [key] if isinstance(key, str) else [joint, kind, f"{kind} {key}"]
        edge = {"joint_kind": ""} | in_our_types(values) | {"joint": joint}
        add_joint(full, a, b, free_key(full, a, b, keys), edge)
    return full


def whole_graph(graph: "nx.Graph[str]") -> "nx.MultiGraph[str]":
    """Return any networkx graph as ``as_multigraph`` does, whole: with the defaults of ``assembly.graph.faults``.

    Nodes and edges are sorted, edges keyed by joint. PlanError with what is wrong with it.
    """
    several = as_multigraph(graph)
    refuse(graph_problems(several))
    return completed(several)
