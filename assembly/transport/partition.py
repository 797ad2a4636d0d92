"""The best cuts of a chain or a ring: fewest pieces, then fewest cut beams, then balanced masses; exact."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import TypeAlias

Fits: TypeAlias = Callable[[int, int], bool]
Mass: TypeAlias = Callable[[int, int], int]
Cost: TypeAlias = Callable[[int], int]


@dataclass(frozen=True, order=True)
class Cuts:
    """A set of cuts in the order in which sets are preferred: pieces, cut beams, sum of squared masses, stops.

    At a given number of pieces and a given total mass, the least sum of squares is the least variance of the masses.
    """

    pieces: int
    cut_beams: int
    squares: int
    stops: tuple[int, ...]


def _fewest(stops: Sequence[int], cost: Cost, fits: Fits) -> dict[int, tuple[int, int]]:
    """Return (pieces, cut beams) of the best cuts from each stop to the last; stops without any are left out."""
    last = stops[-1]
    rest = {last: (0, 0)}
    for i in range(len(stops) - 2, -1, -1):
        start = stops[i]
        found = [
            (rest[end][0] + 1, rest[end][1] + (cost(end) if end != last else 0))
            for end in stops[i + 1 :]
            if end in rest and fits(start, end)
        ]
        if found:
            rest[start] = min(found)
    return rest


def best_chain(stops: Sequence[int], cost: Cost, fits: Fits, mass: Mass) -> Cuts | None:
    """Return the best cuts of a chain whose first and last stops are its ends, or None if no cuts will do.

    ``cost(stop)`` is the number of beams cut at an inner stop, ``fits(a, b)`` whether there may be a piece between two
    stops, ``mass(a, b)`` its mass, a whole number so that sums are exact. Dynamic programming from the far end: all
    criteria add up along the chain, so the best rest does not depend on what came before it. Masses are asked for only
    where pieces and cut beams are fewest.
    """
    first, last = stops[0], stops[-1]
    rest = _fewest(stops, cost, fits)
    if first not in rest:
        return None
    place = {stop: i for i, stop in enumerate(stops)}

    @cache
    def balanced(start: int) -> tuple[int, tuple[int, ...]]:
        if start == last:
            return 0, ()
        found = []
        for end in stops[place[start] + 1 :]:
            inner = end != last
            paid = cost(end) if inner else 0
            if end in rest and (rest[end][0] + 1, rest[end][1] + paid) == rest[start] and fits(start, end):
                squares, after = balanced(end)
                found.append((squares + mass(start, end) ** 2, (end, *after) if inner else ()))
        return min(found)

    return Cuts(*rest[first], *balanced(first))


def best_ring(stops: Sequence[int], around: int, cost: Cost, fits: Fits, mass: Mass) -> Cuts | None:
    """Return the best cuts of a closed ring, or None; ``around`` is what one turn adds to a stop.

    ``fits(a, b)`` and ``mass(a, b)`` are asked with a < b, the far one a turn on where needed, and for the first stop
    and itself a turn on: that is the uncut ring. One cut alone opens a ring and divides nothing, so there are none or
    at least two; the chain is solved for each stop as the lowest cut, with masses for the best of these only.
    """
    start = stops[0]
    if fits(start, start + around):
        return Cuts(1, 0, mass(start, start + around) ** 2, ())

    def divided(a: int, b: int) -> bool:
        return b - a < around and fits(a, b)

    chains = [(*stops[i:], stop + around) for i, stop in enumerate(stops)]
    fewest = []
    for chain in chains:
        rest = _fewest(chain, cost, divided)
        if chain[0] in rest:
            pieces, beams = rest[chain[0]]
            fewest.append((pieces, beams + cost(chain[0]), chain))
    found = []
    for pieces, beams, chain in fewest:
        if (pieces, beams) == min(entry[:2] for entry in fewest):
            best = best_chain(chain, cost, divided, mass)
            assert best is not None
            found.append(Cuts(pieces, beams, best.squares, (chain[0], *best.stops)))
    return min(found, default=None)
