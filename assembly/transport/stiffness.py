"""Whether a segment of a cut shell stays stiff until it is joined again: soft modes and sag, with and without braces.

It hangs by its lifting joints from slings that are upright, or stands on its feet and its props. Method, assumptions
and figures: docs/segments.md.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np
from scipy.sparse import csc_array

from aag_cad.findings import Finding
from aag_cad.language import Figure, Text, text
from aag_cad.mechanics.frame.factor import SingularError, factor, lowest_pairs
from aag_cad.mechanics.frame.model import Dof, FrameModel, Spring, Support
from aag_cad.mechanics.frame.shell import shell_frame
from aag_cad.mechanics.frame.statics import held_part, mechanism_error
from aag_cad.mechanics.frame.system import (
    FrameSystem,
    against_unknowns,
    frame_system,
    full_stiffness,
    mass_matrix,
    part_stiffness,
)
from aag_cad.parts.model import Gridshell, Shell, Timber
from aag_cad.parts.twins import made_for_each
from aag_cad.units import Floats, Ints, Vector
from assembly.base.segments import Segment, Segmentation
from assembly.locking.model import GRAVITY
from assembly.locking.order import SAG_LIMIT, SOFT, soft_mode_count
from assembly.transport.frame import BracedFrame, braced_frame
from assembly.transport.lifting import lifting_points, standing_props

Way: TypeAlias = Literal["hung", "standing"]

MODES = 4
SLING = 3000.0
_KG_PER_TONNE = 1000.0
_DIGITS = 6
# A body on three upright slings sways in two directions and turns about the plumb line.
_PENDULUMS = 3
_HORIZONTAL: tuple[Vector, Vector] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))


@dataclass(frozen=True)
class SegmentState:
    """A held segment: lowest eigenvalues of K v = lambda M v, 1/s2, how many are soft, and the sag under its weight.

    ``displacement`` is the largest of any joint of a beam, mm, at joint ``at``; infinite for a mechanism.
    """

    eigenvalues: tuple[float, ...]
    soft_modes: int
    displacement: float
    at: str


@dataclass(frozen=True)
class SegmentHold:
    """A segment hung by joints, or standing on feet and props: with its braces, and without them (``bare``).

    A mode is soft below ``threshold``, 1/s2. ``forces`` are those in the braces under self-weight, N, tension positive,
    of a bar the largest along it; ``buckled`` are the places of the braces that are pressed beyond their Euler force:
    they are left out of ``braced`` one after the other, the one that exceeds it most first, and have no force.
    """

    way: Way
    joints: tuple[str, ...]
    threshold: float
    braced: SegmentState
    bare: SegmentState
    forces: tuple[float, ...]
    buckled: tuple[int, ...]


@dataclass(frozen=True)
class SegmentStiffness:
    """How stiff a segment is in each way in which it is held; without lifting joints it does not hang."""

    segment: str
    holds: tuple[SegmentHold, ...]

    @property
    def displacement(self) -> float:
        """The largest displacement under self-weight with braces, mm."""
        return max((hold.braced.displacement for hold in self.holds), default=0.0)


@dataclass(frozen=True, eq=False)
class _Held:
    """A held frame: stiffness (f, f) without braces and of each brace, mass (f, f) in t, weight (f,) in N."""

    braced: BracedFrame
    system: FrameSystem
    alone: csc_array
    braces: tuple[csc_array, ...]
    mass: csc_array
    weight: Floats


def _root(model: FrameModel, node: str) -> str:
    """Return the node that a node is a slave of in the end, or itself."""
    masters = {link.slave: link.master for link in model.links}
    while node in masters:
        node = masters[node]
    return node


def _held(braced: BracedFrame, supports: dict[str, tuple[Dof, ...]], springs: Iterable[Spring]) -> _Held:
    model = replace(
        braced.frame.model,
        supports=tuple(Support(node, held) for node, held in supports.items()),
        springs=tuple(springs),
    )
    system = frame_system(model)
    # The braces are the last elements, so that without them the unknowns are the same.
    own = len(model.elements) - sum(map(len, braced.braces))
    alone = frame_system(replace(model, elements=model.elements[:own]))
    loads = np.zeros((len(model.nodes), 6))
    loads[:, 2] = -GRAVITY * braced.frame.masses
    return _Held(
        braced,
        system,
        held_part(alone, against_unknowns(alone, full_stiffness(alone))),
        tuple(held_part(system, part_stiffness(system, places)) for places in braced.braces),
        held_part(system, mass_matrix(system, braced.frame.masses / _KG_PER_TONNE)),
        np.asarray(system.transform.T @ loads.ravel())[system.free],
    )


def _hung(braced: BracedFrame, joints: Sequence[str]) -> _Held:
    """Return a frame that hangs by joints on upright slings of 3 m: held in z, and in plan like a pendulum."""
    model = braced.frame.model
    nodes = tuple(dict.fromkeys(_root(model, braced.frame.beam_nodes[joint][0]) for joint in joints))
    pull = float(braced.frame.masses.sum()) * GRAVITY / len(nodes) / SLING
    springs = (Spring(node, way, pull) for node in nodes for way in _HORIZONTAL)
    return _held(braced, dict.fromkeys(nodes, ("z",)), springs)


def _standing(braced: BracedFrame, feet: Sequence[Vector], props: Sequence[str]) -> _Held:
    """Return a frame whose nodes at the feet are held in x, y and z, and those at the props in z."""
    model = braced.frame.model
    points = np.array([node.point for node in model.nodes])
    nearest = [int(np.argmin(np.linalg.norm(points - np.array(foot), axis=1))) for foot in feet]
    supports: dict[str, tuple[Dof, ...]] = {_root(model, model.nodes[i].mark): ("x", "y", "z") for i in nearest}
    for prop in props:
        supports.setdefault(_root(model, braced.frame.beam_nodes[prop][0]), ("z",))
    return _held(braced, supports, ())


def _stiffness(held: _Held, chosen: Sequence[int]) -> tuple[csc_array, Ints]:
    """Return the stiffness (a, a) with some braces, and the places (a,) of the unknowns that it holds."""
    total = csc_array(sum((held.braces[i] for i in chosen), held.alone))
    active = np.flatnonzero(total.diagonal())
    return csc_array(total[active][:, active]), active


def _spread(held: _Held, active: Ints, values: Floats) -> Floats:
    unknowns = np.zeros(held.system.transform.shape[1])
    unknowns[held.system.free[active]] = values
    return unknowns


def _sag(held: _Held, chosen: Sequence[int]) -> tuple[float, str, Floats]:
    """Return the largest displacement of a joint under self-weight, the joint, and the axial forces (b,) of braces."""
    stiffness, active = _stiffness(held, chosen)
    places = [(joint, held.system.index[n]) for joint, names in held.braced.frame.beam_nodes.items() for n in names]
    try:
        solved, given = factor(stiffness).solve(held.weight[active]), True
    except SingularError as error:
        solved, given = error.mode, False
    moved = (held.system.transform @ _spread(held, active, solved)).reshape(-1, 6)
    sizes = np.linalg.norm(moved[[place for _, place in places], :3], axis=1)
    worst = int(np.argmax(np.round(sizes / sizes.max(), _DIGITS)))
    forces = np.zeros(len(held.braces))
    if not given:
        return math.inf, places[worst][0], forces
    arrays = held.system.arrays
    for i in chosen:
        elements = held.braced.braces[i]
        ends = arrays.to_ends[elements] @ moved[arrays.nodes[elements]].reshape(-1, 12, 1)
        axial = (arrays.stiffness[elements] @ ends)[:, 6, 0]
        forces[i] = axial[np.argmax(np.abs(axial))]
    return float(sizes[worst]), places[worst][0], forces


def _state(held: _Held, chosen: Sequence[int], way: Way, threshold: float) -> tuple[SegmentState, Floats]:
    """Return the state with some braces and their forces (b,); pendulum motions are left out of its modes."""
    stiffness, active = _stiffness(held, chosen)
    skipped = _PENDULUMS if way == "hung" else 0
    try:
        values, _ = lowest_pairs(stiffness, csc_array(held.mass[active][:, active]), MODES + skipped)
    except SingularError as error:
        raise mechanism_error(held.system, _spread(held, active, error.mode)) from error
    eigenvalues = tuple(values[skipped:].tolist())
    displacement, at, forces = _sag(held, chosen)
    return SegmentState(eigenvalues, soft_mode_count(eigenvalues, threshold), displacement, at), forces


def _hold(held: _Held, way: Way, joints: tuple[str, ...], threshold: float) -> SegmentHold:
    """Return the states of a held frame; braces that buckle are left out."""
    buckled: list[int] = []
    while True:
        chosen = [i for i in range(len(held.braces)) if i not in buckled]
        _, _, forces = _sag(held, chosen)
        over = -forces / held.braced.euler
        if not len(over) or over.max() <= 1.0:
            break
        buckled.append(int(np.argmax(np.round(over, _DIGITS))))
    braced, forces = _state(held, chosen, way, threshold)
    bare = _state(held, (), way, threshold)[0]
    return SegmentHold(way, joints, threshold, braced, bare, tuple(forces.tolist()), tuple(sorted(buckled)))


def _feet(shell: Shell, geodesics: Iterable[str]) -> list[Vector]:
    own = set(geodesics)
    return [joint.point for joint in shell.joints if joint.kind == "foot" and own & set(joint.members)]


def finished_lowest(shell: Shell, timber: Timber) -> dict[Way, float]:
    """Return the lowest eigenvalue, 1/s2, of a whole finished shell with tight bolts, hung and standing like a segment.

    It hangs by ``lifting_points`` and stands on the feet of its geodesics and ``standing_props``.
    """
    frame = shell_frame(shell, timber, tight=True)
    braced = BracedFrame(frame, (), np.array([]))
    points = np.array([node.point for node in frame.model.nodes])
    centre = np.asarray(np.average(points, axis=0, weights=frame.masses))
    studs = {stud.mark: np.array(stud.frame.origin) for stud in shell.studs if stud.mark in frame.beam_nodes}
    feet = _feet(shell, (plank.mark for plank in shell.planks))
    lifting, props = lifting_points(studs, centre).studs, standing_props([np.array(f) for f in feet], studs, {}, centre)
    found: dict[Way, float] = {}
    if lifting:
        found["hung"] = _state(_hung(braced, lifting), (), "hung", 0.0)[0].eigenvalues[0]
    if props:
        found["standing"] = _state(_standing(braced, feet, props), (), "standing", 0.0)[0].eigenvalues[0]
    return found


def segment_stiffness(
    shell: Shell,
    timber: Timber,
    segmentation: Segmentation,
    segment: Segment,
    *,
    finished: Mapping[Way, float] | None = None,
    tight: bool = True,
) -> SegmentStiffness:
    """Return how stiff a segment is, hung by its lifting joints and standing on its feet and props.

    ``finished`` are the lowest eigenvalues of the whole finished shell (None: ``finished_lowest``): a mode is soft
    below half of that of the shell held in the same way, or in the other one if the shell cannot be. ``tight``: the
    bolts of the studs are tightened. A segment stands on the feet of its geodesics if it has props. PlanError if a
    brace does not fit the segment, FrameError that names the node if something moves that has no mass.
    """
    lowest = finished_lowest(shell, timber) if finished is None else finished
    braced = braced_frame(shell, timber, segmentation.splices, segment, tight=tight)
    held: list[tuple[Way, tuple[str, ...], _Held]] = []
    if segment.lifting.studs:
        held.append(("hung", segment.lifting.studs, _hung(braced, segment.lifting.studs)))
    if segment.props:
        feet = _feet(shell, segment.geodesics)
        held.append(("standing", segment.props, _standing(braced, feet, segment.props)))
    holds = tuple(
        _hold(frame, way, joints, SOFT * lowest.get(way, min(lowest.values()))) for way, joints, frame in held
    )
    return SegmentStiffness(segment.name, holds)


def segments_stiffness(gridshell: Gridshell, segmentation: Segmentation) -> tuple[SegmentStiffness, ...]:
    """Return how stiff the segments of all shells are that are cut; those of twins, cut alike, are computed once.

    Errors are those of ``segment_stiffness``.
    """
    timber = gridshell.timber

    def of_shell(shell: Shell) -> tuple[SegmentStiffness, ...]:
        own = [segment for segment in segmentation.segments if segment.shell == shell.mark]
        if len(own) < 2:
            return ()
        lowest = finished_lowest(shell, timber)
        return tuple(segment_stiffness(shell, timber, segmentation, segment, finished=lowest) for segment in own)

    return tuple(item for found in made_for_each(gridshell, of_shell).values() for item in found)


def stiffness_finding(stiffness: SegmentStiffness, limit: float = SAG_LIMIT) -> Finding | None:
    """Return that a segment sags more than a limit (mm) with its braces (AAG965, a warning), None if it does not."""
    if stiffness.displacement <= limit:
        return None

    def words(key: str, **figures: Figure) -> Text:
        return text(f"segments.stiffness.{key}", **figures)

    hold = max(stiffness.holds, key=lambda hold: hold.braced.displacement)
    free, held = math.isinf(stiffness.displacement), words(hold.way)
    told = [words("hold" if free else f"hold_{hold.way}", at=hold.braced.at)]
    if hold.buckled:
        told.append(words("buckled", braces=", ".join(str(i + 1) for i in hold.buckled)))
    remedy = words("remedy", told=(*told, words("wider")))
    if free:
        return Finding("AAG965", "warning", stiffness.segment, words("free", held=held), 1.0, 0.0, "", remedy)
    what = words("sag", held=held)
    return Finding("AAG965", "warning", stiffness.segment, what, stiffness.displacement, limit, "mm", remedy)


def stiffness_findings(
    gridshell: Gridshell, segmentation: Segmentation, limit: float = SAG_LIMIT
) -> tuple[Finding, ...]:
    """Return which segments of cut shells sag more than a limit (mm) with their braces: AAG965."""
    every = segments_stiffness(gridshell, segmentation)
    found = (stiffness_finding(stiffness, limit) for stiffness in every)
    return tuple(finding for finding in found if finding is not None)
