"""Sections 2.1 and 2.2, Fig. 4 and equations (1) to (5): the exact discrete web is a zero of every energy at once.

Vertices are scaled to a mean edge of 1, so that the sums compare with the figures that AAG webs are published with.
Not asserted: (6) and (7), a regulariser and a sum with weights that lead an optimisation and have no zero of interest.
"""

import math

import numpy as np
import pytest

from aag_cad.units import Floats
from aag_cad.web.quality import star_normals
from aag_cad.web.web import Web, crpc_web

ROWS_BELOW = 2
# Coordinates of some 20 edge lengths carry rounding errors of 1e-14 each; (1) to (5) sum squares over some 250 stars.
ZERO = 1e-24


def unit(a: Floats) -> Floats:
    return np.asarray(a / np.linalg.norm(a, axis=-1, keepdims=True))


@pytest.fixture(scope="module")
def vertices() -> Floats:
    """The vault's exact web over its 14 geodesics and their midlines, two rows below the neck; mean edge 1."""
    web = crpc_web(5100.0, 3.0, -8823.0, np.linspace(-math.pi / 6.0, math.pi / 6.0, 27), ROWS_BELOW, 34).vertices
    return np.asarray(web / np.linalg.norm(web[1:, 1:] - web[:-1, :-1], axis=-1).mean())


def arms(v: Floats) -> list[Floats]:
    """Return v_ij - v_i of the four neighbours along the A lines, j = 1 and 3 opposite, 2 and 4 opposite."""
    centre = v[1:-1, 1:-1]
    return [v[2:, 2:] - centre, v[2:, :-2] - centre, v[:-2, :-2] - centre, v[:-2, 2:] - centre]


def normals(v: Floats) -> Floats:
    a = arms(v)
    return unit(np.cross(a[0] - a[2], a[1] - a[3]))


def test_figure_4_left_five_vertices_of_a_star_are_coplanar(vertices: Floats) -> None:
    """Planar vertex star: the 5 x 3 matrix of a star about its centroid has rank two.

    Not asserted: Fig. 4 middle, the star of a net with two families of geodesics; an AAG web has only one.
    """
    star = np.stack([vertices[1:-1, 1:-1] * 0.0, *arms(vertices)], axis=-2)
    centred = star - star.mean(axis=-2, keepdims=True)
    assert np.linalg.svd(centred, compute_uv=False)[..., 2].max() < 1e-12


def test_figure_4_right_the_diagonal_plane_passes_through_the_normal(vertices: Floats) -> None:
    """The osculating plane of three vertices along G contains the normal of the planar star."""
    up, down = vertices[2:, 1:-1] - vertices[1:-1, 1:-1], vertices[:-2, 1:-1] - vertices[1:-1, 1:-1]
    plane = unit(np.cross(up, down))
    assert np.abs(np.sum(plane * normals(vertices), axis=-1)).max() < 1e-11


def test_equation_1_asymptotic_net(vertices: Floats) -> None:
    """E_Anet = sum (n_i . (v_ij - v_i))^2 + sum (n_i . n_i - 1)^2."""
    n = normals(vertices)
    energy = sum(float((np.sum(n * arm, axis=-1) ** 2).sum()) for arm in arms(vertices))
    energy += float(((np.sum(n * n, axis=-1) - 1.0) ** 2).sum())
    assert energy < ZERO


def test_equation_2_geodesics(vertices: Floats) -> None:
    """E_geo = sum (n_i . [(v_ia - v_i) x (v_ic - v_i)])^2 along the columns."""
    up, down = vertices[2:, 1:-1] - vertices[1:-1, 1:-1], vertices[:-2, 1:-1] - vertices[1:-1, 1:-1]
    assert float((np.sum(normals(vertices) * np.cross(up, down), axis=-1) ** 2).sum()) < ZERO


def test_equation_3_constant_angle(vertices: Floats) -> None:
    """E_angle with theta_0 = 120 degrees between the A lines as they leave the vertex upwards.

    Its second sum vanishes by definition once e_ij are the unit edge vectors, as they are here.
    """
    e = [unit(arm) for arm in arms(vertices)]
    cos = np.sum(unit(e[0] - e[2]) * unit(e[1] - e[3]), axis=-1)
    assert float(((cos - math.cos(math.radians(120.0))) ** 2).sum()) < ZERO


def test_equation_4_bottom_curve(vertices: Floats) -> None:
    """The bottom polyline is planar, z = 0, and geodesic; rows below it make its stars complete, as in Fig. 5c."""
    bottom = vertices[ROWS_BELOW]
    assert float((bottom[:, 2] ** 2).sum()) < ZERO
    left, right = bottom[:-2] - bottom[1:-1], bottom[2:] - bottom[1:-1]
    lean = np.sum(normals(vertices)[ROWS_BELOW - 1] * np.cross(left, right), axis=-1)
    assert float((lean**2).sum()) < ZERO


def test_equation_5_mirror_symmetry(vertices: Floats) -> None:
    """The web mirrors itself in its plane of symmetry, here y = 0.

    Not asserted as printed: (5) squares twice and multiplies vectors; it is read as left = mirrored right.
    """
    mirrored = vertices[:, ::-1] * np.array([1.0, -1.0, 1.0])
    assert float(((vertices - mirrored) ** 2).sum()) < ZERO


def test_the_normals_of_the_stars_are_those_of_the_quality_report(vertices: Floats) -> None:
    found = star_normals(Web(vertices))
    assert np.abs(np.abs(np.sum(found * normals(vertices), axis=-1)) - 1.0).max() < 1e-12
