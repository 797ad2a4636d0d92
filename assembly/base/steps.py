"""What a plan of putting together or of taking down is made of: steps as data, in no language."""

from dataclasses import dataclass
from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from aag_cad.findings import Finding
from aag_cad.language import Sentence, Text
from assembly.base.phases import PHASE, Phase
from assembly.base.segments import Brace


@dataclass(frozen=True)
class StepProp:
    """A prop that must stand under a joint before a step begins; ``holds`` is the shell or segment that bears on it."""

    joint: str
    holds: str


@dataclass(frozen=True)
class Station:
    """A place along a plank, mm from its start."""

    plank: str
    station: float


@dataclass(frozen=True)
class SplicePut:
    """A splice of a beam or edge plank that is cut for the journey along the geodesic ``line``; lengths in mm.

    ``work``: the ``member`` is made with it, it comes out when the shell is divided, goes in again when segments are
    spliced, or leaves when the member is unmade. A ``block`` lies in the gap of a beam at its ``joint``, a ``plate`` on
    an edge plank; ``stations`` are where the planks are parted.
    """

    work: Literal["made", "divide", "splice", "unmade"]
    member: str
    line: str
    joint: str
    shape: Literal["block", "plate"]
    stations: tuple[Station, ...]
    length: float
    bolts: int
    diameter: float
    kind: Literal["splice"] = "splice"


@dataclass(frozen=True)
class FastenersPut:
    """Fasteners of the shell that join two segments along a cut: they come out for the journey and go in again."""

    work: Literal["divide", "splice"]
    line: str
    marks: tuple[str, ...]
    kind: Literal["fasteners"] = "fasteners"


@dataclass(frozen=True)
class Lashing:
    """The geodesic ``line`` is lashed to the beam ends of the segment that keeps it, and freed when it is joined."""

    work: Literal["divide", "splice"]
    line: str
    keeper: str
    kind: Literal["lashing"] = "lashing"


@dataclass(frozen=True)
class Bracing:
    """A temporary brace that is put on a segment for the journey, and taken off when it is joined."""

    work: Literal["divide", "splice"]
    segment: str
    brace: Brace
    kind: Literal["bracing"] = "bracing"


@dataclass(frozen=True)
class PropsAway:
    """Props that are taken away at the end of a step, by the joints above them."""

    joints: tuple[str, ...]
    kind: Literal["props away"] = "props away"


@dataclass(frozen=True)
class WholeShell:
    """A shell that went up in segments, cut along ``lines``, and comes off whole with its splices; mass in kg."""

    segments: tuple[str, ...]
    lines: tuple[str, ...]
    mass: float
    kind: Literal["whole shell"] = "whole shell"


# Read back from a file by its kind.
Extra: TypeAlias = Annotated[
    SplicePut | FastenersPut | Lashing | Bracing | PropsAway | WholeShell, Field(discriminator="kind")
]


@dataclass(frozen=True)
class Step:
    """One step of putting together or of taking down.

    ``id`` names it within its plan and means nothing else. ``marks`` are the parts that it adds or takes off;
    ``assemblies`` the beams or shells, put together before, that it moves or works on, in their order; ``segments``
    the segments of a cut shell that it parts, stands or joins. ``predecessors`` are the ids of the steps that must be
    done before it. ``card`` is the key of its tools, instructions and what to check, with the figures in them;
    ``notes`` are instructions of its own. If ``held``, work goes on only after that check. ``shell`` is "" for steps of
    the whole; ``crew`` counts people, with lifting ``gear`` where they cannot lift a piece together. ``extras`` are
    what it adds or takes off that is no part of the gridshell.
    """

    number: int
    id: str
    phase: Phase
    title: Sentence
    shell: str
    marks: tuple[str, ...]
    assemblies: tuple[str, ...]
    segments: tuple[str, ...]
    crew: int
    gear: bool
    predecessors: tuple[str, ...]
    card: Text
    notes: tuple[Sentence, ...] = ()
    held: bool = False
    props: tuple[StepProp, ...] = ()
    extras: tuple[Extra, ...] = ()

    @property
    def propped(self) -> tuple[str, ...]:
        """The joints under which a prop stands."""
        return tuple(prop.joint for prop in self.props)


def carried(phase: Phase, marks: tuple[str, ...], assemblies: tuple[str, ...], segments: tuple[str, ...]) -> list[str]:
    """Return the pieces that a step carries, by their marks or names: what is only joined stays where it is."""
    return [*marks] if PHASE[phase].stays else [*marks, *(segments or assemblies)]


@dataclass(frozen=True)
class Plan:
    """The steps of putting a gridshell together, or of taking it down, in an order in which they can be done.

    ``findings`` say what cannot be done so, or not by this crew.
    """

    name: str
    steps: tuple[Step, ...]
    findings: tuple[Finding, ...] = ()
