"""Which crossings become joints, and where each plank ends."""

import math

import numpy as np
from scipy.optimize import brentq

from aag_cad.design import Design
from aag_cad.design_tables import LevelShells
from aag_cad.errors import NetworkError
from aag_cad.families import BEAMS, EDGES, FAMILIES, GEODESICS, Family
from aag_cad.geometry.framed import FramedCurve, frames_at
from aag_cad.network.model import LEFT_RIDGE, RIGHT_RIDGE, Crossing, CurveId, NetworkCurve
from aag_cad.network.ridge import ridge_distance
from aag_cad.units import Floats

_RANK = {"boundary": 0, "AA": 1, "AG": 2}
SCREW_END_DISTANCE = 7.0


def geodesic_extent(design: Design, curves: dict[CurveId, FramedCurve], stops: list[Crossing]) -> tuple[float, float]:
    """Return the stations between which a G plank, cut square, keeps ``end_gap`` to both edge planks."""
    half, gap = design.timber.width / 2.0, design.boundary.end_gap
    ends = []
    for stop, sign in zip(stops, (1.0, -1.0), strict=True):
        tangents = [
            frames_at(curves[curve], np.array([station])).tangent[0]
            for curve, station in zip(stop.curves, stop.stations, strict=True)
        ]
        cos = abs(float(tangents[0] @ tangents[1]))
        sin = math.sqrt(1.0 - cos**2)
        ends.append(stop.stations[0] + sign * ((half + gap) / sin + half * cos / sin))
    return ends[0], ends[1]


def _geodesic_extents(
    design: Design, curves: dict[CurveId, FramedCurve], crossings: list[Crossing]
) -> dict[CurveId, tuple[float, float]]:
    extents = {}
    for curve in (name for name in curves if name.family in GEODESICS):
        stops = [c for kind in ("foot", "ridge") for c in crossings if c.kind == kind and c.curves[0] == curve]
        extents[curve] = geodesic_extent(design, curves, stops)
        if extents[curve][1] - extents[curve][0] < 2 * design.timber.width:
            raise NetworkError(
                f"geodesic {curve.number}: no length is left between bottom and ridge plank; enlarge "
                "shells.axis_distance, narrow shells.sector_deg or reduce boundary.end_gap "
                f"({design.boundary.end_gap:g} mm)"
            )
    return extents


def _spacing(design: Design, a: Crossing, b: Crossing) -> float:
    """Return how far apart two joints on one beam must be for their studs and blocks to fit into the gap."""
    half = {
        "AA": design.joints.stud_across_flats / math.sqrt(3.0),
        "AG": design.joints.block_length / 2.0,
        "boundary": design.joints.block_length / 2.0,
    }
    return half[a.kind] + half[b.kind] + design.boundary.end_gap


def kept_crossings(design: Design, curves: dict[CurveId, FramedCurve], crossings: list[Crossing]) -> list[Crossing]:
    """Return the crossings that become joints, sorted by kind and place.

    An AG crossing goes where the G plank is cut off or its screw would sit within 7 d of the end (EN 1995-1-1, table
    8.2, a3,c); of two joints on a beam whose blocks would overlap, the boundary wins over AA and AG. NetworkError if
    the blocks are too long for the mesh.
    """
    extents = _geodesic_extents(design, curves, crossings)
    reach = SCREW_END_DISTANCE * design.joints.screw_diameter

    def held(c: Crossing) -> bool:
        low, high = extents[c.curves[1]]
        return low + reach <= c.stations[1] <= high - reach

    kept = {c for c in crossings if c.kind != "AG" or held(c)}
    for beam in (name for name in curves if name.family in BEAMS):
        on_beam = [c for c in kept if beam in c.curves]
        placed: list[Crossing] = []
        for c in sorted(on_beam, key=lambda c: (_RANK[c.kind], c.station_on(beam))):
            near = [p for p in placed if abs(c.station_on(beam) - p.station_on(beam)) < _spacing(design, c, p)]
            if not near:
                placed.append(c)
                continue
            if c.kind == "AG" and near[0].kind == "AA":
                raise NetworkError(
                    f"joints.block_length: a block of {design.joints.block_length:g} mm does not fit between the "
                    f"studs of {beam.family} beam {beam.number}; shorten it or use fewer geodesics"
                )
            kept.discard(c)
    return sorted(kept, key=lambda c: (c.kind, c.curves, c.stations))


def _section_corners(design: Design, curve: FramedCurve, family: Family, station: float) -> Floats:
    """Return the corners (4, 3) of a beam's or edge plank's section at a station of its reference curve."""
    lift = FAMILIES[family].layer * design.layer_offset
    if family in EDGES:
        height, across = design.timber.thickness / 2.0, design.timber.width / 2.0
    else:
        height, across = design.timber.width / 2.0, design.sibling_offset + design.timber.thickness / 2.0
    frames = frames_at(curve, np.array([station]))
    return np.array(
        [
            frames.point[0] + (lift + n * height) * frames.normal[0] + b * across * frames.binormal[0]
            for n in (-1.0, 1.0)
            for b in (-1.0, 1.0)
        ]
    )


def _free_overhang(design: Design, curve: FramedCurve, family: Family, last: float, sign: float) -> float:
    """Return how far a beam may reach past its last joint: ``end_overhang``, less where the ridge plane is near."""
    wish = design.boundary.end_overhang

    def clearance(overhang: float) -> float:
        corners = _section_corners(design, curve, family, last + sign * overhang)
        return float(ridge_distance(corners, design.shells.count).min()) - design.boundary.ridge_gap

    if clearance(wish) >= 0.0:
        return wish
    if clearance(0.0) <= 0.0:
        raise NetworkError(
            f"boundary.ridge_setback: {design.boundary.ridge_setback:g} mm lets beams of family {family} touch the "
            "ridge plane; enlarge it"
        )
    return float(brentq(clearance, 0.0, wish))


def _crown_station(design: Design, curve: FramedCurve) -> float:
    """Return where a ridge plank ends so that it keeps half of ``end_gap`` to the shell's plane of symmetry."""
    side = float(np.sign(curve.points[0, 1]))

    def clearance(station: float) -> float:
        corners = _section_corners(design, curve, "E", station)
        return float((side * corners[:, 1]).min()) - design.boundary.end_gap / 2.0

    return float(brentq(clearance, curve.length - 2 * design.timber.width, curve.length - 1.0))


def trimmed_curves(design: Design, curves: dict[CurveId, FramedCurve], crossings: list[Crossing]) -> list[NetworkCurve]:
    """Return every curve with the stations between which its plank lies, sorted by id.

    Beams end ``end_overhang`` past their first and last joint, G planks before the edge planks, ridge planks at the
    crown.
    """
    extents = _geodesic_extents(design, curves, crossings)
    ridges = () if isinstance(design.shells, LevelShells) else (LEFT_RIDGE, RIGHT_RIDGE)
    trimmed = []
    for name in sorted(curves):
        curve = curves[name]
        if name.family in GEODESICS:
            start, end = extents[name]
        elif name.family in EDGES:
            start, end = 0.0, _crown_station(design, curve) if name in ridges else curve.length
        else:
            joints = [c.station_on(name) for c in crossings if name in c.curves]
            start = min(joints) - _free_overhang(design, curve, name.family, min(joints), -1.0)
            end = max(joints) + _free_overhang(design, curve, name.family, max(joints), 1.0)
        trimmed.append(NetworkCurve(name, curve, float(start), float(end)))
    return trimmed
