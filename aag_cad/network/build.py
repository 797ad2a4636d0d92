"""From a design and its chart to the curve network of one shell: selection, crossings, boundaries, crop."""

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np

from aag_cad.design import Design
from aag_cad.design_tables import LevelShells
from aag_cad.errors import NetworkError
from aag_cad.families import BEAMS
from aag_cad.geometry.framed import FramedCurve, framed_curve, nearest_station
from aag_cad.geometry.surface import Chart, unit_normals
from aag_cad.network.crop import kept_crossings, trimmed_curves
from aag_cad.network.edges import EdgeLine, edge_at, level_edges, level_region, ridge_boundary
from aag_cad.network.lines import ChartLine, Region, asymptotic_lines, crossings_of, geodesic_lines
from aag_cad.network.model import LEFT_RIDGE, RIGHT_RIDGE, Crossing, CrossingKind, CurveId, CurveNetwork
from aag_cad.network.ridge import ridge_distance, surface_points
from aag_cad.units import Floats, vector

_MARGIN = 300.0
_ON_EDGE = 1e-6


@dataclass(frozen=True)
class _Meeting:
    """Two curves that meet at a point of the chart."""

    kind: CrossingKind
    curves: tuple[CurveId, CurveId]
    s: float
    theta: float


def _aa_meetings(design: Design, chart: Chart, region: Region, lines: list[ChartLine]) -> list[_Meeting]:
    """Return the AA nodes clear of bottom and top, without those of beams that have fewer than ``min_nodes``."""
    pattern = design.pattern
    found = [
        _Meeting("AA", (a.id, b.id), *place)
        for a in (line for line in lines if line.slope > 0)
        for b in (line for line in lines if line.slope < 0)
        for place in crossings_of(a, b, region.closed)
    ]
    s, theta = np.array([(node.s, node.theta) for node in found]).T
    points = surface_points(chart, s, theta)
    foot = np.linalg.norm(points - surface_points(chart, np.full_like(s, region.bottom), theta), axis=1)
    ridge = ridge_distance(points, design.shells.count)
    if isinstance(design.shells, LevelShells):
        top = surface_points(chart, np.full_like(s, region.highest), theta)
        ridge = np.minimum(ridge, np.linalg.norm(points - top, axis=1))
    clear = (foot >= pattern.node_clearance_foot) & (ridge >= pattern.node_clearance_ridge)
    nodes = [node for node, free in zip(found, clear, strict=True) if free]
    while True:
        count = Counter(curve for node in nodes for curve in node.curves)
        kept = [node for node in nodes if all(count[curve] >= pattern.min_nodes for curve in node.curves)]
        if len(kept) == len(nodes):
            return kept
        nodes = kept


def _boundary_meetings(region: Region, edges: tuple[EdgeLine, ...], lines: Iterable[ChartLine]) -> list[_Meeting]:
    """Return where A lines end on the bottom or the top; where they end on a side they cross a G line there."""
    meetings = []
    for line in lines:
        for s in (line.low, line.high):
            theta = float(line.theta(np.array([s]))[0])
            if abs(s - region.bottom) < _ON_EDGE:
                meetings.append(_Meeting("boundary", (line.id, edge_at(edges, "bottom", theta)), region.bottom, theta))
            elif abs(s - region.top_at(theta)) < _ON_EDGE:
                meetings.append(_Meeting("boundary", (line.id, edge_at(edges, "top", theta)), s, theta))
    return meetings


def _beams(design: Design, chart: Chart, region: Region) -> tuple[list[ChartLine], list[_Meeting]]:
    """Return the A lines that become beams, renumbered without gaps, and their nodes."""
    every = asymptotic_lines(region, design.step, design.pattern.row_offset)
    nodes = _aa_meetings(design, chart, region, every)
    used = {curve for node in nodes for curve in node.curves}
    if not used:
        raise NetworkError(
            f"pattern.min_nodes: no beam has {design.pattern.min_nodes} AA nodes; use more geodesics, a larger shell, "
            f"a smaller min_nodes, pattern.node_clearance_foot ({design.pattern.node_clearance_foot:g} mm) or "
            f"pattern.node_clearance_ridge ({design.pattern.node_clearance_ridge:g} mm)"
        )
    renamed = {
        line.id: CurveId(family, i)
        for family in BEAMS
        for i, line in enumerate((x for x in every if x.id in used and x.id.family == family), start=1)
    }
    beams = [replace(line, id=renamed[line.id]) for line in every if line.id in used]
    return beams, [replace(n, curves=(renamed[n.curves[0]], renamed[n.curves[1]])) for n in nodes]


def _meetings(
    region: Region, edges: tuple[EdgeLine, ...], beams: list[ChartLine], geodesics: list[ChartLine]
) -> list[_Meeting]:
    """Return all places where beams, geodesics and edge planks meet, but for the AA nodes."""
    meetings = [
        _Meeting("AG", (beam.id, g.id), *place)
        for beam in beams
        for g in geodesics
        for place in crossings_of(beam, g, region.closed)
    ]
    meetings += _boundary_meetings(region, edges, beams)
    for g in geodesics:
        foot, head = (edge_at(edges, place, g.intercept) for place in ("bottom", "top"))
        meetings.append(_Meeting("foot", (g.id, foot), region.bottom, g.intercept))
        meetings.append(_Meeting("ridge", (g.id, head), g.high, g.intercept))
    return meetings


def _framed(chart: Chart, path: Callable[[Floats], tuple[Floats, Floats]], low: float, high: float) -> FramedCurve:
    """Return the curve t -> (s, theta) on the chart over [low, high] as a framed curve."""
    rough = surface_points(chart, *path(np.linspace(low, high, 50)))
    length = float(np.linalg.norm(np.diff(rough, axis=0), axis=1).sum())

    def evaluate(t: Floats) -> tuple[Floats, Floats]:
        jet = chart.jet(*path(t))
        return jet.point, unit_normals(jet)

    return framed_curve(evaluate, low, high, length)


def _line_curve(chart: Chart, line: ChartLine) -> FramedCurve:
    """Return an A or G line as a framed curve that reaches past both its ends."""
    ends = np.array([line.low, line.high])
    jet = chart.jet(ends, line.theta(ends))
    before, after = _MARGIN / np.linalg.norm(jet.du + line.slope * jet.dv, axis=1)
    return _framed(chart, lambda s: (s, line.theta(s)), line.low - before, line.high + after)


def _crossings(chart: Chart, curves: dict[CurveId, FramedCurve], meetings: list[_Meeting]) -> list[Crossing]:
    """Return the meetings as crossings with their arc-length stations on both curves."""
    jet = chart.jet(np.array([m.s for m in meetings]), np.array([m.theta for m in meetings]))
    normals = unit_normals(jet)
    stations = np.zeros((len(meetings), 2))
    for name, curve in curves.items():
        where = [(i, k) for i, m in enumerate(meetings) for k in (0, 1) if m.curves[k] == name]
        points = jet.point[[i for i, _ in where]]
        for (i, k), station in zip(where, nearest_station(curve, points), strict=True):
            stations[i, k] = station
    return [
        Crossing(m.kind, m.curves, (float(a), float(b)), vector(point), vector(normal))
        for m, (a, b), point, normal in zip(meetings, stations, jet.point, normals, strict=True)
    ]


def shell_network(design: Design, chart: Chart) -> CurveNetwork:
    """Return the curve network of one shell of a design (paper section 2.2, Fig. 2, 6b and c).

    Tri-hex selection of A and G lines, crop at the bottom, the side meridians and the top, joints, ends. SurfaceError
    or NetworkError with the key to change where no buildable network comes out.
    """
    level = isinstance(design.shells, LevelShells)
    region, edges = (level_region(design, chart), ()) if level else ridge_boundary(design, chart)
    beams, meetings = _beams(design, chart, region)
    geodesics = geodesic_lines(region, design.pattern.geodesics)
    if level:
        edges = level_edges(design, chart, region, beams + geodesics)
    meetings += _meetings(region, edges, beams, geodesics)
    if not level:
        meetings.append(_Meeting("ridge", (LEFT_RIDGE, RIGHT_RIDGE), region.top_at(0.0), 0.0))
    curves = {line.id: _line_curve(chart, line) for line in beams + geodesics}
    curves |= {edge.id: _framed(chart, edge.path, edge.low, edge.high) for edge in edges}
    crossings = kept_crossings(design, curves, _crossings(chart, curves, meetings))
    return CurveNetwork(tuple(trimmed_curves(design, curves, crossings)), tuple(crossings))
