"""The graph of parts and joints holds the whole gridshell, wherever its shells stand."""

from collections import Counter, defaultdict
from dataclasses import replace

import networkx as nx
import numpy as np
import pytest

from aag_cad.geometry.framed import FramedCurve, framed_curve
from aag_cad.parts.index import index_of
from aag_cad.parts.mesh import frame_matrix, shell_mesh
from aag_cad.parts.model import Gridshell, Part, Strip, all_joints, all_parts, ridge_parts, shell_parts
from aag_cad.parts.quantities import mass
from aag_cad.units import Floats
from assembly.graph.gridshell_graph import assembly_graph, part_point


@pytest.fixture(scope="module")
def graph(gridshell: Gridshell) -> "nx.MultiGraph[str]":
    return assembly_graph(gridshell)


def test_every_part_is_a_node_and_nothing_else(gridshell: Gridshell, graph: "nx.MultiGraph[str]") -> None:
    assert sorted(graph.nodes) == sorted(part.mark for part in all_parts(gridshell))


def test_every_joint_of_two_parts_or_more_is_among_the_edges(gridshell: Gridshell, graph: "nx.MultiGraph[str]") -> None:
    wanted = {joint.mark: joint.kind for joint in all_joints(gridshell)}
    found = {edge[2]: graph.edges[edge]["joint_kind"] for edge in graph.edges(keys=True)}
    assert found == wanted


def test_a_stud_is_tied_to_four_planks_and_four_bolts(gridshell: Gridshell, graph: "nx.MultiGraph[str]") -> None:
    for shell in gridshell.shells:
        for stud in shell.studs:
            kinds = Counter(graph.nodes[other]["kind"] for other in graph.neighbors(stud.mark))
            assert kinds == {"plank": 4, "bolt": 4}


def test_edges_are_keyed_by_their_joint_and_say_how_its_parts_are_tied(graph: "nx.MultiGraph[str]") -> None:
    found: dict[str, set[str]] = defaultdict(set)
    for _, _, key, edge in graph.edges(keys=True, data=True):
        assert key == edge["joint"]
        found[edge["joint_kind"]].add(edge["kind"])
    assert found == {
        "AA": {"crossing", "bolted"},
        "AG": {"crossing", "coupled", "screwed", "bolted"},
        "boundary": {"crossing", "coupled", "screwed", "bolted"},
        "foot": {"crossing", "bolted"},
        "footing": {"seated"},
        "ridge": {"crossing", "bolted"},
        "blade": {"bladed", "bolted"},
        "cover": {"screwed"},
    }


def test_at_a_block_two_planks_are_coupled_and_a_third_is_screwed_on(
    gridshell: Gridshell, graph: "nx.MultiGraph[str]"
) -> None:
    joint = next(joint for joint in gridshell.shells[0].joints if joint.kind == "AG")
    tied = {other: graph.edges[joint.mark, other, joint.mark]["kind"] for other in graph.neighbors(joint.mark)}
    planks = [mark for mark in joint.members if mark != joint.mark]
    expected = {mark: "coupled" if mark[-1] in "LR" else "screwed" for mark in planks}
    expected |= {mark: "bolted" if "-B" in mark else "screwed" for mark in joint.fasteners}
    assert {mark: tied[mark] for mark in expected} == expected


def test_planks_lie_over_planks_of_a_lower_layer_where_their_curves_pass(
    gridshell: Gridshell, graph: "nx.MultiGraph[str]"
) -> None:
    points = {joint.mark: np.array(joint.point) for shell in gridshell.shells for joint in shell.joints}
    planks = index_of(gridshell).planks
    count = 0
    for a, b, edge in graph.edges(data=True):
        if edge["kind"] != "crossing" or not edge["above"]:
            continue
        upper, lower = (a, b) if edge["above"] == a else (b, a)
        assert graph.nodes[lower]["layer"] < graph.nodes[upper]["layer"]
        for mark, station in ((lower, edge["below_mm"]), (upper, edge["above_mm"])):
            # 56 mm below or above the joint's point and, beside the gap of a beam, 18 mm aside at 30 degrees or more.
            gap = planks[mark].curve.point_spline(station) - points[edge["joint"]]
            assert float(np.linalg.norm(gap)) < 70.0
        count += 1
    # Four pairs of planks at a stud, two at a block.
    kinds = Counter(joint.kind for shell in gridshell.shells for joint in shell.joints)
    assert count == 4 * kinds["AA"] + 2 * (kinds["AG"] + kinds["boundary"])


def test_planks_that_meet_end_to_end_lie_on_neither(graph: "nx.MultiGraph[str]") -> None:
    met = [edge["joint_kind"] for _, _, edge in graph.edges(data=True) if edge.get("above") == ""]
    assert set(met) == {"foot", "ridge"}


def test_only_planks_are_laid_and_they_say_how_they_lie(gridshell: Gridshell, graph: "nx.MultiGraph[str]") -> None:
    radius = gridshell.timber.min_bending_radius
    for shell in gridshell.shells:
        matrix = frame_matrix(shell.placement)
        for plank in shell.planks:
            node, section = graph.nodes[plank.mark], plank.blank.section
            assert node["upright"] == (plank.family in ("A1", "A2"))
            assert node["depth_mm"] == (section.width if node["upright"] else section.thickness)
            assert node["min_radius_mm"] == radius
            for name, point in (("start", plank.curve.points[0]), ("end", plank.curve.points[-1])):
                # One rotation and shift of points at 10 m: rounding only.
                np.testing.assert_allclose(node[name], (matrix @ [*point, 1.0])[:3], atol=1e-6)
    laid = {mark for mark in graph if "start" in graph.nodes[mark]}
    assert laid == {plank.mark for shell in gridshell.shells for plank in shell.planks}


def test_a_blade_ties_two_ridge_planks_and_a_foot_hangs_on_its_shoe(
    gridshell: Gridshell, graph: "nx.MultiGraph[str]"
) -> None:
    for blade in gridshell.blades:
        kinds = Counter(graph.nodes[other]["kind"] for other in graph.neighbors(blade.mark))
        assert kinds == {"plank": 2, "bolt": 4}
    for shell in gridshell.shells:
        for shoe in shell.shoes:
            kinds = Counter(graph.nodes[other]["kind"] for other in graph.neighbors(shoe.mark))
            assert kinds == {"plank": 2, "bolt": 4, "concrete block": 1}
        for footing in shell.footings:
            kinds = Counter(graph.nodes[other]["kind"] for other in graph.neighbors(footing.mark))
            assert kinds == {"shoe": 1, "threaded rod": 1}
        for strap in shell.straps:
            kinds = Counter(graph.nodes[other]["kind"] for other in graph.neighbors(strap.mark))
            assert kinds["plank"] == 2
            assert kinds["bolt"] == len(strap.blank.holes)


def test_the_middle_of_bars_and_strips_lies_within_them(gridshell: Gridshell) -> None:
    """That of a bar on its centre line, that of a strip midway between its edges: inside the box of its mesh."""
    shell = gridshell.shells[0]
    parts: tuple[Part, ...] = (*shell.straps, *shell.mullions, *shell.clamps, *shell.strips)
    for part in parts:
        vertices, point = shell_mesh(part).vertices, part_point(part)
        assert np.all(point > vertices.min(axis=0))
        assert np.all(point < vertices.max(axis=0))


def test_a_strip_reaches_as_far_left_as_right_of_its_middle() -> None:
    """A flat sheet of 800 mm from x = 0, 2 m long: its middle is (400, 1000)."""

    def edge(x: float) -> FramedCurve:
        def evaluate(t: Floats) -> tuple[Floats, Floats]:
            zero = np.zeros_like(t)
            return np.column_stack([zero + x, t, zero]), np.column_stack([zero, zero, zero + 1.0])

        return framed_curve(evaluate, 0.0, 2000.0, 2000.0)

    strip = Strip("S1-P-01", edge(0.0), edge(800.0), 10.0, (0.0, 0.0), (1.0, 1.0))
    np.testing.assert_allclose(part_point(strip), [400.0, 1000.0, 0.0], atol=1e-9)


def test_a_coupling_block_belongs_to_the_beam_whose_planks_it_parts(
    gridshell: Gridshell, graph: "nx.MultiGraph[str]"
) -> None:
    for shell in gridshell.shells:
        for block in (block for block in shell.blocks if "-K-" in block.mark):
            node = graph.nodes[block.mark]
            assert node["beam"]
            planks = [other for other in graph.neighbors(block.mark) if graph.nodes[other]["beam"] == node["beam"]]
            assert sorted(mark for mark in planks if mark[-1] in "LR") == [f"{node['beam']}-L", f"{node['beam']}-R"]
            assert node["layer"] == graph.nodes[planks[0]]["layer"]


def test_the_masses_add_up_to_those_of_the_part_lists(gridshell: Gridshell, graph: "nx.MultiGraph[str]") -> None:
    total = sum(mass(part, gridshell.timber) for part in all_parts(gridshell))
    # The same numbers in another order: only the rounding of some 4 000 additions may differ.
    assert sum(graph.nodes[mark]["mass_kg"] for mark in graph) == pytest.approx(total, rel=1e-12)


def test_positions_are_those_of_the_first_shell_turned_into_place(
    gridshell: Gridshell, graph: "nx.MultiGraph[str]"
) -> None:
    first = {part.mark: graph.nodes[part.mark]["position"] for part in shell_parts(gridshell.shells[0])}
    for shell in gridshell.shells[1:]:
        turn = frame_matrix(shell.placement)[:3, :3]
        for mark, position in first.items():
            theirs = graph.nodes[shell.mark + mark[2:]]["position"]
            # Both come from the same curve by one rotation: nothing but rounding at 10 m.
            np.testing.assert_allclose(theirs, turn @ np.array(position), atol=1e-6)


def test_each_shell_hangs_together(gridshell: Gridshell, graph: "nx.MultiGraph[str]") -> None:
    for shell in gridshell.shells:
        assert nx.is_connected(graph.subgraph(part.mark for part in shell_parts(shell)))


def test_the_ridges_make_one_of_the_shells(gridshell: Gridshell, graph: "nx.MultiGraph[str]") -> None:
    assert nx.is_connected(graph)
    without = graph.subgraph(set(graph) - {part.mark for part in ridge_parts(gridshell)})
    assert nx.number_connected_components(nx.Graph(without.edges(keys=False))) == len(gridshell.shells)


@pytest.mark.parametrize("count", [1, 2])
def test_any_number_of_shells_will_do(gridshell: Gridshell, count: int) -> None:
    fewer = replace(gridshell, shells=gridshell.shells[:count], blades=(), bolts=(), joints=())
    assert len(assembly_graph(fewer)) == len(all_parts(fewer))


def test_a_stud_belongs_to_no_single_beam(gridshell: Gridshell) -> None:
    shell = gridshell.shells[0]
    studs = {stud.mark for stud in shell.studs}
    assert not studs & set(index_of(shell).beam_of)
