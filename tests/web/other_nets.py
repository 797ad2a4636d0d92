"""Other readings of a web, to test with: a G-net's angles, and the two asymptotic meshes that it is made of.

An A-net has planar vertex stars (``energies.a_net``), a G-net has equal opposite angles, and an AAG-net has planar
stars along two families and geodesics along a diagonal (paper, section 2.1). In a ``Web`` the A lines are both
diagonals and G the columns; in an ``AsymptoticMesh`` the A lines are the mesh polylines and G is one diagonal: every
second vertex of the web.
"""

from dataclasses import dataclass

import numpy as np

from aag_cad.geometry.surface import dot
from aag_cad.units import Floats, Ints
from aag_cad.web.energies import a_net, geodesic
from aag_cad.web.line_curvatures import Derivatives
from aag_cad.web.stars import Star, coplanar, points_of, stars, through_normal
from aag_cad.web.terms import Term, stacked, term, vertex_numbers
from aag_cad.web.web import Web


def star_planarity(web: Web) -> Floats:
    """Return the distance of the A neighbours from the plane of each star per mean edge, (rows - 2, columns - 2)."""
    star, x = stars(web), points_of(web)
    edges = [x[corner] - x[star.centre] for corner in star.corners]
    mean_edge = float(np.mean([np.linalg.norm(edge, axis=1).mean() for edge in edges]))
    largest = np.max([np.abs(dot(star.normal, edge)) for edge in edges], axis=0)
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
            by_edge = (by_unit - dot(by_unit, along)[:, None] * along) / lengths[place]
            derivatives += [(around[place], by_edge), (centre, -by_edge)]
        parts.append(term(dot(one, two) - dot(three, four), derivatives, web.vertices.size))
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
        parts.append(term(dot(star.normal, edge), derivatives, mesh.vertices.size))
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
