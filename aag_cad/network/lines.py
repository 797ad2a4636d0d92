"""The lines of the tri-hex pattern in the chart (s, theta): A lines theta = c +- s and G lines theta = const."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.interpolate import BSpline
from scipy.optimize import brentq

from aag_cad.network.model import CurveId, Family
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
    """The shell in the chart: s >= 0, |theta| <= half, s <= ridge(|theta|)."""

    half: float
    ridge: BSpline

    def margin(self, s: float, theta: float) -> float:
        """Return a number that is positive inside and zero on the border."""
        clipped = min(abs(theta), self.half)
        return min(s, self.half - abs(theta), float(self.ridge(clipped)) - s)


def _inside_intervals(region: Region, slope: int, intercept: float, step: float) -> list[tuple[float, float]]:
    """Return the intervals of s over which a line runs inside the region."""

    def margin(s: float) -> float:
        return region.margin(s, intercept + slope * s) + _EDGE

    top = float(region.ridge(0.0)) + step
    grid = np.arange(-step, top, step / 40.0)
    signs = [margin(s) > 0.0 for s in grid]
    edges = [
        float(brentq(margin, a, b, xtol=1e-14))
        for (a, b), (x, y) in zip(pairwise(grid), pairwise(signs), strict=True)
        if x != y
    ]
    return [(low, high) for low, high in zip(edges[::2], edges[1::2], strict=True) if high - low > step / 2.0]


def asymptotic_lines(region: Region, step: float, row_offset: float) -> list[ChartLine]:
    """Return every second A line of both families inside the region, by rising theta, numbered from 1.

    A1: theta - s = (2m - row_offset) step, A2: theta + s = (2m + row_offset) step: with every G line between two
    columns of AA nodes this is the tri-hex pattern (paper section 3.1).
    """
    reach = math.ceil((float(region.ridge(0.0)) + region.half) / step)
    lines: list[ChartLine] = []
    families: tuple[tuple[Family, int, float], ...] = (("A1", 1, -row_offset), ("A2", -1, row_offset))
    for family, slope, offset in families:
        intercepts = [(2 * m + offset) * step for m in range(-reach, reach + 1)]
        found = [(c, *interval) for c in intercepts for interval in _inside_intervals(region, slope, c, step)]
        lines += [ChartLine(CurveId(family, i), slope, *line) for i, line in enumerate(found, start=1)]
    return lines


def geodesic_lines(region: Region, count: int) -> list[ChartLine]:
    """Return the G lines (meridians) by rising theta, numbered from 1."""
    angles = np.linspace(-region.half, region.half, count)
    return [
        ChartLine(CurveId("G", i), 0, float(theta), 0.0, float(region.ridge(abs(theta))))
        for i, theta in enumerate(angles, start=1)
    ]


def crossing_of(a: ChartLine, b: ChartLine) -> tuple[float, float] | None:
    """Return (s, theta) where two lines of different families cross inside both, or None."""
    if a.slope == b.slope:
        return None
    s = (b.intercept - a.intercept) / (a.slope - b.slope)
    if not all(line.low - _EDGE <= s <= line.high + _EDGE for line in (a, b)):
        return None
    return s, a.intercept + a.slope * s
