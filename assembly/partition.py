"""The best cuts of a chain or a ring: fewest pieces, then fewest cut beams, then balanced masses; exact."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

Weigh: TypeAlias = Callable[[int, int], int | None]
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


def best_chain(stops: Sequence[int], cost: Cost, weigh: Weigh) -> Cuts | None:
    """Return the best cuts of a chain whose first and last stops are its ends, or None if no cuts will do.

    ``cost(stop)`` is the number of beams cut at an inner stop; ``weigh(a, b)`` the mass of the piece between two stops
    (a whole number, so that sums are exact), None if there is no such piece or it must not be. Dynamic programming from
    the far end: all four criteria add up along the chain, so the best rest does not depend on what came before it.
    """
    last = stops[-1]
    rest: dict[int, Cuts | None] = {last: Cuts(0, 0, 0, ())}
    for i in range(len(stops) - 2, -1, -1):
        start, found = stops[i], []
        for end in stops[i + 1 :]:
            after = rest[end]
            mass = None if after is None else weigh(start, end)
            if after is None or mass is None:
                continue
            inner = end != last
            found.append(
                Cuts(
                    after.pieces + 1,
                    after.cut_beams + (cost(end) if inner else 0),
                    after.squares + mass**2,
                    (end, *after.stops) if inner else (),
                )
            )
        rest[start] = min(found, default=None)
    return rest[stops[0]]


def best_ring(stops: Sequence[int], around: int, cost: Cost, weigh: Weigh, whole: int | None) -> Cuts | None:
    """Return the best cuts of a closed ring, or None; ``around`` is what one turn adds to a stop.

    ``weigh(a, b)`` is asked with a < b, the far one a turn on where needed; ``whole`` is the mass of the uncut ring, or
    None if that must not be. One cut alone opens a ring and divides nothing, so there are none or at least two; the
    chain is solved once for each stop as the lowest cut.
    """
    found = [] if whole is None else [Cuts(1, 0, whole**2, ())]
    for i, first in enumerate(stops):
        end = first + around

        def opened(a: int, b: int, first: int = first, end: int = end) -> int | None:
            return None if (a, b) == (first, end) else weigh(a, b)

        chain = best_chain((first, *stops[i + 1 :], end), cost, opened)
        if chain is not None:
            found.append(Cuts(chain.pieces, chain.cut_beams + cost(first), chain.squares, (first, *chain.stops)))
    return min(found, default=None)
