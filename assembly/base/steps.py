"""What a plan of putting together or of taking down is made of."""

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

from aag_cad.findings import Finding
from aag_cad.language import Language

# "lay", "slide" and "join" are those of planks of any layers; "divide" and "splice" those of shells cut for transport.
UpPhase: TypeAlias = Literal[
    "prefabricate", "lay A1", "lay G", "lay A2", "lay", "slide", "join", "studs", "hoist", "edge planks",
    "fix geodesics", "tighten", "divide", "feet", "stand", "splice", "ridges", "cover",
]  # fmt: skip
DownPhase: TypeAlias = Literal[
    "uncover", "prop", "open ridges", "lift off", "clear feet", "hang", "release geodesics", "pull edge planks",
    "lower", "take off beams", "take off geodesics", "pull studs", "unbolt", "passports",
]  # fmt: skip
Phase: TypeAlias = Literal[UpPhase, DownPhase]

UP_PHASES: tuple[UpPhase, ...] = get_args(UpPhase)
DOWN_PHASES: tuple[DownPhase, ...] = get_args(DownPhase)
PHASES: tuple[Phase, ...] = (*UP_PHASES, *DOWN_PHASES)


@dataclass(frozen=True)
class Step:
    """One step of putting together or of taking down.

    ``marks`` are the parts that it adds or takes off; ``assemblies`` the beams or shells, put together before, that it
    moves into place, in the order of laying. ``predecessors`` are the ids of the steps that must be done before it.
    ``hold`` says what must be checked before work goes on, or is "". ``shell`` is "" for steps of the whole vault;
    ``crew`` counts people. ``props`` are the joints under which a prop must stand before the step begins; ``extras``
    say what it adds or takes off that is no part of the gridshell: splice blocks, plates, bracing.
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
    props: tuple[str, ...] = ()
    extras: tuple[str, ...] = ()


@dataclass(frozen=True)
class Plan:
    """The steps of putting a gridshell together, or of taking it down, in an order in which they can be done.

    Titles, tools, instructions and what to check are in ``language``. ``findings`` say what cannot be done so, or not
    by this crew.
    """

    name: str
    steps: tuple[Step, ...]
    language: Language = "en"
    findings: tuple[Finding, ...] = ()
