"""The unit system: mm, N and radians inside; degrees a metre only where a person reads them."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aag_cad import units


def test_sixty_degrees_a_metre_in_radians_a_millimetre() -> None:
    assert units.deg_per_m(math.radians(60.0) / 1000.0) == pytest.approx(60.0, rel=1e-14)


@given(twist=st.floats(-1e-2, 1e-2))
def test_a_twist_in_degrees_a_metre_is_57296_times_that_in_radians_a_millimetre(twist: float) -> None:
    assert units.deg_per_m(twist) == pytest.approx(twist * 180_000.0 / math.pi, rel=1e-12, abs=1e-300)


@given(values=st.tuples(*[st.floats(allow_nan=False)] * 3))
def test_a_vector_is_three_plain_floats(values: tuple[float, float, float]) -> None:
    found = units.vector(np.array(values))
    assert found == values
    assert all(type(value) is float for value in found)


def test_millimetres_in_a_metre_a_square_metre_and_a_cubic_metre() -> None:
    assert (units.MM_PER_M, units.MM2_PER_M2, units.MM3_PER_M3) == (1e3, 1e6, 1e9)
