"""Section 3: the plank and what it can bear, r_min = 1.7 m and 60 degrees a metre.

Not asserted: stresses, relaxation and creep; the finger joints of the lamellas.
"""

import math

import numpy as np
import pytest

from aag_cad.design import Design
from aag_cad.geometry.framed import curvatures_at
from aag_cad.network.model import CurveNetwork
from aag_cad.parts.model import Gridshell, Shell


def test_two_planks_of_12_mm_are_split_from_one_of_25(design: Design) -> None:
    """25 x 100 mm from the sawmill, split to 2 x 12 x 100 mm: the saw takes a millimetre."""
    assert (design.timber.width, design.timber.thickness) == (100.0, 12.0)
    assert 25.0 - 2.0 * design.timber.thickness == 1.0


def test_the_species_is_ash_with_the_paper_s_limits(design: Design) -> None:
    assert design.timber.species == "ash"
    assert design.timber.min_bending_radius == 1700.0
    assert design.timber.max_twist_deg_per_m == 60.0


def test_the_modulus_and_strength_of_section_4_1(gridshell: Gridshell) -> None:
    """14000 N/mm2 and 50 N/mm2: the class D50 of EN 338 has both."""
    assert (gridshell.timber.modulus, gridshell.timber.bending_strength) == (14000.0, 50.0)


def test_the_geometry_goes_to_the_smallest_radius_and_not_below(network: CurveNetwork) -> None:
    """r_min = 1.7 m, reached by the geodesics at the ground: the shape is as curved as the planks allow (section 4)."""
    weak = []
    for item in network.curves:
        found = curvatures_at(item.curve, np.linspace(0.0, item.curve.length, 600))
        weak.append(float(np.abs(found.geodesic if item.id.family in ("A1", "A2") else found.normal).max()))
    assert 1.0 / max(weak) == pytest.approx(1700.0, abs=1.0)


def test_every_plank_as_built_is_bent_no_tighter_than_r_min(shell: Shell) -> None:
    """On the planks themselves, their offsets from the surface included, and with no allowance at all."""
    for plank in shell.planks:
        found = curvatures_at(plank.curve, np.linspace(0.0, plank.blank.length, 300))
        assert 1.0 / np.abs(found.geodesic if plank.upright else found.normal).max() > 1700.0, plank.mark


def test_the_largest_twist_is_a_third_of_what_the_planks_stand(shell: Shell) -> None:
    """19.5 degrees a metre at the feet of the beams, of 60."""
    twist = max(
        float(np.abs(curvatures_at(plank.curve, np.linspace(0.0, plank.blank.length, 300)).torsion).max())
        for plank in shell.planks
    )
    assert math.degrees(twist) * 1000.0 == pytest.approx(19.5, abs=0.1)


def test_planks_fit_a_stock_of_seven_metres(shell: Shell) -> None:
    """The longest beam is 6.71 m. Not asserted: the paper's own longest plank, which it does not print."""
    longest = max(plank.blank.length for plank in shell.planks)
    assert longest == pytest.approx(6710.0, abs=20.0)
