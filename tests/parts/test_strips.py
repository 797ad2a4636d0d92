"""Strips: flat patterns of sheets whose unrolling is known, and of the vault; mesh and depth of the formed sheet."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from aag_cad.design import Design
from aag_cad.design_tables import CrpcSurface
from aag_cad.geometry.developable import ruled_edges
from aag_cad.geometry.framed import FramedCurve, framed_curve
from aag_cad.geometry.revolution import AsymptoticChart
from aag_cad.network.model import CurveId, CurveNetwork
from aag_cad.parts.model import Strip
from aag_cad.parts.shapes.sheet import (
    chord_offsets,
    flat_pattern,
    sheet_of,
    sheet_radius,
    strip_depth,
    strip_mesh,
    strip_points,
    strip_sizes,
    strip_volume,
)
from aag_cad.units import Floats

THICKNESS = 10.0
Evaluate = Callable[[Floats], tuple[Floats, Floats]]


def circle(radius: float, y: float, slope: float = 0.0) -> Evaluate:
    """Return a circle about the y axis; its normals point outwards, leaning towards -y by ``slope``."""

    def evaluate(angle: Floats) -> tuple[Floats, Floats]:
        out = np.column_stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)])
        normal = (out + np.array([0.0, -slope, 0.0])) / math.hypot(1.0, slope)
        return radius * out + np.array([0.0, y, 0.0]), normal

    return evaluate


def strip_between(left: FramedCurve, right: FramedCurve, lower: tuple[float, ...], upper: tuple[float, ...]) -> Strip:
    return Strip("S1-P-01", *ruled_edges(left, right, 0.0, left.length, 100.0), THICKNESS, lower, upper)


def arcs(radii: tuple[float, float], angle: float, width: float) -> tuple[FramedCurve, FramedCurve]:
    slope = (radii[1] - radii[0]) / width
    left = framed_curve(circle(radii[0], 0.0, slope), 0.0, angle, radii[0] * angle)
    return left, framed_curve(circle(radii[1], width, slope), 0.0, angle, radii[1] * angle)


@pytest.fixture(scope="module")
def rolled() -> Strip:
    """A sheet rolled to a cylinder of 2 m radius over 1 rad, 500 mm wide, with a slanting and a peaked end."""
    return strip_between(*arcs((2000.0, 2000.0), 1.0, 500.0), (0.0, 0.1), (0.8, 1.0, 0.9))


@pytest.fixture(scope="module")
def conical() -> Strip:
    """A sheet on a cone, from 2000 to 2300 mm radius over 400 mm along the axis, 1 rad."""
    return strip_between(*arcs((2000.0, 2300.0), 1.0, 400.0), (0.0, 0.0), (1.0, 1.0))


def test_a_rolled_sheet_unrolls_to_a_straight_strip_with_straight_cuts(rolled: Strip) -> None:
    flat = flat_pattern(rolled)
    assert (flat.left_length, flat.right_length) == pytest.approx((1600.0, 1600.0), abs=1e-3)
    assert (flat.left_sagitta, flat.right_sagitta) == pytest.approx((0.0, 0.0), abs=1e-3)
    corners = np.concatenate([flat.lower, flat.upper])
    turned = corners - corners[0]
    along = (flat.left[-1] - flat.left[0]) / 1600.0
    x, y = turned @ along, turned @ np.array([-along[1], along[0]])
    assert x == pytest.approx([0.0, 200.0, 1600.0, 2000.0, 1800.0], abs=2e-3)
    assert y == pytest.approx([0.0, 500.0, 0.0, 250.0, 500.0], abs=2e-3)
    # Trapezium less the wedge at the foot, and with the peak.
    assert flat.area == pytest.approx(
        500.0 * (1600.0 + 1800.0) / 2.0 - 0.5 * 500.0 * 200.0 + 0.5 * 500.0 * 300.0, rel=1e-6
    )
    assert sheet_radius(rolled) == pytest.approx(2000.0, rel=1e-5)


def test_a_conical_sheet_unrolls_to_a_sector_of_a_ring(conical: Strip) -> None:
    flat, slant = flat_pattern(conical), math.hypot(400.0, 300.0)
    apex = slant * 2000.0 / 300.0
    turn = 2000.0 / apex
    inner, outer = (radius * (1.0 - math.cos(turn / 2.0)) for radius in (apex, apex + slant))
    assert (flat.left_length, flat.right_length) == pytest.approx((2000.0, 2300.0), abs=1e-3)
    # The inner arc bulges into the sheet, which makes that edge concave; the outer one is convex.
    assert (flat.left_sagitta, flat.right_sagitta) == pytest.approx((inner, -outer), abs=1e-2)
    # The outline is a polygon with a corner every 25 mm.
    assert flat.area == pytest.approx(turn / 2.0 * ((apex + slant) ** 2 - apex**2), rel=1e-5)
    assert sheet_radius(conical) == pytest.approx(2000.0 * slant / 400.0, rel=1e-4)


def test_a_strip_of_the_vault_unrolls_as_its_closed_form_says(
    design: Design, chart: AsymptoticChart, network: CurveNetwork
) -> None:
    curves = {item.id: item.curve for item in network.curves}
    left, right = curves[CurveId("G", 7)], curves[CurveId("G", 8)]
    edges = ruled_edges(left, right, 400.0, 4600.0, 150.0)
    flat = flat_pattern(Strip("S1-P-07", *edges, THICKNESS, (0.0, 0.0), (1.0, 1.0)))
    half = math.sin(math.radians(design.shells.sector_deg) / (design.pattern.geodesics - 1) / 2.0)
    assert isinstance(design.surface, CrpcSurface)
    r0, n = design.surface.neck_radius, design.surface.ratio
    first, last = (math.hypot(x - chart.surface.axis_x, y) for x, y, _ in edges[0].points[[0, -1]].tolist())

    def along(r: float) -> float:
        """Return dx/dr of the unrolled edge: dr/ds = cos psi with sin psi = (r0 / r)^n, and y = r sin(delta / 2)."""
        return math.sqrt(1.0 / (1.0 - (r0 / r) ** (2.0 * n)) - half**2)

    assert flat.length == pytest.approx(quad(along, first, last)[0], abs=0.05)
    assert flat.width == pytest.approx(2.0 * half * last, abs=0.01)
    assert flat.area == pytest.approx(2.0 * half * quad(lambda r: r * along(r), first, last)[0], rel=1e-5)
    # The sagitta of the concave edge: where it is parallel to its chord.
    chord = half * (last - first) / quad(along, first, last)[0]
    steepest = brentq(lambda r: half / along(r) - chord, first + 1.0, last)
    x, y = quad(along, first, steepest)[0], half * (steepest - first)
    sagitta = (chord * x - y) / math.hypot(1.0, chord)
    assert (flat.left_sagitta, flat.right_sagitta) == pytest.approx((sagitta, sagitta), abs=0.01)


def test_the_mesh_is_closed_and_encloses_area_times_thickness(rolled: Strip, conical: Strip) -> None:
    for strip in (rolled, conical):
        mesh = strip_mesh(strip, 20.0)
        edges = np.sort(np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]]), axis=1)
        assert np.all(np.unique(edges, axis=0, return_counts=True)[1] == 2)
        # Chords every 20 mm of a 2 m radius lose 4e-6; the offset faces share it.
        assert mesh.volume == pytest.approx(strip_volume(strip), rel=1e-4)
        assert strip_volume(strip) == pytest.approx(flat_pattern(strip).area * THICKNESS)
        assert strip_sizes(strip)[2] == THICKNESS


def test_depth_is_zero_on_the_skin_and_half_the_thickness_in_the_middle(rolled: Strip, conical: Strip) -> None:
    for strip in (rolled, conical):
        assert np.abs(strip_depth(strip, strip_points(strip, 60.0, 30.0))).max() < 1e-3
        sheet = sheet_of(strip)
        u, v = np.array([0.3, 0.5, 0.7]), np.array([0.5, 0.3, 0.6])
        assert strip_depth(strip, sheet.formed(u, v, 0.0)) == pytest.approx(5.0, abs=1e-6)
        assert strip_depth(strip, sheet.formed(u, v, 8.0)) == pytest.approx(-3.0, abs=1e-6)
        assert strip_depth(strip, sheet.formed(u, np.array([-0.1, 1.1, 1.2]), 0.0)).max() < -20.0


def test_what_the_cuts_take_away_is_outside(rolled: Strip) -> None:
    sheet = sheet_of(rolled)
    u, v = np.array([0.02, 0.92, 0.97]), np.array([0.9, 0.05, 0.9])
    assert strip_depth(rolled, sheet.formed(u, v, 0.0)).max() < -10.0


def test_ordinates_of_an_edge_are_taken_from_its_chord() -> None:
    t = np.linspace(0.0, 1.0, 101)
    edge = np.column_stack([3.0 * t - 4.0 * t * (1.0 - t), 4.0 * t + 3.0 * t * (1.0 - t)])
    along, beside = chord_offsets(edge)
    assert along == pytest.approx(5.0 * t)
    assert beside == pytest.approx(5.0 * t * (1.0 - t))
