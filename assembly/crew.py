"""How many people a piece takes, and when it takes lifting gear."""

import math
from dataclasses import dataclass

from assembly.errors import PlanError

LONG_PIECE = 3000.0


@dataclass(frozen=True)
class Crew:
    """Who assembles: how many people at most, and what one of them may lift, kg."""

    people: int
    lift_limit: float


def crew_of(people: int, lift_limit: float) -> Crew:
    """Return a crew; PlanError with the keys to mend if nobody is in it or nobody lifts anything."""
    if people < 1 or not lift_limit > 0.0:
        raise PlanError(
            f"crew: {people} people who lift {lift_limit:g} kg each; at least 1 person and more than 0 kg: "
            "mend crew.people and crew.lift_limit"
        )
    return Crew(people, lift_limit)


@dataclass(frozen=True)
class Hands:
    """The people that a piece takes; ``gear`` if it is too heavy for all of them together."""

    people: int
    gear: bool


def hands_for(crew: Crew, mass_kg: float, length_mm: float) -> Hands:
    """Return the hands for the heaviest and the longest piece of a step; a piece over 3 m takes two people."""
    needed = max(math.ceil(mass_kg / crew.lift_limit), 2 if length_mm > LONG_PIECE else 1)
    return Hands(min(needed, crew.people), mass_kg > crew.people * crew.lift_limit)
