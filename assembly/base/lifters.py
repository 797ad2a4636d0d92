"""How many people a piece takes, and when it takes lifting gear."""

import math
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass

from aag_cad.findings import Finding
from aag_cad.language import text
from assembly.base.errors import PlanError
from assembly.base.mark_ranges import named_marks

LONG_PIECE = 3000.0


@dataclass(frozen=True)
class Lifters:
    """Those who carry: how many people at most, and what one of them may lift, kg."""

    people: int
    lift_limit: float


def lifters_of(people: int, lift_limit: float) -> Lifters:
    """Return the lifters; PlanError with the keys to mend if nobody is in it or nobody lifts anything."""
    if people < 1 or not lift_limit > 0.0:
        raise PlanError(
            f"crew: {people} people who lift {lift_limit:g} kg each; at least 1 person and more than 0 kg: "
            "mend crew.people and crew.lift_limit"
        )
    return Lifters(people, lift_limit)


@dataclass(frozen=True)
class Hands:
    """The people that a piece takes; ``gear`` if it is too heavy for all of them together."""

    people: int
    gear: bool


def hands_for(lifters: Lifters, mass_kg: float, length_mm: float) -> Hands:
    """Return the hands for the heaviest and the longest piece of a step; a piece over 3 m takes two people."""
    needed = max(math.ceil(mass_kg / lifters.lift_limit), 2 if length_mm > LONG_PIECE else 1)
    return Hands(min(needed, lifters.people), mass_kg > lifters.people * lifters.lift_limit)


def lifting_findings(weights: Mapping[str, tuple[float, float]], lifters: Lifters) -> tuple[Finding, ...]:
    """Return what is heavy (AAG955): warnings for what the whole crew cannot lift, notes for what takes several people.

    ``weights`` are (kg, mm) by mark, as in ``assembly.plan.assembly_plan.piece_weights``. A warning names all pieces of
    one mass, a note the heaviest of all that take so many people.
    """
    heavy: dict[float, list[str]] = defaultdict(list)
    shared: dict[int, list[tuple[float, str]]] = defaultdict(list)
    for mark, (mass, _) in sorted(weights.items()):
        needed = math.ceil(mass / lifters.lift_limit)
        if hands_for(lifters, mass, 0.0).gear:
            heavy[round(mass, 1)].append(mark)
        elif needed > 1:
            shared[needed].append((-mass, mark))
    found, allowed = [], lifters.people * lifters.lift_limit
    for mass, marks in sorted(heavy.items(), reverse=True):
        words = text("graph.plan.lifting.heavy" + "_one" * (lifters.people == 1), people=lifters.people)
        needed = math.ceil(mass / lifters.lift_limit)
        remedy = text("graph.plan.lifting.heavy_remedy", people=needed)
        found.append(Finding("AAG955", "warning", named_marks(marks), words, mass, allowed, "kg", remedy))
    for needed, listed in sorted(shared.items(), reverse=True):
        mass, mark = min(listed)
        words = text("graph.plan.lifting.shared", count=len(listed), people=needed)
        remedy = text("graph.plan.lifting.shared_remedy")
        found.append(Finding("AAG955", "note", mark, words, -mass, lifters.lift_limit, "kg", remedy))
    return tuple(found)
