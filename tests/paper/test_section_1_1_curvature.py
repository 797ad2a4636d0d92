"""Section 1.1 and Fig. 1: curvature of curves and planks.

Not asserted: anything about the bending of real timber; planks are ideal strips here.
"""

import numpy as np
import pytest
from curvatures import fundamental_forms
from darboux import Darboux, ParameterCurve, darboux

from aag_cad.geometry.framed import curvatures_at, frames_at
from aag_cad.geometry.revolution import AsymptoticChart
from aag_cad.network.model import CurveNetwork, NetworkCurve
from aag_cad.parts.forming import plank_axes
from aag_cad.parts.model import Shell

S = np.linspace(0.05, 1.2, 24)


def line(chart: AsymptoticChart, slope: float) -> Darboux:
    """Return the Darboux data along theta = 0.1 + slope * s."""
    one, zero = np.ones_like(S), np.zeros_like(S)
    theta = 0.1 + slope * S
    return darboux(chart.jet(S, theta), ParameterCurve(S, theta, one, slope * one, zero, zero))


@pytest.mark.parametrize("slope", [1.0, 0.37, -0.8, 0.0])
def test_figure_1a_the_angle_between_curvature_vector_and_normal_splits_the_curvature(
    chart: AsymptoticChart, slope: float
) -> None:
    """kappa_n = kappa cos(alpha), kappa_g = kappa sin(alpha), kappa^2 = kappa_n^2 + kappa_g^2 (section 1.1)."""
    found = line(chart, slope)
    vector = found.normal_curvature[:, None] * found.normal + found.geodesic_curvature[:, None] * found.binormal
    kappa = np.linalg.norm(vector, axis=1)
    alpha = np.arctan2(np.linalg.norm(np.cross(vector, found.normal), axis=1), np.sum(vector * found.normal, axis=1))
    np.testing.assert_allclose(kappa * np.cos(alpha), found.normal_curvature, atol=1e-16)
    np.testing.assert_allclose(kappa * np.sin(alpha), np.abs(found.geodesic_curvature), atol=1e-16)
    np.testing.assert_allclose(kappa**2, found.normal_curvature**2 + found.geodesic_curvature**2, rtol=1e-12)


def test_an_asymptotic_curve_is_the_case_alpha_90_degrees(chart: AsymptoticChart) -> None:
    """Section 1.1: kappa_n = 0, the curvature vectors lie in the tangent planes."""
    found = line(chart, 1.0)
    assert np.abs(found.normal_curvature).max() < 1e-9
    assert np.abs(found.geodesic_curvature).min() > 1e-6


def test_a_geodesic_is_the_case_alpha_0(chart: AsymptoticChart) -> None:
    """Section 1.1: kappa_g = 0, the curvature vectors lie in the planes of tangent and normal."""
    found = line(chart, 0.0)
    assert np.abs(found.geodesic_curvature).max() < 1e-15
    assert np.abs(found.normal_curvature).min() > 1e-6


def test_figure_1b_a_plank_along_a_geodesic_lies_flat_in_the_surface(shell: Shell) -> None:
    """Its thickness is the surface normal, so it is bent by kappa_n about its weak axis and by nothing about the other.

    Not asserted: the edges of a flat plank lie 50 mm beside the geodesic and leave the surface a little.
    """
    for plank in (plank for plank in shell.planks if plank.family == "G"):
        stations = np.linspace(0.0, plank.blank.length, 60)
        _, _, width, thickness = plank_axes(plank, stations)
        frames = frames_at(plank.curve, stations)
        np.testing.assert_allclose(thickness, frames.normal, atol=1e-12)
        np.testing.assert_allclose(width, frames.binormal, atol=1e-12)
        assert np.abs(curvatures_at(plank.curve, stations).geodesic).max() < 1e-7


def test_figure_1c_a_plank_along_an_asymptotic_curve_stands_upright(shell: Shell) -> None:
    """Its width is the surface normal: bent by kappa_g about its weak axis.

    Not asserted: kappa_n = 0 on the plank itself. The beams run 56 mm off the surface, where kappa_n = h tau_g^2 up to
    6.5e-6 1/mm is left over about the strong axis: a radius of more than 150 m.
    """
    for plank in (plank for plank in shell.planks if plank.upright):
        stations = np.linspace(0.0, plank.blank.length, 60)
        _, _, width, _ = plank_axes(plank, stations)
        np.testing.assert_allclose(width, frames_at(plank.curve, stations).normal, atol=1e-12)
        assert np.abs(curvatures_at(plank.curve, stations).normal).max() < 7e-6


def test_figure_1c_both_asymptotic_curves_are_symmetric_to_the_principal_directions(chart: AsymptoticChart) -> None:
    """a1 and a2 make equal angles with the meridian p1 and with the parallel circle p2 at every point."""
    theta = 0.2 + 0.0 * S
    jet = chart.jet(S, theta)
    forms = fundamental_forms(jet)
    np.testing.assert_allclose(forms.M / forms.N, 0.0, atol=1e-9)
    p1, p2 = jet.du / np.sqrt(forms.E)[:, None], jet.dv / np.sqrt(forms.G)[:, None]
    one, zero = np.ones_like(S), np.zeros_like(S)
    a1, a2 = (darboux(jet, ParameterCurve(S, theta, one, k * one, zero, zero)).tangent for k in (1.0, -1.0))
    np.testing.assert_allclose(np.sum(a1 * p1, axis=1), np.sum(a2 * p1, axis=1), atol=1e-12)
    np.testing.assert_allclose(np.sum(a1 * p2, axis=1), -np.sum(a2 * p2, axis=1), atol=1e-12)


def test_straight_planks_can_be_bent_into_all_curves_of_the_network(network: CurveNetwork) -> None:
    """Section 1.1: with kappa_n or kappa_g zero the curve has a straight plank, on all 39 curves of a shell."""

    def strong(item: NetworkCurve) -> float:
        found = curvatures_at(item.curve, np.linspace(item.start, item.end, 200))
        return float(np.abs(found.normal if item.id.family in ("A1", "A2") else found.geodesic).max())

    assert len(network.curves) == 39
    assert max(map(strong, network.curves)) < 1e-7
