"""A gridshell is cut into as few segments as the transport allows, as a brute force over all cuts would do it."""

import itertools
import math
import re
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from aag_cad.design import Design, load_design
from aag_cad.language import printed
from aag_cad.mechanics.checks.fastener_spacing import bolt_distances
from aag_cad.parts.forming import formed_points
from aag_cad.parts.mesh import frame_matrix, shell_mesh
from aag_cad.parts.model import Gridshell, shell_parts
from aag_cad.parts.quantities import mass
from aag_cad.pipeline import gridshell_of
from assembly.base.errors import PlanError
from assembly.base.segments import Limits, Segmentation
from assembly.transport.cut_pieces import Divisible, divisible, stop_splices, stretch_between
from assembly.transport.findings import splice_finding
from assembly.transport.loading import best_pose, hull_points
from assembly.transport.search import best_stops, limits_from
from assembly.transport.segments import segment_findings, segments

LORRY = Limits(12000.0, 2400.0, 2600.0, 3000.0)
NARROW = Limits(12000.0, 2400.0, 2400.0, 3000.0)
WIDE = Limits(12000.0, 4000.0, 4000.0, 3000.0)


def by_mass(load: float) -> Limits:
    """A transport of any size that carries so much."""
    return Limits(50000.0, 50000.0, 50000.0, load)


@pytest.fixture(scope="module")
def single(gridshell: Gridshell) -> Gridshell:
    """The first shell of the vault, alone."""
    return replace(gridshell, shells=gridshell.shells[:1], blades=(), bolts=(), joints=())


@pytest.fixture(scope="module")
def item(single: Gridshell) -> Divisible:
    return divisible(single.shells[0], single.timber)


@pytest.fixture(scope="module")
def lorry(single: Gridshell) -> Segmentation:
    return segments(single, LORRY)


@pytest.fixture(scope="module")
def column() -> Gridshell:
    """A closed ring of 24 geodesics."""
    return gridshell_of(load_design("column"))


def test_no_random_pose_of_a_segment_leaves_more_room(item: Divisible) -> None:
    corners = hull_points(stretch_between(item, 2, 11).corners)
    found = best_pose(corners, LORRY.room)
    axes = Rotation.random(2000, random_state=1).as_matrix()
    fillings = [
        max(size / room for size, room in zip(np.ptp(corners @ turn, axis=0), LORRY.room, strict=True)) for turn in axes
    ]
    assert found.filling < min(fillings)


def test_the_vault_travels_in_three_shells_of_the_papers_weight(gridshell: Gridshell) -> None:
    plan = segments(gridshell, WIDE)
    assert [segment.name for segment in plan.segments] == ["S1", "S2", "S3"]
    assert not plan.splices
    assert not plan.site
    assert not plan.changes
    assert not plan.problems
    for segment in plan.segments:
        # Section 3.2: about 300 kg of timber and 30 kg of steel; both are rounded there to about a tenth.
        assert segment.mass == pytest.approx(330.0, rel=0.05)
        assert segment.timber == pytest.approx(300.0, rel=0.1)
        assert segment.fits


def test_alike_shells_are_cut_alike(gridshell: Gridshell) -> None:
    plan = segments(gridshell, by_mass(135.0))
    assert [segment.name for segment in plan.segments] == [f"S{i}.{k}" for i in (1, 2, 3) for k in (1, 2, 3)]
    for first, second in zip(plan.segments[:3], plan.segments[3:6], strict=True):
        assert [m.partition("-")[2] for m in first.geodesics] == [m.partition("-")[2] for m in second.geodesics]
        assert first.pose.size == pytest.approx(second.pose.size, abs=1e-6)


def carried_joints(single: Gridshell) -> Iterator[str]:
    """Marks of what the joints of a shell hold that are not made on site anyway: blocks, studs, straps, fasteners."""
    shell = single.shells[0]
    hubs = {stud.mark for stud in shell.studs} | {block.mark for block in shell.blocks}
    hubs |= {strap.mark for strap in shell.straps}
    for joint in shell.joints:
        if joint.kind not in ("foot", "footing", "cover"):
            yield from (mark for mark in (*joint.members, *joint.fasteners) if mark in hubs or mark in joint.fasteners)


def check_each_part_once(single: Gridshell, plan: Segmentation) -> None:
    """Every small part is in one segment, put in on site or replaced; the pieces of every plank make up its length."""
    planks = {plank.mark: plank for plank in single.shells[0].planks}
    found = Counter(mark for segment in plan.segments for mark in segment.parts)
    found.update(plan.site)
    found.update(mark for splice in plan.splices for mark in splice.left_out)
    lengths: dict[str, list[tuple[float, float]]] = defaultdict(list)
    for segment in plan.segments:
        for mark in set(segment.parts) & set(planks):
            lengths[mark].append((0.0, planks[mark].blank.length))
        for piece in segment.pieces:
            lengths[piece.plank].append((piece.start, piece.end))
    assert {mark: n for mark, n in found.items() if mark not in planks} == dict.fromkeys(carried_joints(single), 1)
    for mark, plank in planks.items():
        ends = sorted(lengths[mark])
        assert ends[0][0] == 0.0
        assert ends[-1][1] == plank.blank.length
        assert all(first[1] == second[0] for first, second in itertools.pairwise(ends)), mark


def test_each_part_is_in_one_segment_and_planks_are_cut_without_loss(single: Gridshell, lorry: Segmentation) -> None:
    check_each_part_once(single, lorry)


def test_segments_fit_by_the_meshes_of_their_parts(single: Gridshell, lorry: Segmentation) -> None:
    shell = single.shells[0]
    turn = frame_matrix(shell.placement)[:3, :3]
    parts = {part.mark: part for part in shell_parts(shell)}
    planks = {plank.mark: plank for plank in shell.planks}
    for segment in lorry.segments:
        points = [shell_mesh(parts[mark]).vertices for mark in segment.parts]
        for piece in segment.pieces:
            y, z = planks[piece.plank].blank.section.width / 2.0, planks[piece.plank].blank.section.thickness / 2.0
            stations = np.linspace(piece.start, piece.end, 40)
            blank = np.array([(x, a, b) for x in stations for a in (-y, y) for b in (-z, z)])
            points.append(formed_points(planks[piece.plank], blank))
        extents = np.ptp(np.concatenate(points) @ turn.T @ np.array(segment.pose.axes).T, axis=0)
        # Corners every 60 mm miss at most the sagitta of 60 mm at 1.7 m: 0.3 mm; splice blocks may stand out further.
        assert np.all(extents <= np.array(segment.pose.size) + 0.3)
        assert np.all(extents <= LORRY.room)
        assert segment.fits
        assert np.array(segment.pose.axes) @ np.array(segment.pose.axes).T == pytest.approx(np.eye(3), abs=1e-9)


def test_a_shell_is_cut_as_by_brute_force_over_all_lines(item: Divisible) -> None:
    load, stops = 135.0, item.grid.stops()

    @cache
    def grams(a: int, b: int) -> int | None:
        if a // 2 == b // 2 or not item.grid.owned(a, b):
            return None
        kilos = stretch_between(item, a, b).mass
        return round(1000.0 * kilos) if kilos <= load else None

    def beams(stop: int) -> int:
        return sum(splice.kind == "block" for splice in stop_splices(item, stop))

    found = []
    for inner in (cuts for n in range(3) for cuts in itertools.combinations(stops[1:-1], n)):
        masses = [grams(a, b) for a, b in itertools.pairwise((stops[0], *inner, stops[-1]))]
        if all(m is not None for m in masses):
            squares = sum(m**2 for m in masses if m is not None)
            found.append((len(masses), sum(beams(stop) for stop in inner), squares, inner))
    # The crane is the weaker one here.
    assert best_stops(item, replace(by_mass(3000.0), crane=load)) == min(found)[-1]


def test_what_lies_between_two_cuts_also_lies_between_wider_ones(item: Divisible) -> None:
    stops = item.grid.stops()
    for a, b in ((6, 13), (7, 12), (8, 17)):
        inner, i, j = stretch_between(item, a, b), stops.index(a), stops.index(b)
        for c, d in ((stops[i - 1], b), (a, stops[j + 1])):
            outer = stretch_between(item, c, d)
            assert {m for m in inner.parts if "-W" not in m} <= set(outer.parts)
            assert outer.mass > inner.mass - 1e-9


def test_cuts_and_bolts_of_splices_keep_clear_of_every_other_hole(single: Gridshell, lorry: Segmentation) -> None:
    planks = {plank.mark: plank for plank in single.shells[0].planks}
    limits = bolt_distances(8.0, 0.0)
    assert lorry.splices
    for splice in lorry.splices:
        assert splice.fits
        assert len(splice.cuts) == (2 if splice.kind == "block" else 1)
        last_bolt = limits.a3_t + (splice.columns - 1) * limits.a1
        for cut in splice.cuts:
            holes = [hole for hole in planks[cut.plank].blank.holes if hole.joint != splice.joint]
            nearest = min(abs(hole.station - cut.station) for hole in holes)
            assert nearest == pytest.approx(cut.clear)
            assert nearest >= last_bolt + limits.a1
            if splice.joint:
                assert any(j.joint == splice.joint and j.station == cut.station for j in planks[cut.plank].joints)
        if splice.kind == "block":
            assert splice.length == pytest.approx(2.0 * (last_bolt + limits.a3_t))
            assert splice.room >= splice.length / 2.0


def test_only_beams_with_studs_on_both_sides_of_a_line_are_cut(single: Gridshell, lorry: Segmentation) -> None:
    studs = {stud.mark for stud in single.shells[0].studs}
    beams = {beam.mark: beam for beam in single.shells[0].beams}
    cut = {(splice.member, splice.joint) for splice in lorry.splices if splice.kind == "block"}
    geodesics = {splice.line for splice in lorry.splices}
    crossing = {j.mark for j in single.shells[0].joints if j.kind == "AG" and geodesics & set(j.members)}
    wanted = set()
    for mark, beam in beams.items():
        for place in (place for place in beam.joints if place.joint in crossing):
            sides = {j.station > place.station for j in beam.joints if j.joint in studs}
            wanted |= {(mark, place.joint)} if len(sides) == 2 else set()
    assert cut == wanted


def test_the_plumb_line_of_a_lifted_segment_runs_between_its_studs(single: Gridshell, lorry: Segmentation) -> None:
    shell = single.shells[0]
    matrix = frame_matrix(shell.placement)
    studs = {stud.mark: matrix[:3, :3] @ np.array(stud.frame.origin) + matrix[:3, 3] for stud in shell.studs}
    for segment in lorry.segments:
        assert len(segment.lifting.studs) == 3
        assert set(segment.lifting.studs) <= set(segment.parts)
        corners = np.array([studs[mark] for mark in segment.lifting.studs])
        shares = np.linalg.solve(np.vstack([corners[:, :2].T, np.ones(3)]), [*segment.centre[:2], 1.0])
        assert np.all(shares > 0.0)
        assert segment.lifting.above == (shares @ corners[:, 2] > segment.centre[2])


def test_the_centres_of_gravity_of_the_segments_make_that_of_the_shell(
    single: Gridshell, item: Divisible, lorry: Segmentation
) -> None:
    whole = segments(single, WIDE).segments[0]
    masses = [segment.mass for segment in lorry.segments]
    joined = np.average([segment.centre for segment in lorry.segments], axis=0, weights=masses)
    # Coupling blocks that splices replace and the fasteners put in on site shift it a little.
    assert joined == pytest.approx(np.array(whole.centre), abs=40.0)
    small = {part.mark: part for part in shell_parts(item.shell)}
    assert whole.mass == pytest.approx(sum(mass(small[mark], single.timber) for mark in whole.parts), rel=1e-12)


def test_bare_beam_ends_get_a_bar_and_few_geodesics_two_diagonals(single: Gridshell) -> None:
    plan = segments(single, by_mass(80.0))
    bare = 0
    for segment in plan.segments:
        kinds = Counter(brace.kind for brace in segment.braces)
        sides = 1 if segment.name in ("S1.1", f"S1.{len(plan.segments)}") else 2
        assert kinds["tie"] == sides
        assert kinds["diagonal"] == (2 if len(segment.geodesics) < 3 else 0)
        bare += kinds["bar"]
    # Of the two sides of every cut one keeps the geodesic.
    assert bare == len(plan.segments) - 1


def test_a_narrow_lorry_says_what_must_change_and_what_it_says_is_enough(single: Gridshell, item: Divisible) -> None:
    plan = segments(single, NARROW)
    assert len(plan.segments) == 4
    (change,) = plan.changes
    assert (change.code, change.severity, change.mark) == ("AAG961", "warning", "S1")
    assert "does not fit 12000 x 2400 x 2400 mm and 3000 kg whole: it is cut into 4 along" in change.text
    assert change.found > change.allowed == 2400.0
    width = float(change.text.partition("transport.width = ")[2].split()[0])
    height = float(change.text.partition("transport.height = ")[2].split()[0])
    for limits in (replace(NARROW, width=width), replace(NARROW, height=height)):
        assert best_stops(item, limits) == ()


def test_a_crane_too_weak_for_one_geodesic_with_its_beams_is_a_problem(single: Gridshell) -> None:
    plan = segments(single, replace(WIDE, crane=10.0))
    (segment,) = plan.segments
    assert not segment.fits
    assert segment.over[1] < 0.0 < segment.over[3]
    (problem,) = segment_findings(plan)
    assert (problem.code, problem.severity, problem.mark, problem.unit) == ("AAG962", "error", "S1", "kg")
    assert problem.found > problem.allowed == 10.0
    assert "no cuts along its geodesics make it fit 12000 x 4000 x 4000 mm and 10 kg" in problem.text
    assert "alone with the beams beside it takes" in problem.text
    assert f"it travels whole with a load of {math.ceil(segment.mass)} kg" in problem.text


def test_a_box_shorter_than_the_geodesics_is_a_problem(item: Divisible) -> None:
    assert best_stops(item, Limits(1000.0, 1000.0, 1000.0, 3000.0)) is None


def test_a_closed_ring_is_opened_by_two_cuts_at_least(column: Gridshell) -> None:
    plan = segments(column, by_mass(400.0))
    assert len(plan.segments) == 2
    owned = [mark for segment in plan.segments for mark in segment.geodesics]
    assert sorted(owned) == sorted(p.mark for p in column.shells[0].planks if p.family == "G")
    check_each_part_once(column, plan)
    whole = stretch_between(divisible(column.shells[0], column.timber), 2, 2 + 2 * 24)
    assert not whole.pieces
    # The centre of gravity of a closed ring is on its axis; bolts and screws are turned to one side, which is little.
    assert whole.centre[:2] == pytest.approx((0.0, 0.0), abs=5.0)


def test_corners_reach_as_far_as_the_meshes_of_all_that_travels(single: Gridshell, item: Divisible) -> None:
    stretch = stretch_between(item, 2, 29)
    meshes = [shell_mesh(part).vertices for part in shell_parts(single.shells[0]) if part.mark in set(stretch.parts)]
    points = np.concatenate(meshes)
    # Both sample planks, at 60 and at 120 mm: the sagitta of 120 mm at 1.7 m is 1.1 mm.
    assert stretch.corners.min(axis=0) == pytest.approx(points.min(axis=0), abs=1.1)
    assert stretch.corners.max(axis=0) == pytest.approx(points.max(axis=0), abs=1.1)


def test_the_shipped_transport_carries_the_shells_whole(design: Design, gridshell: Gridshell) -> None:
    """A wide load of 4.6 m: the 2.6 m high lorry takes each shell, of the paper's weight, as it is (section 3.2)."""
    shipped = design.transport
    assert shipped is not None
    plan = segments(gridshell, Limits(shipped.length, shipped.width, shipped.height, shipped.mass, shipped.crane))
    assert [segment.name for segment in plan.segments] == ["S1", "S2", "S3"]
    assert segment_findings(plan) == ()
    for segment in plan.segments:
        assert segment.timber == pytest.approx(300.0, rel=0.1)
        assert segment.mass == pytest.approx(330.0, rel=0.05)
        assert segment.props == ()
        assert all(over <= 0.0 for over in segment.over)


def test_without_a_transport_nothing_is_cut(single: Gridshell) -> None:
    plan = segments(single, Limits(*(4 * (math.inf,))))
    (segment,) = plan.segments
    assert segment.fits
    assert segment_findings(plan) == ()
    assert all(math.isfinite(size) for size in segment.pose.size)


def test_what_a_crane_cannot_lift_is_cut_though_the_lorry_would_carry_it(single: Gridshell) -> None:
    plan = segments(single, replace(WIDE, crane=200.0))
    assert len(plan.segments) == 2
    assert all(segment.mass <= 200.0 for segment in plan.segments)
    (change,) = plan.changes
    assert (change.unit, change.allowed) == ("kg", 200.0)


@pytest.mark.parametrize(
    ("text", "limits"),
    [
        ("12000x2400x2400", Limits(12000.0, 2400.0, 2400.0, math.inf)),
        ("12000x2400x2400x3000", Limits(12000.0, 2400.0, 2400.0, 3000.0)),
        (" 12000 x 2400 X 2400\u00d73000 x 500.5", Limits(12000.0, 2400.0, 2400.0, 3000.0, 500.5)),
    ],
)
def test_a_transport_is_written_by_its_sizes(text: str, limits: Limits) -> None:
    assert limits_from(text) == limits


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("12000x2400", "2 numbers, allowed 3 to 5"),
        ("1x2x3x4x5x6", "6 numbers, allowed 3 to 5"),
        ("12000xtwox2400", "width = 'two' is no number"),
        ("12000x2400x0", "height = 0, allowed more than 0"),
        ("12000x2400x2400xnan", "mass = nan, allowed more than 0"),
        ("12000x2400x2400x3000x-5", "crane = -5, allowed more than 0"),
    ],
)
def test_a_transport_that_cannot_be_read_is_refused_with_an_example(text: str, complaint: str) -> None:
    with pytest.raises(PlanError, match=r"--transport .*" + re.escape(complaint)) as refused:
        limits_from(text)
    assert "12000x2400x2400x3000" in str(refused.value)


def test_splices_without_room_are_findings_with_both_figures(lorry: Segmentation) -> None:
    block = next(splice for splice in lorry.splices if splice.kind == "block")
    plate = next(splice for splice in lorry.splices if splice.kind == "plate")
    assert splice_finding(block) is None
    for splice, found, allowed in (
        (replace(block, required=1000.0), block.clear, 1000.0),
        (replace(block, room=150.0), 150.0, block.reach),
        (replace(plate, required=1000.0), plate.clear, 1000.0),
    ):
        told = splice_finding(splice)
        assert told is not None
        assert (told.code, told.severity, told.mark) == ("AAG964", "error", splice.member)
        assert (told.found, told.allowed) == (found, allowed)
        assert printed(told.remedy, "de") != printed(told.remedy, "en")


def test_a_narrow_last_segment_cannot_be_slung_by_three_joints(single: Gridshell) -> None:
    (problem,) = segments(single, NARROW).problems
    assert (problem.code, problem.severity, problem.mark) == ("AAG963", "warning", "S1.4")
    assert problem.found < problem.allowed == 100.0
