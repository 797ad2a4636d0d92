"""A segment with its temporary braces against closed forms, the force method by hand and a count of rigidity."""

import math
from dataclasses import replace

import numpy as np
import pytest

from aag_cad.mechanics.frame.model import FrameModel, FrameSection, NodalLoad, Spring, Support
from aag_cad.mechanics.frame.shell import shell_frame
from aag_cad.mechanics.frame.statics import static_solution
from aag_cad.mechanics.frame.system import against_unknowns, frame_system, full_stiffness
from aag_cad.parts.model import Gridshell, Shell, Timber
from aag_cad.units import Floats, Vector, vector
from assembly.base.errors import PlanError
from assembly.base.segments import Brace, Limits, Segment, Segmentation
from assembly.locking.model import GRAVITY
from assembly.locking.order import SAG_LIMIT
from assembly.transport.frame import braced_frame, segment_shell
from assembly.transport.segments import segments
from assembly.transport.stiffness import (
    SLING,
    SegmentHold,
    SegmentStiffness,
    Way,
    finished_lowest,
    segment_stiffness,
    segments_stiffness,
    stiffness_finding,
    stiffness_findings,
)

# The crane of 80 kg cuts each shell into five: of two, three, two, three and four geodesics.
CRANE = Limits(50000.0, 50000.0, 50000.0, 80.0)


@pytest.fixture(scope="module")
def plan(gridshell: Gridshell) -> Segmentation:
    return segments(gridshell, CRANE)


@pytest.fixture(scope="module")
def lowest(shell: Shell, timber: Timber) -> dict[Way, float]:
    return finished_lowest(shell, timber)


@pytest.fixture(scope="module")
def timber(gridshell: Gridshell) -> Timber:
    return gridshell.timber


@pytest.fixture(scope="module")
def found(gridshell: Gridshell, plan: Segmentation) -> dict[str, SegmentStiffness]:
    return {item.segment: item for item in segments_stiffness(gridshell, plan)}


def named(plan: Segmentation, name: str) -> Segment:
    return next(segment for segment in plan.segments if segment.name == name)


def hold_of(stiffness: SegmentStiffness, way: Way) -> SegmentHold:
    return next(hold for hold in stiffness.holds if hold.way == way)


def test_the_frame_of_a_segment_weighs_what_the_segment_weighs(
    shell: Shell, timber: Timber, plan: Segmentation
) -> None:
    for segment in plan.segments[:5]:
        frame = braced_frame(shell, timber, plan.splices, segment).frame
        # Pieces of edge planks on which no beam ends have no beam to weigh on: 0.8 of 23 kg at the ends.
        assert frame.masses.sum() == pytest.approx(segment.mass, rel=0.04)
        centre = np.average([node.point for node in frame.model.nodes], axis=0, weights=frame.masses)
        # 0.8 kg that are 2.4 m off, of 23.
        assert centre == pytest.approx(np.array(segment.centre), abs=100.0)


def test_two_pieces_of_one_beam_in_one_segment_are_two_beams(shell: Shell, timber: Timber, plan: Segmentation) -> None:
    one, other = named(plan, "S1.2"), named(plan, "S1.4")
    both = replace(one, parts=(*one.parts, *other.parts), pieces=(*one.pieces, *other.pieces))
    own = [segment_shell(shell, plan.splices, segment) for segment in (one, other, both)]
    assert len(own[2].beams) == len(own[0].beams) + len(own[1].beams)
    assert len({beam.mark for beam in own[2].beams}) == len(own[2].beams)
    assert len({plank.mark for plank in own[2].planks}) == len(own[2].planks)
    masses = [shell_frame(item, timber, tight=True).masses.sum() for item in own]
    assert masses[2] == pytest.approx(masses[0] + masses[1], rel=1e-9)


def test_eigenvalues_fall_when_a_brace_is_left_out(
    shell: Shell, timber: Timber, plan: Segmentation, found: dict[str, SegmentStiffness], lowest: dict[Way, float]
) -> None:
    """Courant's minimax principle, masses staying; and each brace is worth 1 % of some eigenvalue."""
    segment = named(plan, "S1.3")
    assert [brace.kind for brace in segment.braces] == ["bar", "tie", "bar", "tie", "diagonal", "diagonal"]
    for i in range(len(segment.braces)):
        less = replace(segment, braces=(*segment.braces[:i], *segment.braces[i + 1 :]))
        without = segment_stiffness(shell, timber, plan, less, finished=lowest)
        ratios = []
        for hold, full in zip(without.holds, found["S1.3"].holds, strict=True):
            assert not hold.buckled
            assert not full.buckled
            ratios += (np.array(hold.braced.eigenvalues) / full.braced.eigenvalues).tolist()
            assert hold.bare.eigenvalues == pytest.approx(full.bare.eigenvalues, rel=1e-6)
        assert max(ratios) < 1.0 + 1e-6
        assert min(ratios) < 0.99


def test_without_braces_and_with_loose_studs_a_segment_is_softer(
    shell: Shell, timber: Timber, plan: Segmentation, found: dict[str, SegmentStiffness], lowest: dict[Way, float]
) -> None:
    segment = named(plan, "S1.3")
    loose = segment_stiffness(shell, timber, plan, segment, finished=lowest, tight=False)
    for slack, full in zip(loose.holds, found["S1.3"].holds, strict=True):
        assert np.all(np.array(full.bare.eigenvalues) < full.braced.eigenvalues)
        assert np.all(np.array(slack.bare.eigenvalues) < full.bare.eigenvalues)
        assert np.all(np.array(slack.braced.eigenvalues) < full.braced.eigenvalues)
        assert full.bare.displacement > 3.0 * full.braced.displacement
        assert full.bare.soft_modes > full.braced.soft_modes


def hung_by_hand(model: FrameModel, masses: Floats, nodes: list[str]) -> tuple[FrameModel, tuple[NodalLoad, ...]]:
    """A frame on three upright slings and its self-weight, with loads and supports written out."""
    masters = {link.slave: link.master for link in model.links}
    roots = [masters.get(node, node) for node in nodes]
    assert not set(roots) & set(masters)
    pull = float(masses.sum()) * GRAVITY / 3.0 / SLING
    springs = tuple(Spring(node, way, pull) for node in roots for way in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    supports = tuple(Support(node, ("z",)) for node in roots)
    marks = [node.mark for node in model.nodes]
    weight = tuple(NodalLoad(m, (0.0, 0.0, -GRAVITY * kilos)) for m, kilos in zip(marks, masses.tolist(), strict=True))
    return replace(model, supports=supports, springs=springs), weight


def test_the_force_in_a_tie_is_that_of_the_force_method(
    shell: Shell, timber: Timber, plan: Segmentation, found: dict[str, SegmentStiffness]
) -> None:
    """One redundant: X = - (how far the studs part without it) / (how far X = 1 draws them together + L / EA)."""
    segment = named(plan, "S1.5")
    (tie,) = segment.braces
    frame = braced_frame(shell, timber, plan.splices, replace(segment, braces=())).frame
    hung = [frame.beam_nodes[mark][0] for mark in segment.lifting.studs]
    model, weight = hung_by_hand(frame.model, frame.masses, hung)
    points = {node.mark: np.array(node.point) for node in model.nodes}
    places = [node.mark for node in model.nodes]
    ends = {stud.mark: np.array(stud.frame.origin) for stud in shell.studs if stud.mark in (tie.start, tie.end)}
    length = float(np.linalg.norm(ends[tie.end] - ends[tie.start]))
    along = (ends[tie.end] - ends[tie.start]) / length

    def load(mark: str, force: Floats) -> NodalLoad:
        node = frame.beam_nodes[mark][0]
        return NodalLoad(node, vector(force), vector(np.cross(ends[mark] - points[node], force)))

    def parting(loads: tuple[NodalLoad, ...]) -> float:
        moved = static_solution(model, loads).displacements
        shifts = []
        for mark in (tie.start, tie.end):
            node = frame.beam_nodes[mark][0]
            at = moved[places.index(node)]
            shifts.append(at[:3] + np.cross(at[3:], ends[mark] - points[node]))
        return float((shifts[1] - shifts[0]) @ along)

    section = shell.planks[0].blank.section
    give = length / (timber.modulus * 2.0 * section.width * section.thickness)
    drawn = -parting((load(tie.start, along), load(tie.end, -along)))
    expected = parting(weight) / (drawn + give)
    hold = hold_of(found["S1.5"], "hung")
    assert expected < -50.0
    assert hold.forces[0] == pytest.approx(expected, rel=1e-6)
    bare = static_solution(model, weight).displacements
    on_beams = [places.index(node) for nodes in frame.beam_nodes.values() for node in nodes]
    assert hold.bare.displacement == pytest.approx(np.linalg.norm(bare[on_beams, :3], axis=1).max(), rel=1e-6)


def bars_and_pins(model: FrameModel) -> Floats:
    """Return what does not give, one row (6 n) each, if planks only keep their length and links are rigid."""
    place = {node.mark: i for i, node in enumerate(model.nodes)}
    points = np.array([node.point for node in model.nodes])
    unit_turn = 1.0 / 300.0
    rows: list[Floats] = []

    def add(*ends: tuple[str, float, Floats, Floats]) -> None:
        row = np.zeros((len(points), 6))
        for node, sign, way, turn in ends:
            row[place[node]] += sign * np.concatenate([way, turn * unit_turn])
        rows.append(row.ravel())

    for bar in model.elements:
        a, b = np.array(bar.start_offset), np.array(bar.end_offset)
        chord = points[place[bar.end]] + b - points[place[bar.start]] - a
        way = chord / np.linalg.norm(chord)
        add((bar.end, 1.0, way, np.cross(b, way)), (bar.start, -1.0, way, np.cross(a, way)))
    nothing = np.zeros(3)
    for link in model.links:
        arm = points[place[link.slave]] - points[place[link.master]]
        kept = np.eye(3) if link.pin is None else np.linalg.svd(np.array([link.pin]))[2][1:]
        for way in np.eye(3):
            add((link.slave, 1.0, way, nothing), (link.master, -1.0, way, np.cross(arm, way)))
        for axis in kept:
            add((link.slave, 1.0, nothing, axis / unit_turn), (link.master, -1.0, nothing, axis / unit_turn))
    return np.array(rows)


@pytest.mark.parametrize("kinds", [(), ("tie", "diagonal")])
def test_free_motions_are_those_of_bars_and_pins_when_bending_vanishes(
    shell: Shell, timber: Timber, plan: Segmentation, kinds: tuple[str, ...]
) -> None:
    """The segment of two geodesics at the end, in the air: six motions as a body, and what its bars leave free."""
    segment = named(plan, "S1.1")
    segment = replace(segment, braces=tuple(brace for brace in segment.braces if brace.kind in kinds))
    model = braced_frame(shell, timber, plan.splices, segment, tight=False).frame.model
    matrix = bars_and_pins(model)
    singular = np.linalg.svd(matrix, compute_uv=False)
    rank = int(np.sum(singular > 1e-9 * singular[0]))
    # A gap of five decades: no tolerance decides.
    assert singular[rank - 1] > 1e-4 * singular[0]
    weak = tuple(
        replace(bar, section=FrameSection(s.area, 1e-15 * s.torsion, 1e-15 * s.inertia_y, 1e-15 * s.inertia_z))
        for bar in model.elements
        for s in (bar.section,)
    )
    system = frame_system(replace(model, elements=weak))
    stiffness = against_unknowns(system, full_stiffness(system)).toarray()
    free = int(np.sum(np.linalg.eigvalsh(stiffness) < 1e-3))
    assert free == matrix.shape[1] - rank
    assert free > 6


def test_a_straight_brace_is_two_planks_and_buckles_as_euler_says(
    shell: Shell, timber: Timber, plan: Segmentation
) -> None:
    segment = named(plan, "S1.3")
    braced = braced_frame(shell, timber, plan.splices, segment)
    at: dict[str, Vector] = {stud.mark: stud.frame.origin for stud in shell.studs}
    for brace, force in zip(segment.braces, braced.euler.tolist(), strict=True):
        if brace.kind == "tie":
            # One plank flat and one on edge: 100 x 12 upright and lying, b h3 / 12 each.
            inertia = 12.0 * 100.0**3 / 12.0 + 100.0 * 12.0**3 / 12.0
            span = math.dist(at[brace.start], at[brace.end])
            assert brace.length == pytest.approx(span + 200.0, abs=0.1)
            assert force == pytest.approx(math.pi**2 * timber.modulus * inertia / span**2, rel=1e-12)
        assert math.isinf(force) == (brace.kind == "bar")


def test_a_brace_that_buckles_is_left_out(
    shell: Shell, timber: Timber, plan: Segmentation, lowest: dict[Way, float]
) -> None:
    """Of timber three hundred times as heavy the segment presses its tie beyond what it bears, and hangs without it."""
    segment, heavy = named(plan, "S1.5"), replace(timber, density=300.0 * timber.density)
    hold = hold_of(segment_stiffness(shell, heavy, plan, segment, finished=lowest), "hung")
    assert hold.buckled == (0,)
    assert hold.forces == (0.0,)
    assert hold.braced == hold.bare


def test_the_rule_leaves_no_soft_mode_in_what_hangs_and_keeps_all_within_the_limit(
    gridshell: Gridshell, plan: Segmentation, found: dict[str, SegmentStiffness], lowest: dict[Way, float]
) -> None:
    for item in found.values():
        for hold in item.holds:
            assert hold.threshold == pytest.approx(0.5 * lowest[hold.way], rel=1e-6)
            assert hold.way == "standing" or hold.braced.soft_modes == 0
            assert not hold.buckled
    assert found["S1.3"].displacement == pytest.approx(14.3, abs=0.5)
    assert hold_of(found["S1.3"], "hung").bare.displacement == pytest.approx(104.0, abs=3.0)
    one, own = replace(gridshell, shells=gridshell.shells[:1]), replace(plan, segments=plan.segments[3:5])
    assert stiffness_findings(one, own) == ()
    (finding,) = stiffness_findings(one, own, limit=5.0)
    assert (finding.mark, finding.allowed) == ("S1.5", 5.0)


def test_a_segment_that_sags_is_a_finding_with_its_remedy(
    shell: Shell, timber: Timber, plan: Segmentation, found: dict[str, SegmentStiffness], lowest: dict[Way, float]
) -> None:
    assert stiffness_finding(found["S1.3"]) is None
    bare = segment_stiffness(shell, timber, plan, replace(named(plan, "S1.3"), braces=()), finished=lowest)
    finding = stiffness_finding(bare)
    assert finding is not None
    worst = hold_of(bare, "hung").bare
    assert (finding.code, finding.severity, finding.mark, finding.unit) == ("AAG965", "warning", "S1.3", "mm")
    assert finding.found == worst.displacement > finding.allowed == SAG_LIMIT
    assert f"most at {worst.at}: sling it there as well, under a spreader" in finding.text


def test_a_segment_on_one_foot_is_free_to_move_and_said_to_be(
    shell: Shell, timber: Timber, plan: Segmentation, lowest: dict[Way, float]
) -> None:
    """Held in z at a single stud it turns about its foot: not a sag of so many mm, but a mechanism."""
    segment = named(plan, "S1.1")
    on_one = replace(segment, props=segment.props[:1], braces=())
    first = segment.geodesics[0]
    joints = tuple(j for j in shell.joints if j.kind != "foot" or first in j.members)
    stiffness = segment_stiffness(replace(shell, joints=joints), timber, plan, on_one, finished=lowest)
    finding = stiffness_finding(stiffness)
    assert finding is not None
    assert math.isinf(stiffness.displacement)
    assert (finding.found, finding.allowed) == (1.0, 0.0)
    assert "ways to move" in finding.text


def test_equal_segments_of_other_shells_have_equal_figures_and_their_own_marks(
    gridshell: Gridshell, plan: Segmentation, found: dict[str, SegmentStiffness], lowest: dict[Way, float]
) -> None:
    assert list(found) == [segment.name for segment in plan.segments]
    segment = named(plan, "S3.4")
    own = segment_stiffness(gridshell.shells[2], gridshell.timber, plan, segment, finished=lowest)
    for hold, copied in zip(own.holds, found["S3.4"].holds, strict=True):
        assert copied.joints == hold.joints
        assert copied.braced.at == hold.braced.at
        assert copied.braced.at.startswith("S3-")
        assert copied.braced.displacement == pytest.approx(hold.braced.displacement, rel=1e-6)
        assert copied.bare.eigenvalues == pytest.approx(hold.bare.eigenvalues, rel=1e-6)


def test_a_brace_to_a_joint_of_another_segment_is_an_error(shell: Shell, timber: Timber, plan: Segmentation) -> None:
    segment = named(plan, "S1.1")
    stray = named(plan, "S1.5").lifting.studs[0]
    wrong = replace(segment, braces=(Brace("tie", stray, segment.props[0], 1000.0),))
    with pytest.raises(PlanError, match=f"S1.1: its brace 1 .* no beam at {stray}"):
        segment_stiffness(shell, timber, plan, wrong, finished={"standing": 1.0})
