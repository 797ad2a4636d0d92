"""The frame engine against closed forms of beams and frames and against PyNiteFEA on the same model."""

import math
from dataclasses import replace

import numpy as np
import pytest
from frame_modes import lowest_eigenvalues
from Pynite import FEModel3D

from aag_cad.mechanics.frame.factor import lowest_pairs, softest_pair
from aag_cad.mechanics.frame.model import (
    FrameElement,
    FrameError,
    FrameMaterial,
    FrameModel,
    FrameNode,
    FrameSection,
    LineLoad,
    NodalLoad,
    RigidLink,
    Spring,
    Support,
    rectangle_section,
)
from aag_cad.mechanics.frame.statics import FrameResult, held_part, static_solution
from aag_cad.mechanics.frame.system import against_unknowns, frame_system, full_stiffness, mass_matrix
from aag_cad.units import Floats, Vector

# Exact elements: what is left is rounding, amplified by the ratio of the stiffnesses in a model.
EXACT = 1e-6
ASH = FrameMaterial(14000.0, 880.0)
PLANK = rectangle_section(100.0, 12.0)
BAR = FrameSection(area=1200.0, torsion=3.0e5, inertia_y=4.0e5, inertia_z=1.5e5)
UP: Vector = (0.0, 0.0, 1.0)


def chain(points: list[Vector], section: FrameSection = BAR, direction: Vector = UP) -> FrameModel:
    """Return elements from point to point; nodes 0, 1, ..., elements b1, b2, ...; node 0 clamped."""
    nodes = tuple(FrameNode(str(i), point) for i, point in enumerate(points))
    elements = tuple(FrameElement(f"b{i}", str(i - 1), str(i), section, ASH, direction) for i in range(1, len(points)))
    return FrameModel(nodes, elements, supports=(Support("0"),))


def moved(model: FrameModel, result: FrameResult, node: str) -> list[float]:
    place = [item.mark for item in model.nodes].index(node)
    return list(result.displacements[place].tolist())


def test_a_cantilever_deflects_by_p_l3_over_3ei_about_each_axis() -> None:
    """Local z is up: a load along z bends about y, and the tip turns about -y; a load along y bends about z."""
    model, length = chain([(0, 0, 0), (800, 0, 0), (2000, 0, 0)]), 2000.0
    result = static_solution(model, (NodalLoad("2", (1000.0, 20.0, 30.0), (5000.0, 0.0, 0.0)),))
    e, g = ASH.modulus, ASH.shear_modulus
    assert moved(model, result, "2") == pytest.approx(
        [
            1000.0 * length / (e * BAR.area),
            20.0 * length**3 / (3 * e * BAR.inertia_z),
            30.0 * length**3 / (3 * e * BAR.inertia_y),
            5000.0 * length / (g * BAR.torsion),
            -30.0 * length**2 / (2 * e * BAR.inertia_y),
            20.0 * length**2 / (2 * e * BAR.inertia_z),
        ],
        rel=EXACT,
    )
    assert result.reactions[0] == pytest.approx([-1000.0, -20.0, -30.0, -5000.0, 60000.0, -40000.0], rel=EXACT)


def test_an_even_load_gives_w_l4_over_8ei_and_the_clamping_moment() -> None:
    model, length, load = chain([(0, 0, 0), (0, 1500, 0)]), 1500.0, 0.7
    result = static_solution(model, (), (LineLoad("b1", (0.0, 0.0, -load)),))
    assert result.displacements[1, 2] == pytest.approx(-load * length**4 / (8 * ASH.modulus * BAR.inertia_y), rel=EXACT)
    assert abs(result.end_forces[0, 4]) == pytest.approx(load * length**2 / 2, rel=EXACT)
    assert result.end_forces[0, 6:] == pytest.approx(np.zeros(6), abs=1e-6)


def test_releases_make_a_propped_and_a_simply_supported_beam() -> None:
    """Clamped and hinged: 5/8 and 3/8 of the load; hinged at both ends: the ends of the beam turn, the nodes do not."""
    base = chain([(0, 0, 0), (3000, 0, 0)])
    held = replace(base, supports=(Support("0"), Support("1")))
    hinged = replace(held, elements=(replace(base.elements[0], end_releases=("ry",)),))
    result = static_solution(hinged, (), (LineLoad("b1", (0.0, 0.0, -1.0)),))
    assert result.reactions[:, 2] == pytest.approx([1875.0, 1125.0], rel=EXACT)
    assert result.reactions[0, 4] == pytest.approx(-(3000.0**2) / 8, rel=EXACT)
    both = replace(held, elements=(replace(base.elements[0], start_releases=("ry",), end_releases=("ry",)),))
    result = static_solution(both, (), (LineLoad("b1", (0.0, 0.0, -1.0)),))
    assert result.reactions[:, 2] == pytest.approx([1500.0, 1500.0], rel=EXACT)
    assert result.reactions[:, 4] == pytest.approx([0.0, 0.0], abs=1e-6)


def test_a_portal_with_hinged_feet_sways_as_the_slope_deflection_method_says() -> None:
    """P h3 / (6 E I_c) + P h2 l / (12 E I_b) without stretch of the members: area times 1e5."""
    height, span, push = 3000.0, 4000.0, 500.0
    stiff = replace(BAR, area=BAR.area * 1e5)
    points: list[Vector] = [(0, 0, 0), (0, 0, height), (span, 0, height), (span, 0, 0)]
    model = chain(points, stiff, (0.0, 1.0, 0.0))
    feet = tuple(Support(node, ("x", "y", "z", "rx", "rz")) for node in ("0", "3"))
    model = replace(model, supports=feet)
    result = static_solution(model, (NodalLoad("1", (push / 2, 0, 0)), NodalLoad("2", (push / 2, 0, 0))))
    sway = push * height**2 / ASH.modulus / BAR.inertia_z * (height / 6 + span / 12)
    assert moved(model, result, "1")[0] == pytest.approx(sway, rel=EXACT)
    assert result.reactions[3, 2] == pytest.approx(push * height / span, rel=EXACT)


def test_a_bent_cantilever_in_space_adds_bending_of_both_legs_and_torsion_of_the_first() -> None:
    a, b, load = 1200.0, 700.0, 40.0
    model = chain([(0, 0, 0), (a, 0, 0), (a, b, 0)])
    result = static_solution(model, (NodalLoad("2", (0, 0, -load)),))
    bending = (a**3 + b**3) / (3 * ASH.modulus * BAR.inertia_y)
    torsion = a * b**2 / (ASH.shear_modulus * BAR.torsion)
    assert moved(model, result, "2")[2] == pytest.approx(-load * (bending + torsion), rel=EXACT)


def test_an_element_on_rigid_arms_is_an_element_at_their_ends() -> None:
    """A bar 50 mm over its nodes: the load in the node's line is an axial force with the moment 50 F."""
    arm, force, length = 50.0, 300.0, 1000.0
    base = chain([(0, 0, 0), (length, 0, 0)])
    raised = replace(base.elements[0], start_offset=(0, 0, arm), end_offset=(0, 0, arm))
    result = static_solution(replace(base, elements=(raised,)), (NodalLoad("1", (force, 0, 0)),))
    bend = force * arm / (ASH.modulus * BAR.inertia_y)
    assert result.displacements[1] == pytest.approx(
        [force * length / (ASH.modulus * BAR.area) + arm**2 * force * length / (ASH.modulus * BAR.inertia_y),
         0.0, bend * length**2 / 2, 0.0, -bend * length, 0.0],
        rel=EXACT, abs=1e-9,
    )  # fmt: skip


def test_two_planks_36_mm_apart_between_blocks_bend_as_one_under_a_moment() -> None:
    """2 E I + 2 E A e2, 28 times the stiffness of two loose planks: the coupled beam of the paper, section 3.1."""
    base, moment, length = chain([(0, 0, 0), (1000, 0, 0)], PLANK), 1e5, 1000.0
    planks = tuple(
        replace(base.elements[0], mark=side, start_offset=(0, e, 0), end_offset=(0, e, 0))
        for side, e in (("L", 18.0), ("R", -18.0))
    )
    result = static_solution(replace(base, elements=planks), (NodalLoad("1", (0, 0, 0), (0, 0, moment)),))
    loose = 2 * ASH.modulus * PLANK.inertia_z
    assert result.displacements[1, 5] == pytest.approx(moment * length / (28.0 * loose), rel=EXACT)


def scissors(pin: Vector | None) -> FrameModel:
    """Return two crossing bars 112 mm over each other, the lower clamped at an end, the upper held by the stud only."""
    nodes = (
        FrameNode("a", (-500, 0, 0)), FrameNode("A", (0, 0, 0)), FrameNode("b", (0, -400, 112)),
        FrameNode("B", (0, 0, 112)), FrameNode("c", (0, 400, 112)),
    )  # fmt: skip
    elements = (
        FrameElement("aA", "a", "A", BAR, ASH, UP),
        FrameElement("bB", "b", "B", BAR, ASH, UP),
        FrameElement("Bc", "B", "c", BAR, ASH, UP),
    )
    return FrameModel(nodes, elements, (RigidLink("A", "B", pin),), (Support("a"),))


def test_a_rigid_stud_carries_force_and_moment_from_layer_to_layer() -> None:
    """The lower bar is a cantilever under the force, its moment 112 F and the torque 400 F."""
    force, e = 10.0, ASH.modulus
    result = static_solution(scissors(None), (NodalLoad("c", (force, 0, 0)),))
    lower, turn = result.displacements[1], 112.0 * force * 500.0 / (e * BAR.inertia_y)
    assert lower[4] == pytest.approx(turn, rel=EXACT)
    twist = -400.0 * force * 500.0 / (e * BAR.inertia_z)
    assert lower[5] == pytest.approx(twist, rel=EXACT)
    stud = 112.0 * turn + force * 500.0 / (e * BAR.area)
    tip = stud - 400.0 * twist + force * 400.0**3 / (3 * e * BAR.inertia_z)
    assert result.displacements[4, 0] == pytest.approx(tip, rel=EXACT)


def test_the_pin_of_a_scissor_joint_is_a_mechanism_that_names_the_free_end_and_its_way() -> None:
    with pytest.raises(FrameError, match=r"^[bc]: the frame is a mechanism.*move along \(1, 0, 0\)"):
        static_solution(scissors(UP), (NodalLoad("c", (0, 0, -10.0)),))


def test_a_pin_with_a_turning_spring_takes_what_the_spring_gives() -> None:
    """The spring holds end c against turning: the pin then carries no torque into the lower bar."""
    model = replace(scissors(UP), springs=(Spring("c", UP, 1e7, turning=True),))
    result = static_solution(model, (NodalLoad("c", (0, 0, 0), (0, 0, 2000.0)),))
    assert result.displacements[4, 5] == pytest.approx(2000.0 / 1e7, rel=EXACT)
    assert result.displacements[1, 5] == pytest.approx(0.0, abs=1e-15)


def test_links_in_a_chain_are_one_rigid_body() -> None:
    model = chain([(0, 0, 0), (1000, 0, 0), (1000, 0, 60), (1000, 300, 60)])
    linked = replace(model, elements=model.elements[:1], links=(RigidLink("2", "3"), RigidLink("1", "2")))
    result = static_solution(linked, (NodalLoad("3", (0, 0, -10.0)),))
    direct = static_solution(
        replace(linked, nodes=model.nodes[:2], links=()), (NodalLoad("1", (0, 0, -10.0), (-3000.0, 0, 0)),)
    )
    assert result.displacements[1] == pytest.approx(direct.displacements[1], rel=EXACT)
    assert result.displacements[3, 2] == pytest.approx(
        direct.displacements[1, 2] + 300.0 * direct.displacements[1, 3], rel=EXACT
    )


def test_springs_at_the_feet_add_f_over_k() -> None:
    model = replace(
        chain([(0, 0, 0), (0, 0, 2000)], direction=(0, 1, 0)),
        supports=(Support("0", ("x", "y", "rx", "ry", "rz")),),
        springs=(Spring("0", (0, 0, 2.0), 100.0),),
    )
    result = static_solution(model, (NodalLoad("1", (0, 0, -500.0)),))
    assert result.displacements[0, 2] == pytest.approx(-5.0, rel=EXACT)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"supports": ()}, "mechanism"),
        ({"supports": (Support("0", ("x", "y", "z")),)}, "mechanism"),
        ({"nodes": tuple(FrameNode(mark, (100 * i, i, 0)) for i, mark in enumerate(("0", "1", "lost")))}, r"^lost: "),
        ({"supports": (Support("9"),)}, "^9: .*not in the model"),
        ({"nodes": (FrameNode("0", (0, 0, 0)), FrameNode("1", (0, 0, 0)))}, "^b1: length 0"),
        ({"links": (RigidLink("1", "1"),)}, "own master"),
        ({"links": (RigidLink("1", "0"),)}, "^0: a slave of a rigid link cannot be held"),
        ({"nodes": (FrameNode("0", (0, 0, 0)), FrameNode("0", (1000, 0, 0)))}, "^0: two nodes"),
    ],
)  # fmt: skip
def test_what_does_not_stand_is_named(change: dict[str, object], text: str) -> None:
    model = replace(chain([(0, 0, 0), (1000, 0, 0)]), **change)  # type: ignore[arg-type]
    with pytest.raises(FrameError, match=text):
        static_solution(model, (NodalLoad("1", (0, 0, -1.0)),))


def test_three_hinges_in_a_row_name_the_middle_one() -> None:
    """Two bars in a line, hinged at both ends and in the middle, have no stiffness across: never a huge number."""
    base = chain([(0, 0, 0), (1000, 0, 0), (2000, 0, 0)])
    first, second = base.elements
    model = replace(
        base,
        elements=(replace(first, start_releases=("ry",), end_releases=("ry",)), second),
        supports=(Support("0"), Support("2", ("x", "y", "z", "rx", "rz"))),
    )
    with pytest.raises(FrameError, match=r"^1: .*move along \(0, 0, 1\)"):
        static_solution(model, (NodalLoad("1", (0, 0, -1.0)),))


def test_an_element_that_its_releases_leave_loose_is_named() -> None:
    base = chain([(0, 0, 0), (1000, 0, 0)])
    spun = replace(base, elements=(replace(base.elements[0], start_releases=("rx",), end_releases=("rx",)),))
    with pytest.raises(FrameError, match=r"^b1: released rx, rx"):
        static_solution(spun)


def test_the_direction_of_local_z_may_not_run_along_the_element() -> None:
    with pytest.raises(FrameError, match=r"^b1: the direction of local z"):
        static_solution(chain([(0, 0, 0), (0, 0, 900)]))


def test_a_cantilever_swings_at_the_frequencies_of_euler_and_bernoulli() -> None:
    """omega2 = (k l)^4 E I / (m l^4) with k l = 1.8751 and 4.6941; 40 lumped masses leave 0.2 %."""
    count, length, weight = 40, 3000.0, 2.52
    model = chain([(length * i / count, 0.0, 0.0) for i in range(count + 1)])
    masses = np.full(count + 1, weight / count)
    masses[[0, -1]] /= 2
    found = lowest_eigenvalues(model, 6, masses)
    for inertia in (BAR.inertia_y, BAR.inertia_z):
        unit = 1000.0 * ASH.modulus * inertia / (weight * length**3)
        for root in (1.875104, 4.694091):
            assert np.min(np.abs(found / (root**4 * unit) - 1.0)) < 2e-3


def test_subspace_iteration_finds_the_softest_mode_from_a_guess_that_lacks_it() -> None:
    """The guess is two higher modes of the cantilever, square to the first; Lanczos gives the value to compare with."""
    count = 40
    system = frame_system(chain([(50.0 * i, 0.0, 0.0) for i in range(count + 1)]))
    stiffness = held_part(system, against_unknowns(system, full_stiffness(system)))
    mass = held_part(system, mass_matrix(system, np.full(count + 1, 0.05)))
    values, modes = lowest_pairs(stiffness, mass, 6)
    found, better = softest_pair(stiffness, mass, modes[:, 3:5])
    assert found == pytest.approx(values[0], rel=1e-7)
    assert better.shape == (len(mass.diagonal()), 2)


def test_a_beam_in_the_air_has_six_modes_without_stiffness() -> None:
    base = chain([(300.0 * i, 10.0 * i * i, 0.0) for i in range(14)])
    found = lowest_eigenvalues(replace(base, supports=()), 8)
    assert np.all(np.abs(found[:6]) < 1e-6 * found[6])


def test_a_pin_shows_as_one_eigenvalue_of_zero() -> None:
    """With masses at all nodes; scissors of one clamped and one free bar."""
    found = lowest_eigenvalues(scissors(UP), 2, np.ones(5))
    assert abs(found[0]) < 1e-6 * found[1]


def space_frame() -> tuple[list[Vector], list[tuple[int, int]]]:
    """Return a crooked tower of two storeys: corners (12,) and members."""
    points: list[Vector] = [
        (x + 90.0 * level * y / 1000, y - 60.0 * level, 1700.0 * level + 0.1 * x * level)
        for level in range(3)
        for x, y in ((0.0, 0.0), (2400.0, 0.0), (2600.0, 1900.0), (100.0, 2100.0))
    ]
    members = [(4 * s + i, 4 * s + 4 + i) for s in range(2) for i in range(4)]
    members += [(4 * s + i, 4 * s + (i + 1) % 4) for s in (1, 2) for i in range(4)]
    return points, [*members, (1, 4), (6, 9)]


def pynite_model(points: list[Vector], members: list[tuple[int, int]], sections: list[FrameSection]) -> FEModel3D:
    model = FEModel3D()
    model.add_material("ash", ASH.modulus, ASH.shear_modulus, 0.3, 0.0)
    for i, point in enumerate(points):
        model.add_node(str(i), *point)
    for k, ((i, j), section) in enumerate(zip(members, sections, strict=True)):
        model.add_section(f"s{k}", section.area, section.inertia_y, section.inertia_z, section.torsion)
        model.add_member(f"m{k}", str(i), str(j), "ash", f"s{k}", rotation=17.0 * k)
    for i in range(4):
        model.def_support(str(i), True, True, True, True, True, True)
    return model


def pynite_displacements(model: FEModel3D, count: int) -> Floats:
    model.analyze_linear(check_stability=False)
    names = ("DX", "DY", "DZ", "RX", "RY", "RZ")
    return np.array([[getattr(model.nodes[str(i)], name)["Combo 1"] for name in names] for i in range(count)])


def test_a_space_frame_with_releases_and_loads_is_that_of_pynite() -> None:
    points, members = space_frame()
    sections = [replace(BAR, inertia_y=BAR.inertia_y * (1 + 0.1 * k)) for k in range(len(members))]
    other = pynite_model(points, members, sections)
    ours = []
    for k, (i, j) in enumerate(members):
        x, y, z = other.members[f"m{k}"].T()[2, :3].tolist()
        ours.append(FrameElement(f"m{k}", str(i), str(j), sections[k], ASH, (x, y, z)))
    other.def_releases("m9", Ryi=True, Rzj=True)
    ours[9] = replace(ours[9], start_releases=("ry",), end_releases=("rz",))
    other.def_releases("m16", Ryi=True, Rzi=True, Ryj=True, Rzj=True, Rxj=True)
    ours[16] = replace(ours[16], start_releases=("ry", "rz"), end_releases=("rx", "ry", "rz"))
    loads = [NodalLoad("9", (120.0, -40.0, -900.0), (3e4, -2e4, 1e4)), NodalLoad("6", (0.0, 300.0, 0.0))]
    for load in loads:
        for name, value in zip(("FX", "FY", "FZ", "MX", "MY", "MZ"), (*load.force, *load.moment), strict=True):
            other.add_node_load(load.node, name, value)
    lines = [LineLoad("m9", (0.3, 0.1, -0.8)), LineLoad("m2", (0.0, 0.2, 0.0)), LineLoad("m16", (0.0, 0.0, -0.5))]
    for line in lines:
        for name, value in zip(("FX", "FY", "FZ"), line.force, strict=True):
            other.add_member_dist_load(line.element, name, value, value)
    nodes = tuple(FrameNode(str(i), point) for i, point in enumerate(points))
    model = FrameModel(nodes, tuple(ours), supports=tuple(Support(str(i)) for i in range(4)))
    found = static_solution(model, tuple(loads), tuple(lines))
    expected = pynite_displacements(other, len(points))
    for part in (slice(0, 3), slice(3, 6)):
        scale = np.abs(expected[:, part]).max()
        assert found.displacements[:, part] == pytest.approx(expected[:, part], abs=EXACT * scale)
    for k in (2, 9, 12):
        ends = np.asarray(other.members[f"m{k}"].f()).ravel()
        assert found.end_forces[k] == pytest.approx(ends, abs=EXACT * np.abs(ends).max())


def pynite_tip_on_arms(points: list[Vector], stiffening: float) -> tuple[Floats, Vector]:
    """Return the displacements of node 1 and local z of a bar between arms that are ``stiffening`` times as stiff."""
    other = FEModel3D()
    other.add_material("ash", ASH.modulus, ASH.shear_modulus, 0.3, 0.0)
    for i, point in enumerate(points):
        other.add_node(str(i), *point)
    for name, factor in (("bar", 1.0), ("arm", stiffening)):
        other.add_section(name, *(factor * v for v in (BAR.area, BAR.inertia_y, BAR.inertia_z, BAR.torsion)))
    for name, i, j, section in (("m", 2, 3, "bar"), ("a", 0, 2, "arm"), ("b", 1, 3, "arm")):
        other.add_member(name, str(i), str(j), "ash", section)
    other.def_support("0", True, True, True, True, True, True)
    for name, value in (("FX", 100.0), ("FY", 7.0), ("FZ", -30.0), ("MX", 4e3)):
        other.add_node_load("1", name, value)
    x, y, z = other.members["m"].T()[2, :3].tolist()
    return pynite_displacements(other, 2)[1], (x, y, z)


def test_rigid_arms_are_the_limit_of_pynite_with_ever_stiffer_members() -> None:
    """The arms' flexibility falls with their stiffness s: 2 u(2 s) - u(s) is the limit but for 1 / s2; s = 2000."""
    points: list[Vector] = [(0, 0, 0), (2000, 100, 50), (0, 56, 0), (2000, 156, 50)]
    (once, direction), (twice, _) = (pynite_tip_on_arms(points, stiffening) for stiffening in (2e3, 4e3))
    arm: Vector = (0, 56, 0)
    model = FrameModel(
        (FrameNode("0", points[0]), FrameNode("1", points[1])),
        (FrameElement("m", "0", "1", BAR, ASH, direction, arm, arm),),
        supports=(Support("0"),),
    )
    found = static_solution(model, (NodalLoad("1", (100.0, 7.0, -30.0), (4e3, 0.0, 0.0)),)).displacements[1]
    assert found == pytest.approx(2.0 * twice - once, rel=EXACT)


def test_a_thin_plank_twists_like_roarks_rectangle() -> None:
    """K = a b3 (16/3 - 3.36 b/a (1 - b4 / 12 a4)) with half sides a and b: Roark, table 10.7."""
    a, b = 50.0, 6.0
    assert PLANK.torsion == pytest.approx(a * b**3 * (16 / 3 - 3.36 * b / a * (1 - b**4 / (12 * a**4))), rel=1e-12)
    assert rectangle_section(12.0, 100.0).inertia_y == pytest.approx(100.0 * 12.0**3 / 12.0, rel=1e-12)
    assert math.isclose(rectangle_section(12.0, 100.0).torsion, PLANK.torsion)
