"""The figures of one shell: plan area, crown, entry, smallest radius, largest twist."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from aag_cad.design import Design
from aag_cad.geometry.framed import curvatures_at
from aag_cad.geometry.profiles import CrpcProfile
from aag_cad.geometry.revolution import AsymptoticChart
from aag_cad.network.extent import ShellExtent, shell_areas, shell_extent
from aag_cad.network.model import CurveNetwork
from aag_cad.units import MM2_PER_M2


@pytest.fixture(scope="module")
def extent(design: Design, chart: AsymptoticChart, network: CurveNetwork) -> ShellExtent:
    """The figures of a shell of the vault."""
    return shell_extent(design, chart, network)


def ridge_radius(theta: float) -> float:
    """Return r of the ridge in plan about the shell's axis: (sqrt(3)/2) D / sin(|theta| + 60 degrees)."""
    return math.sqrt(3.0) / 2.0 * 8823.0 / math.sin(abs(theta) + math.pi / 3.0)


def height_at(radius: float) -> float:
    """Return z of the vault's meridian at a radius."""
    y = math.acosh((radius / 5100.0) ** 3)
    return float(CrpcProfile(5100.0, 3.0).meridian(np.array([y]))[1][0, 0])


def test_three_shells_cover_sixty_square_metres(design: Design, chart: AsymptoticChart) -> None:
    """60.27 m2, as the integral of (ridge^2 - neck^2) / 2 over the sector in closed form."""
    expected = 2.0 * quad(lambda t: (ridge_radius(t) ** 2 - 5100.0**2) / 2.0, 0.0, math.pi / 6.0)[0]
    found = shell_areas(design, chart)[0]
    assert found == pytest.approx(expected, rel=1e-9)
    assert 3.0 * found / MM2_PER_M2 == pytest.approx(60.27, abs=0.1)


def test_crown_and_entry(extent: ShellExtent) -> None:
    """2720 mm at the centre, where r = D, and 2430 mm over the entry, where r = (sqrt(3)/2) D."""
    assert extent.crown_height == pytest.approx(height_at(8823.0), abs=1e-6)
    assert extent.crown_height == pytest.approx(2720.0, abs=2.0)
    assert extent.entry_height == pytest.approx(height_at(math.sqrt(3.0) / 2.0 * 8823.0), abs=1e-6)
    assert extent.entry_height == pytest.approx(2430.0, abs=5.0)


def test_the_smallest_bending_radius_of_the_curves_is_that_of_the_meridian_at_the_neck(network: CurveNetwork) -> None:
    """1700 mm = r0 / 3, the paper's r_min; the curves of the geodesics reach through the neck."""
    bend = [
        np.abs(curvatures_at(item.curve, np.linspace(0.0, item.curve.length, 1000)).normal).max()
        for item in network.curves
        if item.id.family == "G"
    ]
    assert 1.0 / max(bend) == pytest.approx(1700.0, abs=1.0)


def test_the_largest_twist_is_that_of_the_beams_at_the_neck(
    extent: ShellExtent,
) -> None:
    """19.5 degrees a metre, a third of what the timber stands."""
    twist = extent.largest_twist
    assert math.degrees(max(twist.values())) * 1000.0 == pytest.approx(19.5, abs=0.1)
    assert max(twist, key=lambda family: twist[family]) in ("A1", "A2")


def test_the_smallest_radii_by_family(extent: ShellExtent) -> None:
    """G 1700 mm at the foot, the bottom its own 5100 mm, A1 and A2 r0 / 0.595275 = 8567 mm."""
    radii = extent.smallest_radius
    assert radii["G"] == pytest.approx(1700.0, abs=1.0)
    assert radii["E"] == pytest.approx(5100.0, abs=1.0)
    assert radii["A1"] == pytest.approx(5100.0 / 0.595275, abs=3.0)
    assert radii["A2"] == pytest.approx(radii["A1"], abs=0.5)


def test_meridians_do_not_twist(extent: ShellExtent) -> None:
    assert extent.largest_twist["G"] < 1e-9
