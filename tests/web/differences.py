"""Webs moved a little, and Jacobians by central differences, for the tests of this folder."""

from collections.abc import Callable

import numpy as np

from aag_cad.units import Floats
from aag_cad.web.terms import Term
from aag_cad.web.web import Web


def perturbed(web: Web, amplitude: float = 0.05) -> Web:
    """Return a web with every coordinate moved by an amount between + and - amplitude that repeats in no direction."""
    shift = np.sin(1.0 + 2.3 * np.arange(web.vertices.size) ** 1.3).reshape(web.vertices.shape)
    return Web(web.vertices + amplitude * shift)


def central_differences(energy: Callable[[Web], Term], web: Web, step: float = 1e-5) -> Floats:
    """Return the Jacobian (m, 3 n) by central differences; at 1e-5 edges their error is about 1e-10."""
    columns = []
    for unknown in range(web.vertices.size):
        move = np.zeros(web.vertices.size)
        move[unknown] = step
        shift = move.reshape(web.vertices.shape)
        ahead, behind = energy(Web(web.vertices + shift)), energy(Web(web.vertices - shift))
        columns.append((ahead.residuals - behind.residuals) / (2.0 * step))
    return np.stack(columns, axis=1)
