"""The coupled beams of a gridshell to test with, and what their drilled differences ask for."""

from collections.abc import Iterator

import numpy as np

from aag_cad.mechanics.siblings import CoupledPair, coupled_pair
from aag_cad.parts.index import index_of
from aag_cad.parts.model import Gridshell
from aag_cad.units import Floats


def coupled_pairs(gridshell: Gridshell) -> Iterator[CoupledPair]:
    """Yield the couplings of every beam of every shell."""
    for shell in gridshell.shells:
        planks = index_of(shell).planks
        for beam in shell.beams:
            yield coupled_pair(beam, *(planks[mark] for mark in beam.planks))


def drilled_turn(pair: CoupledPair) -> Floats:
    """Return the angles (m - 1,) that the drilled differences ask for, bay by bay, radians; positive to the left."""
    return np.diff(pair.right - pair.left) / pair.spacing
