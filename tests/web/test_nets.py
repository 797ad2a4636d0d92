"""Section 2.1: A-nets, G-nets and AAG-nets in both readings, and the curvatures of their lines."""

import math
from collections.abc import Callable
from functools import partial

import numpy as np
import pytest
from darboux import ParameterCurve, darboux
from other_nets import (
    AsymptoticMesh,
    aag_net,
    asymptotic_mesh,
    g_net,
    interleaved,
    mesh_a_net,
    mesh_aag_net,
    mesh_geodesic,
    opposite_angles_deg,
    star_planarity,
)

from aag_cad.geometry.profiles import CrpcProfile
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface
from aag_cad.units import Floats
from aag_cad.web.energies import a_net
from aag_cad.web.line_curvatures import (
    LINES,
    Line,
    geodesic_curvature,
    geodesic_torsion,
    largest_bending,
    largest_twist,
    normal_curvature,
)
from aag_cad.web.quality import quality
from aag_cad.web.terms import Term
from aag_cad.web.web import Web, crpc_web, sampled_web

R0, AXIS = 5100.0, -8823.0
both_parities = pytest.mark.parametrize("parity", [0, 1])
lines = pytest.mark.parametrize("line", LINES)


def exact_web(columns: int = 10, rows_above: int = 6) -> Web:
    """Return the vault's exact web scaled to a mean edge of 1."""
    web = crpc_web(R0, 3.0, AXIS, np.linspace(-math.pi / 6.0, math.pi / 6.0, columns), 2, rows_above)
    return Web(web.vertices / np.linalg.norm(web.vertices[1:, 1:] - web.vertices[:-1, :-1], axis=-1).mean())


def perturbed(vertices: Floats, amplitude: float = 0.05) -> Floats:
    shift = np.sin(1.0 + 2.3 * np.arange(vertices.size) ** 1.3).reshape(vertices.shape)
    return np.asarray(vertices + amplitude * shift)


def helices(radius: float = 4.0) -> Web:
    """Return a cylinder's net of two families of helices; all geodesics of a cylinder are helices or their limits."""
    row, column = np.indices((7, 8)).astype(float)
    turn, rise = 0.15 * (row + column), 0.6 * (row - column)
    return Web(np.stack([radius * np.cos(turn), radius * np.sin(turn), rise], axis=-1))


def central_differences(residuals: Callable[[Floats], Floats], vertices: Floats, step: float = 1e-5) -> Floats:
    columns = []
    for unknown in range(vertices.size):
        move = np.zeros(vertices.size)
        move[unknown] = step
        shift = move.reshape(vertices.shape)
        columns.append((residuals(vertices + shift) - residuals(vertices - shift)) / (2.0 * step))
    return np.stack(columns, axis=1)


NETS: dict[str, Callable[[Web], Term]] = {
    "A-net": a_net,
    "G-net": g_net,
    "AAG-net": aag_net,
    **{f"kappa_g {line}": partial(geodesic_curvature, line=line) for line in LINES},
    **{f"kappa_n {line}": partial(normal_curvature, line=line) for line in LINES},
    **{f"tau_g {line}": partial(geodesic_torsion, line=line) for line in LINES},
}


@pytest.mark.parametrize("name", NETS)
def test_jacobians_are_the_true_derivatives(name: str) -> None:
    vertices = perturbed(exact_web(8, 4).vertices)
    numeric = central_differences(lambda v: NETS[name](Web(v)).residuals, vertices)
    exact = NETS[name](Web(vertices)).jacobian.toarray()
    assert np.abs(exact - numeric).max() < 1e-6 * np.abs(numeric).max()


@both_parities
def test_jacobians_of_the_rotated_reading_are_the_true_derivatives(parity: int) -> None:
    """Places without a vertex are NaN, have no residual and no derivative."""
    mesh = asymptotic_mesh(Web(perturbed(exact_web(8, 5).vertices)), parity)
    numeric = central_differences(lambda v: mesh_aag_net(AsymptoticMesh(v)).residuals, mesh.vertices)
    exact = mesh_aag_net(mesh).jacobian.toarray()
    assert np.all(np.isfinite(exact))
    assert np.abs(exact - numeric).max() < 1e-6 * np.abs(numeric).max()


def test_the_exact_web_is_an_aag_net_in_both_readings() -> None:
    web = exact_web()
    assert np.abs(aag_net(web).residuals).max() < 1e-12
    for parity in (0, 1):
        mesh = asymptotic_mesh(web, parity)
        assert np.abs(mesh_aag_net(mesh).residuals).max() < 1e-12
        moved = AsymptoticMesh(perturbed(mesh.vertices))
        assert np.abs(mesh_a_net(moved).residuals).max() > 0.01
        assert np.abs(mesh_geodesic(moved).residuals).max() > 0.01


@pytest.mark.parametrize("shape", [(8, 10), (9, 10), (8, 9), (9, 9)])
def test_both_rotated_meshes_make_up_the_web_again(shape: tuple[int, int]) -> None:
    vertices = np.arange(shape[0] * shape[1] * 3.0).reshape(*shape, 3)
    even, odd = (asymptotic_mesh(Web(vertices), parity) for parity in (0, 1))
    held = [int(np.isfinite(mesh.vertices[..., 0]).sum()) for mesh in (even, odd)]
    assert sum(held) == shape[0] * shape[1]
    np.testing.assert_array_equal(interleaved(even, odd, *shape).vertices, vertices)


def test_steps_of_the_rotated_mesh_are_the_a_lines_and_its_diagonal_is_g() -> None:
    """One step along p is up right, one along q up left, one along both is two rows up the same column."""
    row, column = np.indices((8, 9)).astype(float)
    mesh = asymptotic_mesh(Web(np.stack([column, row, 0.0 * row], axis=-1))).vertices

    def steps(moved: Floats) -> list[list[float]]:
        found: list[list[float]] = np.unique(moved[np.isfinite(moved[..., 0])], axis=0).tolist()
        return found

    assert steps(mesh[1:] - mesh[:-1]) == [[1.0, 1.0, 0.0]]
    assert steps(mesh[:, 1:] - mesh[:, :-1]) == [[-1.0, 1.0, 0.0]]
    assert steps(mesh[1:, 1:] - mesh[:-1, :-1]) == [[0.0, 2.0, 0.0]]


def test_the_rotated_meshes_have_the_same_planar_stars() -> None:
    """No star of the A-net couples the two parities: that is the checkerboard freedom of the web."""
    web = Web(perturbed(exact_web().vertices))
    both = np.concatenate([mesh_a_net(asymptotic_mesh(web, parity)).residuals for parity in (0, 1)])
    np.testing.assert_allclose(np.sort(both), np.sort(a_net(web).residuals), rtol=0.0, atol=1e-14)


def test_only_the_columns_of_the_web_hold_the_two_parities_together() -> None:
    """Lifting every second vertex leaves the rotated reading at zero, and not the geodesics of the web."""
    row, column = np.indices((8, 9)).astype(float)
    flat = np.stack([column * math.sqrt(3.0), row, 0.0 * row], axis=-1)
    slid = Web(flat + np.array([0.1, 0.0, 0.0]) * ((row + column) % 2)[..., None])
    for parity in (0, 1):
        assert np.abs(mesh_aag_net(asymptotic_mesh(slid, parity)).residuals).max() < 1e-12
    assert np.abs(aag_net(slid).residuals).max() > 0.1


def test_helices_of_a_cylinder_are_a_g_net() -> None:
    """A half-turn about the normal of any vertex maps the net onto itself, so opposite angles are equal."""
    web = helices()
    assert np.abs(g_net(web).residuals).max() < 1e-12
    # A difference of two angles, each good to 1e-15 radians.
    assert opposite_angles_deg(web).max() < 1e-12


def test_both_families_of_a_g_net_are_straightest_polylines() -> None:
    """Equal opposite angles give equal sums of angles on both sides of each polyline: its geodesics are straightest."""
    v = helices().vertices
    centre = v[1:-1, 1:-1]
    around = [v[1:-1, 2:] - centre, v[2:, 1:-1] - centre, v[1:-1, :-2] - centre, v[:-2, 1:-1] - centre]
    unit = [edge / np.linalg.norm(edge, axis=-1, keepdims=True) for edge in around]
    angles = [np.arccos(np.sum(unit[k] * unit[(k + 1) % 4], axis=-1)) for k in range(4)]
    np.testing.assert_allclose(angles[0] + angles[1], angles[2] + angles[3], atol=1e-12)
    np.testing.assert_allclose(angles[1] + angles[2], angles[3] + angles[0], atol=1e-12)
    # The star is not flat: the four angles do not add up to a full turn, so that this says more than in a plane.
    assert abs(sum(angles)[3, 3] - 2.0 * math.pi) > 1e-5


def test_one_family_of_geodesics_is_no_g_net() -> None:
    """Section 2.1: the angle condition cannot make meshes with one family of geodesics; at the neck circle it holds."""
    found = opposite_angles_deg(exact_web())
    assert found[1].max() < 1e-9
    assert found[2:].min() > 0.1


def test_a_single_kink_is_measured_by_its_angle() -> None:
    """In a square lattice a row shifted sideways by d makes opposite angles differ by 2 arctan d."""
    row, column = np.indices((5, 5)).astype(float)
    flat = np.stack([column, row, 0.0 * row], axis=-1)
    flat[2, :, 0] += 0.2
    expected = 2.0 * math.degrees(math.atan(0.2))
    assert opposite_angles_deg(Web(flat))[1, 1] == pytest.approx(expected, rel=1e-12)


def test_asymptotic_lines_have_no_normal_curvature_and_geodesics_no_geodesic_curvature() -> None:
    web = exact_web()
    for line in LINES[:2]:
        assert np.abs(normal_curvature(web, line).residuals).max() < 1e-12
    assert np.abs(geodesic_curvature(web, "G").residuals).max() < 1e-12
    assert np.abs(geodesic_torsion(web, "G").residuals).max() < 1e-12


@lines
def test_discrete_curvatures_converge_to_those_of_the_smooth_surface(line: Line) -> None:
    """kappa_n, kappa_g and tau_g, signs included, against the Darboux frame; the error falls with the step squared."""
    chart = AsymptoticChart(RevolutionSurface(CrpcProfile(R0, 3.0), AXIS))
    slope = {"A1": 1.0, "A2": -1.0, "G": 0.0}[line]
    at, one, none = np.array([0.4]), np.ones(1), np.zeros(1)
    turn = np.array([0.0])
    smooth = darboux(chart.jet(at, turn), ParameterCurve(at, turn, one, slope * one, none, none))
    errors = []
    for step in (0.04, 0.02):
        grid = step * np.arange(-3.0, 4.0)
        web = sampled_web(chart, 0.4 + grid, grid)
        discrete = [
            geodesic_curvature(web, line).residuals.reshape(5, 5)[2, 2],
            normal_curvature(web, line).residuals.reshape(5, 5)[2, 2],
            # The edges before and after the middle vertex; their mean is the torsion there.
            geodesic_torsion(web, line).residuals.mean(),
        ]
        exact = [smooth.geodesic_curvature[0], smooth.normal_curvature[0], smooth.geodesic_torsion[0]]
        errors.append(np.abs(np.subtract(discrete, exact)).max() * R0)
    assert errors[0] < 0.01
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)


def test_fields_agree_with_the_quality_report() -> None:
    web = exact_web()
    found = quality(web)
    assert 1.0 / largest_bending(web).max() == pytest.approx(
        min(found.smallest_radius_a, found.smallest_radius_g), rel=1e-12
    )
    assert math.degrees(largest_twist(web).max()) * 1000.0 == pytest.approx(found.largest_twist_deg_per_m, rel=1e-9)
    moved = Web(perturbed(web.vertices))
    assert star_planarity(moved).max() == pytest.approx(quality(moved).planarity_per_edge, rel=1e-12)
