"""The cover of a shell: aluminium bars on the geodesics, bent sheets between them, screwed to the coupling blocks."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeAlias, TypeVar

import numpy as np
from scipy.optimize import brentq

from aag_cad.design import Design
from aag_cad.design_sections import LevelShells
from aag_cad.errors import DesignError
from aag_cad.geometry.developable import ruled_edges, shared_range
from aag_cad.geometry.framed import SAMPLE_SPACING, FramedCurve, frames_at, nearest_station, offset_curve
from aag_cad.network.model import CurveNetwork, NetworkCurve
from aag_cad.network.ridge import ridge_distance
from aag_cad.parts.fasteners import axis_frame, wood_screw
from aag_cad.parts.forming import axis_piercings
from aag_cad.parts.marks import Mark, parse_mark
from aag_cad.parts.members import curve_mark
from aag_cad.parts.model import Blank, ClampingBar, CrossSection, Hole, Joint, Mullion, Screw, Shell, Strip
from aag_cad.parts.strips import Sheet, rulings_through, sheet_of
from aag_cad.units import Floats, vector

# Four samples past the end of a curve its spline is off by about 0.02 mm, and slanting cuts leave little sheet there.
_REACH = 4.0 * SAMPLE_SPACING
_ALONG_CUT = 33
_SAFE = 1e-3
_PASSES = 20

# How far points (n, 3) lie inside a limit, mm, (n,).
Limit: TypeAlias = Callable[[Floats], Floats]
_Bar = TypeVar("_Bar", Mullion, ClampingBar)


@dataclass(frozen=True)
class FacadePieces:
    """What covers one shell, in shell coordinates, each sorted by mark; all empty without a cover."""

    mullions: tuple[Mullion, ...] = ()
    strips: tuple[Strip, ...] = ()
    clamps: tuple[ClampingBar, ...] = ()
    screws: tuple[Screw, ...] = ()
    joints: tuple[Joint, ...] = ()


def beam_face(design: Design) -> float:
    """Return how far the outer faces of the outer beams lie from the surface along its normal, mm."""
    return design.layer_offset + design.timber.width / 2.0


def sheet_height(design: Design) -> float:
    """Return how far the edges of the sheets, at mid-thickness, lie from the surface along its normal, mm."""
    facade = design.facade
    return beam_face(design) + facade.mullion[1] + facade.seal + facade.sheet_thickness / 2.0


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

    def least(limit: Limit) -> Callable[[float], float]:
        def inside(station: float) -> float:
            frames = frames_at(item.curve, np.array([station]))
            corners = [
                frames.point + (height + n * z) * frames.normal + b * y * frames.binormal
                for n in (-1.0, 1.0)
                for b in (-1.0, 1.0)
            ]
            return float(limit(np.concatenate(corners)).min())

        return inside

    top = _below_top(design, item, design.facade.ridge_clearance)
    middle = (item.start + item.end) / 2.0
    start = _where(least(_over_foot(design)), -_REACH, middle, "facade.foot_clearance", mark)
    end = _where(least(top), item.curve.length + _REACH, middle, "facade.ridge_clearance", mark)
    curve = offset_curve(item.curve, height, 0.0, start, end)
    return curve, Blank(curve.length, section, ())


def _bars(design: Design, items: list[NetworkCurve]) -> tuple[list[Mullion], list[ClampingBar]]:
    facade, face = design.facade, beam_face(design)
    mullions, clamps = [], []
    for item in items:
        mark = str(Mark(1, "M", item.id.number))
        height = face + facade.mullion[1] / 2.0
        mullions.append(Mullion(mark, *_bar(design, item, height, CrossSection(*facade.mullion), mark)))
        mark = str(Mark(1, "D", item.id.number))
        height = face + facade.build_up - facade.clamp[1] / 2.0
        clamps.append(ClampingBar(mark, *_bar(design, item, height, CrossSection(*facade.clamp), mark)))
    return mullions, clamps


def _depth_at(sheet: Sheet, limit: Limit, u: Floats, v: Floats) -> Floats:
    """Return how far the thinner of both faces lies inside a limit at rulings u and fractions v, (n,)."""
    half = sheet.thickness / 2.0
    return np.minimum(limit(sheet.formed(u, v, -half)), limit(sheet.formed(u, v, half)))


def _corner(sheet: Sheet, limit: Limit, v: float, outer: float, key: str, mark: str) -> float:
    def inside(u: float) -> float:
        return float(_depth_at(sheet, limit, np.array([u]), np.array([v]))[0])

    return _where(inside, outer, 0.5, key, mark)


def _along_cut(sheet: Sheet, cut: tuple[float, ...]) -> tuple[Floats, Floats]:
    """Return rulings and fractions, each (n,), of points along a cut that is straight in the flat pattern."""
    corners = sheet.flattened(np.array(cut), np.linspace(0.0, 1.0, len(cut)))
    t = np.linspace(0.0, len(cut) - 1.0, (len(cut) - 1) * (_ALONG_CUT - 1) + 1)
    points = np.column_stack([np.interp(t, np.arange(len(cut)), corners[:, axis]) for axis in (0, 1)])
    return rulings_through(sheet, points)


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
        deficit = -float(_depth_at(sheet, _below_top(design, pair[0], clearance), *_along_cut(sheet, cut)).min())
        if deficit <= 0.0:
            return cut
        aim += deficit + _SAFE
    raise DesignError(f"{key}: no straight cut of {mark} keeps {clearance:g} mm; reduce it")


def _strip(design: Design, pair: tuple[NetworkCurve, NetworkCurve]) -> Strip:
    """Return the strip between two geodesics, its edges no longer than its corners need."""
    mark = str(Mark(1, "P", pair[0].id.number))
    height, gap, thickness = sheet_height(design), design.facade.edge_gap, design.facade.sheet_thickness
    left, right = (
        offset_curve(item.curve, height, sign * gap, -_REACH, item.curve.length + _REACH)
        for item, sign in zip(pair, (1.0, -1.0), strict=True)
    )
    low, high = shared_range(left, right)
    sheet = sheet_of(
        Strip(mark, *ruled_edges(left, right, low, high, SAMPLE_SPACING), thickness, (0.0, 0.0), (1.0, 1.0))
    )
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
    )


def _with_hole(bar: _Bar, joint: str, screw: Screw, diameter: float) -> _Bar:
    ((station, offset),) = axis_piercings(bar, np.array([screw.frame.origin]), np.array([screw.frame.z])).tolist()
    holes = (*bar.blank.holes, Hole(station, offset, diameter, "screw", joint))
    return replace(bar, blank=replace(bar.blank, holes=holes))


def _block_joints(shell: Shell, item: NetworkCurve) -> list[Joint]:
    """Return the joints of a geodesic with the outer beams, from its foot upwards."""
    plank = curve_mark(1, item.id)
    joints = [
        joint
        for joint in shell.joints
        if joint.kind == "AG" and plank in joint.members and any(parse_mark(m).family == "A2" for m in joint.members)
    ]
    if not joints:
        raise DesignError(f"facade.cover: no outer beam crosses {plank} under its mullion; set it to false")
    points = np.array([joint.point for joint in joints])
    guess = item.curve.stations[np.argmin(np.linalg.norm(points[:, None] - item.curve.points[None], axis=2), axis=1)]
    stations = nearest_station(item.curve, points, guess)
    return [joints[i] for i in np.argsort(stations, kind="stable")]


def _cover_joint(design: Design, mark: Mark, at: Joint, members: tuple[str, ...]) -> tuple[Joint, Screw]:
    """Return the joint of bars and sheets on the coupling block of another joint, with its screw from outside."""
    facade = design.facade
    normal, point = np.array(at.normal), np.array(at.point)
    face = point + beam_face(design) * normal
    side = np.cross(normal, np.array([0.0, 0.0, 1.0]))
    frame = axis_frame(face + facade.build_up * normal, -normal, side)
    screw = wood_screw(f"{mark}-W1", facade.screw_diameter, facade.screw_length, frame)
    block = next(m for m in at.members if parse_mark(m).family == "K")
    return Joint(str(mark), "cover", vector(face), at.normal, (*members, block), (screw.mark,)), screw


def placed_facade(design: Design, network: CurveNetwork, shell: Shell) -> FacadePieces:
    """Return the cover of the first shell, whose joints and blocks are placed (paper section 3.2, Fig. 8e to g).

    Mullions lie on the outer beams along the geodesics, a sheet on either side of the screws, a clamping bar on top;
    one screw goes through both bars into every coupling block of an outer beam under them. DesignError or SurfaceError
    with the key to change where that cannot be built.
    """
    if not design.facade.cover:
        return FacadePieces()
    items = [item for item in network.curves if item.id.family == "G"]
    mullions, clamps = _bars(design, items)
    pairs = list(zip(items, items[1:] + items[:1] if design.closed else items[1:], strict=False))
    strips = [_strip(design, pair) for pair in pairs]
    beside: dict[int, list[str]] = {item.id.number: [] for item in items}
    for (left, right), strip in zip(pairs, strips, strict=True):
        beside[left.id.number].append(strip.mark)
        beside[right.id.number].append(strip.mark)
    joints: list[Joint] = []
    screws: list[Screw] = []
    for i, item in enumerate(items):
        for at in _block_joints(shell, item):
            mark = Mark(1, "V", len(joints) + 1)
            members = (mullions[i].mark, clamps[i].mark, *sorted(beside[item.id.number]))
            joint, screw = _cover_joint(design, mark, at, members)
            mullions[i] = _with_hole(mullions[i], joint.mark, screw, design.facade.screw_hole)
            clamps[i] = _with_hole(clamps[i], joint.mark, screw, design.facade.screw_hole)
            joints.append(joint)
            screws.append(screw)
    return FacadePieces(tuple(mullions), tuple(strips), tuple(clamps), tuple(screws), tuple(joints))
