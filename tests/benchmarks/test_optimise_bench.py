"""How long the optimiser takes from a circular-arc meridian, against the number of vertices."""

import math

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture
from web_curves import a_curve_normal_curvature

from aag_cad.geometry.profiles import ArcProfile
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface
from aag_cad.web.goals import Goals
from aag_cad.web.optimise import optimise
from aag_cad.web.web import sampled_web

# Normal curvature of the A curves on the interpolated surface, 1/mm, at 441, 1 640, 6 318 and 24 794 vertices.
ALLOWED = {1: 5e-7, 2: 1e-7, 4: 5e-8, 8: 2e-8}


@pytest.mark.parametrize("density", sorted(ALLOWED))
def test_optimise_a_circular_arc(benchmark: BenchmarkFixture, density: int) -> None:
    half = math.radians(30.0)
    chart = AsymptoticChart(RevolutionSurface(ArcProfile(5100.0, 3000.0), -8823.0))
    s = np.arange(-1, 19 * density + 1) * half / 10.0 / density
    web = sampled_web(chart, s, np.linspace(-half, half, 20 * density + 1))
    goals = Goals(angle=math.radians(120.0), bottom_row=1, height=float(web.vertices[-1, 10 * density, 2]))
    found = benchmark.pedantic(optimise, (web, goals), rounds=1)
    assert found.success, found.explanation
    curvature = a_curve_normal_curvature(found.web)
    benchmark.extra_info["normal_curvature_per_mm"] = curvature
    assert curvature < ALLOWED[density]
