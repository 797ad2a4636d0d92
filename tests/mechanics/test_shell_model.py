"""A shell as a frame: coupled beams against Vierendeel's closed form, scissor grids against rigid bodies on pins."""

from dataclasses import replace
from itertools import pairwise, product

import numpy as np
import pytest
from frame_modes import lowest_eigenvalues

from aag_cad.geometry.framed import FramedCurve, framed_curve
from aag_cad.mechanics.frame.model import FrameError, NodalLoad, Support, rectangle_section
from aag_cad.mechanics.frame.shell import SHORTEST_END, ShellFrame, shell_frame
from aag_cad.mechanics.frame.statics import static_solution
from aag_cad.parts.forms import Blank, CrossSection, Frame
from aag_cad.parts.model import Beam, Gridshell, Joint, JointStation, Plank, Shell, Timber, shell_parts
from aag_cad.parts.quantities import mass
from aag_cad.units import Floats, Vector, vector

TIMBER = Timber("ash", "D50", 700.0, 14000.0, 880.0, 50.0, 4.5, 1700.0, 1e-3)
NORMAL: Vector = (0.0, 0.0, 1.0)
SECTION = CrossSection(100.0, 12.0)
EDGE = 600.0
ALONG = {"A1": np.array([1.0, 0.0, 0.0]), "A2": np.array([0.5, 0.75**0.5, 0.0])}
HEIGHT = {"A1": -56.0, "G": 0.0, "A2": 56.0}
# What is kinematically free comes out at rounding, 1e-8 of the first elastic mode at most.
FREE = 1e-5


def straight(start: Floats, end: Floats) -> FramedCurve:
    length = float(np.linalg.norm(end - start))

    def evaluate(t: Floats) -> tuple[Floats, Floats]:
        return start + np.outer(t / length, end - start), np.tile(NORMAL, (len(t), 1))

    return framed_curve(evaluate, 0.0, length, length)


def flat_beam(mark: str, curve: FramedCurve, joints: list[tuple[str, Floats]]) -> tuple[Beam, list[Plank]]:
    family = "A1" if "A1" in mark else "A2"
    layer = -1 if family == "A1" else 1
    start, end = curve.points[0], curve.points[-1]
    across = np.cross(NORMAL, (end - start) / curve.length)
    stations = tuple(
        sorted((JointStation(m, float(np.linalg.norm(p - start))) for m, p in joints), key=lambda j: j.station)
    )
    planks = [
        Plank(f"{mark}-{side}", family, layer, True, mark, line, Blank(line.length, SECTION, ()), ())
        for side, arm in (("L", 18.0), ("R", -18.0))
        for line in [straight(start + arm * across, end + arm * across)]
    ]
    return Beam(mark, family, layer, (planks[0].mark, planks[1].mark), curve, stations), planks


def at(u: float, v: float, family: str) -> Floats:
    """Return the point of the flat rhombic grid at u along A1 and v along A2, in the layer of a family."""
    return np.asarray(EDGE * (u * ALONG["A1"] + v * ALONG["A2"]) + np.array([0.0, 0.0, HEIGHT[family]]))


def flat_grid(count: int, diagonals: list[float]) -> Shell:
    """Return a flat grid of count + count beams with a stud at each crossing, and geodesics along u + v = diagonal.

    The geodesics cross the beams between studs, as in the tri-hex.
    """
    inside = range(count)
    places: dict[str, tuple[float, float, str, str]] = {}
    for number, (i, j) in enumerate(product(inside, inside), start=1):
        places[f"S1-N-{number:03d}"] = (float(i), float(j), f"S1-A1-{j + 1:02d}", f"S1-A2-{i + 1:02d}")
    for g, diagonal in enumerate(diagonals, start=1):
        for family, i in product(("A1", "A2"), inside):
            other = diagonal - i
            if 0.0 < other < count - 1:
                u, v = (other, float(i)) if family == "A1" else (float(i), other)
                mark = f"S1-K-{len(places) + 1:03d}"
                places[mark] = (u, v, f"S1-{family}-{i + 1:02d}", f"S1-G-{g:02d}")
    beams, planks = [], []
    for family, i in product(("A1", "A2"), inside):
        name = f"S1-{family}-{i + 1:02d}"
        ends = [(-0.1, float(i)), (count - 0.9, float(i))]
        ends = ends if family == "A1" else [(v, u) for u, v in ends]
        on = [(m, at(u, v, family)) for m, (u, v, *names) in places.items() if name in names]
        beam, siblings = flat_beam(name, straight(at(*ends[0], family), at(*ends[1], family)), on)
        beams.append(beam)
        planks += siblings
    for g, diagonal in enumerate(diagonals, start=1):
        on = sorted(
            ((u, m) for m, (u, _, *names) in places.items() if f"S1-G-{g:02d}" in names), key=lambda item: item[0]
        )
        first, last = on[0][0] - 0.3, on[-1][0] + 0.3
        line = straight(at(first, diagonal - first, "G"), at(last, diagonal - last, "G"))
        stations = tuple(JointStation(m, EDGE * (u - first)) for u, m in on)
        planks.append(Plank(f"S1-G-{g:02d}", "G", 0, False, "", line, Blank(line.length, SECTION, ()), stations))
    joints = tuple(
        Joint(m, "AA" if "-N-" in m else "AG", vector(at(u, v, "G")), NORMAL, (f"{a}-L", f"{a}-R", *named), ())
        for m, (u, v, a, b) in places.items()
        for named in [(f"{b}-L", f"{b}-R") if "-A2-" in b else (b,)]
    )
    frame = Frame((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), NORMAL)
    return Shell("S1", frame, tuple(planks), tuple(beams), (), (), (), (), joints)


def free_motions(frame: ShellFrame) -> int:
    """Return how many modes of a frame without supports have no stiffness, by the eigenvalues of the engine."""
    found = lowest_eigenvalues(frame.model, 20, np.ones(len(frame.model.nodes)))
    return int(np.sum(found < FREE * found[-1]))


def rigid_body_motions(shell: Shell, fixed: set[str]) -> int:
    """Return the nullity, by dense SVD, of members as rigid bodies (6 each) and pins about the normal (5 rows)."""
    bodies = [beam.mark for beam in shell.beams] + sorted(fixed)
    home = {plank.mark: plank.beam or plank.mark for plank in shell.planks}
    rows = []
    for joint in shell.joints:
        met = [name for name in dict.fromkeys(home[m] for m in joint.members) if name in bodies]
        for one, other in pairwise(met):
            block = np.zeros((5, len(bodies), 6))
            for name, sign in ((one, 1.0), (other, -1.0)):
                k = bodies.index(name)
                for axis, unit in enumerate(np.eye(3)):
                    block[axis, k, :3], block[axis, k, 3:] = sign * unit, sign * np.cross(joint.point, unit) / EDGE
                block[3, k, 3], block[4, k, 4] = sign, sign
            rows.append(block.reshape(5, -1))
    singular = np.linalg.svd(np.concatenate(rows), compute_uv=False)
    return 6 * len(bodies) - int(np.sum(singular > 1e-9 * singular[0]))


@pytest.mark.parametrize(("count", "fixed"), [(2, 0), (3, 0), (3, 1), (4, 0), (4, 2)])
def test_a_flat_grid_moves_as_rigid_bodies_on_pins_until_a_geodesic_locks_it(count: int, fixed: int) -> None:
    """Rhombic scissors have one motion beside the six of the whole; a single geodesic across takes it."""
    shell = flat_grid(count, [count - 1.5, count - 0.5])
    screwed = {f"S1-G-{g:02d}" for g in range(1, fixed + 1)}
    found = free_motions(shell_frame(shell, TIMBER, fixed=screwed))
    assert found == rigid_body_motions(shell, screwed)
    assert found == (6 if fixed else 7)


def test_tightened_bolts_lock_the_scissors_without_geodesics() -> None:
    assert free_motions(shell_frame(flat_grid(3, [1.5]), TIMBER, fixed=(), tight=True)) == 6


def test_a_scissor_grid_held_at_its_feet_is_refused_with_the_name_of_a_free_node() -> None:
    frame = shell_frame(flat_grid(3, [1.5]), TIMBER, fixed=())
    held = replace(frame.model, supports=(Support("S1-A1-01 at S1-N-001"),))
    with pytest.raises(FrameError, match=r"^S1-A\d-\d\d at S1-[NK]-\d{3}: the frame is a mechanism"):
        static_solution(held, (NodalLoad("S1-A1-03 at S1-N-009", (0.0, 1.0, 0.0)),))


def test_a_coupled_beam_bends_sideways_like_a_vierendeel_girder() -> None:
    """Bays of length a, rigid blocks: F a sum(d2) / EI_c + n F a3 / (24 E I), d from a bay's middle to the tip.

    EI_c = 2 E I + 2 E A (18 mm)2 for the pair, E I for each plank between the blocks.
    """
    count, force = 6, 10.0
    shell = flat_grid(count, [])
    frame = shell_frame(replace(shell, beams=shell.beams[:1]), TIMBER, fixed=())
    nodes = [node.mark for node in frame.model.nodes]
    held = replace(frame.model, supports=(Support(nodes[0]),))
    tip = static_solution(held, (NodalLoad(nodes[-1], (0.0, force, 0.0)),)).displacements[-1, 1]
    plank, bays = rectangle_section(100.0, 12.0), count - 1
    local = TIMBER.modulus * plank.inertia_z
    coupled = 2.0 * local + 2.0 * TIMBER.modulus * plank.area * 18.0**2
    arms = EDGE * (np.arange(bays) + 0.5)
    expected = force * EDGE * np.sum(arms**2) / coupled + bays * force * EDGE**3 / (24.0 * local)
    assert tip == pytest.approx(expected, rel=1e-6)


def test_a_coupled_beam_bends_along_the_normal_like_two_upright_planks() -> None:
    count, force = 4, 10.0
    shell = flat_grid(count, [])
    frame = shell_frame(replace(shell, beams=shell.beams[:1]), TIMBER, fixed=())
    nodes = [node.mark for node in frame.model.nodes]
    held = replace(frame.model, supports=(Support(nodes[0]),))
    tip = static_solution(held, (NodalLoad(nodes[-1], (0.0, 0.0, force)),)).displacements[-1, 2]
    rigidity = 2.0 * TIMBER.modulus * 12.0 * 100.0**3 / 12.0
    assert tip == pytest.approx(force * (EDGE * (count - 1)) ** 3 / (3.0 * rigidity), rel=1e-6)


def test_beam_ends_shorter_than_120_mm_past_the_last_joint_are_left_out(gridshell: Gridshell) -> None:
    shell = gridshell.shells[0]
    points = {node.mark: np.array(node.point) for node in shell_frame(shell, gridshell.timber).model.nodes}
    for beam in shell.beams:
        on = [point for mark, point in points.items() if mark.startswith(f"{beam.mark} at ")]
        for inner, outer in ((on[1], on[0]), (on[-2], on[-1])):
            assert np.linalg.norm(outer - inner) > SHORTEST_END - 1.0


def test_the_nodes_carry_the_timber_and_steel_of_the_shell(gridshell: Gridshell) -> None:
    """All planks, studs, blocks, straps and their fasteners, whether a geodesic is fixed or not; no feet, no cover."""
    shell, timber = gridshell.shells[0], gridshell.timber
    joints = [joint for joint in shell.joints if joint.kind in ("AA", "AG", "boundary", "ridge")]
    named = {mark for joint in joints for mark in (*joint.members, *joint.fasteners)}
    expected = sum(mass(part, timber) for part in shell_parts(shell) if part.mark in named)
    for fixed in ((), None):
        assert shell_frame(shell, timber, fixed=fixed).masses.sum() == pytest.approx(expected, rel=1e-9)


def test_studs_join_the_layers_over_112_mm_and_leave_the_turn_about_the_normal(gridshell: Gridshell) -> None:
    shell = gridshell.shells[0]
    frame = shell_frame(shell, gridshell.timber, fixed=())
    points = {node.mark: np.array(node.point) for node in frame.model.nodes}
    joints = {joint.mark: joint for joint in shell.joints}
    assert len(frame.model.links) == len(shell.studs)
    for link in frame.model.links:
        normal = joints[link.master.split(" at ")[1]].normal
        assert link.pin == normal
        # The layers are parallel surfaces 56 mm off, their own normals turn by less than a thousandth.
        assert points[link.slave] - points[link.master] == pytest.approx(112.0 * np.array(normal), abs=0.2)


def test_a_geodesic_is_in_the_frame_only_when_it_is_screwed_on(gridshell: Gridshell) -> None:
    shell = gridshell.shells[0]
    frame = shell_frame(shell, gridshell.timber, fixed=("S1-G-07",))
    flat = {member for member in frame.members if "-G-" in member or "-E-" in member}
    assert flat == {"S1-G-07"}
    crossings = [joint for joint in shell.joints if joint.kind == "AG" and "S1-G-07" in joint.members]
    assert len(frame.model.links) == len(shell.studs) + len(crossings)


def test_a_shell_without_beams_is_no_frame(gridshell: Gridshell) -> None:
    with pytest.raises(FrameError, match=r"^S1: none of its beams"):
        shell_frame(replace(gridshell.shells[0], beams=()), gridshell.timber)
