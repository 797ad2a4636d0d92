"""The plan of any graph of parts: each part once, nothing under what lies unless it is slid in, and no spare hands."""

import math
import os
import subprocess
import sys
from dataclasses import replace
from itertools import pairwise, product

import networkx as nx
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from aag_cad.design_making import Minutes
from aag_cad.language import printed
from aag_cad.parts.model import Gridshell
from aag_cad.planning import planned_source, read_source
from assembly.base.errors import PlanError
from assembly.base.lifters import Lifters, lifting_findings
from assembly.base.steps import Plan
from assembly.booklet.plan_file import plan_json
from assembly.booklet.step_words import step_words
from assembly.checks.graph_plan import check_graph_plan
from assembly.graph.files import graph_text, read_graph
from assembly.graph.gridshell_graph import assembly_graph
from assembly.graph.interlacing import interlacing
from assembly.plan.durations import step_minutes
from assembly.plan.graph_plan import JOINTS_A_STEP, graph_plan
from assembly.plan.schedule import people_curve, schedule_of
from assembly.plan.work import LAID_A_STEP

MINUTES = Minutes.model_validate({})


def add_line(
    graph: "nx.MultiGraph[str]", mark: str, a: tuple[float, float], b: tuple[float, float], stiff: bool
) -> None:
    long = abs(b[0] - a[0]) + abs(b[1] - a[1])
    graph.add_node(
        mark, kind="plank", family=mark[0], mass_kg=long / 400.0, length_mm=long, start=(*a, 0.0), end=(*b, 0.0),
        upright=stiff, depth_mm=12.0, min_radius_mm=500.0,
    )  # fmt: skip


def add_joint(graph: "nx.MultiGraph[str]", joint: str, kind: str, a: str, b: str) -> None:
    """Fasten two planks: by a bolt, or by a stud with two bolts, which holds both."""
    hub = joint if kind == "stud" else a
    if kind == "stud":
        graph.add_node(joint, kind="stud", mass_kg=0.2, length_mm=220.0)
        for mark in (a, b):
            graph.add_edge(joint, mark, key=joint, kind="bolted", joint=joint, joint_kind="AA")
    for i in range(1 if kind == "bolt" else 2):
        bolt = f"{joint}-B{i + 1}"
        graph.add_node(bolt, kind="bolt", mass_kg=0.05, length_mm=80.0)
        graph.add_edge(hub, bolt, key=joint, kind="bolted", joint=joint, joint_kind="AA")
        if kind == "bolt":
            graph.add_edge(b, bolt, key=joint, kind="bolted", joint=joint, joint_kind="AA")


@st.composite
def weaves(draw: st.DrawFn) -> "nx.MultiGraph[str]":
    """Return warp and weft of random reach, one over the other at random, stiff or not, fastened here and there."""
    graph: nx.MultiGraph[str] = nx.MultiGraph(name="weave")
    across, up = draw(st.integers(1, 9)), draw(st.integers(1, 5))
    upright = st.sampled_from(draw(st.sampled_from([[False], [True, False, False], [True]])))
    for i in range(up):
        add_line(graph, f"X-{i + 1:02d}", (-400.0, 500.0 * i), (500.0 * across - 100.0, 500.0 * i), draw(upright))
    for j in range(across):
        low = draw(st.integers(0, up - 1))
        ends = (500.0 * j, 500.0 * low - 400.0), (500.0 * j, 500.0 * up - 100.0)
        add_line(graph, f"Y-{j + 1:02d}", *ends, draw(upright))
        for i in range(low, up):
            joint, pair = f"J-{i + 1:02d}{j + 1:02d}", (f"X-{i + 1:02d}", f"Y-{j + 1:02d}")
            above = pair[draw(st.integers(0, 1))]
            graph.add_edge(*pair, key=joint, kind="crossing", joint=joint, joint_kind="AA", above=above)
            kind = draw(st.sampled_from(["", "bolt", "stud"]))
            if kind:
                add_joint(graph, joint, kind, *pair)
    return graph


@settings(max_examples=100, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(weaves(), st.integers(1, 5), st.sampled_from([2.0, 8.0, 25.0]))
def test_every_weave_is_planned_so_that_each_part_reaches_its_place(
    graph: "nx.MultiGraph[str]", people: int, lift_limit: float
) -> None:
    plan = graph_plan(graph, people, lift_limit)
    assert check_graph_plan(plan, graph, people) == []
    placed = [mark for step in plan.steps for mark in step.marks]
    told = {mark for f in plan.findings if f.severity == "error" for mark in f.mark.split(", ")}
    assert len(placed) == len(set(placed))
    assert set(placed) | told == set(graph)
    assert not set(placed) & told
    minutes = step_minutes(plan, graph, MINUTES)
    schedule = schedule_of(plan, minutes, people)
    assert all(count <= people for _, count in people_curve(schedule))
    assert graph_plan(graph, people, lift_limit) == plan


@settings(max_examples=40, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(weaves(), st.data())
def test_the_check_finds_every_way_to_spoil_a_plan(graph: "nx.MultiGraph[str]", data: st.DataObject) -> None:
    plan = graph_plan(graph, 3, 25.0)
    if not plan.steps:
        return
    step = data.draw(st.sampled_from(plan.steps))
    others = [other for other in plan.steps if other.id != step.id]
    gone = replace(plan, steps=tuple(replace(s, number=i) for i, s in enumerate(others, start=1)))
    assert check_graph_plan(gone, graph)
    twice = replace(step, id="again", number=len(plan.steps) + 1)
    assert check_graph_plan(replace(plan, steps=(*plan.steps, twice)), graph)
    if step.predecessors:
        freed = tuple(replace(s, predecessors=()) if s.id == step.id else s for s in plan.steps)
        assert check_graph_plan(replace(plan, steps=freed), graph)
    if step.phase == "slide":
        laid = tuple(replace(s, phase="lay") if s.id == step.id else s for s in plan.steps)
        under = any(
            edge["above"] != mark
            for mark in step.marks
            for _, _, edge in graph.edges(mark, data=True)
            if edge["kind"] == "crossing"
        )
        assert bool(check_graph_plan(replace(plan, steps=laid), graph)) == under
    crowd = tuple(replace(s, crew=4) if s.id == step.id else s for s in plan.steps)
    assert check_graph_plan(replace(plan, steps=crowd), graph, 3)


def grid(across: int, up: int) -> "nx.MultiGraph[str]":
    """Return planks along x on the floor and planks along y on them, a bolt at every crossing."""
    graph: nx.MultiGraph[str] = nx.MultiGraph(name="grid")
    for i in range(up):
        add_line(graph, f"X-{i + 1:02d}", (-400.0, 500.0 * i), (500.0 * across - 100.0, 500.0 * i), True)
    for j in range(across):
        add_line(graph, f"Y-{j + 1:02d}", (500.0 * j, -400.0), (500.0 * j, 500.0 * up - 100.0), True)
    for i, j in product(range(up), range(across)):
        joint, pair = f"J-{i + 1:02d}{j + 1:02d}", (f"X-{i + 1:02d}", f"Y-{j + 1:02d}")
        graph.add_edge(*pair, key=joint, kind="crossing", joint=joint, joint_kind="AA", above=pair[1])
        add_joint(graph, joint, "bolt", *pair)
    return graph


def test_a_grid_is_laid_in_two_runs_and_bolted_along_a_path() -> None:
    graph = grid(9, 6)
    plan = graph_plan(graph, 4, 25.0)
    assert [step.phase for step in plan.steps] == ["lay"] * 3 + ["join"] * 3
    assert [len(step.marks) for step in plan.steps] == [6, 4, 5, 18, 18, 18]
    assert [step.predecessors for step in plan.steps[:3]] == [(), ("lay.1",), ("lay.1",)]
    assert all(step.held and step_words(step, "en").hold for step in (plan.steps[2], plan.steps[5]))
    walked = [mark.removesuffix("-B1") for step in plan.steps[3:] for mark in step.marks]
    places = [(int(mark[2:4]), int(mark[4:6])) for mark in walked]
    assert all(abs(a[0] - b[0]) + abs(a[1] - b[1]) == 1 for a, b in pairwise(places))


def test_steps_are_no_larger_than_a_card_can_tell() -> None:
    plan = graph_plan(grid(20, 12), 4, 25.0)
    assert max(len(step.marks) for step in plan.steps if step.phase == "lay") == LAID_A_STEP
    assert max(len(step.marks) for step in plan.steps if step.phase == "join") == JOINTS_A_STEP


def test_the_true_kagome_weave_is_laid_and_slid_in() -> None:
    graph = read_graph(graph_text("kagome"))
    plan = graph_plan(graph, 4, 25.0)
    assert check_graph_plan(plan, graph, 4) == []
    slides = [step for step in plan.steps if step.phase == "slide"]
    for step, slide in zip(slides, interlacing(graph).slides, strict=True):
        assert step.marks == (slide.unit,)
        instructions = step_words(step, "en").instructions
        told = " ".join(instructions)
        assert all(joint in told for joint in slide.joints)
        assert slide.end in instructions[0]


def test_what_the_impossible_weave_leaves_out_is_named_and_in_no_step() -> None:
    graph = read_graph(graph_text("impossible"))
    plan = graph_plan(graph, 4, 25.0)
    assert check_graph_plan(plan, graph, 4) == []
    out = {mark for finding in plan.findings for mark in finding.mark.split(", ")}
    assert out
    assert {mark for step in plan.steps for mark in step.marks} == set(graph) - out


def test_a_bolt_of_a_plank_that_cannot_be_laid_waits_with_it() -> None:
    graph = read_graph(graph_text("impossible"))
    stuck = interlacing(graph).left_out[0]
    free = next(mark for mark in sorted(graph) if mark not in interlacing(graph).left_out)
    add_joint(graph, "J-999", "bolt", stuck, free)
    plan = graph_plan(graph, 4, 25.0)
    assert [finding.mark for finding in plan.findings if finding.code == "AAG956"] == ["J-999-B1"]
    assert check_graph_plan(plan, graph, 4) == []


def test_a_part_that_nothing_holds_is_refused_by_its_mark() -> None:
    graph = grid(2, 2)
    graph.add_node("lost", kind="bolt", mass_kg=0.1, length_mm=50.0)
    with pytest.raises(PlanError, match="lost"):
        graph_plan(graph, 2, 25.0)


@pytest.fixture(scope="module")
def vault_plan(gridshell: Gridshell) -> Plan:
    return graph_plan(assembly_graph(gridshell), 4, 25.0)


def test_the_vault_as_a_plain_graph_can_be_put_together(gridshell: Gridshell, vault_plan: Plan) -> None:
    graph = assembly_graph(gridshell)
    assert check_graph_plan(vault_plan, graph, 4) == []
    assert sum(len(step.marks) for step in vault_plan.steps) == len(graph)
    beams = [beam for step in vault_plan.steps for beam in step.assemblies]
    assert sorted(beams) == sorted(beam.mark for shell in gridshell.shells for beam in shell.beams)
    minutes = step_minutes(vault_plan, graph, MINUTES)
    assert all(minutes[step.id] >= 1 for step in vault_plan.steps)
    schedule = schedule_of(vault_plan, minutes, 4)
    assert max(count for _, count in people_curve(schedule)) == 4
    assert schedule.ratio < 1.1


def test_the_plan_prints_in_german_line_for_line(vault_plan: Plan) -> None:
    for step in vault_plan.steps:
        english, german = step_words(step, "en"), step_words(step, "de")
        assert english.title != german.title
        assert len(english.tools) == len(german.tools)
        assert len(english.instructions) == len(german.instructions)
        assert bool(english.hold) == bool(german.hold) == step.held


def test_a_lay_step_lasts_as_long_as_what_is_done_in_it() -> None:
    """Two people, 10 min each to get ready; 6 planks of 4.8 m at 0.5 min/m and 5 min each, shared."""
    graph = grid(9, 6)
    plan = graph_plan(graph, 2, 25.0)
    first = plan.steps[0]
    assert first.crew == 2
    assert step_minutes(plan, graph, MINUTES)[first.id] == round(10 + (6 * 4.8 * 0.5 + 6 * 5) / 2 + 0.49)


def test_to_slide_a_plank_in_takes_as_long_in_any_weave_as_in_a_gridshell() -> None:
    """Two people, 10 min each to get ready; 0.5 min/m to its place, 5 min for a flat plank, 15 min to push it in."""
    graph = read_graph(graph_text("kagome"))
    plan = graph_plan(graph, 4, 25.0)
    step = next(step for step in plan.steps if step.marks == ("P1-03",))
    assert (step.phase, step.crew) == ("slide", 2)
    assert step_minutes(plan, graph, MINUTES)[step.id] == math.ceil(10 + (4.684752 * 0.5 + 5 + 15) / 2)


def test_the_plan_does_not_depend_on_the_hash_of_marks() -> None:
    code = (
        "from aag_cad.planning import planned_source, read_source; from assembly.booklet.plan_file import plan_json; "
        "print(plan_json(planned_source(read_source('kagome')).file))"
    )
    here = plan_json(planned_source(read_source("kagome")).file)
    environment = os.environ | {"PYTHONHASHSEED": "4711"}
    there = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert there.stdout.strip() == here.strip()


def test_what_a_crew_cannot_lift_is_told_once_for_each_mass() -> None:
    weights = {
        "S1-C-01": (109.4, 300.0),
        "S1-C-02": (109.4, 300.0),
        "S1-A1-01": (30.0, 5000.0),
        "S1-G-01": (9.0, 4000.0),
    }
    heavy, shared = lifting_findings(weights, Lifters(4, 25.0))
    assert (heavy.code, heavy.severity, heavy.mark) == ("AAG955", "warning", "C-01, C-02")
    assert (heavy.found, heavy.allowed) == (109.4, 100.0)
    assert "5 people" in heavy.text
    assert (shared.code, shared.severity, shared.mark, shared.found, shared.allowed) == (
        "AAG955", "note", "S1-A1-01", 30.0, 25.0,
    )  # fmt: skip
    assert lifting_findings(weights, Lifters(1, 200.0)) == ()
    assert "Person" in printed(lifting_findings(weights, Lifters(1, 25.0))[0].what, "de")
