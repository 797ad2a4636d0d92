"""Who lies above whom in a shell: the heights of its members at each joint and the order that follows from them."""

import math
from dataclasses import replace

import networkx as nx
import numpy as np
import pytest

from aag_cad.design import Design
from aag_cad.geometry.framed import framed_curve
from aag_cad.parts.forms import Blank, CrossSection, Frame
from aag_cad.parts.model import Gridshell, Joint, JointStation, Plank, Shell
from aag_cad.units import Floats, vector
from assembly.base.errors import PlanError
from assembly.graph.gridshell_graph import assembly_graph
from assembly.graph.interlacing import interlacing
from assembly.graph.layers import crossing_levels
from assembly.laying.order import flat_orders


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


def of(gridshell: Gridshell, shell: Shell) -> Gridshell:
    """Return a gridshell of one shell alone."""
    return replace(gridshell, shells=(shell,), blades=(), bolts=(), joints=())


@pytest.fixture(scope="module")
def precedence(gridshell: Gridshell) -> "nx.DiGraph[str]":
    return interlacing(assembly_graph(of(gridshell, gridshell.shells[0]))).precedence


def test_geodesics_lie_on_lower_beams_and_under_upper_beams(shell: Shell, precedence: "nx.DiGraph[str]") -> None:
    family = {plank.beam or plank.mark: plank.family for plank in shell.planks}
    found = {(family[lower], family[upper]) for lower, upper in precedence.edges}
    assert found == {("A1", "A2"), ("A1", "G"), ("G", "A2"), ("A1", "E"), ("E", "A2")}


def test_each_crossing_of_the_vault_gives_one_relation(shell: Shell, precedence: "nx.DiGraph[str]") -> None:
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


def _weave(first: int, shift: float) -> tuple[list[Plank], list[Joint]]:
    """Three planks in a triangle, each over the next one by 20 mm, from an index and a place on."""
    corners = np.array([(0.0, 0.0), (2000.0, 0.0), (1000.0, 1700.0)]) + shift
    marks = [f"S1-G-{first + i:02d}" for i in range(3)]
    names = [f"S1-K-{first + i:03d}" for i in range(3)]
    planks, joints = [], []
    for i in range(3):
        low, high = np.array([*corners[i], 0.0]), np.array([*corners[(i + 1) % 3], 20.0])
        reach = 0.2 * (high - low)
        planks.append(_plank(marks[i], low - reach, high + reach, [(names[i], low), (names[(i + 1) % 3], high)]))
        joints.append(Joint(names[i], "AG", vector(low), (0.0, 0.0, 1.0), (marks[i], marks[i - 1]), ()))
    return planks, joints


def _shell(planks: list[Plank], joints: list[Joint]) -> Shell:
    frame = Frame((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    return Shell("S1", frame, tuple(planks), (), (), (), (), (), tuple(joints))


@pytest.fixture
def woven() -> Shell:
    """Three planks in a triangle, each over the next one by 20 mm: nobody can be laid first."""
    return _shell(*_weave(1, 0.0))


def stiff(gridshell: Gridshell, shell: Shell) -> Gridshell:
    """Return a gridshell of one shell whose planks cannot be bent far enough to be slid in."""
    return replace(of(gridshell, shell), timber=replace(gridshell.timber, min_bending_radius=1e6))


def test_stiff_planks_woven_in_a_circle_are_refused_by_mark_and_joint(woven: Shell, gridshell: Gridshell) -> None:
    with pytest.raises(PlanError) as caught:
        flat_orders(stiff(gridshell, woven))
    for name in ("S1-G-01", "S1-G-02", "S1-G-03", "S1-K-001", "S1-K-002", "S1-K-003"):
        assert name in str(caught.value)


def test_every_circle_of_a_shell_is_named(gridshell: Gridshell) -> None:
    one, other = _weave(1, 0.0), _weave(4, 9000.0)
    with pytest.raises(PlanError) as caught:
        flat_orders(stiff(gridshell, _shell(one[0] + other[0], one[1] + other[1])))
    for mark in [joint.mark for joint in one[1] + other[1]] + [plank.mark for plank in one[0] + other[0]]:
        assert mark in str(caught.value)


def test_two_planks_of_the_weave_have_an_order(woven: Shell, gridshell: Gridshell) -> None:
    pair = replace(woven, planks=woven.planks[:2], joints=(woven.joints[1],))
    assert list(interlacing(assembly_graph(of(gridshell, pair))).precedence.edges) == [("S1-G-02", "S1-G-01")]


def test_one_plank_of_the_woven_triangle_is_slid_in(woven: Shell, gridshell: Gridshell) -> None:
    """2 m between its crossings and 24 mm up: R = 2000^2 / (4 x 24) = 41.7 m and nothing lies beyond its ends."""
    found = interlacing(assembly_graph(of(gridshell, woven)))
    assert not found.findings
    assert [slide.unit for slide in found.slides] == ["S1-G-01"]
    # The planks climb 20 mm on 2 m, which makes them longer by 0.005 %.
    assert found.slides[0].radius == pytest.approx(2000.0**2 / 96.0, rel=2e-4)
    assert found.slides[0].free == math.inf
    assert list(nx.topological_sort(found.precedence)) == ["S1-G-03", "S1-G-02", "S1-G-01"]
