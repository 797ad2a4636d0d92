"""Vertex stars of a web and how residuals through their normals change."""

from dataclasses import dataclass

import numpy as np

from aag_cad.geometry.surface import dot
from aag_cad.units import Floats, Ints
from aag_cad.web.terms import Term, term, vertex_numbers
from aag_cad.web.web import Web


@dataclass(frozen=True, eq=False)
class Star:
    """Stars of all inner vertices: numbers (m,), the A diagonals u and w, the normal and the length of u x w."""

    centre: Ints
    corners: tuple[Ints, Ints, Ints, Ints]
    u: Floats
    w: Floats
    normal: Floats
    area: Floats


def points_of(web: Web) -> Floats:
    """Return the vertices of a web as (n, 3)."""
    return web.vertices.reshape(-1, 3)


def stars(web: Web) -> Star:
    """Return the stars of all inner vertices of a web, row by row."""
    number = vertex_numbers(*web.vertices.shape[:2])
    corners = (
        number[2:, 2:].ravel(), number[2:, :-2].ravel(), number[:-2, :-2].ravel(), number[:-2, 2:].ravel(),
    )  # fmt: skip
    x = points_of(web)
    u, w = x[corners[0]] - x[corners[2]], x[corners[1]] - x[corners[3]]
    cross = np.cross(u, w)
    area = np.linalg.norm(cross, axis=1)
    return Star(number[1:-1, 1:-1].ravel(), corners, u, w, cross / area[:, None], area)


def through_normal(star: Star, towards: Floats) -> list[tuple[Ints, Floats]]:
    """Return the derivatives of n . towards by the corners, with ``towards`` (m, 3) held."""
    g = (towards - dot(towards, star.normal)[:, None] * star.normal) / star.area[:, None]
    by_u, by_w = np.cross(star.w, g), np.cross(g, star.u)
    first, second, third, fourth = star.corners
    return [(first, by_u), (third, -by_u), (second, by_w), (fourth, -by_w)]


def coplanar(web: Web, star: Star, ahead: Ints, behind: Ints) -> Term:
    """Return n . (a x c) / |a||c| with a, c the edges to two neighbours: zero where a, c and n lie in one plane."""
    x = points_of(web)
    a, c = x[ahead] - x[star.centre], x[behind] - x[star.centre]
    length_a, length_c = np.linalg.norm(a, axis=1)[:, None], np.linalg.norm(c, axis=1)[:, None]
    a, c = a / length_a, c / length_c
    cross = np.cross(a, c)
    by_a, by_c = np.cross(c, star.normal), np.cross(star.normal, a)
    by_a = (by_a - dot(by_a, a)[:, None] * a) / length_a
    by_c = (by_c - dot(by_c, c)[:, None] * c) / length_c
    derivatives = [
        (ahead, by_a), (behind, by_c), (star.centre, -by_a - by_c), *through_normal(star, cross),
    ]  # fmt: skip
    return term(dot(star.normal, cross), derivatives, web.vertices.size)
