"""The boundary of a shell in the chart: its region, and the edge planks along bottom and top."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.optimize import brentq

from aag_cad.design import Design
from aag_cad.design_tables import LevelShells
from aag_cad.errors import NetworkError
from aag_cad.geometry.surface import Chart
from aag_cad.network.crop import SCREW_END_DISTANCE
from aag_cad.network.lines import ChartLine, Region
from aag_cad.network.model import BOTTOM, LEFT_RIDGE, RIGHT_RIDGE, CurveId
from aag_cad.network.ridge import ridge_coordinate, ridge_distance, ridge_line, surface_points
from aag_cad.units import Floats

_SAME = 1e-6


@dataclass(frozen=True, eq=False)
class EdgeLine:
    """An edge plank in the chart, t -> (s, theta) over [low, high]; it serves the angles theta below ``upto``."""

    id: CurveId
    place: Literal["bottom", "top"]
    path: Callable[[Floats], tuple[Floats, Floats]]
    low: float
    high: float
    upto: float = math.inf


def coordinate_at_height(chart: Chart, height: float, key: str) -> float:
    """Return s where the meridian reaches a height over the ground line, mm; NetworkError with the key if never."""
    if height == 0.0:
        return 0.0

    def gap(s: float) -> float:
        return float(surface_points(chart, np.array([s]), np.zeros(1))[0, 2]) - height

    low, high = chart.domain
    if gap(low) * gap(high) > 0.0:
        raise NetworkError(
            f"{key}: the meridian runs from {gap(low) + height:.0f} to {gap(high) + height:.0f} mm and never reaches "
            f"{height:g} mm; choose a height between them"
        )
    return float(brentq(gap, low, high, xtol=1e-13))


def bottom_coordinate(design: Design, chart: Chart) -> float:
    """Return s of the bottom edge."""
    return coordinate_at_height(chart, design.bottom_height, "shells.bottom_height")


def top_coordinate(design: Design, chart: Chart, theta: float) -> float:
    """Return s where the surface ends at an angle: at the ridge or mirror plane, or at the stated height."""
    if isinstance(design.shells, LevelShells):
        return coordinate_at_height(chart, design.shells.top_height, "shells.top_height")
    return ridge_coordinate(chart, theta, design.shells.count, 0.0)


def _parallel(s: float) -> Callable[[Floats], tuple[Floats, Floats]]:
    return lambda theta: (np.full_like(theta, s), theta)


def _sides(design: Design, chart: Chart, s: Iterable[float]) -> list[float]:
    """Return the angle up to which an open edge reaches past the side at each s."""
    half = design.half_sector
    listed = np.array(list(s))
    radii = np.linalg.norm(chart.jet(listed, np.full_like(listed, half)).dv, axis=1)
    return [float(side) for side in half + design.boundary.end_overhang / radii]


def ridge_boundary(design: Design, chart: Chart) -> tuple[Region, tuple[EdgeLine, ...]]:
    """Return region and edges of a shell that ends at ridge planes: bottom, and two ridge geodesics."""
    shells, setback = design.shells.count, design.boundary.ridge_setback
    top = ridge_coordinate(chart, design.half_sector, shells, setback)
    bottom_side, ridge_side = _sides(design, chart, (0.0, top))
    ridge = ridge_line(chart, shells, ridge_side, setback)
    edges = (
        EdgeLine(BOTTOM, "bottom", _parallel(0.0), -bottom_side, bottom_side),
        EdgeLine(LEFT_RIDGE, "top", lambda t: (ridge.path(t)[0], -ridge.path(t)[1]), 0.0, 1.0, upto=0.0),
        EdgeLine(RIGHT_RIDGE, "top", ridge.path, 0.0, 1.0),
    )
    return Region(design.half_sector, lambda theta: float(ridge.height(theta))), edges


def level_region(design: Design, chart: Chart) -> Region:
    """Return the region of a shell cropped at two heights; NetworkError if its top edge reaches its neighbour's."""
    bottom, top = bottom_coordinate(design, chart), top_coordinate(design, chart, 0.0)
    half, setback = design.half_sector, design.boundary.ridge_setback
    theta = np.linspace(-half, half, 181)
    nearest = float(ridge_distance(surface_points(chart, np.full_like(theta, top), theta), design.shells.count).min())
    if nearest < setback - _SAME:
        raise NetworkError(
            f"shells.top_height: the top edge comes {nearest:.0f} mm near to the plane between the shells, "
            f"boundary.ridge_setback asks for {setback:g}; lower it, enlarge axis_distance or narrow sector_deg"
        )
    return Region(half, lambda _theta: top, bottom, design.closed)


def _ring_cuts(
    design: Design, key: str, radius: float, joints: list[tuple[float, bool]], geodesic: bool
) -> list[tuple[float, float]]:
    """Return the angles (from, to) of the planks of a closed ring, none longer than ``transport.length``.

    ``joints`` are angles, and whether a beam passes there. A cut lies midway between two neighbouring beams, near
    enough to both for no end to dangle, so that every plank hangs on two beams at least. A ring that is no geodesic is
    cut wherever it can be: its planks are sawn curved, and short ones waste less.
    """
    turned = sorted((angle % (2.0 * math.pi), not beam) for angle, beam in joints)
    angles, loose = np.array([angle for angle, _ in turned]), np.array([no_beam for _, no_beam in turned])
    gaps = np.diff(angles, append=angles[0] + 2.0 * math.pi)
    least = design.boundary.end_gap + 2.0 * SCREW_END_DISTANCE * design.joints.screw_diameter
    fit = (gaps * radius >= least) & (gaps * radius <= 2.0 * design.boundary.max_overhang)
    fit &= ~loose & ~np.roll(loose, -1)
    places = (angles + gaps / 2.0)[fit]
    fewest = math.ceil(2.0 * math.pi * radius / design.transport.length)
    for count in range(fewest if geodesic else max(fewest, len(places)), len(places) + 1):
        cuts = places[(np.arange(count) * len(places)) // count]
        ends = np.append(cuts[1:], cuts[0] + 2.0 * math.pi)
        if float((ends - cuts).max()) * radius <= design.transport.length:
            slit = design.boundary.end_gap / 2.0 / radius
            return [(float(a) + slit, float(b) - slit) for a, b in zip(cuts, ends, strict=True)]
    raise NetworkError(
        f"{key}: the ring of {2.0 * math.pi * radius:.0f} mm cannot be cut into planks of transport.length "
        f"{design.transport.length:g} mm: a cut needs two beams {least:.0f} to "
        f"{2.0 * design.boundary.max_overhang:.0f} mm apart, and {len(places)} places are so; change {key} a little"
    )


def level_edges(design: Design, chart: Chart, region: Region, lines: Iterable[ChartLine]) -> tuple[EdgeLine, ...]:
    """Return the edges of a shell cropped at two heights: parallel circles, cut into several planks where closed."""
    heights: tuple[tuple[Literal["bottom", "top"], float, str], ...] = (
        ("bottom", region.bottom, "pattern.row_offset"),
        ("top", region.highest, "shells.top_height"),
    )
    edges: list[EdgeLine] = []
    listed = list(lines)
    for place, s, key in heights:
        if not region.closed:
            side = _sides(design, chart, (s,))[0]
            edges.append(EdgeLine(CurveId("E", len(edges) + 1), place, _parallel(s), -side, side))
            continue
        jet = chart.jet(np.array([s]), np.zeros(1))
        radius = float(np.linalg.norm(jet.dv))
        geodesic = abs(float(jet.du[0, 0])) < _SAME * float(np.linalg.norm(jet.du))
        joints = [
            (float(line.theta(np.array([s]))[0]), line.slope != 0)
            for line in listed
            if min(abs(line.low - s), abs(line.high - s)) < _SAME
        ]
        for low, high in _ring_cuts(design, key, radius, joints, geodesic):
            edges.append(EdgeLine(CurveId("E", len(edges) + 1), place, _parallel(s), low, high, upto=high))
    return tuple(edges)


def edge_at(edges: Iterable[EdgeLine], place: Literal["bottom", "top"], theta: float) -> CurveId:
    """Return the edge plank that a line meets at an angle."""
    there = [edge for edge in edges if edge.place == place]
    if there[-1].upto < math.inf:
        first = there[0].low
        theta = first + (theta - first) % (2.0 * math.pi)
    return next(edge.id for edge in there if theta < edge.upto)
