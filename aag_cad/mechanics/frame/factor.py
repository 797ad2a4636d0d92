"""Sparse factors that are checked: a mechanism is an error, where SuperLU alone gives huge numbers without a word."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csc_array
from scipy.sparse.linalg import LinearOperator, SuperLU, eigsh, splu

from aag_cad.units import Floats

# A pivot is what is left of a diagonal entry when all before it are eliminated: 1e-16 of it is rounding. A cantilever
# of 1000 equal elements still leaves 1e-10 at its tip.
PIVOT_LIMIT = 1e-12
RESIDUAL_LIMIT = 1e-6
_DENSE = 60
_PERTURBED = 1e-9
_NO_SHIFT = 1e-10
_STANDS_STILL = 1e-8
_MOST_ROUNDS = 60


class SingularError(ArithmeticError):
    """A stiffness that does not hold: ``mode`` (u,) is how its unknowns move without force."""

    def __init__(self, mode: Floats) -> None:
        """Keep the mode."""
        super().__init__("singular stiffness")
        self.mode = mode


@dataclass(frozen=True, eq=False)
class Factor:
    """A symmetric positive matrix (u, u) with its factor."""

    matrix: csc_array
    lu: SuperLU

    def solve(self, right: Floats) -> Floats:
        """Return the solution of right sides (u,) or (u, k), refined once; SingularError if a residual stays."""
        found = self.lu.solve(right)
        found = found + self.lu.solve(right - self.matrix @ found)
        size = float(np.abs(right).max(initial=0.0))
        if size > 0.0 and not float(np.abs(self.matrix @ found - right).max()) <= RESIDUAL_LIMIT * size:
            raise SingularError(free_mode(self.matrix))
        return np.asarray(found)


def _symmetric_lu(matrix: csc_array) -> SuperLU:
    return splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


def start_vector(size: int) -> Floats:
    """Return a vector (size,) that is orthogonal to no mode but by accident, always the same."""
    return np.cos(np.arange(size, dtype=np.float64) ** 1.5 + 0.5)


def free_mode(matrix: csc_array) -> Floats:
    """Return how the unknowns (u,) of a singular matrix move without force, by inverse iteration on it made regular."""
    diagonal = matrix.diagonal()
    scale = np.where(diagonal > 0.0, diagonal, diagonal.max(initial=0.0) or 1.0)
    size = len(diagonal)
    held = csc_array((_PERTURBED * scale, (np.arange(size), np.arange(size))), shape=(size, size))
    lu = _symmetric_lu(csc_array(matrix + held))
    mode = start_vector(size)
    for _ in range(4):
        mode = lu.solve(scale * mode)
        mode /= np.abs(mode).max()
    return np.asarray(mode)


def factor(matrix: csc_array) -> Factor:
    """Return the factor of a symmetric positive matrix (u, u); SingularError with its mode if it is loose."""
    diagonal = matrix.diagonal()
    if not diagonal.min(initial=1.0) > 0.0:
        raise SingularError(free_mode(matrix))
    try:
        lu = _symmetric_lu(matrix)
    except RuntimeError as error:
        raise SingularError(free_mode(matrix)) from error
    pivots = lu.U.diagonal()[lu.perm_c]
    if not (np.array_equal(lu.perm_r, lu.perm_c) and bool(np.all(pivots > PIVOT_LIMIT * diagonal))):
        raise SingularError(free_mode(matrix))
    return Factor(matrix, lu)


def _dense_modes(stiffness: csc_array, mass: csc_array, count: int, shift: float) -> tuple[Floats, Floats]:
    flexibility, modes = eigh(mass.toarray(), (stiffness + shift * mass).toarray())
    order = np.argsort(-flexibility, kind="stable")[:count]
    order = order[flexibility[order] > 1e-14 * flexibility.max()]
    return 1.0 / flexibility[order] - shift, modes[:, order]


def lowest_pairs(stiffness: csc_array, mass: csc_array, count: int) -> tuple[Floats, Floats]:
    """Return the lowest eigenvalues (k,) of K v = lambda M v and their vectors (u, k), v.T M v = 1; k <= count.

    Mechanisms come out as eigenvalues of about 0, within 1e-10 of the mean of K over M. SingularError if something that
    moves without force has no mass either.
    """
    weights = mass.diagonal()
    heavy = weights > 0.0
    shift = _NO_SHIFT * float(stiffness.diagonal()[heavy].sum() / weights[heavy].sum())
    size = len(weights)
    if size <= max(_DENSE, 2 * count + 2):
        factor(csc_array(stiffness + shift * mass))
        values, modes = _dense_modes(stiffness, mass, count, shift)
    else:
        lu = factor(csc_array(stiffness + shift * mass)).lu
        inverse = LinearOperator((size, size), matvec=lu.solve, dtype=np.float64)
        values, modes = eigsh(stiffness, k=count, M=mass, sigma=-shift, OPinv=inverse, v0=start_vector(size))
    order = np.argsort(values, kind="stable")
    values, modes = values[order], modes[:, order]
    return values, modes / np.sqrt(np.sum(modes * (mass @ modes), axis=0))


def softest_pair(stiffness: csc_array, mass: csc_array, guess: Floats) -> tuple[float, Floats]:
    """Return the lowest eigenvalue of K v = lambda M v for a K that holds, and its softest modes (u, k) roughly.

    Subspace iteration (Bathe and Wilson 1972) from modes (u, k) of a like frame and one vector more, so that a mode
    which the guess lacks is found as well; until the eigenvalue stands still to 1e-8. SingularError for a mechanism.
    """
    lu = factor(stiffness).lu
    block = mass @ np.column_stack([guess, start_vector(len(guess))])
    last = np.inf
    for _ in range(_MOST_ROUNDS):
        moved = lu.solve(block)
        loaded = mass @ moved
        values, turn = eigh(moved.T @ block, moved.T @ loaded)
        block, lowest = loaded @ turn, float(values[0])
        if abs(last - lowest) < _STANDS_STILL * lowest:
            return lowest, np.asarray(moved @ turn)[:, : guess.shape[1]]
        last = lowest
    values, modes = lowest_pairs(stiffness, mass, guess.shape[1])
    return float(values[0]), modes
