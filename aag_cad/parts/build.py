"""The gridshell of a design and its network: all parts and joints of all shells."""

import math
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np

from aag_cad.design import Design
from aag_cad.families import GEODESICS
from aag_cad.geometry.framed import frames_at, nearest_station
from aag_cad.geometry.revolution import turn
from aag_cad.network.model import Crossing, CurveId, CurveNetwork
from aag_cad.parts.blades import BladeJoint, blade_joints, own_sides
from aag_cad.parts.clearance import Obstacle, near_parts, obstacles
from aag_cad.parts.facade import covered, placed_facade
from aag_cad.parts.feet import foot_joints
from aag_cad.parts.forms import UNMOVED, Frame
from aag_cad.parts.joints import BuiltJoint, block_joint, node_joint
from aag_cad.parts.kinds import KINDS, kind_of
from aag_cad.parts.marks import Mark, turned_mark
from aag_cad.parts.members import (
    Drilling,
    curve_mark,
    drilled,
    grouped,
    undrilled_members,
    with_joints,
)
from aag_cad.parts.model import SCHEMA_VERSION, Beam, Blade, Bolt, Gridshell, Joint, Part, Plank, Shell, Timber
from aag_cad.parts.straps import strap_joint
from aag_cad.parts.twins import renamed
from aag_cad.units import Floats, vector

_T = TypeVar("_T")
# What the first shell gets once its structure stands, in this order: each gives the shell with parts and joints more.
ADDITIONS: list[Callable[[Design, CurveNetwork, Shell], Shell]] = [
    lambda design, network, shell: covered(shell, placed_facade(design, network, shell)),
]


def _numbered(network: CurveNetwork, shell: int) -> list[tuple[Mark, Crossing]]:
    """Return the crossings with the marks of their joints: nodes row by row, blocks beam by beam, ends by geodesic."""

    def of(*kinds: str) -> list[Crossing]:
        return [c for c in network.crossings if c.kind in kinds]

    nodes = sorted(of("AA"), key=lambda c: (round(c.point[2]), round(c.point[1], 3), c.point[0]))
    blocks = sorted(of("AG", "boundary"), key=lambda c: (c.curves[0], c.stations[0]))
    marked = [(Mark(shell, "N", i), c) for i, c in enumerate(nodes, start=1)]
    marked += [(Mark(shell, "K", i), c) for i, c in enumerate(blocks, start=1)]
    marked += [(Mark(shell, "F", c.curves[0].number), c) for c in of("foot")]
    last = max(c.curves[0].number for c in of("foot"))
    for c in of("ridge"):
        marked.append((Mark(shell, "R", c.curves[0].number if c.curves[0].family in GEODESICS else last + 1), c))
    return marked


def _beam_joints(design: Design, marked: list[tuple[Mark, Crossing]], beams: dict[CurveId, Beam]) -> list[BuiltJoint]:
    """Return all joints on beams with their parts and drillings."""
    listed = [(mark, crossing) for mark, crossing in marked if crossing.kind in ("AA", "AG", "boundary")]
    places: dict[CurveId, list[tuple[int, Floats]]] = defaultdict(list)
    for i, (_, crossing) in enumerate(listed):
        for curve in crossing.curves:
            if curve in beams:
                lift = beams[curve].layer * design.layer_offset
                places[curve].append((i, np.array(crossing.point) + lift * np.array(crossing.normal)))
    station = {
        (curve, i): float(s)
        for curve, at in places.items()
        for (i, _), s in zip(at, nearest_station(beams[curve].curve, np.array([p for _, p in at])), strict=True)
    }
    built = []
    for i, (mark, crossing) in enumerate(listed):
        if crossing.kind == "AA":
            pair = [beams[curve] for curve in crossing.curves]
            built.append(node_joint(design, mark, crossing, pair, [station[c, i] for c in crossing.curves]))
        else:
            beam = crossing.curves[0]
            built.append(block_joint(design, mark, crossing, beams[beam], station[beam, i]))
    return built


def _end_joints(
    design: Design, network: CurveNetwork, marked: list[tuple[Mark, Crossing]], among: list[Obstacle]
) -> list[BuiltJoint]:
    """Return the joints at the ends of the flat planks: feet, and straps at the top."""
    feet = [
        joint
        for mark, crossing in marked
        if crossing.kind == "foot"
        for joint in foot_joints(design, network, mark, crossing)
    ]
    straps = [
        strap_joint(design, network, mark, crossing, among) for mark, crossing in marked if crossing.kind == "ridge"
    ]
    return [*feet, *straps]


def _jointed(design: Design, plank: Plank, joints: list[Joint], beam: Beam | None) -> Plank:
    """Return a plank with the stations of its joints; on a sibling they are those of its own, shifted curve."""
    points = [(joint.mark, np.array(joint.point)) for joint in joints]
    if beam is not None:
        shift = design.sibling_offset * (1.0 if plank.mark == beam.planks[0] else -1.0)
        places = zip(joints, _on_beam(design, beam, joints), strict=True)
        points = [(joint.mark, point + shift * across) for joint, (point, across) in places]
    return replace(plank, joints=with_joints(plank, points))


def _on_beam(design: Design, beam: Beam, joints: list[Joint]) -> list[tuple[Floats, Floats]]:
    """Return for each joint the point on the beam's curve and the direction across it, each (3,)."""
    lift = beam.layer * design.layer_offset
    points = np.array([np.array(joint.point) + lift * np.array(joint.normal) for joint in joints])
    frames = frames_at(beam.curve, nearest_station(beam.curve, points))
    return list(zip(frames.point, frames.binormal, strict=True))


def _with_holes(
    design: Design, beams: list[Beam], planks: list[Plank], joints: list[Joint], drillings: list[Drilling]
) -> tuple[list[Beam], list[Plank]]:
    """Return beams and planks with the stations of their joints, the planks drilled."""
    by_plank, by_mark = grouped(drillings), {beam.mark: beam for beam in beams}
    members: dict[str, list[Joint]] = defaultdict(list)
    for joint in joints:
        for mark in joint.members:
            members[mark].append(joint)
    finished = [_jointed(design, drilled(p, by_plank[p.mark]), members[p.mark], by_mark.get(p.beam)) for p in planks]
    jointed_beams = []
    for beam in beams:
        on_beam = members[beam.planks[0]]
        places = _on_beam(design, beam, on_beam)
        points = [(joint.mark, point) for joint, (point, _) in zip(on_beam, places, strict=True)]
        jointed_beams.append(replace(beam, joints=with_joints(beam, points)))
    return jointed_beams, finished


def _by_field(parts: Sequence[Part]) -> dict[str, Any]:
    """Return parts by the field of a shell that holds their kind."""
    names = {row.field for row in KINDS.values() if row.place in ("shell", "ground")}
    return {name: tuple(part for part in parts if kind_of(part).field == name) for name in names}


def _blades(design: Design, network: CurveNetwork, parts: list[Part]) -> list[BladeJoint]:
    """Return the blades between the first shell and the second, clear of the parts of both."""
    count = design.shells.count
    if count == 1 or design.shells.top == "level":
        return []
    return blade_joints(design, network, [o for i in (0, 1) for o in obstacles(parts, _placement(i, count))])


def _shell(design: Design, network: CurveNetwork) -> tuple[Shell, list[BladeJoint]]:
    """Return the first shell, S1, and the blades between it and the second."""
    beams, planks = undrilled_members(design, 1, network)
    by_curve = {item.id: beam for item in network.curves for beam in beams if beam.mark == curve_mark(1, item.id)}
    marked = _numbered(network, 1)
    built = _beam_joints(design, marked, by_curve)
    upper = [c.point for _, c in marked if c.kind == "ridge"]
    among = obstacles([*planks, *near_parts((part for b in built for part in b.parts), upper)], UNMOVED)
    built += _end_joints(design, network, marked, among)
    parts = [part for b in built for part in b.parts]
    blades = _blades(design, network, [*planks, *near_parts(parts, upper)])
    joints = [b.joint for b in built]
    drillings = [d for b in built for d in b.drillings]
    for blade in blades:
        ours, theirs = own_sides(design, blade)
        joints_of_blade = [(ours, blade.left), (theirs, blade.right)]
        joints += [joint for joint, _ in joints_of_blade]
        drillings += [replace(d, joint=joint.mark) for joint, listed in joints_of_blade for d in listed]
    beams, planks = _with_holes(design, beams, planks, joints, drillings)
    shell = Shell(
        mark="S1",
        placement=UNMOVED,
        beams=tuple(beams),
        joints=tuple(b.joint for b in built),
        **_by_field([*planks, *parts]),
    )
    for added in ADDITIONS:
        shell = added(design, network, shell)
    return shell, blades


def _copy_of(value: _T, index: int, count: int) -> _T:
    """Return what belongs to the first shell, and to the ridges beside it, as that of the shell ``index`` places on."""
    return renamed(value, lambda text: turned_mark(text, index, count))


def _turned(frame: Frame, placement: Frame) -> Frame:
    """Return a frame turned with a shell about the centre."""
    turning = np.column_stack([placement.x, placement.y, placement.z])
    origin, x, y, z = (vector(turning @ np.array(v)) for v in (frame.origin, frame.x, frame.y, frame.z))
    return Frame(origin, x, y, z)


def _ridges(design: Design, blades: list[BladeJoint]) -> tuple[list[Blade], list[Bolt], list[Joint]]:
    """Return blades, bolts and joints of every ridge."""
    count = design.shells.count
    all_blades, bolts, joints = [], [], []
    for i in range(count):
        placement = _placement(i, count)
        for item in blades:
            copy = _copy_of(item, i, count)
            all_blades.append(replace(copy.blade, frame=_turned(copy.blade.frame, placement)))
            bolts += [replace(bolt, frame=_turned(bolt.frame, placement)) for bolt in copy.bolts]
            frame = all_blades[-1].frame
            joints.append(replace(copy.joint, point=frame.origin, normal=frame.z))
    return all_blades, bolts, joints


def _placement(index: int, count: int) -> Frame:
    motion = turn(2.0 * math.pi * index / count)
    return Frame((0.0, 0.0, 0.0), vector(motion[:3, 0]), vector(motion[:3, 1]), vector(motion[:3, 2]))


def gridshell_from(design: Design, network: CurveNetwork) -> Gridshell:
    """Return the whole gridshell: the shell of the network, repeated about the centre (paper sections 3.1 and 3.2)."""
    first, blade_joints_of_first = _shell(design, network)
    count = design.shells.count
    copies = (replace(_copy_of(first, i, count), twin_of=first.mark) for i in range(1, count))
    shells = [replace(shell, placement=_placement(i, count)) for i, shell in enumerate((first, *copies))]
    blades, bolts, joints = _ridges(design, blade_joints_of_first)
    timber, strength = design.timber, design.timber.strength
    return Gridshell(
        schema_version=SCHEMA_VERSION,
        name=design.project.name,
        title=design.project.title,
        timber=Timber(
            species=timber.species,
            strength_class=timber.strength_class,
            density=timber.density,
            modulus=strength.E0,
            shear_modulus=strength.G,
            bending_strength=strength.f_m,
            shear_strength=strength.f_v,
            min_bending_radius=timber.min_bending_radius,
            max_twist=math.radians(timber.max_twist_deg_per_m) / 1000.0,
        ),
        ground=design.bottom_height - design.supports.foot_height,
        shells=tuple(shells),
        blades=tuple(blades),
        bolts=tuple(bolts),
        joints=tuple(joints),
    )
