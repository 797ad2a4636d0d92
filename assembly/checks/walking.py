"""What all walks over a plan ask: whether its steps are numbered in order, what is forced before what, what stands."""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping

import numpy as np

from aag_cad.units import Floats
from assembly.base.steps import Plan


def numbering_problems(plan: Plan) -> Iterator[str]:
    """Yield what is wrong with the numbers, ids and predecessors of any plan."""
    seen: set[str] = set()
    for i, step in enumerate(plan.steps, start=1):
        if step.number != i:
            yield f"step {step.id}: number {step.number}, expected {i}"
        if step.id in seen:
            yield f"step {step.id}: the id stands twice"
        for before in step.predecessors:
            if before not in seen:
                yield f"step {step.id}: predecessor {before} does not come before it"
        seen.add(step.id)


def crew_problems(plan: Plan, people: int | None) -> Iterator[str]:
    """Yield the steps that nobody does, or that take more people than there are (None: any number)."""
    for step in plan.steps:
        if step.crew < 1 or (people is not None and step.crew > people):
            yield f"step {step.id}: {step.crew} people, allowed 1 to {'any' if people is None else people}"


def time_problems(plan: Plan, times: Mapping[str, tuple[int, int]], people: int) -> Iterator[str]:
    """Yield the steps that end before they begin, begin too soon, or need more people at a time than there are.

    ``times`` are the minutes of work from the start at which each step begins and ends, by its id.
    """
    changes = Counter[int]()
    for step in plan.steps:
        start, end = times[step.id]
        if not 0 <= start <= end:
            yield f"step {step.id}: from minute {start} to {end}, allowed 0 or later and no end before its start"
        for before in (before for before in step.predecessors if before in times):
            if times[before][1] > start:
                yield f"step {step.id}: begins at minute {start}, but {before} ends at {times[before][1]}"
        changes[start] += step.crew
        changes[end] -= step.crew
    busy = 0
    for minute in sorted(changes):
        busy += changes[minute]
        if busy > people:
            yield f"minute {minute}: {busy} people at work, allowed {people}"


def once_problems(plan: Plan, parts: Iterable[str], excused: Collection[str] = ()) -> Iterator[str]:
    """Yield the parts that no step adds, unless they are excused, or several; and what is added, but is no part."""
    placed = Counter(mark for step in plan.steps for mark in step.marks)
    wanted = set(parts)
    for mark in sorted(wanted - set(placed) - set(excused)):
        yield f"{mark}: no step adds it"
    for mark in sorted(set(placed) - wanted):
        yield f"{mark}: a step adds it, but there is no such part"
    for mark, count in sorted(placed.items()):
        if count > 1:
            yield f"{mark}: {count} steps add it, allowed 1"


def ancestors(plan: Plan) -> dict[str, set[str]]:
    """Return for each step the ids of all steps that its predecessors force before it."""
    found: dict[str, set[str]] = {}
    for step in plan.steps:
        found[step.id] = set(step.predecessors)
        for before in step.predecessors:
            found[step.id] |= found.get(before, set())
    return found


def surrounds(corners: Floats, point: Floats) -> bool:
    """Return whether a point (2,) lies inside the convex hull of points (n, 2): they leave no half of its view free."""
    away = corners - point
    angles = np.sort(np.arctan2(away[:, 1], away[:, 0]))
    gaps = np.diff(np.append(angles, angles[0] + 2.0 * np.pi))
    return bool(len(angles) > 2 and gaps.max() < np.pi)
