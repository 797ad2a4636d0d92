"""The curvatures and twists of the lines of a web, with sparse Jacobians.

Lines of a web: A1 runs up right (d_3, v, d_1 of a vertex star), A2 runs up left (d_4, v, d_2), G runs up a column. All
values sit at the inner vertices, (rows - 2) x (columns - 2), row by row, where the star gives a normal.
"""

from typing import Literal, TypeAlias

import numpy as np
from scipy.sparse import csr_array

from aag_cad.geometry.surface import dot
from aag_cad.units import Floats, Ints
from aag_cad.web.stars import Star, points_of, stars, through_normal
from aag_cad.web.terms import Term, term, vertex_numbers
from aag_cad.web.web import Web

Line: TypeAlias = Literal["A1", "A2", "G"]
LINES: tuple[Line, ...] = ("A1", "A2", "G")
Derivatives: TypeAlias = list[tuple[Ints, Floats]]


def _neighbours(web: Web, star: Star, line: Line) -> tuple[Ints, Ints]:
    """Return the numbers of the vertices ahead and behind on a line through the centre of each star."""
    if line == "G":
        columns = web.vertices.shape[1]
        return star.centre + columns, star.centre - columns
    ahead = LINES.index(line)
    return star.corners[ahead], star.corners[ahead + 2]


def _turning(web: Web, star: Star, line: Line, normal_part: bool) -> Term:
    """Return 2 m . (a x c) / |a||c||a - c|, the curvature 1 / R of the circle through three vertices, about m.

    m is the star's normal for the geodesic part, the side direction t x n (unit, t along a - c) for the normal part.
    """
    ahead, behind = _neighbours(web, star, line)
    x = points_of(web)
    a, c = x[ahead] - x[star.centre], x[behind] - x[star.centre]
    chord = a - c
    length_a, length_c, length = (np.linalg.norm(edge, axis=1)[:, None] for edge in (a, c, chord))
    a, c = a / length_a, c / length_c
    by_axis = 2.0 * np.cross(a, c) / length
    if normal_part:
        side = np.cross(chord, star.normal)
        wide = np.linalg.norm(side, axis=1)[:, None]
        axis = side / wide
        by_side = (by_axis - dot(by_axis, axis)[:, None] * axis) / wide
        by_normal, by_chord = np.cross(by_side, chord), np.cross(star.normal, by_side)
    else:
        axis, by_normal, by_chord = star.normal, by_axis, np.zeros_like(chord)
    values = dot(axis, by_axis)
    by_a, by_c = 2.0 * np.cross(c, axis) / length, 2.0 * np.cross(axis, a) / length
    by_chord = by_chord - values[:, None] * chord / length**2
    by_a = (by_a - dot(by_a, a)[:, None] * a) / length_a + by_chord
    by_c = (by_c - dot(by_c, c)[:, None] * c) / length_c - by_chord
    derivatives: Derivatives = [(ahead, by_a), (behind, by_c), (star.centre, -by_a - by_c)]
    found = term(values, [*derivatives, *through_normal(star, by_normal)], web.vertices.size)
    # The energies' normal is opposite to that of the surface and of the quality report, which give the sign here.
    return Term(-found.residuals, csr_array(-found.jacobian))


def geodesic_curvature(web: Web, line: Line) -> Term:
    """Return kappa_g of the lines at the inner vertices, 1 / length: what a plank on edge, as on A, is bent to.

    It is the curvature of the circle through three vertices, seen along the normal; positive towards n x t, with n as
    in ``quality.star_normals`` and t upwards.
    """
    return _turning(web, stars(web), line, normal_part=False)


def normal_curvature(web: Web, line: Line) -> Term:
    """Return kappa_n of the lines at the inner vertices, 1 / length: what a flat plank, as on G, is bent to.

    It is the curvature of the circle through three vertices, seen from the side; positive towards the normal of
    ``quality.star_normals``.
    """
    return _turning(web, stars(web), line, normal_part=True)


def _chosen(star: Star, rows: Ints) -> Star:
    first, second, third, fourth = (corner[rows] for corner in star.corners)
    return Star(
        star.centre[rows], (first, second, third, fourth),
        star.u[rows], star.w[rows], star.normal[rows], star.area[rows],
    )  # fmt: skip


def _steps(web: Web, line: Line) -> tuple[Ints, Ints]:
    """Return the positions, among the stars, of both ends of each edge of a line between inner vertices."""
    place = vertex_numbers(web.vertices.shape[0] - 2, web.vertices.shape[1] - 2)
    if line == "A1":
        return place[:-1, :-1].ravel(), place[1:, 1:].ravel()
    if line == "A2":
        return place[:-1, 1:].ravel(), place[1:, :-1].ravel()
    return place[:-1].ravel(), place[1:].ravel()


def geodesic_torsion(web: Web, line: Line) -> Term:
    """Return tau_g on the edges between inner vertices, radians / length: the twist of a plank that follows the line.

    It is the angle from one star's normal to the next, seen along the edge, over the edge's length. Rows are one less
    than those of the inner vertices; on A lines, columns too.
    """
    star, x = stars(web), points_of(web)
    below, above = (_chosen(star, ends) for ends in _steps(web, line))
    edge = x[above.centre] - x[below.centre]
    length = np.linalg.norm(edge, axis=1)[:, None]
    along, n, m = edge / length, below.normal, above.normal
    n_along, m_along = dot(n, along)[:, None], dot(m, along)[:, None]
    sine, cosine = dot(along, np.cross(n, m))[:, None], dot(n, m)[:, None] - n_along * m_along
    torsion = np.arctan2(sine, cosine) / length
    by_sine, by_cosine = (part / (sine**2 + cosine**2) / length for part in (cosine, -sine))
    by_n = by_sine * np.cross(m, along) + by_cosine * (m - m_along * along)
    by_m = by_sine * np.cross(along, n) + by_cosine * (n - n_along * along)
    by_along = by_sine * np.cross(n, m) - by_cosine * (m_along * n + n_along * m)
    by_edge = (by_along - dot(by_along, along)[:, None] * along) / length - torsion * along / length
    derivatives: Derivatives = [(above.centre, by_edge), (below.centre, -by_edge)]
    derivatives += [*through_normal(below, by_n), *through_normal(above, by_m)]
    return term(torsion[:, 0], derivatives, web.vertices.size)


def largest_twist(web: Web) -> Floats:
    """Return the largest |tau_g| of the edges of A and G lines at each inner vertex, radians / length."""
    shape = (web.vertices.shape[0] - 2, web.vertices.shape[1] - 2)
    largest = np.zeros(shape[0] * shape[1])
    for line in LINES:
        torsion = np.abs(geodesic_torsion(web, line).residuals)
        for ends in _steps(web, line):
            np.maximum.at(largest, ends, torsion)
    return largest.reshape(shape)


def largest_bending(web: Web) -> Floats:
    """Return the largest weak-axis curvature 1 / R of a plank at each inner vertex: kappa_g of A, kappa_n of G."""
    bent = [geodesic_curvature(web, "A1"), geodesic_curvature(web, "A2"), normal_curvature(web, "G")]
    largest = np.max([np.abs(item.residuals) for item in bent], axis=0)
    return np.asarray(largest.reshape(web.vertices.shape[0] - 2, web.vertices.shape[1] - 2))
