"""From curves to parts: how many, where they end, and that the same design gives the same gridshell."""

import math
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from aag_cad.design import Design
from aag_cad.errors import DesignError
from aag_cad.network.model import CurveNetwork
from aag_cad.parts.build import gridshell_from
from aag_cad.parts.mesh import shell_mesh
from aag_cad.parts.model import Footing, Gridshell, Plank, Rod, Shell, all_joints, shell_parts
from aag_cad.parts.shapes.bar import plank_mesh
from aag_cad.pipeline import gridshell_of
from aag_cad.units import Floats


def ridge_distance(points: Floats) -> Floats:
    """Return the distance of points from the nearer of the two vertical planes at 60 degrees from -x."""
    return np.asarray(-math.sqrt(3.0) / 2.0 * points[:, 0] - np.abs(points[:, 1]) / 2.0)


def of_family(shell: Shell, *families: str) -> list[Plank]:
    return [plank for plank in shell.planks if plank.family in families]


def test_the_planks_of_the_vault(gridshell: Gridshell) -> None:
    """66 coupled beams of 132 planks, 42 geodesics, 9 edge planks in three shells."""
    planks = Counter(plank.family for shell in gridshell.shells for plank in shell.planks)
    assert sum(len(shell.beams) for shell in gridshell.shells) == 66
    assert planks["A1"] + planks["A2"] == 132
    assert planks["G"] == 42
    assert planks["E"] == 9


def test_every_beam_has_two_planks_of_its_own(shell: Shell) -> None:
    owned = [mark for beam in shell.beams for mark in beam.planks]
    assert len(owned) == len(set(owned)) == 2 * len(shell.beams)
    beam_of = {plank.mark: plank.beam for plank in shell.planks}
    assert all(beam_of[mark] == beam.mark for beam in shell.beams for mark in beam.planks)


def test_the_joints_of_a_shell(shell: Shell, network: CurveNetwork) -> None:
    """Each crossing of the network becomes one joint of its kind, each foot one more between shoe and block."""
    crossings = Counter(c.kind for c in network.crossings)
    structural = Counter(joint.kind for joint in shell.joints if joint.kind != "cover")
    assert structural == crossings + Counter(footing=crossings["foot"])
    assert len({joint.mark for joint in shell.joints}) == len(shell.joints)


def test_the_same_design_gives_the_same_gridshell(design: Design, gridshell: Gridshell) -> None:
    """Bit for bit, built a second time from the design alone."""
    assert gridshell_of(design) == gridshell


def test_the_longest_and_shortest_planks(shell: Shell) -> None:
    """Beams up to 6.9 m; geodesics from 3.5 m at the side to 4.5 m at the middle; bottom r0 pi / 3 + 200 mm."""
    beams = [plank.blank.length for plank in of_family(shell, "A1", "A2")]
    assert 6500.0 < max(beams) < 6870.0
    geodesics = [plank.blank.length for plank in of_family(shell, "G")]
    assert geodesics[:7] == sorted(geodesics[:7])
    assert geodesics == pytest.approx(geodesics[::-1], abs=1e-3)
    bottom = of_family(shell, "E")[0]
    assert bottom.blank.length == pytest.approx(5100.0 * math.pi / 3.0 + 200.0, abs=1e-3)


def test_geodesics_are_their_meridian_less_what_the_edge_planks_take(shell: Shell) -> None:
    """A side meridian is 3.76 m long to the ridge plane; foot and ridge plank with gaps take 55 and 170 mm of it."""
    side, middle = of_family(shell, "G")[0].blank.length, of_family(shell, "G")[6].blank.length
    assert 3760.0 - 300.0 < side < 3760.0 - 150.0
    assert 4780.0 - 400.0 < middle < 4780.0 - 150.0


def test_no_part_comes_nearer_to_the_ridge_plane_than_the_gap(design: Design, shell: Shell) -> None:
    """Nothing but blades there. The end of a beam is found on its curve, its corners lie 0.05 mm aside."""
    for part in shell_parts(shell):
        assert ridge_distance(shell_mesh(part).vertices).min() > design.boundary.ridge_gap - 0.05, part.mark


def test_nothing_but_concrete_blocks_and_their_rods_reaches_below_the_ground(gridshell: Gridshell) -> None:
    for part in shell_parts(gridshell.shells[0]):
        low = shell_mesh(part).vertices[:, 2].min()
        assert (low < gridshell.ground - 1.0) == isinstance(part, Footing | Rod), part.mark


def test_the_highest_timber_is_about_as_high_as_the_crown_of_the_surface(shell: Shell) -> None:
    """The highest timber is an outer beam beside the ridge: at most 106 mm over a surface that ends below its crown."""
    top = max(float(plank_mesh(plank).vertices[:, 2].max()) for plank in shell.planks)
    assert 2691.0 < top < 2720.0 + 106.0


def test_both_planks_of_a_beam_carry_all_its_joints(shell: Shell) -> None:
    joints = {plank.mark: [place.joint for place in plank.joints] for plank in shell.planks}
    for beam in shell.beams:
        marks = [place.joint for place in beam.joints]
        assert joints[beam.planks[0]] == joints[beam.planks[1]] == marks


def test_every_joint_of_a_plank_names_the_plank_and_the_other_way_round(gridshell: Gridshell) -> None:
    """Ridge planks carry the joints of their blades too, which lie between two shells."""
    planks = [plank for shell in gridshell.shells for plank in shell.planks]
    marks = {plank.mark for plank in planks}
    named = {(mark, joint.mark) for joint in all_joints(gridshell) for mark in joint.members if mark in marks}
    assert {(plank.mark, place.joint) for plank in planks for place in plank.joints} == named


def test_the_timber_is_that_of_the_design_with_the_values_of_its_class(design: Design, gridshell: Gridshell) -> None:
    timber = gridshell.timber
    assert (timber.species, timber.strength_class, timber.density) == ("ash", "D50", 700.0)
    assert (timber.modulus, timber.bending_strength) == (14000.0, 50.0)
    assert math.degrees(timber.max_twist) * 1000.0 == pytest.approx(design.timber.max_twist_deg_per_m)
    assert timber.min_bending_radius == 1700.0


def test_a_vault_of_more_shells_repeats_the_same_shell(design: Design, network: CurveNetwork) -> None:
    """The network is that of one shell: with five of them the parts are the same, 72 degrees apart.

    Cropped for three it reaches over the ridge planes of five: no cover, and few places for blades are tried.
    """
    facade = design.facade.model_copy(update={"cover": False})
    ridge = design.ridge.model_copy(update={"blades": "equal", "blade_spacing": 1e5})
    five = replace_shell_count(design.model_copy(update={"facade": facade, "ridge": ridge}), 5)
    built = gridshell_from(five, network)
    assert [shell.mark for shell in built.shells] == ["S1", "S2", "S3", "S4", "S5"]
    np.testing.assert_allclose(
        built.shells[1].placement.x, [math.cos(math.radians(72.0)), math.sin(math.radians(72.0)), 0.0], atol=1e-15
    )
    assert built.shells[4].planks[0].mark == "S5-A1-01-L"


def replace_shell_count(design: Design, count: int) -> Design:
    return design.model_copy(update={"shells": design.shells.model_copy(update={"count": count})})


def test_a_gap_wider_than_any_bolt_is_long_is_refused_by_its_key(design: Design, network: CurveNetwork) -> None:
    """The longest M8 in the catalogue is 160 mm; a gap of 150 mm needs 174 mm of timber and more of bolt."""
    joints = design.joints.model_copy(update={"gap": 150.0, "stud_across_flats": 150.0})
    with pytest.raises(DesignError, match=r"joints\.bolt_diameter: no M8 bolt of .* mm in the catalogue, the longest"):
        gridshell_from(design.model_copy(update={"joints": joints}), network)


def test_ground_follows_the_foot_height(design: Design, network: CurveNetwork, gridshell: Gridshell) -> None:
    """Shoes grow, rods and blocks go down by 70 mm; all else stays where it is."""
    supports = design.supports.model_copy(update={"foot_height": 220.0})
    raised = gridshell_from(design.model_copy(update={"supports": supports}), network)
    assert raised.ground == gridshell.ground - 70.0 == -220.0
    for old, new in zip(gridshell.shells, raised.shells, strict=True):
        heights = [[part.frame.origin[2] for part in each.rods] for each in (old, new)]
        assert np.subtract(heights[0], heights[1]) == pytest.approx(70.0, abs=1e-9)
        tops = [[part.frame.origin[2] for part in each.footings] for each in (old, new)]
        assert np.subtract(tops[0], tops[1]) == pytest.approx(70.0, abs=1e-9)
    assert [_without_feet(shell) for shell in raised.shells] == [_without_feet(shell) for shell in gridshell.shells]
    assert (raised.blades, raised.bolts, raised.joints) == (gridshell.blades, gridshell.bolts, gridshell.joints)


def _without_feet(shell: Shell) -> Shell:
    above = tuple(joint for joint in shell.joints if joint.kind != "footing")
    return replace(shell, shoes=(), rods=(), footings=(), joints=above)
