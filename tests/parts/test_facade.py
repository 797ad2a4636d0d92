"""The cover of a shell: where sheets and bars lie and end, what carries them, and what the checks find."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from aag_cad.design import Design, load_design
from aag_cad.errors import DesignError
from aag_cad.findings import Finding
from aag_cad.geometry.framed import frames_at
from aag_cad.mechanics.checks.cover import FACADE_CHECKS
from aag_cad.network.build import shell_network
from aag_cad.network.model import CurveNetwork
from aag_cad.network.ridge import ridge_distance
from aag_cad.parts.build import gridshell_from
from aag_cad.parts.clearance import placed_points
from aag_cad.parts.facade import FacadePieces, covered, placed_facade
from aag_cad.parts.forming import formed_points
from aag_cad.parts.mesh import depths_in, frame_matrix
from aag_cad.parts.model import ClampingBar, Gridshell, Mullion, Part, Shell, Strip, shell_parts
from aag_cad.parts.products import part_frame
from aag_cad.parts.shapes.sheet import flat_pattern, sheet_radius, strip_depth, strip_mesh, strip_points
from aag_cad.pipeline import chart_of
from aag_cad.units import Floats

CONTACT = 1.0


def with_facade(design: Design, **changes: Any) -> Design:
    return design.model_copy(update={"facade": design.facade.model_copy(update=changes)})


def bare_gridshell(design: Design, network: CurveNetwork) -> Gridshell:
    return gridshell_from(with_facade(design, cover=False), network)


@pytest.fixture(scope="module")
def bare(design: Design, network: CurveNetwork) -> Gridshell:
    return bare_gridshell(design, network)


@pytest.fixture(scope="module")
def pieces(design: Design, network: CurveNetwork, bare: Gridshell) -> FacadePieces:
    return placed_facade(design, network, bare.shells[0])


@pytest.fixture(scope="module")
def clad(bare: Gridshell, pieces: FacadePieces) -> Gridshell:
    """One covered shell of the vault."""
    return replace(bare, shells=(covered(bare.shells[0], pieces),))


@pytest.fixture(scope="module")
def clad_shell(clad: Gridshell) -> Shell:
    return clad.shells[0]


def bars_of(shell: Shell) -> tuple[Mullion | ClampingBar, ...]:
    return (*shell.mullions, *shell.clamps)


def test_a_shell_of_the_vault_has_13_strips_between_14_mullions_and_clamping_bars(clad_shell: Shell) -> None:
    """Section 3.2: 13 strips of 10 mm polycarbonate, clamped along the geodesics."""
    assert [strip.mark for strip in clad_shell.strips] == [f"S1-P-{i:02d}" for i in range(1, 14)]
    assert [bar.mark for bar in clad_shell.mullions] == [f"S1-M-{i:02d}" for i in range(1, 15)]
    assert [bar.mark for bar in clad_shell.clamps] == [f"S1-D-{i:02d}" for i in range(1, 15)]
    assert {strip.thickness for strip in clad_shell.strips} == {10.0}


def test_formed_and_flat_edges_are_equally_long(clad_shell: Shell) -> None:
    for strip in clad_shell.strips:
        flat = flat_pattern(strip)
        for curve, side, flat_length in ((strip.left, 0, flat.left_length), (strip.right, -1, flat.right_length)):
            ends = np.interp(
                [strip.lower[side], strip.upper[side]], np.linspace(0, 1, len(curve.stations)), curve.stations
            )
            fine = curve.point_spline(np.linspace(*ends, 2001))
            formed = float(np.linalg.norm(np.diff(fine, axis=0), axis=1).sum())
            assert flat_length == pytest.approx(formed, rel=1e-4)


def test_formed_and_flat_sheet_have_the_same_area(clad_shell: Shell) -> None:
    for strip in clad_shell.strips:
        # Volume of the closed mesh over thickness: chords of 20 mm lose a few millionths.
        assert flat_pattern(strip).area == pytest.approx(strip_mesh(strip, 20.0).volume / strip.thickness, rel=1e-4)


def test_every_long_edge_is_concave(clad_shell: Shell) -> None:
    """Fig. 8e: each panel is tailored with a long concave edge."""
    flats = [flat_pattern(strip) for strip in clad_shell.strips]
    assert all(10.0 < sagitta < 30.0 for flat in flats for sagitta in (flat.left_sagitta, flat.right_sagitta))
    # Left and right half of a shell are mirror images.
    assert [flat.left_sagitta for flat in flats] == pytest.approx(
        [flat.right_sagitta for flat in flats[::-1]], abs=0.01
    )


def test_sheets_are_bent_as_the_neck_less_its_distance_from_the_surface(design: Design, clad_shell: Shell) -> None:
    # r0 / n = 1700 mm at the neck; the sheet lies 116 mm outside, on the far side from the centre of bending.
    assert min(sheet_radius(strip) for strip in clad_shell.strips) == pytest.approx(1700.0 + 116.0, rel=2e-3)


def test_cover_ends_at_the_clearances_of_foot_and_ridge(design: Design, clad_shell: Shell) -> None:
    for strip in clad_shell.strips:
        points = strip_mesh(strip).vertices
        assert points[:, 2].min() == pytest.approx(20.0, abs=1e-3)
        gap = float(ridge_distance(points, design.shells.count).min())
        assert 20.0 - 1e-3 < gap < 20.1
    for bar in bars_of(clad_shell):
        points = placed_points(bar)
        assert points[:, 2].min() == pytest.approx(20.0, abs=1e-3)
        assert ridge_distance(points, design.shells.count).min() == pytest.approx(20.0, abs=1e-2)


def test_the_middle_strip_ends_in_a_peak_under_the_crown(clad_shell: Shell) -> None:
    assert [len(strip.upper) for strip in clad_shell.strips] == [2] * 6 + [3] + [2] * 6
    left, peak, right = clad_shell.strips[6].upper
    assert peak == 1.0
    assert left == pytest.approx(right, abs=1e-5)
    assert left < 0.97
    corner = flat_pattern(clad_shell.strips[6]).upper[1]
    assert corner[1] == pytest.approx(0.0, abs=0.05)


def test_all_pieces_are_joined_and_all_that_joints_name_exists(clad_shell: Shell) -> None:
    named = {mark for joint in clad_shell.joints for mark in (*joint.members, *joint.fasteners)}
    marks = [part.mark for part in shell_parts(clad_shell)]
    assert len(set(marks)) == len(marks)
    assert named == set(marks) | {p for b in clad_shell.beams for p in b.planks}


def test_an_outer_beam_carries_the_mullion_wherever_it_crosses_the_geodesic(clad_shell: Shell) -> None:
    crossings = [
        joint for joint in clad_shell.joints if joint.kind == "AG" and any("-A2-" in mark for mark in joint.members)
    ]
    blocks = {mark for joint in clad_shell.joints if joint.kind == "cover" for mark in joint.members if "-K-" in mark}
    assert blocks == {joint.mark for joint in crossings}


def test_facade_screws_pass_both_bars_and_stop_before_the_bolt(design: Design, clad_shell: Shell) -> None:
    screws = {screw.mark: screw for screw in clad_shell.screws}
    bolts = {joint.mark: joint.fasteners[0] for joint in clad_shell.joints if joint.kind == "AG"}
    by_mark = {bolt.mark: bolt for bolt in clad_shell.bolts}
    holes: dict[str, list[Floats]] = {}
    for bar in bars_of(clad_shell):
        centres = formed_points(bar, np.array([[hole.station, hole.offset, 0.0] for hole in bar.blank.holes]))
        for hole, centre in zip(bar.blank.holes, centres, strict=True):
            holes.setdefault(hole.joint, []).append(centre)
    for joint in (joint for joint in clad_shell.joints if joint.kind == "cover"):
        screw = screws[f"{joint.mark}-W1"]
        origin, axis = np.array(screw.frame.origin), np.array(screw.frame.z)
        assert len(holes[joint.mark]) == 2
        for centre in holes[joint.mark]:
            assert np.linalg.norm(np.cross(centre - origin, axis)) < 0.1
        block = next((mark for mark in joint.members if "-K-" in mark), None)
        if block is not None:
            bolt = by_mark[bolts[block]]
            depth = (np.array(bolt.frame.origin) - origin) @ axis
            assert screw.length < depth - design.joints.bolt_hole / 2.0


def test_no_bar_is_left_without_support(design: Design, clad_shell: Shell) -> None:
    for bar in bars_of(clad_shell):
        stations = [hole.station for hole in bar.blank.holes]
        assert max(np.diff(stations)) < design.facade.support_spacing
        assert max(stations[0], bar.blank.length - stations[-1]) < 0.75 * design.facade.support_spacing


def test_blocks_on_geodesics_are_as_high_as_the_outer_beams(clad_shell: Shell, pieces: FacadePieces) -> None:
    assert pieces.blocks
    planks = {plank.mark: plank for plank in clad_shell.planks}
    for block in pieces.blocks:
        joint = next(joint for joint in clad_shell.joints if joint.mark == block.mark)
        plank = planks[next(mark for mark in joint.members if "-G-" in mark)]
        holes = [hole for hole in plank.blank.holes if hole.joint == joint.mark]
        assert len(holes) == 1
        assert joint.mark in {place.joint for place in plank.joints}
        foot = np.array(block.frame.origin) - block.width / 2.0 * np.array(block.frame.y)
        centre = frames_at(plank.curve, np.array([holes[0].station])).point[0]
        assert np.linalg.norm(foot - centre) == pytest.approx(6.0, abs=1e-3)
        assert np.linalg.norm(np.array(joint.point) - centre) == pytest.approx(106.0, abs=1e-3)


def skin(part: Part) -> Floats:
    return strip_points(part, 25.0, 8.0) if isinstance(part, Strip) else placed_points(part)


def depth_in(part: Part, points: Floats) -> float:
    if isinstance(part, Strip):
        return float(strip_depth(part, points).max())
    frame = part_frame(part)
    matrix = np.eye(4) if frame is None else frame_matrix(frame)
    return float(depths_in(part, (points - matrix[:3, 3]) @ matrix[:3, :3]).max())


def meetings(shell: Shell, cover: Sequence[Part]) -> Iterator[tuple[float, str, str]]:
    """Yield how deep each piece of the cover and each other part reach into each other, where they come near."""
    own = {(fastener, member) for joint in shell.joints for fastener in joint.fasteners for member in joint.members}
    skins = [(part, skin(part)) for part in shell_parts(shell)]
    for piece in cover:
        outside = skin(piece)
        low, high = outside.min(axis=0) - 1.0, outside.max(axis=0) + 1.0
        for part, points in skins:
            if part.mark == piece.mark or (part.mark, piece.mark) in own:
                continue
            theirs = points[np.all((points > low) & (points < high), axis=1)]
            least, most = points.min(axis=0) - 1.0, points.max(axis=0) + 1.0
            ours = outside[np.all((outside > least) & (outside < most), axis=1)]
            for target, near in ((piece, theirs), (part, ours)):
                if len(near):
                    yield depth_in(target, near), piece.mark, part.mark


def test_cover_and_gridshell_touch_but_do_not_run_into_each_other(clad_shell: Shell) -> None:
    """The side and the middle stand for the rest: strips and bars of both."""
    places = (0, 6)
    cover = [group[i] for group in (clad_shell.strips, clad_shell.mullions, clad_shell.clamps) for i in places]
    assert 0.0 < max(meetings(clad_shell, cover))[0] < CONTACT


def test_strips_end_at_the_planks_of_a_level_top_and_are_all_alike() -> None:
    design = load_design("triple-arch")
    network = shell_network(design, chart_of(design))
    strips = placed_facade(design, network, bare_gridshell(design, network).shells[0]).strips
    flats = [flat_pattern(strip) for strip in strips]
    assert len(strips) == 15
    assert np.ptp([flat.length for flat in flats]) < 0.01
    assert np.ptp([flat.area for flat in flats]) < 100.0
    assert all(strip.upper == pytest.approx((1.0, 1.0), abs=1e-6) for strip in strips)


def test_a_closed_shell_has_as_many_strips_as_geodesics() -> None:
    design = with_facade(load_design("column"), cover=True)
    network = shell_network(design, chart_of(design))
    gridshell = bare_gridshell(design, network)
    pieces = placed_facade(design, network, gridshell.shells[0])
    assert len(pieces.strips) == design.pattern.geodesics == 24
    over_last = [joint for joint in pieces.joints if "S1-M-24" in joint.members]
    assert all({"S1-P-23", "S1-P-24"} <= set(joint.members) for joint in over_last)
    assert all({"S1-P-24", "S1-P-01"} <= set(joint.members) for joint in pieces.joints if "S1-M-01" in joint.members)
    found = checked(design, replace(gridshell, shells=(covered(gridshell.shells[0], pieces),)))
    assert {"AAG851", "AAG852"} <= {check.code for check in found}


def test_without_a_cover_nothing_is_placed(design: Design, network: CurveNetwork, bare: Gridshell) -> None:
    assert placed_facade(with_facade(design, cover=False), network, bare.shells[0]) == FacadePieces()


def test_a_clearance_out_of_reach_is_refused_with_its_key(
    design: Design, network: CurveNetwork, bare: Gridshell
) -> None:
    for key, value in (("ridge_clearance", 4000.0), ("foot_clearance", -2000.0)):
        with pytest.raises(DesignError, match=f"facade.{key}: S1-M-01 cannot end there"):
            placed_facade(with_facade(design, **{key: value}), network, bare.shells[0])


def checked(design: Design, gridshell: Gridshell) -> list[Finding]:
    return [check for checks in FACADE_CHECKS for check in checks(design, gridshell)]


def test_the_cover_of_the_vault_passes_every_check(design: Design, clad: Gridshell) -> None:
    assert checked(design, clad) == []


@pytest.mark.parametrize(
    ("changes", "code", "mark", "found", "allowed"),
    [
        ({"sheet_width": 660.0}, "AAG851", "S1-P-07", 683.3, 660.0),
        ({"sheet_lengths": (3000.0, 5000.0)}, "AAG852", "S1-P-07", 5123.2, 5000.0),
        ({"sheet_thickness": 12.5}, "AAG853", "S1-P-01", 1817.6, 1875.0),
        ({"edge_gap": 3.0}, "AAG854", "S1-P-01", 1.0, 1.814),
        ({"ridge_clearance": 10.0}, "AAG855", "S1-P-01", 10.0, 11.78),
        ({"edge_gap": 8.0}, "AAG856", "S1", 17.0, 20.0),
        ({"support_spacing": 500.0}, "AAG858", "S1-M-01", 626.0, 500.0),
        ({"screw_length": 40.0}, "AAG859", "S1", 21.0, 24.0),
        ({"screw_length": 50.0}, "AAG860", "S1", 31.0, 27.5),
    ],
)
def test_a_figure_out_of_its_range_is_found(
    design: Design, clad: Gridshell, changes: dict[str, Any], code: str, mark: str, found: float, allowed: float
) -> None:
    checks = [check for check in checked(with_facade(design, **changes), clad) if check.code == code]
    first = next(check for check in checks if check.mark == mark)
    assert (first.found, first.allowed) == pytest.approx((found, allowed), rel=1e-3)
    assert first.remedy


def test_a_bar_too_thick_to_be_bent_cold_is_found(design: Design, clad: Gridshell) -> None:
    """EN AW-6060 T66 yields at 150 N/mm2: E t / 2 r = 70000 t / 3616."""
    shell = clad.shells[0]
    bar = shell.mullions[0]
    for thickness, fits in ((7.0, True), (8.0, False)):
        section = replace(bar.blank.section, thickness=thickness)
        thick = replace(bar, blank=replace(bar.blank, section=section))
        found = checked(design, replace(clad, shells=(replace(shell, mullions=(thick, *shell.mullions[1:])),)))
        assert ("AAG857" in {check.code for check in found}) != fits
