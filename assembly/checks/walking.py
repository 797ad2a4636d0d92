"""What all walks over a plan ask: whether its steps are numbered in order, what is forced before what, what stands."""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator

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
