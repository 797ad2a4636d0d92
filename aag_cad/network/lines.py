"""The lines of the tri-hex pattern in the chart (s, theta): A lines theta = c +- s and G lines theta = const."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from aag_cad.families import Family
from aag_cad.network.model import CurveId
from aag_cad.units import Floats

_EDGE = 1e-9


@dataclass(frozen=True)
class ChartLine:
    """theta = intercept + slope * s over s in [low, high]; slope +1 (A1), -1 (A2) or 0 (G)."""

    id: CurveId
    slope: int
    intercept: float
    low: float
    high: float

    def theta(self, s: Floats) -> Floats:
        """Return theta at s, (n,)."""
        return self.intercept + self.slope * s


@dataclass(frozen=True, eq=False)
class Region:
    """The shell in the chart: bottom <= s <= top(|theta|), and |theta| <= half unless it is closed about its axis."""

    half: float
    top: Callable[[float], float]
    bottom: float = 0.0
    closed: bool = False

    @property
    def highest(self) -> float:
        """The largest s of the top, at the middle or at the sides."""
        return max(float(self.top(0.0)), float(self.top(self.half)))

    def top_at(self, theta: float) -> float:
        """Return s of the top edge at an angle."""
        return float(self.top(0.0 if self.closed else min(abs(theta), self.half)))

    def margin(self, s: float, theta: float) -> float:
        """Return a number that is positive inside and zero on the border."""
        inside = min(s - self.bottom, self.top_at(theta) - s)
        return inside if self.closed else min(inside, self.half - abs(theta))


def _inside_intervals(region: Region, slope: int, intercept: float, step: float) -> list[tuple[float, float]]:
    """Return the intervals of s over which a line runs inside the region."""

    def margin(s: float) -> float:
        return region.margin(s, intercept + slope * s) + _EDGE

    grid = np.arange(region.bottom - step, region.highest + step, step / 40.0)
    signs = [margin(s) > 0.0 for s in grid.tolist()]
    edges = [
        float(brentq(margin, a, b, xtol=1e-14))
        for (a, b), (x, y) in zip(pairwise(grid), pairwise(signs), strict=True)
        if x != y
    ]
    return [(low, high) for low, high in zip(edges[::2], edges[1::2], strict=True) if high - low > step / 2.0]


def asymptotic_lines(region: Region, step: float, row_offset: float) -> list[ChartLine]:
    """Return every second A line of both families inside the region, by rising theta, numbered from 1.

    With s counted from the bottom edge, A1: theta - s = (2m - row_offset) step, A2: theta + s = (2m + row_offset) step:
    with every G line between two columns of AA nodes this is the tri-hex pattern (paper section 3.1).
    """
    reach = math.ceil((region.highest - region.bottom + region.half) / step)
    turns = range(round(math.pi / step)) if region.closed else range(-reach, reach + 1)
    lines: list[ChartLine] = []
    families: tuple[tuple[Family, int, float], ...] = (("A1", 1, -row_offset), ("A2", -1, row_offset))
    for family, slope, offset in families:
        intercepts = [(2 * m + offset) * step - slope * region.bottom for m in turns]
        found = [(c, *interval) for c in intercepts for interval in _inside_intervals(region, slope, c, step)]
        lines += [ChartLine(CurveId(family, i), slope, *line) for i, line in enumerate(found, start=1)]
    return lines


def geodesic_lines(region: Region, count: int) -> list[ChartLine]:
    """Return the G lines (meridians) by rising theta, numbered from 1; half a step from theta = 0 where closed."""
    angles = np.linspace(-region.half, region.half, count)
    if region.closed:
        angles = (np.arange(count) + 0.5 - count / 2.0) * 2.0 * math.pi / count
    return [
        ChartLine(CurveId("G", i), 0, float(theta), region.bottom, region.top_at(float(theta)))
        for i, theta in enumerate(angles, start=1)
    ]


def crossings_of(a: ChartLine, b: ChartLine, closed: bool) -> list[tuple[float, float]]:
    """Return (s, theta) of the places where two lines of different families cross inside both.

    One at most, unless the shell is closed: there theta counts modulo a full turn.
    """
    if a.slope == b.slope:
        return []
    places = []
    for turn in (-2, -1, 0, 1, 2) if closed else (0,):
        s = (b.intercept + 2.0 * math.pi * turn - a.intercept) / (a.slope - b.slope)
        if all(line.low - _EDGE <= s <= line.high + _EDGE for line in (a, b)):
            places.append((s, a.intercept + a.slope * s))
    return places
