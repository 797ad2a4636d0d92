"""The Darboux frame: how a plank on a surface is bent about its two axes, and how it is twisted."""

import math

import numpy as np
from curvatures import fundamental_forms, gauss_curvature, mean_curvature
from darboux import Darboux, ParameterCurve, darboux
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import Chebyshev

from aag_cad.geometry.profiles import CrpcProfile
from aag_cad.geometry.revolution import RevolutionSurface
from aag_cad.geometry.surface import Jet, dot
from aag_cad.units import Floats

RADIUS = 1700.0


def sphere(u: Floats, v: Floats) -> Jet:
    """Return the 2-jet of a sphere: u is the latitude, v the longitude; X_u x X_v points inwards."""
    zero, r = np.zeros_like(u), RADIUS
    out, east = np.column_stack([np.cos(v), np.sin(v), zero]), np.column_stack([-np.sin(v), np.cos(v), zero])
    up = np.column_stack([zero, zero, zero + r])
    sin, cos = np.sin(u)[:, None], np.cos(u)[:, None]
    return Jet(
        point=r * cos * out + sin * up,
        du=-r * sin * out + cos * up,
        dv=r * cos * east,
        duu=-r * cos * out - sin * up,
        duv=-r * sin * east,
        dvv=-r * cos * out,
    )


def cylinder(u: Floats, v: Floats) -> Jet:
    """Return the 2-jet of a cylinder: u is the angle, v the height; X_u x X_v points outwards."""
    zero, r = np.zeros_like(u), RADIUS
    out, around = np.column_stack([np.cos(u), np.sin(u), zero]), np.column_stack([-np.sin(u), np.cos(u), zero])
    flat = np.zeros((len(u), 3))
    return Jet(
        r * out + np.column_stack([zero, zero, v]), r * around, flat + np.array([0.0, 0.0, 1.0]), -r * out, flat, flat
    )


def straight(u0: float, v0: float, du: float, dv: float, t: Floats) -> ParameterCurve:
    """Return the straight line (u0, v0) + t (du, dv) of the parameter plane."""
    one = np.ones_like(t)
    return ParameterCurve(u0 + du * t, v0 + dv * t, du * one, dv * one, 0.0 * one, 0.0 * one)


def wave(turn: float, swing: float, t: Floats) -> ParameterCurve:
    """Return a wavy line of the parameter plane."""
    return ParameterCurve(
        0.2 + swing * np.sin(3.0 * t),
        turn * t,
        3.0 * swing * np.cos(3.0 * t),
        turn * np.ones_like(t),
        -9.0 * swing * np.sin(3.0 * t),
        np.zeros_like(t),
    )


def vault_surface() -> RevolutionSurface:
    return RevolutionSurface(CrpcProfile(5100.0, 3.0))


def on_vault(curve: ParameterCurve) -> Darboux:
    return darboux(vault_surface().jet(curve.u, curve.v), curve)


def chebyshev_derivative(t: Floats, values: Floats, order: int = 1) -> Floats:
    """Return derivatives (n, 3) of samples (n, 3) at t by a Chebyshev series, independent of any 2-jet."""
    columns = [Chebyshev.fit(t, values[:, i], 40).deriv(order)(t) for i in range(values.shape[1])]
    return np.column_stack(columns)


CHEBYSHEV_NODES = np.cos(np.pi * np.arange(121) / 120.0)[::-1] * 0.5


def test_a_helix_is_a_geodesic_of_its_cylinder() -> None:
    climb = 0.6
    curve = straight(0.1, 0.0, math.cos(climb) / RADIUS, math.sin(climb), np.linspace(0.0, 5000.0, 20))
    found = darboux(cylinder(curve.u, curve.v), curve)
    np.testing.assert_allclose(found.speed, 1.0, rtol=1e-14)
    np.testing.assert_allclose(found.geodesic_curvature, 0.0, atol=1e-18)
    np.testing.assert_allclose(found.normal_curvature, -(math.cos(climb) ** 2) / RADIUS, rtol=1e-12)


def test_the_twist_of_a_helix_is_its_torsion_because_it_is_a_geodesic() -> None:
    """A right-handed helix of pitch angle a on a cylinder of radius r has torsion + sin a cos a / r."""
    climb = 0.6
    curve = straight(0.1, 0.0, math.cos(climb) / RADIUS, math.sin(climb), np.linspace(0.0, 5000.0, 20))
    found = darboux(cylinder(curve.u, curve.v), curve)
    np.testing.assert_allclose(found.geodesic_torsion, math.sin(climb) * math.cos(climb) / RADIUS, rtol=1e-12)


def test_a_parallel_of_latitude_bends_with_the_tangent_of_the_latitude_and_does_not_twist() -> None:
    latitude = np.linspace(-1.2, 1.2, 13)
    curve = straight(0.0, 0.0, 0.0, 1.0, latitude)
    curve = ParameterCurve(latitude, curve.v, curve.du, curve.dv, curve.ddu, curve.ddv)
    found = darboux(sphere(curve.u, curve.v), curve)
    np.testing.assert_allclose(found.normal_curvature, 1.0 / RADIUS, rtol=1e-12)
    np.testing.assert_allclose(np.abs(found.geodesic_curvature), np.abs(np.tan(latitude)) / RADIUS, atol=1e-16)
    np.testing.assert_allclose(found.geodesic_torsion, 0.0, atol=1e-18)


def test_a_parallel_bends_towards_the_pole_that_it_goes_round() -> None:
    """Going east in the north, seen from outside, the pole lies to the left: kappa_g > 0 with the outward normal."""
    found = darboux(sphere(np.array([0.7]), np.array([0.0])), straight(0.7, 0.0, 0.0, 1.0, np.array([0.0])))
    curvature_vector = (
        found.normal_curvature[:, None] * found.normal + found.geodesic_curvature[:, None] * found.binormal
    )
    np.testing.assert_allclose(curvature_vector[0], [-1.0 / (RADIUS * math.cos(0.7)), 0.0, 0.0], atol=1e-16)


@given(turn=st.floats(0.2, 2.0), swing=st.floats(-0.5, 0.5))
def test_normal_and_geodesic_curvature_are_the_legs_of_the_curvature(turn: float, swing: float) -> None:
    """kappa^2 = kappa_n^2 + kappa_g^2, with kappa = |c' x c''| / |c'|^3 from the points alone."""
    t = CHEBYSHEV_NODES
    curve = wave(turn, swing, t)
    points = vault_surface().jet(curve.u, curve.v).point
    first, second = chebyshev_derivative(t, points), chebyshev_derivative(t, points, 2)
    kappa = np.linalg.norm(np.cross(first, second), axis=1) / np.linalg.norm(first, axis=1) ** 3
    found = on_vault(curve)
    # the second derivative of a Chebyshev series loses about six digits at the ends of its interval
    np.testing.assert_allclose(np.hypot(found.normal_curvature, found.geodesic_curvature), kappa, rtol=1e-7)


def test_the_frame_turns_by_the_three_curvatures() -> None:
    """By arc length t' = kappa_g b + kappa_n n and n' = -kappa_n t - tau_g b: this fixes all three signs."""
    t = CHEBYSHEV_NODES
    found = on_vault(wave(0.8, 0.3, t))
    kn, kg, twist = (
        values[:, None] for values in (found.normal_curvature, found.geodesic_curvature, found.geodesic_torsion)
    )
    speed = found.speed[:, None]
    inner = slice(5, -5)
    tangent_turn = (chebyshev_derivative(t, found.tangent) / speed)[inner]
    normal_turn = (chebyshev_derivative(t, found.normal) / speed)[inner]
    np.testing.assert_allclose(tangent_turn, (kg * found.binormal + kn * found.normal)[inner], atol=1e-12)
    np.testing.assert_allclose(normal_turn, (-kn * found.tangent - twist * found.binormal)[inner], atol=1e-12)


def test_the_frame_is_orthonormal_and_right_handed() -> None:
    found = on_vault(wave(0.8, 0.3, np.linspace(-1.0, 1.0, 40)))
    frames = np.stack([found.tangent, found.binormal, found.normal], axis=1)
    np.testing.assert_allclose(frames @ frames.transpose(0, 2, 1), np.broadcast_to(np.eye(3), (40, 3, 3)), atol=1e-14)
    np.testing.assert_allclose(np.linalg.det(frames), 1.0, rtol=1e-14)
    np.testing.assert_allclose(found.binormal, np.cross(found.normal, found.tangent), atol=1e-14)


@given(angle=st.floats(0.0, math.pi), u=st.floats(-1.5, 1.5))
def test_normal_curvature_and_twist_follow_euler(angle: float, u: float) -> None:
    """kappa_n = k1 cos^2 a + k2 sin^2 a and tau_g = (k2 - k1) sin a cos a, a from the meridian to the parallel."""
    jet = vault_surface().jet(np.array([u]), np.array([0.3]))
    forms = fundamental_forms(jet)
    curve = straight(
        u, 0.3, math.cos(angle) / math.sqrt(forms.E[0]), math.sin(angle) / math.sqrt(forms.G[0]), np.array([0.0])
    )
    found = darboux(jet, curve)
    k1, k2 = forms.L[0] / forms.E[0], forms.N[0] / forms.G[0]
    cos, sin = math.cos(angle), math.sin(angle)
    scale = abs(k1) + abs(k2)
    np.testing.assert_allclose(found.normal_curvature[0], k1 * cos**2 + k2 * sin**2, atol=1e-12 * scale)
    np.testing.assert_allclose(found.geodesic_torsion[0], (k2 - k1) * sin * cos, atol=1e-12 * scale)


@given(angle=st.floats(0.0, math.pi), u=st.floats(-1.5, 1.5))
def test_curvatures_of_crossing_curves_are_bound_to_gauss_and_mean(angle: float, u: float) -> None:
    """Across each other, kappa_n1 kappa_n2 - tau_g^2 = K and kappa_n1 + kappa_n2 = 2 H, whatever the angle."""
    jet = vault_surface().jet(np.array([u]), np.array([0.0]))
    forms = fundamental_forms(jet)
    e, g = math.sqrt(forms.E[0]), math.sqrt(forms.G[0])
    one, other = (
        darboux(jet, straight(u, 0.0, math.cos(a) / e, math.sin(a) / g, np.array([0.0])))
        for a in (angle, angle + math.pi / 2.0)
    )
    product = one.normal_curvature * other.normal_curvature - one.geodesic_torsion**2
    np.testing.assert_allclose(product, gauss_curvature(forms), rtol=1e-9)
    total = one.normal_curvature + other.normal_curvature
    np.testing.assert_allclose(total, 2.0 * mean_curvature(forms), rtol=1e-9)


@given(rate=st.floats(0.01, 100.0))
def test_curvatures_do_not_depend_on_how_fast_the_curve_is_run_through(rate: float) -> None:
    t = np.linspace(-0.5, 0.5, 9)
    slow = wave(0.8, 0.3, t)
    fast = ParameterCurve(slow.u, slow.v, rate * slow.du, rate * slow.dv, rate**2 * slow.ddu, rate**2 * slow.ddv)
    one, other = on_vault(slow), on_vault(fast)
    np.testing.assert_allclose(other.speed, rate * one.speed, rtol=1e-12)
    for name in ("normal_curvature", "geodesic_curvature", "geodesic_torsion"):
        np.testing.assert_allclose(getattr(other, name), getattr(one, name), rtol=1e-9, atol=1e-15)


def test_running_a_curve_backwards_flips_only_its_geodesic_curvature() -> None:
    """The binormal n x t turns over with t, so the sideways bend changes sign; kappa_n and tau_g are even in t."""
    t = np.linspace(-0.5, 0.5, 9)
    ahead = wave(0.8, 0.3, t)
    back = ParameterCurve(ahead.u, ahead.v, -ahead.du, -ahead.dv, ahead.ddu, ahead.ddv)
    one, other = on_vault(ahead), on_vault(back)
    np.testing.assert_allclose(other.geodesic_curvature, -one.geodesic_curvature, rtol=1e-12)
    np.testing.assert_allclose(other.normal_curvature, one.normal_curvature, rtol=1e-12)
    np.testing.assert_allclose(other.geodesic_torsion, one.geodesic_torsion, rtol=1e-12)
    assert np.all(dot(one.binormal, other.binormal) < -0.999)
