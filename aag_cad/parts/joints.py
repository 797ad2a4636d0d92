"""The joints of beams: studs with their bolts, coupling blocks with bolt and screw."""

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from aag_cad.design import Design
from aag_cad.geometry.framed import FramedCurve, frame_at
from aag_cad.geometry.surface import unit
from aag_cad.network.model import Crossing, CurveId
from aag_cad.parts.fasteners import axis_frame, hexagon_bolt, wood_screw
from aag_cad.parts.forms import CrossHole, Frame, Hole
from aag_cad.parts.marks import Mark, part_mark
from aag_cad.parts.members import Drilling, curve_mark
from aag_cad.parts.model import Beam, Bolt, CouplingBlock, Joint, Part, Stud
from aag_cad.units import Floats, vector

# Station on a curve, offset across it, and the curve of the plank that a bolt passes there.
Place: TypeAlias = tuple[float, float, CurveId]


@dataclass(frozen=True)
class BuiltJoint:
    """A joint with the parts that it brings, and the axes on which planks are drilled for it."""

    joint: Joint
    parts: tuple[Part, ...]
    drillings: tuple[Drilling, ...]


def _beam_bolt(
    design: Design, mark: str, joint: str, beam: Beam, station: float, offset: float, slot: float = 0.0
) -> tuple[Bolt, tuple[Drilling, ...]]:
    """Return a bolt across a beam at a station, ``offset`` along the normal, and the drillings of both planks.

    ``slot`` is how much longer than round the holes are, along the planks.
    """
    at = frame_at(beam.curve, station)
    across, centre = at.binormal, at.point + offset * at.normal
    grip = design.joints.gap + 2 * design.timber.thickness
    bolt = hexagon_bolt(
        mark, design.joints.bolt_diameter, grip, axis_frame(centre + grip / 2.0 * across, -across, at.normal)
    )
    drillings = tuple(
        Drilling(
            plank,
            vector(centre + sign * design.sibling_offset * across),
            vector(across),
            design.joints.bolt_hole,
            "bolt",
            joint,
            slot,
        )
        for plank, sign in zip(beam.planks, (1.0, -1.0), strict=True)
    )
    return bolt, drillings


def steel_bolt(
    design: Design, mark: Mark, number: int, curve: FramedCurve, place: Place, side: float, steel: float
) -> tuple[Bolt, Drilling]:
    """Return a bolt through steel of a thickness and the plank at a place on a curve, and the drilling of the plank.

    The steel lies on the inner (``side`` -1) or outer face of the plank, the head on the steel.
    """
    station, offset, plank = place
    at, timber = frame_at(curve, station), design.timber.thickness
    normal, centre = side * at.normal, at.point + offset * at.binormal
    frame = axis_frame(centre + (timber / 2.0 + steel) * normal, -normal, at.tangent)
    bolt = hexagon_bolt(part_mark(mark, f"B{number}"), design.joints.bolt_diameter, timber + steel, frame)
    axis = vector(centre), vector(normal)
    return bolt, Drilling(curve_mark(mark.shell, plank), *axis, design.joints.bolt_hole, "bolt", str(mark))


def _stud_direction(directions: list[Floats], normal: Floats) -> Floats:
    """Return the flat normal (3,) of a hexagon that faces all given directions as well as one hexagon can."""
    first = unit(directions[0] - (directions[0] @ normal) * normal)
    second = np.cross(normal, first)
    angles = np.array([np.arctan2(d @ second, d @ first) for d in directions])
    turn = float(np.angle(np.exp(6j * angles).mean())) / 6.0
    return np.asarray(np.cos(turn) * first + np.sin(turn) * second)


def node_joint(design: Design, mark: Mark, crossing: Crossing, beams: list[Beam], stations: list[float]) -> BuiltJoint:
    """Return an AA node: one stud along the normal through both gaps, two bolts through each beam and the stud.

    The planks' holes are slots if the design asks for them, so that the node can turn while the web is deployed.
    """
    point, normal = np.array(crossing.point), np.array(crossing.normal)
    across = [frame_at(beam.curve, station).binormal for beam, station in zip(beams, stations, strict=True)]
    frame = axis_frame(point, normal, _stud_direction(across, normal))
    bolts: list[Bolt] = []
    drillings: list[Drilling] = []
    holes: list[CrossHole] = []
    for beam, station, direction in zip(beams, stations, across, strict=True):
        for offset in (-design.joints.bolt_offset, design.joints.bolt_offset):
            bolt, drilled = _beam_bolt(
                design, part_mark(mark, f"B{len(bolts) + 1}"), str(mark), beam, station, offset, design.joints.stud_slot
            )
            bolts.append(bolt)
            drillings += drilled
            angle = float(np.arctan2(direction @ np.array(frame.y), direction @ np.array(frame.x)))
            height = beam.layer * design.layer_offset + offset
            holes.append(CrossHole(height, angle, design.joints.bolt_hole))
    stud = Stud(str(mark), frame, design.joints.stud_length, design.joints.stud_across_flats, tuple(holes))
    members = (*(plank for beam in beams for plank in beam.planks), stud.mark)
    joint = Joint(str(mark), "AA", crossing.point, crossing.normal, members, tuple(bolt.mark for bolt in bolts))
    return BuiltJoint(joint, (stud, *bolts), tuple(drillings))


def block_joint(design: Design, mark: Mark, crossing: Crossing, beam: Beam, station: float) -> BuiltJoint:
    """Return the joint of a flat plank on a beam: block in the gap, one bolt across it, one screw through the plank.

    The block sits at the crossing, or flush with the end of the beam where that is nearer than half its length. The
    bolt passes on the far side of the beam's centre line from the flat plank, clear of the screw's point.
    """
    shell = mark.shell
    length, away = design.joints.block_length, float(beam.layer)
    place = min(max(station, length / 2.0), beam.curve.length - length / 2.0)
    at = frame_at(beam.curve, place)
    frame = Frame(vector(at.point), vector(at.tangent), vector(at.normal), vector(-at.binormal))
    offset = away * design.joints.bolt_offset
    bolt, drillings = _beam_bolt(design, part_mark(mark, "B1"), str(mark), beam, place, offset)
    block = CouplingBlock(
        str(mark),
        frame,
        length,
        design.timber.width,
        design.joints.gap,
        (Hole(0.0, offset, design.joints.bolt_hole, "bolt", str(mark)),),
    )
    up = np.array(crossing.normal)
    head = np.array(crossing.point) - away * design.timber.thickness / 2.0 * up
    screw = wood_screw(
        part_mark(mark, "W1"),
        design.joints.screw_diameter,
        design.joints.screw_length,
        axis_frame(head, away * up, at.tangent),
    )
    plank = curve_mark(shell, crossing.curves[1])
    drilling = Drilling(plank, crossing.point, crossing.normal, design.joints.screw_hole, "screw", str(mark))
    joint = Joint(
        str(mark),
        "boundary" if crossing.kind == "boundary" else "AG",
        crossing.point,
        crossing.normal,
        (*beam.planks, plank, block.mark),
        (bolt.mark, screw.mark),
    )
    return BuiltJoint(joint, (block, bolt, screw), (*drillings, drilling))
