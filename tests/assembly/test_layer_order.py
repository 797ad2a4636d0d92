"""Who lies above whom, and in which order things are laid so that nothing has to be threaded in from below."""

from dataclasses import replace

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aag_cad.design import Design
from aag_cad.geometry.framed import framed_curve
from aag_cad.parts.model import Blank, CrossSection, Frame, Joint, JointStation, Plank, Shell
from aag_cad.units import Floats, vector
from assembly.errors import PlanError
from assembly.layers import crossing_levels, layer_precedence, laying_order

Edges = list[tuple[int, int]]


def names(count: int) -> list[str]:
    return [f"S1-G-{i + 1:02d}" for i in range(count)]


def graph_of(count: int, edges: Edges) -> "nx.DiGraph[str]":
    marks = names(count)
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from(marks)
    graph.add_edges_from((marks[a], marks[b]) for a, b in edges)
    return graph


@st.composite
def acyclic(draw: st.DrawFn) -> tuple[int, Edges, list[float]]:
    count = draw(st.integers(1, 12))
    height = draw(st.permutations(range(count)))
    pair = st.tuples(st.integers(0, count - 1), st.integers(0, count - 1))
    pairs = draw(st.lists(pair, max_size=30))
    edges = [(a, b) if height[a] < height[b] else (b, a) for a, b in pairs if a != b]
    return count, edges, draw(st.lists(st.sampled_from([0.0, 1.0, 2.0]), min_size=count, max_size=count))


@given(acyclic())
def test_nothing_is_laid_before_what_it_lies_on(case: tuple[int, Edges, list[float]]) -> None:
    count, edges, along = case
    marks = names(count)
    order = laying_order(graph_of(count, edges), {mark: (x,) for mark, x in zip(marks, along, strict=True)})
    assert sorted(order) == marks
    for lower, upper in edges:
        assert order.index(marks[lower]) < order.index(marks[upper])


@given(acyclic())
def test_of_all_that_can_be_laid_the_first_along_the_sweep_is_laid(case: tuple[int, Edges, list[float]]) -> None:
    count, edges, along = case
    marks = names(count)
    order = laying_order(graph_of(count, edges), {mark: (x,) for mark, x in zip(marks, along, strict=True)})
    laid: set[int] = set()
    for mark in order:
        free = [i for i in range(count) if i not in laid and all(a in laid for a, b in edges if b == i)]
        chosen = min(free, key=lambda i: (along[i], marks[i]))
        assert mark == marks[chosen]
        laid.add(chosen)


@given(acyclic(), st.data())
def test_a_circle_is_refused_with_the_marks_that_lie_in_it(
    case: tuple[int, Edges, list[float]], data: st.DataObject
) -> None:
    count, edges, _ = case
    marks = names(count)
    ring = data.draw(st.lists(st.integers(0, count - 1), min_size=2, max_size=5, unique=True)) if count > 1 else []
    if not ring:
        return
    graph = graph_of(count, [*edges, *zip(ring, [*ring[1:], ring[0]], strict=True)])
    with pytest.raises(PlanError) as caught:
        laying_order(graph, dict.fromkeys(marks, (0.0,)))
    named = {mark for mark in marks if mark in str(caught.value)}
    on_circles = {mark for part in nx.strongly_connected_components(graph) if len(part) > 1 for mark in part}
    assert len(named) >= 2
    assert named <= on_circles


def test_the_layers_of_the_vault_lie_half_a_plank_and_half_a_thickness_apart(shell: Shell, design: Design) -> None:
    levels = crossing_levels(shell)
    layer = {plank.mark: plank.layer for plank in shell.planks}
    for joint in shell.joints:
        if joint.kind != "AA":
            continue
        for level in levels[joint.mark]:
            expected = layer.get(level.mark, 0) * design.layer_offset
            # A sibling stands 18 mm beside its beam's centre line, where the surface falls away by 18^2 / 2R < 0.1 mm.
            assert level.height == pytest.approx(expected, abs=0.2)


def test_geodesics_lie_on_lower_beams_and_under_upper_beams(shell: Shell) -> None:
    precedence = layer_precedence(shell)
    family = {plank.beam or plank.mark: plank.family for plank in shell.planks}
    found = {(family[lower], family[upper]) for lower, upper in precedence.edges}
    assert found == {("A1", "A2"), ("A1", "G"), ("G", "A2"), ("A1", "E"), ("E", "A2")}


def test_each_crossing_of_the_vault_gives_one_relation(shell: Shell) -> None:
    precedence = layer_precedence(shell)
    joints = [mark for edge in precedence.edges for mark in precedence.edges[edge]["joints"]]
    crossings = [joint.mark for joint in shell.joints if joint.kind in ("AA", "AG", "boundary")]
    assert sorted(joints) == sorted(crossings)


def _plank(mark: str, start: Floats, end: Floats, joints: list[tuple[str, Floats]]) -> Plank:
    length = float(np.linalg.norm(end - start))

    def line(t: Floats) -> tuple[Floats, Floats]:
        return start + t[:, None] / length * (end - start), np.tile([0.0, 0.0, 1.0], (len(t), 1))

    curve = framed_curve(line, 0.0, length, length)
    places = tuple(JointStation(name, float(np.linalg.norm(point - start))) for name, point in joints)
    blank = Blank(length, CrossSection(100.0, 12.0), ())
    return Plank(mark, "G", 0, False, "", curve, blank, tuple(sorted(places, key=lambda place: place.station)))


@pytest.fixture
def woven(shell: Shell) -> Shell:
    """Three planks in a triangle, each over the next one by 20 mm: nobody can be laid first."""
    corners = np.array([(0.0, 0.0), (2000.0, 0.0), (1000.0, 1700.0)])
    planks, joints = [], []
    for i in range(3):
        low, high = np.array([*corners[i], 0.0]), np.array([*corners[(i + 1) % 3], 20.0])
        reach = 0.2 * (high - low)
        at = [(f"S1-K-{i + 1:03d}", low), (f"S1-K-{(i + 1) % 3 + 1:03d}", high)]
        planks.append(_plank(f"S1-G-{i + 1:02d}", low - reach, high + reach, at))
        members = (f"S1-G-{i + 1:02d}", f"S1-G-{(i - 1) % 3 + 1:02d}")
        joints.append(Joint(f"S1-K-{i + 1:03d}", "AG", vector(low), (0.0, 0.0, 1.0), members, ()))
    frame = Frame((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    return Shell("S1", frame, tuple(planks), (), (), (), (), (), tuple(joints))


def test_planks_woven_in_a_circle_are_refused_by_mark_and_joint(woven: Shell) -> None:
    with pytest.raises(PlanError) as caught:
        layer_precedence(woven)
    for name in ("S1-G-01", "S1-G-02", "S1-G-03", "S1-K-001", "S1-K-002", "S1-K-003"):
        assert name in str(caught.value)


def test_two_planks_of_the_weave_have_an_order(woven: Shell) -> None:
    pair = replace(woven, planks=woven.planks[:2], joints=(woven.joints[1],))
    assert list(layer_precedence(pair).edges) == [("S1-G-02", "S1-G-01")]
