"""plan.json: a plan as one file that tells the whole story in all languages; its schema is documented and versioned."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any, ClassVar, Literal, TypeAlias

import networkx as nx
from pydantic import ConfigDict, Field, TypeAdapter, ValidationError

from aag_cad.design_making import Crew
from aag_cad.files import json_object
from aag_cad.findings import Severity
from aag_cad.language import LANGUAGES, Language, Sentence, Text, has_words, printed
from aag_cad.parts.model import Gridshell, all_parts
from aag_cad.parts.quantities import mass, sizes
from aag_cad.units import Vector
from assembly.base.errors import PlanError
from assembly.base.names import node_text, part_text
from assembly.base.segments import Brace, PlankPiece, Segment, Segmentation
from assembly.base.steps import Plan, Step
from assembly.booklet.step_words import StepWords, step_words
from assembly.plan.clock import Clock, clock_of
from assembly.plan.schedule import Schedule, ScheduledStep

PLAN_VERSION: Literal[3] = 3

# A text in every language that there is.
Words: TypeAlias = Annotated[dict[Language, str], Field(min_length=len(LANGUAGES))]


@dataclass(frozen=True)
class StepTime:
    """When a step is done: minutes of work since the start, and by the clock of the place if a first day is known.

    ``slack`` is by how many minutes it could be late, with people enough, without a later end of the whole.
    """

    start_minute: int
    end_minute: int
    begins: str | None
    ends: str | None
    slack: int
    critical: bool


@dataclass(frozen=True)
class PlannedStep:
    """A step as data, what its card says in each language, and when it is done."""

    step: Step
    words: Annotated[dict[Language, StepWords], Field(min_length=len(LANGUAGES))]
    time: StepTime


@dataclass(frozen=True)
class Piece:
    """Parts that are alike: what they are called, mass in kg and length in mm of each, and their marks."""

    name: Words
    mass: float
    length: float
    marks: tuple[str, ...]


@dataclass(frozen=True)
class TravellingSegment:
    """A segment of a shell that is cut, or a whole shell, as it travels; kg and mm, in the coordinates of the whole.

    ``parts`` are whole, ``pieces`` what it has of cut planks; ``size`` is length, width, height as it is loaded. It is
    slung at ``lifting``, propped at ``props`` where it stands alone, and kept stiff by ``braces``.
    """

    name: str
    shell: str
    geodesics: tuple[str, ...]
    parts: tuple[str, ...]
    pieces: tuple[PlankPiece, ...]
    mass: float
    centre: Vector
    size: Vector
    lifting: tuple[str, ...]
    props: tuple[str, ...]
    braces: tuple[Brace, ...]


@dataclass(frozen=True)
class PlanFinding:
    """What cannot be done so, or not by this crew: the figure found and allowed with its unit; words by language."""

    code: str
    severity: Severity
    mark: str
    what: Words
    found: float
    allowed: float
    unit: str
    remedy: Words


@dataclass(frozen=True)
class PlanFile:
    """A plan with all that is needed to follow it: steps in an order in which they can be done, parts, segments.

    ``people`` is the crew, ``day_minutes`` how long it works a day.
    """

    # For all that it holds too: no key may be left out or made up, and every number is finite.
    __pydantic_config__: ClassVar[ConfigDict] = ConfigDict(
        extra="forbid", allow_inf_nan=False, json_schema_serialization_defaults_required=True
    )

    schema_version: Literal[3]
    name: str
    people: int
    day_minutes: int
    steps: tuple[PlannedStep, ...]
    pieces: tuple[Piece, ...]
    segments: tuple[TravellingSegment, ...]
    findings: tuple[PlanFinding, ...]

    @property
    def plan(self) -> Plan:
        """The steps of the file as a plan; its findings stand in the file."""
        return Plan(self.name, tuple(each.step for each in self.steps))


@cache
def _adapter() -> TypeAdapter[PlanFile]:
    return TypeAdapter(PlanFile)


def plan_schema() -> dict[str, Any]:
    """Return the JSON Schema of plan.json and disassembly.json."""
    schema = _adapter().json_schema(mode="serialization")
    return {"$schema": "https://json-schema.org/draft/2020-12/schema"} | schema


def _in_all(sentence: Sentence) -> Words:
    return {language: printed(sentence, language) for language in LANGUAGES}


def _pieces(parts: Iterable[tuple[str, Sentence, float, float]]) -> tuple[Piece, ...]:
    """Return (mark, name, kg, mm) of parts as pieces: those that are alike together, in the order of the first."""
    groups: dict[tuple[str, float, float], list[str]] = defaultdict(list)
    names: dict[str, Words] = {}
    for mark, name, kg, length in parts:
        english = printed(name, "en")
        names.setdefault(english, _in_all(name))
        groups[english, round(kg, 4), round(length, 2)].append(mark)
    return tuple(Piece(names[name], kg, length, tuple(marks)) for (name, kg, length), marks in groups.items())


def gridshell_pieces(gridshell: Gridshell) -> tuple[Piece, ...]:
    """Return the parts of a gridshell as pieces."""
    return _pieces(
        (part.mark, part_text(part), mass(part, gridshell.timber), sizes(part)[0]) for part in all_parts(gridshell)
    )


def graph_pieces(graph: "nx.MultiGraph[str]") -> tuple[Piece, ...]:
    """Return the parts of any graph as pieces, called by their section or kind."""
    return _pieces(
        (mark, node_text(node), float(node["mass_kg"]), float(node["length_mm"]))
        for mark, node in graph.nodes(data=True)
    )


def _travelling(segment: Segment) -> TravellingSegment:
    return TravellingSegment(
        name=segment.name,
        shell=segment.shell,
        geodesics=segment.geodesics,
        parts=segment.parts,
        pieces=segment.pieces,
        mass=segment.mass,
        centre=segment.centre,
        size=segment.pose.size,
        lifting=segment.lifting.studs,
        props=segment.props,
        braces=segment.braces,
    )


def _time(when: ScheduledStep, clock: Clock | None) -> StepTime:
    begins = clock.begins(when.start_minute).isoformat() if clock else None
    ends = clock.ends(when.end_minute).isoformat() if clock else None
    return StepTime(when.start_minute, when.end_minute, begins, ends, when.slack, when.critical)


def plan_file(
    plan: Plan,
    schedule: Schedule,
    crew: Crew,
    pieces: Sequence[Piece],
    segmentation: Segmentation | None = None,
) -> PlanFile:
    """Return a plan of putting together or of taking down as a file, with its schedule for a crew.

    PlanError if the crew's first day is none on which it works.
    """
    clock = clock_of(schedule, crew)
    return PlanFile(
        schema_version=PLAN_VERSION,
        name=plan.name,
        people=schedule.people,
        day_minutes=schedule.day_minutes,
        steps=tuple(
            PlannedStep(step, {code: step_words(step, code) for code in LANGUAGES}, _time(when, clock))
            for step, when in zip(plan.steps, schedule.steps, strict=True)
        ),
        pieces=tuple(pieces),
        segments=tuple(map(_travelling, segmentation.segments)) if segmentation else (),
        findings=tuple(
            PlanFinding(
                code=found.code,
                severity=found.severity,
                mark=found.mark,
                what=_in_all(found.what),
                found=found.found,
                allowed=found.allowed,
                unit=found.unit,
                remedy=_in_all(found.remedy),
            )
            for found in plan.findings
        ),
    )


def plan_json(file: PlanFile) -> str:
    """Return a plan file as JSON text that ``read_plan`` reads back to an equal one."""
    return _adapter().dump_json(file, indent=1).decode("utf-8") + "\n"


def read_plan(text: str) -> PlanFile:
    """Return the plan file in a JSON text; PlanError with the place of the first fault."""
    version = json_object(text, "assembly plan", PlanError).get("schema_version")
    if version != PLAN_VERSION:
        raise PlanError(
            f"assembly plan: schema_version {version!r}, allowed {PLAN_VERSION}; write it again with this version"
        )
    try:
        file = _adapter().validate_json(text, strict=True)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(map(str, first["loc"]))
        raise PlanError(
            f"assembly plan: {place}: {first['msg']}, found {first['input']!r}; write plans with aag plan"
        ) from error
    for i, each in enumerate(file.steps):
        title = each.step.title.key if isinstance(each.step.title, Text) else ""
        for key in (title, f"{each.step.card.key}.tools"):
            if key and not has_words(key):
                raise PlanError(f"assembly plan: steps.{i}: {key!r} has no words; write plans with aag plan")
    return file
