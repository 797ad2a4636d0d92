"""What a passport says of a plank, against the model, brute force and closed forms."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aag_cad.geometry.framed import framed_curve
from aag_cad.mechanics.checks.lamella import lamella_stress
from aag_cad.parts.forming import formed_points, plank_axes
from aag_cad.parts.forms import Blank, CrossSection, Hole
from aag_cad.parts.model import Gridshell, Plank, Shell, Timber
from aag_cad.parts.quantities import largest_twist, smallest_radius
from aag_cad.shop.passports import (
    REUSE_HEADER,
    Passport,
    clear_stretches,
    passport,
    passports,
    reuse_row,
    stock_origin,
    strain_along,
)
from aag_cad.units import Floats

SECTION = CrossSection(100.0, 12.0)
ASH = Timber("ash", "D50", 700.0, 14000.0, 930.0, 50.0, 4.5, 1700.0, math.radians(60.0) / 1000.0)


def hole(station: float, diameter: float = 9.0, slot: float = 0.0, offset: float = 18.0) -> Hole:
    return Hole(station, offset, diameter, "bolt", "S1-N-001", slot)


def hoop(radius: float, length: float) -> Plank:
    """Return a flat plank bent round the outside of a cylinder."""

    def evaluate(s: Floats) -> tuple[Floats, Floats]:
        normal = np.column_stack([np.cos(s / radius), np.sin(s / radius), np.zeros_like(s)])
        return radius * normal, normal

    curve = framed_curve(evaluate, 0.0, length, length)
    return Plank("S1-G-01", "G", 0, False, "", curve, Blank(curve.length, SECTION, ()), ())


@pytest.fixture(scope="module")
def held(gridshell: Gridshell) -> tuple[Passport, ...]:
    return passports(gridshell)


def test_every_plank_has_a_passport_in_the_order_of_marks(gridshell: Gridshell, held: tuple[Passport, ...]) -> None:
    marks = [each.plank.mark for each in held]
    assert marks == sorted(plank.mark for shell in gridshell.shells for plank in shell.planks)
    assert {each.design for each in held} == {"vault"}


def test_a_passport_says_what_was_cut_and_drilled(gridshell: Gridshell, held: tuple[Passport, ...]) -> None:
    planks = {plank.mark: plank for shell in gridshell.shells for plank in shell.planks}
    for each in held:
        assert each.plank.blank == planks[each.plank.mark].blank
        assert (each.timber.species, each.timber.strength_class) == ("ash", "D50")


def test_a_plank_of_12_mm_is_half_of_the_board_of_the_paper() -> None:
    """The paper, section 3: 25 x 100 mm boards were split to two planks of 12 x 100 mm."""
    assert stock_origin(SECTION) == "half of a board 25 x 100 mm, split in two"


def test_radius_and_twist_are_those_of_the_part_list(gridshell: Gridshell, held: tuple[Passport, ...]) -> None:
    planks = {plank.mark: plank for shell in gridshell.shells for plank in shell.planks}
    for each in held[:: len(held) // 20]:
        assert each.smallest_radius == smallest_radius(planks[each.plank.mark])
        assert each.largest_twist == largest_twist(planks[each.plank.mark])


def test_a_plank_is_bent_and_twisted_most_where_its_passport_says(shell: Shell, gridshell: Gridshell) -> None:
    """2e-3: the passport names the first station within 1e-3 of the largest, and looks every 20 mm only."""
    for plank in shell.planks[::5]:
        each = passport(plank, gridshell.timber, "vault")
        fine = strain_along(plank, 2.0)
        bending = np.interp(each.smallest_radius_station, fine.stations, np.abs(fine.bending))
        twist = np.interp(each.largest_twist_station, fine.stations, np.abs(fine.twist))
        assert bending == pytest.approx(np.abs(fine.bending).max(), rel=2e-3)
        assert 1.0 / bending == pytest.approx(each.smallest_radius, rel=2e-3)
        assert twist == pytest.approx(np.abs(fine.twist).max(), rel=2e-3, abs=1e-9)


@pytest.mark.parametrize("family", ["A1", "A2", "G"])
def test_the_hollow_face_is_the_shorter_one(shell: Shell, family: str) -> None:
    """Fibres at z = +-6 mm differ by 12 mm times the integral of the bending; 2e-3 for chords of 5 mm and the twist."""
    plank = max((each for each in shell.planks if each.family == family), key=lambda each: each.blank.length)
    strain = strain_along(plank, 5.0)
    lengths = []
    for z in (-6.0, 6.0):
        fibre = np.column_stack([strain.stations, np.zeros_like(strain.stations), np.full_like(strain.stations, z)])
        lengths.append(np.linalg.norm(np.diff(formed_points(plank, fibre), axis=0), axis=1).sum())
    turning = float(np.trapezoid(strain.bending, strain.stations))
    assert lengths[0] - lengths[1] == pytest.approx(12.0 * turning, rel=2e-3)
    assert abs(turning) > 0.05


def test_a_right_handed_screw_turns_its_width_towards_its_thickness(shell: Shell) -> None:
    """The angle between neighbouring width directions, seen along the plank; 1e-3 for steps of 20 mm."""
    plank = next(each for each in shell.planks if each.upright)
    strain = strain_along(plank)
    _point, _tangent, width, thickness = plank_axes(plank, strain.stations)
    turned = np.arcsin(np.einsum("ij,ij->i", width[1:], thickness[:-1])) / np.diff(strain.stations)
    middle = (strain.twist[1:] + strain.twist[:-1]) / 2.0
    assert turned == pytest.approx(middle, rel=1e-3)


def test_a_plank_bent_to_the_smallest_radius_uses_the_strength_of_ash_up() -> None:
    """The paper, section 3: r_min = 1.7 m; E t / (2 r) = 14 000 x 12 / 3 400 = 49.4 of f_m = 50 N/mm2."""
    each = passport(hoop(1700.0, 3000.0), ASH, "hoop")
    assert each.stress.combined == pytest.approx(14000.0 * 12.0 / 3400.0, rel=1e-4)
    assert each.bending_utilisation == pytest.approx(0.988, abs=1e-3)
    assert each.shear_utilisation < 1e-6


def test_a_plank_of_one_curvature_is_bent_to_it_from_its_start() -> None:
    assert passport(hoop(5100.0, 3000.0), ASH, "hoop").smallest_radius_station == 0.0


def test_stresses_are_those_of_the_check_of_lamellas(shell: Shell, gridshell: Gridshell) -> None:
    for plank in shell.planks[::9]:
        each, stress = passport(plank, gridshell.timber, "vault"), lamella_stress(plank, gridshell.timber)
        assert (each.stress.combined, each.stress.torsion) == (stress.combined, stress.torsion)
        assert each.bending_utilisation == pytest.approx(stress.combined / 50.0)
        assert each.shear_utilisation == pytest.approx(stress.torsion / gridshell.timber.shear_strength)


bored = st.builds(
    lambda station, diameter, slot: hole(station / 4.0, diameter / 4.0, slot / 4.0),
    st.integers(0, 4000),
    st.integers(4, 80),
    st.integers(0, 200),
)


@given(st.lists(bored, max_size=12), st.integers(1, 4000))
def test_clear_stretches_are_what_a_ruler_finds_free_of_holes(holes: list[Hole], quarters: int) -> None:
    """Brute force: every eighth of a millimetre is looked at, in its middle; edges of holes lie on eighths."""
    length = quarters / 4.0
    middles = (np.arange(int(length * 8.0)) + 0.5) / 8.0
    free = np.ones(len(middles), dtype=bool)
    for each in holes:
        half = (each.diameter + each.slot) / 2.0
        free &= (middles < each.station - half) | (middles > each.station + half)
    found = np.zeros(len(middles), dtype=bool)
    for stretch in clear_stretches(Blank(length, SECTION, tuple(holes))):
        assert 0.0 <= stretch.start < stretch.end <= length
        assert not found[(middles > stretch.start) & (middles < stretch.end)].any()
        found |= (middles > stretch.start) & (middles < stretch.end)
    assert np.array_equal(found, free)


def test_clear_stretches_come_longest_first_and_end_at_the_edges_of_holes() -> None:
    blank = Blank(1000.0, SECTION, (hole(100.0), hole(100.0, offset=-18.0), hole(400.0, diameter=10.0, slot=20.0)))
    assert [(each.start, each.end, each.length) for each in clear_stretches(blank)] == [
        (415.0, 1000.0, 585.0), (104.5, 385.0, 280.5), (0.0, 95.5, 95.5),
    ]  # fmt: skip


def test_a_plank_without_holes_is_clear_from_end_to_end() -> None:
    (stretch,) = clear_stretches(Blank(1234.5, SECTION, ()))
    assert (stretch.start, stretch.end) == (0.0, 1234.5)


def test_a_plank_is_stock_with_its_holes_from_the_start() -> None:
    plank = hoop(5000.0, 3000.0)
    blank = replace(
        plank.blank, holes=(hole(99.76, offset=-18.0), hole(400.0, 6.5, offset=-0.01), hole(700.0, slot=20.0))
    )
    row = dict(zip(REUSE_HEADER, reuse_row(passport(replace(plank, blank=blank), ASH, "hoop")), strict=True))
    assert row == {
        "mark": "S1-G-01",
        "length_mm": "3000.0",
        "width_mm": "100",
        "thickness_mm": "12",
        "species": "ash",
        "strength_class": "D50",
        "holes": "99.8:-18.0:9;400.0:0.0:6.5;700.0:18.0:29",
    }
