"""Folded plates: volume, holes and depth against the plain geometry of a folded rectangle."""

import numpy as np
import pytest

from aag_cad.parts.forms import FoldedPlate, PlateHole
from aag_cad.parts.shapes.folded_plate import (
    developed_length,
    hole_axes,
    plate_depth,
    plate_legs,
    plate_rings,
    plate_volume,
)
from aag_cad.parts.triangles import tube

ANGLE = FoldedPlate(
    ((0.0, 100.0), (0.0, 0.0), (60.0, 0.0)), 80.0, 6.0, (PlateHole(30.0, 10.0, 9.0), PlateHole(130.0, 0.0, 18.0))
)


def test_a_plate_folded_at_a_right_angle_has_the_length_of_its_two_legs() -> None:
    assert developed_length(ANGLE) == pytest.approx(160.0)


def test_mitred_folds_keep_section_times_length() -> None:
    gross = 160.0 * 80.0 * 6.0
    assert tube(plate_rings(ANGLE)).volume == pytest.approx(gross, rel=1e-12)
    bored = 6.0 * np.pi / 4.0 * (9.0**2 + 18.0**2)
    assert plate_volume(ANGLE) == pytest.approx(gross - bored, rel=1e-12)


def test_holes_stand_square_to_the_leg_that_they_are_in() -> None:
    centres, axes = hole_axes(ANGLE)
    assert centres == pytest.approx(np.array([[0.0, 10.0, 70.0], [30.0, 0.0, 0.0]]))
    assert np.abs(axes) == pytest.approx(np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]))


def test_thickness_directions_are_length_cross_width() -> None:
    legs = plate_legs(ANGLE)
    assert legs.normal == pytest.approx(np.cross(legs.direction, [0.0, 1.0, 0.0]))


def test_depth_is_the_way_to_the_nearest_face() -> None:
    points = np.array([[0.0, 0.0, 50.0], [2.0, 0.0, 50.0], [0.0, 39.0, 50.0], [10.0, 0.0, 50.0], [30.0, 0.0, -1.0]])
    assert plate_depth(ANGLE, points) == pytest.approx(np.array([3.0, 1.0, 1.0, -7.0, 2.0]))
