"""A segment of a cut shell as a frame of its own, with temporary braces that can be left out.

It is a shell as ``aag_cad.mechanics.frame.shell`` makes one into a frame: pieces of beams between the cuts, geodesics
and edge planks screwed, studs tightened. At a cut the geodesic of the line, or the bar in its place, is joined to each
beam end as if it were screwed to it. Assumptions: docs/segments.md.
"""

import math
from collections import defaultdict
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from aag_cad.geometry.framed import FramedCurve
from aag_cad.geometry.surface import unit
from aag_cad.mechanics.frame.model import (
    FrameElement,
    FrameMaterial,
    FrameModel,
    FrameNode,
    FrameSection,
    RigidLink,
    rectangle_section,
)
from aag_cad.mechanics.frame.shell import ShellFrame, shell_frame
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import parse_mark
from aag_cad.parts.model import Beam, Joint, JointStation, Plank, Shell, Timber
from aag_cad.units import Floats, Ints, Vector, vector
from assembly.base.errors import PlanError
from assembly.base.segments import Brace, Segment, Splice

_SAMPLE_SPACING = 150.0
_LEAST_SAMPLES = 13
# Two pieces of one beam in one segment need two marks: the index of the second is higher by this.
_NEXT_PIECE = 1000
_FRAMED = ("AG", "boundary", "foot", "ridge")


@dataclass(frozen=True, eq=False)
class BracedFrame:
    """A segment as a frame without supports, its braces in it as the last elements.

    ``braces`` has for each brace the places (k,) of its elements; ``euler`` (b,) the force in N at which it buckles
    between its pins, infinite for a bar, which each beam end holds.
    """

    frame: ShellFrame
    braces: tuple[Ints, ...]
    euler: Floats


def _trimmed(curve: FramedCurve, start: float, end: float) -> FramedCurve:
    """Return a curve between two of its stations."""
    count = max(_LEAST_SAMPLES, math.ceil((end - start) / _SAMPLE_SPACING) + 1)
    stations = np.linspace(start, end, count)
    return FramedCurve(stations - start, curve.point_spline(stations), unit(curve.normal_spline(stations)))


def _between(places: Sequence[JointStation], start: float, end: float, length: float) -> tuple[JointStation, ...]:
    """Return the joints of a piece, counted from its start; at an end that is not cut those past it too."""
    low, high = (start if start > 0.0 else -math.inf), (end if end < length else math.inf)
    return tuple(JointStation(place.joint, place.station - start) for place in places if low <= place.station <= high)


def _numbered(mark: str, number: int) -> str:
    """Return the mark of a piece: that of the whole for the first one in a segment."""
    parsed = parse_mark(mark)
    return str(replace(parsed, index=parsed.index + _NEXT_PIECE * number)) if number else mark


def _cut_plank(plank: Plank, number: int, span: tuple[float, float], left_out: Collection[str]) -> Plank:
    """Return a piece of a plank; an upright one keeps its curve, because its beam says where the frame runs."""
    (start, end), length = span, plank.blank.length
    holes = tuple(
        replace(hole, station=hole.station - start)
        for hole in plank.blank.holes
        if start < hole.station < end and hole.joint not in left_out
    )
    return replace(
        plank,
        mark=_numbered(plank.mark, number),
        beam=plank.beam and _numbered(plank.beam, number),
        curve=plank.curve if plank.upright or span == (0.0, length) else _trimmed(plank.curve, start, end),
        blank=replace(plank.blank, length=end - start, holes=holes),
        joints=_between(plank.joints, start, end, length),
    )


def _cut_beam(beam: Beam, number: int, span: tuple[float, float]) -> Beam:
    """Return a piece of a beam between two stations of it."""
    left, right = beam.planks
    return replace(
        beam,
        mark=_numbered(beam.mark, number),
        planks=(_numbered(left, number), _numbered(right, number)),
        curve=_trimmed(beam.curve, *span),
        joints=_between(beam.joints, *span, beam.curve.length),
    )


def _spans(shell: Shell, segment: Segment) -> dict[str, list[tuple[float, float]]]:
    """Return the stations between which a segment has its planks, by mark."""
    own = set(segment.parts)
    found = {plank.mark: [(0.0, plank.blank.length)] for plank in shell.planks if plank.mark in own}
    for piece in segment.pieces:
        found.setdefault(piece.plank, []).append((piece.start, piece.end))
    return {mark: sorted(spans) for mark, spans in found.items()}


def _joint_of_segment(joint: Joint, own: frozenset[str], names: dict[tuple[str, str], str]) -> Joint:
    """Return what a segment has of a joint; ``names`` are the marks of pieces by (plank, joint)."""
    members = [names.get((mark, joint.mark), mark if mark in own else "") for mark in joint.members]
    fasteners = tuple(mark for mark in joint.fasteners if mark in own)
    return replace(joint, members=tuple(mark for mark in members if mark), fasteners=fasteners)


def segment_shell(shell: Shell, splices: Sequence[Splice], segment: Segment) -> Shell:
    """Return a segment as a shell of its own: pieces of planks and beams, and of each joint what the segment has."""
    cuts = {(cut.plank, cut.station): splice.joint for splice in splices for cut in splice.cuts}
    spans, wholes = _spans(shell, segment), index_of(shell).planks
    left_out = {joint for (plank, _), joint in cuts.items() if joint and plank in spans}
    planks: list[Plank] = []
    names: dict[tuple[str, str], str] = {}
    for mark, pieces in spans.items():
        for number, span in enumerate(pieces):
            planks.append(_cut_plank(wholes[mark], number, span, left_out if wholes[mark].upright else ()))
            names |= {(mark, place.joint): planks[-1].mark for place in planks[-1].joints}
    beams = []
    for beam in shell.beams:
        at = {place.joint: place.station for place in beam.joints}
        left = wholes[beam.planks[0]]
        for number, (start, end) in enumerate(spans.get(left.mark, ())):
            low = at[cuts[left.mark, start]] if start > 0.0 else 0.0
            high = at[cuts[left.mark, end]] if end < left.blank.length else beam.curve.length
            beams.append(_cut_beam(beam, number, (low, high)))
    own = frozenset(segment.parts)
    met = {joint for _, joint in names}
    return Shell(
        segment.shell,
        shell.placement,
        tuple(planks),
        tuple(beams),
        tuple(part for part in shell.studs if part.mark in own),
        tuple(part for part in shell.blocks if part.mark in own),
        tuple(part for part in shell.bolts if part.mark in own),
        tuple(part for part in shell.screws if part.mark in own),
        tuple(_joint_of_segment(joint, own, names) for joint in shell.joints if joint.mark in met),
        tuple(part for part in shell.straps if part.mark in own),
    )


def _fixed(own: Shell) -> tuple[str, ...]:
    """Return the flat planks that are joined to others at two joints at least: at one alone they turn on its screw."""
    planks = index_of(own).planks
    met = [planks.keys() & joint.members for joint in own.joints if joint.kind in _FRAMED]
    flat = (plank.mark for plank in own.planks if not plank.upright)
    return tuple(mark for mark in flat if sum(mark in members and len(members) > 1 for members in met) > 1)


def joint_points(shell: Shell) -> dict[str, Vector]:
    """Return where joints are, by mark, mm; AA joints in the middle of their studs."""
    return {joint.mark: joint.point for joint in shell.joints} | {s.mark: s.frame.origin for s in shell.studs}


def bare_ends(shell: Shell, splices: Sequence[Splice], segment: Segment) -> dict[str, tuple[str, ...]]:
    """Return the joints of the bare beam ends along each cut whose geodesic went with the neighbour, by that geodesic.

    The order is that of the geodesic.
    """
    cut = {end for piece in segment.pieces for end in ((piece.plank, piece.start), (piece.plank, piece.end))}
    found: dict[str, list[str]] = defaultdict(list)
    for splice in splices:
        own = any((item.plank, item.station) in cut for item in splice.cuts)
        if own and splice.kind == "block" and splice.line not in segment.geodesics:
            found[splice.line].append(splice.joint)
    along = index_of(shell).stations
    return {line: tuple(sorted(joints, key=lambda joint: along[line, joint])) for line, joints in sorted(found.items())}


def _nearest(point: Vector, groups: Collection[tuple[str, ...]], points: dict[str, Vector]) -> tuple[str, ...]:
    """Return the group of joints that comes nearest to a point."""
    return min(groups, key=lambda joints: min(math.dist(point, points[joint]) for joint in joints))


def _bar(
    name: str, joints: Sequence[Joint], frame: ShellFrame, section: FrameSection, material: FrameMaterial
) -> tuple[list[FrameNode], list[RigidLink], list[FrameElement]]:
    """Return a bar along bare beam ends, joined to each as a geodesic is: free to turn about the surface normal."""
    nodes = [FrameNode(f"{name} at {joint.mark}", joint.point) for joint in joints]
    links = [
        RigidLink(frame.beam_nodes[joint.mark][0], node.mark, joint.normal)
        for node, joint in zip(nodes, joints, strict=True)
    ]
    normals = np.array([joint.normal for joint in joints])
    elements = [
        FrameElement(
            f"{name} #{i + 1}", nodes[i].mark, nodes[i + 1].mark, section, material, vector(normals[i] + normals[i + 1])
        )
        for i in range(len(joints) - 1)
    ]
    return nodes, links, elements


def _straight(
    name: str,
    brace: Brace,
    frame: ShellFrame,
    points: dict[str, Vector],
    section: FrameSection,
    material: FrameMaterial,
) -> FrameElement:
    """Return a tie or diagonal: a straight bar from the middle of one joint to that of another, pinned there."""
    where = {node.mark: np.array(node.point) for node in frame.model.nodes}
    start, end = frame.beam_nodes[brace.start][0], frame.beam_nodes[brace.end][0]
    one, other = np.array(points[brace.start]), np.array(points[brace.end])
    across = np.cross(other - one, np.eye(3)[np.argmin(np.abs(other - one))])
    return FrameElement(
        name, start, end, section, material, vector(across), vector(one - where[start]), vector(other - where[end]),
        ("ry", "rz"), ("rx", "ry", "rz"),
    )  # fmt: skip


def _euler(section: FrameSection, timber: Timber, span: float) -> float:
    """Return the force in N at which a pinned bar of a length (mm) buckles, about its weaker axis."""
    return math.pi**2 * timber.modulus * min(section.inertia_y, section.inertia_z) / span**2


def _tee(plank: FrameSection) -> FrameSection:
    """Return two planks screwed to a T, as stiff as if they slipped: each bends for itself, flat and on edge."""
    inertia = plank.inertia_y + plank.inertia_z
    return FrameSection(2.0 * plank.area, 2.0 * plank.torsion, inertia, inertia)


def braced_frame(
    shell: Shell, timber: Timber, splices: Sequence[Splice], segment: Segment, *, tight: bool = True
) -> BracedFrame:
    """Return a segment and its braces as a frame; braces are of planks of the shell's section and have no mass.

    ``tight``: the bolts of its studs are tightened. PlanError if a brace ends at a joint that is not in the segment, or
    if a bar has no bare beam ends to go along.
    """
    own = segment_shell(shell, splices, segment)
    frame, points = shell_frame(own, timber, fixed=_fixed(own), tight=tight), joint_points(shell)
    bare, met = bare_ends(shell, splices, segment), index_of(own).joints
    size, material = shell.planks[0].blank.section, FrameMaterial(timber.modulus, timber.shear_modulus)
    plank = rectangle_section(size.thickness, size.width)
    nodes, links, elements = list(frame.model.nodes), list(frame.model.links), list(frame.model.elements)
    places, euler = [], []
    for number, brace in enumerate(segment.braces, start=1):
        missing = [joint for joint in (brace.start, brace.end) if joint not in frame.beam_nodes]
        if missing or (brace.kind == "bar" and not bare):
            what = f"no beam at {missing[0]}" if missing else "no bare beam ends"
            raise PlanError(f"{segment.name}: its brace {number} ({brace.kind}) finds {what}; brace between its joints")
        name, first = f"brace {number}", len(elements)
        if brace.kind == "bar":
            along = [met[joint] for joint in _nearest(points[brace.start], bare.values(), points)]
            more = _bar(name, along, frame, plank, material)
            nodes, links, elements = nodes + more[0], links + more[1], elements + more[2]
            euler.append(math.inf)
        else:
            section = _tee(plank) if brace.planks > 1 else plank
            elements.append(_straight(name, brace, frame, points, section, material))
            euler.append(_euler(section, timber, math.dist(points[brace.start], points[brace.end])))
        places.append(np.arange(first, len(elements)))
    model = FrameModel(tuple(nodes), tuple(elements), tuple(links))
    masses = np.concatenate([frame.masses, np.zeros(len(nodes) - len(frame.masses))])
    return BracedFrame(replace(frame, model=model, masses=masses), tuple(places), np.array(euler))
