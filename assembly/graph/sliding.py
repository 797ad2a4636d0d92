"""Whether a plank can be slid in along its own axis between others that lie: its bends and its free way."""

import math
from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, TypeAlias

import numpy as np

from aag_cad.units import Floats
from assembly.base.shell_axes import best_plane
from assembly.graph.laying_units import PARALLEL, Meeting, Overlap, Unit

End: TypeAlias = Literal["start", "end"]
Why: TypeAlias = Literal["upright", "kept", "unknown", "radius", "length"]

# Heights and places on the floor that differ by less are taken for the same, mm.
SAME = 1.0


@dataclass(frozen=True)
class Hindrance:
    """Why a unit cannot be slid in, with the figure found and the one needed, mm (0 where there is none).

    It stands upright; its graph keeps it from sliding; depths or radius are unknown; it bends too much; too little of
    the floor is free.
    """

    why: Why
    found: float = 0.0
    needed: float = 0.0


@dataclass(frozen=True)
class Sliding:
    """How a unit can be slid in: from which end, what is free beyond it, to which radius it bends; mm, or infinite.

    It cannot if there is a hindrance.
    """

    unit: str
    end: End
    free: float
    radius: float
    hindrances: tuple[Hindrance, ...]


def layer_heights(units: Iterable[Unit]) -> dict[int, float]:
    """Return the height of the middle of each layer, mm, when every layer is as deep as its deepest unit.

    Units without a layer count as layer 0.
    """
    depths: dict[int, float] = defaultdict(float)
    for unit in units:
        depths[unit.layer or 0] = max(depths[unit.layer or 0], unit.depth or 0.0)
    heights: dict[int, float] = {}
    top = 0.0
    for layer in sorted(depths):
        heights[layer] = top + depths[layer] / 2.0
        top += depths[layer]
    return heights


def bend_radius(spacing: float, height: float) -> float:
    """Return the radius of the two equal arcs that lead over a height within a spacing, R = a^2 / 4h; mm."""
    return spacing**2 / (4.0 * height) if height > SAME else math.inf


def smallest_bend(
    unit: Unit, overlaps: Sequence[Overlap], units: Mapping[str, Unit], heights: Mapping[int, float]
) -> float | None:
    """Return the smallest radius to which a unit bends from over one crossing to under the next; None if unknown, mm.

    The units that it crosses lie straight, each at the height of its layer. Infinite if it need not bend.
    """
    places = sorted((at.upper_mm, "over", at.joint, at.lower) for at in overlaps if at.upper == unit.mark)
    places += sorted((at.lower_mm, "under", at.joint, at.upper) for at in overlaps if at.lower == unit.mark)
    smallest = math.inf
    for (x, side, _, one), (y, next_side, _, other) in pairwise(sorted(places)):
        if side == next_side:
            continue
        below, above = (units[one], units[other]) if side == "over" else (units[other], units[one])
        if unit.depth is None or below.depth is None or above.depth is None:
            return None
        room = heights[above.layer or 0] - heights[below.layer or 0] - (below.depth + above.depth) / 2.0
        smallest = min(smallest, bend_radius(y - x, unit.depth - room))
    return smallest


def _floor(units: Sequence[Unit], absent: Collection[str]) -> Floats:
    """Return the lines of units of one shell on the floor, (n, 2, 2) mm: in the plane nearest to all that lie."""
    points = np.array([(unit.start, unit.end) for unit in units], dtype=np.float64)
    lying = [unit.mark not in absent for unit in units]
    axes = best_plane((points[lying] if any(lying) else points).reshape(-1, 3))[:2]
    return np.asarray(points @ axes.T)


def _cross(a: Floats, b: Floats) -> Floats:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def free_way(origin: Floats, direction: Floats, lines: Floats) -> float:
    """Return how far a ray (2,), (2,) of unit direction runs until the first of the lines (n, 2, 2); mm, or infinite.

    A line that ends within 1 mm of the ray or begins within 1 mm before it counts; one that lies along it, too.
    """
    if not len(lines):
        return math.inf
    run, gap = lines[:, 1] - lines[:, 0], lines[:, 0] - origin
    length = np.linalg.norm(run, axis=1)
    turn = _cross(direction, run)
    level = np.abs(turn) <= PARALLEL * np.maximum(length, SAME)
    safe = np.where(level, 1.0, turn)
    along, share = _cross(gap, run) / safe, _cross(gap, direction) / safe
    slack = SAME / np.maximum(length, SAME)
    hit = ~level & (along > -SAME) & (share >= -slack) & (share <= 1.0 + slack)
    ends = (lines - origin) @ direction
    on_axis = level & (np.abs(_cross(gap, direction)) <= SAME) & (ends.max(axis=1) > -SAME)
    found = np.where(hit, along, np.where(on_axis, ends.min(axis=1), math.inf))
    return max(0.0, round(float(found.min()), 3)) if np.any(hit | on_axis) else math.inf


def _beyond(line: Floats, others: Floats) -> tuple[float, float]:
    """Return what is free beyond the start and beyond the end of a line, mm."""
    run = line[1] - line[0]
    length = float(np.linalg.norm(run))
    if length <= SAME:
        return 0.0, 0.0
    return free_way(line[0], -run / length, others), free_way(line[1], run / length, others)


def _way(unit: Unit, free: tuple[float, float], meetings: Sequence[Meeting]) -> tuple[End, float]:
    """Return the end with more free floor, the start if both have the same; an end that meets another has none."""
    blocked = [False, False]
    for meeting in meetings:
        station = meeting.stations[meeting.units.index(unit.mark)]
        blocked[int(station > unit.length / 2.0)] = True
    start, end = (0.0 if stopped else length for stopped, length in zip(blocked, free, strict=True))
    return ("end", end) if end > start + SAME else ("start", start)


def _hindrances(unit: Unit, free: float, radius: float | None) -> Iterable[Hindrance]:
    if not unit.slides:
        yield Hindrance("upright" if unit.upright else "kept")
    if radius is None or (math.isfinite(radius) and unit.min_radius is None):
        yield Hindrance("unknown")
    elif unit.min_radius is not None and radius < unit.min_radius:
        yield Hindrance("radius", radius, unit.min_radius)
    if free < unit.length:
        yield Hindrance("length", free, unit.length)


def slidings(
    wanted: Iterable[str],
    units: Mapping[str, Unit],
    overlaps: Iterable[Overlap],
    meetings: Iterable[Meeting],
    absent: Collection[str],
) -> dict[str, Sliding]:
    """Return how each of the wanted units can be slid in when all others of its shell lie but those that are absent.

    A unit that it crosses at a joint is no hindrance on the floor: it passes over or under it.
    """
    heights = layer_heights(units.values())
    passed: dict[str, list[Overlap]] = defaultdict(list)
    met: dict[str, list[Meeting]] = defaultdict(list)
    for overlap in overlaps:
        passed[overlap.lower].append(overlap)
        passed[overlap.upper].append(overlap)
    for meeting in meetings:
        one, other = meeting.units
        met[one] += [meeting] if other not in absent else []
        met[other] += [meeting] if one not in absent else []
    shells: dict[str, list[Unit]] = defaultdict(list)
    for unit in units.values():
        shells[unit.shell].append(unit)
    floors = {shell: _floor(listed, absent) for shell, listed in shells.items()}
    lying = {shell: np.array([unit.mark not in absent for unit in listed]) for shell, listed in shells.items()}
    rows = {unit.mark: i for listed in shells.values() for i, unit in enumerate(listed)}
    found = {}
    for mark in wanted:
        unit = units[mark]
        lines, others = floors[unit.shell], lying[unit.shell].copy()
        partners = {m for at in passed[mark] for m in (at.lower, at.upper) if units[m].shell == unit.shell}
        others[[rows[m] for m in sorted({mark, *partners})]] = False
        end, free = _way(unit, _beyond(lines[rows[mark]], lines[others]), met[mark])
        radius = smallest_bend(unit, passed[mark], units, heights)
        hindrances = tuple(_hindrances(unit, free, radius))
        found[mark] = Sliding(mark, end, free, math.inf if radius is None else radius, hindrances)
    return found
