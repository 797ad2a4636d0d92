"""Sibling planks: drilled differences, the shape that they spring to, and what hole errors do to it."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from coupled import coupled_pairs, drilled_turn
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

from aag_cad.errors import NetworkError
from aag_cad.mechanics.siblings import (
    CoupledPair,
    PlaneCurve,
    coupled_pair,
    fitted_deviation,
    geodesic_turn,
    hole_error_effect,
    largest_sagitta,
    node_differences,
    node_indices,
    over_drill_shift,
    plane_curve,
    recovered_share,
    sprung_curve,
    sprung_shape,
    target_curve,
)
from aag_cad.parts.model import Gridshell
from aag_cad.units import Floats

MODULUS, WIDTH = 14000.0, 100.0


@pytest.fixture(scope="module")
def pairs(gridshell: Gridshell) -> dict[str, CoupledPair]:
    return {pair.beam.mark: pair for pair in coupled_pairs(gridshell) if pair.beam.mark.startswith("S1")}


def _element(length: float, area: float, inertia: float) -> Floats:
    """Return the stiffness (6, 6) of a plane beam element along x, degrees of freedom u, v, rotation at both ends."""
    stretch, bend = MODULUS * area / length, MODULUS * inertia
    a, b, c, d = 12 * bend / length**3, 6 * bend / length**2, 4 * bend / length, 2 * bend / length
    return np.array(
        [
            [stretch, 0, 0, -stretch, 0, 0],
            [0, a, b, 0, -a, b],
            [0, b, c, 0, -b, d],
            [-stretch, 0, 0, stretch, 0, 0],
            [0, -a, -b, 0, a, -b],
            [0, b, d, 0, -b, c],
        ]
    )


def _linked_beams(bays: Floats, differences: Floats, spacing: float, thickness: float) -> Floats:
    """Return the rotations (m + 1,) of the rigid links of two parallel planks whose bays were cut to unequal lengths.

    Four elements to a bay; the links are masters, plank ends at -+ spacing / 2 their slaves; the first link is held.
    """
    pieces, area, inertia = 4, WIDTH * thickness, WIDTH * thickness**3 / 12.0
    links = len(bays) + 1
    inner = 2 * len(bays) * (pieces - 1)
    size = 3 * (links + inner)
    rows, columns, values = [], [], []
    load = np.zeros(size)

    def dofs(plank: int, bay: int, piece: int) -> tuple[Floats, list[int]]:
        """Return the matrix (3, 3) from a master's degrees of freedom to those of a point on a plank, and theirs."""
        link = bay if piece == 0 else bay + 1 if piece == pieces else None
        if link is None:
            start = 3 * (links + (plank * len(bays) + bay) * (pieces - 1) + piece - 1)
            return np.eye(3), [start, start + 1, start + 2]
        to_point = np.eye(3)
        # A point beside the link, at y, moves along the beam by -y times the rotation.
        to_point[0, 2] = -(0.5 - plank) * spacing
        return to_point, [3 * link, 3 * link + 1, 3 * link + 2]

    for plank in (0, 1):
        for bay, (length, difference) in enumerate(zip(bays, differences, strict=True)):
            stiffness = _element(length / pieces, area, inertia)
            longer = (plank - 0.5) * difference
            push = MODULUS * area * longer / length
            for piece in range(pieces):
                (first, i), (second, j) = dofs(plank, bay, piece), dofs(plank, bay, piece + 1)
                change = np.block([[first, np.zeros((3, 3))], [np.zeros((3, 3)), second]])
                place = np.array(i + j)
                rows.append(np.repeat(place, 6))
                columns.append(np.tile(place, 6))
                values.append((change.T @ stiffness @ change).ravel())
                load[place] += change.T @ np.array([-push, 0, 0, push, 0, 0])
    matrix = coo_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), (size, size)).tocsc()
    moved = np.zeros(size)
    moved[3:] = spsolve(matrix[3:, 3:], load[3:])
    return np.asarray(moved[2 : 3 * links : 3])


def test_coupled_planks_keep_27_28ths_of_the_drilled_curvature() -> None:
    """A frame model of two beams and rigid links, every bay with its own length difference, against the closed form."""
    bays = np.array([250.0, 240.0, 260.0, 500.0, 300.0])
    differences = np.array([0.2, 0.5, 1.0, 2.6, 1.4])
    turns = np.diff(_linked_beams(bays, differences, 36.0, 12.0))
    assert recovered_share(36.0, 12.0) == pytest.approx(27.0 / 28.0, rel=1e-15)
    assert turns / (differences / 36.0) == pytest.approx(np.full(5, 27.0 / 28.0), rel=1e-9)


@pytest.mark.parametrize(("spacing", "thickness"), [(36.0, 12.0), (24.0, 24.0), (60.0, 10.0)])
def test_the_recovered_share_holds_for_other_sections(spacing: float, thickness: float) -> None:
    turn = _linked_beams(np.array([400.0, 400.0]), np.array([1.0, 1.0]), spacing, thickness)[-1]
    assert turn * spacing / 2.0 == pytest.approx(recovered_share(spacing, thickness), rel=1e-9)


def test_drilled_differences_are_the_planks_distance_times_the_turn_of_the_beam(pairs: dict[str, CoupledPair]) -> None:
    """Right minus left over every bay is 2 e times the integral of kappa_g ds, e = 18 mm, to a micrometre's order."""
    for pair in pairs.values():
        assert pair.spacing == pytest.approx(36.0, abs=1e-9)
        couplings = np.diff(pair.right - pair.left)
        assert couplings == pytest.approx(36.0 * geodesic_turn(pair.beam, pair.stations), abs=2e-4), pair.beam.mark
        expected = 36.0 * geodesic_turn(pair.beam, pair.stations[node_indices(pair)])
        assert node_differences(pair) == pytest.approx(expected, abs=2e-4), pair.beam.mark


def test_the_vaults_bays_differ_by_0_4_to_2_8_mm(pairs: dict[str, CoupledPair]) -> None:
    """On the surface the difference up to y is 36 cos 30 * 2/3 ln cosh y, whatever the neck's radius.

    The beams that start at the foot have their nodes at y = sqrt(3) (j + 1/2) delta; the layers lie 56 mm under and
    over the surface, so that the mean of A1 and A2 meets it to 2 percent.
    """
    bays = np.abs(np.concatenate([node_differences(pair) for pair in pairs.values()]))
    assert min(bays) == pytest.approx(0.38, abs=0.01)
    assert max(bays) == pytest.approx(2.81, abs=0.01)
    lower = node_differences(pairs["S1-A1-07"])
    upper = -node_differences(pairs["S1-A2-05"])
    y = math.sqrt(3.0) * math.radians(60.0 / 13.0) * (np.arange(11) + 0.5)
    expected = np.diff(36.0 * math.cos(math.radians(30.0)) * 2.0 / 3.0 * np.log(np.cosh(y)))
    assert (lower + upper) / 2.0 == pytest.approx(expected, rel=0.02)
    assert sum(lower[:9]) == pytest.approx(14.1, abs=0.1)
    assert sum(upper[:9]) == pytest.approx(14.9, abs=0.1)


def test_planks_that_share_no_two_bolted_joints_are_no_pair(gridshell: Gridshell) -> None:
    first = gridshell.shells[0]
    beam = first.beams[0]
    left, right = (next(p for p in first.planks if p.mark == mark) for mark in beam.planks)
    bare = replace(right, blank=replace(right.blank, holes=right.blank.holes[:1]))
    with pytest.raises(NetworkError, match=r"S1-A1-01: 1 joints .* at least 2"):
        coupled_pair(beam, left, bare)


def middle_rise(curve: PlaneCurve) -> float:
    """Return the distance of the middle sample of a plane curve from its chord, positive to the right of it, mm."""
    chord = curve[-1] - curve[0]
    return float(-((curve[len(curve) // 2] - curve[0]) * np.conj(chord)).imag / abs(chord))


def test_a_plane_curve_of_even_turn_is_an_arc_with_its_sagitta() -> None:
    stations = np.linspace(0.0, 5000.0, 11)
    curve = plane_curve(stations / 9000.0, stations)
    assert np.abs(curve - 9000.0j) == pytest.approx(np.full(11, 9000.0), rel=1e-12)
    assert largest_sagitta(curve) == pytest.approx(9000.0 * (1.0 - math.cos(5000.0 / 18000.0)), rel=1e-12)
    assert middle_rise(curve) == pytest.approx(largest_sagitta(curve), rel=1e-12)
    assert fitted_deviation(curve, (3.0 + 4.0j) + np.exp(0.7j) * curve) == pytest.approx(0.0, abs=1e-9)


def test_a_released_pair_is_flatter_by_a_28th_and_over_drilling_mends_it(pairs: dict[str, CoupledPair]) -> None:
    """The sagitta loses about 1/28; over-drilled, what is left comes from bays that bend evenly: under 0.6 mm."""
    for pair in pairs.values():
        shape = sprung_shape(pair, pair.left, pair.right, MODULUS)
        shift = over_drill_shift(pair)
        better = sprung_shape(pair, pair.left - shift, pair.right + shift, MODULUS)
        assert shape.sagitta / shape.target_sagitta == pytest.approx(27.0 / 28.0, abs=5e-3)
        assert better.sagitta == pytest.approx(shape.target_sagitta, rel=5e-3)
        assert better.fitted < 0.6
        assert better.fitted < shape.fitted / 10.0


def test_the_longest_beam_leaves_its_curve_by_16_mm_as_drilled(pairs: dict[str, CoupledPair]) -> None:
    """A2-07: a sagitta of 586 mm; a locked-in force E A s kappa / 56 of 1.3 kN in each plank."""
    shape = sprung_shape(pairs["S1-A2-07"], pairs["S1-A2-07"].left, pairs["S1-A2-07"].right, MODULUS)
    assert shape.target_sagitta == pytest.approx(586.0, abs=1.0)
    assert shape.fitted == pytest.approx(15.7, abs=0.1)
    pair = pairs["S1-A2-07"]
    apart = sprung_curve(pair, pair.left, pair.right)[-1] - target_curve(pair)[-1]
    assert abs(apart) == pytest.approx(72.6, abs=0.5)
    curvature = np.abs(drilled_turn(pair) / np.diff(pair.stations)).max()
    assert shape.force == pytest.approx(MODULUS * 1200.0 * 36.0 * curvature / 56.0, rel=1e-9)


def test_over_drilling_moves_no_hole_by_half_a_millimetre_and_keeps_the_middle(pairs: dict[str, CoupledPair]) -> None:
    for pair in pairs.values():
        left, right = pair.left - over_drill_shift(pair), pair.right + over_drill_shift(pair)
        assert np.diff(right - left) == pytest.approx(np.diff(pair.right - pair.left) * 28.0 / 27.0, rel=1e-9)
        assert left + right == pytest.approx(pair.left + pair.right, rel=1e-15)
        assert np.abs(over_drill_shift(pair)).max() < 0.5


def _drilled_badly(pair: CoupledPair, error: float, count: int) -> Iterator[tuple[Floats, Floats]]:
    random = np.random.default_rng(20)
    for _ in range(count):
        left, right = (
            stations + np.array([random.normal(0.0, error, holes).mean() for holes in pair.holes])
            for stations in (pair.left, pair.right)
        )
        yield left, right


@pytest.mark.parametrize("mark", ["S1-A1-06", "S1-A2-11", "S1-A1-11"])
def test_hole_errors_move_the_shape_as_the_linear_propagation_says(pairs: dict[str, CoupledPair], mark: str) -> None:
    """2 000 pairs drilled with 0.3 mm errors in every hole: the scatter of a standard deviation is then 1.6 percent."""
    pair, effect = pairs[mark], hole_error_effect(pairs[mark])
    right = sprung_curve(pair, pair.left, pair.right)
    last_turn = float(np.sum(drilled_turn(pair))) * pair.recovered
    rises, ends = [], []
    for left_drilled, right_drilled in _drilled_badly(pair, 0.3, 2000):
        curve = sprung_curve(pair, left_drilled, right_drilled)
        rises.append(middle_rise(curve))
        ends.append(((curve[-1] - right[-1]) * np.exp(-1j * last_turn)).imag)
    assert np.std(rises) == pytest.approx(effect.middle, rel=0.06)
    assert np.std(ends) == pytest.approx(effect.end, rel=0.06)
    nodes = [i for i, holes in enumerate(pair.holes) if holes > 1]
    bays = np.array([np.diff((r - x)[nodes]) for x, r in _drilled_badly(pair, 0.3, 2000)])
    nominal = np.diff((pair.right - pair.left)[nodes])
    share = math.sqrt(np.mean((bays - nominal) ** 2) / np.mean(nominal**2))
    assert share == pytest.approx(effect.curvature, rel=0.06)


def test_a_hole_error_of_0_3_mm_is_worth_a_fifth_of_the_long_beams_curvature(pairs: dict[str, CoupledPair]) -> None:
    """From stud to stud: 0.42 mm of error in 2 mm of difference; 6 mm at the middle, 5 cm at the end of a beam."""
    effects = [hole_error_effect(pair) for pair in pairs.values() if pair.beam.curve.length > 5000.0]
    assert [effect.curvature for effect in effects] == pytest.approx([0.2] * len(effects), abs=0.045)
    assert all(5.8 < effect.middle < 6.5 and 50.0 < effect.end < 70.0 for effect in effects)


def test_the_effect_grows_with_the_error_and_straight_beams_have_no_share(pairs: dict[str, CoupledPair]) -> None:
    pair = pairs["S1-A1-03"]
    one, two = hole_error_effect(pair, 0.3), hole_error_effect(pair, 0.6)
    assert (two.middle, two.end, two.curvature) == pytest.approx((2 * one.middle, 2 * one.end, 2 * one.curvature))
    assert hole_error_effect(replace(pair, right=pair.left)).curvature == math.inf


def test_the_target_is_the_beams_curve_with_its_normal_curvature_and_twist_left_out(
    pairs: dict[str, CoupledPair],
) -> None:
    """Its length is kept, its last tangent turned by the whole of kappa_g ds."""
    for pair in pairs.values():
        curve = target_curve(pair)
        assert float(np.abs(np.diff(curve)).sum()) == pytest.approx(pair.stations[-1] - pair.stations[0], rel=1e-6)
        turn = float(np.angle((curve[-1] - curve[-2]) / (curve[1] - curve[0])))
        assert turn == pytest.approx(float(np.sum(drilled_turn(pair))), abs=3e-3)
