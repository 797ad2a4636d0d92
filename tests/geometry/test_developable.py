"""Sheets between two curves: rulings against those of cylinder, cone and the meridians of the vault."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from aag_cad.design import Design
from aag_cad.errors import SurfaceError
from aag_cad.geometry.developable import ruled_edges, ruling_stations, shared_range
from aag_cad.geometry.framed import FramedCurve, framed_curve, frames_at
from aag_cad.geometry.revolution import AsymptoticChart
from aag_cad.geometry.surface import dot, unit
from aag_cad.network.model import CurveId, CurveNetwork
from aag_cad.units import Floats


def arc(radius: float, height: float, start: float, end: float) -> FramedCurve:
    """Return a circle about the z axis at a height, its normals pointing away from the axis."""

    def evaluate(angle: Floats) -> tuple[Floats, Floats]:
        out = np.column_stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)])
        return radius * out + np.array([0.0, 0.0, height]), out

    return framed_curve(evaluate, start, end, radius * (end - start))


def skew(bend: Callable[[Floats], Floats], y: float) -> FramedCurve:
    """Return the curve (x, y, bend(x)) with normals upwards."""

    def evaluate(x: Floats) -> tuple[Floats, Floats]:
        points = np.column_stack([x, np.full_like(x, y), bend(x)])
        return points, np.tile([0.0, 0.0, 1.0], (len(x), 1))

    return framed_curve(evaluate, 0.0, 3000.0, 3000.0)


def test_rulings_of_a_cylinder_are_parallel_to_its_axis() -> None:
    left, right = arc(2000.0, 0.0, 0.0, 1.5), arc(2000.0, 500.0, 0.1, 1.7)
    stations = np.linspace(300.0, 2800.0, 9)
    # The right edge starts 0.1 rad later; the edges are quintic splines, good to a micrometre.
    assert ruling_stations(left, right, stations) == pytest.approx(stations - 200.0, abs=1e-3)


def test_rulings_of_a_cone_pass_through_its_apex() -> None:
    left, right = arc(1500.0, 0.0, 0.0, 1.5), arc(1000.0, 800.0, 0.0, 1.5)
    apex = np.array([0.0, 0.0, 2400.0])
    first, second = ruled_edges(left, right, 0.0, left.length, 150.0)
    assert np.abs(np.cross(unit(first.points - apex), unit(second.points - apex))).max() < 1e-6


def test_only_rulings_that_end_on_both_curves_are_used() -> None:
    left, right = arc(2000.0, 0.0, 0.0, 1.5), arc(2000.0, 500.0, 0.1, 1.2)
    assert shared_range(left, right) == pytest.approx((200.0, 2400.0), abs=1e-3)


def test_one_plane_touches_a_sheet_all_along_each_ruling() -> None:
    # Two parabolas of different bend span a sheet whose rulings are not parallel.
    left, right = skew(lambda x: -(x**2) / 5000.0, 0.0), skew(lambda x: -(x**2) / 4000.0 + x / 50.0, 600.0)
    first, second = ruled_edges(left, right, *shared_range(left, right), 100.0)
    ruling = unit(second.points - first.points)
    angles = np.degrees(np.arccos(np.clip(ruling @ ruling[0], -1.0, 1.0)))
    assert angles.max() > 1.0
    for edge in (first, second):
        tangent = frames_at(edge, edge.stations).tangent
        assert np.abs(dot(tangent, first.normals)).max() < 1e-4
        assert np.abs(dot(ruling, edge.normals)).max() < 1e-9


def test_a_sheet_between_meridians_is_a_cylinder_as_wide_as_the_chord(
    design: Design, chart: AsymptoticChart, network: CurveNetwork
) -> None:
    curves = {item.id: item.curve for item in network.curves}
    left, right = curves[CurveId("G", 3)], curves[CurveId("G", 4)]
    first, second = ruled_edges(left, right, 0.0, left.length, 150.0)
    chord = second.points - first.points
    radius = np.hypot(first.points[:, 0] - chart.surface.axis_x, first.points[:, 1])
    delta = math.radians(design.shells.sector_deg) / (design.pattern.geodesics - 1)
    # The curves are resampled splines, good to some micrometres.
    assert np.linalg.norm(chord, axis=1) == pytest.approx(2.0 * radius * math.sin(delta / 2.0), abs=1e-3)
    assert np.abs(np.cross(unit(chord), unit(chord[0]))).max() < 1e-5
    assert first.points[:, 2] == pytest.approx(second.points[:, 2], abs=0.01)


def test_two_straight_lines_side_by_side_have_no_one_direction_of_bending() -> None:
    left, right = skew(lambda x: 0.0 * x, 0.0), skew(lambda x: 0.0 * x, 500.0)
    with pytest.raises(SurfaceError, match="straight side by side"):
        ruling_stations(left, right, np.array([1000.0, 2000.0]))


def test_edges_that_bend_apart_span_no_developable_sheet() -> None:
    left, right = skew(lambda x: -(x**2) / 5000.0, 0.0), skew(lambda x: (x - 3000.0) ** 2 / 5000.0, 500.0)
    with pytest.raises(SurfaceError):
        ruling_stations(left, right, np.linspace(100.0, 2900.0, 9))
