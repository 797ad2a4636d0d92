"""The surface of revolution with a constant ratio of principal curvatures (CRPC): the vault's own surface.

Closed forms, with r0 the radius of the neck, n the ratio and y the meridian parameter: r = r0 cosh(y)^(1/n),
sin psi = 1 / cosh y = (r0 / r)^n for the slope psi of the meridian against the radius.
"""

import math

import numpy as np
import pytest
from curvatures import fundamental_forms, gauss_curvature, mean_curvature
from darboux import Darboux, ParameterCurve, darboux
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import gamma

from aag_cad.geometry.profiles import CrpcProfile
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface
from aag_cad.units import Floats

R0 = 5100.0
HEIGHTS = np.linspace(-2.5, 2.5, 41)
RATIOS = (1.0 / 3.0, 0.7, 1.0, 2.0, 3.0, 6.0)
ratios = pytest.mark.parametrize("n", RATIOS)


def surface(n: float) -> RevolutionSurface:
    return RevolutionSurface(CrpcProfile(R0, n))


def radius(n: float, y: Floats = HEIGHTS) -> Floats:
    return R0 * np.cosh(y) ** (1.0 / n)


def curve_on_chart(n: float, s: Floats, slope: float, theta: float = 0.2) -> Darboux:
    """Return the Darboux data of the chart's line theta = const + slope * s: an A line for slope +-1, G for 0."""
    one, zero = np.ones_like(s), np.zeros_like(s)
    jet = AsymptoticChart(surface(n)).jet(s, theta + slope * s)
    return darboux(jet, ParameterCurve(s, theta + slope * s, one, slope * one, zero, zero))


def directions_at(n: float, s: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the unit tangents of both A lines and of the G line through the points (s, 0.2), each (n, 3)."""
    one, zero = np.ones_like(s), np.zeros_like(s)
    jet = AsymptoticChart(surface(n)).jet(s, 0.2 * one)
    first, second, meridian = (
        darboux(jet, ParameterCurve(s, 0.2 * one, one, slope * one, zero, zero)).tangent for slope in (1.0, -1.0, 0.0)
    )
    return first, second, meridian


def asymptotic_curve(n: float, slope: float) -> Darboux:
    return curve_on_chart(n, HEIGHTS / math.sqrt(n), slope)


@ratios
def test_the_metric_is_that_of_the_reference(n: float) -> None:
    """ds^2 = r^2 (dy^2 / n^2 + dtheta^2): isothermal up to the constant factor n."""
    forms = fundamental_forms(surface(n).jet(HEIGHTS, 0.3 * HEIGHTS))
    np.testing.assert_allclose(forms.E, (radius(n) / n) ** 2, rtol=1e-12)
    np.testing.assert_allclose(forms.G, radius(n) ** 2, rtol=1e-12)
    np.testing.assert_allclose(forms.F / (radius(n) ** 2), 0.0, atol=1e-14)


@ratios
def test_the_slope_of_the_meridian_falls_with_the_power_n_of_the_radius(n: float) -> None:
    """Sin psi = dz/ds = (r0 / r)^n: vertical at the neck, ever flatter above it."""
    profile = CrpcProfile(R0, n)
    dr, dz = (values[1] for values in profile.meridian(HEIGHTS))
    np.testing.assert_allclose(dz / np.hypot(dr, dz), (R0 / radius(n)) ** n, rtol=1e-12)


@ratios
def test_the_principal_curvatures_keep_the_ratio_minus_n(n: float) -> None:
    forms = fundamental_forms(surface(n).jet(HEIGHTS, 0.0 * HEIGHTS))
    np.testing.assert_allclose((forms.L / forms.E) / (forms.N / forms.G), -n, rtol=1e-10)
    np.testing.assert_allclose(forms.M, 0.0, atol=1e-9)


@ratios
def test_gaussian_curvature_in_closed_form(n: float) -> None:
    """K = -n r0^(2n) / r^(2n + 2) is negative everywhere: every point has two asymptotic directions."""
    forms = fundamental_forms(surface(n).jet(HEIGHTS, 0.0 * HEIGHTS))
    np.testing.assert_allclose(gauss_curvature(forms), -n * R0 ** (2 * n) / radius(n) ** (2 * n + 2), rtol=1e-9)


def test_the_ratio_one_is_the_catenoid_a_minimal_surface() -> None:
    forms = fundamental_forms(surface(1.0).jet(HEIGHTS, 0.0 * HEIGHTS))
    np.testing.assert_allclose(mean_curvature(forms) * R0, 0.0, atol=1e-13)
    np.testing.assert_allclose(CrpcProfile(R0, 1.0).meridian(HEIGHTS)[1][0], R0 * HEIGHTS, rtol=1e-12)


@given(n=st.floats(0.3, 6.0), y=st.floats(-3.0, 3.0))
def test_derivatives_of_the_meridian_agree_with_finite_differences(n: float, y: float) -> None:
    """Sixth-order central differences of each derivative give the next one."""
    profile, step = CrpcProfile(R0, n), 5e-3
    u: Floats = y + step * np.arange(-3.0, 4.0)
    weights = np.array([-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0]) / (60.0 * step)
    for values in profile.meridian(u):
        scale = float(np.abs(values[1:]).max())
        np.testing.assert_allclose(values[:3] @ weights, values[1:, 3], atol=1e-8 * scale)


@given(n=st.floats(0.3, 6.0), y=st.floats(-6.0, 6.0))
def test_the_height_is_the_integral_of_its_slope(n: float, y: float) -> None:
    """Z(y) = (r0 / n) integral cosh^(1/n - 1), by adaptive quadrature instead of the profile's fixed one."""
    expected = R0 / n * quad(lambda t: math.cosh(t) ** (1.0 / n - 1.0), 0.0, y, epsabs=1e-12, epsrel=1e-12)[0]
    assert CrpcProfile(R0, n).meridian(np.array([y]))[1][0, 0] == pytest.approx(expected, rel=1e-10, abs=1e-9)


def test_the_height_of_the_sixty_degree_surface_is_bounded() -> None:
    """For n = 3 the height stays below r0 sqrt(pi)/6 Gamma(1/3) / Gamma(5/6) = 0.701091 r0.

    What lies above y = 8 is integrated with cosh t = exp(t) / 2, good to 1e-7 of that rest.
    """
    bound = math.sqrt(math.pi) / 6.0 * gamma(1.0 / 3.0) / gamma(5.0 / 6.0)
    assert bound == pytest.approx(0.701091, abs=5e-7)
    top = float(CrpcProfile(R0, 3.0).meridian(np.array([8.0]))[1][0, 0]) / R0
    rest = 2.0 ** (2.0 / 3.0) / 2.0 * math.exp(-16.0 / 3.0)
    assert top < bound
    assert top + rest == pytest.approx(bound, abs=1e-8)


@ratios
@pytest.mark.parametrize("slope", [1.0, -1.0])
def test_asymptotic_curves_have_no_normal_curvature(n: float, slope: float) -> None:
    assert np.abs(asymptotic_curve(n, slope).normal_curvature).max() < 1e-9


@ratios
@pytest.mark.parametrize("slope", [1.0, -1.0])
def test_geodesic_curvature_of_asymptotic_curves_in_closed_form(n: float, slope: float) -> None:
    """kappa_g = +-sin(phi) tanh(y) / r with phi = arctan sqrt(n): they bend opposite ways, and not at the neck."""
    expected = slope * math.sin(math.atan(math.sqrt(n))) * np.tanh(HEIGHTS) / radius(n)
    np.testing.assert_allclose(asymptotic_curve(n, slope).geodesic_curvature, expected, atol=1e-15)


@ratios
@pytest.mark.parametrize("slope", [1.0, -1.0])
def test_asymptotic_curves_twist_by_the_root_of_minus_k(n: float, slope: float) -> None:
    """Beltrami-Enneper: tau_g^2 = -K, so tau_g = +-sqrt(n) r0^n / r^(n + 1), with opposite signs for both families."""
    found = asymptotic_curve(n, slope).geodesic_torsion
    np.testing.assert_allclose(found, slope * math.sqrt(n) * R0**n / radius(n) ** (n + 1), rtol=1e-9)


@ratios
def test_asymptotic_curves_meet_the_meridian_at_a_constant_angle(n: float) -> None:
    one, other, meridian = directions_at(n, HEIGHTS / math.sqrt(n))
    for tangent in (one, other):
        cos = np.einsum("ij,ij->i", tangent, meridian)
        np.testing.assert_allclose(np.arccos(cos), math.atan(math.sqrt(n)), rtol=1e-12)
    between = np.arccos(np.einsum("ij,ij->i", one, other))
    np.testing.assert_allclose(between, 2.0 * math.atan(math.sqrt(n)), rtol=1e-12)


@pytest.mark.parametrize(("n", "aa_deg", "ag_deg"), [(3.0, 120.0, 60.0), (1.0, 90.0, 45.0), (1.0 / 3.0, 60.0, 30.0)])
def test_node_angles_of_the_named_surfaces(n: float, aa_deg: float, ag_deg: float) -> None:
    """Equilateral tri-hex for n = 3, the catenoid's right angle for n = 1, a bisected sector of 60 degrees for 1/3."""
    one, other, meridian = directions_at(n, np.linspace(-0.8, 0.8, 9))
    np.testing.assert_allclose(np.degrees(np.arccos(np.einsum("ij,ij->i", one, other))), aa_deg, atol=1e-9)
    np.testing.assert_allclose(np.degrees(np.arccos(np.einsum("ij,ij->i", one, meridian))), ag_deg, atol=1e-9)


@ratios
def test_meridians_are_geodesics_without_twist(n: float) -> None:
    found = asymptotic_curve(n, 0.0)
    assert np.abs(found.geodesic_curvature).max() < 1e-9
    assert np.abs(found.geodesic_torsion).max() < 1e-15
    np.testing.assert_allclose(np.abs(found.normal_curvature), n * R0**n / radius(n) ** (n + 1), rtol=1e-9)


@ratios
def test_the_meridian_is_bent_most_at_the_neck(n: float) -> None:
    """Its smallest radius is r0 / n: 1700 mm for the vault."""
    bend = np.abs(asymptotic_curve(n, 0.0).normal_curvature)
    assert int(np.argmax(bend)) == len(HEIGHTS) // 2
    assert 1.0 / bend.max() == pytest.approx(R0 / n, rel=1e-12)


@ratios
def test_the_neck_circle_is_a_planar_geodesic(n: float) -> None:
    """The paper's bottom curve: in the plane z = 0, without geodesic curvature, of radius r0."""
    theta = np.linspace(-0.6, 0.6, 13)
    one, zero = np.ones_like(theta), np.zeros_like(theta)
    jet = AsymptoticChart(surface(n)).jet(zero, theta)
    found = darboux(jet, ParameterCurve(zero, theta, zero, one, zero, zero))
    np.testing.assert_allclose(jet.point[:, 2], 0.0, atol=1e-9)
    assert np.abs(found.geodesic_curvature).max() < 1e-15
    np.testing.assert_allclose(np.abs(found.normal_curvature), 1.0 / R0, rtol=1e-12)


@ratios
def test_no_parallel_but_the_neck_is_a_geodesic(n: float) -> None:
    """kappa_g = cos psi / r = tanh(y) / r of a parallel circle, zero only at y = 0."""
    one, zero = np.ones_like(HEIGHTS), np.zeros_like(HEIGHTS)
    jet = surface(n).jet(HEIGHTS, zero)
    found = darboux(jet, ParameterCurve(HEIGHTS, zero, zero, one, zero, zero))
    np.testing.assert_allclose(found.geodesic_curvature, np.tanh(HEIGHTS) / radius(n), atol=1e-15)


def test_the_most_curved_asymptotic_curve_of_the_sixty_degree_surface() -> None:
    """For n = 3 kappa_A is largest where cosh y = 2: 0.595275 / r0 at r = 2^(1/3) r0 = 1.2599 r0."""
    y = np.linspace(0.0, 3.0, 30_001)
    bend = curve_on_chart(3.0, y / math.sqrt(3.0), 1.0).geodesic_curvature
    place = int(np.argmax(bend))
    assert bend[place] * R0 == pytest.approx(0.75 / 2.0 ** (1.0 / 3.0), rel=1e-8)
    assert bend[place] * R0 == pytest.approx(0.595275, abs=5e-7)
    assert radius(3.0, y[place]) / R0 == pytest.approx(1.2599, abs=1e-4)


def test_the_sixty_degree_surface_twists_most_at_the_neck() -> None:
    """Sqrt(3) / r0, which is 19.46 degrees a metre for the vault."""
    twist = asymptotic_curve(3.0, 1.0).geodesic_torsion
    assert twist.max() == pytest.approx(math.sqrt(3.0) / R0, rel=1e-12)
    assert math.degrees(twist.max()) * 1000.0 == pytest.approx(19.46, abs=0.005)


@given(n=st.floats(0.3, 6.0), s=st.floats(-1.5, 1.5))
def test_the_asymptotic_coordinate_is_the_meridian_parameter_over_root_n(n: float, s: float) -> None:
    profile = CrpcProfile(R0, n)
    back = profile.asymptotic(profile.from_asymptotic(np.array([s])))
    np.testing.assert_allclose(back, s, rtol=1e-14, atol=1e-300)
    np.testing.assert_allclose(profile.from_asymptotic(np.array([s])), s * math.sqrt(n), rtol=1e-14, atol=1e-300)
