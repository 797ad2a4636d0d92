"""Where every member of a shell lies when it is assembled flat on the floor (paper, section 3.2 and Fig. 7g).

Of all flat states that keep the distances between the studs, the one that turns the loose nodes little and bends the
beams little away from the shape that they were made in, with the geodesics straight. Model, figures and what cannot
hold exactly: docs/flattening.md. Floor coordinates: x to the right, y away from the foot, from a corner of the
floor; seen from above, which is from outside the shell. Millimetres and radians.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array, eye_array
from scipy.sparse.linalg import splu

from aag_cad.findings import Finding, Severity
from aag_cad.language import text
from aag_cad.parts.index import index_of
from aag_cad.parts.model import Shell, Timber
from aag_cad.units import Floats
from assembly.base.errors import PlanError
from assembly.laying.net import Net, Ray, is_ring, shell_net
from assembly.laying.terms import Arrays, Stiffness, bending, net_arrays, residuals, started, stretch, turning

LENGTH_LIMIT = 0.5
# A node's turn and a crossing beside its line cost this share of what the same turn or offset costs a bay of a beam.
_SOFTNESS = 0.025
_MOST_STEPS = 200
_FIRST_DAMPING = 1e-9
_LEAST_DAMPING = 1e-12
_STILL = 1e-4
_NO_GAIN = 1e-9


@dataclass(frozen=True, eq=False)
class FlatMember:
    """A beam or geodesic on the floor: its points (k, 2) from its start to its end, at stations (k,) along it.

    ``joints`` are the joints at the points, "" at an end without one; a geodesic has only its two ends. ``width`` is
    what it covers of the floor across its length, ``shift`` how far holes of a geodesic lie from its crossings at most.
    """

    mark: str
    family: str
    layer: int
    width: float
    stations: Floats
    points: Floats
    joints: tuple[str, ...]
    shift: float = 0.0


@dataclass(frozen=True, eq=False)
class FlatState:
    """A shell on the floor: its members from the lowest layer up, its studs, crossings and foot joints by mark.

    ``size`` is the floor that it covers, x by y; ``view_origin`` is where the origin of the view square on to the shell
    (``assembly.base.shell_axes``) lies on it, None for a ring. ``length_error`` is the largest error of a distance
    between neighbouring holes, ``aside`` the largest distance of a crossing from the line of its geodesic, ``turns``
    how much wider each node's angle from lower to upper beam is than in the shell. ``radius`` is the smallest radius of
    what a beam is bent beyond its made shape, ``eased_radius`` what bolts with play in their holes leave of it, in the
    beam ``bent``; ``clearance`` is the least gap between a geodesic and a stud. ``left_open`` are the joints of a ring
    that come together only when it is closed.
    """

    shell: str
    members: tuple[FlatMember, ...]
    studs: dict[str, Floats]
    crossings: dict[str, Floats]
    foot: dict[str, Floats]
    size: tuple[float, float]
    view_origin: Floats | None
    length_error: float
    aside: float
    turns: dict[str, float]
    radius: float
    eased_radius: float
    bent: str
    clearance: float
    left_open: tuple[str, ...]

    @property
    def shift(self) -> float:
        """How far the holes of any geodesic lie from its crossings at most: it slides by so much in the lifting."""
        return max((member.shift for member in self.members), default=0.0)


def _stiffness(shell: Shell, arrays: Arrays) -> Stiffness:
    """Return the stiffness of two coupled planks for a modulus of 1 N/mm2; only the ratios count."""
    beam = shell.beams[0]
    section = next(plank for plank in shell.planks if plank.beam == beam.mark).blank.section
    apart = beam_width(shell) - section.thickness
    area = 2.0 * section.width * section.thickness
    second = area * (section.thickness**2 / 12.0 + apart**2 / 4.0)
    bay = float(arrays.spacing.mean())
    return Stiffness(area, second, _SOFTNESS * second / bay, _SOFTNESS * second / bay**3)


def beam_width(shell: Shell) -> float:
    """Return the width of a coupled beam from outside to outside of its planks, mm."""
    planks = index_of(shell).planks
    left, right = (planks[mark] for mark in shell.beams[0].planks)
    return float(np.linalg.norm(left.curve.points[0] - right.curve.points[0])) + left.blank.section.thickness


def settled(arrays: Arrays, stiffness: Stiffness, unknowns: Floats, shell: str) -> Floats:
    """Return the unknowns of least energy, by damped Gauss-Newton steps; PlanError if they do not settle."""
    damping = _FIRST_DAMPING
    now = residuals(arrays, stiffness, unknowns)
    energy = float(now.values @ now.values)
    for _ in range(_MOST_STEPS):
        normal = now.jacobian.T @ now.jacobian
        # A rigid motion of the whole costs nothing: the damping alone holds it where it is.
        held = damping * float(normal.diagonal().max()) * eye_array(len(unknowns))
        factor = splu(
            csc_array(normal + held),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        step = -factor.solve(now.jacobian.T @ now.values)
        then = residuals(arrays, stiffness, unknowns + step)
        lower = float(then.values @ then.values)
        still = float(np.abs(step).max()) < _STILL
        if not lower <= energy and not still:
            damping *= 10.0
            continue
        gained = energy - lower
        unknowns, now, energy = unknowns + step, then, lower
        damping = max(damping / 10.0, _LEAST_DAMPING)
        if still or gained <= _NO_GAIN * energy:
            return unknowns
    raise PlanError(
        f"{shell}: laid flat it does not settle in {_MOST_STEPS} steps; lay it out in two parts, or on falsework"
    )


def _turned_back(points: Floats, target: Floats) -> Floats:
    """Return points (n, 2) moved rigidly as near as can be to a target (n, 2)."""
    a, b = points - points.mean(axis=0), target - target.mean(axis=0)
    along, across = float((a * b).sum()), float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum())
    size = np.hypot(along, across)
    c, s = along / size, across / size
    return np.asarray(a @ np.array([[c, s], [-s, c]]) + target.mean(axis=0))


def _straight(ray: Ray, at: Floats) -> tuple[Floats, Floats, Floats] | None:
    """Return a point and the direction (2,) of the best line through the crossings of a geodesic, and offsets (k,).

    The point is where station 0 of the geodesic lies if its holes are as near to the crossings as can be. None with
    fewer than two crossings.
    """
    if len(ray.points) < 2:
        return None
    crossings = at[ray.points]
    away = crossings - crossings.mean(axis=0)
    ahead = np.linalg.svd(away)[2][0]
    ahead = ahead if float(ahead @ (crossings[-1] - crossings[0])) > 0.0 else -ahead
    start = crossings.mean(axis=0) - ray.stations.mean() * ahead
    return start, ahead, away @ np.array([-ahead[1], ahead[0]])


def outline_of(member: FlatMember) -> Floats:
    """Return the outline (2 k, 2) of a member on the floor, anticlockwise from its start."""
    along = np.gradient(member.points, axis=0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    across = member.width / 2.0 * np.column_stack([-along[:, 1], along[:, 0]])
    return np.concatenate([member.points - across, (member.points + across)[::-1]])


def _geodesics(shell: Shell, net: Net, at: Floats) -> tuple[list[FlatMember], dict[str, Floats], float]:
    """Return the geodesics on the floor, their foot joints, and the largest offset of a crossing."""
    planks = index_of(shell).planks
    feet = {joint.mark for joint in shell.joints if joint.kind == "foot"}
    members: list[FlatMember] = []
    foot: dict[str, Floats] = {}
    aside = 0.0
    for ray in net.rays:
        line = _straight(ray, at)
        if line is None:
            continue
        plank, (start, ahead, offsets) = planks[ray.mark], line
        ends = np.array([0.0, plank.curve.length])
        shifts = (at[ray.points] - start) @ ahead - ray.stations
        aside = max(aside, float(np.abs(offsets).max()))
        foot |= {j.joint: start + j.station * ahead for j in plank.joints if j.joint in feet}
        points = start + ends[:, None] * ahead
        width, shift = plank.blank.section.width, float(np.abs(shifts).max())
        members.append(FlatMember(ray.mark, plank.family, plank.layer, width, ends, points, ("", ""), shift))
    return members, foot, aside


def _beams(shell: Shell, net: Net, at: Floats) -> list[FlatMember]:
    width = beam_width(shell)
    beams = index_of(shell).beams
    members = []
    for chain in net.chains:
        named = {place: joint for joint, place in chain.joints.items()}
        joints = tuple(named.get(i, "") for i in range(len(chain.points)))
        points = at[chain.points]
        family = beams[chain.mark].family
        members.append(FlatMember(chain.mark, family, chain.layer, width, chain.stations, points, joints))
    return members


def _rows(points: dict[str, Floats]) -> list[Floats]:
    return [point[None] for point in points.values()]


def _clearance(shell: Shell, geodesics: Sequence[FlatMember], studs: Floats) -> float:
    """Return the least gap between the edge of a geodesic and a stud beside it; infinite without one."""
    least = math.inf
    reach = shell.studs[0].across_flats / math.sqrt(3.0) if shell.studs else 0.0
    for member in geodesics:
        ahead = (member.points[1] - member.points[0]) / np.linalg.norm(member.points[1] - member.points[0])
        away = studs - member.points[0]
        along, aside = away @ ahead, np.abs(away @ np.array([-ahead[1], ahead[0]]))
        beside = aside[(along > -reach) & (along < member.stations[-1] + reach)]
        least = min(least, float(beside.min(initial=math.inf)) - member.width / 2.0 - reach)
    return least


def _most_bent(net: Net, excess: Floats, free: float) -> tuple[float, float, str]:
    """Return the smallest radii of bends without and with play, and the beam of the second.

    ``excess`` (m,) are the turns beyond the made ones, bend by bend. Play lets the planks of a beam turn by ``free``
    either way before they must bend as one: between two places it takes twice that off their difference.
    """
    stiff, eased, worst, first = 0.0, -1.0, "", 0
    for chain in net.chains:
        own = excess[first : first + len(chain.turns)]
        first += len(chain.turns)
        stiff = max(stiff, float((2.0 * np.abs(own) / (chain.chords[:-1] + chain.chords[1:])).max(initial=0.0)))
        turned = np.concatenate([[0.0], np.cumsum(own)])
        middles = (chain.stations[:-1] + chain.stations[1:]) / 2.0
        i, j = np.triu_indices(len(middles), 1)
        slopes = (np.abs(turned[j] - turned[i]) - 2.0 * free) / (middles[j] - middles[i])
        if float(slopes.max(initial=0.0)) > eased:
            eased, worst = float(slopes.max(initial=0.0)), chain.mark
    return 1.0 / stiff if stiff > 0.0 else np.inf, 1.0 / eased if eased > 0.0 else np.inf, worst


def _free_turn(shell: Shell) -> float:
    """Return by how much the play of bolts in their holes lets the planks of a beam turn either way, radians."""
    beam = shell.beams[0]
    plank = index_of(shell).planks[beam.planks[0]]
    play = [hole.diameter for hole in plank.blank.holes if hole.use == "bolt"]
    if not play or not shell.bolts:
        return 0.0
    return (min(play) - shell.bolts[0].diameter) / (beam_width(shell) - plank.blank.section.thickness)


def flat_state(shell: Shell) -> FlatState:
    """Return a shell laid flat; the same shell gives the same state.

    A ring is cut open beside its first geodesic and named in ``left_open``. PlanError without beams that cross on
    studs, or if no flat state is found.
    """
    net = shell_net(shell)
    arrays = net_arrays(net)
    unknowns = settled(arrays, _stiffness(shell, arrays), started(net), shell.mark)
    at = _turned_back(unknowns[: 2 * arrays.points].reshape(-1, 2), net.start)
    # Floor coordinates count from the corner of what is covered.
    geodesics, foot, _ = _geodesics(shell, net, at)
    lying = np.concatenate([*(outline_of(member) for member in (*_beams(shell, net, at), *geodesics)), *_rows(foot)])
    low, high = lying.min(axis=0), lying.max(axis=0)
    at = at - low
    geodesics, foot, aside = _geodesics(shell, net, at)
    radius, eased, bent = _most_bent(net, bending(arrays, unknowns).values, _free_turn(shell))
    turns = turning(arrays, unknowns).values.tolist()
    studs = {scissor.joint: at[scissor.point] for scissor in net.scissors}
    return FlatState(
        shell=shell.mark,
        members=tuple(sorted([*_beams(shell, net, at), *geodesics], key=lambda member: (member.layer, member.mark))),
        studs=dict(sorted(studs.items())),
        crossings=dict(
            sorted((mark, at[i]) for ray in net.rays for mark, i in zip(ray.joints, ray.points, strict=True))
        ),
        foot=dict(sorted(foot.items())),
        size=(float(high[0] - low[0]), float(high[1] - low[1])),
        view_origin=None if is_ring(shell) else -low,
        length_error=float(np.abs(stretch(arrays, unknowns).values).max()),
        aside=aside,
        turns={scissor.joint: turn for scissor, turn in zip(net.scissors, turns, strict=True)},
        radius=radius,
        eased_radius=eased,
        bent=bent,
        clearance=_clearance(shell, geodesics, np.array(list(studs.values()))),
        left_open=net.left_open,
    )


def flat_findings(shell: Shell, state: FlatState, timber: Timber) -> tuple[Finding, ...]:
    """Return what a crew must know before it lays a shell flat: AAG971 to AAG974.

    AAG971 holes that miss each other, AAG972 a beam that would be bent beyond its strength if its two planks acted as
    one, AAG973 a geodesic that does not pass between the studs, AAG974 joints that stay open until a ring is closed.
    """

    def finding(code: str, severity: Severity, mark: str, found: float, allowed: float, unit: str) -> Finding:
        what, remedy = (text(f"drawings.findings.{code}.{key}") for key in ("what", "remedy"))
        return Finding(code, severity, mark, what, found, allowed, unit, remedy)

    stress = timber.modulus * beam_width(shell) / 2.0 / state.eased_radius
    found = []
    if state.length_error > LENGTH_LIMIT:
        found.append(finding("AAG971", "error", shell.mark, state.length_error, LENGTH_LIMIT, "mm"))
    if stress > timber.bending_strength:
        found.append(finding("AAG972", "warning", state.bent, stress, timber.bending_strength, "N/mm2"))
    if state.clearance < 0.0:
        found.append(finding("AAG973", "warning", shell.mark, state.clearance, 0.0, "mm"))
    if state.left_open:
        found.append(finding("AAG974", "note", shell.mark, len(state.left_open), 0.0, ""))
    return tuple(found)
