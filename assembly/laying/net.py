"""The beams and geodesics of a shell as a net in the plane of the floor: what is kept when it is laid flat.

A beam becomes a chain of points, at its ends and at every joint. Developed into the plane by its geodesic curvature it
gives the lengths of the chords and the turns between them: the shape that it was prefabricated in. Two chains share the
point of a stud that joins them. Lengths in mm, angles in radians, seen from outside (from above on the floor).
"""

import math
from dataclasses import dataclass

import numpy as np

from aag_cad.families import EDGES
from aag_cad.geometry.framed import frames_at
from aag_cad.mechanics.siblings import geodesic_turn, plane_curve
from aag_cad.parts.index import index_of
from aag_cad.parts.model import Beam, Joint, Member, Shell
from aag_cad.units import Floats, Ints
from assembly.base.errors import PlanError
from assembly.base.shell_axes import shell_view
from assembly.graph.cut_lines import cut_lines

_SAME_PLACE = 1.0
_SAMPLES_PER_BAY = 8


@dataclass(frozen=True, eq=False)
class Chain:
    """A beam as a chain of points (k,) of the net at stations (k,) along it, mm.

    ``chords`` (k - 1,) are the distances of neighbours when it is developed, ``turns`` (k - 2,) the angles by which it
    turns at its inner points, ``headings`` (k,) how the line from the point before to the point after leans against the
    beam itself. ``joints`` are the places of its joints in the chain.
    """

    mark: str
    layer: int
    stations: Floats
    points: Ints
    chords: Floats
    turns: Floats
    headings: Floats
    joints: dict[str, int]


@dataclass(frozen=True)
class Scissor:
    """A stud: its point, the points before and after it on the lower and on the upper beam, and two angles.

    ``built`` is the angle from the lower beam to the upper one in the shell, ``chords`` that between the lines through
    the points when the beams cross so.
    """

    joint: str
    point: int
    lower: tuple[int, int]
    upper: tuple[int, int]
    built: float
    chords: float


@dataclass(frozen=True, eq=False)
class Ray:
    """A geodesic: the points (k,) where beams cross it, their joints, and the stations (k,) of those on it, mm."""

    mark: str
    joints: tuple[str, ...]
    points: Ints
    stations: Floats


@dataclass(frozen=True, eq=False)
class Net:
    """The net of a shell: its chains, scissors and rays over points that lie at ``start`` (n, 2) to begin with.

    ``left_open`` are the joints that part where a closed ring is cut open.
    """

    start: Floats
    chains: tuple[Chain, ...]
    scissors: tuple[Scissor, ...]
    rays: tuple[Ray, ...]
    left_open: tuple[str, ...]


def is_ring(shell: Shell) -> bool:
    """Return whether a shell closes to a ring, so that it can be laid flat only when it is cut open."""
    try:
        return cut_lines(shell).ring
    except PlanError:
        return False


def _stations(member: Member) -> tuple[Floats, dict[str, int]]:
    """Return the stations of a member's ends and joints, those that coincide once, and the place of each joint."""
    ends = [(0.0, ""), (member.curve.length, "")]
    stations: list[float] = []
    joints: dict[str, int] = {}
    for station, joint in sorted([*ends, *((place.station, place.joint) for place in member.joints)]):
        if not stations or station - stations[-1] > _SAME_PLACE:
            stations.append(station)
        if joint:
            joints[joint] = len(stations) - 1
    return np.array(stations), joints


def _around(points: Floats, centre: Floats) -> Floats:
    """Return the angles (n,) of points (n, 3) about a vertical axis, without jumps."""
    return np.unwrap(np.arctan2(points[:, 1] - centre[1], points[:, 0] - centre[0]))


def _laid_out(shell: Shell, members: list[Member], ring: bool) -> tuple[dict[str, Floats], float]:
    """Return where the joints and ends of members lie to begin with, (k, 2) by mark, and how near the same place is.

    Seen square on; a ring is rolled out as the cylinder of its mean radius, cut open beside its first geodesic, each
    member in one piece with its middle on the cylinder.
    """
    places = {member.mark: member.curve.point_spline(_stations(member)[0]) for member in members}
    if not ring:
        view = shell_view(shell)
        return {mark: view(points)[:, :2] for mark, points in places.items()}, math.inf
    every = np.concatenate([member.curve.points for member in members])
    normals = np.concatenate([member.curve.normals for member in members])
    centre = (every.min(axis=0) + every.max(axis=0)) / 2.0
    radius = float(np.linalg.norm((every - centre)[:, :2], axis=1).mean())
    # Who looks against the normals of a ring may stand within it: then the angle grows to the left.
    side = math.copysign(1.0, float(((every - centre) * normals)[:, :2].sum()))
    geodesics = [member for member in members if not isinstance(member, Beam)]
    seam = float(_around(geodesics[0].curve.points, centre).mean()) - math.pi / len(geodesics)
    flat = {}
    for mark, points in places.items():
        angle = _around(points, centre) - seam
        angle -= 2.0 * np.pi * np.floor(angle.mean() / (2.0 * np.pi))
        flat[mark] = np.column_stack([side * radius * angle, points[:, 2]])
    return flat, np.pi * radius


def _developed(beam: Beam, stations: Floats) -> tuple[Floats, Floats, Floats]:
    """Return chords (k - 1,), turns (k - 2,) and headings (k,) of a beam that is developed into the plane."""
    shares = np.arange(_SAMPLES_PER_BAY) / _SAMPLES_PER_BAY
    fine = np.append((stations[:-1, None] + np.diff(stations)[:, None] * shares).ravel(), stations[-1])
    angle = np.concatenate([[0.0], np.cumsum(geodesic_turn(beam, fine))])
    at = plane_curve(angle, fine)[::_SAMPLES_PER_BAY]
    steps = np.diff(at)
    past = np.concatenate([at[1:], at[-1:]]) - np.concatenate([at[:1], at[:-1]])
    headings = np.angle(past * np.exp(-1j * angle[::_SAMPLES_PER_BAY]))
    return np.abs(steps), np.angle(steps[1:] / steps[:-1]), headings


def _chains(beams: list[Beam], shared: dict[str, int]) -> tuple[tuple[Chain, ...], int]:
    """Return the beams as chains over the points of ``shared`` joints and new ones, and the number of points."""
    chains: list[Chain] = []
    count = max(shared.values(), default=-1) + 1
    for beam in beams:
        stations, joints = _stations(beam)
        points = np.full(len(stations), -1, dtype=np.int64)
        for joint, place in joints.items():
            if joint in shared:
                points[place] = shared[joint]
        new = points < 0
        points[new] = count + np.arange(int(new.sum()))
        count += int(new.sum())
        chains.append(Chain(beam.mark, beam.layer, stations, points, *_developed(beam, stations), joints))
    return tuple(chains), count


def _neighbours(chain: Chain, place: int) -> tuple[int, int]:
    last = len(chain.points) - 1
    return int(chain.points[max(place - 1, 0)]), int(chain.points[min(place + 1, last)])


def _scissor(joint: Joint, below: str, above: str, chains: dict[str, Chain], beams: dict[str, Beam]) -> Scissor:
    lower, upper = chains[below], chains[above]
    normal, first = np.array(joint.normal), np.zeros(3)
    angles: list[float] = []
    for chain in (lower, upper):
        station = chain.stations[chain.joints[joint.mark]]
        along = frames_at(beams[chain.mark].curve, np.array([station])).tangent[0]
        first = first if first.any() else along - (along @ normal) * normal
        angles.append(float(np.arctan2(np.cross(first, along) @ normal, first @ along)))
    places = (lower.joints[joint.mark], upper.joints[joint.mark])
    built = angles[1] - angles[0]
    return Scissor(
        joint.mark,
        int(lower.points[places[0]]),
        _neighbours(lower, places[0]),
        _neighbours(upper, places[1]),
        built,
        built + float(upper.headings[places[1]] - lower.headings[places[0]]),
    )


def _crossed(shell: Shell) -> dict[str, tuple[str, str]]:
    """Return for each joint of two beams, or beam and geodesic, the marks of both, the lower one first."""
    index = index_of(shell)
    found: dict[str, tuple[str, str]] = {}
    for joint in shell.joints:
        if joint.kind in ("AA", "AG", "boundary"):
            planks = (index.planks[mark] for mark in joint.members if mark in index.planks)
            meeting = sorted((plank.layer, index.unit_of[plank.mark]) for plank in planks if plank.family not in EDGES)
            marks = tuple(dict.fromkeys(mark for _, mark in meeting))
            if len(marks) == 2:
                found[joint.mark] = (marks[0], marks[1])
    return found


def shell_net(shell: Shell) -> Net:
    """Return the net of a shell; PlanError if it has no beams that cross on studs."""
    geodesics = list(index_of(shell).geodesics.values())
    members: list[Member] = [*shell.beams, *geodesics]
    begin, near = _laid_out(shell, members, is_ring(shell))
    places = {member.mark: _stations(member)[1] for member in members}

    def apart(joint: str, marks: tuple[str, str]) -> float:
        a, b = (begin[mark][places[mark][joint]] for mark in marks)
        return float(np.linalg.norm(a - b))

    pairs = _crossed(shell)
    left_open = {joint for joint, marks in pairs.items() if apart(joint, marks) > near}
    studs = [joint for joint in shell.joints if joint.kind == "AA" and joint.mark in pairs]
    if not studs:
        raise PlanError(f"{shell.mark}: no two beams cross on a stud; only a shell with AA nodes can be laid flat")
    kept = [joint for joint in studs if joint.mark not in left_open]
    chains, count = _chains(list(shell.beams), {joint.mark: i for i, joint in enumerate(kept)})
    start, met = np.zeros((count, 2)), np.zeros(count)
    for chain in chains:
        np.add.at(start, chain.points, begin[chain.mark])
        np.add.at(met, chain.points, 1.0)
    by_mark, beams = {chain.mark: chain for chain in chains}, index_of(shell).beams
    scissors = (_scissor(joint, *pairs[joint.mark], by_mark, beams) for joint in kept)
    rays = (_ray(plank, pairs, by_mark, left_open) for plank in geodesics)
    return Net(start / met[:, None], chains, tuple(scissors), tuple(rays), tuple(sorted(left_open)))


def _ray(plank: Member, pairs: dict[str, tuple[str, str]], chains: dict[str, Chain], left_open: set[str]) -> Ray:
    joints, points, stations = [], [], []
    for place in plank.joints:
        if place.joint not in pairs or place.joint in left_open:
            continue
        chain = next(chains[mark] for mark in pairs[place.joint] if mark in chains)
        joints.append(place.joint)
        points.append(int(chain.points[chain.joints[place.joint]]))
        stations.append(place.station)
    return Ray(plank.mark, tuple(joints), np.array(points, dtype=np.int64), np.array(stations))
