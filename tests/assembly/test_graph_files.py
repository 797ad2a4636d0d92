"""Graphs of parts and joints as files: read back as they were written, or refused with all that is wrong with them."""

import json
import math
from pathlib import Path
from typing import Any

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shipped_weaves import circle_graph, kagome_graph

from aag_cad.errors import FileError
from aag_cad.parts.model import Gridshell
from aag_cad.parts.store import gridshell_json, read_gridshell
from assembly.base.errors import PlanError
from assembly.graph.faults import EDGE_KINDS, graph_problems
from assembly.graph.files import graph_json, graph_text, graphml, read_graph, read_graphml, shipped_graphs
from assembly.graph.gridshell_graph import assembly_graph
from assembly.graph.interlacing import interlacing
from assembly.graph.whole import whole_graph

Graph = nx.MultiGraph

NODE = {"kind": "plank", "mass_kg": 5.0, "length_mm": 2000.0}


def equal(one: "Graph[str]", other: "Graph[str]") -> bool:
    return bool(nx.utils.graphs_equal(one, other))


def crossed(**edge: Any) -> "Graph[str]":
    """Two planks that cross in their middles; the edge as given."""
    graph: Graph[str] = Graph(name="two planks")
    graph.add_node("A", **NODE, start=(0.0, 0.0, 0.0), end=(2000.0, 0.0, 0.0))
    graph.add_node("B", **NODE, start=(1000.0, -1000.0, 0.0), end=(1000.0, 1000.0, 0.0))
    graph.add_edge("A", "B", key="J-1", **({"kind": "crossing", "above": "B"} | edge))
    return graph


@pytest.fixture(scope="module")
def vault_graph(gridshell: Gridshell) -> "Graph[str]":
    return assembly_graph(gridshell)


texts = st.text(st.characters(codec="utf-8", categories=["L", "N", "P", "S"]), min_size=1, max_size=8)
lengths = st.floats(1e-6, 1e9)
places = st.floats(-1e9, 1e9)
points = st.tuples(places, places, places)


@st.composite
def any_graphs(draw: st.DrawFn) -> "Graph[str]":
    graph: Graph[str] = Graph(name=draw(texts))
    marks = draw(st.lists(texts, unique=True, max_size=6))
    for mark in marks:
        node = {"kind": draw(texts), "mass_kg": draw(st.floats(0.0, 1e6)), "length_mm": draw(lengths)}
        node |= {"start": draw(points), "end": draw(points)}
        optional = {
            "family": texts, "beam": texts, "shell": texts, "upright": st.booleans(), "slides": st.booleans(),
            "depth_mm": lengths, "min_radius_mm": lengths, "layer": st.integers(-99, 99), "position": points,
        }  # fmt: skip
        node |= draw(st.fixed_dictionaries({}, optional=optional))
        if node["start"] != node["end"]:
            graph.add_node(mark, **node)
    pair = st.permutations(sorted(graph))
    for i in range(draw(st.integers(0, 8)) if len(graph) > 1 else 0):
        a, b = draw(pair)[:2]
        kind = draw(st.sampled_from(EDGE_KINDS))
        edge = {"kind": kind, "joint": f"J-{i}", "joint_kind": draw(texts)}
        if kind == "crossing":
            edge["above"] = draw(st.sampled_from([a, b, ""]))
        graph.add_edge(a, b, key=f"J-{i}", **edge)
    return graph


@given(any_graphs())
def test_a_graph_is_read_back_from_json_and_graphml_as_it_was(graph: "Graph[str]") -> None:
    full = whole_graph(graph)
    assert equal(read_graph(graph_json(full)), full)
    assert equal(read_graph(graph_json(graph)), full)
    assert equal(read_graphml(graphml(full)), full)
    assert read_graphml(graphml(graph)).graph["name"] == graph.graph["name"]


@given(any_graphs())
def test_the_same_graph_gives_the_same_bytes_however_it_was_built(graph: "Graph[str]") -> None:
    other: Graph[str] = Graph(name=graph.graph["name"])
    for mark in reversed(list(graph)):
        other.add_node(mark, **dict(reversed(graph.nodes[mark].items())))
    for a, b, key, edge in reversed(list(graph.edges(keys=True, data=True))):
        other.add_edge(b, a, key=key, **edge)
    assert graph_json(other) == graph_json(graph)
    assert graphml(other) == graphml(graph)


def test_the_vault_is_read_back_as_it_was(vault_graph: "Graph[str]") -> None:
    assert equal(read_graph(graph_json(vault_graph)), vault_graph)
    assert equal(read_graphml(graphml(vault_graph)), vault_graph)


def test_the_graph_of_gridshell_json_is_that_of_the_gridshell(gridshell: Gridshell, vault_graph: "Graph[str]") -> None:
    assert equal(assembly_graph(read_gridshell(gridshell_json(gridshell))), vault_graph)


def test_every_id_of_a_graphml_file_stands_for_one_thing(vault_graph: "Graph[str]") -> None:
    """An independent reader of XML: the ids of nodes and edges are unique, every value has a key."""
    from xml.etree import ElementTree

    space = "{http://graphml.graphdrawing.org/xmlns}"
    root = ElementTree.fromstring(graphml(vault_graph))
    edges, nodes = list(root.iter(f"{space}edge")), list(root.iter(f"{space}node"))
    assert len({edge.get("id") for edge in edges}) == len(edges) == vault_graph.number_of_edges()
    assert {node.get("id") for node in nodes} == set(vault_graph)
    keys = {key.get("id") for key in root.iter(f"{space}key")}
    assert {item.get("key") for item in root.iter(f"{space}data")} == keys


@pytest.mark.parametrize(("name", "made"), [("kagome", kagome_graph), ("impossible", circle_graph)])
def test_the_shipped_graphs_are_those_that_their_functions_make(name: str, made: Any) -> None:
    """Sines differ in the last digit between machines, and the file gives its points to a thousandth of a mm."""
    shipped, graph = read_graph(graph_text(name)), whole_graph(made())
    assert sorted(shipped) == sorted(graph)
    assert sorted(shipped.edges(keys=True)) == sorted(graph.edges(keys=True))
    for mark, node in graph.nodes(data=True):
        for key, value in node.items():
            number = isinstance(value, float | tuple)
            assert shipped.nodes[mark][key] == (pytest.approx(value, abs=2e-3) if number else value)
    for a, b, key, edge in graph.edges(keys=True, data=True):
        assert shipped.edges[a, b, key] == pytest.approx(edge, abs=2e-3) or shipped.edges[a, b, key] == edge


def test_the_files_of_the_shipped_graphs_are_written_as_we_write_them() -> None:
    for name in shipped_graphs():
        text = graph_text(name)
        assert graph_json(read_graph(text)) == text


def test_a_name_that_is_none_is_answered_with_those_that_there_are(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"no such graph file, and not a shipped graph \(impossible, kagome\)"):
        graph_text("kagomé")
    with pytest.raises(FileError, match="cannot be read as a text file"):
        graph_text(str(tmp_path))
    path = tmp_path / "own.json"
    path.write_text(graph_json(crossed()), encoding="utf-8")
    assert equal(read_graph(graph_text(str(path))), whole_graph(crossed()))


def test_a_graph_of_others_needs_no_more_than_planks_and_who_lies_above() -> None:
    graph: Graph[str] = Graph()
    for mark, x in (("A", 0.0), ("B", 500.0)):
        graph.add_node(mark, **NODE, start=[x, 0, 0], end=[500 - x, 1000, 0])
    graph.add_edge("A", "B", kind="crossing", above="A")
    full = whole_graph(graph)
    assert full.nodes["A"] == NODE | {
        "start": (0.0, 0.0, 0.0), "end": (500.0, 1000.0, 0.0), "position": (250.0, 500.0, 0.0), "upright": False,
        "family": "", "shell": "", "beam": "", "layer": None,
    }  # fmt: skip
    assert list(full.edges(keys=True, data=True)) == [
        ("A", "B", "A/B", {"kind": "crossing", "above": "A", "joint": "A/B", "joint_kind": ""})
    ]
    assert list(interlacing(graph).precedence.edges) == [("B", "A")]


def test_a_simple_graph_will_do() -> None:
    simple = nx.Graph(crossed())
    assert list(whole_graph(simple).edges(keys=True)) == [("A", "B", "A/B")]


def test_two_joints_of_one_pair_are_told_apart_and_one_joint_may_tie_it_twice() -> None:
    text = graph_json(crossed())
    data = json.loads(text)
    data["edges"] = [
        {"a": "A", "b": "B", "kind": "crossing", "above": "B", "joint": "J"},
        {"a": "B", "b": "A", "kind": "bolted", "joint": "J"},
        {"a": "A", "b": "B", "kind": "screwed"},
        {"a": "A", "b": "B", "kind": "bolted"},
    ]
    graph = read_graph(json.dumps(data))
    assert {key: edge["kind"] for _, _, key, edge in graph.edges(keys=True, data=True)} == {
        "J": "crossing", "J bolted": "bolted", "A/B/2": "screwed", "A/B/3": "bolted",
    }  # fmt: skip
    assert equal(read_graph(graph_json(graph)), graph)
    assert equal(read_graphml(graphml(graph)), graph)


def test_attributes_of_others_are_kept() -> None:
    graph = whole_graph(crossed(colour="red"))
    graph.nodes["A"]["grade"] = 2
    assert equal(read_graph(graph_json(graph)), graph)
    assert equal(read_graphml(graphml(graph)), graph)
    graph.nodes["A"]["grade"] = {1, 2}
    for write in (graph_json, graphml):
        with pytest.raises(PlanError, match=r"A: grade \{1, 2\}"):
            write(graph)


BAD_NODES = [
    ("mass_kg", -1.0, "a finite number, 0 or more"),
    ("mass_kg", math.nan, "a finite number, 0 or more"),
    ("mass_kg", "5", "a finite number, 0 or more"),
    ("mass_kg", True, "a finite number, 0 or more"),
    ("length_mm", 0.0, "a finite number above 0"),
    ("length_mm", math.inf, "a finite number above 0"),
    ("kind", "", "a text that is not empty"),
    ("layer", 0.5, "a whole number, rising outwards, or none"),
    ("start", (0.0, 0.0), "three finite numbers, mm"),
    ("start", (0.0, 0.0, math.nan), "three finite numbers, mm"),
    ("end", (0.0, 0.0, 0.0), "another point than start"),
    ("upright", 1, "true or false"),
    ("depth_mm", -12.0, "a finite number above 0"),
    ("min_radius_mm", 0.0, "a finite number above 0"),
    ("family", 3, "a text in one line"),
    ("family", "two\nlines", "a text in one line"),
]


@pytest.mark.parametrize(("attribute", "value", "allowed"), BAD_NODES)
def test_a_bad_node_is_named_with_its_attribute_and_what_is_allowed(attribute: str, value: Any, allowed: str) -> None:
    graph = crossed()
    graph.nodes["A"][attribute] = value
    (problem,) = graph_problems(graph)
    assert (problem.where, problem.attribute, problem.value) == ("A", attribute, repr(value))
    assert problem.allowed == allowed
    assert problem.remedy in problem.text
    with pytest.raises(PlanError, match="1 fault in the graph"):
        interlacing(graph)


@pytest.mark.parametrize("attribute", ["kind", "mass_kg", "length_mm", "start", "end"])
def test_what_a_plank_needs_is_missed(attribute: str) -> None:
    graph = crossed()
    del graph.nodes["A"][attribute]
    (problem,) = graph_problems(graph)
    assert (problem.where, problem.attribute, problem.value) == ("A", attribute, "is missing")


BAD_EDGES = [
    ({"kind": "glued"}, "kind", "crossing, coupled, bolted, screwed, seated, bladed"),
    ({"above": "C"}, "above", "A, B, or empty where they meet"),
    ({"above": 7}, "above", "a text or none"),
    ({"above": None}, "layer", "two different layers"),
    ({"below_mm": 2000.5}, "below_mm", "0 to 2000 mm along A"),
    ({"above_mm": -0.5}, "above_mm", "0 to 2000 mm along B"),
    ({"above": "A", "below_mm": 2001.0}, "below_mm", "0 to 2000 mm along B"),
    ({"below_mm": math.nan}, "below_mm", "a finite number, mm"),
    ({"joint": ""}, "joint", "a text that is not empty"),
]


@pytest.mark.parametrize(("edge", "attribute", "allowed"), BAD_EDGES)
def test_a_bad_edge_is_named_with_its_ends(edge: dict[str, Any], attribute: str, allowed: str) -> None:
    problems = graph_problems(crossed(**edge))
    assert {problem.where for problem in problems} == {"edge A - B"}
    assert (attribute, allowed) in [(problem.attribute, problem.allowed) for problem in problems]


def test_an_edge_without_a_kind_and_one_from_a_part_to_itself_are_faults() -> None:
    graph = crossed()
    graph.add_edge("A", "A", kind="bolted")
    del graph.edges["A", "B", "J-1"]["kind"]
    assert [(problem.where, problem.attribute) for problem in graph_problems(graph)] == [
        ("edge A - A", "ends"), ("edge A - B", "kind"),
    ]  # fmt: skip


def test_planks_of_one_layer_need_to_be_told_who_lies_above() -> None:
    graph = crossed(above=None)
    for mark, layer in (("A", 1), ("B", 1)):
        graph.nodes[mark]["layer"] = layer
    (problem,) = graph_problems(graph)
    assert problem.value == "1 and 1"
    graph.nodes["B"]["layer"] = 0
    assert not graph_problems(graph)


def test_the_first_faults_are_listed_and_the_rest_counted() -> None:
    data = json.loads(graph_json(kagome_graph()))
    for node in data["nodes"]:
        node["mass_kg"] = -1
    with pytest.raises(PlanError) as caught:
        read_graph(json.dumps(data))
    lines = str(caught.value).splitlines()
    assert lines[0] == "18 faults in the graph:"
    assert lines[1].startswith("P1-01: mass_kg -1.0, allowed: a finite number, 0 or more")
    assert len(lines) == 10
    assert lines[-1] == "and 10 more"


def broken(**changes: Any) -> str:
    return json.dumps(json.loads(graph_json(crossed())) | changes)


NODES = [{"mark": "A"} | NODE | {"start": [0, 0, 0], "end": [1, 0, 0]}]
BAD_FILES = [
    ("{", "not valid JSON"),
    ("[" * 100_000, "not valid JSON"),
    ("[]", "schema_version None, this program reads 1"),
    (broken(schema_version=2), "schema_version 2, this program reads 1"),
    (broken(nodes={}), "nodes {}; give a list of objects"),
    (broken(edges=None), "edges None; give a list of objects"),
    (broken(nodes=[{"kind": "plank"}]), r"nodes\[0\].*give an object with mark as a text"),
    (broken(nodes=[7]), r"nodes\[0\]"),
    (broken(nodes=NODES * 2, edges=[]), "'A', allowed: each mark once"),
    (broken(nodes=NODES), "edge A - B: end 'B', allowed: the mark of a node"),
    (broken(edges=[{"a": "A", "b": "B", "kind": "bolted", "joint": "J"}] * 3), "joint 'J', allowed: each once"),
    (broken(edges=[{"a": "A", "b": "B", "kind": "bolted", "key": 3}]), "key 3"),
]


@pytest.mark.parametrize(("text", "said"), BAD_FILES)
def test_a_text_that_is_no_graph_is_refused_with_what_is_wrong(text: str, said: str) -> None:
    with pytest.raises(PlanError, match=said):
        read_graph(text)


@pytest.mark.parametrize("text", ["", "<graphml", "<a/>", graph_json(crossed())])
def test_a_text_that_is_no_graphml_is_refused(text: str) -> None:
    with pytest.raises(PlanError, match="not valid GraphML"):
        read_graphml(text)


names = st.sampled_from(["mark", "kind", "mass_kg", "start", "a", "b", "above", "joint", "key"])
leaves = st.none() | st.booleans() | st.floats() | st.sampled_from(["A", "B", "crossing", ""])
rubbish = st.recursive(leaves, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(names, inner), max_leaves=12)


@given(rubbish, st.booleans())
def test_whatever_stands_in_a_file_the_answer_is_a_graph_or_an_error_of_ours(item: Any, whole: bool) -> None:
    data = json.loads(graph_json(crossed()))
    for name in ("nodes", "edges"):
        changed = item if whole else [*data[name], data[name][0] | item if isinstance(item, dict) else item]
        try:
            found = graph_json(read_graph(json.dumps(data | {name: changed})))
        except PlanError as error:
            found = str(error)
        assert found


def test_two_edges_of_one_joint_that_networkx_numbered_are_both_kept() -> None:
    graph = crossed()
    for kind in ("bolted", "bolted", "screwed"):
        graph.add_edge("A", "B", kind=kind, joint="J")
    assert list(whole_graph(graph).edges(keys=True)) == [
        ("A", "B", "J-1"), ("A", "B", "J"), ("A", "B", "J bolted"), ("A", "B", "J screwed"),
    ]  # fmt: skip


def test_attributes_may_have_any_name() -> None:
    data = json.loads(graph_json(crossed()))
    data["nodes"][0]["node_for_adding"] = data["edges"][0]["u_for_edge"] = 1
    graph = read_graph(json.dumps(data))
    assert equal(read_graph(graph_json(graph)), graph)
