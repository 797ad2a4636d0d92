"""A shell as a frame: coupled beams in two layers, studs as pins between them, flat planks where they are fixed.

Every bay of a coupled beam is its two planks on rigid arms from the beam's line, so that the blocks and studs couple
them and the planks bend between. A flat plank is joined to the beam below or above it by a rigid arm (the block) that
leaves it free to turn about the surface normal (one screw), as the paper's model does (section 4.1).
"""

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from aag_cad.families import BEAMS, EDGES, GEODESICS
from aag_cad.geometry.framed import frames_at
from aag_cad.mechanics.frame.model import (
    ORIGIN,
    FrameElement,
    FrameError,
    FrameMaterial,
    FrameModel,
    FrameNode,
    FrameSection,
    RigidLink,
    rectangle_section,
)
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import parse_mark
from aag_cad.parts.model import Beam, FlatBar, Joint, Member, Shell, Timber
from aag_cad.parts.quantities import mass
from aag_cad.units import Floats, Vector, vector

# A shorter end gives false peaks of shear and adds nothing to the stiffness.
SHORTEST_END = 120.0
_SAME_PLACE = 1.0
_ON_BEAMS = ("AA", "AG", "boundary")
_ON_FLAT = ("AG", "boundary", "foot", "ridge")


@dataclass(frozen=True, eq=False)
class ShellFrame:
    """The frame of a shell without supports, in its coordinates.

    ``members`` (m) is the beam or flat plank that each element belongs to. ``masses`` (n,) in kg are those of all
    planks, studs, blocks and their fasteners at the nodes of the beams; flat planks weigh on the beams that they
    cross, fixed or not. ``beam_nodes`` are the nodes of the beams at a joint, by its mark.
    """

    model: FrameModel
    members: tuple[str, ...]
    masses: Floats
    beam_nodes: dict[str, tuple[str, ...]]


@dataclass(frozen=True, eq=False)
class _Line:
    """A beam or flat plank as a line of nodes: stations (k,), marks of the nodes, and which of them bears a joint."""

    mark: str
    length: float
    stations: Floats
    points: Floats
    normals: Floats
    across: Floats
    joints: dict[str, int]

    @cached_property
    def nodes(self) -> tuple[str, ...]:
        """The marks of its nodes: with the joint there, else start or end."""
        there = {place: joint for joint, place in reversed(self.joints.items())}
        ends = {0: f"{self.mark} start", len(self.stations) - 1: f"{self.mark} end"}
        return tuple(f"{self.mark} at {there[i]}" if i in there else ends[i] for i in range(len(self.stations)))


def _kept(places: list[tuple[float, str]], known: dict[str, Joint], length: float, trimmed: bool) -> list[float]:
    """Return the stations of nodes: one for joints at the same place, ends where they reach far enough past the last.

    ``trimmed``: of two joints at an end nearer than ``SHORTEST_END`` only one has a node, a stud before a block.
    """
    groups: list[list[tuple[float, str]]] = []
    for station, joint in places:
        if groups and station - groups[-1][-1][0] < _SAME_PLACE:
            groups[-1].append((station, joint))
        else:
            groups.append([(station, joint)])
    stations = [group[0][0] for group in groups]
    studs = [any(known[joint].kind == "AA" for _, joint in group) for group in groups]
    for end, inner in ((0, 1), (-1, -2)):
        if trimmed and len(stations) > 2 and abs(stations[inner] - stations[end]) < SHORTEST_END:
            if studs[end] and not studs[inner]:
                del stations[inner], studs[inner]
            elif not (studs[end] and studs[inner]):
                del stations[end], studs[end]
    before = [0.0] if stations[0] > SHORTEST_END else []
    return [*before, *stations, *([length] if length - stations[-1] > SHORTEST_END else [])]


def _line(member: Member, known: dict[str, Joint]) -> _Line | None:
    """Return the line of a member, or None if fewer than two of its places bear a joint of the frame."""
    length = member.curve.length
    wanted = _ON_BEAMS if isinstance(member, Beam) else _ON_FLAT
    places = sorted(
        (min(max(joint.station, 0.0), length), joint.joint)
        for joint in member.joints
        if joint.joint in known and known[joint.joint].kind in wanted
    )
    if not places or places[-1][0] - places[0][0] < _SAME_PLACE:
        return None
    stations = np.array(_kept(places, known, length, isinstance(member, Beam)))
    frames = frames_at(member.curve, stations)
    joints = {joint: int(np.argmin(np.abs(stations - station))) for station, joint in places}
    return _Line(member.mark, length, stations, frames.point, frames.normal, frames.binormal, joints)


def _elements(
    line: _Line, sides: Iterable[tuple[str, float]], section: FrameSection, material: FrameMaterial
) -> Iterator[FrameElement]:
    """Yield the elements of a line, one in every bay for each side (name, arm across the line in mm)."""
    for mark, arm in sides:
        for i, j in pairwise(range(len(line.stations))):
            yield FrameElement(
                mark=f"{mark} #{i + 1}",
                start=line.nodes[i],
                end=line.nodes[j],
                section=section,
                material=material,
                direction=vector(line.normals[i] + line.normals[j]),
                start_offset=vector(arm * line.across[i]) if arm else ORIGIN,
                end_offset=vector(arm * line.across[j]) if arm else ORIGIN,
            )


def _links(lines: dict[str, _Line], joints: Iterable[Joint], home: dict[str, str], tight: bool) -> Iterator[RigidLink]:
    """Yield the links of all joints whose members are in the frame; beams before edge planks before geodesics."""
    masters: dict[str, str] = {}

    def bound(one: str, other: str, pin: Vector | None, mark: str) -> RigidLink:
        for master, slave in ((one, other), (other, one)):
            top = master
            while top in masters:
                top = masters[top]
            if slave not in masters and top != slave:
                masters[slave] = master
                return RigidLink(master, slave, pin)
        raise FrameError(f"{mark}: {one} and {other} are tied already; take one of the joints away")

    for joint in joints:
        names = dict.fromkeys(home.get(member, member) for member in joint.members)
        met = sorted((name for name in names if name in lines and joint.mark in lines[name].joints), key=_rank)
        nodes = [lines[name].nodes[lines[name].joints[joint.mark]] for name in met]
        pin = None if tight and joint.kind == "AA" else joint.normal
        for one, other in pairwise(nodes):
            yield bound(one, other, pin, joint.mark)


def _rank(name: str) -> tuple[int, str]:
    return (*BEAMS, *EDGES, *GEODESICS).index(parse_mark(name).family), name


def _shares(stations: Floats, length: float) -> Floats:
    """Return the shares (k,) of a member's length that fall to places at stations (k,) of it."""
    return np.diff(np.concatenate([[0.0], (stations[1:] + stations[:-1]) / 2.0, [length]])) / length


def _masses(
    shell: Shell, timber: Timber, beams: list[_Line], nodes: dict[str, int], beam_nodes: dict[str, tuple[str, ...]]
) -> Floats:
    """Return the masses (n,) at the nodes, kg; what belongs to a joint off the beams goes to the nearest beam."""
    index = index_of(shell)
    joints = index.joints
    names = [name for line in beams for name in line.nodes]
    points = np.concatenate([line.points for line in beams])
    found = np.zeros(len(nodes))

    def put(weight: float, joint: Joint) -> None:
        nearest = names[int(np.argmin(np.linalg.norm(points - np.array(joint.point), axis=1)))]
        held = beam_nodes.get(joint.mark, (nearest,))
        for name in held:
            found[nodes[name]] += weight / len(held)

    for line in beams:
        carried = sum(mass(index.planks[plank], timber) for plank in index.beams[line.mark].planks)
        found[[nodes[name] for name in line.nodes]] += carried * _shares(line.stations, line.length)
    for plank in (plank for plank in shell.planks if not plank.upright):
        lying = [
            item for item in plank.joints if item.joint in joints and joints[item.joint].kind in ("AG", "boundary")
        ]
        if lying:
            shares = _shares(np.array([item.station for item in lying]), plank.curve.length)
            for item, share in zip(lying, shares.tolist(), strict=True):
                put(share * mass(plank, timber), joints[item.joint])
    for joint in shell.joints:
        if joint.kind in (*_ON_BEAMS, "ridge"):
            parts = {*joint.members, *joint.fasteners} - index.planks.keys()
            put(sum(mass(index.parts[part], timber) for part in sorted(parts) if part in index.parts), joint)
    return found


def _sides(
    line: _Line, beams: dict[str, Beam], planks: Mapping[str, FlatBar]
) -> tuple[list[tuple[str, float]], FrameSection]:
    """Return the planks of a line with their arms across it, mm, and the section of each."""
    if line.mark not in beams:
        size = planks[line.mark].blank.section
        return [(line.mark, 0.0)], rectangle_section(size.thickness, size.width)
    left, right = (planks[sibling] for sibling in beams[line.mark].planks)
    half = float(np.linalg.norm(left.curve.points[0] - right.curve.points[0])) / 2.0
    size = left.blank.section
    return [(left.mark, half), (right.mark, -half)], rectangle_section(size.width, size.thickness)


def shell_frame(
    shell: Shell, timber: Timber, *, fixed: Collection[str] | None = None, tight: bool = False
) -> ShellFrame:
    """Return the frame of a shell in which the flat planks ``fixed`` are screwed to the beams; None: all of them.

    ``tight``: the bolts of the studs are tightened, so that beams no longer turn against each other. Beam ends shorter
    than 120 mm past a joint are left out. FrameError if a shell has no beams with joints or its joints contradict.
    """
    index = index_of(shell)
    flat = [plank for plank in shell.planks if not plank.upright and (fixed is None or plank.mark in fixed)]
    candidates: list[Member] = [*shell.beams, *flat]
    found = {member.mark: _line(member, index.joints) for member in candidates}
    lines = {mark: line for mark, line in found.items() if line is not None}
    if not any(beam.mark in lines for beam in shell.beams):
        raise FrameError(f"{shell.mark}: none of its beams has two joints; at least one is needed for a frame")
    beams, planks = index.beams, index.planks
    material = FrameMaterial(timber.modulus, timber.shear_modulus)
    elements: list[FrameElement] = []
    members: list[str] = []
    for mark, line in lines.items():
        elements += _elements(line, *_sides(line, beams, planks), material)
        members += [mark] * (len(elements) - len(members))
    nodes = tuple(
        FrameNode(name, vector(point))
        for line in lines.values()
        for name, point in zip(line.nodes, line.points, strict=True)
    )
    upright = [line for line in lines.values() if line.mark in beams]
    beam_nodes: dict[str, tuple[str, ...]] = {}
    for line in upright:
        for joint, place in line.joints.items():
            beam_nodes[joint] = (*beam_nodes.get(joint, ()), line.nodes[place])
    links = tuple(_links(lines, shell.joints, index.unit_of, tight))
    masses = _masses(shell, timber, upright, {node.mark: i for i, node in enumerate(nodes)}, beam_nodes)
    return ShellFrame(FrameModel(nodes, tuple(elements), links), tuple(members), masses, beam_nodes)
