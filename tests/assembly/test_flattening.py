"""The shell laid flat: distances hold, plane nets come back as they are, and what cannot hold is said."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from aag_cad.design import load_design
from aag_cad.families import Family
from aag_cad.geometry.framed import FramedCurve
from aag_cad.language import printed
from aag_cad.parts.forms import UNMOVED, Blank, CrossSection
from aag_cad.parts.model import Beam, Gridshell, Joint, JointKind, JointStation, Plank, Shell, Stud
from aag_cad.pipeline import gridshell_of
from aag_cad.units import Floats, vector
from assembly.base.errors import PlanError
from assembly.laying.flattening import LENGTH_LIMIT, FlatMember, FlatState, flat_findings, flat_state, outline_of
from assembly.laying.net import is_ring, shell_net
from assembly.laying.terms import Residuals, bending, net_arrays, sideways, started, stretch, turning

UP = np.array([0.0, 0.0, 1.0])


def curve_through(points: Floats, stations: Floats) -> FramedCurve:
    return FramedCurve(stations, points, np.tile(UP, (len(points), 1)))


def straight(start: Floats, end: Floats) -> FramedCurve:
    shares = np.linspace(0.0, 1.0, 13)[:, None]
    return curve_through(start + shares * (end - start), shares[:, 0] * float(np.linalg.norm(end - start)))


def arc(centre: Floats, radius: float, start: float, end: float) -> FramedCurve:
    angles = np.linspace(start, end, 61)
    points = centre + radius * np.column_stack([np.cos(angles), np.sin(angles), np.zeros(61)])
    return curve_through(points, radius * np.abs(angles - start))


def plane_shell(
    lower: list[FramedCurve],
    upper: list[FramedCurve],
    across: list[FramedCurve],
    crossings: list[tuple[str, str, Floats]],
) -> Shell:
    """Return a shell in the plane z = 0 of lower and upper beams and geodesics, and where they cross by mark."""
    curves: dict[str, tuple[FramedCurve, Family, int]] = {}
    families: tuple[tuple[Family, int, list[FramedCurve]], ...] = (
        ("A1", -1, lower),
        ("A2", 1, upper),
        ("G", 0, across),
    )
    for family, layer, found in families:
        curves |= {f"S1-{family}-{i:02d}": (curve, family, layer) for i, curve in enumerate(found, start=1)}
    stations: dict[str, list[JointStation]] = {mark: [] for mark in curves}
    joints, studs = [], []
    for i, (a, b, point) in enumerate(crossings, start=1):
        kind: JointKind = "AG" if "-G-" in b else "AA"
        mark = f"S1-{'K' if kind == 'AG' else 'N'}-{i:03d}"
        planks = [name for beam in (a, b) for name in ([beam] if "-G-" in beam else [f"{beam}-L", f"{beam}-R"])]
        joints.append(Joint(mark, kind, vector(point), vector(UP), tuple(planks), ()))
        if kind == "AA":
            studs.append(Stud(mark, replace(UNMOVED, origin=vector(point)), 220.0, 24.0, ()))
        for member in (a, b):
            curve = curves[member][0]
            fine = np.linspace(0.0, curve.length, 200_001)
            near = np.linalg.norm(curve.point_spline(fine) - point, axis=1).argmin()
            stations[member].append(JointStation(mark, float(fine[near])))
    beams, planks_made = [], []
    section = CrossSection(100.0, 12.0)
    for mark, (curve, family, layer) in curves.items():
        places = tuple(sorted(stations[mark], key=lambda place: place.station))
        blank = Blank(curve.length, section, ())
        if family == "G":
            planks_made.append(Plank(mark, family, 0, False, "", curve, blank, places))
            continue
        beams.append(Beam(mark, family, layer, (f"{mark}-L", f"{mark}-R"), curve, places))
        for side, away in (("L", 18.0), ("R", -18.0)):
            beside = curve_through(curve.points + away * np.array([0.0, 1.0, 0.0]), curve.stations)
            planks_made.append(Plank(f"{mark}-{side}", family, layer, True, mark, beside, blank, ()))
    return Shell("S1", UNMOVED, tuple(planks_made), tuple(beams), tuple(studs), (), (), (), tuple(joints))


def kagome_plane(rows: int = 4) -> Shell:
    """Return a plane tri-hex lattice: beams at +-30 degrees, upright geodesics through the middles between studs."""
    step = 300.0
    first, second = np.array([np.sqrt(0.75), 0.5, 0.0]), np.array([-np.sqrt(0.75), 0.5, 0.0])

    def at(i: float, j: float) -> Floats:
        return step * (i * first + j * second)

    far = rows - 1 + 0.75
    lower = [straight(at(-0.75, j), at(far, j)) for j in range(rows)]
    upper = [straight(at(i, -0.75), at(i, far)) for i in range(rows)]
    crossings = [
        (f"S1-A1-{j + 1:02d}", f"S1-A2-{i + 1:02d}", at(i, j)) for i, j in itertools.product(range(rows), repeat=2)
    ]
    lines = [k + 0.5 for k in range(1 - rows, rows - 1)]
    across = [
        straight(at(k, 0.0) * [1.0, 0.0, 0.0] - 200.0 * np.eye(3)[1], at(k, 0.0) * [1, 0, 0] + 1500.0 * np.eye(3)[1])
        for k in lines
    ]
    for number, k in enumerate(lines, start=1):
        for n in range(rows):
            if 0 <= n + k <= rows - 1:
                crossings.append((f"S1-A1-{n + 1:02d}", f"S1-G-{number:02d}", at(n + k, n)))
            if 0 <= n - k <= rows - 1:
                crossings.append((f"S1-A2-{n + 1:02d}", f"S1-G-{number:02d}", at(n, n - k)))
    return plane_shell(lower, upper, across, crossings)


def arcs_plane() -> Shell:
    """Return two families of equal circles in the plane, centred left and right on the x axis."""
    radius, left, right = 6000.0, (-5000.0, -4400.0, -3800.0), (3700.0, 4300.0, 4900.0)
    lower = [arc(np.array([a, 0.0, 0.0]), radius, 1.2, 0.4) for a in left]
    upper = [arc(np.array([b, 0.0, 0.0]), radius, np.pi - 0.4, np.pi - 1.2) for b in right]
    crossings = [
        (f"S1-A1-{i:02d}", f"S1-A2-{j:02d}", np.array([(a + b) / 2.0, np.sqrt(radius**2 - (b - a) ** 2 / 4.0), 0.0]))
        for i, a in enumerate(left, start=1)
        for j, b in enumerate(right, start=1)
    ]
    return plane_shell(lower, upper, [], crossings)


@pytest.fixture(scope="module")
def state(shell: Shell) -> FlatState:
    return flat_state(shell)


@pytest.fixture(scope="module")
def column() -> Shell:
    return gridshell_of(load_design("column")).shells[0]


def member_of(state: FlatState, mark: str) -> FlatMember:
    return next(member for member in state.members if member.mark == mark)


@pytest.mark.parametrize("made", [kagome_plane, arcs_plane])
def test_a_plane_net_comes_back_as_it_is(made: object) -> None:
    shell = kagome_plane() if made is kagome_plane else arcs_plane()
    state = flat_state(shell)
    points = {joint.mark: np.array(joint.point)[:2] for joint in shell.joints}
    moves = np.array([state.studs[mark] - points[mark] for mark in state.studs])
    # Stations were looked up on a lattice of 0.03 mm and curves are splines through samples: 0.1 mm.
    assert np.ptp(moves, axis=0) == pytest.approx([0.0, 0.0], abs=0.1)
    assert max(abs(turn) for turn in state.turns.values()) < np.radians(0.05)
    assert state.aside < 0.1
    assert state.length_error < 0.05
    assert state.radius > 100.0 * 6000.0


def test_the_holes_of_every_beam_stay_as_far_apart_as_they_were_drilled(state: FlatState) -> None:
    beams = [member for member in state.members if member.layer]
    assert len(beams) == 22
    for member in beams:
        between = np.linalg.norm(np.diff(member.points, axis=0), axis=1)
        # The chord of a bay of 0.5 m at a radius of 5 m is 0.2 mm shorter than its arc.
        assert between == pytest.approx(np.diff(member.stations), abs=0.25), member.mark
    assert state.length_error < LENGTH_LIMIT / 5.0


def test_beams_that_share_a_stud_meet_on_the_floor(shell: Shell, state: FlatState) -> None:
    assert set(state.studs) == {stud.mark for stud in shell.studs}
    places: dict[str, list[Floats]] = {mark: [] for mark in state.studs}
    for member in state.members:
        for joint, point in zip(member.joints, member.points, strict=True):
            if joint in places:
                places[joint].append(point)
    for mark, (lower, upper) in places.items():
        assert lower == pytest.approx(upper)
        assert state.studs[mark] == pytest.approx(lower)


def test_nodes_turn_slightly_as_in_the_paper(state: FlatState) -> None:
    # Section 3.2: "AA-joints slightly rotate into the final 60 degree angle"; it is 120 from lower to upper.
    turns = np.degrees(list(state.turns.values()))
    assert np.abs(turns).max() < 8.0
    assert abs(turns.mean()) < 1.5
    headings: dict[str, list[float]] = {mark: [] for mark in state.studs}
    for member in state.members:
        for i, joint in enumerate(member.joints):
            if joint in headings:
                way = member.points[i + 1] - member.points[i - 1]
                headings[joint].append(float(np.degrees(np.arctan2(way[1], way[0]))))
    for mark, (lower, upper) in headings.items():
        flat = (upper - lower) % 360.0
        # Lines through neighbouring points lean up to 0.2 degrees against the beams; beams of two layers of a shell
        # cross at 120 degrees within 0.3.
        assert flat == pytest.approx(240.0 + np.degrees(state.turns[mark]), abs=0.5)


def test_geodesics_are_straight_planks_of_their_length_near_all_their_crossings(shell: Shell, state: FlatState) -> None:
    for plank in (plank for plank in shell.planks if plank.family == "G"):
        member = member_of(state, plank.mark)
        way = member.points[1] - member.points[0]
        assert float(np.linalg.norm(way)) == pytest.approx(plank.curve.length)
        left = np.array([-way[1], way[0]]) / plank.curve.length
        aside = [
            float((state.crossings[j.joint] - member.points[0]) @ left)
            for j in plank.joints
            if j.joint in state.crossings
        ]
        assert len(aside) >= 5
        # Every block lies at least partly under its geodesic, which is 100 mm wide.
        assert max(map(abs, aside)) <= state.aside + 1e-9 < 50.0
        assert member.shift <= state.shift < 150.0
    assert state.clearance > 50.0


def test_a_symmetric_shell_lies_symmetrically(state: FlatState) -> None:
    studs = np.array(list(state.studs.values()))
    mirrored = np.array([state.size[0], 0.0]) + studs * [-1.0, 1.0]
    nearest = np.linalg.norm(studs[:, None] - mirrored[None], axis=2).min(axis=1)
    # The mirror takes lower beams to upper ones, whose curves run 112 mm farther out and are not quite as long.
    assert nearest.max() < 20.0


def test_the_foot_lies_along_the_bottom_of_the_floor(state: FlatState) -> None:
    feet = np.array(list(state.foot.values()))
    assert len(feet) == 14
    assert feet[:, 1].max() < 0.12 * state.size[1]
    for member in state.members:
        outline = outline_of(member)
        assert outline.min() > -1e-6
        assert (outline <= np.array(state.size) + 1e-6).all()


def test_the_same_shell_gives_the_same_state(shell: Shell, state: FlatState) -> None:
    again = flat_state(shell)
    assert all(np.array_equal(a.points, b.points) for a, b in zip(state.members, again.members, strict=True))
    assert again.turns == state.turns


@pytest.mark.parametrize("name", ["stretch", "bending", "turning", "sideways"])
def test_jacobians_agree_with_finite_differences(name: str) -> None:
    terms = {"stretch": stretch, "bending": bending, "turning": turning, "sideways": sideways}
    net = shell_net(kagome_plane())
    arrays = net_arrays(net)
    random = np.random.default_rng(7)
    unknowns = started(net) + 0.01 * random.standard_normal(len(started(net))) * 300.0
    unknowns[2 * arrays.points :: 2] = started(net)[2 * arrays.points :: 2] + 0.05
    step = 1e-5
    for _ in range(5):
        way = random.standard_normal(len(unknowns))
        way[2 * arrays.points :: 2] /= 300.0
        found: Residuals = terms[name](arrays, unknowns)
        ahead, behind = (terms[name](arrays, unknowns + side * step * way).values for side in (1.0, -1.0))
        assert found.jacobian @ way == pytest.approx((ahead - behind) / (2.0 * step), rel=1e-5, abs=1e-7)


def test_a_ring_is_cut_open_and_says_what_stays_open(column: Shell, shell: Shell) -> None:
    assert is_ring(column)
    assert not is_ring(shell)
    state = flat_state(column)
    studs = {stud.mark for stud in column.studs}
    assert state.left_open
    assert set(state.studs) == studs - set(state.left_open)
    assert state.view_origin is None
    codes = [finding.code for finding in flat_findings(column, state, gridshell_of(load_design("column")).timber)]
    assert "AAG974" in codes
    # So narrow a waist cannot be spread flat without bending the beams beyond their strength.
    assert "AAG972" in codes


def test_the_vault_can_be_laid_flat_if_its_bolts_have_play(
    gridshell: Gridshell, shell: Shell, state: FlatState
) -> None:
    assert flat_findings(shell, state, gridshell.timber) == ()
    assert state.radius < state.eased_radius
    stiff = replace(state, eased_radius=state.radius)
    (finding,) = flat_findings(shell, stiff, gridshell.timber)
    assert finding.code == "AAG972"
    # Two planks of 12 mm with 24 mm between them: the outer faces are 24 mm from the middle.
    assert finding.found == pytest.approx(gridshell.timber.modulus * 24.0 / state.radius)
    assert printed(finding.what, "de") != printed(finding.what, "en")


def test_a_geodesic_that_meets_a_stud_is_found(gridshell: Gridshell, shell: Shell, state: FlatState) -> None:
    (finding,) = flat_findings(shell, replace(state, clearance=-3.0), gridshell.timber)
    assert (finding.code, finding.found) == ("AAG973", -3.0)
    (finding,) = flat_findings(shell, replace(state, length_error=0.7), gridshell.timber)
    assert (finding.code, finding.severity) == ("AAG971", "error")


def test_a_shell_without_studs_cannot_be_laid_flat(shell: Shell) -> None:
    with pytest.raises(PlanError, match="S1"):
        flat_state(replace(shell, joints=tuple(joint for joint in shell.joints if joint.kind != "AA")))
