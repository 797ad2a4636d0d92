"""Steel straps: the end of a geodesic on the edge plank that it stops at, and the two ridge planks at the crown."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from aag_cad.design import Design
from aag_cad.families import GEODESICS
from aag_cad.geometry.framed import FramedCurve, frame_at, framed_curve, frames_at, nearest_station, offset_curve
from aag_cad.geometry.surface import unit
from aag_cad.network.model import Crossing, CurveId, CurveNetwork, NetworkCurve
from aag_cad.parts.clearance import Obstacle, is_free, placed_points
from aag_cad.parts.forms import Blank, CrossSection, Hole
from aag_cad.parts.joints import BuiltJoint, Place, steel_bolt
from aag_cad.parts.marks import Mark
from aag_cad.parts.members import curve_mark
from aag_cad.parts.model import Joint, Part, Strap
from aag_cad.units import Floats

_STEEL_END = 20.0
_FARTHEST = 160.0
_BACK = 10.0
_PAST = 60.0


@dataclass(frozen=True, eq=False)
class _StrapLine:
    """The line of a strap on the surface and, for each of the two planks, ways to place its bolts, the best first."""

    curve: FramedCurve
    ways: tuple[tuple[tuple[Place, ...], ...], tuple[tuple[Place, ...], ...]]


def _line_over_geodesic(design: Design, geodesic: NetworkCurve, crossing: Crossing) -> _StrapLine:
    """Return the line over the end of a geodesic and the edge plank past it.

    Beams in the way move the bolts of the geodesic back, those of the edge plank aside, and at last leave it one.
    """
    diameter = design.joints.bolt_diameter
    step, aside = 5.0 * diameter, 1.5 * diameter
    plank, edge = crossing.curves
    end, middle = geodesic.end, crossing.stations[0]
    nearest = design.joints.loaded_end
    backs = np.arange(nearest, nearest + _FARTHEST, _BACK).tolist()
    own = tuple(((end - back - step, 0.0, plank), (end - back, 0.0, plank)) for back in backs)
    offsets = (0.0, aside, -aside)
    pairs = tuple(((middle - step / 2.0, y, edge), (middle + step / 2.0, y, edge)) for y in offsets)
    singles = tuple(((middle + along, y, edge),) for y in offsets for along in (0.0, diameter, -diameter))
    return _StrapLine(geodesic.curve, (own, (*pairs, *singles)))


def _line_over_crown(
    design: Design, curves: dict[CurveId, NetworkCurve], crossing: Crossing, back: float
) -> _StrapLine:
    """Return the straight line between two ridge planks, ``back`` mm from the ends at which they meet."""
    half = 3.0 * design.joints.bolt_diameter
    ends = []
    for curve in (curves[name] for name in crossing.curves):
        nearer_start = crossing.stations[0] - curve.start < curve.end - crossing.stations[0]
        at = frame_at(curve.curve, curve.start + back if nearer_start else curve.end - back)
        ends.append((at.point, at.normal))
    (a, n), (b, m) = ends
    reach = float(np.linalg.norm(b - a))

    def evaluate(t: Floats) -> tuple[Floats, Floats]:
        u = (t / reach)[:, None]
        return a + u * (b - a), unit((1.0 - u) * n + u * m)

    line = framed_curve(evaluate, -_PAST, reach + _PAST, reach + 2.0 * _PAST)
    first, last = (
        ((_PAST + at - half, 0.0, name), (_PAST + at + half, 0.0, name))
        for at, name in zip((0.0, reach), crossing.curves, strict=True)
    )
    return _StrapLine(line, ((first,), (last,)))


def _strap(design: Design, mark: Mark, line: _StrapLine, places: Sequence[Place], side: float) -> Strap:
    """Return the strap on the inner (side -1) or outer face, just long enough for its bolts."""
    ridge = design.ridge
    at = np.array([station for station, _, _ in places])
    low, high = float(at.min()) - _STEEL_END, float(at.max()) + _STEEL_END
    off = side * (design.timber.thickness + ridge.strap_thickness) / 2.0
    curve = offset_curve(line.curve, off, 0.0, low, high)
    stations = nearest_station(curve, frames_at(line.curve, at).point, at - low)
    holes = tuple(
        Hole(float(s), offset, design.joints.bolt_hole, "bolt", str(mark))
        for s, (_, offset, _) in zip(stations, places, strict=True)
    )
    return Strap(str(mark), curve, Blank(curve.length, CrossSection(ridge.strap_width, ridge.strap_thickness), holes))


def _strapped(
    design: Design, mark: Mark, crossing: Crossing, line: _StrapLine, places: Sequence[Place], side: float
) -> BuiltJoint:
    strap = _strap(design, mark, line, places, side)
    steel = design.ridge.strap_thickness
    bolted = [steel_bolt(design, mark, i, line.curve, place, side, steel) for i, place in enumerate(places, start=1)]
    members = (*(curve_mark(mark.shell, name) for name in crossing.curves), strap.mark)
    fasteners = tuple(bolt.mark for bolt, _ in bolted)
    joint = Joint(str(mark), "ridge", crossing.point, crossing.normal, members, fasteners)
    return BuiltJoint(joint, (strap, *(bolt for bolt, _ in bolted)), tuple(drilling for _, drilling in bolted))


def strap_joint(
    design: Design, network: CurveNetwork, mark: Mark, crossing: Crossing, among: Sequence[Obstacle]
) -> BuiltJoint:
    """Return a ridge joint with a strap inside, or outside where beams take the inside.

    Where neither is free it lies inside, and the audit reports what runs into it; at the crown, where the beams in the
    way tie the ridge planks themselves, there is none then, and the audit notes a joint without fasteners.
    """
    curves = {curve.id: curve for curve in network.curves}
    names = crossing.curves
    if names[0].family in GEODESICS:
        lines = [_line_over_geodesic(design, curves[names[0]], crossing)]
    else:
        nearest = design.joints.loaded_end + 6.0 * design.joints.bolt_diameter
        backs = np.arange(nearest, 3.0 * nearest, 2.0 * _BACK).tolist()
        lines = [_line_over_crown(design, curves, crossing, back) for back in backs]
    own = {curve_mark(mark.shell, name) for name in names}
    others = [obstacle for obstacle in among if obstacle.part.mark not in own]

    def free(*parts: Part) -> bool:
        return all(is_free(placed_points(part), others) for part in parts)

    def first_free(line: _StrapLine, ways: tuple[tuple[Place, ...], ...], side: float) -> tuple[Place, ...] | None:
        steel = design.ridge.strap_thickness
        bolts = ((way, [steel_bolt(design, mark, 1, line.curve, at, side, steel)[0] for at in way]) for way in ways)
        return next((way for way, bolted in bolts if free(*bolted)), None)

    for line, side in product(lines, (-1.0, 1.0)):
        chosen = [first_free(line, ways, side) for ways in line.ways]
        places = [place for way in chosen if way is not None for place in way]
        if None not in chosen and free(_strap(design, mark, line, places, side)):
            return _strapped(design, mark, crossing, line, places, side)
    if names[0].family not in GEODESICS:
        members = tuple(curve_mark(mark.shell, name) for name in names)
        return BuiltJoint(Joint(str(mark), "ridge", crossing.point, crossing.normal, members, ()), (), ())
    return _strapped(design, mark, crossing, lines[0], [*lines[0].ways[0][0], *lines[0].ways[1][0]], -1.0)
