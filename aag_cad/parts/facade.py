"""The cover of a shell: aluminium bars on the geodesics, bent sheets between them, screwed to the coupling blocks."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from itertools import pairwise
from typing import TypeVar

import numpy as np
from scipy.optimize import brentq

from aag_cad.design import Design
from aag_cad.design_tables import LevelShells
from aag_cad.errors import DesignError
from aag_cad.families import GEODESICS, LAYERS
from aag_cad.geometry.developable import ruled_edges, shared_range
from aag_cad.geometry.framed import SAMPLE_SPACING, FramedCurve, frames_at, nearest_station, offset_curve
from aag_cad.network.model import CurveNetwork, NetworkCurve
from aag_cad.network.ridge import ridge_distance
from aag_cad.parts.clearance import Obstacle, is_free, obstacles, placed_points
from aag_cad.parts.fasteners import axis_frame, wood_screw
from aag_cad.parts.forming import axis_piercings
from aag_cad.parts.forms import Blank, CrossSection, Frame, Hole
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import Mark, joint_of, parse_mark, part_mark
from aag_cad.parts.members import Drilling, curve_mark, drilled, grouped, with_joints
from aag_cad.parts.model import ClampingBar, CouplingBlock, Joint, Mullion, Plank, Screw, Shell, Strip
from aag_cad.parts.shapes.sheet import Limit, Sheet, along_cut, depth_inside, sheet_of
from aag_cad.units import MM_PER_M, vector

# Four samples past the end of a curve its spline is off by about 0.02 mm, and slanting cuts leave little sheet there.
_REACH = 4.0 * SAMPLE_SPACING
_SAFE = 1e-3
_PASSES = 20
# How far a bar may reach past its last support, as a share of the spacing.
FREE_END = 0.75
# The bars are a little longer than the geodesic under them.
_EARLY = 0.95
# A block on the geodesic: its length, and from the plank's end to its screw (12 d).
_STAND_OFF_LENGTH = 100.0
_STAND_OFF_END = 75.0
_STEP = 10.0

_Bar = TypeVar("_Bar", Mullion, ClampingBar)


@dataclass(frozen=True)
class FacadePieces:
    """What covers one shell, in shell coordinates, each sorted by mark; all empty without a cover.

    ``blocks`` stand on geodesics where outer beams are far apart; ``drillings`` are their screw holes in the planks.
    """

    mullions: tuple[Mullion, ...] = ()
    strips: tuple[Strip, ...] = ()
    clamps: tuple[ClampingBar, ...] = ()
    screws: tuple[Screw, ...] = ()
    blocks: tuple[CouplingBlock, ...] = ()
    joints: tuple[Joint, ...] = ()
    drillings: tuple[Drilling, ...] = ()


@dataclass(frozen=True)
class _Line:
    """A geodesic with its plank, the bars over it, and the strips beside it."""

    item: NetworkCurve
    plank: Plank
    mullion: Mullion
    clamp: ClampingBar
    strips: tuple[str, ...]


def beam_face(design: Design) -> float:
    """Return how far the outer faces of the outer beams lie from the surface along its normal, mm."""
    return design.layer_offset + design.timber.width / 2.0


def strip_neighbours(design: Design, index: int) -> tuple[int, int]:
    """Return the numbers of the geodesics under the left and the right edge of a strip."""
    return index, index % design.pattern.geodesics + 1 if design.closed else index + 1


def _over_foot(design: Design) -> Limit:
    lowest = design.bottom_height + design.facade.foot_clearance
    return lambda points: points[:, 2] - lowest


def _below_top(design: Design, item: NetworkCurve, clearance: float) -> Limit:
    """Return the limit at the upper end: the ridge planes, or on a level top the end of the geodesic's plank."""
    if not isinstance(design.shells, LevelShells):
        return lambda points: ridge_distance(points, design.shells.count) - clearance
    frames = frames_at(item.curve, np.array([item.end]))
    return lambda points: (frames.point[0] - points) @ frames.tangent[0]


def _where(inside: Callable[[float], float], outer: float, inner: float, key: str, mark: str) -> float:
    """Return where between ``outer`` and ``inner`` a limit is met; DesignError with the key if it is not."""
    if inside(outer) > 0.0 or inside(inner) <= 0.0:
        raise DesignError(
            f"{key}: {mark} cannot end there: the geodesics reach {_REACH:.0f} mm past the planks at most, and the "
            "cover needs some length; change the clearance, or set facade.cover = false"
        )
    return float(brentq(inside, outer, inner, xtol=1e-9))


def _bar(
    design: Design, item: NetworkCurve, height: float, section: CrossSection, mark: str
) -> tuple[FramedCurve, Blank]:
    """Return centre line and blank of a bar on a geodesic, cut square at the clearances of foot and top."""
    y, z = section.width / 2.0, section.thickness / 2.0
    up, aside = np.array([[height - z], [height - z], [height + z], [height + z]]), np.array([[-y], [y], [y], [-y]])

    def least(limit: Limit) -> Callable[[float], float]:
        def inside(station: float) -> float:
            frames = frames_at(item.curve, np.array([station]))
            return float(limit(frames.point + up * frames.normal + aside * frames.binormal).min())

        return inside

    top = _below_top(design, item, design.facade.ridge_clearance)
    middle = (item.start + item.end) / 2.0
    start = _where(least(_over_foot(design)), -_REACH, middle, "facade.foot_clearance", mark)
    end = _where(least(top), item.curve.length + _REACH, middle, "facade.ridge_clearance", mark)
    line = offset_curve(item.curve, height, 0.0, start, end)
    return line, Blank(line.length, section, ())


def _bars(design: Design, items: list[NetworkCurve]) -> tuple[list[Mullion], list[ClampingBar]]:
    facade, face = design.facade, beam_face(design)
    under, over = face + facade.mullion[1] / 2.0, face + facade.build_up - facade.clamp[1] / 2.0
    mullions, clamps = [], []
    for item in items:
        mark, upper = str(Mark(1, "M", item.id.number)), str(Mark(1, "D", item.id.number))
        mullions.append(Mullion(mark, *_bar(design, item, under, CrossSection(*facade.mullion), mark)))
        clamps.append(ClampingBar(upper, *_bar(design, item, over, CrossSection(*facade.clamp), upper)))
    return mullions, clamps


def _corner(sheet: Sheet, limit: Limit, v: float, outer: float, key: str, mark: str) -> float:
    def inside(u: float) -> float:
        return float(depth_inside(sheet, limit, np.array([u]), np.array([v]))[0])

    return _where(inside, outer, 0.5, key, mark)


def _upper_cut(design: Design, sheet: Sheet, pair: tuple[NetworkCurve, NetworkCurve], mark: str) -> tuple[float, ...]:
    """Return the corners of the upper cut; nothing of it comes nearer to the ridge planes than the clearance.

    A sheet that spans two ridge planes gets a cut along each, which meet in a peak.
    """
    clearance, key = design.facade.ridge_clearance, "facade.ridge_clearance"
    level = isinstance(design.shells, LevelShells)
    left, right = (float(item.curve.points[-1, 1]) for item in pair)
    fractions = (0.0, 0.5, 1.0) if not level and design.shells.count > 2 and left * right < 0.0 else (0.0, 1.0)
    aim = clearance
    for _ in range(_PASSES):
        limits = [_below_top(design, pair[round(v)], aim) for v in fractions]
        cut = tuple(_corner(sheet, limit, v, 1.0, key, mark) for v, limit in zip(fractions, limits, strict=True))
        if level:
            return cut
        deficit = -float(depth_inside(sheet, _below_top(design, pair[0], clearance), *along_cut(sheet, cut)).min())
        if deficit <= 0.0:
            return cut
        aim += deficit + _SAFE
    raise DesignError(f"{key}: no straight cut of {mark} keeps {clearance:g} mm; reduce it")


def _strip(design: Design, pair: tuple[NetworkCurve, NetworkCurve]) -> Strip:
    """Return the strip between two geodesics, its edges no longer than its corners need."""
    mark = str(Mark(1, "P", pair[0].id.number))
    facade = design.facade
    gap, thickness = facade.edge_gap, facade.sheet_thickness
    height = beam_face(design) + facade.mullion[1] + facade.seal + thickness / 2.0
    left, right = (
        offset_curve(item.curve, height, sign * gap, -_REACH, item.curve.length + _REACH)
        for item, sign in zip(pair, (1.0, -1.0), strict=True)
    )
    low, high = shared_range(left, right)
    edges = ruled_edges(left, right, low, high, SAMPLE_SPACING)
    sheet = sheet_of(Strip(mark, *edges, thickness, (0.0, 0.0), (1.0, 1.0)))
    lower = tuple(_corner(sheet, _over_foot(design), v, 0.0, "facade.foot_clearance", mark) for v in (0.0, 1.0))
    upper = _upper_cut(design, sheet, pair, mark)
    first, last = min(lower), max(upper)
    ends = (low + first * (high - low), low + last * (high - low))
    return Strip(
        mark,
        *ruled_edges(left, right, *ends, SAMPLE_SPACING),
        thickness,
        tuple((u - first) / (last - first) for u in lower),
        tuple((u - first) / (last - first) for u in upper),
        design.facade.sheet_mass / thickness * MM_PER_M,
    )


def _drilled_bar(bar: _Bar, screws: Sequence[Screw], diameter: float) -> _Bar:
    """Return a bar with the holes of its screws, each marked by its joint."""
    axes = (np.array([screw.frame.origin for screw in screws]), np.array([screw.frame.z for screw in screws]))
    holes = [
        Hole(station, offset, diameter, "screw", joint_of(screw.mark))
        for screw, (station, offset) in zip(screws, axis_piercings(bar, *axes).tolist(), strict=True)
    ]
    return replace(bar, blank=replace(bar.blank, holes=tuple(sorted(holes, key=lambda hole: hole.station))))


def _crossings(line: _Line, joints: Sequence[Joint]) -> list[tuple[float, Joint]]:
    """Return the joints of a geodesic with beams, each with its station."""
    own = [joint for joint in joints if joint.kind == "AG" and line.plank.mark in joint.members]
    points = np.array([joint.point for joint in own]).reshape(-1, 3)
    return list(zip(nearest_station(line.item.curve, points).tolist(), own, strict=True))


def _is_outer(joint: Joint) -> bool:
    return any(parse_mark(member).family == LAYERS[1] for member in joint.members)


def _wanted_stations(design: Design, line: _Line, beams: list[float]) -> list[float]:
    """Return where blocks on the geodesic are due, so that supports are not too far apart.

    ``beams`` are the stations of those that are there.
    """
    spacing = design.facade.support_spacing
    first, last = nearest_station(line.item.curve, line.mullion.curve.points[[0, -1]]).tolist()
    supports, wanted = sorted(beams), []
    if not supports or supports[0] - first > _EARLY * FREE_END * spacing:
        wanted.append(line.item.start + _STAND_OFF_END)
    if not supports or last - supports[-1] > _EARLY * FREE_END * spacing:
        wanted.append(line.item.end - _STAND_OFF_END)
    for a, b in pairwise(sorted([*supports, *wanted])):
        count = math.ceil((b - a) / spacing)
        wanted += [a + (b - a) * i / count for i in range(1, count)]
    return sorted(wanted)


def _stand_off(design: Design, mark: str, item: NetworkCurve, station: float) -> CouplingBlock:
    """Return a block on the outer face of a geodesic, as high and as wide as an outer beam."""
    frames = frames_at(item.curve, np.array([station]))
    centre = frames.point[0] + design.layer_offset * frames.normal[0]
    frame = Frame(vector(centre), vector(frames.tangent[0]), vector(frames.normal[0]), vector(-frames.binormal[0]))
    across = design.joints.gap + 2.0 * design.timber.thickness
    return CouplingBlock(mark, frame, _STAND_OFF_LENGTH, design.timber.width, across, ())


def _free_station(
    design: Design, item: NetworkCurve, wanted: float, beams: list[float], among: Sequence[Obstacle]
) -> float | None:
    """Return the nearest station where a block on the geodesic is clear of all beams and fittings, or None.

    No beam passes on the other side either, where its screws are driven.
    """
    apart = (design.joints.block_length + _STAND_OFF_LENGTH) / 2.0
    for step in np.arange(0.0, design.facade.support_spacing / 2.0, _STEP).tolist():
        for station in (wanted + step, wanted - step):
            inside = item.start + _STAND_OFF_END <= station <= item.end - _STAND_OFF_END
            if not inside or any(abs(station - beam) < apart for beam in beams):
                continue
            if is_free(placed_points(_stand_off(design, "S1-V-001", item, station)), among, 0.0):
                return float(station)
    return None


def _stand_offs(
    design: Design, line: _Line, crossings: list[tuple[float, Joint]], among: Sequence[Obstacle]
) -> list[float]:
    """Return the stations of the blocks on a geodesic that its mullion needs besides the outer beams."""
    near = [o for o in among if o.part.mark != line.plank.mark]
    taken = [station for station, _ in crossings]
    for wanted in _wanted_stations(design, line, [station for station, joint in crossings if _is_outer(joint)]):
        station = _free_station(design, line.item, wanted, taken, near)
        if station is not None:
            taken.append(station)
    return taken[len(crossings) :]


def _stand_off_screw(design: Design, mark: Mark, block: CouplingBlock, plank: str) -> tuple[Screw, Drilling]:
    """Return the screw from inside through a geodesic into a block on it, and the drilling of its plank."""
    joints, up = design.joints, np.array(block.frame.y)
    middle = np.array(block.frame.origin) - design.layer_offset * up
    frame = axis_frame(middle - design.timber.thickness / 2.0 * up, up, np.array(block.frame.x))
    screw = wood_screw(part_mark(mark, "W2"), joints.screw_diameter, joints.screw_length, frame)
    return screw, Drilling(plank, vector(middle), vector(up), joints.screw_hole, "screw", str(mark))


def _fixed_at(design: Design, line: _Line, mark: Mark, station: float, at: Joint | None) -> FacadePieces:
    """Return the joint of bars and strips on the block of another joint or, without one, on a block of its own."""
    frames, facade = frames_at(line.item.curve, np.array([station])), design.facade
    up, face = frames.normal[0], frames.point[0] + beam_face(design) * frames.normal[0]
    axis = axis_frame(face + facade.build_up * up, -up, frames.tangent[0])
    screw = wood_screw(part_mark(mark, "W1"), facade.screw_diameter, facade.screw_length, axis)
    bars = (line.mullion.mark, line.clamp.mark, *line.strips)
    blocks: tuple[CouplingBlock, ...] = ()
    screws, drillings = [screw], list[Drilling]()
    if at is None:
        blocks = (_stand_off(design, str(mark), line.item, station),)
        inner, drilling = _stand_off_screw(design, mark, blocks[0], line.plank.mark)
        screws, drillings = [screw, inner], [drilling]
        members = (*bars, line.plank.mark, blocks[0].mark)
    else:
        members = (*bars, next(m for m in at.members if parse_mark(m).family == "K"))
    joint = Joint(str(mark), "cover", vector(face), vector(up), members, tuple(s.mark for s in screws))
    return FacadePieces(screws=tuple(screws), blocks=blocks, joints=(joint,), drillings=tuple(drillings))


def _fixed_line(
    design: Design, line: _Line, joints: Sequence[Joint], among: Sequence[Obstacle], first: int
) -> list[FacadePieces]:
    """Return the joints of the bars of a geodesic, numbered upwards from ``first``, and the bars, drilled."""
    crossings = _crossings(line, joints)
    places: list[tuple[float, Joint | None]] = [place for place in crossings if _is_outer(place[1])]
    places += [(station, None) for station in _stand_offs(design, line, crossings, among)]
    places.sort(key=lambda place: place[0])
    fixed = [_fixed_at(design, line, Mark(1, "V", n), *place) for n, place in enumerate(places, start=first)]
    screws, hole = [pieces.screws[0] for pieces in fixed], design.facade.screw_hole
    if not screws:
        raise DesignError(f"facade.cover: nothing carries {line.mullion.mark}; set it to false")
    bars = FacadePieces((_drilled_bar(line.mullion, screws, hole),), (), (_drilled_bar(line.clamp, screws, hole),))
    return [*fixed, bars]


def _lines(design: Design, network: CurveNetwork, shell: Shell) -> tuple[list[_Line], list[Strip]]:
    items = {item.id.number: item for item in network.curves if item.id.family in GEODESICS}
    planks = index_of(shell).planks
    mullions, clamps = _bars(design, list(items.values()))
    beside: dict[int, list[str]] = {number: [] for number in items}
    strips = []
    for number in items if design.closed else list(items)[:-1]:
        left, right = strip_neighbours(design, number)
        strips.append(_strip(design, (items[left], items[right])))
        beside[left].append(strips[-1].mark)
        beside[right].append(strips[-1].mark)
    lines = [
        _Line(item, planks[curve_mark(1, item.id)], mullion, clamp, tuple(sorted(beside[item.id.number])))
        for item, mullion, clamp in zip(items.values(), mullions, clamps, strict=True)
    ]
    return lines, strips


def placed_facade(design: Design, network: CurveNetwork, shell: Shell) -> FacadePieces:
    """Return the cover of the first shell, whose other parts are placed (paper section 3.2, Fig. 8e to g).

    Mullions lie on the outer beams along the geodesics, a sheet on either side of the screws, a clamping bar on top.
    One screw goes through both bars into every coupling block of an outer beam under them; where those are too far
    apart, blocks on the geodesic carry them. DesignError or SurfaceError with the key to change where that cannot be.
    """
    if not design.facade.cover:
        return FacadePieces()
    lines, strips = _lines(design, network, shell)
    # Nodes are far from geodesics; what is fixed at their own joints, at feet and at the top is not.
    near = {mark for joint in shell.joints if joint.kind != "AA" for mark in joint.fasteners}
    bolts = [bolt for bolt in shell.bolts if bolt.mark in near]
    among = obstacles([*shell.planks, *shell.straps, *shell.shoes, *bolts, *shell.blocks], shell.placement)
    done = [FacadePieces(strips=tuple(strips))]
    for line in lines:
        done += _fixed_line(design, line, shell.joints, among, sum(len(pieces.joints) for pieces in done) + 1)
    names = [field.name for field in fields(FacadePieces)]
    return FacadePieces(**{name: tuple(piece for pieces in done for piece in getattr(pieces, name)) for name in names})


def covered(shell: Shell, pieces: FacadePieces) -> Shell:
    """Return a shell with its cover: the pieces, and their holes and joints in the planks of the geodesics."""
    by_plank = grouped(pieces.drillings)
    joints = {joint.mark: np.array(joint.point) for joint in pieces.joints}

    def finished(plank: Plank) -> Plank:
        wanted = by_plank.get(plank.mark, [])
        if not wanted:
            return plank
        new = drilled(replace(plank, blank=replace(plank.blank, holes=())), wanted).blank.holes
        holes = tuple(sorted([*plank.blank.holes, *new], key=lambda hole: (hole.station, hole.offset)))
        places = with_joints(plank, ((mark, joints[mark]) for mark in sorted({d.joint for d in wanted})))
        stations = tuple(sorted([*plank.joints, *places], key=lambda joint: (joint.station, joint.joint)))
        return replace(plank, blank=replace(plank.blank, holes=holes), joints=stations)

    return replace(
        shell,
        planks=tuple(finished(plank) for plank in shell.planks),
        blocks=(*shell.blocks, *pieces.blocks),
        screws=(*shell.screws, *pieces.screws),
        joints=(*shell.joints, *pieces.joints),
        mullions=pieces.mullions,
        strips=pieces.strips,
        clamps=pieces.clamps,
    )
