"""Forming stresses against the formulas for a bent and a twisted strip."""

import math

import numpy as np
import pytest

from aag_cad.geometry.framed import FramedCurve, framed_curve
from aag_cad.mechanics.checks.lamella import lamella_stress, unrolled_bow
from aag_cad.parts.forms import Blank, CrossSection
from aag_cad.parts.model import Gridshell, Plank, Timber
from aag_cad.units import Floats, deg_per_m

# A quintic spline with a sample every 150 mm keeps the curvature of a 1.7 m arc to about 2e-6.
TIMBER = Timber("ash", "D50", 700.0, 14000.0, 880.0, 50.0, 4.5, 1700.0, math.radians(60.0) / 1000.0)


def _plank(upright: bool, curve: FramedCurve) -> Plank:
    family = "A1" if upright else "G"
    section = CrossSection(100.0, 12.0)
    return Plank("S1-G-01", family, 0, upright, "", curve, Blank(curve.length, section, ()), ())


def _arc(radius: float, angle: float, normal_is_radial: bool) -> FramedCurve:
    def evaluate(t: Floats) -> tuple[Floats, Floats]:
        outward = np.column_stack([np.cos(t), np.sin(t), np.zeros_like(t)])
        up = np.tile([0.0, 0.0, 1.0], (len(t), 1))
        return radius * outward, outward if normal_is_radial else up

    return framed_curve(evaluate, 0.0, angle, radius * angle)


def test_a_flat_plank_at_the_papers_smallest_radius_reaches_the_bending_strength_of_d50() -> None:
    """Section 3 of the paper: r_min = 1.7 m for 12 mm planks is E t / 2 r = 49.4 N/mm2, just under f_m = 50."""
    stress = lamella_stress(_plank(False, _arc(1700.0, 1.0, True)), TIMBER)
    assert stress.bending == pytest.approx(14000.0 * 12.0 / (2 * 1700.0), rel=1e-5)
    assert stress.smallest_radius == pytest.approx(1700.0, rel=1e-5)
    assert stress.edgewise < 1e-3
    assert stress.bow < 1e-3


def test_an_upright_plank_bends_about_its_weak_axis_along_the_geodesic_curvature() -> None:
    stress = lamella_stress(_plank(True, _arc(9000.0, 0.5, False)), TIMBER)
    assert stress.bending == pytest.approx(14000.0 * 12.0 / (2 * 9000.0), rel=1e-5)
    assert stress.edgewise < 1e-3


def test_an_upright_plank_on_a_curve_of_normal_curvature_is_strained_edgewise_and_bows() -> None:
    radius, angle = 100_000.0, 0.07
    stress = lamella_stress(_plank(True, _arc(radius, angle, True)), TIMBER)
    assert stress.edgewise == pytest.approx(14000.0 * 50.0 / radius, rel=1e-4)
    assert stress.bow == pytest.approx(radius * (1 - math.cos(angle / 2)), rel=1e-3)


def test_sixty_degrees_per_metre_give_the_torsion_and_helix_stress_of_a_thin_strip() -> None:
    """At the paper's limit beta_max = 60 deg/m: tau = G t theta' = 11.1, sigma = E theta'^2 b^2 / 12 = 12.8 N/mm2."""
    twist = math.radians(60.0) / 1000.0

    def evaluate(t: Floats) -> tuple[Floats, Floats]:
        zero = np.zeros_like(t)
        return np.column_stack([t, zero, zero]), np.column_stack([zero, np.cos(twist * t), np.sin(twist * t)])

    stress = lamella_stress(_plank(True, framed_curve(evaluate, 0.0, 1000.0, 1000.0)), TIMBER)
    assert deg_per_m(stress.largest_twist) == pytest.approx(60.0, rel=1e-5)
    assert stress.torsion == pytest.approx(11.06, abs=0.01)
    assert stress.helix == pytest.approx(12.79, abs=0.01)
    assert stress.combined == pytest.approx(stress.helix, rel=1e-5)


def test_the_bow_of_a_straight_line_is_zero_and_of_a_circle_its_sagitta() -> None:
    stations = np.linspace(0.0, 5000.0, 2001)
    assert unrolled_bow(np.zeros_like(stations), stations) == 0.0
    sagitta = 50_000.0 * (1 - math.cos(5000.0 / 2 / 50_000.0))
    assert unrolled_bow(np.full_like(stations, 1 / 50_000.0), stations) == pytest.approx(sagitta, rel=1e-5)


def test_the_offset_layers_of_the_vault_cost_the_edgewise_stress_of_h_tau_squared(gridshell: Gridshell) -> None:
    """Beams 56 mm off the surface have kappa_edge = h tau^2: 4.5 N/mm2 where tau = sqrt(3)/r0."""
    largest = max(lamella_stress(p, gridshell.timber).edgewise for p in gridshell.shells[0].planks if p.upright)
    assert largest == pytest.approx(14000.0 * 50.0 * 56.0 * 3.0 / 5100.0**2, rel=0.05)
