"""The discrete nets of the paper's section 2.1 and the curvatures of their lines, with sparse Jacobians.

An A-net has planar vertex stars (``energies.a_net``), a G-net has equal opposite angles, and an AAG-net has planar
stars along two families and geodesics along a diagonal. In a ``Web`` the A lines are both diagonals and G the columns;
in an ``AsymptoticMesh`` the A lines are the mesh polylines and G is one diagonal: every second vertex of the web.

Lines of a web: A1 runs up right (d_3, v, d_1 of a vertex star), A2 runs up left (d_4, v, d_2), G runs up a column. All
values sit at the inner vertices, (rows - 2) x (columns - 2), row by row, where the star gives a normal.
"""

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from scipy.sparse import csr_array

from aag_cad.units import Floats, Ints
from aag_cad.web.energies import a_net, geodesic
from aag_cad.web.stars import Star, coplanar, points_of, row_dot, stars, through_normal
from aag_cad.web.terms import Term, stacked, term, vertex_numbers
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
        by_side = (by_axis - row_dot(by_axis, axis)[:, None] * axis) / wide
        by_normal, by_chord = np.cross(by_side, chord), np.cross(star.normal, by_side)
    else:
        axis, by_normal, by_chord = star.normal, by_axis, np.zeros_like(chord)
    values = row_dot(axis, by_axis)
    by_a, by_c = 2.0 * np.cross(c, axis) / length, 2.0 * np.cross(axis, a) / length
    by_chord = by_chord - values[:, None] * chord / length**2
    by_a = (by_a - row_dot(by_a, a)[:, None] * a) / length_a + by_chord
    by_c = (by_c - row_dot(by_c, c)[:, None] * c) / length_c - by_chord
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
    n_along, m_along = row_dot(n, along)[:, None], row_dot(m, along)[:, None]
    sine, cosine = row_dot(along, np.cross(n, m))[:, None], row_dot(n, m)[:, None] - n_along * m_along
    torsion = np.arctan2(sine, cosine) / length
    by_sine, by_cosine = (part / (sine**2 + cosine**2) / length for part in (cosine, -sine))
    by_n = by_sine * np.cross(m, along) + by_cosine * (m - m_along * along)
    by_m = by_sine * np.cross(along, n) + by_cosine * (n - n_along * along)
    by_along = by_sine * np.cross(n, m) - by_cosine * (m_along * n + n_along * m)
    by_edge = (by_along - row_dot(by_along, along)[:, None] * along) / length - torsion * along / length
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


def star_planarity(web: Web) -> Floats:
    """Return the distance of the A neighbours from the plane of each star per mean edge, (rows - 2, columns - 2)."""
    star, x = stars(web), points_of(web)
    edges = [x[corner] - x[star.centre] for corner in star.corners]
    mean_edge = float(np.mean([np.linalg.norm(edge, axis=1).mean() for edge in edges]))
    largest = np.max([np.abs(row_dot(star.normal, edge)) for edge in edges], axis=0)
    return np.asarray(largest.reshape(web.vertices.shape[0] - 2, web.vertices.shape[1] - 2) / mean_edge)


def g_net(web: Web) -> Term:
    """Return the differences of the cosines of opposite angles in each star of rows and columns, two per vertex.

    They vanish where both rows and columns are discrete geodesics after Wunderlich (1951; paper section 2.1). One
    family of geodesics, as in an AAG web, does not satisfy them.
    """
    columns, x = web.vertices.shape[1], points_of(web)
    centre = vertex_numbers(*web.vertices.shape[:2])[1:-1, 1:-1].ravel()
    around = [centre + 1, centre + columns, centre - 1, centre - columns]
    edges = [x[vertex] - x[centre] for vertex in around]
    lengths = [np.linalg.norm(edge, axis=1)[:, None] for edge in edges]
    unit = [edge / length for edge, length in zip(edges, lengths, strict=True)]
    parts = []
    for first in (0, 1):
        one, two, three, four = (unit[(first + k) % 4] for k in range(4))
        derivatives: Derivatives = []
        for k, by_unit in enumerate((two, one, -four, -three)):
            place = (first + k) % 4
            along = unit[place]
            by_edge = (by_unit - row_dot(by_unit, along)[:, None] * along) / lengths[place]
            derivatives += [(around[place], by_edge), (centre, -by_edge)]
        parts.append(term(row_dot(one, two) - row_dot(three, four), derivatives, web.vertices.size))
    return stacked(parts)


def opposite_angles_deg(web: Web) -> Floats:
    """Return the larger difference of two opposite angles at each inner vertex, (rows - 2, columns - 2) degrees."""
    v = web.vertices
    centre = v[1:-1, 1:-1]
    edges = (v[1:-1, 2:] - centre, v[2:, 1:-1] - centre, v[1:-1, :-2] - centre, v[:-2, 1:-1] - centre)
    around = [edge / np.linalg.norm(edge, axis=-1, keepdims=True) for edge in edges]
    # The half-angle form is exact for all angles, where the arc cosine loses half of the digits near 0 and 180.
    angles = [
        2.0 * np.arctan2(np.linalg.norm(one - two, axis=-1), np.linalg.norm(one + two, axis=-1))
        for one, two in zip(around, around[1:] + around[:1], strict=True)
    ]
    difference = np.maximum(np.abs(angles[0] - angles[2]), np.abs(angles[1] - angles[3]))
    return np.asarray(np.degrees(difference))


@dataclass(frozen=True, eq=False)
class AsymptoticMesh:
    """Vertices (p, q, 3), A1 along p, A2 along q, G along the diagonal p + q; NaN where the mesh has no vertex."""

    vertices: Floats


def _diagonal_places(rows: int, columns: int, parity: int) -> tuple[Ints, Ints, Ints, Ints]:
    """Return row, column, p and q of the vertices of a grid with row + column of the parity."""
    row, column = (k.ravel() for k in np.indices((rows, columns)))
    same = (row + column) % 2 == parity
    row, column = row[same], column[same]
    return row, column, (row + column) // 2, (row - column + columns) // 2


def asymptotic_mesh(web: Web, parity: int = 0) -> AsymptoticMesh:
    """Return the rotated reading of a web: the vertices with row + column even (parity 0) or odd (parity 1).

    A rectangular web becomes a diamond in p, q; each of its A lines of that parity is one mesh polyline.
    """
    rows, columns = web.vertices.shape[:2]
    row, column, p, q = _diagonal_places(rows, columns, parity)
    vertices = np.full((int(p.max()) + 1, int(q.max()) + 1, 3), np.nan)
    vertices[p, q] = web.vertices[row, column]
    return AsymptoticMesh(vertices)


def interleaved(even: AsymptoticMesh, odd: AsymptoticMesh, rows: int, columns: int) -> Web:
    """Return the web of ``rows`` x ``columns`` vertices from its two asymptotic meshes."""
    vertices = np.empty((rows, columns, 3))
    for parity, mesh in enumerate((even, odd)):
        row, column, p, q = _diagonal_places(rows, columns, parity)
        vertices[row, column] = mesh.vertices[p, q]
    return Web(vertices)


def _mesh_stars(mesh: AsymptoticMesh, diagonal: bool) -> Star:
    """Return the stars whose four neighbours, and those on the G diagonal if asked for, are in the mesh."""
    inside = ~np.isnan(mesh.vertices[..., 0])
    complete = inside[1:-1, 1:-1] & inside[2:, 1:-1] & inside[1:-1, 2:] & inside[:-2, 1:-1] & inside[1:-1, :-2]
    if diagonal:
        complete &= inside[2:, 2:] & inside[:-2, :-2]
    width = mesh.vertices.shape[1]
    centre = vertex_numbers(*inside.shape)[1:-1, 1:-1][complete]
    corners = (centre + width, centre + 1, centre - width, centre - 1)
    x = mesh.vertices.reshape(-1, 3)
    u, w = x[corners[0]] - x[corners[2]], x[corners[1]] - x[corners[3]]
    cross = np.cross(u, w)
    area = np.linalg.norm(cross, axis=1)
    return Star(centre, corners, u, w, cross / area[:, None], area)


def mesh_a_net(mesh: AsymptoticMesh) -> Term:
    """Return n . (v_ij - v_i), Eq. (1), of two neighbours per complete star of mesh polylines.

    Stacked over both parities of a web they are the residuals of ``energies.a_net``: no star couples the parities.
    """
    star, x = _mesh_stars(mesh, diagonal=False), mesh.vertices.reshape(-1, 3)
    parts = []
    for corner in star.corners[:2]:
        edge = x[corner] - x[star.centre]
        derivatives = [(corner, star.normal), (star.centre, -star.normal), *through_normal(star, edge)]
        parts.append(term(row_dot(star.normal, edge), derivatives, mesh.vertices.size))
    return stacked(parts)


def mesh_geodesic(mesh: AsymptoticMesh) -> Term:
    """Return n . (a x c) / |a||c|, Eq. (2), along the diagonal p + q of each complete star.

    In the web these are the neighbours two rows up and down the column, so that the two parities stay apart.
    """
    star, step = _mesh_stars(mesh, diagonal=True), mesh.vertices.shape[1] + 1
    return coplanar(Web(mesh.vertices), star, star.centre + step, star.centre - step)


def aag_net(web: Web) -> Term:
    """Return the conditions of an AAG-net over a web: planar A stars (1) and geodesic columns (2)."""
    return stacked([a_net(web), geodesic(web)])


def mesh_aag_net(mesh: AsymptoticMesh) -> Term:
    """Return the conditions of an AAG-net in the rotated reading: planar mesh stars and geodesic diagonals."""
    return stacked([mesh_a_net(mesh), mesh_geodesic(mesh)])
