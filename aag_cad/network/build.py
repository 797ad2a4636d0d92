"""From a design and its chart to the curve network of one shell: selection, crossings, boundaries, crop."""

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from aag_cad.design import Design
from aag_cad.errors import NetworkError
from aag_cad.geometry.framed import FramedCurve, framed_curve, nearest_station
from aag_cad.geometry.revolution import AsymptoticChart
from aag_cad.geometry.surface import unit_normals
from aag_cad.network.crop import kept_crossings, trimmed_curves
from aag_cad.network.lines import ChartLine, Region, asymptotic_lines, crossing_of, geodesic_lines
from aag_cad.network.model import Crossing, CrossingKind, CurveId, CurveNetwork, Family
from aag_cad.network.ridge import RidgeLine, ridge_coordinate, ridge_distance, ridge_line, surface_points
from aag_cad.units import Floats, vector

BOTTOM = CurveId("E", 1)
LEFT_RIDGE = CurveId("E", 2)
RIGHT_RIDGE = CurveId("E", 3)
_MARGIN = 300.0


@dataclass(frozen=True)
class _Meeting:
    """Two curves that meet at a point of the chart."""

    kind: CrossingKind
    curves: tuple[CurveId, CurveId]
    s: float
    theta: float


def _ridge_of(theta: float) -> CurveId:
    return LEFT_RIDGE if theta < 0 else RIGHT_RIDGE


def _aa_meetings(design: Design, chart: AsymptoticChart, lines: list[ChartLine]) -> list[_Meeting]:
    """Return the AA nodes clear of foot and ridge, without those of beams that have fewer than ``min_nodes``."""
    pattern = design.pattern
    found = []
    for a in (line for line in lines if line.slope > 0):
        for b in (line for line in lines if line.slope < 0):
            if (place := crossing_of(a, b)) is not None:
                found.append(_Meeting("AA", (a.id, b.id), *place))
    s, theta = np.array([(node.s, node.theta) for node in found]).T
    points = surface_points(chart, s, theta)
    foot = np.linalg.norm(points - surface_points(chart, np.zeros_like(s), theta), axis=1)
    ridge = ridge_distance(points, design.shells.count)
    clear = (foot >= pattern.node_clearance_foot) & (ridge >= pattern.node_clearance_ridge)
    nodes = [node for node, free in zip(found, clear, strict=True) if free]
    while True:
        count = Counter(curve for node in nodes for curve in node.curves)
        kept = [node for node in nodes if all(count[curve] >= pattern.min_nodes for curve in node.curves)]
        if len(kept) == len(nodes):
            return kept
        nodes = kept


def _boundary_meetings(region: Region, lines: Iterable[ChartLine]) -> list[_Meeting]:
    """Return where A lines end on the bottom or a ridge; where they end on a side they cross a G line there."""
    meetings = []
    for line in lines:
        for s in (line.low, line.high):
            theta = float(line.theta(np.array([s]))[0])
            if abs(s) < 1e-6:
                meetings.append(_Meeting("boundary", (line.id, BOTTOM), 0.0, theta))
            elif abs(s - float(region.ridge(min(abs(theta), region.half)))) < 1e-6:
                meetings.append(_Meeting("boundary", (line.id, _ridge_of(theta)), s, theta))
    return meetings


def _meetings(design: Design, chart: AsymptoticChart, region: Region) -> tuple[list[ChartLine], list[_Meeting]]:
    """Return the lines that become planks, renumbered without gaps, and all places where they meet."""
    every = asymptotic_lines(region, design.step, design.pattern.row_offset)
    nodes = _aa_meetings(design, chart, every)
    used = {curve for node in nodes for curve in node.curves}
    if not used:
        raise NetworkError(
            f"pattern.min_nodes: no beam has {design.pattern.min_nodes} AA nodes; use more geodesics, a larger shell, "
            f"a smaller min_nodes, pattern.node_clearance_foot ({design.pattern.node_clearance_foot:g} mm) or "
            f"pattern.node_clearance_ridge ({design.pattern.node_clearance_ridge:g} mm)"
        )
    families: tuple[Family, ...] = ("A1", "A2")
    renamed = {
        line.id: CurveId(family, i)
        for family in families
        for i, line in enumerate((x for x in every if x.id in used and x.id.family == family), start=1)
    }
    beams = [
        ChartLine(renamed[line.id], line.slope, line.intercept, line.low, line.high)
        for line in every
        if line.id in used
    ]
    geodesics = geodesic_lines(region, design.pattern.geodesics)
    meetings = [_Meeting("AA", (renamed[n.curves[0]], renamed[n.curves[1]]), n.s, n.theta) for n in nodes]
    for beam in beams:
        for g in geodesics:
            if (place := crossing_of(beam, g)) is not None:
                meetings.append(_Meeting("AG", (beam.id, g.id), *place))
    meetings += _boundary_meetings(region, beams)
    for g in geodesics:
        meetings.append(_Meeting("foot", (g.id, BOTTOM), 0.0, g.intercept))
        meetings.append(_Meeting("ridge", (g.id, _ridge_of(g.intercept)), g.high, g.intercept))
    meetings.append(_Meeting("ridge", (LEFT_RIDGE, RIGHT_RIDGE), float(region.ridge(0.0)), 0.0))
    return beams + geodesics, meetings


def _framed(
    chart: AsymptoticChart, path: Callable[[Floats], tuple[Floats, Floats]], low: float, high: float
) -> FramedCurve:
    """Return the curve t -> (s, theta) on the chart over [low, high] as a framed curve."""
    rough = surface_points(chart, *path(np.linspace(low, high, 50)))
    length = float(np.linalg.norm(np.diff(rough, axis=0), axis=1).sum())

    def evaluate(t: Floats) -> tuple[Floats, Floats]:
        jet = chart.jet(*path(t))
        return jet.point, unit_normals(jet)

    return framed_curve(evaluate, low, high, length)


def _line_curve(chart: AsymptoticChart, line: ChartLine) -> FramedCurve:
    """Return an A or G line as a framed curve that reaches past both its ends."""
    ends = np.array([line.low, line.high])
    jet = chart.jet(ends, line.theta(ends))
    before, after = _MARGIN / np.linalg.norm(jet.du + line.slope * jet.dv, axis=1)
    return _framed(chart, lambda s: (s, line.theta(s)), line.low - before, line.high + after)


def _edge_curves(chart: AsymptoticChart, ridge: RidgeLine, side: float) -> dict[CurveId, FramedCurve]:
    """Return bottom, left and right edge curve; the ridges start past the side and end at the crown."""
    return {
        BOTTOM: _framed(chart, lambda theta: (np.zeros_like(theta), theta), -side, side),
        LEFT_RIDGE: _framed(chart, lambda t: (ridge.path(t)[0], -ridge.path(t)[1]), 0.0, 1.0),
        RIGHT_RIDGE: _framed(chart, ridge.path, 0.0, 1.0),
    }


def _crossings(chart: AsymptoticChart, curves: dict[CurveId, FramedCurve], meetings: list[_Meeting]) -> list[Crossing]:
    """Return the meetings as crossings with their arc-length stations on both curves."""
    jet = chart.jet(np.array([m.s for m in meetings]), np.array([m.theta for m in meetings]))
    normals = unit_normals(jet)
    stations = np.zeros((len(meetings), 2))
    for name, curve in curves.items():
        where = [(i, k) for i, m in enumerate(meetings) for k in (0, 1) if m.curves[k] == name]
        points = jet.point[[i for i, _ in where]]
        nearest = np.argmin(np.linalg.norm(points[:, None] - curve.points[None], axis=2), axis=1)
        for (i, k), station in zip(where, nearest_station(curve, points, curve.stations[nearest]), strict=True):
            stations[i, k] = station
    return [
        Crossing(m.kind, m.curves, (float(a), float(b)), vector(point), vector(normal))
        for m, (a, b), point, normal in zip(meetings, stations, jet.point, normals, strict=True)
    ]


def shell_network(design: Design, chart: AsymptoticChart) -> CurveNetwork:
    """Return the curve network of one shell of a design (paper section 2.2, Fig. 6b and c).

    Tri-hex selection of A and G lines, crop at the ground, the side meridians and the ridge geodesics, joints, ends.
    SurfaceError or NetworkError with the key to change where no buildable network comes out.
    """
    half, shells, overhang = design.half_sector, design.shells.count, design.boundary.end_overhang
    neck, top = 0.0, ridge_coordinate(chart, half, shells, design.boundary.ridge_setback)
    radii = np.linalg.norm(chart.jet(np.array([neck, top]), np.array([half, half])).dv, axis=1)
    bottom_side, ridge_side = half + overhang / radii
    ridge = ridge_line(chart, shells, float(ridge_side), design.boundary.ridge_setback)
    region = Region(design.half_sector, ridge.height)
    lines, meetings = _meetings(design, chart, region)
    curves = {line.id: _line_curve(chart, line) for line in lines}
    curves |= _edge_curves(chart, ridge, float(bottom_side))
    crossings = kept_crossings(design, curves, _crossings(chart, curves, meetings))
    return CurveNetwork(tuple(trimmed_curves(design, curves, crossings)), tuple(crossings))
