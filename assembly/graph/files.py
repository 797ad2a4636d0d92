"""Graphs of parts and joints as files: JSON of our own and GraphML; both are read back to an equal graph."""

import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, TypeAlias, cast
from xml.etree.ElementTree import ParseError

import networkx as nx

from aag_cad.files import json_object
from aag_cad.resources import shipped_names, shipped_text
from assembly.base.any_graph import add_joint, as_multigraph
from assembly.base.errors import PlanError
from assembly.graph.faults import GraphProblem, graph_problems, is_point, refuse
from assembly.graph.whole import POINTS, Attributes, completed, free_key, in_our_types, whole_graph

SCHEMA_VERSION = 1

# Marks of both ends, key (None where the file gives none) and attributes.
_Edge: TypeAlias = tuple[str, str, str | None, Attributes]

_AXES = ("x", "y", "z")
# GraphML as networkx reads it drops empty texts, and ``above`` is empty where two planks meet end to end.
_MEETS = "meets"


def _plain(where: str, values: Mapping[str, Any]) -> Attributes:
    """Return attributes as a file can hold them, sorted by name; PlanError for any other."""
    plain: Attributes = {}
    for name in sorted(values):
        value = values[name]
        if name in POINTS and is_point(value):
            value = list(value)
        elif not (value is None or isinstance(value, str | bool | int | float)):
            raise PlanError(f"{where}: {name} {value!r}; give it as text, number, true or false")
        plain[name] = value
    return plain


def _edges(graph: "nx.MultiGraph[str]") -> Iterator[tuple[str, str, str, Attributes]]:
    """Yield the edges of a graph, the lower mark first, by marks and keys; ``key`` as attribute where not the joint."""
    found = []
    for a, b, key, values in graph.edges(keys=True, data=True):
        plain = _plain(f"edge {a} - {b}", values)
        if not isinstance(key, int) and key != plain.get("joint"):
            plain["key"] = key
        found.append((min(a, b), max(a, b), str(key), plain))
    yield from sorted(found, key=lambda edge: edge[:3])


def _lines(items: Iterable[Attributes]) -> str:
    return ",\n".join(json.dumps(item, ensure_ascii=False, allow_nan=False) for item in items)


def graph_json(graph: "nx.Graph[str]") -> str:
    """Return any graph as JSON: schema_version, name, nodes (``mark``, attributes), edges (``a``, ``b``, attributes).

    Nodes by mark, edges by their marks, one a line; every number with all its digits. PlanError if it has faults.
    """
    whole = whole_graph(graph)
    nodes = _lines({"mark": mark} | _plain(mark, whole.nodes[mark]) for mark in whole)
    edges = _lines({"a": a, "b": b} | values for a, b, _, values in _edges(whole))
    name = json.dumps(str(whole.name), ensure_ascii=False)
    return f'{{"schema_version":{SCHEMA_VERSION},"name":{name},"nodes":[\n{nodes}\n],"edges":[\n{edges}\n]}}\n'


def _assembled(name: str, nodes: Iterable[tuple[str, Attributes]], edges: Iterable[_Edge]) -> "nx.MultiGraph[str]":
    """Return the graph of nodes and edges as they were read, with its defaults; PlanError with all its faults."""
    graph: nx.MultiGraph[str] = nx.MultiGraph(name=name)
    problems: list[GraphProblem] = []
    for mark, values in nodes:
        if mark in graph:
            remedy = "give one of the two another mark"
            problems.append(GraphProblem(mark, "mark", repr(mark), "each mark once", remedy))
        graph.add_nodes_from([(mark, in_our_types(values))])
    for a, b, key, values in edges:
        where, joint = f"edge {a} - {b}", values.get("joint")
        strangers = [mark for mark in (a, b) if mark not in graph]
        problems += [
            GraphProblem(where, "end", repr(mark), "the mark of a node", "add the node, or leave the edge out")
            for mark in strangers
        ]
        keys = [key] if key else [joint, f"{joint} {values.get('kind')}"] if isinstance(joint, str) and joint else []
        free = free_key(graph, a, b, keys)
        if keys and free is None:
            remedy = "give the second one another joint or key"
            problems.append(GraphProblem(where, "joint", repr(keys[0]), "each once", remedy))
        elif not strangers:
            add_joint(graph, a, b, free, in_our_types(values))
    refuse((*problems, *graph_problems(graph)))
    return completed(graph)


def _items(data: Attributes, name: str, marks: tuple[str, ...]) -> list[Attributes]:
    """Return the objects of a list of the file, each with the marks that it needs; PlanError if it is none."""
    items = data.get(name)
    if not isinstance(items, list):
        raise PlanError(f"graph: {name} {items!r:.60}; give a list of objects")
    for i, item in enumerate(items):
        for mark in marks:
            if not isinstance(item, dict) or not isinstance(item.get(mark), str) or not item[mark]:
                raise PlanError(f"graph: {name}[{i}]: {item!r:.80}; give an object with {mark} as a text")
        if not isinstance(item.get("key", ""), str):
            raise PlanError(f"graph: {name}[{i}]: key {item['key']!r:.60}; give it as a text, or leave it out")
    return items


def read_graph(text: str) -> "nx.MultiGraph[str]":
    """Return the graph in a JSON text, its defaults filled in; PlanError that lists the first faults of all."""
    data = json_object(text, "graph", PlanError)
    version = data.get("schema_version")
    if version != SCHEMA_VERSION:
        raise PlanError(
            f"graph: schema_version {version!r}, this program reads {SCHEMA_VERSION}; see docs/interlacing.md"
        )
    nodes = [(item.pop("mark"), item) for item in _items(data, "nodes", ("mark",))]
    edges = [(e.pop("a"), e.pop("b"), e.pop("key", None), e) for e in _items(data, "edges", ("a", "b"))]
    return _assembled(str(data.get("name", "")), nodes, edges)


def _split(where: str, values: Mapping[str, Any]) -> Attributes:
    """Return attributes as GraphML can hold them: points as three numbers, nothing that is none or empty."""
    flat: Attributes = {}
    for name, value in _plain(where, values).items():
        if isinstance(value, list):
            flat |= {f"{name}_{axis}": x for axis, x in zip(_AXES, value, strict=True)}
        elif name == "above" and value == "":
            flat[_MEETS] = True
        elif value is not None and value != "":
            flat[name] = value
    return flat


def _joined(values: Mapping[str, Any]) -> Attributes:
    """Return attributes of GraphML with their points put together again."""
    joined = dict(values)
    for name in POINTS:
        axes = [f"{name}_{axis}" for axis in _AXES]
        if all(axis in joined for axis in axes):
            joined[name] = tuple(joined.pop(axis) for axis in axes)
    if joined.pop(_MEETS, False):
        joined["above"] = ""
    return joined


def graphml(graph: "nx.Graph[str]") -> str:
    """Return any graph as GraphML; points are split into ``start_x``, ``start_y``, ``start_z`` and so on, mm.

    Of what others added, attributes that are empty or none are left out. PlanError if it has faults.
    """
    whole = whole_graph(graph)
    flat: nx.MultiGraph[str] = nx.MultiGraph(name=str(whole.name))
    flat.add_nodes_from((mark, _split(mark, whole.nodes[mark])) for mark in whole)
    for i, (a, b, _, values) in enumerate(_edges(whole), start=1):
        attributes = {("joint_key" if name == "key" else name): value for name, value in values.items()}
        flat.add_edge(a, b, **_split("", attributes), key=f"e{i}")
    return "\n".join(nx.generate_graphml(flat)) + "\n"


def read_graphml(text: str) -> "nx.MultiGraph[str]":
    """Return the graph in a GraphML text, its defaults filled in; PlanError that lists the first faults of all."""
    try:
        read = cast("nx.MultiGraph[str]", nx.parse_graphml(text, node_type=str, force_multigraph=True))
    except (nx.NetworkXError, ParseError, ValueError, KeyError) as error:
        raise PlanError(f"graph: not valid GraphML: {error}") from error
    for _, _, values in read.edges(data=True):
        # Before a direction may say who lies above: where they meet, nobody does.
        joined = _joined(values)
        values.clear()
        values.update(joined)
    found = as_multigraph(read)
    nodes = [(mark, _joined(values)) for mark, values in found.nodes(data=True)]
    edges = [(a, b, values.pop("joint_key", None), values) for a, b, values in found.edges(data=True)]
    return _assembled(str(found.graph.get("name", "")), nodes, edges)


def shipped_graphs() -> list[str]:
    """Return the names of the shipped graphs, sorted."""
    return shipped_names("graphs", ".json")


def graph_text(name_or_path: str) -> str:
    """Return the text of a shipped graph or of a file; FileError if neither can be read."""
    return shipped_text("graphs", ".json", name_or_path, "graph")
