"""Where a shell is cut so that each of its segments fits the transport: exact over all cuts along geodesics."""

import math
import re
from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise

import numpy as np

from assembly.base.errors import PlanError
from assembly.base.segments import Limits, Pose
from assembly.transport.cut_pieces import Divisible, Stretch, stop_splices, stretch_between
from assembly.transport.loading import best_pose
from assembly.transport.partition import best_chain, best_ring

_ROUNDING = 1e-9
_GRAMS = 1000.0
_WIDEST = 4.0
_HALVINGS = 6
_ENDLESS = 100.0


_FORM = re.compile(r"\s*[x\u00d7]\s*", re.IGNORECASE)
_PLACES = ("length", "width", "height", "mass", "crane")


def limits_from(text: str, option: str = "--transport") -> Limits:
    """Return the limits written as length x width x height in mm, load and crane in kg: ``12000x2400x2400x3000x500``.

    Load and crane may be left out: then nothing limits the mass. PlanError with the option, the value and the form.
    """
    form = (
        "write length x width x height in mm, then, if they limit it, the load and what the crane lifts in kg, each "
        "more than 0: 12000x2400x2400, 12000x2400x2400x3000 or 12000x2400x2400x3000x500"
    )
    places = _FORM.split(text.strip())
    if not 3 <= len(places) <= len(_PLACES):
        raise PlanError(f"{option} {text!r}: {len(places)} numbers, allowed 3 to {len(_PLACES)}; {form}")
    sizes: dict[str, float] = {}
    for name, place in zip(_PLACES, places, strict=False):
        try:
            sizes[name] = float(place)
        except ValueError as error:
            raise PlanError(f"{option} {text!r}: {name} = {place!r} is no number; {form}") from error
        if not (0.0 < sizes[name] < math.inf):
            raise PlanError(f"{option} {text!r}: {name} = {place}, allowed more than 0; {form}")
    return Limits(**{"mass": math.inf, **sizes})


def pose_in(stretch: Stretch, limits: Limits, enough: float = 0.0) -> Pose:
    """Return the pose of a stretch that leaves most room in the transport.

    Where a side of the transport has no limit it counts as far longer than any other; without any limit the smallest
    cube decides.
    """
    known = [size for size in limits.room if math.isfinite(size)]
    if len(known) == len(limits.room):
        return best_pose(stretch.corners, limits.room, enough)
    far = _ENDLESS * max(known, default=float(np.ptp(stretch.corners, axis=0).max()))
    length, width, height = (size if math.isfinite(size) else far for size in limits.room)
    return best_pose(stretch.corners, (length, width, height), enough)


def fits(stretch: Stretch, limits: Limits) -> bool:
    """Return whether a stretch is light enough and a pose was found in which it fits."""
    extents = np.ptp(stretch.corners, axis=0)
    # Too long for the room's diagonal, or smaller in every direction than the room in any: no pose need be sought.
    if stretch.mass > limits.load or float(extents.max()) > math.hypot(*limits.room):
        return False
    if math.hypot(*extents.tolist()) <= min(limits.room):
        return True
    return pose_in(stretch, limits, 1.0).filling <= 1.0 + _ROUNDING


def furthest(stops: Sequence[int], count: int, fitting: Callable[[int, int], bool]) -> dict[int, int]:
    """Return for each of the first ``count`` stops the furthest stop to which the stretch between them fits.

    What lies between two stops also lies between any two around them, so the furthest one never goes back: about two
    looks per stop are enough. A stop from which nothing fits is its own furthest.
    """
    found, j = {}, 0
    for i in range(count):
        j = max(j, i)
        while j + 1 < len(stops) and fitting(stops[i], stops[j + 1]):
            j += 1
        found[stops[i]] = stops[j]
    return found


def _owns(item: Divisible, start: int, end: int) -> bool:
    """Return whether a stretch keeps a geodesic and has two different lines as its sides."""
    return bool(item.grid.owned(start, end)) and start // 2 != end // 2


def best_stops(item: Divisible, limits: Limits) -> tuple[int, ...] | None:
    """Return the stops at which a shell is cut, () to carry it whole, None if no cuts along geodesics make it fit.

    Fewest segments, then fewest cut beams (a beam cut twice counts twice), then least variance of the masses to the
    gram, then the lowest stops. Each segment keeps at least one geodesic.
    """
    grid = item.grid
    stops, turn = grid.stops(), 2 * len(grid.lines)
    ends = (stops[0], stops[0] + turn) if grid.ring else (stops[0], stops[-1])
    if fits(stretch_between(item, *ends), limits):
        return ()

    def fitting(start: int, end: int) -> bool:
        if grid.ring and end - start >= turn:
            return False
        return not _owns(item, start, end) or fits(stretch_between(item, start, end), limits)

    far = (*stops, *(stop + turn for stop in stops)) if grid.ring else stops
    reach = furthest(far, len(stops), fitting)

    @cache
    def allowed(start: int, end: int) -> bool:
        return end <= reach[start] and _owns(item, start, end)

    @cache
    def grams(start: int, end: int) -> int:
        return round(_GRAMS * stretch_between(item, start, end).mass)

    @cache
    def cost(stop: int) -> int:
        return sum(splice.kind == "block" for splice in stop_splices(item, stop))

    best = best_ring(stops, turn, cost, allowed, grams) if grid.ring else best_chain(stops, cost, allowed, grams)
    return None if best is None else best.stops


def segment_ends(item: Divisible, stops: tuple[int, ...]) -> list[tuple[int, int]]:
    """Return (start, end) of each segment for the stops at which a shell is cut."""
    grid = item.grid
    if grid.ring:
        around = (*stops, stops[0] + 2 * len(grid.lines)) if stops else (2, 2 + 2 * len(grid.lines))
        return list(pairwise(around))
    chain = (grid.stops()[0], *stops, grid.stops()[-1])
    return list(pairwise(chain))


def smallest_runs(item: Divisible) -> list[tuple[int, int]]:
    """Return the stretches that keep a single geodesic: what is left if a shell is cut along every one."""
    stops = item.grid.stops()
    far = (*stops, *(stop + 2 * len(item.grid.lines) for stop in stops)) if item.grid.ring else stops
    pairs = [(a, b) for a in stops for b in far if a < b <= a + 3 and _owns(item, a, b)]
    return [(a, b) for a, b in pairs if len(item.grid.owned(a, b)) == 1]


def least_widths(stretch: Stretch, limits: Limits) -> tuple[float | None, float | None]:
    """Return the least width and the least height, mm, that alone make a stretch fit; None if four times is too little.

    Each by halving, to an eightieth of the range in the worst case; the width found is that of a pose and so is enough.
    """

    def least(axis: int) -> float | None:
        low, high, found = limits.room[axis], _WIDEST * limits.room[axis], None
        for k in range(_HALVINGS + 1):
            tried = high if k == 0 else (low + high) / 2.0
            room = (limits.length, *(tried if i == axis else limits.room[i] for i in (1, 2)))
            pose = best_pose(stretch.corners, (room[0], room[1], room[2]), 1.0)
            if pose.filling <= 1.0 + _ROUNDING:
                high = found = pose.size[axis]
            elif k == 0:
                return None
            else:
                low = tried
            if high <= low:
                break
        return found

    return least(1), least(2)
