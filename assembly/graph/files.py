"""Graphs of parts and joints as files: JSON of our own and GraphML; both are read back to an equal graph."""

import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, TypeAlias
from xml.etree.ElementTree import ParseError

import networkx as nx

from aag_cad.resources import shipped_names, shipped_text
from assembly.base.errors import PlanError
from assembly.graph.faults import GraphProblem, graph_problems, refuse
from assembly.graph.laying_units import is_laid, joint_name

SCHEMA_VERSION = 1

Attributes: TypeAlias = dict[str, Any]
# Marks of both ends, key (None where the file gives none) and attributes.
_Edge: TypeAlias = tuple[str, str, str | None, Attributes]

_POINTS = ("position", "start", "end")
_NUMBERS = ("mass_kg", "length_mm", "depth_mm", "min_radius_mm", "below_mm", "above_mm")
_AXES = ("x", "y", "z")
# GraphML as networkx reads it drops empty texts, and ``above`` is empty where two planks meet end to end.
_MEETS = "meets"


def _in_our_types(values: Mapping[str, Any]) -> Attributes:
    """Return attributes with points as tuples and whole numbers as floats where they stand for lengths or masses."""
    read = dict(values)
    for name in _POINTS:
        if isinstance(read.get(name), list | tuple):
            read[name] = tuple(float(x) if type(x) is int else x for x in read[name])
    for name in _NUMBERS:
        if type(read.get(name)) is int:
            read[name] = float(read[name])
    return read


def _free_key(graph: "nx.MultiGraph[str]", a: str, b: str, keys: Iterable[str]) -> str | None:
    """Return the first of some keys that no edge between two nodes has, or None."""
    return next((key for key in keys if not graph.has_edge(a, b, key)), None)


def _add(graph: "nx.MultiGraph[str]", a: str, b: str, key: str | None, values: Attributes) -> None:
    # Not as keywords: others may have attributes of the names of the parameters.
    new = graph.add_edge(a, b, key)
    graph.edges[a, b, new].update(values)


def _completed(graph: "nx.MultiGraph[str]") -> "nx.MultiGraph[str]":
    """Return a faultless graph with its defaults, sorted; edges without a key get their joint's mark, or more of it."""
    full: nx.MultiGraph[str] = nx.MultiGraph(name=str(graph.graph.get("name", "")))
    for mark in sorted(graph):
        node: Attributes = {"family": "", "shell": "", "beam": "", "layer": None} | _in_our_types(graph.nodes[mark])
        if is_laid(node):
            middle = tuple((a + b) / 2.0 for a, b in zip(node["start"], node["end"], strict=True))
            node = {"position": middle, "upright": False, **node}
        full.add_node(mark)
        full.nodes[mark].update(node)
    edges = ((*sorted((a, b)), key, values) for a, b, key, values in graph.edges(keys=True, data=True))
    for a, b, key, values in sorted(edges, key=lambda edge: (*edge[:2], not isinstance(edge[2], str), str(edge[2]))):
        joint = joint_name(a, b, key, values)
        kind = f"{joint} {values['kind']}"
        keys = [key] if isinstance(key, str) else [joint, kind, f"{kind} {key}"]
        edge = {"joint_kind": ""} | _in_our_types(values) | {"joint": joint}
        _add(full, a, b, _free_key(full, a, b, keys), edge)
    return full


def with_defaults(graph: "nx.Graph[str]") -> "nx.MultiGraph[str]":
    """Return a graph with the documented defaults filled in, its nodes and edges sorted, its edges keyed by joint.

    Any undirected networkx graph. PlanError with what is wrong with it.
    """
    several: nx.MultiGraph[str] = graph if isinstance(graph, nx.MultiGraph) else nx.MultiGraph(graph)
    refuse(graph_problems(several))
    return _completed(several)


def _plain(where: str, values: Mapping[str, Any]) -> Attributes:
    """Return attributes as a file can hold them, sorted by name; PlanError for any other."""
    plain: Attributes = {}
    for name in sorted(values):
        value = values[name]
        if name in _POINTS:
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


def graph_json(graph: "nx.MultiGraph[str]") -> str:
    """Return a graph as JSON: schema_version, name, nodes (``mark`` and attributes), edges (``a``, ``b``, attributes).

    Nodes by mark, edges by their marks, one a line; every number with all its digits. PlanError if it has faults.
    """
    refuse(graph_problems(graph))
    nodes = _lines({"mark": mark} | _plain(mark, graph.nodes[mark]) for mark in sorted(graph))
    edges = _lines({"a": a, "b": b} | values for a, b, _, values in _edges(graph))
    name = json.dumps(str(graph.graph.get("name", "")), ensure_ascii=False)
    return f'{{"schema_version":{SCHEMA_VERSION},"name":{name},"nodes":[\n{nodes}\n],"edges":[\n{edges}\n]}}\n'


def _assembled(name: str, nodes: Iterable[tuple[str, Attributes]], edges: Iterable[_Edge]) -> "nx.MultiGraph[str]":
    """Return the graph of nodes and edges as they were read, with its defaults; PlanError with all its faults."""
    graph: nx.MultiGraph[str] = nx.MultiGraph(name=name)
    problems: list[GraphProblem] = []
    for mark, values in nodes:
        if mark in graph:
            remedy = "give one of the two another mark"
            problems.append(GraphProblem(mark, "mark", repr(mark), "each mark once", remedy))
        graph.add_node(mark)
        graph.nodes[mark].update(_in_our_types(values))
    for a, b, key, values in edges:
        where, joint = f"edge {a} - {b}", values.get("joint")
        strangers = [mark for mark in (a, b) if mark not in graph]
        problems += [
            GraphProblem(where, "end", repr(mark), "the mark of a node", "add the node, or leave the edge out")
            for mark in strangers
        ]
        keys = [key] if key else [joint, f"{joint} {values.get('kind')}"] if isinstance(joint, str) and joint else []
        free = _free_key(graph, a, b, keys)
        if keys and free is None:
            remedy = "give the second one another joint or key"
            problems.append(GraphProblem(where, "joint", repr(keys[0]), "each once", remedy))
        elif not strangers:
            _add(graph, a, b, free, _in_our_types(values))
    refuse((*problems, *graph_problems(graph)))
    return _completed(graph)


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
    try:
        data = json.loads(text)
    except (json.JSONDecodeError, RecursionError) as error:
        raise PlanError(f"graph: not valid JSON: {error}") from error
    version = data.get("schema_version") if isinstance(data, dict) else None
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
        if name in _POINTS:
            flat |= {f"{name}_{axis}": x for axis, x in zip(_AXES, value, strict=True)}
        elif name == "above" and value == "":
            flat[_MEETS] = True
        elif value is not None and value != "":
            flat[name] = value
    return flat


def _joined(values: Mapping[str, Any]) -> Attributes:
    """Return attributes of GraphML with their points put together again."""
    joined = dict(values)
    for name in _POINTS:
        axes = [f"{name}_{axis}" for axis in _AXES]
        if all(axis in joined for axis in axes):
            joined[name] = tuple(joined.pop(axis) for axis in axes)
    if joined.pop(_MEETS, False):
        joined["above"] = ""
    return joined


def graphml(graph: "nx.MultiGraph[str]") -> str:
    """Return a graph as GraphML; points are split into ``start_x``, ``start_y``, ``start_z`` and so on, mm.

    Of what others added, attributes that are empty or none are left out. PlanError if it has faults.
    """
    refuse(graph_problems(graph))
    flat: nx.MultiGraph[str] = nx.MultiGraph(name=str(graph.graph.get("name", "")))
    for mark in sorted(graph):
        flat.add_node(mark, **_split(mark, graph.nodes[mark]))
    for i, (a, b, _, values) in enumerate(_edges(graph), start=1):
        attributes = {("joint_key" if name == "key" else name): value for name, value in values.items()}
        flat.add_edge(a, b, **_split("", attributes), key=f"e{i}")
    return "\n".join(nx.generate_graphml(flat)) + "\n"


def read_graphml(text: str) -> "nx.MultiGraph[str]":
    """Return the graph in a GraphML text, its defaults filled in; PlanError that lists the first faults of all."""
    try:
        found = nx.parse_graphml(text, node_type=str, force_multigraph=True)
    except (nx.NetworkXError, ParseError, ValueError, KeyError) as error:
        raise PlanError(f"graph: not valid GraphML: {error}") from error
    nodes = [(mark, _joined(values)) for mark, values in found.nodes(data=True)]
    edges = [
        (a, b, joined.pop("joint_key", None), joined)
        for a, b, joined in ((a, b, _joined(values)) for a, b, values in found.edges(data=True))
    ]
    return _assembled(str(found.graph.get("name", "")), nodes, edges)


def shipped_graphs() -> list[str]:
    """Return the names of the shipped graphs, sorted."""
    return shipped_names("graphs", ".json")


def graph_text(name_or_path: str) -> str:
    """Return the text of a shipped graph or of a file; FileError if neither can be read."""
    return shipped_text("graphs", ".json", name_or_path, "graph")
