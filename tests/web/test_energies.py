"""The energies (1) to (6) over a web: true derivatives, zero where the field says so, and not zero elsewhere."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from differences import central_differences, perturbed

from aag_cad.web.energies import a_net, bottom_curve, constant_angle, fairness, geodesic, symmetry
from aag_cad.web.terms import Term, stacked
from aag_cad.web.web import Web, crpc_web

BOTTOM = 2
ANGLE = math.radians(120.0)
Energy = Callable[[Web], Term]


def scaled(web: Web) -> Web:
    """Return a web scaled to a mean edge of 1 along A1."""
    return Web(web.vertices / np.linalg.norm(web.vertices[1:, 1:] - web.vertices[:-1, :-1], axis=-1).mean())


def exact_web(ratio: float = 3.0) -> Web:
    return scaled(crpc_web(5100.0, ratio, -8823.0, np.linspace(-math.pi / 6.0, math.pi / 6.0, 11), BOTTOM, 7))


def fair(web: Web) -> Term:
    return fairness(web, exact_web().vertices)


def isogonal(web: Web) -> Term:
    return constant_angle(web, ANGLE)


def bottom(web: Web) -> Term:
    return bottom_curve(web, BOTTOM)


ENERGIES: tuple[Energy, ...] = (a_net, geodesic, isogonal, bottom, symmetry, fair)
energies = pytest.mark.parametrize("energy", ENERGIES, ids=lambda energy: energy.__name__)


@energies
def test_jacobians_are_the_true_derivatives(energy: Energy) -> None:
    """All norms and normals are differentiated: nothing is held for an iteration."""
    web = perturbed(exact_web())
    numeric = central_differences(energy, web)
    exact = energy(web).jacobian.toarray()
    assert np.abs(exact - numeric).max() < 1e-6 * np.abs(numeric).max()


@energies
def test_the_exact_web_of_a_crpc_surface_is_a_zero_of_every_energy(energy: Energy) -> None:
    """Coordinates of 20 edges carry rounding errors of 4e-15; differences of second order leave less than 1e-12."""
    assert np.abs(energy(exact_web()).residuals).max() < 1e-12


@energies
def test_a_perturbed_web_is_a_zero_of_none(energy: Energy) -> None:
    assert np.abs(energy(perturbed(exact_web())).residuals).max() > 0.01


@energies
def test_one_residual_row_for_each_condition(energy: Energy) -> None:
    """Jacobians span all coordinates of the web, one row per residual."""
    web = exact_web()
    found = energy(web)
    assert found.jacobian.shape == (len(found.residuals), web.vertices.size)


@pytest.mark.parametrize("energy", [a_net, geodesic, isogonal, symmetry])
def test_energies_do_not_see_a_web_lifted_along_z(energy: Energy) -> None:
    """Translation along z is a null direction of all energies but the bottom curve's, which holds z = 0."""
    web = perturbed(exact_web())
    lift = np.tile([0.0, 0.0, 1.0], web.vertices.size // 3)
    assert np.abs(energy(web).jacobian @ lift).max() < 1e-12
    assert np.abs(bottom(web).jacobian @ lift).max() == 1.0


@pytest.mark.parametrize("energy", [geodesic, isogonal])
def test_angular_energies_do_not_see_scale(energy: Energy) -> None:
    """Divided by the lengths of the edges, Eq. (2) and (3) keep their value when the web grows."""
    web = perturbed(exact_web())
    np.testing.assert_allclose(energy(Web(web.vertices * 7.0)).residuals, energy(web).residuals, atol=1e-12)


def test_undivided_geodesic_residuals_vanish_with_the_third_power_of_the_edge() -> None:
    """A fixed lateral bend: n . (a x c) falls by 8 when the mesh is halved, n . (a x c) / |a||c| by 2 only."""

    def bent(count: int) -> Web:
        u = np.linspace(-0.5, 0.5, count)
        y, x = np.meshgrid(u, u, indexing="ij")
        return Web(np.stack([x + 0.1 * y**2, y, x * y], axis=-1))

    coarse, fine = bent(9), bent(17)
    middle_coarse = geodesic(coarse).residuals.reshape(7, 7)[3, 3]
    middle_fine = geodesic(fine).residuals.reshape(15, 15)[7, 7]
    assert middle_coarse / middle_fine == pytest.approx(2.0, rel=0.05)
    edge = np.linalg.norm(coarse.vertices[5, 4] - coarse.vertices[4, 4])
    finer = np.linalg.norm(fine.vertices[9, 8] - fine.vertices[8, 8])
    assert middle_coarse * edge**2 / (middle_fine * finer**2) == pytest.approx(8.0, rel=0.05)


def test_two_rows_per_star_say_as_much_as_four() -> None:
    """The eliminated normal is at right angles to both diagonals, so opposite neighbours stand off equally."""
    web = perturbed(exact_web())
    v = web.vertices
    centre = v[1:-1, 1:-1]
    arms = [v[2:, 2:] - centre, v[2:, :-2] - centre, v[:-2, :-2] - centre, v[:-2, 2:] - centre]
    cross = np.cross(arms[0] - arms[2], arms[1] - arms[3])
    normal = cross / np.linalg.norm(cross, axis=-1, keepdims=True)
    four = sum(float((np.sum(normal * arm, axis=-1) ** 2).sum()) for arm in arms)
    assert four == pytest.approx(2.0 * a_net(web).energy, rel=1e-12)


@pytest.mark.parametrize("ratio", [1.0 / 3.0, 1.0, 2.0])
def test_the_constant_angle_follows_the_ratio_of_curvatures(ratio: float) -> None:
    """A lines of a CRPC surface cross at 2 arctan sqrt(ratio); another angle leaves the difference of the cosines."""
    angle = 2.0 * math.atan(math.sqrt(ratio))
    web = exact_web(ratio)
    assert np.abs(constant_angle(web, angle).residuals).max() < 1e-12
    np.testing.assert_allclose(constant_angle(web, ANGLE).residuals, math.cos(angle) - math.cos(ANGLE), atol=1e-12)


def test_the_bottom_row_is_the_neck_and_no_other() -> None:
    """Above the neck the parallel circles are planar but no geodesics, and they lie above z = 0."""
    web = exact_web()
    count = web.vertices.shape[1]
    lifted = Web(web.vertices - np.array([0.0, 0.0, web.vertices[4, 0, 2]]))
    found = bottom_curve(lifted, 4).residuals
    assert np.abs(found[:count]).max() < 1e-12
    assert np.abs(found[count:]).min() > 0.01


def test_a_web_moved_along_y_is_no_longer_its_own_image() -> None:
    """The coordinates x and z still agree; y_left + y_right is twice the shift in every pair."""
    web = exact_web()
    moved = symmetry(Web(web.vertices + np.array([0.0, 0.25, 0.0]))).residuals.reshape(3, -1)
    np.testing.assert_allclose(moved[0], 0.0, atol=1e-12)
    np.testing.assert_allclose(moved[1], 0.5, atol=1e-12)
    np.testing.assert_allclose(moved[2], 0.0, atol=1e-12)


def test_a_mirrored_web_has_the_same_energies() -> None:
    web = perturbed(exact_web())
    image = Web(web.vertices[:, ::-1] * np.array([1.0, -1.0, 1.0]))
    for energy in (a_net, geodesic, isogonal, bottom, symmetry):
        assert energy(image).energy == pytest.approx(energy(web).energy, rel=1e-10)


def test_fairness_is_zero_at_the_reference_and_for_even_displacements() -> None:
    """A displacement that grows evenly along rows and columns bends nothing."""
    web = perturbed(exact_web())
    assert not fairness(web, web.vertices).residuals.any()
    rows, columns, _ = web.vertices.shape
    row, column = np.indices((rows, columns)).astype(float)
    even = np.stack([0.3 + 0.1 * row, 0.2 * column, 0.1 * row - 0.3 * column], axis=-1)
    assert np.abs(fairness(Web(web.vertices + even), web.vertices).residuals).max() < 1e-12


def test_fairness_on_positions_prefers_the_flat_lattice_to_the_design() -> None:
    """Why the displacement is taken: read on positions, Eq. (6) is zero for the collapsed web and not for the vault."""
    web = exact_web()
    rows, columns, _ = web.vertices.shape
    x, y = np.meshgrid(np.arange(columns) * math.sqrt(0.75), np.arange(rows) * 0.5)
    flat = Web(np.stack([x, y, np.zeros_like(x)], axis=-1))
    nowhere = np.zeros_like(web.vertices)
    assert fairness(flat, nowhere).energy < 1e-24
    assert stacked([a_net(flat), geodesic(flat), isogonal(flat)]).energy < 1e-24
    assert fairness(web, nowhere).energy > 0.1


def test_stacked_terms_add_their_energies() -> None:
    web = perturbed(exact_web())
    parts = [energy(web) for energy in ENERGIES]
    both = stacked(parts)
    assert both.energy == pytest.approx(sum(part.energy for part in parts), rel=1e-12)
    assert both.jacobian.shape[0] == sum(part.jacobian.shape[0] for part in parts)
