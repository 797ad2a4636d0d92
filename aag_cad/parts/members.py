"""Planks and coupled beams from the curves of a network: curves first, holes when the joints are known."""

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from aag_cad.design import Design
from aag_cad.families import FAMILIES, Family
from aag_cad.geometry.framed import FramedCurve, nearest_station, offset_curve
from aag_cad.network.model import CurveId, CurveNetwork
from aag_cad.parts.forming import axis_piercings
from aag_cad.parts.forms import Blank, CrossSection, Hole, HoleUse
from aag_cad.parts.marks import Mark, part_mark
from aag_cad.parts.model import Beam, JointStation, Member, Plank
from aag_cad.units import Floats, Vector


@dataclass(frozen=True)
class Drilling:
    """An axis that a plank is drilled on: near the plank, in shell coordinates; ``slot`` as in ``Hole``."""

    plank: str
    origin: Vector
    direction: Vector
    diameter: float
    use: HoleUse
    joint: str
    slot: float = 0.0


def curve_mark(shell: int, curve: CurveId) -> str:
    """Return the mark of the beam or plank on a curve."""
    return str(Mark(shell, curve.family, curve.number))


def _plank(design: Design, mark: str, beam: str, family: Family, curve: FramedCurve) -> Plank:
    section = CrossSection(design.timber.width, design.timber.thickness)
    return Plank(
        mark=mark,
        family=family,
        layer=FAMILIES[family].layer,
        upright=bool(beam),
        beam=beam,
        curve=curve,
        blank=Blank(curve.length, section, ()),
        joints=(),
    )


def undrilled_members(design: Design, shell: int, network: CurveNetwork) -> tuple[list[Beam], list[Plank]]:
    """Return the beams and planks of a shell with their curves, still without holes and joints.

    The beam's curve lies on the parallel surface of its layer; its planks lie left (+) and right (-) of it. Each is
    the centre line of a straight plank: its own arc length is the length of the blank.
    """
    beams, planks = [], []
    for item in network.curves:
        mark, family = curve_mark(shell, item.id), item.id.family
        layer = FAMILIES[family].layer
        if not FAMILIES[family].upright:
            line = offset_curve(item.curve, 0.0, 0.0, item.start, item.end)
            planks.append(_plank(design, mark, "", family, line))
            continue
        axis = offset_curve(item.curve, layer * design.layer_offset, 0.0, item.start, item.end)
        beams.append(Beam(mark, family, layer, (part_mark(mark, "L"), part_mark(mark, "R")), axis, ()))
        for side, sign in (("L", 1.0), ("R", -1.0)):
            line = offset_curve(axis, 0.0, sign * design.sibling_offset, 0.0, axis.length)
            planks.append(_plank(design, part_mark(mark, side), mark, family, line))
    return beams, planks


def drilled(plank: Plank, drillings: Iterable[Drilling]) -> Plank:
    """Return the plank with its holes: each where its straight axis pierces the formed plank's middle surface."""
    wanted = list(drillings)
    if not wanted:
        return plank
    places = axis_piercings(plank, np.array([d.origin for d in wanted]), np.array([d.direction for d in wanted]))
    holes = [
        Hole(float(x), float(y), d.diameter, d.use, d.joint, d.slot) for (x, y), d in zip(places, wanted, strict=True)
    ]
    ordered = tuple(sorted(holes, key=lambda hole: (hole.station, hole.offset)))
    return replace(plank, blank=replace(plank.blank, holes=ordered))


def with_joints(member: Member, joints: Iterable[tuple[str, Floats]]) -> tuple[JointStation, ...]:
    """Return the joint stations of a member, sorted, from joint marks and points (3,) near its curve."""
    listed = list(joints)
    if not listed:
        return ()
    stations = nearest_station(member.curve, np.array([point for _, point in listed]))
    return tuple(
        sorted(
            (JointStation(mark, float(s)) for (mark, _), s in zip(listed, stations, strict=True)),
            key=lambda joint: (joint.station, joint.joint),
        )
    )


def grouped(drillings: Iterable[Drilling]) -> dict[str, list[Drilling]]:
    """Return the drillings by the mark of their plank."""
    groups: dict[str, list[Drilling]] = defaultdict(list)
    for drilling in drillings:
        groups[drilling.plank].append(drilling)
    return groups
