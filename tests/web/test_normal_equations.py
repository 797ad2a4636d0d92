"""The step of Gauss-Newton: least squares by the normal equations, whoever factorises them."""

from importlib.util import find_spec

import numpy as np
import pytest
from scipy.sparse import csr_array

from aag_cad.errors import DesignError
from aag_cad.web.normal_equations import best_factorisation, gauss_newton_step


def test_the_step_is_the_least_squares_solution() -> None:
    rng = np.random.default_rng(3)
    matrix, right = rng.normal(size=(40, 12)), rng.normal(size=40)
    step = gauss_newton_step(csr_array(matrix), right, 0.0, "scipy")
    np.testing.assert_allclose(step, np.linalg.lstsq(matrix, -right, rcond=None)[0], atol=1e-12)


def test_the_best_factorisation_is_one_that_is_installed() -> None:
    """CHOLMOD where scikit-sparse is, else SciPy; asked for without being there, it is refused with the remedy."""
    matrix, right = csr_array(np.eye(5)), np.arange(5.0)
    np.testing.assert_allclose(gauss_newton_step(matrix, right, 0.0, best_factorisation()), -right)
    if find_spec("sksparse") is None:
        assert best_factorisation() == "scipy"
        with pytest.raises(DesignError, match="scikit-sparse"):
            gauss_newton_step(matrix, right, 0.0, "cholmod")
    else:
        assert best_factorisation() == "cholmod"
