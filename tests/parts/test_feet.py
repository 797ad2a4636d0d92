"""Feet of the vault (paper section 3.2, Fig. 8a): 14 blocks a shell, shoes on rods that set the height."""

import numpy as np
import pytest

from aag_cad.design import Design, load_design, parse_design
from aag_cad.errors import DesignError
from aag_cad.network.model import CurveNetwork
from aag_cad.parts.build import gridshell_from
from aag_cad.parts.mesh import depths_in, frame_matrix
from aag_cad.parts.model import Gridshell, Shell, Shoe
from aag_cad.parts.shapes.folded_plate import hole_axes, plate_legs
from aag_cad.units import Floats


def _in_shell(shoe: Shoe, points: Floats) -> Floats:
    matrix = frame_matrix(shoe.frame)
    return np.asarray(points @ matrix[:3, :3].T + matrix[:3, 3])


def test_every_shell_stands_on_14_concrete_blocks_and_the_vault_on_42(gridshell: Gridshell) -> None:
    assert [len(shell.footings) for shell in gridshell.shells] == [14, 14, 14]
    assert [len(shell.shoes) for shell in gridshell.shells] == [14, 14, 14]
    assert [len(shell.rods) for shell in gridshell.shells] == [14, 14, 14]


def test_the_tops_of_the_blocks_lie_on_the_ground(gridshell: Gridshell, shell: Shell) -> None:
    for footing in shell.footings:
        assert footing.frame.origin[2] == pytest.approx(gridshell.ground, abs=1e-9)
        assert footing.frame.z == (0.0, 0.0, 1.0)


def test_every_foot_has_two_bolts_in_the_geodesic_two_in_the_bottom_plank_and_a_rod(shell: Shell) -> None:
    feet = [joint for joint in shell.joints if joint.kind == "foot"]
    assert len(feet) == 14
    holes = {plank.mark: plank.blank.holes for plank in shell.planks}
    for joint in feet:
        geodesic, edge, shoe = joint.members
        assert shoe == joint.mark
        assert [sum(hole.joint == joint.mark for hole in holes[mark]) for mark in (geodesic, edge)] == [2, 2]
        assert len(joint.fasteners) == 4
    standing = [joint for joint in shell.joints if joint.kind == "footing"]
    assert [len(joint.fasteners) for joint in standing] == [1] * 14


def test_rods_pass_the_hole_of_their_shoe_upright_and_reach_into_the_block(shell: Shell) -> None:
    shoes, footings = {s.mark[-2:]: s for s in shell.shoes}, {f.mark[-2:]: f for f in shell.footings}
    for rod in shell.rods:
        number = rod.mark.split("-")[2]
        centres, axes = hole_axes(shoes[number].plate)
        centre = _in_shell(shoes[number], centres)[-1]
        assert centre[:2] == pytest.approx(rod.frame.origin[:2], abs=1e-9)
        assert abs(axes[-1][2]) == pytest.approx(1.0)
        # The foot of the shoe lies between the two nuts, with no play.
        low, high = (rod.frame.origin[2] + height for height in rod.nuts)
        assert (low, high) == pytest.approx((centre[2] - 3.0, centre[2] + 3.0), abs=1e-9)
        depth = footings[number].frame.origin[2] - rod.frame.origin[2]
        assert 0.3 * footings[number].height < depth < footings[number].height


def test_the_lower_nut_can_go_down_and_the_upper_nut_up_by_the_adjustment(design: Design, shell: Shell) -> None:
    way = design.supports.adjustment
    for rod, footing in zip(shell.rods, shell.footings, strict=True):
        under_nut = rod.frame.origin[2] + rod.nuts[0] - rod.washer_thickness - rod.nut_height
        assert under_nut - footing.frame.origin[2] >= way
        assert rod.length - (rod.nuts[1] + rod.washer_thickness + rod.nut_height) >= way


def test_shoes_lie_on_the_face_of_their_planks_without_a_gap_of_a_millimetre(shell: Shell) -> None:
    planks = {plank.mark: plank for plank in shell.planks}
    for joint in (joint for joint in shell.joints if joint.kind == "foot"):
        shoe = next(shoe for shoe in shell.shoes if shoe.mark == joint.mark)
        legs = plate_legs(shoe.plate)
        top = _in_shell(shoe, (legs.start + legs.direction * legs.length[:, None] / 2.0)[:4])
        depth = depths_in(planks[joint.members[0]], top)
        assert depth == pytest.approx(-3.0, abs=0.5)


def test_shoes_take_the_side_that_the_crossing_beam_leaves_free(shell: Shell) -> None:
    """Beams of A1 end inside at every other foot, those of A2 outside at the ones between."""
    sides = [float(np.sign(shoe.plate.line[3][0])) for shoe in shell.shoes]
    edge = [joint for joint in shell.joints if joint.kind == "boundary"]
    for shoe, side in zip(shell.shoes, sides, strict=True):
        near = [j for j in edge if np.linalg.norm(np.subtract(j.point, shoe.frame.origin)) < 50.0]
        assert all(("-A1-" in j.members[0]) == (side > 0.0) for j in near)
    assert {1.0, -1.0} == set(sides)


def test_a_foot_that_is_too_low_for_a_shoe_is_refused_with_the_height_that_it_takes(network: CurveNetwork) -> None:
    text = load_design("vault").model_dump()
    text["supports"]["foot_height"] = 80.0
    low = Design.model_validate(text)
    with pytest.raises(DesignError, match=r"supports.foot_height: 80 mm leaves no room for the shoe S1-F-01.*at least"):
        gridshell_from(low, network)


def test_an_unknown_rod_size_is_named_with_its_key() -> None:
    from aag_cad.resources import template

    text = template("designs", "vault.toml").read_text(encoding="utf-8")
    with pytest.raises(DesignError, match=r"supports\.rod_diameter"):
        parse_design(text.replace("rod_diameter = 16 ", "rod_diameter = 15 "))
