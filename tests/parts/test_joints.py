"""The joints: the hexagonal stud that fits every node, bolts across beams, blocks and screws for the flat planks."""

import math
from collections import Counter

import numpy as np
import pytest

from aag_cad.design import Design
from aag_cad.geometry.framed import frames_at
from aag_cad.parts.forming import blank_points, plank_axes
from aag_cad.parts.forms import Frame
from aag_cad.parts.model import (
    Bolt,
    CouplingBlock,
    Gridshell,
    Joint,
    Plank,
    Rod,
    Screw,
    Shell,
    Stud,
    all_joints,
    all_parts,
    shell_parts,
)
from aag_cad.units import Floats


def array(vector: tuple[float, float, float]) -> Floats:
    return np.array(vector)


def local(frame: Frame, point: Floats) -> Floats:
    """Return the coordinates of a point (3,) in a frame."""
    return np.asarray(np.array([frame.x, frame.y, frame.z]) @ (point - array(frame.origin)))


def joints_of(shell: Shell, *kinds: str) -> list[Joint]:
    return [joint for joint in shell.joints if joint.kind in kinds]


def planks_of(shell: Shell) -> dict[str, Plank]:
    return {plank.mark: plank for plank in shell.planks}


def studs_with_planks(shell: Shell) -> list[tuple[Stud, Plank]]:
    """Return every stud with each of the four planks that it touches."""
    planks, studs = planks_of(shell), {stud.mark: stud for stud in shell.studs}
    return [
        (studs[joint.mark], planks[mark])
        for joint in joints_of(shell, "AA")
        for mark in joint.members
        if mark in planks
    ]


def block_joints(shell: Shell) -> list[tuple[Joint, CouplingBlock, Bolt, Screw, Plank]]:
    """Return the joints of the flat planks on beams: block, bolt, screw and the flat plank."""
    planks, blocks = planks_of(shell), {block.mark: block for block in shell.blocks}
    bolts, screws = {bolt.mark: bolt for bolt in shell.bolts}, {screw.mark: screw for screw in shell.screws}
    found = []
    for joint in joints_of(shell, "AG", "boundary"):
        bolt, screw = (joint.fasteners[0], joint.fasteners[1])
        flat = next(planks[mark] for mark in joint.members if mark in planks and not planks[mark].upright)
        found.append((joint, blocks[joint.mark], bolts[bolt], screws[screw], flat))
    return found


def test_every_fastener_belongs_to_exactly_one_joint(gridshell: Gridshell) -> None:
    held = Counter(mark for joint in all_joints(gridshell) for mark in joint.fasteners)
    assert set(held) == {part.mark for part in all_parts(gridshell) if isinstance(part, Bolt | Screw | Rod)}
    assert set(held.values()) == {1}


def test_every_joint_has_a_fastener_whose_mark_begins_with_its_own(gridshell: Gridshell) -> None:
    for joint in all_joints(gridshell):
        assert joint.fasteners
        assert all(mark.rpartition("-")[0] == joint.mark for mark in joint.fasteners)


def test_every_part_has_a_joint_and_every_joint_names_parts_that_exist(gridshell: Gridshell) -> None:
    for shell in gridshell.shells:
        named = {mark for joint in shell.joints for mark in (*joint.members, *joint.fasteners)}
        assert named == {part.mark for part in shell_parts(shell)}
    named = {mark for joint in all_joints(gridshell) for mark in (*joint.members, *joint.fasteners)}
    assert named == {part.mark for part in all_parts(gridshell)}


def test_who_meets_at_a_joint(shell: Shell) -> None:
    """AA: two beams and a stud with four bolts. AG and boundary: a beam, a flat plank and a block, bolt and screw."""
    for joint in joints_of(shell, "AA"):
        families = [mark.split("-")[1] for mark in joint.members]
        assert families == ["A1", "A1", "A2", "A2", "N"]
        assert [mark[-2:] for mark in joint.fasteners] == ["B1", "B2", "B3", "B4"]
    for joint in joints_of(shell, "AG", "boundary"):
        families = [mark.split("-")[1] for mark in joint.members]
        assert families[0] == families[1]
        assert families[0] in ("A1", "A2")
        assert families[2:] == ["G" if joint.kind == "AG" else "E", "K"]
        assert [mark[-2:] for mark in joint.fasteners] == ["B1", "W1"]
    for joint in joints_of(shell, "foot"):
        assert [mark.split("-")[1] for mark in joint.members] == ["G", "E", "F"]
        assert [mark[-2:] for mark in joint.fasteners] == ["B1", "B2", "B3", "B4"]
    for joint in joints_of(shell, "footing"):
        assert [mark.split("-")[1] for mark in joint.members] == ["F", "C"]
        assert [mark[-2:] for mark in joint.fasteners] == ["T1"]
    ridge = joints_of(shell, "ridge")
    assert Counter(tuple(mark.split("-")[1] for mark in joint.members) for joint in ridge) == {
        ("G", "E", "R"): 14,
        ("E", "E", "R"): 1,
    }
    assert all({mark[-2] for mark in joint.fasteners} == {"B"} for joint in ridge)


def test_who_meets_at_a_cover_joint(shell: Shell) -> None:
    """One screw through clamping bar and mullion between strips into a block; one on a geodesic has its own more."""
    assert joints_of(shell, "cover")
    for joint in joints_of(shell, "cover"):
        families = Counter(mark.split("-")[1] for mark in joint.members)
        assert (families["M"], families["D"], families["K"] + families["V"]) == (1, 1, 1)
        assert families["P"] in (1, 2)
        assert families["G"] == families["V"]
        assert joint.fasteners[0] == f"{joint.mark}-W1"
        assert (len(joint.fasteners) > 1) == bool(families["V"])


def test_blades_join_the_ridge_planks_of_two_shells_with_four_bolts(gridshell: Gridshell) -> None:
    assert {joint.kind for joint in gridshell.joints} == {"blade"}
    for joint in gridshell.joints:
        left, right, blade = joint.members
        assert (left[3:], right[3:], blade) == ("E-02", "E-03", joint.mark)
        assert {left[1], right[1]} == set(joint.mark[1:3])
        assert [mark[-2:] for mark in joint.fasteners] == ["B1", "B2", "B3", "B4"]


def test_normals_of_joints_are_unit_vectors_out_of_the_vault(shell: Shell) -> None:
    normals = np.array([joint.normal for joint in shell.joints])
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-12)
    assert normals[:, 2].min() > -1e-9


def test_a_stud_stands_on_its_node_along_the_surface_normal(shell: Shell) -> None:
    joints = {joint.mark: joint for joint in shell.joints}
    for stud in shell.studs:
        assert stud.frame.origin == joints[stud.mark].point
        np.testing.assert_allclose(stud.frame.z, joints[stud.mark].normal, atol=1e-12)


def test_the_beams_cross_at_sixty_degrees_in_their_own_layers_too(shell: Shell) -> None:
    """56 mm off the surface each beam turns by h tau_g; both families turn the same way, for h and tau_g change sign.

    So the angle of the surface stays the angle of the joint, and one stud fits all nodes.
    """
    beams = {beam.planks[0]: beam for beam in shell.beams}
    for joint in joints_of(shell, "AA"):
        tangents = []
        for beam in (beams[mark] for mark in joint.members if mark in beams):
            station = next(place.station for place in beam.joints if place.joint == joint.mark)
            tangents.append(frames_at(beam.curve, np.array([station])).tangent[0])
        assert math.degrees(math.acos(abs(float(tangents[0] @ tangents[1])))) == pytest.approx(60.0, abs=1e-4)


def test_a_flat_of_the_stud_faces_each_of_its_four_planks(shell: Shell) -> None:
    """Its normals, every 60 degrees about the axis, lie in the thickness direction of the plank to 0.05 degrees."""
    for stud, plank in studs_with_planks(shell):
        lift = array(stud.frame.origin) + plank.layer * 56.0 * array(stud.frame.z)
        station = blank_points(plank, lift[None])[0, 0]
        thickness = plank_axes(plank, np.array([station]))[3][0]
        x, y, z = local(stud.frame, thickness + array(stud.frame.origin))
        turn = math.degrees(math.atan2(y, x)) % 60.0
        assert min(turn, 60.0 - turn) < 0.05
        assert abs(math.degrees(math.asin(z))) < 0.05


def test_the_flats_of_the_stud_touch_the_faces_of_the_planks(shell: Shell) -> None:
    """24 mm across flats fill the gap of 24 mm: from flat to plank face 0 mm, within 0.2."""
    for stud, plank in studs_with_planks(shell):
        centre = array(stud.frame.origin) + plank.layer * 56.0 * array(stud.frame.z)
        off = abs(blank_points(plank, centre[None])[0, 2])
        contact = off - plank.blank.section.thickness / 2.0 - stud.across_flats / 2.0
        assert contact == pytest.approx(0.0, abs=0.2)


def test_the_stud_reaches_through_both_beams(design: Design, shell: Shell) -> None:
    """Two planks of 100 mm and the geodesics' 12 mm between them: 212 of 220 mm, so 4 mm stand out at each end."""
    needed = 2.0 * design.timber.width + design.timber.thickness
    assert all(stud.length - needed == pytest.approx(8.0) for stud in shell.studs)


def test_the_holes_of_a_stud_are_where_its_bolts_pass(shell: Shell) -> None:
    """Through its axis, at right angles to it, out of a flat: at heights +-56 +-18 mm."""
    bolts = {bolt.mark: bolt for bolt in shell.bolts}
    joints = {joint.mark: joint for joint in shell.joints}
    for stud in shell.studs:
        assert sorted(hole.height for hole in stud.holes) == [-74.0, -38.0, 38.0, 74.0]
        for hole, mark in zip(stud.holes, joints[stud.mark].fasteners, strict=True):
            bolt = bolts[mark]
            x, y, z = local(stud.frame, array(bolt.frame.origin))
            direction = local(stud.frame, array(bolt.frame.z) + array(stud.frame.origin))
            assert z == pytest.approx(hole.height, abs=0.02)
            assert abs(direction[2]) < 1e-3
            assert abs(x * direction[1] - y * direction[0]) < 0.02
            along = math.degrees(math.atan2(direction[1], direction[0]) - hole.angle) % 180.0
            assert min(along, 180.0 - along) < 0.05
            assert min(math.degrees(hole.angle) % 60.0, 60.0 - math.degrees(hole.angle) % 60.0) < 0.05


def test_a_bolt_clamps_two_planks_and_what_fills_their_gap(design: Design, shell: Shell) -> None:
    """Its head lies on the outer face of one plank and its nut on that of the other, 12 + 24 + 12 mm on."""
    planks, bolts = planks_of(shell), {bolt.mark: bolt for bolt in shell.bolts}
    for joint in joints_of(shell, "AA", "AG", "boundary"):
        for bolt in (bolts[mark] for mark in joint.fasteners if mark in bolts):
            assert bolt.grip == design.joints.gap + 2.0 * design.timber.thickness == 48.0
            ends = np.array([array(bolt.frame.origin) + t * array(bolt.frame.z) for t in (0.0, bolt.grip)])
            near = []
            for plank in (planks[mark] for mark in joint.members if mark in planks and planks[mark].upright):
                x, y, z = blank_points(plank, ends).T
                inside = (np.abs(y) < 50.0) & (np.abs(np.abs(z) - 6.0) < 0.05) & (x > 0.0)
                near.append(inside & (x < plank.blank.length))
            assert np.array(near).any(axis=0).all(), bolt.mark


def test_a_bolt_of_steel_clamps_one_plank_and_the_steel_on_it(design: Design, gridshell: Gridshell) -> None:
    """12 mm of timber and the plate: 6 mm of a shoe, 3 mm of a strap, 5 mm of a blade; head on the steel."""
    timber, kinds = design.timber.thickness, {joint.mark: joint.kind for joint in all_joints(gridshell)}
    steel = {
        "foot": design.supports.shoe_thickness,
        "ridge": design.ridge.strap_thickness,
        "blade": design.ridge.blade_thickness,
    }
    bolts = [*gridshell.bolts, *(bolt for shell in gridshell.shells for bolt in shell.bolts)]
    on_steel = [(bolt, kinds[bolt.mark.rpartition("-")[0]]) for bolt in bolts]
    on_steel = [(bolt, kind) for bolt, kind in on_steel if kind in steel]
    assert all(bolt.grip == timber + steel[kind] for bolt, kind in on_steel)
    assert {kind for _, kind in on_steel} == set(steel)


def test_a_bolt_is_long_enough_for_washers_and_nut_but_not_by_a_whole_size_more(gridshell: Gridshell) -> None:
    """Two washers of 2 mm, a nut of 6.8 mm and 2 mm of thread past the grip.

    Through a beam, 48 mm: 60.8 mm, the next size is 65. Through a plank and steel of 3 to 6 mm: 27.8 to 30.8 mm, for
    which ISO 4014 has no M8 shorter than 40.
    """
    for bolt in (*gridshell.shells[0].bolts, *gridshell.bolts):
        needed = bolt.grip + 2.0 * bolt.washer_thickness + bolt.nut_height
        assert needed < bolt.length
        assert (bolt.diameter, bolt.length) == (8.0, 65.0 if bolt.grip == 48.0 else 40.0)


def test_a_block_fills_the_gap_and_bears_on_the_flat_plank(shell: Shell) -> None:
    """It lies 6 to 106 mm off the surface: its edge is flush with the face of the plank that is screwed to it."""
    beams = {mark: beam for beam in shell.beams for mark in beam.planks}
    for joint, block, _, _, flat in block_joints(shell):
        beam = beams[joint.members[0]]
        assert (block.length, block.width, block.thickness) == (120.0, 100.0, 24.0)
        x, y, z = local(block.frame, array(joint.point))
        assert abs(x) <= block.length / 2.0
        assert beam.layer * y == pytest.approx(-block.width / 2.0 - flat.blank.section.thickness / 2.0, abs=0.2)
        assert z == pytest.approx(0.0, abs=0.3)


def test_a_block_lies_inside_its_beam(shell: Shell) -> None:
    beams = {mark: beam for beam in shell.beams for mark in beam.planks}
    for joint, block, _, _, _ in block_joints(shell):
        curve = beams[joint.members[0]].curve
        gap = np.linalg.norm(curve.points - array(block.frame.origin), axis=1)
        tangent = array(block.frame.x)
        start = float((array(block.frame.origin) - curve.points[0]) @ tangent)
        end = float((curve.points[-1] - array(block.frame.origin)) @ tangent)
        assert gap.min() < 150.0
        # within half a sample of either end the beam is straight to a tenth of a millimetre
        assert min(start, end) > block.length / 2.0 - 0.1


def test_a_screw_enters_the_flat_plank_flush_and_ends_in_the_block(design: Design, shell: Shell) -> None:
    for joint, block, _, screw, flat in block_joints(shell):
        head = array(screw.frame.origin)
        x, y, z = blank_points(flat, head[None])[0]
        assert 0.0 < x < flat.blank.length
        assert abs(y) < 0.05
        assert abs(z) == pytest.approx(flat.blank.section.thickness / 2.0, abs=0.01)
        tip = local(block.frame, head + screw.length * array(screw.frame.z))
        assert np.all(np.abs(tip) < np.array([block.length, block.width, block.thickness]) / 2.0), joint.mark
        depth = screw.length - design.timber.thickness
        assert block.width / 2.0 - abs(tip[1]) == pytest.approx(min(depth, block.width - depth), abs=0.5)


def test_a_screw_keeps_its_distance_from_the_end_of_its_block(design: Design, shell: Shell) -> None:
    """7 d of EN 1995-1-1, table 8.2 (a3,c), along the grain of the block: 42 mm."""
    for joint, block, _, screw, _ in block_joints(shell):
        x = local(block.frame, array(screw.frame.origin))[0]
        assert block.length / 2.0 - abs(x) >= 7.0 * design.joints.screw_diameter, joint.mark


def test_screw_and_bolt_of_a_block_do_not_meet(shell: Shell) -> None:
    """The bolt passes on the far side of the beam's centre line: at least 10 mm of timber lie between them."""
    for joint, block, bolt, screw, _ in block_joints(shell):
        tip = local(block.frame, array(screw.frame.origin) + screw.length * array(screw.frame.z))
        axis = local(block.frame, array(bolt.frame.origin))
        assert block.holes[0].offset == pytest.approx(axis[1], abs=0.05)
        clear = math.hypot(max(0.0, abs(tip[0] - axis[0]) - 3.0), tip[1] - axis[1]) - bolt.diameter / 2.0
        assert clear > 10.0, joint.mark


def test_geodesics_are_screwed_to_the_inner_beams_from_outside_and_to_the_outer_ones_from_inside(
    shell: Shell,
) -> None:
    """Interwoven (section 3.1): the screw points away from the free face, into the layer of its beam."""
    layer = {mark: beam.layer for beam in shell.beams for mark in beam.planks}
    for joint, _, _, screw, _ in block_joints(shell):
        assert float(array(screw.frame.z) @ array(joint.normal)) == pytest.approx(layer[joint.members[0]], abs=1e-9)
