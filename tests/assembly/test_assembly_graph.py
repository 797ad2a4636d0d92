"""The graph of parts and joints holds the whole gridshell, wherever its shells stand."""

from collections import Counter
from dataclasses import replace

import networkx as nx
import numpy as np
import pytest

from aag_cad.geometry.framed import FramedCurve, framed_curve
from aag_cad.parts.assemblies import beam_of_parts
from aag_cad.parts.mesh import frame_matrix, shell_mesh
from aag_cad.parts.model import Gridshell, Part, Strip, all_joints, all_parts, ridge_parts, shell_parts
from aag_cad.parts.quantities import mass
from aag_cad.units import Floats
from assembly.graph import assembly_graph, part_point


@pytest.fixture(scope="module")
def graph(gridshell: Gridshell) -> "nx.MultiGraph[str]":
    return assembly_graph(gridshell)


def test_every_part_is_a_node_and_nothing_else(gridshell: Gridshell, graph: "nx.MultiGraph[str]") -> None:
    assert sorted(graph.nodes) == sorted(part.mark for part in all_parts(gridshell))


def test_every_joint_of_two_parts_or_more_is_among_the_edges(gridshell: Gridshell, graph: "nx.MultiGraph[str]") -> None:
    wanted = {joint.mark: joint.kind for joint in all_joints(gridshell)}
    found = {edge[2]: graph.edges[edge]["kind"] for edge in graph.edges(keys=True)}
    assert found == wanted


def test_a_stud_is_tied_to_four_planks_and_four_bolts(gridshell: Gridshell, graph: "nx.MultiGraph[str]") -> None:
    for shell in gridshell.shells:
        for stud in shell.studs:
            kinds = Counter(graph.nodes[other]["kind"] for other in graph.neighbors(stud.mark))
            assert kinds == {"plank": 4, "bolt": 4}


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
    assert not studs & set(beam_of_parts(shell))
