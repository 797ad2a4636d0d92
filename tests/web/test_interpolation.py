"""The surface through a web tends to the smooth surface that the web stands for, with its curvatures."""

import math

import numpy as np
import pytest
from curvatures import fundamental_forms, gauss_curvature
from web_curves import a_curve_normal_curvature, surface_line

from aag_cad.design import Design
from aag_cad.errors import SurfaceError
from aag_cad.geometry.framed import curvatures_at
from aag_cad.geometry.profiles import CrpcProfile
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface
from aag_cad.pipeline import web_of
from aag_cad.units import Floats
from aag_cad.web.interpolation import interpolated_surface
from aag_cad.web.web import Web, crpc_web, sampled_web

R0, RATIO, AXIS = 5100.0, 3.0, -8823.0
HEIGHT, HALF = 0.64, 0.32
CHART = AsymptoticChart(RevolutionSurface(CrpcProfile(R0, RATIO), AXIS))


def sampled(cells: int) -> Web:
    return sampled_web(CHART, np.linspace(0.0, HEIGHT, cells + 1), np.linspace(-HALF, HALF, cells + 1))


def exact(cells: int) -> Web:
    return crpc_web(R0, RATIO, AXIS, np.linspace(-HALF, HALF, cells + 1), 0, cells)


def inside() -> tuple[Floats, Floats]:
    """Return parameters over the web without its outer eighth."""
    one = np.linspace(HEIGHT / 8.0, 7.0 * HEIGHT / 8.0, 23)
    u, v = np.meshgrid(one, one)
    return u.ravel(), v.ravel()


def errors(web: Web, cells: int) -> Floats:
    """Return the largest errors of the point (mm) and of the Gaussian curvature (per its largest value)."""
    u, v = inside()
    found = interpolated_surface(web, HEIGHT / cells).jet(u, v)
    true = CHART.jet(u, v - HALF)
    curvature = gauss_curvature(fundamental_forms(true))
    wrong = gauss_curvature(fundamental_forms(found)) - curvature
    return np.array([np.abs(found.point - true.point).max(), np.abs(wrong).max() / np.abs(curvature).max()])


def test_every_vertex_of_the_web_lies_on_the_surface() -> None:
    web = exact(8)
    u, v = (grid.ravel() for grid in np.meshgrid(0.5 * np.arange(9), 0.5 * np.arange(9), indexing="ij"))
    found = interpolated_surface(web, 0.5).jet(u, v).point
    np.testing.assert_allclose(found, web.vertices.reshape(-1, 3), rtol=0.0, atol=1e-8)


def test_the_surface_of_a_sampled_web_tends_to_the_smooth_surface() -> None:
    """A quintic spline errs by h^6 in the point and h^4 in curvature: half the step, at least 1/32 and 1/8."""
    coarse, middle, fine = (errors(sampled(cells), cells) for cells in (8, 16, 32))
    assert np.all(middle < coarse / [32.0, 8.0])
    assert np.all(fine < middle / [32.0, 8.0])
    assert fine[0] < 1e-6
    assert fine[1] < 1e-6


def test_the_surface_of_the_exact_discrete_web_tends_to_the_smooth_surface_too() -> None:
    """The discrete web differs from the smooth surface by h^2: half the step, about a quarter of the error."""
    coarse, middle, fine = (errors(exact(cells), cells) for cells in (8, 16, 32))
    np.testing.assert_allclose(coarse[0] / middle[0], 4.0, rtol=0.1)
    np.testing.assert_allclose(middle[0] / fine[0], 4.0, rtol=0.1)
    assert np.all(fine < middle / 3.5)


def test_the_derivatives_are_those_of_the_points() -> None:
    surface, e = interpolated_surface(exact(8), HEIGHT / 8), 1e-4
    u, v = inside()
    jet, at = surface.jet(u, v), lambda a, b: surface.jet(u + a * e, v + b * e).point
    np.testing.assert_allclose(jet.du, (at(1, 0) - at(-1, 0)) / (2 * e), rtol=0.0, atol=0.01)
    np.testing.assert_allclose(jet.dv, (at(0, 1) - at(0, -1)) / (2 * e), rtol=0.0, atol=0.01)
    mixed = (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4 * e**2)
    np.testing.assert_allclose(jet.duv, mixed, rtol=0.0, atol=0.5)
    np.testing.assert_allclose(jet.duu, (at(1, 0) - 2 * jet.point + at(-1, 0)) / e**2, rtol=0.0, atol=0.5)
    np.testing.assert_allclose(jet.dvv, (at(0, 1) - 2 * jet.point + at(0, -1)) / e**2, rtol=0.0, atol=0.5)


def test_the_normal_curvature_of_the_a_curves_goes_to_zero_with_the_step() -> None:
    """On the smooth surface they are asymptotic: kappa_n = 0 (paper section 1.1)."""
    smooth = [a_curve_normal_curvature(sampled(cells)) for cells in (8, 16, 32)]
    discrete = [a_curve_normal_curvature(exact(cells)) for cells in (8, 16, 32)]
    assert smooth[1] < smooth[0] / 8.0
    assert smooth[2] < smooth[1] / 8.0
    assert discrete[1] < discrete[0] / 3.5
    assert discrete[2] < discrete[1] / 3.5
    # A radius of 10 km in the weak direction of a plank is straight.
    assert discrete[2] < 1e-7


def test_the_a_curves_of_the_vault_are_straight_the_stiff_way(design: Design, chart: AsymptoticChart) -> None:
    """A radius of more than 5 km bends a 100 mm wide plank by 50 / 5e6 = 1e-5: less than 0.2 MPa."""
    assert a_curve_normal_curvature(web_of(design, chart)) < 1.0 / 5.0e6


def test_on_a_sphere_the_normal_curvature_is_one_over_the_radius() -> None:
    one = np.linspace(-0.4, 0.4, 13)
    phi, theta = np.meshgrid(one, one, indexing="ij")
    points = np.stack([np.cos(phi) * np.cos(theta), np.cos(phi) * np.sin(theta), np.sin(phi)], axis=-1)
    assert a_curve_normal_curvature(Web(4000.0 * points)) == pytest.approx(1.0 / 4000.0, rel=1e-5)


def test_the_lines_of_the_surface_are_asymptotic_and_geodesic_curves() -> None:
    """kappa_n = 0 on v = c +- u and kappa_g = 0 on v = const, where no plank could bend."""
    surface = interpolated_surface(sampled(16), HEIGHT / 16)
    for slope, intercept in ((1, 0.0), (-1, HEIGHT), (1, 0.11), (0, 0.3)):
        curve = surface_line(surface, slope, intercept)
        found = curvatures_at(curve, np.linspace(0.15, 0.85, 30) * curve.length)
        assert np.abs(found.normal if slope else found.geodesic).max() < 1e-7
        assert np.abs(found.geodesic if slope else found.normal).max() > 1e-5


def test_the_lines_meet_at_the_angle_of_the_web() -> None:
    surface = interpolated_surface(sampled(16), HEIGHT / 16)
    jet = surface.jet(*inside())
    for slope in (1.0, -1.0):
        along = jet.du + slope * jet.dv
        cosine = np.einsum("ij,ij->i", along, jet.du) / np.linalg.norm(along, axis=1) / np.linalg.norm(jet.du, axis=1)
        np.testing.assert_allclose(cosine, math.cos(math.atan(math.sqrt(RATIO))), atol=1e-6)


def test_a_small_web_is_one_polynomial_piece() -> None:
    web = Web(exact(8).vertices[:4, :3])
    surface = interpolated_surface(web, 1.0)
    assert surface.degrees == (3, 2)
    np.testing.assert_allclose(surface.jet(np.array([3.0]), np.array([2.0])).point[0], web.vertices[3, 2], atol=1e-8)


def test_points_and_lines_off_the_web_are_refused() -> None:
    surface = interpolated_surface(exact(8), 1.0)
    with pytest.raises(SurfaceError, match=r"u = 8\.5000 lies outside the web, which covers u from 0\.0000 to 8\.0000"):
        surface.jet(np.array([8.5]), np.array([1.0]))
    with pytest.raises(SurfaceError, match="v = nan lies outside"):
        surface.jet(np.array([1.0]), np.array([np.nan]))
    for slope, intercept in ((0, -1.0), (1, 9.0), (-1, -0.5)):
        with pytest.raises(SurfaceError, match="misses the web"):
            surface_line(surface, slope, intercept)
    with pytest.raises(SurfaceError, match=r"step 0\.0"):
        interpolated_surface(exact(8), 0.0)
    with pytest.raises(SurfaceError, match="at least 3 x 3"):
        interpolated_surface(Web(exact(8).vertices[:2]), 1.0)
    with pytest.raises(SurfaceError, match=r"4 x 9 vertices; .* at least 5 x 5"):
        a_curve_normal_curvature(Web(exact(8).vertices[:4]))
