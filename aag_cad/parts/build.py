"""The gridshell of a design and its network: all parts and joints of all shells."""

import math
from collections import defaultdict
from dataclasses import fields, is_dataclass, replace
from typing import TypeVar

import numpy as np

from aag_cad.design import Design
from aag_cad.geometry.framed import FramedCurve, frames_at
from aag_cad.geometry.patches import turn
from aag_cad.network.model import Crossing, CurveId, CurveNetwork
from aag_cad.parts.joints import BuiltJoint, block_joint, end_joint, node_joint
from aag_cad.parts.marks import Mark
from aag_cad.parts.members import (
    curve_mark,
    drilled,
    grouped,
    stations_of,
    undrilled_members,
    with_joints,
)
from aag_cad.parts.model import (
    SCHEMA_VERSION,
    Beam,
    Bolt,
    CouplingBlock,
    Frame,
    Gridshell,
    Joint,
    Plank,
    Screw,
    Shell,
    Stud,
    Timber,
)
from aag_cad.units import Floats, vector

_T = TypeVar("_T")


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
        marked.append((Mark(shell, "R", c.curves[0].number if c.curves[0].family == "G" else last + 1), c))
    return marked


def _built_joints(design: Design, marked: list[tuple[Mark, Crossing]], beams: dict[CurveId, Beam]) -> list[BuiltJoint]:
    """Return all joints with their parts and drillings."""
    places: dict[CurveId, list[tuple[int, Floats]]] = defaultdict(list)
    for i, (_, crossing) in enumerate(marked):
        for curve in crossing.curves:
            if curve in beams:
                lift = beams[curve].layer * design.layer_offset
                places[curve].append((i, np.array(crossing.point) + lift * np.array(crossing.normal)))
    station = {
        (curve, i): float(s)
        for curve, listed in places.items()
        for (i, _), s in zip(listed, stations_of(beams[curve], np.array([p for _, p in listed])), strict=True)
    }
    built = []
    for i, (mark, crossing) in enumerate(marked):
        if crossing.kind == "AA":
            pair = [beams[curve] for curve in crossing.curves]
            built.append(node_joint(design, mark, crossing, pair, [station[c, i] for c in crossing.curves]))
        elif crossing.kind in ("AG", "boundary"):
            beam = crossing.curves[0]
            built.append(block_joint(design, mark, crossing, beams[beam], station[beam, i]))
        else:
            built.append(end_joint(mark, crossing))
    return built


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
    frames = frames_at(beam.curve, stations_of(beam, points))
    return list(zip(frames.point, frames.binormal, strict=True))


def _shell(design: Design, network: CurveNetwork) -> Shell:
    """Return the first shell, S1."""
    beams, planks = undrilled_members(design, 1, network)
    by_curve = {item.id: beam for item in network.curves for beam in beams if beam.mark == curve_mark(1, item.id)}
    built = _built_joints(design, _numbered(network, 1), by_curve)
    joints = [b.joint for b in built]
    parts = [part for b in built for part in b.parts]
    drillings = grouped(d for b in built for d in b.drillings)
    members: dict[str, list[Joint]] = defaultdict(list)
    for joint in joints:
        for mark in joint.members:
            members[mark].append(joint)
    by_mark = {beam.mark: beam for beam in beams}
    finished = [_jointed(design, drilled(p, drillings[p.mark]), members[p.mark], by_mark.get(p.beam)) for p in planks]
    jointed_beams = []
    for beam in beams:
        on_beam = members[beam.planks[0]]
        places = _on_beam(design, beam, on_beam)
        points = [(joint.mark, point) for joint, (point, _) in zip(on_beam, places, strict=True)]
        jointed_beams.append(replace(beam, joints=with_joints(beam, points)))
    return Shell(
        mark="S1",
        placement=Frame((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
        planks=tuple(finished),
        beams=tuple(jointed_beams),
        studs=tuple(p for p in parts if isinstance(p, Stud)),
        blocks=tuple(p for p in parts if isinstance(p, CouplingBlock)),
        bolts=tuple(p for p in parts if isinstance(p, Bolt)),
        screws=tuple(p for p in parts if isinstance(p, Screw)),
        joints=tuple(joints),
    )


def _renamed(value: _T, old: str, new: str) -> _T:
    """Return plain data with the shell's mark exchanged in every mark; curves are shared, not copied."""
    if isinstance(value, str):
        ours = value == old or value.startswith(f"{old}-")
        return new + value[len(old) :] if ours else value  # type: ignore[return-value]
    if isinstance(value, tuple):
        return tuple(_renamed(item, old, new) for item in value)  # type: ignore[return-value]
    if is_dataclass(value) and not isinstance(value, type | FramedCurve):
        changed = {f.name: _renamed(getattr(value, f.name), old, new) for f in fields(value)}
        return replace(value, **changed)
    return value


def _placement(index: int, count: int) -> Frame:
    motion = turn(2.0 * math.pi * index / count)
    return Frame((0.0, 0.0, 0.0), vector(motion[:3, 0]), vector(motion[:3, 1]), vector(motion[:3, 2]))


def gridshell_from(design: Design, network: CurveNetwork) -> Gridshell:
    """Return the whole gridshell: the shell of the network, repeated about the centre (paper sections 3.1 and 3.2)."""
    first = _shell(design, network)
    count = design.shells.count
    shells = [replace(_renamed(first, "S1", f"S{i + 1}"), placement=_placement(i, count)) for i in range(count)]
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
    )
