"""Geodesics between two points: great circles, helices, and Clairaut's constant on the vault's own surface."""

import math

import numpy as np
import pytest
from darboux import ParameterCurve, darboux
from numpy.polynomial import Chebyshev

from aag_cad.errors import NetworkError
from aag_cad.geometry.geodesic import geodesic_acceleration, geodesic_between
from aag_cad.geometry.profiles import CrpcProfile
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface
from aag_cad.geometry.surface import Jet, Surface
from aag_cad.units import Floats

RADIUS = 1700.0
T = np.linspace(0.0, 1.0, 41)


class Sphere:
    """A sphere by latitude u and longitude v."""

    def jet(self, u: Floats, v: Floats) -> Jet:
        """Return its 2-jet."""
        zero = np.zeros_like(u)
        out, east = np.column_stack([np.cos(v), np.sin(v), zero]), np.column_stack([-np.sin(v), np.cos(v), zero])
        up = np.column_stack([zero, zero, zero + RADIUS])
        sin, cos = RADIUS * np.sin(u)[:, None], RADIUS * np.cos(u)[:, None]
        lifted = np.sin(u)[:, None] * up
        return Jet(cos * out + lifted, -sin * out + np.cos(u)[:, None] * up, cos * east, -cos * out - lifted,
                   -sin * east, -cos * out)  # fmt: skip


class Cylinder:
    """A cylinder by angle u and height v."""

    def jet(self, u: Floats, v: Floats) -> Jet:
        """Return its 2-jet."""
        zero, flat = np.zeros_like(u), np.zeros((len(u), 3))
        out = RADIUS * np.column_stack([np.cos(u), np.sin(u), zero])
        around = RADIUS * np.column_stack([-np.sin(u), np.cos(u), zero])
        return Jet(out + np.column_stack([zero, zero, v]), around, flat + np.array([0.0, 0.0, 1.0]), -out, flat, flat)


def vault_chart() -> AsymptoticChart:
    return AsymptoticChart(RevolutionSurface(CrpcProfile(5100.0, 3.0), -8823.0))


def path_points(surface: Surface, start: tuple[float, float], end: tuple[float, float]) -> Floats:
    """Return points (41, 3) at equal parameters along the geodesic."""
    return surface.jet(*geodesic_between(surface, np.array(start), np.array(end))(T)).point


def test_geodesics_of_a_sphere_are_great_circles() -> None:
    """All points lie in one plane through the centre."""
    points = path_points(Sphere(), (0.2, -0.4), (0.9, 1.1))
    normal = np.cross(points[0], points[-1])
    assert np.abs(points @ (normal / np.linalg.norm(normal))).max() < 1e-6


def test_a_geodesic_of_a_sphere_is_as_long_as_the_angle_between_its_ends() -> None:
    points = path_points(Sphere(), (0.2, -0.4), (0.9, 1.1))
    angle = math.acos(float(points[0] @ points[-1]) / RADIUS**2)
    steps = np.arccos(np.clip(np.einsum("ij,ij->i", points[1:], points[:-1]) / RADIUS**2, -1.0, 1.0))
    assert steps.sum() == pytest.approx(angle, rel=1e-9)


def test_geodesics_of_a_cylinder_are_helices() -> None:
    """Unrolled they are straight: equal climb for equal turn."""
    path = geodesic_between(Cylinder(), np.array([0.1, -300.0]), np.array([1.4, 2200.0]))
    u, v = path(T)
    np.testing.assert_allclose(u, 0.1 + 1.3 * T, atol=1e-9)
    np.testing.assert_allclose(v, -300.0 + 2500.0 * T, atol=1e-6)


def test_a_geodesic_runs_at_constant_speed() -> None:
    """The affine parameter of the geodesic equation is proportional to arc length."""
    points = path_points(vault_chart(), (0.3, 0.5), (0.6, -0.1))
    velocity = np.column_stack([Chebyshev.fit(T, points[:, i], 20).deriv()(T) for i in range(3)])
    speed = np.linalg.norm(velocity, axis=1)
    np.testing.assert_allclose(speed, speed.mean(), rtol=1e-7)


def test_clairaut_radius_times_sine_of_the_angle_to_the_meridian_is_constant() -> None:
    """On the vault's surface, over a geodesic like that of its ridge: constant to 1e-8 of r0."""
    chart = vault_chart()
    path = geodesic_between(chart, np.array([0.5, 0.55]), np.array([0.68, 0.0]))
    s, theta = path(T)
    points = chart.jet(s, theta).point
    velocity = np.column_stack([Chebyshev.fit(T, points[:, i], 20).deriv()(T) for i in range(3)])
    radius = np.hypot(points[:, 0] + 8823.0, points[:, 1])
    around = np.column_stack([-np.sin(theta), np.cos(theta), 0.0 * theta])
    sine = np.einsum("ij,ij->i", velocity, around) / np.linalg.norm(velocity, axis=1)
    constant = radius * sine
    assert np.ptp(constant) < 1e-8 * 5100.0
    assert abs(constant.mean()) > 1000.0


def test_the_geodesic_equation_leaves_no_geodesic_curvature() -> None:
    chart = vault_chart()
    u, v = np.linspace(0.1, 0.7, 12), np.linspace(-0.5, 0.5, 12)
    du, dv = 0.3 + 0.0 * u, np.linspace(-1.0, 1.0, 12)
    curve = ParameterCurve(u, v, du, dv, *geodesic_acceleration(chart, u, v, du, dv))
    assert np.abs(darboux(chart.jet(u, v), curve).geodesic_curvature).max() < 1e-16


def test_a_meridian_and_the_neck_are_found_as_geodesics() -> None:
    """Theta stays constant up the meridian; s stays zero along the neck, the paper's bottom curve."""
    chart = vault_chart()
    _, theta = geodesic_between(chart, np.array([0.1, 0.3]), np.array([0.7, 0.3]))(T)
    np.testing.assert_allclose(theta, 0.3, atol=1e-9)
    s, _ = geodesic_between(chart, np.array([0.0, -0.5]), np.array([0.0, 0.5]))(T)
    np.testing.assert_allclose(s, 0.0, atol=1e-9)


def test_the_ends_are_met() -> None:
    path = geodesic_between(vault_chart(), np.array([0.5, 0.55]), np.array([0.68, 0.0]))
    np.testing.assert_allclose(np.column_stack(path(np.array([0.0, 1.0]))), [[0.5, 0.55], [0.68, 0.0]], atol=1e-9)


def test_points_that_no_geodesic_joins_are_refused_with_the_ends_and_a_remedy() -> None:
    """From pole to pole of a sphere every meridian is one: the problem has no single solution."""
    with pytest.raises(NetworkError, match=r"no geodesic found from \(s, theta\) = \(.*\) to \(.*\): .*; move the end"):
        geodesic_between(Sphere(), np.array([-math.pi / 2.0 + 1e-9, 0.0]), np.array([math.pi / 2.0 - 1e-9, 3.0]))
