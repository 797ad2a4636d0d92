"""A designer's intent as energies over a web: sizes, given points, a reference, and limits of bending and twist.

Lengths are in the unit of the web: scale the targets with the vertices.
"""

import numpy as np
from scipy.sparse import csr_array, diags_array

from aag_cad.units import Floats, Ints
from aag_cad.web.goals import PointGoal
from aag_cad.web.line_curvatures import LINES, geodesic_curvature, geodesic_torsion, normal_curvature
from aag_cad.web.terms import Term, stacked, term, vertex_numbers
from aag_cad.web.web import Web

# A limit takes its full slope once it is exceeded by this part of itself.
_SOFT = 0.01


def height(web: Web, row_bottom: int, target: float) -> Term:
    """Return how much higher than ``target`` the top of the middle column stands over the bottom row, one residual.

    An even number of columns has two middle ones, which share.
    """
    rows, columns = web.vertices.shape[:2]
    number = vertex_numbers(rows, columns)
    middle = [(columns - 1) // 2, columns // 2]
    half_up = np.array([[0.0, 0.0, 0.5]])
    derivatives: list[tuple[Ints, Floats]] = []
    for column in middle:
        derivatives += [(number[[-1], column], half_up), (number[[row_bottom], column], -half_up)]
    reached = float((web.vertices[-1, middle, 2] - web.vertices[row_bottom, middle, 2]).mean())
    return term(np.array([reached - target]), derivatives, web.vertices.size)


def span(web: Web, row_bottom: int, target: float) -> Term:
    """Return how much wider than ``target`` the ends of the bottom row stand apart, one residual."""
    number = vertex_numbers(*web.vertices.shape[:2])
    apart = (web.vertices[row_bottom, -1] - web.vertices[row_bottom, 0])[None, :]
    width = float(np.linalg.norm(apart))
    derivatives = [(number[row_bottom, [-1]], apart / width), (number[row_bottom, [0]], -apart / width)]
    return term(np.array([width - target]), derivatives, web.vertices.size)


def _displacement(web: Web, chosen: Ints, reference: Floats) -> Term:
    """Return x - reference (m, 3) of the chosen vertices (m,), coordinate by coordinate."""
    unknown = (3 * chosen[:, None] + np.arange(3)).ravel()
    ones, rows = np.ones(len(unknown)), np.arange(len(unknown))
    jacobian = csr_array((ones, (rows, unknown)), shape=(len(unknown), web.vertices.size))
    return Term((web.vertices.reshape(-1, 3)[chosen] - reference).ravel(), jacobian)


def held_points(web: Web, points: tuple[PointGoal, ...]) -> Term:
    """Return the distance of each held vertex from its point, three residuals a point; none without points."""
    number = vertex_numbers(*web.vertices.shape[:2])
    chosen = np.array([number[goal.row, goal.column] for goal in points], dtype=np.int64)
    return _displacement(web, chosen, np.array([goal.point for goal in points], dtype=np.float64).reshape(-1, 3))


def closeness(web: Web, reference: Floats) -> Term:
    """Return the displacement of every vertex from ``reference`` (rows, columns, 3)."""
    return _displacement(web, vertex_numbers(*web.vertices.shape[:2]).ravel(), reference.reshape(-1, 3))


def _over(value: Term, limit: float) -> Term:
    """Return by which part a value of either sign exceeds its limit: zero within, and of continuous derivative."""
    excess = np.maximum(np.abs(value.residuals) / limit - 1.0, 0.0)
    soft = excess < _SOFT
    slope = np.where(soft, excess / _SOFT, 1.0) * np.sign(value.residuals) / limit
    residuals = np.where(soft, excess**2 / (2.0 * _SOFT), excess - _SOFT / 2.0)
    return Term(residuals, csr_array(diags_array(slope) @ value.jacobian))


def bending_radius(web: Web, smallest: float) -> Term:
    """Return smallest / R - 1 where a plank is bent tighter than the radius ``smallest``, zero elsewhere.

    A planks stand on edge and bend by the geodesic curvature, G planks lie flat and bend by the normal curvature
    (paper section 1.1). At the limit the residual starts as a parabola, so that its derivative has no jump.
    """
    bent = [geodesic_curvature(web, "A1"), geodesic_curvature(web, "A2"), normal_curvature(web, "G")]
    return _over(stacked(bent), 1.0 / smallest)


def twist(web: Web, largest: float) -> Term:
    """Return |tau_g| / largest - 1 where a plank of any family is twisted more than ``largest``, zero elsewhere.

    ``largest`` is in radians per length. At the limit the residual starts as a parabola.
    """
    return _over(stacked([geodesic_torsion(web, line) for line in LINES]), largest)
