"""Two stands under a pair of planks laid flat, so that own weight bends them until their holes meet.

The planks lie one over the other with studs and blocks between them and slide on each other: both bend to one curve,
each with its own stiffness. Where the curve has turned by an angle, the lower plank's holes lag the upper's by the
planks' distance times that angle: the holes meet where the turn is the drilled one (paper, section 3.2 and Fig. 7e).
Linear beam theory with overhangs, lengths along the planks; derivation and limits: docs/prefabrication.md.
"""

import math
from dataclasses import dataclass

import numpy as np

from aag_cad.mechanics.siblings import CoupledPair
from aag_cad.parts.model import Part, Shell, Timber
from aag_cad.parts.quantities import mass
from aag_cad.units import Floats

GRAVITY = 9.81
LEAST_OVERHANG = 50.0
_LATTICE = 10.0
_STEPS = (320.0, 160.0, 80.0, 40.0, 20.0, 10.0)
_LEAST_HALF_SPAN = 200.0


@dataclass(frozen=True)
class FlatPair:
    """A pair laid flat: length in mm, own weight in N/mm and bending stiffness E I in N mm2 of both planks together."""

    length: float
    weight: float
    stiffness: float


@dataclass(frozen=True)
class Stands:
    """Where two stands carry a pair: overhangs at its start and end in mm, load hung half-way between them in N."""

    start: float
    end: float
    load: float = 0.0


@dataclass(frozen=True)
class StandLayout:
    """The stands on which a beam's holes meet best, and what is left.

    ``upper`` is the plank that lies on top; ``spacing`` and overhangs in mm along the planks, ``added`` in kg; ``sag``
    is the largest depth below a string over the stands; ``gap`` and ``largest_gap`` are the root mean square and the
    largest distance in mm by which holes still miss each other when the upper plank is pushed along to fit best;
    ``slope`` is the largest slope between the stands in radians.
    """

    upper: str
    stands: Stands
    spacing: float
    added: float
    sag: float
    gap: float
    largest_gap: float
    slope: float


def _reactions(pair: FlatPair, stands: Stands) -> tuple[float, float, float, float]:
    """Return both stands' places from the start, mm, and their reactions, N."""
    first, second = stands.start, pair.length - stands.end
    span = second - first
    on_second = pair.weight * pair.length * (pair.length / 2.0 - first) / span + stands.load / 2.0
    return first, second, pair.weight * pair.length + stands.load - on_second, on_second


def _raw(pair: FlatPair, stands: Stands, x: Floats, order: int) -> Floats:
    """Return the moment (order 0) or its first or second integral over x (n,), by Macaulay brackets, over E I."""
    first, second, on_first, on_second = _reactions(pair, stands)

    def bracket(at: float, power: int) -> Floats:
        return np.asarray(np.maximum(x - at, 0.0) ** power / math.factorial(power))

    middle = (first + second) / 2.0
    moment = (
        on_first * bracket(first, order + 1)
        + on_second * bracket(second, order + 1)
        - stands.load * bracket(middle, order + 1)
        - pair.weight * bracket(0.0, order + 2)
    )
    return np.asarray(moment / pair.stiffness)


def curvature(pair: FlatPair, stands: Stands, x: Floats) -> Floats:
    """Return the curvature M / E I (n,) at x (n,), 1/mm; positive where the pair sags."""
    return _raw(pair, stands, x, 0)


def slope(pair: FlatPair, stands: Stands, x: Floats) -> Floats:
    """Return the slope (n,) at x (n,), radians; both stands are at one height."""
    first, second = stands.start, pair.length - stands.end
    ends = _raw(pair, stands, np.array([first, second]), 2)
    turned = _raw(pair, stands, x, 1) - (ends[1] - ends[0]) / (second - first)
    return np.asarray(turned)


def height(pair: FlatPair, stands: Stands, x: Floats) -> Floats:
    """Return the height (n,) at x (n,) over the tops of the stands, mm; negative where the pair sags."""
    first, second = stands.start, pair.length - stands.end
    ends = _raw(pair, stands, np.array([first, second]), 2)
    rise = (ends[1] - ends[0]) / (second - first)
    return np.asarray(_raw(pair, stands, x, 2) - ends[0] - rise * (x - first))


def flat_pair(shell: Shell, pair: CoupledPair, timber: Timber) -> FlatPair:
    """Return a beam's two planks laid flat, with the weight of its studs and blocks spread over the length.

    A stud counts whole: it is in the gap of each of its two beams while that beam is made.
    """
    wanted = {*pair.beam.planks, *pair.joints}
    timbers: tuple[Part, ...] = (*shell.planks, *shell.studs, *shell.blocks)
    parts = [part for part in timbers if part.mark in wanted]
    weight = GRAVITY * sum(mass(part, timber) for part in parts)
    inertia, length = pair.section.width * pair.section.thickness**3 / 12.0, pair.beam.curve.length
    return FlatPair(length, weight / length, 2.0 * timber.modulus * inertia)


def _turns_left(pair: CoupledPair) -> float:
    """Return 1 if the beam turns to its left on the whole, -1 if to its right."""
    return 1.0 if pair.right[-1] - pair.left[-1] >= pair.right[0] - pair.left[0] else -1.0


def hole_gaps(pair: CoupledPair, flat: FlatPair, stands: Stands) -> Floats:
    """Return by how much (m,) the holes of the couplings miss each other, mm, the upper plank pushed along to fit best.

    The plank with the shorter hole distances lies on top: there the sagging pair is shorter.
    """
    sagged = pair.spacing * slope(flat, stands, pair.stations)
    gaps = sagged - _turns_left(pair) * (pair.right - pair.left)
    return np.asarray(gaps - gaps.mean())


def _miss(pair: CoupledPair, flat: FlatPair, stands: Stands) -> float:
    return float(np.sqrt(np.mean(hole_gaps(pair, flat, stands) ** 2)))


def _best_overhangs(pair: CoupledPair, flat: FlatPair) -> Stands:
    """Return the overhangs, in steps of 10 mm, at which the holes meet best in the sum of squares."""
    most = flat.length / 2.0 - _LEAST_HALF_SPAN

    def inside(overhang: float) -> float:
        return min(max(overhang, LEAST_OVERHANG), max(LEAST_OVERHANG, most // _LATTICE * _LATTICE))

    best = Stands(inside(LEAST_OVERHANG), inside(LEAST_OVERHANG))
    for step in _STEPS:
        while True:
            moves = [(i * step, j * step) for i in (0, -1, 1) for j in (0, -1, 1)]
            around = [Stands(inside(best.start + i), inside(best.end + j)) for i, j in moves]
            found = min(around, key=lambda stands: _miss(pair, flat, stands))
            if found == best:
                break
            best = found
    return best


def _added_load(pair: CoupledPair, flat: FlatPair, stands: Stands) -> float:
    """Return the load half-way, N, not negative, with which the holes meet best; the gaps are linear in it."""
    without = hole_gaps(pair, flat, stands)
    by_newton = hole_gaps(pair, flat, Stands(stands.start, stands.end, 1.0)) - without
    return max(0.0, float(-(without @ by_newton) / (by_newton @ by_newton)))


def stand_layout(pair: CoupledPair, flat: FlatPair) -> StandLayout:
    """Return the stands on which the holes of a beam meet best; a load is added only if they stand at both ends.

    Own weight too great is met by moving the stands inwards, own weight too small by hanging a load half-way.
    """
    stands = _best_overhangs(pair, flat)
    if stands.start == stands.end == LEAST_OVERHANG:
        stands = Stands(stands.start, stands.end, _added_load(pair, flat, stands))
    gaps = hole_gaps(pair, flat, stands)
    x = np.linspace(stands.start, flat.length - stands.end, 401)
    return StandLayout(
        upper=pair.beam.planks[0 if _turns_left(pair) > 0.0 else 1],
        stands=stands,
        spacing=float(x[-1] - x[0]),
        added=stands.load / GRAVITY,
        sag=float(-height(flat, stands, x).min()),
        gap=float(np.sqrt(np.mean(gaps**2))),
        largest_gap=float(np.abs(gaps).max()),
        slope=float(np.abs(slope(flat, stands, x)).max()),
    )
