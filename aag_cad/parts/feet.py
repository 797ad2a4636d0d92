"""The feet of a shell: steel shoes on geodesic and bottom plank, threaded rods, precast concrete blocks (Fig. 8a)."""

import math
from dataclasses import dataclass

import numpy as np

from aag_cad.design import Design
from aag_cad.errors import DesignError
from aag_cad.families import FAMILIES
from aag_cad.geometry.framed import frame_at, frames_at
from aag_cad.geometry.surface import unit
from aag_cad.network.model import Crossing, CurveNetwork, NetworkCurve
from aag_cad.parts.fasteners import threaded_rod
from aag_cad.parts.forms import FoldedPlate, Frame, PlateHole
from aag_cad.parts.joints import BuiltJoint, Place, steel_bolt
from aag_cad.parts.marks import Mark, part_mark
from aag_cad.parts.members import curve_mark
from aag_cad.parts.model import Footing, Joint, Rod, Shoe
from aag_cad.units import Floats, vector

_ROD_SPARE = 6.0
_LEVEL = 0.2
_LINE_STEP = 15.0


@dataclass(frozen=True, eq=False)
class _Site:
    """A foot: its marks and curves, the frame (z up, x outward, level), the side of the shoe along the normal (+-1)."""

    mark: Mark
    crossing: Crossing
    geodesic: NetworkCurve
    frame: Frame
    side: float
    beam: Floats


def _beam_at(network: CurveNetwork, crossing: Crossing, reach: float) -> tuple[int, Floats] | None:
    """Return layer and direction (3,) of the beam that crosses the bottom plank at a foot, or None."""
    curves = {curve.id: curve for curve in network.curves}
    for other in network.crossings:
        near = np.linalg.norm(np.subtract(other.point, crossing.point)) < reach
        if other.kind == "boundary" and other.curves[1] == crossing.curves[1] and near:
            beam = other.curves[0]
            return FAMILIES[beam.family].layer, frame_at(curves[beam].curve, other.stations[0]).tangent
    return None


def _site(design: Design, network: CurveNetwork, mark: Mark, crossing: Crossing) -> _Site:
    geodesic = next(curve for curve in network.curves if curve.id == crossing.curves[0])
    outward = np.array(crossing.normal) * [1.0, 1.0, 0.0]
    if np.linalg.norm(outward) < _LEVEL:
        raise DesignError(
            f"shells: the surface lies flat at foot {mark}, its normal leans {np.linalg.norm(outward):.2f} off the "
            f"vertical where a shoe takes {_LEVEL:g} or more; crop the shell where it is steeper"
        )
    x, z = unit(outward), np.array([0.0, 0.0, 1.0])
    frame = Frame(crossing.point, vector(x), vector(np.cross(z, x)), vector(z))
    beam = _beam_at(network, crossing, design.timber.width)
    layer, direction = beam if beam is not None else (1, np.zeros(3))
    return _Site(mark, crossing, geodesic, frame, -float(layer), direction)


def _in_plane(site: _Site, points: Floats) -> Floats:
    """Return points (n, 3) as (x, z) in the frame of a foot, (n, 2)."""
    gap = points - np.array(site.frame.origin)
    return np.column_stack([gap @ np.array(site.frame.x), gap @ np.array(site.frame.z)])


def _bolt_stations(design: Design, site: _Site) -> tuple[float, float]:
    """Return the stations on the geodesic's curve of its own bolts, and of the highest point of the shoe."""
    bolts = site.geodesic.start + design.joints.loaded_end
    return bolts, bolts + 2.0 * design.joints.bolt_diameter


def _stand(design: Design, rod: Rod) -> float:
    """Return how high the underside of a shoe's foot is over the block: lower nut, adjustment and a spare thread."""
    return rod.nut_height + rod.washer_thickness + design.supports.adjustment + _ROD_SPARE


def _rod(design: Design, site: _Site) -> Rod:
    """Return the threaded rod of a foot beside the inner face of the shoe, its lower half in the block."""
    supports = design.supports
    probe = threaded_rod("", supports.rod_diameter, 0.0, (0.0, 0.0), site.frame)
    stand, depth = _stand(design, probe), min(0.5 * supports.block_size[2], 8.0 * supports.rod_diameter)
    carries = depth + stand
    presses = carries + supports.shoe_thickness
    past_nut = probe.washer_thickness + probe.nut_height
    length = float(math.ceil(presses + supports.adjustment + past_nut + _ROD_SPARE))
    clear = probe.washer_diameter / 2.0 + design.supports.shoe_thickness / 2.0 + 2.0
    x, z = _fold(design, site, stand)
    at = (
        np.array(site.frame.origin)
        + (x - site.side * clear) * np.array(site.frame.x)
        + (z - supports.shoe_thickness / 2.0 - carries) * np.array([0.0, 0.0, 1.0])
    )
    frame = Frame(vector(at), site.frame.x, site.frame.y, site.frame.z)
    block = Mark(site.mark.shell, "C", site.mark.index)
    return threaded_rod(part_mark(block, "T1"), supports.rod_diameter, length, (carries, presses), frame)


def _upright(design: Design, site: _Site) -> tuple[Floats, Floats]:
    """Return stations (n,) on the geodesic's curve, falling, and the centre line of the shoe's upright there (n, 2)."""
    _bolt, top = _bolt_stations(design, site)
    low = site.crossing.stations[0] - design.timber.width / 2.0
    stations = np.linspace(top, low, max(3, int((top - low) / _LINE_STEP) + 1))
    frames = frames_at(site.geodesic.curve, stations)
    off = site.side * (design.timber.thickness + design.supports.shoe_thickness) / 2.0
    return stations, _in_plane(site, frames.point + off * frames.normal)


def _fold(design: Design, site: _Site, stand: float) -> Floats:
    """Return (x, z) where the upright, straight on below the bottom plank, meets the shoe's foot at mid-thickness."""
    _stations, line = _upright(design, site)
    down = unit(line[-1] - line[-2])
    ground = design.bottom_height - design.supports.foot_height - site.crossing.point[2]
    level = ground + stand + design.supports.shoe_thickness / 2.0
    if line[-1, 1] <= level:
        raise DesignError(
            f"supports.foot_height: {design.supports.foot_height:g} mm leaves no room for the shoe {site.mark} under "
            f"the bottom plank; at least {design.supports.foot_height + level - line[-1, 1] + 1.0:.0f} mm"
        )
    return np.asarray(line[-1] + (level - line[-1, 1]) / down[1] * down)


def _plate(design: Design, site: _Site, rod: Rod) -> FoldedPlate:
    """Return the shoe as a folded plate, from the top of its upright to the end of its foot, with its holes."""
    supports, joints = design.supports, design.joints
    stations, line = _upright(design, site)
    fold = _fold(design, site, _stand(design, rod))
    rod_x = _in_plane(site, np.array([rod.frame.origin]))[0, 0]
    end = rod_x - site.side * (rod.washer_diameter / 2.0 + 8.0)
    whole = np.vstack([line, fold, [end, fold[1]]])
    run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(whole, axis=0), axis=1))])
    holes = []
    for station, y, _ in _bolt_places(design, site):
        along = float(np.interp(station, stations[::-1], run[: len(stations)][::-1]))
        across = float(np.array(site.frame.y) @ frame_at(site.geodesic.curve, station).binormal)
        holes.append(PlateHole(along, across * y, joints.bolt_hole))
    holes.append(PlateHole(float(run[-2] + abs(rod_x - fold[0])), 0.0, supports.rod_diameter + 2.0))
    return FoldedPlate(
        tuple((float(x), float(z)) for x, z in whole), supports.shoe_width, supports.shoe_thickness, tuple(holes)
    )


def _bolt_places(design: Design, site: _Site) -> list[Place]:
    """Return the places on the geodesic's curve of the four bolts of a foot.

    Two side by side in the geodesic; two in the bottom plank, on the diagonal that is farther from the crossing beam.
    """
    geodesic, edge = site.crossing.curves
    own, _top = _bolt_stations(design, site)
    clear = 3.0 * design.joints.bolt_diameter + 0.5
    y = design.supports.shoe_width / 2.0 - 15.0
    up = design.timber.width / 2.0 - clear
    foot = site.crossing.stations[0]
    at = frame_at(site.geodesic.curve, foot)
    lean = float((site.beam @ at.tangent) * (site.beam @ at.binormal))
    turn = -1.0 if lean > 0.0 else 1.0
    inner = design.joints.bolt_offset
    return [(own, inner, geodesic), (own, -inner, geodesic), (foot + up, turn * y, edge), (foot - up, -turn * y, edge)]


def foot_joints(design: Design, network: CurveNetwork, mark: Mark, crossing: Crossing) -> list[BuiltJoint]:
    """Return the two joints of a foot: planks in a shoe, shoe on a concrete block; DesignError where they have no room.

    The shoe lies on the side of the planks that the crossing beam leaves free.
    """
    site = _site(design, network, mark, crossing)
    rod = _rod(design, site)
    shoe = Shoe(str(mark), site.frame, _plate(design, site, rod))
    top = np.array(rod.frame.origin) + (rod.nuts[0] - _stand(design, rod)) * np.array([0.0, 0.0, 1.0])
    block = str(Mark(mark.shell, "C", mark.index))
    footing = Footing(
        block, Frame(vector(top), *(site.frame.x, site.frame.y, site.frame.z)), *design.supports.block_size
    )
    bolted = [
        steel_bolt(design, mark, i, site.geodesic.curve, place, site.side, design.supports.shoe_thickness)
        for i, place in enumerate(_bolt_places(design, site), start=1)
    ]
    bolts, drillings = zip(*bolted, strict=True)
    members = (*(curve_mark(mark.shell, curve) for curve in crossing.curves), shoe.mark)
    shod = Joint(str(mark), "foot", crossing.point, crossing.normal, members, tuple(bolt.mark for bolt in bolts))
    stood = Joint(block, "footing", footing.frame.origin, footing.frame.z, (shoe.mark, footing.mark), (rod.mark,))
    return [BuiltJoint(shod, (shoe, *bolts), drillings), BuiltJoint(stood, (rod, footing), ())]
