"""From unknowns to vertices: B-spline control nets and mirror symmetry as linear maps."""

import numpy as np
from scipy.interpolate import BSpline
from scipy.sparse import csr_array, eye_array, kron

from aag_cad.units import Floats
from aag_cad.web.terms import vertex_numbers

_DEGREE = 5


def mirrored(rows: int, columns: int, symmetric: bool) -> csr_array:
    """Return the map (3 n, unknowns) from the coordinates of the free points of a grid to those of all its points.

    Symmetric grids keep the columns up to the middle one free: column j and the last column less j are images in the
    plane y = 0, and the middle column lies in it. Symmetry is exact and halves the unknowns.
    """
    number = vertex_numbers(rows, columns)
    if not symmetric:
        return csr_array(eye_array(number.size * 3))
    half = (columns + 1) // 2
    left, right = number[:, :half].ravel(), number[:, ::-1][:, :half].ravel()
    free = np.ones((len(left), 3), dtype=bool)
    free[left == right, 1] = False
    column = np.cumsum(free.ravel()).reshape(free.shape) - 1
    pair, axis = np.nonzero(free)
    unknown = column[pair, axis]
    image = left[pair] != right[pair]
    sign = np.where(axis == 1, -1.0, 1.0)
    rows_of = np.concatenate([3 * left[pair] + axis, (3 * right[pair] + axis)[image]])
    columns_of = np.concatenate([unknown, unknown[image]])
    values = np.concatenate([np.ones(len(pair)), sign[image]])
    return csr_array((values, (rows_of, columns_of)), shape=(3 * number.size, int(free.sum())))


def _clamped_basis(places: Floats, low: float, high: float, controls: int) -> csr_array:
    inner = np.linspace(low, high, controls - _DEGREE + 1)
    knots = np.concatenate([[low] * _DEGREE, inner, [high] * _DEGREE])
    return csr_array(BSpline.design_matrix(places, knots, _DEGREE))


def control_map(
    rows: Floats, columns: Floats, bounds: tuple[tuple[float, float], tuple[float, float]], controls: tuple[int, int]
) -> csr_array:
    """Return the map (3 n, 3 m) from the control points of a quintic tensor-product B-spline to its points.

    The points lie at the grid of parameters ``rows`` x ``columns`` inside ``bounds`` of the two directions.
    """
    along = _clamped_basis(rows, *bounds[0], controls[0])
    across = _clamped_basis(columns, *bounds[1], controls[1])
    return csr_array(kron(kron(along, across), eye_array(3)))
