"""The chart (s, theta) of a surface of revolution: its diagonals are the asymptotic curves."""

import math
import re

import numpy as np
import pytest
from curvatures import fundamental_forms, gauss_curvature, mean_curvature
from darboux import ParameterCurve, darboux

from aag_cad.errors import SurfaceError
from aag_cad.geometry.profiles import CrpcProfile, HyperboloidProfile, Profile, SplineProfile
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface
from aag_cad.units import Floats

R0 = 5100.0


def sampled_meridian(points: int = 161) -> tuple[tuple[float, float], ...]:
    """Return points (r, z) of the CRPC meridian of ratio 3, from below the neck to far above the crown."""
    y = np.linspace(-0.6, 2.4, points)
    profile = CrpcProfile(R0, 3.0)
    return tuple(zip(*(values[0].tolist() for values in profile.meridian(y)), strict=True))


PROFILES: dict[str, Profile] = {
    "crpc": CrpcProfile(R0, 3.0),
    "hyperboloid": HyperboloidProfile(R0, 3200.0),
    "spline": SplineProfile(sampled_meridian()),
}
profiles = pytest.mark.parametrize("name", PROFILES)


def chart_of(name: str) -> AsymptoticChart:
    return AsymptoticChart(RevolutionSurface(PROFILES[name], -8823.0))


def diagonal(chart: AsymptoticChart, s: Floats, slope: float) -> ParameterCurve:
    one, zero = np.ones_like(s), np.zeros_like(s)
    return ParameterCurve(s, 0.1 + slope * s, one, slope * one, zero, zero)


S = np.linspace(-0.2, 0.8, 21)


@profiles
def test_the_second_fundamental_form_is_a_multiple_of_ds2_minus_dtheta2(name: str) -> None:
    """L = -N and M = 0: so the lines theta +- s = const are asymptotic."""
    forms = fundamental_forms(chart_of(name).jet(S, 0.3 * S))
    np.testing.assert_allclose(forms.L / forms.N, -1.0, rtol=1e-9)
    np.testing.assert_allclose(forms.M / forms.N, 0.0, atol=1e-9)


@profiles
@pytest.mark.parametrize("slope", [1.0, -1.0])
def test_the_diagonals_are_asymptotic_curves(name: str, slope: float) -> None:
    chart = chart_of(name)
    curve = diagonal(chart, S, slope)
    assert np.abs(darboux(chart.jet(curve.u, curve.v), curve).normal_curvature).max() < 1e-9


@profiles
def test_the_lines_of_constant_angle_are_geodesics(name: str) -> None:
    chart = chart_of(name)
    curve = diagonal(chart, S, 0.0)
    assert np.abs(darboux(chart.jet(curve.u, curve.v), curve).geodesic_curvature).max() < 1e-15


@profiles
def test_the_chart_covers_the_same_surface_as_the_meridian_parameter(name: str) -> None:
    """Points and curvatures do not depend on the parameters that a surface is written in."""
    chart = chart_of(name)
    jet, plain = chart.jet(S, 0.3 * S), chart.surface.jet(chart.meridian_parameter(S), 0.3 * S)
    np.testing.assert_array_equal(jet.point, plain.point)
    one, other = fundamental_forms(jet), fundamental_forms(plain)
    np.testing.assert_allclose(gauss_curvature(one), gauss_curvature(other), rtol=1e-10)
    np.testing.assert_allclose(mean_curvature(one), mean_curvature(other), rtol=1e-10, atol=1e-16)


@profiles
def test_the_jet_of_the_chart_agrees_with_differences_of_its_points(name: str) -> None:
    """Sixth-order central differences by s; the tolerance is their own error on a radius of some metres."""
    chart, step = chart_of(name), 1e-3
    s = np.linspace(-0.15, 0.75, 7)
    weights = np.array([-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0]) / (60.0 * step)
    jets = [chart.jet(s + k * step, 0.2 + 0.0 * s) for k in range(-3, 4)]
    for value, slope in (("point", "du"), ("du", "duu"), ("dv", "duv")):
        differences = sum(w * getattr(jet, value) for w, jet in zip(weights, jets, strict=True))
        np.testing.assert_allclose(differences, getattr(jets[3], slope), atol=1e-5)


def test_the_normal_points_to_the_axis_and_up() -> None:
    """The shell's outside: it stands outside its own axis and leans in over the visitor."""
    jet = chart_of("crpc").jet(np.array([0.0, 0.5]), np.array([0.0, 0.0]))
    normal = np.cross(jet.du, jet.dv)
    assert normal[0, 0] < 0.0
    assert normal[0, 2] == pytest.approx(0.0, abs=1e-6)
    assert normal[1, 0] < 0.0 < normal[1, 2]


def test_the_ground_line_has_the_asymptotic_coordinate_zero() -> None:
    for name in PROFILES:
        assert chart_of(name).jet(np.array([0.0]), np.array([0.0])).point[0, 2] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("slope", [1.0, -1.0])
def test_the_asymptotic_curves_of_the_hyperboloid_are_its_straight_rulings(slope: float) -> None:
    """Each diagonal stays within 1e-9 mm of the chord between its ends, and has no curvature at all."""
    chart = chart_of("hyperboloid")
    s = np.linspace(-0.9, 0.9, 25)
    points = chart.jet(s, 0.3 + slope * s).point
    chord = (points[-1] - points[0]) / np.linalg.norm(points[-1] - points[0])
    off = np.cross(points - points[0], chord)
    assert np.linalg.norm(off, axis=1).max() < 1e-8
    curve = diagonal(chart, s, slope)
    found = darboux(chart.jet(curve.u, curve.v), curve)
    assert np.hypot(found.normal_curvature, found.geodesic_curvature).max() < 1e-14


def test_the_hyperboloid_solves_its_own_equation() -> None:
    """(r / r0)^2 - (z / c)^2 = 1."""
    u = np.linspace(-1.0, 1.0, 9)
    r, z = (values[0] for values in PROFILES["hyperboloid"].meridian(u))
    np.testing.assert_allclose((r / R0) ** 2 - (z / 3200.0) ** 2, 1.0, rtol=1e-13)


def test_the_coordinate_of_the_hyperboloid_is_the_gudermannian() -> None:
    profile = HyperboloidProfile(R0, 3200.0)
    u = np.linspace(-2.0, 2.0, 17)
    np.testing.assert_allclose(profile.asymptotic(u), np.arctan(np.sinh(u)), rtol=1e-13, atol=1e-16)
    np.testing.assert_allclose(profile.from_asymptotic(profile.asymptotic(u)), u, rtol=1e-12, atol=1e-16)


def test_a_spline_through_points_of_the_crpc_meridian_has_its_asymptotic_coordinate() -> None:
    """At equal s the tabulated chart of the spline gives the radius and height of the closed form.

    161 points over 9 m: the quintic's error of about 1e-6 mm in position gives 1e-4 mm through two derivatives.
    """
    spline, exact = chart_of("spline"), chart_of("crpc")
    zero = np.zeros_like(S)
    np.testing.assert_allclose(spline.jet(S, zero).point, exact.jet(S, zero).point, atol=1e-4)


def test_the_domain_of_a_spline_chart_is_where_its_points_end() -> None:
    low, high = chart_of("spline").domain
    assert (low, high) == pytest.approx((-0.6 / math.sqrt(3.0), 2.4 / math.sqrt(3.0)), abs=1e-5)


def test_asking_beyond_the_end_of_the_meridian_names_both_figures_and_the_remedy() -> None:
    with pytest.raises(SurfaceError, match=r"coordinate 1\.500, the meridian ends at .*; lengthen the meridian"):
        chart_of("spline").jet(np.array([0.0, 1.5]), np.array([0.0, 0.0]))


def test_a_meridian_that_bulges_outwards_has_no_asymptotic_curves_there() -> None:
    """A circular arc round the axis (a sphere's meridian) has K > 0; the error says at which height and what to do."""
    t = np.linspace(-0.3, 0.8, 12)
    profile = SplineProfile(tuple(zip((4000.0 * np.cos(t)).tolist(), (4000.0 * np.sin(t)).tolist(), strict=True)))
    with pytest.raises(SurfaceError, match=r"K >= 0 at height z = -1\d{3} mm \(radius 3\d{3} mm\)") as caught:
        _ = AsymptoticChart(RevolutionSurface(profile)).domain
    assert "K < 0" in str(caught.value)


def test_the_height_named_is_the_one_where_the_meridian_turns_over() -> None:
    """A meridian r = r0 + a z^2 - b z^4 changes from concave to convex where 2 a = 12 b z^2: at z = 2000 mm."""
    z = np.linspace(-1500.0, 2600.0, 60)
    a = 1e-4
    b = 2.0 * a / (12.0 * 2000.0**2)
    profile = SplineProfile(tuple(zip((R0 + a * z**2 - b * z**4).tolist(), z.tolist(), strict=True)))
    with pytest.raises(SurfaceError) as caught:
        _ = AsymptoticChart(RevolutionSurface(profile)).domain
    found = re.search(r"height z = (-?\d+) mm", str(caught.value))
    assert found is not None
    # the first of 3200 quadrature points past the inflection, which lie about 1.3 mm apart
    assert 1998.0 <= float(found[1]) <= 2005.0


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (((5000.0, -10.0), (5000.0, 10.0), (5001.0, 20.0)), r"surface\.points: 3 points; .* at least 6"),
        (tuple((5000.0, z) for z in (-10.0, 0.0, 10.0, 9.0, 20.0, 30.0)), r"surface\.points: heights must rise"),
        (tuple((5000.0, z) for z in (0.0, 1.0, 2.0, 3.0, 4.0, 5.0)), r"from 0 to 5 mm; they must reach from below"),
        (tuple((5000.0, z) for z in (-9.0, -8.0, -7.0, -6.0, -5.0, 0.0)), r"from -9 to 0 mm; they must reach"),
    ],
)
def test_points_that_make_no_meridian_are_refused(points: tuple[tuple[float, float], ...], message: str) -> None:
    with pytest.raises(SurfaceError, match=message):
        _ = AsymptoticChart(RevolutionSurface(SplineProfile(points))).domain
