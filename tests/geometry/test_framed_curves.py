"""Curves with a surface normal: arc length, curvature from splines, and the straight plank on an offset curve."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import ellipe

from aag_cad.geometry.framed import (
    SAMPLE_SPACING,
    FramedCurve,
    curvatures_at,
    framed_curve,
    frames_at,
    nearest_station,
    offset_curve,
)
from aag_cad.units import Floats

RADIUS = 1700.0
CLIMB = 0.5
ONE_BIT = 4e-16
# Samples 150 mm apart on a radius of 1.7 m leave the quintic's position good to a micron, its curvature to 1e-7 1/mm:
# a bending radius of 1700 mm is then known to 0.3 mm.
MICRON = 1e-3
CURVATURE = 1e-7


def circle(end: float = 2.5) -> FramedCurve:
    """Return a circle in the horizontal plane, seen as a curve of that plane: its normal is vertical."""

    def evaluate(t: Floats) -> tuple[Floats, Floats]:
        zero = np.zeros_like(t)
        return (
            RADIUS * np.column_stack([np.cos(t), np.sin(t), zero]),
            np.column_stack([zero, zero, zero + 1.0]),
        )

    return framed_curve(evaluate, 0.0, end, RADIUS * end)


def helix(end: float = 2.0) -> FramedCurve:
    """Return a right-handed helix on a cylinder with the cylinder's outward normal."""

    def evaluate(t: Floats) -> tuple[Floats, Floats]:
        out = np.column_stack([np.cos(t), np.sin(t), np.zeros_like(t)])
        rise = np.column_stack([np.zeros_like(t), np.zeros_like(t), RADIUS * math.tan(CLIMB) * t])
        return RADIUS * out + rise, out

    return framed_curve(evaluate, 0.0, end, RADIUS * end / math.cos(CLIMB))


def ellipse() -> FramedCurve:
    """Return half an ellipse: its parameter is far from its arc length."""

    def evaluate(t: Floats) -> tuple[Floats, Floats]:
        zero = np.zeros_like(t)
        return (
            np.column_stack([3000.0 * np.cos(t), 2400.0 * np.sin(t), zero]),
            np.column_stack([zero, zero, zero + 1.0]),
        )

    return framed_curve(evaluate, 0.0, math.pi, 8500.0)


def inner(curve: FramedCurve) -> Floats:
    return np.linspace(0.0, curve.length, 200)


def test_the_arc_length_of_a_circle() -> None:
    assert circle(2.5).length == pytest.approx(RADIUS * 2.5, abs=MICRON)


def test_the_arc_length_of_a_helix() -> None:
    assert helix(2.0).length == pytest.approx(2.0 * RADIUS / math.cos(CLIMB), abs=MICRON)


def test_the_arc_length_of_an_ellipse_is_the_complete_elliptic_integral() -> None:
    """Half an ellipse is 2 a E(m) long, with m = 1 - (b / a)^2."""
    assert ellipse().length == pytest.approx(2.0 * 3000.0 * ellipe(1.0 - (2400.0 / 3000.0) ** 2), abs=MICRON)


@pytest.mark.parametrize("curve", [circle(), helix(), ellipse()], ids=["circle", "helix", "ellipse"])
def test_the_samples_lie_at_equal_arc_lengths_and_the_spline_has_unit_speed(curve: FramedCurve) -> None:
    np.testing.assert_allclose(np.diff(curve.stations), curve.length / (len(curve.stations) - 1), rtol=1e-12)
    speed = np.linalg.norm(curve.point_spline(inner(curve), nu=1), axis=1)
    np.testing.assert_allclose(speed, 1.0, atol=2e-5)


def test_a_long_curve_has_a_sample_every_150_mm_and_a_short_one_no_fewer_than_13() -> None:
    assert len(circle(2.5).stations) == math.ceil(RADIUS * 2.5 / SAMPLE_SPACING) + 1
    assert len(circle(0.1).stations) == 13


def test_a_circle_in_its_plane_bends_sideways_only() -> None:
    found = curvatures_at(circle(), inner(circle()))
    np.testing.assert_allclose(found.geodesic, 1.0 / RADIUS, atol=CURVATURE)
    assert max(np.abs(found.normal).max(), np.abs(found.torsion).max()) < CURVATURE


def test_a_helix_on_a_cylinder_is_a_geodesic_with_curvature_and_torsion() -> None:
    """kappa_n = -cos^2 a / r, kappa_g = 0, tau_g = sin a cos a / r from the splines."""
    curve = helix()
    found = curvatures_at(curve, inner(curve))
    np.testing.assert_allclose(found.normal, -(math.cos(CLIMB) ** 2) / RADIUS, atol=CURVATURE)
    np.testing.assert_allclose(found.torsion, math.sin(CLIMB) * math.cos(CLIMB) / RADIUS, atol=CURVATURE)
    assert np.abs(found.geodesic).max() < CURVATURE


@pytest.mark.parametrize("curve", [circle(), helix(), ellipse()], ids=["circle", "helix", "ellipse"])
def test_frames_are_orthonormal_and_right_handed(curve: FramedCurve) -> None:
    frames = frames_at(curve, inner(curve))
    axes = np.stack([frames.tangent, frames.binormal, frames.normal], axis=1)
    unity = np.broadcast_to(np.eye(3), axes.shape)
    np.testing.assert_allclose(axes @ axes.transpose(0, 2, 1), unity, atol=1e-14)
    np.testing.assert_allclose(np.linalg.det(axes), 1.0, atol=1e-14)


@given(offset=st.floats(-300.0, 300.0))
def test_a_sideways_offset_of_a_circle_is_a_concentric_circle(offset: float) -> None:
    """The binormal points to the centre of a circle run counter-clockwise: the radius becomes r - e."""
    curve = offset_curve(circle(), 0.0, offset, 0.0, circle().length)
    np.testing.assert_allclose(np.linalg.norm(curve.points, axis=1), RADIUS - offset, atol=MICRON)
    assert curve.length == pytest.approx(2.5 * (RADIUS - offset), abs=MICRON)


@given(height=st.floats(-300.0, 300.0))
def test_a_lifted_helix_lies_on_the_parallel_cylinder_and_is_steeper_inside(height: float) -> None:
    """The curve c + h n is the helix of radius r + h with the same rise: its length is the longer hypotenuse."""
    base = helix()
    curve = offset_curve(base, height, 0.0, 0.0, base.length)
    np.testing.assert_allclose(np.hypot(curve.points[:, 0], curve.points[:, 1]), RADIUS + height, atol=MICRON)
    expected = 2.0 * math.hypot(RADIUS + height, RADIUS * math.tan(CLIMB))
    assert curve.length == pytest.approx(expected, abs=MICRON)


def test_lifting_and_lowering_a_curve_brings_it_back() -> None:
    """The normal of the parallel curve is that of the curve, so the second offset undoes the first."""
    base = helix()
    lifted = offset_curve(base, 56.0, 0.0, 0.0, base.length)
    back = offset_curve(lifted, -56.0, 0.0, 0.0, lifted.length)
    stations = np.linspace(0.0, 1.0, 50)
    np.testing.assert_allclose(
        back.point_spline(stations * back.length), base.point_spline(stations * base.length), atol=1e-4
    )


@given(start=st.floats(0.0, 1500.0), extra=st.floats(600.0, 2000.0))
def test_an_offset_over_part_of_a_curve_begins_and_ends_there(start: float, extra: float) -> None:
    base = circle()
    part = offset_curve(base, 0.0, 0.0, start, start + extra)
    assert part.length == pytest.approx(extra, abs=MICRON)
    ends = base.point_spline(np.array([start, start + extra]))
    np.testing.assert_allclose(part.points[[0, -1]], ends, atol=1e-9)


@given(station=st.floats(100.0, 3000.0), across=st.floats(-200.0, 200.0), along_normal=st.floats(-200.0, 200.0))
def test_the_nearest_station_sees_a_point_in_its_normal_plane(
    station: float, across: float, along_normal: float
) -> None:
    curve = helix()
    frames = frames_at(curve, np.array([station]))
    point = frames.point + across * frames.binormal + along_normal * frames.normal
    found = nearest_station(curve, point, np.array([station + 40.0]))
    assert found[0] == pytest.approx(station, abs=1e-6)


def test_curves_are_equal_if_all_their_samples_are_equal_bit_for_bit() -> None:
    assert circle() == circle()
    moved = circle().points.copy()
    moved[3, 1] *= 1.0 + ONE_BIT
    assert circle() != replace(circle(), points=moved)
    assert circle() != circle(2.4)
    assert circle() != "circle"
