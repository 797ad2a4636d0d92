"""Section 2.2, equations (1) to (6): what the toolkit's energies share with the printed ones, and where they differ.

The printed expressions are evaluated here from the vertices alone, on a web that satisfies none of them, and compared
with the residuals of ``aag_cad.web.energies``.
"""

import math

import numpy as np
import pytest

from aag_cad.units import Floats
from aag_cad.web.energies import a_net, bottom_curve, constant_angle, fairness, geodesic, symmetry
from aag_cad.web.web import Web, crpc_web

BOTTOM = 2
ANGLE = math.radians(120.0)


@pytest.fixture(scope="module")
def exact() -> Web:
    """The vault's exact web scaled to a mean edge of 1."""
    web = crpc_web(5100.0, 3.0, -8823.0, np.linspace(-math.pi / 6.0, math.pi / 6.0, 12), BOTTOM, 8)
    return Web(web.vertices / np.linalg.norm(web.vertices[1:, 1:] - web.vertices[:-1, :-1], axis=-1).mean())


@pytest.fixture(scope="module")
def web(exact: Web) -> Web:
    """The same web with every coordinate moved by up to 0.05 edges."""
    v = exact.vertices
    return Web(v + 0.05 * np.sin(1.0 + 2.3 * np.arange(v.size) ** 1.3).reshape(v.shape))


def unit(a: Floats) -> Floats:
    return np.asarray(a / np.linalg.norm(a, axis=-1, keepdims=True))


def arms(web: Web) -> list[Floats]:
    """Return v_ij - v_i, j = 1 to 4 in turn around the star."""
    v = web.vertices
    centre = v[1:-1, 1:-1]
    return [v[2:, 2:] - centre, v[2:, :-2] - centre, v[:-2, :-2] - centre, v[:-2, 2:] - centre]


def normals(web: Web) -> Floats:
    """Return n = (d_1 - d_3) x (d_2 - d_4) / |.|, which takes the place of the paper's auxiliary unknown."""
    a = arms(web)
    return unit(np.cross(a[0] - a[2], a[1] - a[3]))


def test_equation_1_with_the_normal_eliminated(web: Web) -> None:
    """The first sum of (1) is twice the energy here, and the second, (n.n - 1)^2, is zero by construction.

    Difference: the paper keeps n_i as six more unknowns a star and lets (1) find it; here it is a function of the star,
    and opposite neighbours give the same residual, so that two rows say what four say in print.
    """
    n = normals(web)
    printed = sum(float((np.sum(n * arm, axis=-1) ** 2).sum()) for arm in arms(web))
    assert printed == pytest.approx(2.0 * a_net(web).energy, rel=1e-12)
    assert float(((np.sum(n * n, axis=-1) - 1.0) ** 2).sum()) < 1e-24


def test_equation_1_eliminated_is_no_weaker_than_with_a_free_normal(web: Web, exact: Web) -> None:
    """The best free normal is the last singular vector of a star's edges: it can only lower (1), and by little."""
    best = float((np.linalg.svd(np.stack(arms(web), axis=-2), compute_uv=False)[..., 2] ** 2).sum())
    assert a_net(web).energy < best <= 2.0 * a_net(web).energy
    assert np.linalg.svd(np.stack(arms(exact), axis=-2), compute_uv=False)[..., 2].max() < 1e-12
    assert a_net(exact).energy < 1e-24


def test_equation_2_divided_by_the_lengths_of_both_edges(web: Web) -> None:
    """Residual times |v_ia - v_i| |v_ic - v_i| is the printed one.

    Difference: undivided, (2) is of third order in the edge length and is lost beside (1) and (3) on fine webs.
    """
    v = web.vertices
    a, c = v[2:, 1:-1] - v[1:-1, 1:-1], v[:-2, 1:-1] - v[1:-1, 1:-1]
    printed = np.sum(normals(web) * np.cross(a, c), axis=-1)
    lengths = np.linalg.norm(a, axis=-1) * np.linalg.norm(c, axis=-1)
    np.testing.assert_allclose(geodesic(web).residuals * lengths.ravel(), printed.ravel(), atol=1e-13)


def cosines(web: Web, lengths: list[Floats] | None = None, norms: list[Floats] | None = None) -> Floats:
    """Return t_i1 . t_i2 of (3), with the norms of the web or with norms that are held."""
    edges = arms(web)
    held = lengths or [np.linalg.norm(edge, axis=-1, keepdims=True) for edge in edges]
    e = [edge / length for edge, length in zip(edges, held, strict=True)]
    sums = [e[0] - e[2], e[1] - e[3]]
    over = norms or [np.linalg.norm(s, axis=-1, keepdims=True) for s in sums]
    return np.asarray(np.sum((sums[0] / over[0]) * (sums[1] / over[1]), axis=-1))


def test_equation_3_is_the_printed_first_sum(web: Web) -> None:
    """Its second sum, which binds the auxiliary e_ij to the edges, falls away because e_ij are the unit edges."""
    printed = float(((cosines(web) - math.cos(ANGLE)) ** 2).sum())
    assert constant_angle(web, ANGLE).energy == pytest.approx(printed, rel=1e-12)


def test_equation_3_with_all_norms_differentiated(web: Web) -> None:
    """An angle does not change when the web grows: the derivative by the scale is zero here.

    Difference: the paper computes the norms once in each iteration. With them held, the scalar product grows as the
    square of the scale and the step that an iteration takes is wrong; it diverges from starts that are far off.
    """
    growth = constant_angle(web, ANGLE).jacobian @ web.vertices.ravel()
    assert np.abs(growth).max() < 1e-12
    lengths = [np.linalg.norm(edge, axis=-1, keepdims=True) for edge in arms(web)]
    e = [edge / length for edge, length in zip(arms(web), lengths, strict=True)]
    norms = [np.linalg.norm(s, axis=-1, keepdims=True) for s in (e[0] - e[2], e[1] - e[3])]
    step = 1e-6
    larger, smaller = (cosines(Web(web.vertices * (1.0 + h)), lengths, norms) for h in (step, -step))
    np.testing.assert_allclose((larger - smaller) / (2.0 * step), 2.0 * cosines(web), rtol=1e-6)


def test_equation_4_bottom_curve(web: Web) -> None:
    """The heights of the bottom row, and (2) along it divided by the edges; ghost rows make its stars complete.

    The weight of 10 that (7) gives to this term is the optimiser's.
    """
    v = web.vertices[BOTTOM]
    a, c = v[:-2] - v[1:-1], v[2:] - v[1:-1]
    lean = np.sum(normals(web)[BOTTOM - 1] * np.cross(a, c), axis=-1)
    lean = lean / (np.linalg.norm(a, axis=-1) * np.linalg.norm(c, axis=-1))
    found = bottom_curve(web, BOTTOM).residuals
    np.testing.assert_allclose(found, np.concatenate([v[:, 2], lean]), atol=1e-13)


def test_equation_5_as_printed_is_no_mirror_symmetry(exact: Web) -> None:
    """Printed: ((v_left - v_right)^2 x [1, 0, 0])^2 with the YZ-plane as the mirror.

    Difference: read as a product with the vector [1, 0, 0], it asks x_left = x_right, which no pair of mirror images
    off the YZ-plane satisfies; read as a cross product, its y and z parts are right but x is left free. Symmetry is
    x_left + x_right = 0, y_left = y_right, z_left = z_right. The toolkit's plane of symmetry is y = 0.
    """
    turned = exact.vertices[..., [1, 0, 2]]
    left, right = turned[:, :6], turned[:, ::-1][:, :6]
    np.testing.assert_allclose(left * np.array([-1.0, 1.0, 1.0]), right, atol=1e-12)
    product = ((left - right) ** 2 * np.array([1.0, 0.0, 0.0])) ** 2
    assert product.sum() > 1.0
    astray = left + np.array([0.7, 0.0, 0.0])
    crossed = np.cross((astray - right) ** 2, np.array([1.0, 0.0, 0.0])) ** 2
    assert crossed.sum() < 1e-24
    assert symmetry(exact).energy < 1e-24


def test_equation_5_read_as_mirror_symmetry(web: Web) -> None:
    """The energy is the squared distance of every vertex of one half from the image of its partner."""
    half = web.vertices.shape[1] // 2
    image = web.vertices[:, ::-1][:, :half] * np.array([1.0, -1.0, 1.0])
    assert symmetry(web).energy == pytest.approx(float(((web.vertices[:, :half] - image) ** 2).sum()), rel=1e-12)


def second_differences(v: Floats) -> float:
    """Return the sum of (2 v_i - v_il - v_ir)^2 over rows, columns and both families of diagonals."""
    along = (
        2.0 * v[1:-1] - v[2:] - v[:-2],
        2.0 * v[:, 1:-1] - v[:, 2:] - v[:, :-2],
        2.0 * v[1:-1, 1:-1] - v[2:, 2:] - v[:-2, :-2],
        2.0 * v[1:-1, 1:-1] - v[2:, :-2] - v[:-2, 2:],
    )
    return sum(float((part**2).sum()) for part in along)


def test_equation_6_on_the_displacement(web: Web, exact: Web) -> None:
    """The printed sum of the displacement from the reference; on positions it is had with a reference of zeros.

    Difference: (6) is printed for positions. There it is smallest for a flat lattice, which satisfies (1) to (5) too,
    so that every start collapses; on the displacement it is zero at the start and keeps only the change smooth.
    """
    moved = web.vertices - exact.vertices
    assert fairness(web, exact.vertices).energy == pytest.approx(second_differences(moved), rel=1e-12)
    assert fairness(web, np.zeros_like(moved)).energy == pytest.approx(second_differences(web.vertices), rel=1e-12)
    assert fairness(exact, exact.vertices).energy == 0.0
    assert second_differences(exact.vertices) > 0.1
