"""Gaussian and mean curvature of surfaces whose closed forms stand in every textbook."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from curvatures import Forms, fundamental_forms, gauss_curvature, mean_curvature

from aag_cad.geometry.surface import Jet, unit_normals
from aag_cad.units import Floats

RELATIVE = 1e-12


def cylinder(u: Floats, v: Floats, radius: float = 1700.0) -> Jet:
    """Return the 2-jet of the circular cylinder: u is the angle, v the height."""
    zero = np.zeros_like(u)
    return Jet(
        point=np.column_stack([radius * np.cos(u), radius * np.sin(u), v]),
        du=np.column_stack([-radius * np.sin(u), radius * np.cos(u), zero]),
        dv=np.column_stack([zero, zero, zero + 1.0]),
        duu=np.column_stack([-radius * np.cos(u), -radius * np.sin(u), zero]),
        duv=np.zeros((len(u), 3)),
        dvv=np.zeros((len(u), 3)),
    )


def torus(u: Floats, v: Floats, ring: float = 900.0, tube: float = 300.0) -> Jet:
    """Return the 2-jet of the torus: u runs around the ring, v around the tube."""
    zero, reach = np.zeros_like(u), ring + tube * np.cos(v)
    out, along = np.column_stack([np.cos(u), np.sin(u), zero]), np.column_stack([-np.sin(u), np.cos(u), zero])
    up = np.column_stack([zero, zero, zero + 1.0])
    sin, cos = tube * np.sin(v)[:, None], tube * np.cos(v)[:, None]
    return Jet(
        point=reach[:, None] * out + sin * up,
        du=reach[:, None] * along,
        dv=-sin * out + cos * up,
        duu=-reach[:, None] * out,
        duv=-sin * along,
        dvv=-cos * out - sin * up,
    )


def sphere(u: Floats, v: Floats) -> Jet:
    """Return the 2-jet of the sphere of radius 300: a torus whose ring has shrunk to its centre."""
    return torus(u, v, ring=0.0, tube=300.0)


def helicoid(u: Floats, v: Floats, pitch: float = 250.0) -> Jet:
    """Return the 2-jet of the helicoid (u cos v, u sin v, pitch v)."""
    cos, sin, zero = np.cos(v), np.sin(v), np.zeros_like(u)
    return Jet(
        point=np.column_stack([u * cos, u * sin, pitch * v]),
        du=np.column_stack([cos, sin, zero]),
        dv=np.column_stack([-u * sin, u * cos, zero + pitch]),
        duu=np.zeros((len(u), 3)),
        duv=np.column_stack([-sin, cos, zero]),
        dvv=np.column_stack([-u * cos, -u * sin, zero]),
    )


def hyperbolic_paraboloid(u: Floats, v: Floats, a: float = 400.0) -> Jet:
    """Return the 2-jet of the saddle z = u v / a."""
    zero = np.zeros_like(u)
    one = zero + 1.0
    return Jet(
        point=np.column_stack([u, v, u * v / a]),
        du=np.column_stack([one, zero, v / a]),
        dv=np.column_stack([zero, one, u / a]),
        duu=np.zeros((len(u), 3)),
        duv=np.column_stack([zero, zero, one / a]),
        dvv=np.zeros((len(u), 3)),
    )


GRID_U, GRID_V = (grid.ravel() for grid in np.meshgrid(np.linspace(0.3, 2.9, 7), np.linspace(-1.2, 1.3, 8)))


def forms_of(surface: Callable[[Floats, Floats], Jet]) -> Forms:
    return fundamental_forms(surface(GRID_U, GRID_V))


def test_a_cylinder_is_developable_and_bends_once() -> None:
    forms = forms_of(cylinder)
    np.testing.assert_allclose(gauss_curvature(forms), 0.0, atol=1e-20)
    np.testing.assert_allclose(np.abs(mean_curvature(forms)), 1.0 / (2.0 * 1700.0), rtol=RELATIVE)


def test_a_sphere_has_constant_curvatures() -> None:
    forms = forms_of(sphere)
    np.testing.assert_allclose(gauss_curvature(forms), 1.0 / 300.0**2, rtol=RELATIVE)
    np.testing.assert_allclose(np.abs(mean_curvature(forms)), 1.0 / 300.0, rtol=RELATIVE)


def test_a_torus_is_curved_either_way_on_its_outside_and_inside() -> None:
    v = np.linspace(-math.pi, math.pi, 31)
    forms = fundamental_forms(torus(np.linspace(0.0, 2.0, 31), v))
    reach = 900.0 + 300.0 * np.cos(v)
    np.testing.assert_allclose(gauss_curvature(forms), np.cos(v) / (300.0 * reach), rtol=RELATIVE, atol=1e-19)
    np.testing.assert_allclose(
        np.abs(mean_curvature(forms)), (900.0 + 600.0 * np.cos(v)) / (600.0 * reach), rtol=RELATIVE
    )


def test_a_helicoid_is_minimal() -> None:
    forms = forms_of(helicoid)
    np.testing.assert_allclose(mean_curvature(forms), 0.0, atol=1e-18)
    np.testing.assert_allclose(gauss_curvature(forms), -(250.0**2) / (GRID_U**2 + 250.0**2) ** 2, rtol=RELATIVE)


def test_the_parameter_lines_of_a_helicoid_are_its_asymptotic_curves() -> None:
    forms = forms_of(helicoid)
    np.testing.assert_allclose(np.concatenate([forms.L, forms.N]), 0.0, atol=1e-15)
    assert np.all(forms.M != 0.0)


def test_a_hyperbolic_paraboloid_is_negatively_curved_everywhere() -> None:
    forms = fundamental_forms(hyperbolic_paraboloid(100.0 * GRID_U, 100.0 * GRID_V))
    stretch = 1.0 + (100.0 / 400.0) ** 2 * (GRID_U**2 + GRID_V**2)
    np.testing.assert_allclose(gauss_curvature(forms), -1.0 / 400.0**2 / stretch**2, rtol=RELATIVE)
    expected = -(100.0**2) * GRID_U * GRID_V / 400.0**3 / stretch**1.5
    np.testing.assert_allclose(mean_curvature(forms), expected, rtol=RELATIVE, atol=1e-18)


@pytest.mark.parametrize("surface", [cylinder, torus, sphere, helicoid, hyperbolic_paraboloid])
def test_the_first_form_measures_the_area_of_the_parallelogram_of_the_tangents(
    surface: Callable[[Floats, Floats], Jet],
) -> None:
    """E G - F^2 = |X_u x X_v|^2 (Lagrange's identity)."""
    jet, forms = surface(GRID_U, GRID_V), forms_of(surface)
    area = np.linalg.norm(np.cross(jet.du, jet.dv), axis=1)
    np.testing.assert_allclose(np.sqrt(forms.E * forms.G - forms.F**2), area, rtol=RELATIVE)


@pytest.mark.parametrize("surface", [cylinder, torus, helicoid, hyperbolic_paraboloid])
def test_turning_the_normal_over_flips_mean_but_not_gaussian_curvature(
    surface: Callable[[Floats, Floats], Jet],
) -> None:
    """Exchanging u and v reverses the normal X_u x X_v."""
    jet = surface(GRID_U, GRID_V)
    turned = Jet(jet.point, jet.dv, jet.du, jet.dvv, jet.duv, jet.duu)
    np.testing.assert_allclose(unit_normals(turned), -unit_normals(jet), atol=1e-15)
    one, other = fundamental_forms(jet), fundamental_forms(turned)
    np.testing.assert_allclose(gauss_curvature(other), gauss_curvature(one), rtol=RELATIVE)
    np.testing.assert_allclose(mean_curvature(other), -mean_curvature(one), rtol=RELATIVE, atol=1e-18)
