"""Cutting stock: which boards to buy and what is cut from each, with the least length bought, and the proof of it.

A board is cut to length first and then split, so each cut of a board gives ``planks_per_board`` pieces; the shorter
ones are cut back to their own length. Sorted by length, the k-th longest cut can never be shorter than piece number
(k - 1) planks_per_board + 1. Grouping neighbours in that order reaches this for every k, so no other grouping needs
less, and what is left is the cutting-stock problem of Gilmore and Gomory (1961) over several stock lengths.
"""

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
from scipy.optimize import LinearConstraint, linprog, milp

from aag_cad.units import Floats

# Limits of work and not of time: a plan must not depend on the speed of the machine.
_BRANCHES = 300_000
_COLUMNS_AT_A_TIME = 3
_PATTERNS = 20_000
_NODES = 300
_SLACK = 1e-7

Pattern: TypeAlias = tuple[int, ...]
Column: TypeAlias = tuple[Pattern, int]


@dataclass(frozen=True)
class StockRules:
    """What is bought and how it is sawn: stock lengths, width of a saw cut, loss at each end, mm."""

    lengths: tuple[float, ...]
    kerf: float
    trim: float
    planks_per_board: int = 1

    @property
    def longest_cut(self) -> float:
        """The longest piece that the longest stock gives, mm."""
        return max(self.lengths) - 2.0 * self.trim


@dataclass(frozen=True)
class Piece:
    """A piece to be cut: mark, length in mm, and which one it is of the pieces that are jointed into the part."""

    mark: str
    length: float
    number: int = 1
    of: int = 1


@dataclass(frozen=True)
class Cut:
    """A cut of a board: position of its start from the start of the board, length, and the pieces split from it."""

    position: float
    length: float
    pieces: tuple[Piece, ...]


@dataclass(frozen=True)
class Board:
    """A board (or bar) as bought, and its cuts from one end to the other."""

    length: float
    cuts: tuple[Cut, ...]


@dataclass(frozen=True)
class CuttingPlan:
    """Boards to buy, lengths in mm; no plan buys less than ``bound``, ``relaxation`` is that of the linear programme.

    ``first_fit_decreasing`` is what the usual rule of thumb would buy. ``refused`` pieces are longer than every stock.
    """

    boards: tuple[Board, ...]
    planks_per_board: int
    bound: float
    relaxation: float
    first_fit_decreasing: float
    refused: tuple[Piece, ...]

    @property
    def bought(self) -> float:
        """Length of all boards, mm."""
        return sum(board.length for board in self.boards)

    @property
    def used(self) -> float:
        """Length of all pieces as length of board, mm."""
        pieces = (piece.length for board in self.boards for cut in board.cuts for piece in cut.pieces)
        return math.fsum(pieces) / self.planks_per_board

    @property
    def waste(self) -> float:
        """Length of board that ends as kerf, trimmed ends and offcuts, mm."""
        return self.bought - self.used

    @property
    def waste_percent(self) -> float:
        """Waste as a share of what is bought, per cent."""
        return 100.0 * self.waste / self.bought if self.boards else 0.0

    @property
    def proven(self) -> bool:
        """Whether no plan can buy less."""
        return self.bought <= self.bound + _SLACK


@dataclass(frozen=True)
class _Demand:
    """The problem: sizes and rooms with one kerf each, in a common measure; stock in tenths of a millimetre, rising."""

    sizes: tuple[int, ...]
    demand: tuple[int, ...]
    stock: tuple[int, ...]
    room: tuple[int, ...]

    @property
    def step(self) -> int:
        """All that can be bought is a multiple of this."""
        return math.gcd(*self.stock)


def _tenths(length: float) -> int:
    return round(10.0 * length)


def _demand(sizes: Counter[int], rules: StockRules) -> _Demand:
    kerf, trim = _tenths(rules.kerf), _tenths(rules.trim)
    ordered = sorted(sizes, reverse=True)
    stock = sorted({_tenths(length) for length in rules.lengths})
    net = tuple(size + kerf for size in ordered)
    room = tuple(length - 2 * trim + kerf for length in stock)
    common = math.gcd(*net)
    return _Demand(
        tuple(size // common for size in net),
        tuple(sizes[size] for size in ordered),
        tuple(stock),
        tuple(length // common for length in room),
    )


def _shortest_stock(wanted: _Demand, pattern: Pattern) -> int:
    """Return the index of the shortest stock that holds a pattern."""
    filled = sum(count * size for count, size in zip(pattern, wanted.sizes, strict=True))
    return next(i for i, room in enumerate(wanted.room) if filled <= room)


def _first_fit_decreasing(wanted: _Demand) -> list[Column]:
    """Return the boards of the rule of thumb: longest pieces first, each into the first board with room for it.

    Boards are opened in the longest stock; in the end each becomes the shortest stock that holds what is in it.
    """
    boards: list[list[int]] = []
    left: list[int] = []
    for i, (size, count) in enumerate(zip(wanted.sizes, wanted.demand, strict=True)):
        for _ in range(count):
            place = next((b for b, room in enumerate(left) if size <= room), len(boards))
            if place == len(boards):
                boards.append([0] * len(wanted.sizes))
                left.append(wanted.room[-1])
            boards[place][i] += 1
            left[place] -= size
    return [(tuple(board), _shortest_stock(wanted, tuple(board))) for board in boards]


def _by_rate(values: Floats, wanted: _Demand) -> list[int]:
    """Return the pieces that are worth anything, best value for their length first."""
    return [int(i) for i in np.argsort(-values / np.array(wanted.sizes), kind="stable") if values[i] > 0.0]


def _divisible_worth(values: Floats, wanted: _Demand, room: int) -> float:
    """Return what a room would be worth if pieces could be cut through: no pattern is worth more (Dantzig 1957)."""
    worth, left = 0.0, room
    for i in _by_rate(values, wanted):
        filled = min(left, wanted.demand[i] * wanted.sizes[i])
        worth += values[i] * filled / wanted.sizes[i]
        left -= filled
    return worth


def _patterns_worth(
    values: Floats, wanted: _Demand, room: int, worth: float, rising: bool = False
) -> tuple[list[Pattern], bool]:
    """Return patterns that fit into a room and are worth more than a value, and whether these are all of them.

    If ``rising``, each is worth more than the one before it, and the last is the best of all. Depth first; a branch
    ends where even its rest, filled without gaps at the next best rate, is worth too little.
    """
    order = _by_rate(values, wanted)
    found: list[Pattern] = []
    counts = [0] * len(wanted.sizes)
    branches, least = 0, worth

    def search(depth: int, left: int, value: float) -> bool:
        nonlocal branches, least
        branches += 1
        if depth == len(order):
            if value > least:
                found.append(tuple(counts))
                least = value + _SLACK if rising else worth
            return len(found) < _PATTERNS and branches < _BRANCHES
        i = order[depth]
        if value + left * values[i] / wanted.sizes[i] <= least:
            return branches < _BRANCHES
        for count in range(min(wanted.demand[i], left // wanted.sizes[i]), -1, -1):
            counts[i] = count
            if not search(depth + 1, left - count * wanted.sizes[i], value + count * values[i]):
                return False
        return True

    return found, search(0, room, 0.0)


def _matrix(columns: Sequence[Column]) -> Floats:
    return np.array([pattern for pattern, _ in columns], dtype=np.float64).T


def _relaxation(wanted: _Demand, columns: list[Column]) -> tuple[float, Floats]:
    """Return a lower bound of what any plan buys, in steps, and the duals (n,) that prove it.

    Column generation (Gilmore and Gomory 1961); new patterns are added to ``columns``. It ends when no pattern is worth
    more than its stock: the bound is that of the linear programme over all patterns. Where the search for one has to be
    broken off, the duals are scaled until none can be (Farley 1990).
    """
    known = set(columns)
    while True:
        costs = [wanted.stock[i] / wanted.step for _, i in columns]
        answer = linprog(costs, A_ub=-_matrix(columns), b_ub=-np.array(wanted.demand), method="highs")
        duals = np.maximum(0.0, -np.asarray(answer.ineqlin.marginals, dtype=np.float64))
        fresh: list[Column] = []
        excess = 1.0
        for i, (stock, room) in enumerate(zip(wanted.stock, wanted.room, strict=True)):
            patterns, complete = _patterns_worth(duals, wanted, room, stock / wanted.step + _SLACK, rising=True)
            fresh += [(pattern, i) for pattern in patterns[-_COLUMNS_AT_A_TIME:] if (pattern, i) not in known]
            if not complete:
                excess = max(excess, _divisible_worth(duals, wanted, room) * wanted.step / stock)
        if not fresh:
            return float(duals @ np.array(wanted.demand)) / excess, duals / excess
        known.update(fresh)
        columns += fresh


def times_cut(costs: Floats, *limits: LinearConstraint) -> tuple[list[int], Any]:
    """Return how often each pattern is cut so that all costs least, 0 if no plan is found, and the solver's answer."""
    whole = np.ones(len(costs), dtype=np.int64)
    answer = milp(costs, integrality=whole, constraints=limits, options={"mip_rel_gap": 0.0, "node_limit": _NODES})
    return [0] * len(costs) if answer.x is None else [round(x) for x in answer.x], answer


def _bought(wanted: _Demand, boards: Iterable[Column]) -> int:
    return sum(wanted.stock[i] for _, i in boards) // wanted.step


def _improved(wanted: _Demand, plan: list[Column], columns: Sequence[Column], lower: int) -> tuple[list[Column], bool]:
    """Return a plan or the best from given patterns if that buys less, and whether the search for it came to its end.

    That no plan buys less than ``lower`` steps is known, and lets the search end as soon as one is found.
    """
    costs = np.array([wanted.stock[i] / wanted.step for _, i in columns])
    enough = LinearConstraint(_matrix(columns), np.array(wanted.demand), np.inf)
    times, answer = times_cut(costs, enough, LinearConstraint(costs[None], lower, np.inf))
    found = [column for column, count in zip(columns, times, strict=True) for _ in range(count)]
    return (found if found and _bought(wanted, found) < _bought(wanted, plan) else plan), answer.status == 0


def _solved(wanted: _Demand) -> tuple[list[Column], int, float, int]:
    """Return the best plan's boards, its lower bound and the linear programme's, and first-fit-decreasing; in steps.

    If the plan from the generated patterns misses the bound, the integer programme is solved again over all patterns
    whose reduced cost is less than the gap: no better plan holds any other.
    """
    best = usual = _first_fit_decreasing(wanted)
    singles = [tuple(row) for row in np.eye(len(wanted.sizes), dtype=int).tolist()]
    columns = sorted({*usual, *((single, _shortest_stock(wanted, single)) for single in singles)})
    relaxed, duals = _relaxation(wanted, columns)
    lower = math.ceil(relaxed - 1e-6)
    if _bought(wanted, best) > lower:
        best, _ = _improved(wanted, best, columns, lower)
    if _bought(wanted, best) > lower:
        gap = _bought(wanted, best) - 1.0 - relaxed
        near, complete = set(best), True
        for i, (stock, room) in enumerate(zip(wanted.stock, wanted.room, strict=True)):
            patterns, ended = _patterns_worth(duals, wanted, room, stock / wanted.step - gap - 1e-6)
            near.update((pattern, i) for pattern in patterns if any(pattern))
            complete = complete and ended
        best, solved = _improved(wanted, best, sorted(near), lower)
        if solved and complete:
            lower = _bought(wanted, best)
    return best, lower, relaxed, _bought(wanted, usual)


def grouped_pieces(pieces: Iterable[Piece], planks_per_board: int) -> list[tuple[Piece, ...]]:
    """Return what is split from the same cut: neighbours by length, longest first; the last group may be smaller."""
    ordered = sorted(pieces, key=lambda piece: (-piece.length, piece.mark, piece.number))
    return [tuple(ordered[i : i + planks_per_board]) for i in range(0, len(ordered), planks_per_board)]


def _boards(
    wanted: _Demand, plan: Iterable[Column], groups: Sequence[tuple[Piece, ...]], rules: StockRules
) -> list[Board]:
    """Return the plan with its pieces: cuts that nobody needs are left out, and boards as short as that allows."""
    lengths = sorted({group[0].length for group in groups}, reverse=True)
    waiting = [[group for group in groups if group[0].length == length] for length in lengths]
    filled: list[tuple[int, list[tuple[Piece, ...]]]] = []
    for pattern, _ in sorted(plan, key=lambda column: (column[1], column[0]), reverse=True):
        taken = [min(count, len(left)) for count, left in zip(pattern, waiting, strict=True)]
        cuts = [left.pop(0) for count, left in zip(taken, waiting, strict=True) for _ in range(count)]
        if cuts:
            filled.append((wanted.stock[_shortest_stock(wanted, tuple(taken))], cuts))
    filled.sort(key=lambda item: (-item[0], [-group[0].length for group in item[1]], item[1][0][0].mark))
    boards = []
    for length, cuts in filled:
        position, listed = _tenths(rules.trim), []
        for group in cuts:
            listed.append(Cut(position / 10.0, group[0].length, group))
            position += _tenths(group[0].length) + _tenths(rules.kerf)
        boards.append(Board(length / 10.0, tuple(listed)))
    return boards


def cutting_plan(pieces: Iterable[Piece], rules: StockRules) -> CuttingPlan:
    """Return the boards that give all pieces with the least length bought; lengths count in tenths of a millimetre.

    Pieces longer than every stock are refused, not an error. The bound is that of the linear programme, rounded up to
    what can be bought, or the optimum itself where the integer programme is searched to its end.
    """
    rounded = [replace(piece, length=round(piece.length, 1)) for piece in pieces]
    fitting = [piece for piece in rounded if _tenths(piece.length) <= _tenths(rules.longest_cut)]
    refused = sorted(set(rounded) - set(fitting), key=lambda piece: (piece.mark, piece.number))
    groups = grouped_pieces(fitting, rules.planks_per_board)
    if not groups:
        return CuttingPlan((), rules.planks_per_board, 0.0, 0.0, 0.0, tuple(refused))
    wanted = _demand(Counter(_tenths(group[0].length) for group in groups), rules)
    plan, lower, relaxed, usual = _solved(wanted)
    boards, step = _boards(wanted, plan, groups, rules), wanted.step / 10.0
    bounds = lower * step, relaxed * step, usual * step
    return CuttingPlan(tuple(boards), rules.planks_per_board, *bounds, tuple(refused))
