"""``aag plan`` with graphs of others: GraphML and JSON under any ending, directed or not; what is wrong with them."""

import subprocess
import sys
from pathlib import Path

import networkx as nx
import pytest

from assembly.booklet.plan_file import read_plan
from assembly.checks.graph_plan import check_graph_plan
from assembly.graph.files import graph_text, graphml, read_graph

AAG = [sys.executable, "-m", "aag_cad", "plan"]


def _aag(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([*AAG, *arguments], capture_output=True, text=True, cwd=cwd, timeout=300, check=False)


def _plank(x: float, y: float) -> dict[str, object]:
    points = {"start_x": -x, "start_y": -y, "start_z": 0.0, "end_x": x, "end_y": y, "end_z": 0.0}
    return {"kind": "plank", "mass_kg": 2.0, "length_mm": 2000.0} | points


def _cross() -> "nx.DiGraph[str]":
    """Return two planks as GraphML has them, one over the other by the direction of the edge alone."""
    graph: nx.DiGraph[str] = nx.DiGraph(name="Kreuz")
    graph.add_node("Schwelle unten", **_plank(1000.0, 0.0))
    graph.add_node("träger-1", **_plank(0.0, 1000.0))
    graph.add_edge("Schwelle unten", "träger-1", kind="crossing")
    return graph


@pytest.mark.parametrize("name", ["weave.graphml", "WEAVE.GRAPHML", "weave.xml"])
def test_a_weave_in_graphml_is_planned_as_the_same_in_json(name: str, tmp_path: Path) -> None:
    graph = read_graph(graph_text("kagome"))
    (tmp_path / name).write_text(graphml(graph), encoding="utf-8")
    (tmp_path / "WEAVE.JSON").write_text(graph_text("kagome"), encoding="utf-8")
    run, same = _aag(name, "-o", "out", "--json", cwd=tmp_path), _aag("WEAVE.JSON", "--json", cwd=tmp_path)
    assert run.returncode == same.returncode == 0, run.stderr + same.stderr
    assert run.stdout == same.stdout
    assert check_graph_plan(read_plan(run.stdout).plan, graph, 4) == []
    assert (tmp_path / "out" / "plan.json").read_text(encoding="utf-8") == run.stdout
    files = {path.relative_to(tmp_path / "out").as_posix() for path in (tmp_path / "out").rglob("*.*")}
    printed = {"sequence.html", "sequence.pdf", "schedule.svg"}
    assert files == {"plan.json", "tables/schedule.csv", "graph.json", "graph.graphml"} | printed


def test_a_directed_graph_of_networkx_is_explained_from_the_command_line(tmp_path: Path) -> None:
    (tmp_path / "cross.graphml").write_text("\n".join(nx.generate_graphml(_cross())), encoding="utf-8")
    run = _aag("cross.graphml", "--explain", "Schwelle unten", "-o", "never", cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    assert "Schwelle unten: plank, 2000 mm, 2.0 kg" in run.stdout
    assert "over it lies träger-1" in run.stdout
    assert not (tmp_path / "never").exists()


BROKEN = {
    "cut.graphml": ("<graphml><graph>", "not valid GraphML"),
    "json.graphml": ('{"nodes": []}', "not valid GraphML"),
    "picture.graphml": ("<svg/>", "not valid GraphML"),
    "empty.graphml": ("", "not valid GraphML"),
    "BARE.GRAPHML": (
        '<graphml xmlns="http://graphml.graphdrawing.org/xmlns"><graph edgedefault="undirected"><node id="a"/>'
        "</graph></graphml>",
        "a: kind is missing",
    ),
    "nothing.graphml": (
        '<graphml xmlns="http://graphml.graphdrawing.org/xmlns"><graph edgedefault="undirected"/></graphml>',
        "no nodes",
    ),
    "xml.json": ("<graphml/>", "not valid JSON"),
    "none.GraphML": (None, "cannot be read"),
    "weave.txt": ("<graphml/>", "not valid TOML"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_file_that_is_no_graph_is_one_message_with_exit_code_2(name: str, tmp_path: Path) -> None:
    text, said = BROKEN[name]
    if text is not None:
        (tmp_path / name).write_text(text, encoding="utf-8")
    run = _aag(name, "-o", "never", cwd=tmp_path)
    assert run.returncode == 2, run.stdout
    assert "Traceback" not in run.stderr
    assert said in run.stderr
    assert not (tmp_path / "never").exists()
