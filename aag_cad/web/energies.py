"""The paper's energies (1) to (6) over a web, one function each: residuals and a sparse Jacobian with true derivatives.

In the star of v_i, d_1 to d_4 are the diagonal neighbours (up right, up left, down left, down right). The A lines run
d_1, v_i, d_3 and d_2, v_i, d_4. v_a and v_c are the neighbours on the G line (up, down). The normal is eliminated,
n = (d_1 - d_3) x (d_2 - d_4) / |.|, where the paper keeps it as an auxiliary unknown; residuals are free of scale where
the web has a mean edge of 1.
"""

import math

import numpy as np
from scipy.sparse import csr_array

from aag_cad.geometry.surface import dot
from aag_cad.units import Floats, Ints
from aag_cad.web.stars import coplanar, points_of, stars, through_normal
from aag_cad.web.terms import Term, stacked, term, vertex_numbers
from aag_cad.web.web import Web


def a_net(web: Web) -> Term:
    """Return n_i . (v_ij - v_i) for two neighbours per star, Eq. (1): planar vertex stars make an A-net.

    With the normal at right angles to both A diagonals, opposite neighbours have equal residuals, so two say all.
    """
    star, x, unknowns = stars(web), points_of(web), web.vertices.size
    parts = []
    for corner in star.corners[:2]:
        edge = x[corner] - x[star.centre]
        derivatives = [(corner, star.normal), (star.centre, -star.normal), *through_normal(star, edge)]
        parts.append(term(dot(star.normal, edge), derivatives, unknowns))
    return stacked(parts)


def geodesic(web: Web) -> Term:
    """Return n_i . [(v_ia - v_i) x (v_ic - v_i)] / |.||.|, Eq. (2): the columns of the grid are geodesics.

    Without the division the residual is of third order in the edge length and vanishes beside the others.
    """
    number = vertex_numbers(*web.vertices.shape[:2])
    return coplanar(web, stars(web), number[2:, 1:-1].ravel(), number[:-2, 1:-1].ravel())


def constant_angle(web: Web, angle: float) -> Term:
    """Return t_i1 . t_i2 - cos(theta_0), Eq. (3): the A lines of the diagonals meet at the angle theta_0, radians.

    t_i1 = (e_i1 - e_i3) / |.|, t_i2 = (e_i2 - e_i4) / |.| with unit edges e_ij; all norms are differentiated.
    """
    star, x = stars(web), points_of(web)
    edges = [x[corner] - x[star.centre] for corner in star.corners]
    lengths = [np.linalg.norm(edge, axis=1)[:, None] for edge in edges]
    units = [edge / length for edge, length in zip(edges, lengths, strict=True)]
    sums = (units[0] - units[2], units[1] - units[3])
    norms = [np.linalg.norm(s, axis=1)[:, None] for s in sums]
    t1, t2 = (s / norm for s, norm in zip(sums, norms, strict=True))
    cosine = dot(t1, t2)
    by_sum = ((t2 - cosine[:, None] * t1) / norms[0], (t1 - cosine[:, None] * t2) / norms[1])
    derivatives: list[tuple[Ints, Floats]] = []
    total = np.zeros_like(t1)
    for k, corner in enumerate(star.corners):
        by_unit = by_sum[k % 2] * (1.0 if k < 2 else -1.0)
        by_edge = (by_unit - dot(by_unit, units[k])[:, None] * units[k]) / lengths[k]
        derivatives.append((corner, by_edge))
        total = total + by_edge
    derivatives.append((star.centre, -total))
    return term(cosine - math.cos(angle), derivatives, web.vertices.size)


def bottom_curve(web: Web, row: int) -> Term:
    """Return v_b . [0, 0, 1] and n_b . [(v_bl - v_b) x (v_br - v_b)] / |.||.|, Eq. (4): a planar, geodesic bottom.

    ``row`` is the row of the bottom curve; at least one ghost row lies under it, so that its stars are complete.
    """
    rows, columns = web.vertices.shape[:2]
    number = vertex_numbers(rows, columns)
    on_row = number[row]
    up = np.tile([0.0, 0.0, 1.0], (columns, 1))
    flat = term(points_of(web)[on_row, 2], [(on_row, up)], web.vertices.size)
    turning = coplanar(web, stars(web), number[1:-1, :-2].ravel(), number[1:-1, 2:].ravel())
    chosen = slice((row - 1) * (columns - 2), row * (columns - 2))
    return stacked([flat, Term(turning.residuals[chosen], csr_array(turning.jacobian[chosen]))])


def symmetry(web: Web) -> Term:
    """Return the difference of each vertex and its mirror image in the plane y = 0, Eq. (5) read as mirror symmetry.

    Column j is the image of the last column less j. The solver removes the images instead; this is the measure.
    """
    rows, columns = web.vertices.shape[:2]
    number = vertex_numbers(rows, columns)
    half = (columns + 1) // 2
    left, right = number[:, :half].ravel(), number[:, ::-1][:, :half].ravel()
    x = points_of(web)
    parts = []
    for axis, sign in ((0, -1.0), (1, 1.0), (2, -1.0)):
        along = np.zeros((len(left), 3))
        along[:, axis] = 1.0
        residuals = x[left, axis] + sign * x[right, axis]
        parts.append(term(residuals, [(left, along), (right, sign * along)], web.vertices.size))
    return stacked(parts)


def fairness(web: Web, reference: Floats) -> Term:
    """Return 2 v_i - v_il - v_ir, Eq. (6), of the displacement from ``reference`` (rows, columns, 3), along all lines.

    On positions instead of displacements it pulls every web into a flat lattice, which satisfies all other energies.
    """
    rows, columns = web.vertices.shape[:2]
    number = vertex_numbers(rows, columns)
    triples = [
        (number[1:-1], number[2:], number[:-2]),
        (number[:, 1:-1], number[:, 2:], number[:, :-2]),
        (number[1:-1, 1:-1], number[2:, 2:], number[:-2, :-2]),
        (number[1:-1, 1:-1], number[2:, :-2], number[:-2, 2:]),
    ]
    middle, one, other = (np.concatenate([t[k].ravel() for t in triples]) for k in range(3))
    moved = points_of(web) - reference.reshape(-1, 3)
    bend = 2.0 * moved[middle] - moved[one] - moved[other]
    parts = []
    for axis in range(3):
        along = np.zeros((len(middle), 3))
        along[:, axis] = 1.0
        parts.append(term(bend[:, axis], [(middle, 2.0 * along), (one, -along), (other, -along)], web.vertices.size))
    return stacked(parts)
