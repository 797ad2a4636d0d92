"""Drawn weaves: what is laid first, what is slid in afterwards, and what nobody can put together."""

import math
from itertools import pairwise

import networkx as nx
import numpy as np
import pytest
from shipped_weaves import circle_graph, kagome_graph
from weaving import Graph, Weave, flat, graph_of, square, walls

from aag_cad.language import printed
from aag_cad.parts.model import Gridshell
from assembly.base.errors import PlanError
from assembly.graph.files import graph_text, read_graph
from assembly.graph.gridshell_graph import assembly_graph
from assembly.graph.interlacing import Interlacing, interlacing, refuse_left_out
from assembly.graph.sliding import bend_radius, free_way


def test_what_is_said_of_a_crossing_counts_more_than_the_layers() -> None:
    weave = Weave((flat("A", (0.0, 0.0), (2000.0, 0.0)), flat("B", (900.0, -900.0), (900.0, 900.0))), ())
    graph = graph_of(weave)
    graph.nodes["A"]["layer"], graph.nodes["B"]["layer"] = 0, 1
    graph.add_edge("A", "B", kind="crossing", above="A")
    found = interlacing(graph)
    assert list(found.precedence.edges) == [("B", "A")]
    # Stations that the graph does not give are those where the lines cross.
    assert (found.overlaps[0].lower_mm, found.overlaps[0].upper_mm) == pytest.approx((900.0, 900.0))


def test_one_plank_of_four_round_a_square_is_slid_in() -> None:
    found = interlacing(graph_of(square(1700.0)))
    # R = 1000^2 / (4 x 24) = 10.4 m; both ends are free, so it comes in at its start, past its lower crossing first.
    (slide,) = found.slides
    assert (slide.unit, slide.end, slide.free, slide.joints) == ("Q1", "start", math.inf, ("J3", "J0"))
    assert slide.radius == 1000.0**2 / 96.0
    assert [at.upper == "Q1" for at in slide.passed] == [False, True]
    assert not found.findings


def test_too_stiff_a_square_is_a_finding_with_its_radius() -> None:
    found = interlacing(graph_of(square(12000.0)))
    assert found.left_out == ("Q1", "Q2", "Q3", "Q4")
    (finding,) = found.findings
    assert (finding.code, finding.severity, finding.mark) == ("AAG951", "error", "Q1, Q2, Q3, Q4")
    for name in ("J0", "J1", "J2", "J3", "10417 mm", "12000 mm"):
        assert name in finding.text


def test_a_plank_needs_its_own_length_of_free_floor() -> None:
    """Each wall has 1.4 m and 1 mm of room before it, then 1 mm less than that."""
    roomy = interlacing(graph_of(square(1700.0, *walls(1401.0))))
    assert [(slide.unit, slide.free) for slide in roomy.slides] == [("Q1", 1401.0)]
    tight = interlacing(graph_of(square(1700.0, *walls(1399.0))))
    assert tight.left_out == ("Q1", "Q2", "Q3", "Q4")
    assert "1399 mm of free floor beyond either end, 1400 mm needed" in tight.findings[0].text


def test_the_end_with_more_free_floor_is_taken() -> None:
    wall = walls(3000.0)[0]
    assert interlacing(graph_of(square(1700.0, wall))).slides[0].end == "end"


def test_what_lies_later_is_in_nobodys_way() -> None:
    graph = graph_of(square(1700.0, *walls(100.0)))
    assert interlacing(graph).findings
    assert not interlacing(graph, later=[f"W{i}" for i in range(4)]).findings
    for i in range(4):
        graph.nodes[f"W{i}"]["family"] = "E"
    assert not interlacing(graph).findings


def test_an_end_that_meets_another_plank_is_not_free() -> None:
    graph = graph_of(square(1700.0, flat("W", (-201.0, -500.0), (-201.0, 500.0))))
    graph.add_edge("Q1", "W", kind="crossing", joint="M", above="", below_mm=0.0, above_mm=500.0)
    found = interlacing(graph)
    assert (found.slides[0].unit, found.slides[0].end) == ("Q1", "end")
    assert not found.precedence.has_edge("Q1", "W")
    assert not found.precedence.has_edge("W", "Q1")


@pytest.mark.parametrize(("attribute", "said"), [("upright", "upright"), ("slides", "not to be slid in")])
def test_a_plank_that_may_not_be_slid_in_stays_where_it_is(attribute: str, said: str) -> None:
    graph = graph_of(square(1700.0))
    for mark in ("Q1", "Q2", "Q4"):
        graph.nodes[mark][attribute] = attribute == "upright"
    assert [slide.unit for slide in interlacing(graph).slides] == ["Q3"]
    graph.nodes["Q3"][attribute] = attribute == "upright"
    assert f"Q1, Q2, Q3, Q4: {'marked as ' * (said != 'upright')}{said}" in interlacing(graph).findings[0].text


def test_an_upright_plank_may_be_slid_in_if_its_graph_says_so() -> None:
    graph = graph_of(square(1.0))
    for mark in graph:
        graph.nodes[mark]["upright"] = True
    assert interlacing(graph).findings
    graph.nodes["Q3"]["slides"] = True
    assert [slide.unit for slide in interlacing(graph).slides] == ["Q3"]


@pytest.mark.parametrize("unknown", ["depth_mm", "min_radius_mm"])
def test_a_bend_that_cannot_be_checked_is_not_made(unknown: str) -> None:
    graph = graph_of(square(1700.0))
    for mark in graph:
        del graph.nodes[mark][unknown]
    assert "the bend cannot be checked" in interlacing(graph).findings[0].text


def test_between_the_layers_of_a_vault_a_plank_stays_straight() -> None:
    """Under beams of the upper layer and over those of the lower one, a geodesic has its own layer, 12 mm deep."""
    graph = graph_of(square(1e9))
    for mark, layer in (("Q1", 0), ("Q2", -1), ("Q3", 0), ("Q4", 1)):
        graph.nodes[mark]["layer"] = layer
    found = interlacing(graph)
    assert [(slide.unit, slide.radius) for slide in found.slides] == [("Q1", math.inf)]


def test_two_arcs_of_the_radius_lead_over_the_height() -> None:
    """Two arcs of angle p: 2 R sin p = a and 2 R (1 - cos p) = h; for a small p that makes R = a^2 / 4h."""
    spacing, height = 500.0, 24.0
    radius = bend_radius(spacing, height)
    angle = math.asin(spacing / (2.0 * radius))
    # What the formula leaves out is (h / a)^2 = 0.23 %, and the square of that.
    assert 2.0 * radius * (1.0 - math.cos(angle)) == pytest.approx(height, rel=1.01 * (height / spacing) ** 2)
    assert bend_radius(spacing, 0.0) == math.inf


def test_a_line_along_the_way_blocks_it_where_it_begins() -> None:
    origin, direction = np.array([0.0, 0.0]), np.array([1.0, 0.0])
    ahead = np.array([[[700.0, 0.0], [900.0, 0.0]]])
    assert free_way(origin, direction, ahead) == 700.0
    assert free_way(origin, -direction, ahead) == math.inf
    assert free_way(origin, direction, ahead + np.array([0.0, 5.0])) == math.inf
    assert free_way(origin, direction, np.zeros((0, 2, 2))) == math.inf


def test_the_vault_is_laid_in_three_layers_without_slides(gridshell: Gridshell) -> None:
    graph = assembly_graph(gridshell)
    found = interlacing(graph)
    assert (found.slides, found.findings, found.left_out) == ((), (), ())
    family = {node["beam"] or mark: node["family"] for mark, node in graph.nodes(data=True) if node["kind"] == "plank"}
    assert set(found.precedence) == set(family)
    pairs = {(family[lower], family[upper]) for lower, upper in found.precedence.edges}
    assert pairs == {("A1", "A2"), ("A1", "G"), ("G", "A2"), ("A1", "E"), ("E", "A2")}
    joints = [at.joint for at in found.overlaps]
    kinds = {"AA", "AG", "boundary"}
    assert sorted(joints) == sorted(j.mark for shell in gridshell.shells for j in shell.joints if j.kind in kinds)


@pytest.fixture(scope="module")
def kagome() -> Interlacing:
    return interlacing(read_graph(graph_text("kagome")))


def test_in_the_kagome_no_plank_is_above_or_below_all_others(kagome: Interlacing) -> None:
    lower, upper = {at.lower for at in kagome.overlaps}, {at.upper for at in kagome.overlaps}
    assert len(lower) == len(upper) == 18
    over = {(at.upper[:2], at.lower[:2]) for at in kagome.overlaps}
    assert over == {("P1", "P2"), ("P2", "P3"), ("P3", "P1")}


def test_along_every_plank_of_the_kagome_over_and_under_take_turns_every_500_mm(kagome: Interlacing) -> None:
    for unit in {at.lower for at in kagome.overlaps}:
        places = sorted([(at.lower_mm, "under") for at in kagome.overlaps if at.lower == unit] +
                        [(at.upper_mm, "over") for at in kagome.overlaps if at.upper == unit])  # fmt: skip
        assert all(one != other for (_, one), (_, other) in pairwise(places))
        # The ends of the planks are given to a thousandth of a millimetre.
        np.testing.assert_allclose(np.diff([x for x, _ in places]), 500.0, atol=2e-3)


def test_one_family_of_the_kagome_is_slid_in(kagome: Interlacing) -> None:
    assert [slide.unit for slide in kagome.slides] == [f"P1-0{i}" for i in range(1, 7)]
    assert not kagome.findings
    for slide in kagome.slides:
        # a^2 / (4 x 24 mm), a = 500 mm to a hundredth of a millimetre.
        assert slide.radius == pytest.approx(500.0**2 / 96.0, rel=2e-5)
        assert slide.free == math.inf
    laid = kagome.precedence.subgraph(mark for mark in kagome.precedence if not mark.startswith("P1"))
    assert {(first[:2], then[:2]) for first, then in laid.edges} == {("P3", "P2")}


def test_a_kagome_of_narrower_mesh_cannot_be_woven_of_these_planks() -> None:
    """R = 400^2 / 96 = 1667 mm is less than 1700 mm, 405^2 / 96 = 1709 mm is more."""
    assert not interlacing(kagome_graph(mesh=405.0)).findings
    found = interlacing(kagome_graph(mesh=400.0))
    assert len(found.left_out) == 18
    assert "1667 mm, at least 1700 mm" in found.findings[0].text


def test_four_upright_planks_in_a_circle_are_left_out_and_all_else_is_laid() -> None:
    found = interlacing(read_graph(graph_text("impossible")))
    assert found.left_out == ("B-1", "B-2", "B-3", "B-4")
    assert sorted(found.precedence) == ["G-1", "G-2", "G-3", "L-1", "L-2", "L-3"]
    assert not found.slides
    (finding,) = found.findings
    circle = [at.joint for at in found.overlaps if at.lower[0] == at.upper[0] == "B"]
    assert len(circle) == 4
    for name in (*circle, *found.left_out, "upright"):
        assert name in finding.text


def test_every_circle_is_named_when_a_weave_is_refused() -> None:
    graph: Graph[str] = Graph(nx.union(circle_graph(), circle_graph(), rename=("X", "Y")))
    for _, _, edge in graph.edges(data=True):
        del edge["above"], edge["joint"]
    for tower in "XY":
        for i in range(4):
            lower, upper = f"{tower}B-{(i + 1) % 4 + 1}", f"{tower}B-{i + 1}"
            for edge in graph[lower][upper].values():
                edge["above"] = upper
    found = interlacing(graph)
    assert len(found.findings) == 2
    with pytest.raises(PlanError, match=r"(?s)XB-1, XB-2, XB-3, XB-4.*YB-1, YB-2, YB-3, YB-4"):
        refuse_left_out(found)


def test_a_finding_speaks_german_with_the_same_figures() -> None:
    (finding,) = interlacing(circle_graph()).findings
    german = printed(finding.what, "de")
    assert "hochkant" in german
    for name in ("B-4", "J-025", "1700 mm"):
        assert name in german
        assert name in finding.text
