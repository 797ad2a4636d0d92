"""The gridshell as data: frames, layers, blanks and curves agree with each other, in every shell alike."""

import math
from collections import Counter
from dataclasses import FrozenInstanceError, fields, is_dataclass

import numpy as np
import pytest

from aag_cad.design import Design
from aag_cad.geometry.framed import frames_at
from aag_cad.network.model import CurveNetwork
from aag_cad.parts.forms import Frame
from aag_cad.parts.model import FlatBar, Gridshell, Part, Plank, Shell, all_joints, all_parts, ridge_parts, shell_parts
from aag_cad.parts.products import part_frame
from aag_cad.units import Floats


def axes(frame: Frame) -> Floats:
    return np.array([frame.x, frame.y, frame.z])


def test_all_parts_of_the_gridshell_are_those_of_its_shells_the_blades_and_their_bolts(gridshell: Gridshell) -> None:
    listed = [part.mark for shell in gridshell.shells for part in shell_parts(shell)]
    between = [*(blade.mark for blade in gridshell.blades), *(bolt.mark for bolt in gridshell.bolts)]
    assert [part.mark for part in ridge_parts(gridshell)] == between
    assert [part.mark for part in all_parts(gridshell)] == [*listed, *between]


def test_every_field_of_a_shell_that_holds_parts_is_among_its_parts(shell: Shell) -> None:
    held = [getattr(shell, field.name) for field in fields(shell) if field.name not in ("beams", "joints")]
    pieces = [piece for piece in held if isinstance(piece, tuple)]
    assert [part for piece in pieces for part in piece] == list(shell_parts(shell))


def test_beams_are_assemblies_and_no_parts(shell: Shell) -> None:
    parts = {part.mark for part in shell_parts(shell)}
    assert not parts & {beam.mark for beam in shell.beams}
    assert {mark for beam in shell.beams for mark in beam.planks} <= parts


def test_a_gridshell_never_changes(shell: Shell) -> None:
    pieces: tuple[Part | Shell, ...] = (shell, shell.planks[0], shell.studs[0], shell.bolts[0])
    for piece in pieces:
        assert is_dataclass(piece)
        with pytest.raises(FrozenInstanceError):
            piece.mark = "S9"  # type: ignore[misc]


def test_all_frames_are_orthonormal_and_right_handed(gridshell: Gridshell) -> None:
    frames = [frame for part in all_parts(gridshell) if (frame := part_frame(part)) is not None]
    frames += [shell.placement for shell in gridshell.shells]
    stacked = np.array([axes(frame) for frame in frames])
    unity = np.broadcast_to(np.eye(3), stacked.shape)
    np.testing.assert_allclose(stacked @ stacked.transpose(0, 2, 1), unity, atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(stacked), 1.0, atol=1e-12)


def test_the_blank_of_a_plank_or_bar_is_as_long_as_its_curve(gridshell: Gridshell) -> None:
    for shell in gridshell.shells:
        bars: tuple[FlatBar, ...] = (*shell.planks, *shell.straps, *shell.mullions, *shell.clamps)
        for bar in bars:
            assert bar.blank.length == bar.curve.length


def test_the_samples_of_a_plank_follow_its_arc_length(shell: Shell) -> None:
    """The spline runs at unit speed to 2e-5: over 7 m the centre line is a fraction of a millimetre off the blank."""
    for plank in shell.planks:
        stations = np.linspace(0.0, plank.curve.length, 400)
        speed = np.linalg.norm(plank.curve.point_spline(stations, nu=1), axis=1)
        np.testing.assert_allclose(speed, 1.0, atol=2e-5)


def test_all_planks_have_the_one_section_of_the_design(design: Design, gridshell: Gridshell) -> None:
    sections = {plank.blank.section for shell in gridshell.shells for plank in shell.planks}
    assert [(section.width, section.thickness) for section in sections] == [(100.0, 12.0)]
    assert (design.timber.width, design.timber.thickness) == (100.0, 12.0)


def test_asymptotic_planks_stand_upright_in_the_outer_layers_and_the_others_lie_flat_between(shell: Shell) -> None:
    kinds = {(plank.family, plank.layer, plank.upright, bool(plank.beam)) for plank in shell.planks}
    assert kinds == {
        ("A1", -1, True, True),
        ("A2", 1, True, True),
        ("G", 0, False, False),
        ("E", 0, False, False),
    }


def test_layer_plus_one_lies_outside_and_layer_minus_one_inside(design: Design, shell: Shell) -> None:
    """At every AA node the beam of A2 lies 56 mm along the outward normal, that of A1 56 mm against it."""
    beams = {beam.planks[0]: beam for beam in shell.beams}
    for joint in (joint for joint in shell.joints if joint.kind == "AA"):
        for beam in (beams[mark] for mark in joint.members if mark in beams):
            station = next(place.station for place in beam.joints if place.joint == joint.mark)
            point = frames_at(beam.curve, np.array([station])).point[0]
            lift = (point - np.array(joint.point)) @ np.array(joint.normal)
            assert lift == pytest.approx(beam.layer * design.layer_offset, abs=1e-4)
            assert np.linalg.norm(point - np.array(joint.point)) == pytest.approx(design.layer_offset, abs=1e-4)


def test_siblings_lie_left_and_right_of_their_beam_seen_from_outside(design: Design, shell: Shell) -> None:
    """Left is the side of normal x tangent; both centres are 18 mm from the beam's, so the gap is 24 mm wide."""
    planks = {plank.mark: plank for plank in shell.planks}
    for beam in shell.beams:
        left, right = (planks[mark] for mark in beam.planks)
        assert (left.mark[-1], right.mark[-1]) == ("L", "R")
        frames = frames_at(beam.curve, np.array([0.0, beam.curve.length]))
        for plank, sign in ((left, 1.0), (right, -1.0)):
            gap = plank.curve.points[[0, -1]] - frames.point
            np.testing.assert_allclose(gap, sign * design.sibling_offset * frames.binormal, atol=1e-4)


def test_holes_and_joints_are_sorted_by_station_and_inside_the_blank(gridshell: Gridshell) -> None:
    for plank in gridshell.shells[0].planks:
        stations = [hole.station for hole in plank.blank.holes]
        assert stations == sorted(stations)
        assert all(0.0 < station < plank.blank.length for station in stations)
        places = [joint.station for joint in plank.joints]
        assert places == sorted(places)


def test_holes_belong_to_the_joints_of_their_plank(shell: Shell) -> None:
    """A hole sits within 61 mm of its joint: a bolt's 18 mm offset, or half a block that was moved to a beam's end.

    Bolts of steel reach farther: a strap lies on a geodesic from 80 mm before its end, moved back by at most 160 mm
    where beams are in the way, on bolts 40 mm apart; the crown's on both ridge planks where they are 300 mm apart.
    """
    kinds = {joint.mark: joint.kind for joint in shell.joints}
    for plank in shell.planks:
        stations = {place.joint: place.station for place in plank.joints}
        for hole in plank.blank.holes:
            reach = 61.0 if kinds.get(hole.joint) in ("AA", "AG", "boundary") else 80.0 + 160.0 + 40.0
            assert abs(hole.station - stations[hole.joint]) < reach


def test_flat_planks_are_screwed_to_beams_on_their_centre_line(shell: Shell) -> None:
    flat = [plank for plank in shell.planks if not plank.upright]
    holes = [hole for plank in flat for hole in plank.blank.holes if "-K-" in hole.joint]
    assert {hole.use for hole in holes} == {"screw"}
    assert max(abs(hole.offset) for hole in holes) < 1e-3


def test_flat_planks_are_bolted_to_steel_at_their_ends_and_edges(shell: Shell) -> None:
    """Shoes, straps and blades; no bolt nearer to an edge of the plank than 3 d of an M8 (EN 1995-1-1, table 8.4)."""
    for plank in (plank for plank in shell.planks if not plank.upright):
        bolted = [hole for hole in plank.blank.holes if hole.use == "bolt"]
        assert {hole.joint.split("-")[-2][0] for hole in bolted} <= {"F", "R"}
        assert all(plank.blank.section.width / 2.0 - abs(hole.offset) >= 24.0 for hole in bolted)


def test_upright_planks_are_bolted_on_the_two_lines_of_the_design(design: Design, shell: Shell) -> None:
    upright = [plank for plank in shell.planks if plank.upright]
    assert all(hole.use == "bolt" for plank in upright for hole in plank.blank.holes)
    offsets = np.array([hole.offset for plank in upright for hole in plank.blank.holes])
    np.testing.assert_allclose(np.abs(offsets), design.joints.bolt_offset, atol=0.05)


def test_the_shells_stand_120_degrees_apart_about_the_centre(gridshell: Gridshell) -> None:
    for i, shell in enumerate(gridshell.shells):
        angle = 2.0 * math.pi * i / 3.0
        assert shell.placement.origin == (0.0, 0.0, 0.0)
        np.testing.assert_allclose(shell.placement.x, [math.cos(angle), math.sin(angle), 0.0], atol=1e-15)
        assert shell.placement.z == (0.0, 0.0, 1.0)


def test_the_shells_are_congruent_part_by_part(gridshell: Gridshell) -> None:
    """Same curves, blanks and frames in their own coordinates: three times one shell."""
    first = gridshell.shells[0]
    for shell in gridshell.shells[1:]:
        for one, other in zip(first.planks, shell.planks, strict=True):
            assert one.curve == other.curve
            assert [(h.station, h.offset, h.diameter) for h in one.blank.holes] == [
                (h.station, h.offset, h.diameter) for h in other.blank.holes
            ]
        for name in ("straps", "mullions", "clamps"):
            assert [bar.curve for bar in getattr(first, name)] == [bar.curve for bar in getattr(shell, name)]
        for name in ("studs", "blocks", "bolts", "screws", "shoes", "rods", "footings"):
            assert [part.frame for part in getattr(first, name)] == [part.frame for part in getattr(shell, name)]
        assert [joint.point for joint in first.joints] == [joint.point for joint in shell.joints]


def test_no_plank_of_one_shell_crosses_into_the_next(shell: Shell) -> None:
    """All centre lines stay inside both ridge planes."""
    for plank in shell.planks:
        x, y = plank.curve.points[:, 0], np.abs(plank.curve.points[:, 1])
        assert (-math.sqrt(3.0) / 2.0 * x - y / 2.0).min() > 0.0


def test_the_ground_lies_a_foot_height_below_the_ground_line(design: Design, gridshell: Gridshell) -> None:
    assert gridshell.ground == -design.supports.foot_height == -150.0


def test_the_parts_of_a_shell_by_kind(shell: Shell) -> None:
    """61 planks; 88 studs with four bolts, 204 blocks with a bolt and a screw; 14 feet with shoe, four bolts and rod.

    A strap at the upper end of each of 14 geodesics and one at the crown. 13 strips between 14 mullions under 14
    clamping bars, on blocks of beams and on some of their own, which stand on geodesics.
    """
    kinds, joints = Counter(type(part).__name__ for part in shell_parts(shell)), Counter(j.kind for j in shell.joints)
    assert (kinds["Plank"], kinds["Stud"]) == (61, 88)
    assert (joints["AA"], joints["AG"] + joints["boundary"]) == (88, 204)
    assert (kinds["Shoe"], kinds["Rod"], kinds["Footing"], kinds["Strap"]) == (14, 14, 14, 15)
    strap_bolts = sum(len(joint.fasteners) for joint in shell.joints if joint.kind == "ridge")
    assert kinds["Bolt"] == 4 * 88 + 204 + 4 * 14 + strap_bolts
    assert (kinds["Mullion"], kinds["Strip"], kinds["ClampingBar"]) == (14, 13, 14)
    cover = [joint for joint in shell.joints if joint.kind == "cover"]
    assert kinds["CouplingBlock"] == 204 + sum(joint.mark in joint.members for joint in cover)
    assert kinds["Screw"] == 204 + sum(len(joint.fasteners) for joint in cover)
    assert all(isinstance(part, Plank) for part in shell_parts(shell)[: kinds["Plank"]])


def test_the_parts_between_the_shells(gridshell: Gridshell) -> None:
    """Seven blades of four bolts along each of three ridges."""
    assert Counter(type(part).__name__ for part in ridge_parts(gridshell)) == {"Blade": 21, "Bolt": 84}


def test_what_python_shows_of_a_gridshell_its_parts_and_curves_is_short(
    gridshell: Gridshell, network: CurveNetwork
) -> None:
    """Every mark can still be read; samples and holes stay out of it."""
    first = gridshell.shells[0]
    assert repr(gridshell) == f"Gridshell vault: 3 shells, {len(all_parts(gridshell))} parts"
    assert repr(first) == "Shell S1: 22 beams, 17 flat planks, 436 joints"
    assert repr(network) == f"CurveNetwork of {len(network.curves)} curves, {len(network.crossings)} crossings"
    for item in (*all_parts(gridshell), *first.beams, *all_joints(gridshell)):
        assert repr(item.mark) in repr(item)
        assert len(repr(item)) < 300, repr(item)
    assert max(len(repr(item.curve)) for item in (*first.planks, *network.curves)) < 60
