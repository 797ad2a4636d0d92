"""The assembly plan of a gridshell: every part in exactly one step, no step before what it rests on."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, fields
from typing import Any, get_type_hints

from aag_cad.parts.model import Gridshell, JointKind, all_parts
from aag_cad.parts.quantities import mass, sizes
from assembly.crew import Crew, crew_of, hands_for
from assembly.errors import PlanError
from assembly.kit import shell_kit
from assembly.process import Work, shell_works
from assembly.site import site_works
from assembly.steps import PHASES, Phase, Plan, Step
from assembly.wording import Fastener, fasteners_by_kind, wording

__all__ = ["Plan", "Step", "plan_json", "plan_of", "read_plan"]

PLAN_VERSION = 1
_EACH_HELD = ("hoist", "stand")


def piece_weights(gridshell: Gridshell) -> dict[str, tuple[float, float]]:
    """Return (mass in kg, length in mm) of every part, of every beam with its blocks and bolts, and of every shell.

    The length of a shell counts as 0.
    """
    weights = {part.mark: (mass(part, gridshell.timber), sizes(part)[0]) for part in all_parts(gridshell)}
    for shell in gridshell.shells:
        kit = shell_kit(shell)
        lengths = {beam.mark: beam.curve.length for beam in shell.beams}
        made = (*kit.beams.values(), *((stud, *bolts) for stud, bolts in kit.studs.items()), *kit.outside.values())
        made = (
            *made,
            *((edge, *screws) for edge, screws in kit.edges.items()),
            *kit.inside.values(),
            tuple(kit.outside),
        )
        weights[shell.mark] = sum(weights[mark][0] for group in made for mark in group), 0.0
        for beam, marks in kit.beams.items():
            weights[beam] = sum(weights[mark][0] for mark in marks), lengths[beam]
    return weights


def lifted(phase: Phase, marks: tuple[str, ...], assemblies: tuple[str, ...]) -> tuple[str, ...]:
    """Return the pieces that a step carries: shells that are only joined stay where they are."""
    return marks if phase == "ridges" else assemblies or marks


def _step(
    work: Work,
    number: int,
    last: bool,
    shell: str,
    fasteners: Mapping[JointKind, Sequence[Fastener]],
    crew: Crew,
    weights: Mapping[str, tuple[float, float]],
) -> Step:
    """Return the step of a piece of work: with its words, and with the hands for its heaviest and longest piece."""
    words = wording(work.phase, fasteners, work.below)
    pieces = [weights[mark] for mark in lifted(work.phase, work.marks, work.assemblies)]
    hands = hands_for(crew, max((m for m, _ in pieces), default=0.0), max((n for _, n in pieces), default=0.0))
    return Step(
        number=number,
        id=work.id,
        phase=work.phase,
        title=work.title,
        shell=shell,
        marks=work.marks,
        assemblies=work.assemblies,
        tools=(*words.tools, "lifting gear") if hands.gear and work.least_crew <= crew.people else words.tools,
        crew=max(hands.people, min(work.least_crew, crew.people)),
        predecessors=work.after,
        instructions=words.instructions,
        hold=words.hold if last else "",
    )


def plan_of(gridshell: Gridshell, people: int, lift_limit: float) -> Plan:
    """Return the assembly plan for a crew of ``people`` who lift at most ``lift_limit`` kg each (paper section 3.2).

    PlanError if the layers are woven in a circle, a part belongs to no joint, or the crew is empty.
    """
    crew, weights = crew_of(people, lift_limit), piece_weights(gridshell)
    chapters = [(shell.mark, (shell,), shell_works(shell)) for shell in gridshell.shells]
    steps: list[Step] = []
    for name, shells, works in [*chapters, ("", gridshell.shells, site_works(gridshell))]:
        fasteners = fasteners_by_kind(gridshell, shells)
        for i, work in enumerate(works):
            last = work.phase in _EACH_HELD or all(later.phase != work.phase for later in works[i + 1 :])
            steps.append(_step(work, len(steps) + 1, last, name, fasteners, crew, weights))
    return Plan(gridshell.name, tuple(steps))


def plan_json(plan: Plan) -> str:
    """Return a plan as JSON text that ``read_plan`` reads back to an equal plan."""
    return json.dumps({"schema_version": PLAN_VERSION, **asdict(plan)}, indent=1, ensure_ascii=False) + "\n"


def _read_step(data: object, place: int) -> Step:
    """Return a step from parsed JSON; PlanError that names the step and the key."""
    if not isinstance(data, dict) or set(data) != {field.name for field in fields(Step)}:
        raise PlanError(f"steps[{place}]: keys must be {', '.join(field.name for field in fields(Step))}")
    values: dict[str, Any] = {}
    for name, kind in get_type_hints(Step).items():
        value = data[name]
        listed = name in ("marks", "assemblies", "tools", "predecessors", "instructions")
        if listed and isinstance(value, list) and all(isinstance(item, str) for item in value):
            values[name] = tuple(value)
        elif not listed and type(value) is (int if kind is int else str) and (name != "phase" or value in PHASES):
            values[name] = value
        else:
            raise PlanError(f"steps[{place}].{name}: {value!r} is not allowed; write plans with plan_json")
    return Step(**values)


def read_plan(text: str) -> Plan:
    """Return the plan in a JSON text; PlanError with the place of the first fault."""
    try:
        data = json.loads(text)
    except json.JSONDecodeError as error:
        raise PlanError(f"assembly plan: not valid JSON: {error}") from error
    if not isinstance(data, dict) or data.get("schema_version") != PLAN_VERSION:
        raise PlanError(f"assembly plan: schema_version must be {PLAN_VERSION}; write it again with this version")
    if not isinstance(data.get("name"), str) or not isinstance(data.get("steps"), list):
        raise PlanError("assembly plan: it needs a name and a list of steps; write it with plan_json")
    return Plan(data["name"], tuple(_read_step(step, i) for i, step in enumerate(data["steps"])))
