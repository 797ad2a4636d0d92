"""The exact discrete AAG web of a CRPC surface, and what sampling the smooth surface gives instead."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aag_cad.geometry.profiles import CrpcProfile
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface
from aag_cad.units import Floats
from aag_cad.web.quality import quality, star_normals
from aag_cad.web.web import Web, crpc_rings, crpc_web, sampled_web

R0, AXIS = 5100.0, -8823.0
RATIOS = (1.0 / 3.0, 1.0, 2.0, 3.0)
ratios = pytest.mark.parametrize("n", RATIOS)


def columns(count: int = 14, sector_deg: float = 60.0) -> Floats:
    half = math.radians(sector_deg) / 2.0
    return np.linspace(-half, half, count)


def exact_web(n: float = 3.0, count: int = 14, rows: int = 8) -> Web:
    return crpc_web(R0, n, AXIS, columns(count), 3, rows)


def smooth_web(n: float, step: float) -> Web:
    """Return the web of the smooth surface over a fixed patch, sampled with a given step."""
    chart = AsymptoticChart(RevolutionSurface(CrpcProfile(R0, n), AXIS))
    s: Floats = step * np.arange(-round(0.16 / step), round(0.64 / step) + 1, dtype=np.float64)
    theta: Floats = step * np.arange(-round(0.48 / step), round(0.48 / step) + 1, dtype=np.float64)
    return sampled_web(chart, s, theta)


def acute(angle_deg: float) -> float:
    return min(angle_deg, 180.0 - angle_deg)


@ratios
def test_every_star_of_the_exact_web_is_planar(n: float) -> None:
    """The vertex and its four neighbours along the A lines lie in one plane (paper section 2.1, Fig. 4 left)."""
    assert quality(exact_web(n)).planarity_per_edge < 1e-13


@ratios
def test_every_column_of_the_exact_web_is_a_discrete_geodesic(n: float) -> None:
    """Seen in the tangent plane of its star, a G line runs straight on (paper section 2.1, Fig. 4 right)."""
    assert quality(exact_web(n)).geodesic_deviation_deg < 1e-9


@ratios
def test_all_node_angles_of_the_exact_web_are_equal(n: float) -> None:
    """The A lines cross at 2 arctan sqrt(n) and G bisects that angle: no node differs from any other."""
    found = quality(exact_web(n))
    half = math.degrees(math.atan(math.sqrt(n)))
    assert found.angle_aa_deg.min == pytest.approx(acute(2.0 * half), abs=1e-9)
    assert found.angle_aa_deg.max == pytest.approx(acute(2.0 * half), abs=1e-9)
    assert found.angle_ag_deg.min == pytest.approx(half, abs=1e-9)
    assert found.angle_ag_deg.max == pytest.approx(half, abs=1e-9)


def test_the_ratio_three_gives_the_sixty_degree_web_of_the_vault() -> None:
    found = quality(exact_web(3.0))
    for span in (found.angle_aa_deg, found.angle_ag_deg):
        assert (span.min, span.mean, span.max) == pytest.approx((60.0, 60.0, 60.0), abs=1e-9)


def test_the_bottom_row_of_the_exact_web_is_planar_and_geodesic() -> None:
    """Row 3 is the neck: z = 0, and the osculating plane of the row holds the star's normal (paper equation 4)."""
    web = exact_web()
    neck = web.vertices[3]
    np.testing.assert_allclose(neck[:, 2], 0.0, atol=1e-12)
    turn = np.cross(neck[:-2] - neck[1:-1], neck[2:] - neck[1:-1])
    lean = np.einsum("ij,ij->i", star_normals(web)[2], turn) / np.linalg.norm(turn, axis=1)
    np.testing.assert_allclose(lean, 0.0, atol=1e-12)


def test_the_web_below_the_neck_mirrors_the_web_above() -> None:
    vertices = exact_web().vertices
    np.testing.assert_allclose(vertices[:3], vertices[6:3:-1] * [1.0, 1.0, -1.0], rtol=1e-14)


def test_the_web_is_symmetric_about_the_shells_plane() -> None:
    vertices = exact_web().vertices
    np.testing.assert_allclose(vertices, vertices[:, ::-1] * [1.0, -1.0, 1.0], rtol=0.0, atol=1e-9)


@given(n=st.floats(0.3, 4.0), step=st.floats(0.01, 0.12))
def test_rings_keep_their_stars_planar_for_any_ratio_and_step(n: float, step: float) -> None:
    """(r_{m+1} c, z_{m+1}), (r_m, z_m) and (r_{m-1} c, z_{m-1}) lie on one line, with c = cos(step)."""
    rings, cos = crpc_rings(R0, n, step, 6), math.cos(step)
    ahead = rings[2:] * [cos, 1.0] - rings[1:-1]
    behind = rings[1:-1] - rings[:-2] * [cos, 1.0]
    cross = ahead[:, 0] * behind[:, 1] - ahead[:, 1] * behind[:, 0]
    np.testing.assert_allclose(cross / (np.linalg.norm(ahead, axis=1) * np.linalg.norm(behind, axis=1)), 0.0, atol=1e-9)


@ratios
def test_the_rings_of_the_exact_web_converge_to_the_smooth_meridian(n: float) -> None:
    """The discrete meridian nears the smooth one at a rate of step^2 when the step is halved."""
    errors = []
    for step in (0.04, 0.02):
        radius, height = crpc_rings(R0, n, step, round(0.48 / step))[-1]
        y = math.acosh((radius / R0) ** n)
        errors.append(abs(float(CrpcProfile(R0, n).meridian(np.array([y]))[1][0, 0]) - height))
    assert errors[0] < 5.0
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.15)


@ratios
def test_the_sampled_web_is_planar_to_third_order_only(n: float) -> None:
    """Halving the step divides planarity / edge by 8; the exact web has none at any step."""
    coarse, fine = (quality(smooth_web(n, step)).planarity_per_edge for step in (0.04, 0.02))
    assert coarse > 1e-7
    assert math.log2(coarse / fine) == pytest.approx(3.0, abs=0.1)


@ratios
def test_the_angles_of_the_sampled_web_are_constant_to_second_order_only(n: float) -> None:
    """Halving the step divides the largest error of an angle by 4."""
    half = math.degrees(math.atan(math.sqrt(n)))
    errors = []
    for step in (0.04, 0.02):
        span = quality(smooth_web(n, step)).angle_aa_deg
        errors.append(max(abs(span.min - acute(2.0 * half)), abs(span.max - acute(2.0 * half))))
    assert errors[0] > 1e-4
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)


@ratios
def test_the_columns_of_the_sampled_web_are_geodesics_exactly(n: float) -> None:
    """Meridians are planar and their plane holds the normal, whatever the step."""
    assert quality(smooth_web(n, 0.04)).geodesic_deviation_deg < 1e-9


def test_both_diagonals_of_the_grid_are_the_asymptotic_lines() -> None:
    """On the sampled web, vertices (i + k, j +- k) lie on theta -+ s = const: one curve of the smooth surface."""
    web = smooth_web(3.0, 0.04)
    x, y, z = web.vertices[..., 0] - AXIS, web.vertices[..., 1], web.vertices[..., 2]
    theta = np.arctan2(y, x)
    s = np.arccosh(np.maximum((np.hypot(x, y) / R0) ** 3, 1.0)) / math.sqrt(3.0) * np.sign(z)
    for sign in (1, -1):
        flipped = (theta - sign * s)[:, ::sign]
        np.testing.assert_allclose(flipped[1:, 1:], flipped[:-1, :-1], atol=1e-7)
