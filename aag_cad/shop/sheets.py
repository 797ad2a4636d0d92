"""Facade strips on sheets: which strips are cut from which sheet, with the least length of sheet bought."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from scipy.optimize import LinearConstraint

from aag_cad.parts.triangles import polygon_area
from aag_cad.shop.stock import Piece, StockRules, cutting_plan, times_cut
from aag_cad.units import Floats

_PATTERNS = 20_000
_SAME = 0.05

# A bay of a sheet holds one kind of strip, or two kinds side by side.
Bay: TypeAlias = tuple[int, ...]


@dataclass(frozen=True)
class SheetRules:
    """What is bought: width of the sheets, their lengths along the ribs, and the gap between two strips, mm."""

    width: float
    lengths: tuple[float, ...]
    gap: float


@dataclass(frozen=True)
class PlacedStrip:
    """A strip on a sheet: its outline, turned by 180 degrees if ``turned``, then moved by (x, y), lies on the sheet."""

    mark: str
    x: float
    y: float
    turned: bool


@dataclass(frozen=True)
class SheetUse:
    """A sheet as bought: x along the ribs from one end, y from one edge, mm."""

    length: float
    strips: tuple[PlacedStrip, ...]


@dataclass(frozen=True)
class SheetPlan:
    """Sheets to buy; lengths in mm, ``strip_area`` in mm2; ``refused`` are the strips that no sheet holds.

    ``bound`` holds for plans in bays: strips behind one another, or two side by side, turned end for end if that helps,
    and never across the ribs or on their other face.
    """

    sheets: tuple[SheetUse, ...]
    width: float
    strip_area: float
    bound: float
    first_fit_decreasing: float
    refused: tuple[str, ...]

    @property
    def bought(self) -> float:
        """Length of all sheets, mm."""
        return sum(sheet.length for sheet in self.sheets)

    @property
    def waste_percent(self) -> float:
        """Share of the area of all sheets that is in no strip, per cent."""
        return 100.0 * (1.0 - self.strip_area / (self.bought * self.width)) if self.sheets else 0.0

    @property
    def proven(self) -> bool:
        """Whether no plan in bays buys less."""
        return self.bought <= self.bound + 1e-6


@dataclass(frozen=True)
class _Fit:
    """How the strips of a bay lie: its length, and (x, y, turned) of each relative to the corner of the bay."""

    length: float
    places: tuple[tuple[float, float, bool], ...]


def _at_corner(outline: Floats) -> Floats:
    return np.asarray(outline - outline.min(axis=0))


def edge_heights(outline: Floats, x: Floats) -> tuple[Floats, Floats]:
    """Return the lowest and highest y of an outline (n, 2) on lines across it at x (m,); NaN where there is none."""
    start, end = outline, np.roll(outline, -1, axis=0)
    low, high = np.minimum(start[:, 0], end[:, 0]), np.maximum(start[:, 0], end[:, 0])
    run = end[:, 0] - start[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        along = np.where(run == 0.0, 0.0, (x[:, None] - start[:, 0]) / run)
    y = start[:, 1] + along * (end[:, 1] - start[:, 1])
    y = np.where((x[:, None] >= low - 1e-9) & (x[:, None] <= high + 1e-9), y, np.nan)
    # The other end of an edge that runs straight across, which has a single x.
    other = np.where((run == 0.0) & ~np.isnan(y), end[:, 1], np.nan)
    both = np.concatenate([y, other], axis=1)
    touched = ~np.isnan(both).all(axis=1)
    lowest, highest = np.full(len(x), np.nan), np.full(len(x), np.nan)
    lowest[touched], highest[touched] = np.nanmin(both[touched], axis=1), np.nanmax(both[touched], axis=1)
    return lowest, highest


def lift_over(lower: Floats, upper: Floats, gap: float, x: Floats) -> float:
    """Return how far ``upper`` must be moved in y to lie clear above ``lower`` at every x (n,), some of it in both."""
    return float(np.nanmax(edge_heights(lower, x)[1] - edge_heights(upper, x)[0])) + gap


def _stacked(under: Floats, over: Floats, rules: SheetRules) -> tuple[float, float, float] | None:
    """Return (width of both, y of the lower, y of the upper) of two strips stacked across the sheet; None if too wide.

    Both stand at their x; their lowest y is 0. Between the corners the edges are straight, so corners are all x that
    matter; most pairs are too wide already at a few.
    """
    low = max(float(under[:, 0].min()), float(over[:, 0].min()))
    high = min(float(under[:, 0].max()), float(over[:, 0].max()))
    for x in (np.linspace(low, high, 9), np.unique(np.concatenate([under[:, 0], over[:, 0]]))):
        lift = lift_over(under, over, rules.gap, x)
        y_under, y_over = max(0.0, -lift), max(0.0, lift)
        width = max(float(under[:, 1].max()) + y_under, float(over[:, 1].max()) + y_over)
        if width > rules.width:
            return None
    return width, y_under, y_over


def _side_by_side(first: Floats, second: Floats, rules: SheetRules) -> _Fit | None:
    """Return how two strips lie side by side on the shortest bay, or None if the sheet is too narrow.

    Either of them may be the lower, the second may be turned, and the shorter lies at one end of the bay or the other.
    """
    length = float(max(np.ptp(first[:, 0]), np.ptp(second[:, 0])))
    fits = []
    for turned in (False, True):
        strips = (_at_corner(first), _at_corner(-second if turned else second))
        spare = [length - float(strip[:, 0].max()) for strip in strips]
        for x_first, x_second in sorted({(0.0, 0.0), (spare[0], spare[1])}):
            moved = (strips[0] + np.array([x_first, 0.0]), strips[1] + np.array([x_second, 0.0]))
            for lower in (0, 1):
                stacked = _stacked(moved[lower], moved[1 - lower], rules)
                if stacked is not None:
                    width, *heights = stacked
                    y_first, y_second = heights if lower == 0 else reversed(heights)
                    fits.append((width, turned, (x_first, y_first, False), (x_second, y_second, turned)))
    return _Fit(length, min(fits)[2:]) if fits else None


def _kinds(strips: Sequence[tuple[str, Floats]]) -> list[tuple[Floats, list[str]]]:
    """Return outlines that differ by more than 0.05 mm, with the marks of the strips of each."""
    kinds: list[tuple[Floats, list[str]]] = []
    for mark, outline in strips:
        corner = _at_corner(outline)
        for known, marks in kinds:
            if known.shape == corner.shape and float(np.abs(known - corner).max()) <= _SAME:
                marks.append(mark)
                break
        else:
            kinds.append((corner, [mark]))
    return kinds


def _bays(outlines: Sequence[Floats], rules: SheetRules) -> dict[Bay, _Fit]:
    """Return what fits on a sheet's width: every strip alone, and every pair that lies side by side."""
    bays: dict[Bay, _Fit] = {
        (i,): _Fit(float(outline[:, 0].max()), ((0.0, 0.0, False),)) for i, outline in enumerate(outlines)
    }
    for i, outline in enumerate(outlines):
        for j in range(i, len(outlines)):
            fit = _side_by_side(outline, outlines[j], rules)
            if fit is not None:
                bays[i, j] = fit
    return bays


def _sequences(bays: Mapping[Bay, _Fit], demand: Sequence[int], rules: SheetRules) -> list[tuple[Bay, ...]]:
    """Return the sets of bays that fit behind one another on the longest sheet, longest bay first."""
    ordered = sorted(bays, key=lambda bay: (-bays[bay].length, bay))
    room = max(rules.lengths)
    found: list[tuple[Bay, ...]] = []

    def search(bays_used: tuple[Bay, ...], first: int, left: float) -> None:
        for k in range(first, len(ordered)):
            bay = ordered[k]
            longer = (*bays_used, bay)
            used = [i for other in longer for i in other]
            if bays[bay].length > left + 1e-9 or len(found) >= _PATTERNS or any(used.count(i) > demand[i] for i in bay):
                continue
            found.append(longer)
            search(longer, k, left - bays[bay].length - rules.gap)

    search((), 0, room)
    return found


def _length_of(sheet: Sequence[Bay], bays: Mapping[Bay, _Fit], rules: SheetRules) -> float:
    """Return the shortest sheet that holds bays behind one another."""
    filled = math.fsum(bays[bay].length for bay in sheet) + rules.gap * (len(sheet) - 1)
    return min(length for length in rules.lengths if filled <= length + 1e-9)


def _fewest(
    patterns: Sequence[tuple[Bay, ...]], costs: Sequence[float], demand: Sequence[int]
) -> tuple[list[tuple[Bay, ...]], float]:
    """Return the sheets of the plan of least length, and the bound that the solver proves."""
    rows = np.zeros((len(demand), len(patterns)))
    for j, pattern in enumerate(patterns):
        for bay in pattern:
            for i in bay:
                rows[i, j] += 1.0
    times, answer = times_cut(np.array(costs) / 1000.0, LinearConstraint(rows, np.array(demand), np.inf))
    plan = [pattern for pattern, count in zip(patterns, times, strict=True) for _ in range(count)]
    return plan, 1000.0 * float(answer.mip_dual_bound or 0.0)


def _placed(plan: Iterable[tuple[Bay, ...]], bays: Mapping[Bay, _Fit], kinds: Sequence[tuple[Floats, list[str]]],
            originals: Mapping[str, Floats], rules: SheetRules) -> list[SheetUse]:  # fmt: skip
    """Return the sheets with the marks on them; bays that nobody needs are left out."""
    waiting = [sorted(marks) for _, marks in kinds]
    sheets = []
    for pattern in sorted(plan, key=lambda pattern: (-_length_of(pattern, bays, rules), pattern)):
        at, listed, kept = 0.0, [], []
        for bay in pattern:
            wanted = tuple(i for n, i in enumerate(bay) if len(waiting[i]) > bay[:n].count(i))
            if not wanted:
                continue
            fit = bays[wanted]
            for i, (x, y, turned) in zip(wanted, fit.places, strict=True):
                mark = waiting[i].pop(0)
                outline = originals[mark]
                corner = (-outline if turned else outline).min(axis=0)
                listed.append(PlacedStrip(mark, float(at + x - corner[0]), float(y - corner[1]), turned))
            at += fit.length + rules.gap
            kept.append(wanted)
        if kept:
            sheets.append(SheetUse(_length_of(kept, bays, rules), tuple(listed)))
    return sheets


def sheet_plan(strips: Iterable[tuple[str, Floats]], rules: SheetRules) -> SheetPlan:
    """Return the sheets for strips, given by mark and outline (n, 2) in mm with x along the ribs.

    The integer programme runs over all sets of bays that fit on a sheet. If these are too many, two strips share a
    width nowhere and the plan is that of their lengths alone, without a bound where a pair would have fitted.
    """
    listed = dict(sorted(strips, key=lambda strip: strip[0]))
    room = max(rules.lengths), rules.width
    originals = {mark: outline for mark, outline in listed.items() if np.all(np.ptp(outline, axis=0) <= room)}
    refused = tuple(mark for mark in listed if mark not in originals)
    if not originals:
        return SheetPlan((), rules.width, 0.0, 0.0, 0.0, refused)
    kinds = _kinds(list(originals.items()))
    demand = [len(marks) for _, marks in kinds]
    bays = _bays([outline for outline, _ in kinds], rules)
    usual = cutting_plan(
        (Piece(mark, float(np.ptp(outline[:, 0]))) for mark, outline in originals.items()),
        StockRules(rules.lengths, rules.gap, 0.0),
    )
    patterns = _sequences(bays, demand, rules)
    if len(patterns) >= _PATTERNS:
        kind_of = {mark: i for i, (_, marks) in enumerate(kinds) for mark in marks}
        plan: list[tuple[Bay, ...]] = [
            tuple((kind_of[cut.pieces[0].mark],) for cut in board.cuts) for board in usual.boards
        ]
        bound = usual.bound if all(len(bay) == 1 for bay in bays) else 0.0
    else:
        plan, bound = _fewest(patterns, [_length_of(pattern, bays, rules) for pattern in patterns], demand)
    return SheetPlan(
        tuple(_placed(plan, bays, kinds, originals, rules)),
        rules.width,
        math.fsum(polygon_area(outline) for outline in originals.values()),
        bound,
        usual.first_fit_decreasing,
        refused,
    )
