"""What an assembly plan is made of."""

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

Phase: TypeAlias = Literal[
    "prefabricate", "lay A1", "lay G", "lay A2", "studs", "hoist", "edge planks", "fix geodesics", "tighten",
    "feet", "stand", "ridges", "cover",
]  # fmt: skip

PHASES: tuple[Phase, ...] = get_args(Phase)


@dataclass(frozen=True)
class Step:
    """One step of the assembly.

    ``marks`` are the parts that it adds; ``assemblies`` the beams or shells, put together before, that it moves into
    place, in the order of laying. ``predecessors`` are the ids of the steps that must be done before it. ``hold`` says
    what must be checked before work goes on, or is "". ``shell`` is "" for steps of the whole vault; ``crew`` counts
    people.
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
    """The steps of a gridshell's assembly in an order in which they can be done, numbered from 1."""

    name: str
    steps: tuple[Step, ...]
