"""The unit system: mm, N, N/mm2, kg and radians inside; what leaves it is converted here and nowhere else."""

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int64]
Vector: TypeAlias = tuple[float, float, float]

MM_PER_M = 1000.0
MM2_PER_M2 = 1e6
MM3_PER_M3 = 1e9


def vector(values: Floats) -> Vector:
    """Return a (3,) array as a plain tuple of floats."""
    x, y, z = values.tolist()
    return x, y, z


def deg_per_m(radians_per_mm: float) -> float:
    """Return a twist in degrees per metre from radians per millimetre."""
    return math.degrees(radians_per_mm) * MM_PER_M
