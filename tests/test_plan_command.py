"""``aag plan`` as a user meets it: a design, a gridshell that a build wrote, any graph of parts; and its errors."""

import csv
import json
import subprocess
import sys
from pathlib import Path

import networkx as nx
import pytest
from builds import aag, small_vault

from aag_cad.design import parse_design
from aag_cad.files import write_text
from aag_cad.parts.store import gridshell_json
from aag_cad.pipeline import gridshell_of
from assembly.booklet.plan_file import read_plan
from assembly.checks.graph_plan import check_graph_plan
from assembly.checks.plan import check_plan
from assembly.graph.files import graph_text, read_graph, read_graphml

AAG = [sys.executable, "-m", "aag_cad", "plan"]


def _aag(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([*AAG, *arguments], capture_output=True, text=True, cwd=cwd, timeout=300, check=False)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the design of a small vault and its gridshell.json."""
    text = small_vault()
    folder = tmp_path_factory.mktemp("plans")
    write_text(folder / "small.toml", text)
    write_text(folder / "gridshell.json", gridshell_json(gridshell_of(parse_design(text))))
    return folder


def test_a_design_becomes_a_folder_of_plans(folder: Path) -> None:
    run = _aag("small.toml", "-o", "up", "--crew", "3", "--transport", "12000x2000x2000x900x600", cwd=folder)
    assert run.returncode == 0, run.stderr
    files = {path.relative_to(folder / "up").as_posix() for path in (folder / "up").rglob("*") if path.is_file()}
    assert files == {
        "plan.json", "disassembly.json", "schedule.svg", "schedule.ics", "locking.svg", "graph.json", "graph.graphml",
        "sequence.pdf", "sequence.html", "disassembly.pdf", "disassembly.html", "tables/schedule.csv",
        "tables/locking.csv", "tables/segments.csv", "tables/splices.csv", "tables/laying.csv",
    }  # fmt: skip
    gridshell = gridshell_of(parse_design((folder / "small.toml").read_text(encoding="utf-8")))
    plan = read_plan((folder / "up" / "plan.json").read_text(encoding="utf-8")).plan
    assert max(step.crew for step in plan.steps) <= 3
    assert any(step.phase == "splice" for step in plan.steps)
    assert "AAG961" in run.stdout
    graph = read_graph((folder / "up" / "graph.json").read_text(encoding="utf-8"))
    assert nx.utils.graphs_equal(graph, read_graphml((folder / "up" / "graph.graphml").read_text(encoding="utf-8")))
    assert {mark for step in plan.steps for mark in step.marks} == set(graph)
    assert gridshell.name == plan.name == "vault"


def test_a_gridshell_file_gives_the_plan_of_its_design(folder: Path) -> None:
    run = _aag("gridshell.json", "-o", "from-file", "--json", "--lang", "de", cwd=folder)
    assert run.returncode == 0, run.stderr
    plan = read_plan(run.stdout).plan
    assert '<html lang="de">' in (folder / "from-file" / "sequence.html").read_text(encoding="utf-8")
    gridshell = gridshell_of(parse_design((folder / "small.toml").read_text(encoding="utf-8")))
    assert check_plan(plan, gridshell) == []
    assert (folder / "from-file" / "plan.json").read_text(encoding="utf-8") == run.stdout


def test_a_true_weave_is_planned_with_slides_and_groups_for_the_lorry(folder: Path) -> None:
    run = _aag("kagome", "-o", "woven", "--transport", "4000x4000x4000x30", cwd=folder)
    assert run.returncode == 0, run.stderr
    plan = read_plan((folder / "woven" / "plan.json").read_text(encoding="utf-8")).plan
    graph = read_graph(graph_text("kagome"))
    assert check_graph_plan(plan, graph, 4) == []
    assert sum(step.phase == "slide" for step in plan.steps) == 6
    with (folder / "woven" / "tables" / "segments.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert sorted(mark for row in rows for mark in row["marks"].split()) == sorted(graph)
    assert all(float(row["mass_kg"]) <= 30.0 for row in rows)


def test_an_impossible_weave_ends_with_its_marks_and_exit_code_1(folder: Path) -> None:
    run = _aag("impossible", "-o", "impossible", cwd=folder)
    assert run.returncode == 1
    assert "1 error in the plan of impossible" in run.stderr
    file = read_plan((folder / "impossible" / "plan.json").read_text(encoding="utf-8"))
    (finding,) = (finding for finding in file.findings if finding.severity == "error")
    assert finding.code == "AAG951"
    assert all(mark in finding.mark for mark in ("B-1", "B-2", "B-3", "B-4"))
    assert not any(mark.startswith("B-") for step in file.plan.steps for mark in step.marks)


def test_explain_says_why_and_writes_nothing(folder: Path) -> None:
    run = _aag("gridshell.json", "--explain", "S1-G-03", "-o", "nothing", cwd=folder)
    assert run.returncode == 0, run.stderr
    assert "It cannot come earlier:" in run.stdout
    assert "under it lies A1-" in run.stdout
    assert not (folder / "nothing").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("vault", "--lang", "fr"), ("--lang", "fr", "en, de")),
        (("kagome", "--crew", "0"), ("--crew", "0", "1 to 40")),
        (("vault", "--transport", "12000x2400"), ("--transport", "12000x2400")),
        (("vault", "--transport", "12000xwidexhigh"), ("--transport", "wide")),
        (("vault", "--transport", "12000x-2400x2400"), ("--transport", "-2400")),
        (("gridshell.json", "--explain", "S9-G-01"), ("--explain S9-G-01", "S1-G-01")),
        (("no-such.json",), ("no-such.json", "cannot be read")),
        (("no-such-design",), ("no-such-design",)),
        (("broken.json",), ("broken.json", "not valid JSON")),
        (("other.json",), ("other.json", "neither a gridshell", "nor a graph")),
        (("bad-graph.json",), ("A-1", "mass_kg")),
    ],
)
def test_what_a_user_can_mend_is_one_message_with_exit_code_2(
    folder: Path, arguments: tuple[str, ...], words: tuple[str, ...]
) -> None:
    (folder / "broken.json").write_text("{", encoding="utf-8")
    (folder / "other.json").write_text('{"name": "something"}', encoding="utf-8")
    data = json.loads(graph_text("kagome"))
    data["nodes"][0] |= {"mark": "A-1", "id": "A-1", "mass_kg": -1.0}
    (folder / "bad-graph.json").write_text(json.dumps(data), encoding="utf-8")
    run = aag("plan", *arguments, "-o", "never", cwd=folder)
    assert run.exit_code == 2, run.stdout
    assert all(word in run.stderr for word in words), run.stderr
    assert not (folder / "never").exists()
