"""The measures of a web's quality: each must see the fault that it is there for, and only that."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aag_cad.units import Floats
from aag_cad.web.quality import quality, star_normals
from aag_cad.web.web import Web, crpc_web

R0, AXIS = 5100.0, -8823.0


def vault_web(count: int = 53, rows: int = 42) -> Web:
    """Return a fine exact web of the vault's surface, from two rows below the neck to past r = 1.26 r0."""
    return crpc_web(R0, 3.0, AXIS, np.linspace(-math.pi / 6.0, math.pi / 6.0, count), 2, rows)


def flat_web() -> Web:
    """Return the flat lattice into which an optimisation collapses: 60 degrees everywhere, and no curvature."""
    x, y = np.meshgrid(np.arange(12) * 300.0, np.arange(9) * 300.0 / math.sqrt(3.0))
    return Web(np.stack([x, y, np.zeros_like(x)], axis=-1))


def mean_edge(web: Web) -> float:
    """Return the mean length of the diagonals of the grid: the edges along the A lines."""
    v = web.vertices
    both = np.concatenate([(v[1:, 1:] - v[:-1, :-1]).reshape(-1, 3), (v[1:, :-1] - v[:-1, 1:]).reshape(-1, 3)])
    return float(np.linalg.norm(both, axis=1).mean())


def rotation(angles: tuple[float, float, float]) -> Floats:
    matrix = np.eye(3)
    for axis, angle in enumerate(angles):
        turn, i, j = np.eye(3), (axis + 1) % 3, (axis + 2) % 3
        turn[i, i] = turn[j, j] = math.cos(angle)
        turn[i, j], turn[j, i] = -math.sin(angle), math.sin(angle)
        matrix = turn @ matrix
    return matrix


def test_a_collapsed_web_is_perfect_in_all_but_its_normals() -> None:
    """Flat: planar, geodesic and of constant angle, so only the turning of the normals shows the collapse."""
    found = quality(flat_web())
    assert found.planarity_per_edge == 0.0
    assert found.geodesic_deviation_deg < 1e-9
    assert found.angle_aa_deg.max - found.angle_aa_deg.min < 1e-9
    assert found.normal_turning_deg == 0.0
    assert found.extent[2] == 0.0


def test_the_normals_of_the_vault_turn_by_the_slope_of_its_meridian() -> None:
    """From the lowest to the highest star the normal turns by the change of psi, sin psi = (r0 / r)^3.

    The step of 1.15 degrees leaves an error of second order, here below a tenth of a degree in about 65.
    """
    web = vault_web()
    radius = np.hypot(web.vertices[:, 0, 0] - AXIS, web.vertices[:, 0, 1])
    psi = np.degrees(np.arcsin((R0 / radius) ** 3))
    expected = (90.0 - psi[1]) + (90.0 - psi[-2])
    assert quality(web).normal_turning_deg == pytest.approx(expected, abs=0.1)


def test_a_web_free_of_checkerboard_has_next_to_no_parity() -> None:
    assert quality(vault_web()).parity_per_edge < 1e-4
    assert quality(flat_web()).parity_per_edge == pytest.approx(0.0, abs=1e-15)


@given(amplitude=st.floats(0.1, 20.0))
def test_an_injected_checkerboard_is_measured_by_its_amplitude(amplitude: float) -> None:
    """Every second vertex is lifted by +a, the others by -a along z: parity must read a per mean edge."""
    web = flat_web()
    rows, cols, _ = web.vertices.shape
    sign = (-1.0) ** np.add.outer(np.arange(rows), np.arange(cols))
    zigzag = Web(web.vertices + amplitude * sign[..., None] * np.array([0.0, 0.0, 1.0]))
    assert quality(zigzag).parity_per_edge * mean_edge(zigzag) == pytest.approx(amplitude, rel=1e-9)


def test_a_checkerboard_leaves_the_planarity_of_the_stars_alone() -> None:
    """Both parities are lattices of their own along the A lines: planarity cannot see them slide apart."""
    web = flat_web()
    rows, cols, _ = web.vertices.shape
    sign = (-1.0) ** np.add.outer(np.arange(rows), np.arange(cols))
    slid = Web(web.vertices + 5.0 * sign[..., None] * np.array([0.0, 0.0, 1.0]))
    assert quality(slid).planarity_per_edge == pytest.approx(0.0, abs=1e-15)
    assert quality(slid).parity_per_edge > 0.01


def test_one_displaced_vertex_spoils_the_planarity_by_its_displacement() -> None:
    web = flat_web()
    moved = web.vertices.copy()
    moved[4, 5, 2] += 3.0
    # as the centre of its star it stands 3 mm off the plane of four neighbours that are still flat
    assert quality(Web(moved)).planarity_per_edge * mean_edge(web) == pytest.approx(3.0, rel=0.01)


def test_a_sideways_kink_in_a_geodesic_is_measured_in_degrees() -> None:
    """One row shifted by d along x turns every column there by 2 arctan(d / h)."""
    web, shift = flat_web(), 10.0
    moved = web.vertices.copy()
    moved[4, :, 0] += shift
    expected = 2.0 * math.degrees(math.atan(shift / (300.0 / math.sqrt(3.0))))
    assert quality(Web(moved)).geodesic_deviation_deg == pytest.approx(expected, rel=1e-9)


def test_the_smallest_radii_and_the_twist_of_the_vault() -> None:
    """r0 / n = 1700 mm for G at the neck, r0 / 0.595275 for A at r = 1.26 r0, sqrt(3) / r0 = 19.46 degrees a metre.

    Discrete curvature at a step of 1.15 degrees differs from the smooth one by less than 0.2 percent.
    """
    found = quality(vault_web())
    assert found.smallest_radius_g == pytest.approx(1700.0, rel=2e-3)
    assert found.smallest_radius_a == pytest.approx(R0 / 0.595275, rel=2e-3)
    assert found.largest_twist_deg_per_m == pytest.approx(math.degrees(math.sqrt(3.0) / R0) * 1000.0, rel=2e-3)


def test_a_flat_web_bends_nowhere() -> None:
    found = quality(flat_web())
    assert min(found.smallest_radius_a, found.smallest_radius_g) > 1e9
    assert found.largest_twist_deg_per_m == 0.0


@given(angles=st.tuples(*[st.floats(-3.0, 3.0)] * 3), shift=st.floats(-1e4, 1e4))
def test_moving_a_web_about_changes_none_of_its_inner_measures(
    angles: tuple[float, float, float], shift: float
) -> None:
    web = vault_web(14, 8)
    moved = quality(Web(web.vertices @ rotation(angles).T + shift))
    still = quality(web)
    assert moved.planarity_per_edge < 1e-12
    assert moved.geodesic_deviation_deg < 1e-8
    for name in ("normal_turning_deg", "smallest_radius_a", "smallest_radius_g", "largest_twist_deg_per_m"):
        assert getattr(moved, name) == pytest.approx(getattr(still, name), rel=1e-8)
    assert moved.angle_aa_deg.mean == pytest.approx(still.angle_aa_deg.mean, abs=1e-8)


@given(scale=st.floats(0.001, 1000.0))
def test_scaling_a_web_scales_lengths_and_nothing_else(scale: float) -> None:
    """The same form in another unit: angles and figures per edge stay, radii grow, twist shrinks."""
    web = vault_web(14, 8)
    one, other = quality(web), quality(Web(web.vertices * scale))
    assert other.parity_per_edge == pytest.approx(one.parity_per_edge, rel=1e-6)
    assert other.angle_ag_deg.max == pytest.approx(one.angle_ag_deg.max, abs=1e-9)
    assert other.extent == pytest.approx(tuple(scale * x for x in one.extent), rel=1e-12)
    assert other.smallest_radius_g == pytest.approx(scale * one.smallest_radius_g, rel=1e-9)
    assert other.largest_twist_deg_per_m == pytest.approx(one.largest_twist_deg_per_m / scale, rel=1e-9)


def test_the_extent_is_the_box_of_all_vertices() -> None:
    vertices = vault_web(14, 8).vertices.reshape(-1, 3)
    expected = tuple((vertices.max(axis=0) - vertices.min(axis=0)).tolist())
    found = quality(vault_web(14, 8))
    assert found.extent == pytest.approx(expected, rel=1e-14)
    assert found.vertices == len(vertices)


def test_star_normals_point_to_the_outside_of_the_shell() -> None:
    """At the neck towards the axis, above it towards the axis and up: as the normal of the smooth surface."""
    normals = star_normals(vault_web())
    middle = normals.shape[1] // 2
    np.testing.assert_allclose(normals[1, middle], [-1.0, 0.0, 0.0], atol=1e-9)
    assert normals[-1, middle, 0] < 0.0 < normals[-1, middle, 2]
