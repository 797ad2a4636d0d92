"""Residuals with their sparse Jacobians over the vertices of a web."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, vstack

from aag_cad.units import Floats, Ints


@dataclass(frozen=True, eq=False)
class Term:
    """Residuals (m,) and their Jacobian (m, 3 n) by the coordinates x, y, z of vertex 0, then 1, ... of a web."""

    residuals: Floats
    jacobian: csr_array

    @property
    def energy(self) -> float:
        """The sum of squares."""
        return float(self.residuals @ self.residuals)


def vertex_numbers(rows: int, columns: int) -> Ints:
    """Return the number (rows, columns) of each vertex of a grid, row by row."""
    return np.arange(rows * columns, dtype=np.int64).reshape(rows, columns)


def term(residuals: Floats, derivatives: Sequence[tuple[Ints, Floats]], unknowns: int) -> Term:
    """Return a term from residuals (m,) and their derivatives: pairs of vertex numbers (m,) and gradients (m, 3)."""
    count = len(residuals)
    rows = np.tile(np.repeat(np.arange(count), 3), len(derivatives))
    columns = np.concatenate([(3 * vertex[:, None] + np.arange(3)).ravel() for vertex, _ in derivatives])
    values = np.concatenate([gradient.ravel() for _, gradient in derivatives])
    return Term(residuals, csr_array((values, (rows, columns)), shape=(count, unknowns)))


def stacked(terms: Sequence[Term]) -> Term:
    """Return several terms as one."""
    return Term(
        np.concatenate([item.residuals for item in terms]),
        csr_array(vstack([item.jacobian for item in terms], format="csr")),
    )
