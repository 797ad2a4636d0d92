"""The graph of parts and joints holds the whole gridshell, wherever its shells stand."""

from collections import Counter
from dataclasses import replace

import networkx as nx
import numpy as np
import pytest

from aag_cad.parts.assemblies import beam_of_parts
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Gridshell, all_parts, shell_parts
from aag_cad.parts.quantities import mass
from assembly.graph import assembly_graph


@pytest.fixture(scope="module")
def graph(gridshell: Gridshell) -> "nx.MultiGraph[str]":
    return assembly_graph(gridshell)


def test_every_part_is_a_node_and_nothing_else(gridshell: Gridshell, graph: "nx.MultiGraph[str]") -> None:
    assert sorted(graph.nodes) == sorted(part.mark for part in all_parts(gridshell))


def test_every_joint_of_two_parts_or_more_is_among_the_edges(gridshell: Gridshell, graph: "nx.MultiGraph[str]") -> None:
    wanted = {joint.mark: joint.kind for shell in gridshell.shells for joint in shell.joints}
    found = {edge[2]: graph.edges[edge]["kind"] for edge in graph.edges(keys=True)}
    assert found == wanted


def test_a_stud_is_tied_to_four_planks_and_four_bolts(gridshell: Gridshell, graph: "nx.MultiGraph[str]") -> None:
    for shell in gridshell.shells:
        for stud in shell.studs:
            kinds = Counter(graph.nodes[other]["kind"] for other in graph.neighbors(stud.mark))
            assert kinds == {"plank": 4, "bolt": 4}


def test_a_coupling_block_belongs_to_the_beam_whose_planks_it_parts(
    gridshell: Gridshell, graph: "nx.MultiGraph[str]"
) -> None:
    for shell in gridshell.shells:
        for block in shell.blocks:
            node = graph.nodes[block.mark]
            planks = [other for other in graph.neighbors(block.mark) if graph.nodes[other]["beam"] == node["beam"]]
            assert sorted(mark for mark in planks if mark[-1] in "LR") == [f"{node['beam']}-L", f"{node['beam']}-R"]
            assert node["layer"] == graph.nodes[planks[0]]["layer"]


def test_the_masses_add_up_to_those_of_the_part_lists(gridshell: Gridshell, graph: "nx.MultiGraph[str]") -> None:
    total = sum(mass(part, gridshell.timber) for part in all_parts(gridshell))
    # The same numbers in another order: only the rounding of 3 000 additions may differ.
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


@pytest.mark.parametrize("count", [1, 2])
def test_any_number_of_shells_will_do(gridshell: Gridshell, count: int) -> None:
    fewer = replace(gridshell, shells=gridshell.shells[:count])
    assert len(assembly_graph(fewer)) == len(all_parts(fewer))


def test_a_stud_belongs_to_no_single_beam(gridshell: Gridshell) -> None:
    shell = gridshell.shells[0]
    studs = {stud.mark for stud in shell.studs}
    assert not studs & set(beam_of_parts(shell))
