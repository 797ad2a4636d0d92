"""The lowest eigenvalues of a whole frame, to test with."""

import numpy as np
from scipy.sparse import csc_array, eye_array

from aag_cad.mechanics.frame.factor import lowest_pairs
from aag_cad.mechanics.frame.model import FrameModel
from aag_cad.mechanics.frame.statics import held_part
from aag_cad.mechanics.frame.system import against_unknowns, frame_system, full_stiffness, mass_matrix
from aag_cad.units import Floats


def lowest_eigenvalues(model: FrameModel, count: int, masses: Floats | None = None) -> Floats:
    """Return the lowest eigenvalues (k,) of K v = lambda M v, at most ``count``: 1/s2 with masses (n,) in kg.

    The masses are lumped at the nodes; without them M is the unit matrix of the unknowns. Mechanisms show as about 0.
    """
    system = frame_system(model)
    stiffness = held_part(system, against_unknowns(system, full_stiffness(system)))
    size = len(system.free)
    unit = csc_array(eye_array(size))
    mass = unit if masses is None else held_part(system, mass_matrix(system, np.asarray(masses) / 1000.0))
    return lowest_pairs(stiffness, mass, min(count, size))[0]
