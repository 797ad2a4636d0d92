"""What a plan of putting together or of taking down is made of."""

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

UpPhase: TypeAlias = Literal[
    "prefabricate", "lay A1", "lay G", "lay A2", "studs", "hoist", "edge planks", "fix geodesics", "tighten",
    "feet", "stand", "ridges", "cover",
]  # fmt: skip
DownPhase: TypeAlias = Literal[
    "uncover", "prop", "open ridges", "lift off", "clear feet", "hang", "release geodesics", "pull edge planks",
    "lower", "take off beams", "take off geodesics", "pull studs", "unbolt", "passports",
]  # fmt: skip
Phase: TypeAlias = UpPhase | DownPhase

UP_PHASES: tuple[UpPhase, ...] = get_args(UpPhase)
DOWN_PHASES: tuple[DownPhase, ...] = get_args(DownPhase)
PHASES: tuple[Phase, ...] = (*UP_PHASES, *DOWN_PHASES)


@dataclass(frozen=True)
class Step:
    """One step of putting together or of taking down.

    ``marks`` are the parts that it adds or takes off; ``assemblies`` the beams or shells, put together before, that it
    moves into place, in the order of laying. ``predecessors`` are the ids of the steps that must be done before it.
    ``hold`` says what must be checked before work goes on, or is "". ``shell`` is "" for steps of the whole vault;
    ``crew`` counts people.
    """

    number: int
    id: str
    phase: Phase
    title: str
    shell: str
    marks: tuple[str, ...]
    assemblies: tuple[str, ...]
    tools: tuple[str, ...]
    crew: int
    predecessors: tuple[str, ...]
    instructions: tuple[str, ...]
    hold: str = ""


@dataclass(frozen=True)
class Plan:
    """The steps of putting a gridshell together, or of taking it down, in an order in which they can be done."""

    name: str
    steps: tuple[Step, ...]
