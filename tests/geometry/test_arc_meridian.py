"""The meridian of one radius: a start that is not CRPC."""

import math

import numpy as np
import pytest
from curvatures import fundamental_forms, gauss_curvature

from aag_cad.geometry.profiles import ArcProfile
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface
from aag_cad.web.quality import quality
from aag_cad.web.web import sampled_web

ARC = ArcProfile(5100.0, 3000.0)


def test_the_derivatives_are_those_of_a_circle() -> None:
    u, h = np.linspace(-1.2, 1.2, 9), 1e-4
    for values, ahead, behind in zip(ARC.meridian(u), ARC.meridian(u + h), ARC.meridian(u - h), strict=True):
        for order in range(3):
            slope = (ahead[order] - behind[order]) / (2 * h)
            # Central differences of a sine are off by h^2 / 6 of its size.
            np.testing.assert_allclose(values[order + 1], slope, atol=3000.0 * h**2)


def test_gauss_curvature_is_minus_cos_over_both_radii() -> None:
    u = np.linspace(-1.0, 1.0, 11)
    found = gauss_curvature(fundamental_forms(RevolutionSurface(ARC).jet(u, np.zeros_like(u))))
    np.testing.assert_allclose(found, -np.cos(u) / (3000.0 * ARC.meridian(u)[0][0]), rtol=1e-12)


def test_the_asymptotic_curves_open_from_the_neck_upwards() -> None:
    """tan^2 phi = r / (R cos u) against the meridian: 52.5 degrees at the neck, more above."""
    chart = AsymptoticChart(RevolutionSurface(ARC))
    step = math.radians(1.0)
    theta = step * np.arange(-10, 11)
    web = sampled_web(chart, step * np.arange(-1, 50), theta)
    angles = quality(web).angle_aa_deg
    neck = 2 * math.degrees(math.atan(math.sqrt(5100.0 / 3000.0)))
    assert 180.0 - neck == pytest.approx(angles.max, abs=0.1)
    assert angles.min < 55.0
