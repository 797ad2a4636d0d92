"""What the drilling of two sibling planks embeds: length differences, the shape the bolted pair springs to, its errors.

A coupled beam is two planks of thickness t whose middle planes lie s apart, bolted together at every stud and coupling
block. From one joint to the next their drilled distances differ by s times the angle that the beam turns in its own
layer (paper, section 3.2 and Fig. 7f). All plane figures here are those of the beam laid down: geodesic curvature kept,
twist and normal curvature left out. Derivations: docs/prefabrication.md.
"""

import math
from collections import defaultdict
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from aag_cad.errors import NetworkError
from aag_cad.geometry.framed import curvatures_at, frames_at, nearest_station
from aag_cad.geometry.surface import dot
from aag_cad.parts.forming import formed_points, plank_axes
from aag_cad.parts.forms import CrossSection
from aag_cad.parts.model import Beam, FlatBar
from aag_cad.units import Floats, Ints

# Plane curves are kept as complex numbers x + i y, mm.
PlaneCurve: TypeAlias = NDArray[np.complex128]

HOLE_ERROR = 0.3
_SPACING = 10.0
_GAUSS = np.polynomial.legendre.leggauss(4)


@dataclass(frozen=True, eq=False)
class CoupledPair:
    """The couplings of a beam in order: joints (m), where they sit on its curve and on both blanks; mm.

    ``left`` and ``right`` (m,) are the stations of the bolts on the planks' centre lines, ``holes`` (m,) how many bolt
    holes each plank has there, ``spacing`` the distance s of the planks' middle planes, ``section`` that of each plank.
    """

    beam: Beam
    joints: tuple[str, ...]
    stations: Floats
    left: Floats
    right: Floats
    holes: Ints
    spacing: float
    section: CrossSection

    @property
    def recovered(self) -> float:
        """The share of the drilled curvature that it keeps when it is released."""
        return recovered_share(self.spacing, self.section.thickness)


@dataclass(frozen=True)
class SprungShape:
    """How far a released pair is from its developed target curve, between its first and last coupling; mm.

    ``fitted`` is the largest distance after the best rigid motion. ``force`` is the largest axial force that is locked
    in the planks, N.
    """

    target_sagitta: float
    sagitta: float
    fitted: float
    force: float


@dataclass(frozen=True)
class HoleErrorEffect:
    """Standard deviations that independent errors of all holes leave in the sprung shape; mm and a share.

    ``middle`` is that of the sagitta at the middle, ``end`` that of the last coupling across the last tangent with the
    first tangent held, ``curvature`` that of the mean geodesic curvature from node to node, as a share of it (root mean
    square over the beam; infinite for a straight one).
    """

    middle: float
    end: float
    curvature: float


def recovered_share(spacing: float, thickness: float) -> float:
    """Return the share of the drilled curvature that a released pair keeps: 1 - 1 / (1 + 3 s^2 / t^2).

    Two planks of E I = E b t^3 / 12 and E A = E b t share the mismatch s (kappa_0 - kappa) of their strains; the least
    energy 2 E I kappa^2 / 2 + 2 E A (s (kappa_0 - kappa) / 2)^2 / 2 gives it. s = 36, t = 12: 27/28.
    """
    return 1.0 - 1.0 / (1.0 + 3.0 * spacing**2 / thickness**2)


def _centre_stations(beam: Beam, plank: FlatBar) -> dict[str, tuple[float, float, int]]:
    """Return for each joint the bolts' stations on the beam's curve and on the plank's centre line, and the holes.

    A bolt off the centre line of a twisted plank meets it later or sooner than on the centre line: by its offset times
    the slope between the beam's normal and the plank's length.
    """
    holes = [hole for hole in plank.blank.holes if hole.use == "bolt"]
    if not holes:
        return {}
    stations, offsets = np.array([h.station for h in holes]), np.array([h.offset for h in holes])
    points = formed_points(plank, np.column_stack([stations, offsets, np.zeros_like(stations)]))
    on_beam = nearest_station(beam.curve, points, stations)
    slope = dot(frames_at(beam.curve, on_beam).normal, plank_axes(plank, stations)[1])
    by_joint: dict[str, list[tuple[float, float]]] = defaultdict(list)
    for hole, at, centre in zip(holes, on_beam, stations - offsets * slope, strict=True):
        by_joint[hole.joint].append((float(at), float(centre)))
    return {joint: (*np.mean(found, axis=0).tolist(), len(found)) for joint, found in by_joint.items()}


def coupled_pair(beam: Beam, left: FlatBar, right: FlatBar) -> CoupledPair:
    """Return the couplings of a beam, read from the bolt holes of its two planks.

    NetworkError if fewer than two joints are drilled in both.
    """
    on_left, on_right = _centre_stations(beam, left), _centre_stations(beam, right)
    joints = sorted(set(on_left) & set(on_right), key=lambda joint: on_left[joint][0])
    if len(joints) < 2:
        raise NetworkError(
            f"{beam.mark}: {len(joints)} joints have bolt holes in both planks, at least 2 couple them; drill both "
            "planks for the same bolts"
        )
    gap = left.curve.points[0] - right.curve.points[0]
    return CoupledPair(
        beam=beam,
        joints=tuple(joints),
        stations=np.array([(on_left[j][0] + on_right[j][0]) / 2.0 for j in joints]),
        left=np.array([on_left[j][1] for j in joints]),
        right=np.array([on_right[j][1] for j in joints]),
        holes=np.array([on_left[j][2] for j in joints]),
        spacing=float(np.linalg.norm(gap)),
        section=left.blank.section,
    )


def geodesic_turn(beam: Beam, stations: Floats) -> Floats:
    """Return the integrals (m - 1,) of the geodesic curvature of a beam's curve between stations (m,), radians."""
    turn = np.zeros(len(stations) - 1)
    half = np.diff(stations) / 2.0
    pieces = max(1, int(np.ceil(2.0 * half.max() / _SPACING)))
    nodes, weights = _GAUSS
    along = 2.0 * np.arange(pieces)[:, None, None] + 1.0 + nodes
    at = stations[:-1, None] + half[:, None] * along / pieces
    for curvature in curvatures_at(beam.curve, at.ravel()).geodesic.reshape(at.shape):
        turn += half / pieces * (curvature @ weights)
    return turn


def node_indices(pair: CoupledPair) -> list[int]:
    """Return which couplings are studs: two bolts side by side hold the planks there, one in a block.

    All couplings if there is only one stud.
    """
    studs = [i for i, holes in enumerate(pair.holes) if holes > 1]
    return studs if len(studs) > 1 else list(range(len(pair.joints)))


def node_differences(pair: CoupledPair) -> Floats:
    """Return right minus left (m - 1,) from stud to stud, mm: what a tape shows; positive where the beam turns left."""
    return np.diff((pair.right - pair.left)[node_indices(pair)])


def plane_curve(angle: Floats, stations: Floats) -> PlaneCurve:
    """Return the plane curve (n,) from 0 whose tangent has the angles (n,) at stations (n,), by arcs in between."""
    step = np.diff(stations) * np.sinc(np.diff(angle) / (2.0 * np.pi))
    chords = step * np.exp(0.5j * (angle[:-1] + angle[1:]))
    return np.concatenate([[0.0], np.cumsum(chords)]).astype(np.complex128)


def largest_sagitta(curve: PlaneCurve) -> float:
    """Return the largest distance of a plane curve from its chord, mm."""
    chord = curve[-1] - curve[0]
    return float(np.abs(((curve - curve[0]) * np.conj(chord)).imag).max() / abs(chord))


def fitted_deviation(curve: PlaneCurve, target: PlaneCurve) -> float:
    """Return the largest distance, mm, of points (n,) of a curve from those of its target after the best rigid motion.

    Best in the sum of squares; points of equal arc length belong together.
    """
    a, b = curve - curve.mean(), target - target.mean()
    turn = np.vdot(a, b)
    return float(np.abs(a * turn / abs(turn) - b).max())


def _samples(pair: CoupledPair) -> Floats:
    """Return stations (n,) from the first to the last coupling, all couplings among them."""
    per_bay = max(2, int(np.ceil(np.diff(pair.stations).max() / _SPACING)))
    inner = pair.stations[:-1, None] + np.diff(pair.stations)[:, None] * np.arange(per_bay) / per_bay
    return np.append(inner.ravel(), pair.stations[-1])


def _sprung_angle(pair: CoupledPair, right_minus_left: Floats, samples: Floats) -> Floats:
    """Return the tangent's angle (n,) at samples (n,) of the released pair: it turns evenly within each bay."""
    at_joints = pair.recovered * (right_minus_left - right_minus_left[0]) / pair.spacing
    return np.asarray(np.interp(samples, pair.stations, at_joints))


def sprung_curve(pair: CoupledPair, left: Floats, right: Floats) -> PlaneCurve:
    """Return the rest curve (n,) of a released pair whose couplings are drilled at stations left and right (m,)."""
    samples = _samples(pair)
    return plane_curve(_sprung_angle(pair, right - left, samples), samples)


def target_curve(pair: CoupledPair) -> PlaneCurve:
    """Return the beam's curve (n,) developed into the plane by its geodesic curvature, from first to last coupling."""
    samples = _samples(pair)
    return plane_curve(np.concatenate([[0.0], np.cumsum(geodesic_turn(pair.beam, samples))]), samples)


def over_drill_shift(pair: CoupledPair) -> Floats:
    """Return how far (m,) each joint's holes move on the right plank, and back on the left, to be over-drilled, mm.

    So drilled the pair springs to the target curve itself: the difference between the siblings grows by the reciprocal
    of the recovered share (28/27), half on each plank, so that the middle of both stays where it is.
    """
    return (pair.right - pair.left) * (1.0 / pair.recovered - 1.0) / 2.0


def sprung_shape(pair: CoupledPair, left: Floats, right: Floats, modulus: float) -> SprungShape:
    """Return the shape of a released pair drilled at stations left and right (m,) against its target curve.

    ``modulus`` in N/mm2 gives the locked-in force E A s (kappa_0 - kappa) / 2.
    """
    curve, target = sprung_curve(pair, left, right), target_curve(pair)
    strain = (1.0 - pair.recovered) * np.abs(np.diff(right - left) / np.diff(pair.stations)) / 2.0
    return SprungShape(
        target_sagitta=largest_sagitta(target),
        sagitta=largest_sagitta(curve),
        fitted=fitted_deviation(curve, target),
        force=float(modulus * pair.section.width * pair.section.thickness * strain.max()),
    )


def hole_error_effect(pair: CoupledPair, error: float = HOLE_ERROR) -> HoleErrorEffect:
    """Return what independent errors of standard deviation ``error`` (mm) in the station of every hole do.

    Linear in the errors. A joint's error is the mean of its holes on each plank, right minus left: variance 2 error^2 /
    holes. An angle depends on the errors at the first coupling and at its own only: they do not add up along the beam.
    """
    samples = _samples(pair)
    angle = _sprung_angle(pair, pair.right - pair.left, samples)
    curve = plane_curve(angle, samples)
    joint_error = error * np.sqrt(2.0 / pair.holes)
    hats = np.array([np.interp(samples, pair.stations, row) for row in np.eye(len(pair.joints))])
    hats[0] -= 1.0
    rate = 1j * np.exp(1j * angle) * hats * pair.recovered / pair.spacing
    steps = (rate[:, 1:] + rate[:, :-1]) / 2.0 * np.diff(samples)
    moved = np.concatenate([np.zeros((len(hats), 1)), np.cumsum(steps, axis=1)], axis=1)
    middle, end = moved[:, len(samples) // 2], moved[:, -1]
    chord = curve[-1]
    along = chord / abs(chord)
    foot = (curve[len(samples) // 2] * np.conj(along)).real / abs(chord)
    rise = ((middle - foot * end) * np.conj(along)).imag
    across = (end * np.exp(-1j * angle[-1])).imag
    nodes, bays = node_indices(pair), node_differences(pair)
    bay_errors = np.hypot(joint_error[nodes[1:]], joint_error[nodes[:-1]])
    return HoleErrorEffect(
        middle=float(np.linalg.norm(rise * joint_error)),
        end=float(np.linalg.norm(across * joint_error)),
        curvature=float(np.linalg.norm(bay_errors) / np.linalg.norm(bays)) if bays.any() else math.inf,
    )
