"""Folded steel blades between the ridge planks of neighbouring shells (Fig. 7k)."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from aag_cad.design import Design
from aag_cad.geometry.framed import Frames, frame_at, nearest_station
from aag_cad.geometry.revolution import turn
from aag_cad.geometry.surface import unit
from aag_cad.network.model import LEFT_RIDGE, RIGHT_RIDGE, CurveNetwork, NetworkCurve
from aag_cad.network.ridge import ridge_distance
from aag_cad.parts.clearance import Obstacle, is_free, placed_points
from aag_cad.parts.fasteners import axis_frame, hexagon_bolt
from aag_cad.parts.forming import formed_points
from aag_cad.parts.forms import FoldedPlate, Frame, PlateHole
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import Mark, parse_mark, part_mark, ridge_name, shell_of
from aag_cad.parts.members import Drilling, curve_mark
from aag_cad.parts.model import Blade, Bolt, Gridshell, Joint
from aag_cad.units import Floats, vector

_REACH = 30.0
_MIRRORED = 0.5
_SHIFT = 20.0


@dataclass(frozen=True)
class BladeJoint:
    """A blade between the first shell and the second: joint and parts in vault coordinates, and the drillings.

    ``left`` goes to the left ridge plank of the first shell; ``right`` to the right one of the second shell, in the
    coordinates of a shell of its own.
    """

    joint: Joint
    blade: Blade
    bolts: tuple[Bolt, ...]
    left: tuple[Drilling, ...]
    right: tuple[Drilling, ...]


def _across(shells: int) -> Floats:
    """Return the level normal (3,) of the left ridge plane of the first shell, pointing away from that shell."""
    half = math.pi / shells
    return np.array([math.sin(half), -math.cos(half), 0.0])


def _blade(design: Design, mark: str, place: Frames, side: float) -> tuple[Blade, list[tuple[Bolt, Floats, Floats]]]:
    """Return a blade on the inner (side -1) or outer face, and its bolts with centre and direction of their holes.

    The first two bolts are in the left plank of the first shell, the others are their mirror images.
    """
    ridge, timber = design.ridge, design.timber.thickness
    across = _across(design.shells.count)
    normal = place.normal
    fold = unit(np.cross(normal, across))
    fold = fold if np.cross(across, fold)[2] > 0.0 else -fold
    wing = unit(np.cross(fold, normal))
    wing = wing if wing @ across > 0.0 else -wing
    face = place.point + side * (timber + ridge.blade_thickness) / 2.0 * normal
    away = -float(face @ across) / float(wing @ across)
    origin = face + away * wing
    up = np.cross(across, fold)
    width = away + _REACH
    tip = -width * np.array([wing @ across, wing @ up])
    spread = ridge.blade_width / 2.0 - 2.5 * design.joints.bolt_diameter
    holes = tuple(
        PlateHole(width + way * away, offset, design.joints.bolt_hole)
        for way in (-1.0, 1.0)
        for offset in (-spread, spread)
    )
    line = ((float(tip[0]), float(tip[1])), (0.0, 0.0), (-float(tip[0]), float(tip[1])))
    plate = FoldedPlate(line, ridge.blade_width, ridge.blade_thickness, holes)
    blade = Blade(mark, Frame(vector(origin), vector(across), vector(fold), vector(up)), plate)
    bolts = []
    for i, hole in enumerate(holes, start=1):
        ours = i <= 2
        centre = place.point + hole.offset * fold
        direction = side * normal
        if not ours:
            centre, direction = _mirrored(centre, across), direction - 2.0 * (direction @ across) * across
        head = centre + (timber / 2.0 + ridge.blade_thickness) * direction
        frame = axis_frame(head, -direction, fold)
        bolt = hexagon_bolt(
            part_mark(mark, f"B{i}"), design.joints.bolt_diameter, timber + ridge.blade_thickness, frame
        )
        bolts.append((bolt, centre, direction))
    return blade, bolts


def _mirrored(point: Floats, across: Floats) -> Floats:
    return np.asarray(point - 2.0 * (point @ across) * across)


def _stations(design: Design, network: CurveNetwork, plank: NetworkCurve) -> list[float]:
    """Return the wished stations of the blades on the left ridge plank, from its start."""
    margin = max(design.ridge.blade_width / 2.0, 10.0 * design.joints.bolt_diameter) + 10.0
    low, high = plank.start + margin, plank.end - margin
    if design.ridge.blades == "equal":
        count = max(1, round((high - low) / design.ridge.blade_spacing))
        return [float(s) for s in np.linspace(low, high, count + 1)]
    found = [c.stations[1] for c in network.crossings if c.kind == "ridge" and c.curves[1] == plank.id]
    return sorted(min(max(s, low), high) for s in found if plank.id == LEFT_RIDGE)


def _tries(station: float, low: float, high: float, reach: float) -> Iterator[float]:
    """Yield stations nearer and farther on both sides of one, as far as the plank and the reach allow."""
    for i in range(int(reach / _SHIFT) + 1):
        for way in (1.0, -1.0) if i else (1.0,):
            if low <= station + way * i * _SHIFT <= high:
                yield station + way * i * _SHIFT


def _is_mirrored(network: CurveNetwork) -> bool:
    """Return whether the two ridge planks are mirror images, so that one folded blade fits both shells."""
    curves = {curve.id: curve for curve in network.curves}
    if LEFT_RIDGE not in curves or RIGHT_RIDGE not in curves:
        return False
    left, right = curves[LEFT_RIDGE], curves[RIGHT_RIDGE]
    points = left.curve.points * [1.0, -1.0, 1.0]
    gap = right.curve.point_spline(nearest_station(right.curve, points)) - points
    return bool(np.linalg.norm(gap, axis=1).max() < _MIRRORED)


def blade_joints(design: Design, network: CurveNetwork, among: Sequence[Obstacle]) -> list[BladeJoint]:
    """Return the blades between the first shell and the second, where the way is free, from the side to the crown.

    ``among``: what stands in the way in both shells, in vault coordinates. None where the ridge planks are
    no mirror images.
    """
    if not _is_mirrored(network):
        return []
    plank = next(curve for curve in network.curves if curve.id == LEFT_RIDGE)
    wished = _stations(design, network, plank)
    margin = design.ridge.blade_width / 2.0 + 30.0
    found: list[BladeJoint] = []
    last = -math.inf
    for station in wished:
        near = [abs(other - station) for other in wished if other != station]
        reach = min(near, default=2.0 * margin) / 2.0
        for at in _tries(station, plank.start + margin, plank.end - margin, reach):
            if at - last <= 2.0 * margin:
                continue
            if joint := _free_blade(design, len(found) + 1, frame_at(plank.curve, at), among):
                found.append(joint)
                last = at
                break
    return found


def _free_blade(design: Design, index: int, place: Frames, among: Sequence[Obstacle]) -> BladeJoint | None:
    """Return the blade at a place inside, else outside, or None where both are taken."""
    mark = str(Mark(0, ridge_name(1, 2), index))
    first, second = curve_mark(1, LEFT_RIDGE), curve_mark(2, RIGHT_RIDGE)
    others = [o for o in among if o.part.mark not in (first, curve_mark(1, RIGHT_RIDGE))]
    for side in (-1.0, 1.0):
        blade, bolts = _blade(design, mark, place, side)
        fasteners = tuple(bolt for bolt, _, _ in bolts)
        points = np.concatenate([placed_points(blade), *(placed_points(bolt) for bolt in fasteners)])
        if not is_free(points, others):
            continue
        back = turn(-2.0 * math.pi / design.shells.count)[:3, :3]
        drill = design.joints.bolt_hole
        left = tuple(Drilling(first, vector(c), vector(d), drill, "bolt", mark) for _, c, d in bolts[:2])
        right = tuple(
            Drilling(curve_mark(1, RIGHT_RIDGE), vector(back @ c), vector(back @ d), drill, "bolt", mark)
            for _, c, d in bolts[2:]
        )
        named = tuple(bolt.mark for bolt in fasteners)
        joint = Joint(mark, "blade", blade.frame.origin, blade.frame.z, (first, second, mark), named)
        return BladeJoint(joint, blade, fasteners, left, right)
    return None


def own_sides(design: Design, found: BladeJoint) -> tuple[Joint, Joint]:
    """Return the joint of a blade as the left ridge plank of the first shell sees it, and as its right one does.

    On its right the first shell meets the last: the marks and the coordinates are those of that ridge, in the first
    shell's own coordinates.
    """
    count = design.shells.count
    back = turn(-2.0 * math.pi / count)[:3, :3]
    left, right = (vector(np.mean([d.origin for d in side], axis=0)) for side in (found.left, found.right))
    old = found.joint.mark
    other = str(replace(parse_mark(old), family=ridge_name(count, 1)))
    ours = replace(found.joint, point=left, members=found.joint.members[:1])
    theirs = replace(
        found.joint,
        mark=other,
        point=right,
        normal=vector(back @ np.array(found.joint.normal)),
        members=(curve_mark(1, RIGHT_RIDGE),),
    )
    return ours, theirs


def ridge_gaps(gridshell: Gridshell) -> tuple[float, float] | None:
    """Return the smallest and largest clear gap between the ridge planks of neighbouring shells, mm; None without.

    It is twice the distance of the plank's nearer edge from the ridge plane, along the blades of the first ridge.
    """
    if not gridshell.blades:
        return None
    first = gridshell.joints[0].members[0]
    plank = index_of(gridshell).planks[first]
    stations = np.array([place.station for place in plank.joints if not shell_of(place.joint)])
    half = plank.blank.section.width / 2.0
    edges = [
        formed_points(plank, np.column_stack([stations, np.full_like(stations, y), np.zeros_like(stations)]))
        for y in (-half, half)
    ]
    gaps = 2.0 * np.minimum(*(ridge_distance(edge, len(gridshell.shells)) for edge in edges))
    return float(gaps.min()), float(gaps.max())
