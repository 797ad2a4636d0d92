"""Figures of one shell and its curves: plan area, crown, smallest radius, largest twist."""

from dataclasses import dataclass

import numpy as np

from aag_cad.design import Design
from aag_cad.families import FAMILIES, Family
from aag_cad.geometry.framed import curvatures_at
from aag_cad.geometry.surface import Chart
from aag_cad.network.edges import bottom_coordinate, top_coordinate
from aag_cad.network.model import CurveNetwork
from aag_cad.network.ridge import surface_points

_SECTORS = 40


@dataclass(frozen=True)
class ShellExtent:
    """Areas of one shell up to the ridge planes (mm2), heights over the ground line, curve figures (mm, rad/mm).

    Radii are those of the weak bending: geodesic curvature of A curves, normal curvature of G and E curves.
    """

    plan_area: float
    roof_area: float
    crown_height: float
    entry_height: float
    smallest_radius: dict[Family, float]
    largest_twist: dict[Family, float]


def shell_areas(design: Design, chart: Chart) -> tuple[float, float]:
    """Return the area in plan and that of the surface between ground line and top of one shell, mm2.

    They are the integrals of |(X_s x X_theta)_z| and |X_s x X_theta| by Gauss-Legendre; where a shell leans out and in
    again, both parts count in plan.
    """
    nodes, weights = np.polynomial.legendre.leggauss(_SECTORS)
    half = design.half_sector
    # The ridge bends at the crown, so each half of the sector is integrated on its own; the shell is symmetric.
    angles = half / 2.0 * (nodes + 1.0)
    bottom = bottom_coordinate(design, chart)
    plan = roof = 0.0
    for theta, weight in zip(angles, weights, strict=True):
        reach = (top_coordinate(design, chart, float(theta)) - bottom) / 2.0
        jet = chart.jet(bottom + reach * (nodes + 1.0), np.full_like(nodes, theta))
        cross = np.cross(jet.du, jet.dv)
        plan += weight * reach * float(weights @ np.abs(cross[:, 2]))
        roof += weight * reach * float(weights @ np.linalg.norm(cross, axis=1))
    return half * plan, half * roof


def shell_extent(design: Design, chart: Chart, network: CurveNetwork) -> ShellExtent:
    """Return the figures of a shell; curves are measured between their outermost joints, ends not counted."""
    radii: dict[Family, float] = {}
    twists: dict[Family, float] = {}
    for item in network.curves:
        family = item.id.family
        joints = [crossing.station_on(item.id) for crossing in network.crossings if item.id in crossing.curves]
        stations = np.linspace(min(joints), max(joints), 400)
        curvatures = curvatures_at(item.curve, stations)
        weak = curvatures.geodesic if FAMILIES[family].upright else curvatures.normal
        radii[family] = min(radii.get(family, np.inf), float(1.0 / max(np.abs(weak).max(), 1e-12)))
        twists[family] = max(twists.get(family, 0.0), float(np.abs(curvatures.torsion).max()))
    heights = [
        float(surface_points(chart, np.array([top_coordinate(design, chart, t)]), np.array([t]))[0, 2])
        for t in (0.0, design.half_sector)
    ]
    return ShellExtent(*shell_areas(design, chart), heights[0], heights[1], radii, twists)
