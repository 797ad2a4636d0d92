"""The assembly plan of a gridshell: every part in exactly one step, no step before what it rests on."""

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import asdict

from aag_cad.errors import FileError
from aag_cad.language import Language, say
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import parse_mark
from aag_cad.parts.model import Gridshell, JointKind, Shell, all_parts
from aag_cad.parts.quantities import mass, sizes
from aag_cad.parts.store import value_of
from assembly.base.crew import Crew, crew_of, hands_for, lifting_findings
from assembly.base.errors import PlanError
from assembly.base.locking_order import LockingOrder
from assembly.base.part_groups import shell_kit
from assembly.base.segments import Segmentation, segments_of
from assembly.base.steps import Plan, Step
from assembly.laying.order import FlatOrder, flat_orders
from assembly.plan.parting import divide_works, made_with_splices
from assembly.plan.shell_work import Work, shell_works
from assembly.plan.site_work import site_works
from assembly.plan.wording import Fastener, fasteners_by_kind, wording
from assembly.transport.segments import segment_findings
from assembly.transport.stiffness import stiffness_findings

__all__ = ["Plan", "Step", "plan_json", "plan_of", "read_plan"]

PLAN_VERSION = 2
_EACH_HELD = ("hoist", "stand", "splice")


def piece_weights(gridshell: Gridshell, segmentation: Segmentation | None = None) -> dict[str, tuple[float, float]]:
    """Return (mass in kg, length in mm) of every part, of every beam with its blocks and bolts, and of every shell.

    Of every segment of a cut shell as well, without its bracing. The length of shells and segments counts as 0.
    """
    weights = {part.mark: (mass(part, gridshell.timber), sizes(part)[0]) for part in all_parts(gridshell)}
    for shell in gridshell.shells:
        kit = shell_kit(shell)
        made = (*kit.beams.values(), *((stud, *bolts) for stud, bolts in kit.studs.items()), *kit.outside.values())
        made = (
            *made,
            *((edge, *screws) for edge, screws in kit.edges.items()),
            *kit.inside.values(),
            tuple(kit.outside),
        )
        weights[shell.mark] = sum(weights[mark][0] for group in made for mark in group), 0.0
        for beam, marks in kit.beams.items():
            weights[beam] = sum(weights[mark][0] for mark in marks), index_of(shell).beams[beam].curve.length
    return weights | segment_weights(gridshell, segmentation)


def segment_weights(gridshell: Gridshell, segmentation: Segmentation | None) -> dict[str, tuple[float, float]]:
    """Return (mass in kg, 0) of every segment of the shells that are cut, without its bracing."""
    cut = (segment for shell in gridshell.shells for segment in segments_of(segmentation, shell.mark))
    return {segment.name: (segment.mass, 0.0) for segment in cut}


def lifted(step: Step | Work, weights: Collection[str]) -> tuple[str, ...]:
    """Return the pieces that a step carries, of those with ``weights``: what is only joined stays where it is.

    Of a shell that is cut one segment at a time is carried.
    """
    segment = step.id.removeprefix("site.stand.")
    match step.phase:
        case "ridges" | "splice":
            return step.marks
        case "stand" if segment in weights:
            return (segment,)
        case "divide":
            return tuple(mark for mark in weights if mark.startswith(tuple(f"{shell}." for shell in step.assemblies)))
        case _:
            return step.assemblies or step.marks


def _told(work: Work, fasteners: Mapping[JointKind, Sequence[Fastener]]) -> str:
    """Return the key of the texts of a piece of work: its phase, or one of its special cases."""
    match work.phase:
        case "stand" if work.id.removeprefix("site.stand.") not in work.assemblies:
            return "stand segment" if work.marks else "raise segment"
        case "stand" if not work.props:
            return "stand free"
        case "edge planks" if not any(parse_mark(mark).family == "R" for mark in work.marks):
            return "edge planks alone"
        case "tighten" if not fasteners.get("ridge"):
            return "tighten alone"
        case phase:
            return phase


def _step(
    work: Work,
    number: int,
    last: bool,
    shell: str,
    fasteners: Mapping[JointKind, Sequence[Fastener]],
    crew: Crew,
    weights: Mapping[str, tuple[float, float]],
    language: Language,
) -> Step:
    """Return the step of a piece of work: with its words, and with the hands for its heaviest and longest piece."""
    told = _told(work, fasteners)
    words = wording(work.phase, fasteners, work.below, language, told=told)
    # Where a segment comes down is told between lifting it and setting it down.
    first = 1 if told in ("stand segment", "raise segment") else len(words.instructions)
    pieces = [weights[mark] for mark in lifted(work, weights)]
    hands = hands_for(crew, max((m for m, _ in pieces), default=0.0), max((n for _, n in pieces), default=0.0))
    geared = hands.gear and work.least_crew <= crew.people
    return Step(
        number=number,
        id=work.id,
        phase=work.phase,
        title=work.title,
        shell=shell,
        marks=work.marks,
        assemblies=work.assemblies,
        tools=(*words.tools, say(language, "steps.gear")) if geared else words.tools,
        crew=max(hands.people, min(work.least_crew, crew.people)),
        predecessors=work.after,
        instructions=(*words.instructions[:first], *work.notes, *words.instructions[first:]),
        hold=words.hold if last else "",
        props=work.props,
        extras=work.extras,
    )


def plan_of(
    gridshell: Gridshell,
    people: int,
    lift_limit: float,
    *,
    orders: Mapping[str, FlatOrder] | None = None,
    locking: Sequence[LockingOrder] = (),
    segmentation: Segmentation | None = None,
    language: Language = "en",
) -> Plan:
    """Return the assembly plan for a crew of ``people`` who lift at most ``lift_limit`` kg each (paper section 3.2).

    ``orders`` say how each shell is laid flat, by mark (none: ``flat_orders``). The geodesics are fixed in the order of
    ``locking``, one for each shell; without it by their marks. Shells that ``segmentation`` cuts are parted for the
    journey and joined again on site. PlanError if the layers are woven so that no plank can be slid in, a part belongs
    to no joint, or the crew is empty.
    """
    crew, weights = crew_of(people, lift_limit), piece_weights(gridshell, segmentation)
    locked = {order.shell: order for order in locking}
    laid = orders if orders is not None else flat_orders(gridshell)
    chapters: list[tuple[str, Sequence[Shell], tuple[Work, ...]]] = []
    for shell in gridshell.shells:
        works = shell_works(shell, laid[shell.mark], locked.get(shell.mark), language)
        spliced = made_with_splices(works, segmentation, language)
        chapters.append((shell.mark, (shell,), (*spliced, *divide_works(shell, segmentation, language))))
    chapters.append(("", gridshell.shells, site_works(gridshell, segmentation, language, locking)))
    steps: list[Step] = []
    for name, shells, works in chapters:
        fasteners = fasteners_by_kind(gridshell, shells)
        for i, work in enumerate(works):
            last = work.phase in _EACH_HELD or all(later.phase != work.phase for later in works[i + 1 :])
            steps.append(_step(work, len(steps) + 1, last, name, fasteners, crew, weights, language))
    craned = {*(shell.mark for shell in gridshell.shells), *segment_weights(gridshell, segmentation)}
    carried = {mark: weight for mark, weight in weights.items() if mark not in craned}
    findings = (
        *lifting_findings(carried, crew),
        *(segment_findings(segmentation) if segmentation else ()),
        *(stiffness_findings(gridshell, segmentation) if segmentation else ()),
    )
    return Plan(gridshell.name, tuple(steps), language, findings)


def plan_json(plan: Plan) -> str:
    """Return a plan as JSON text that ``read_plan`` reads back to an equal plan."""
    return json.dumps({"schema_version": PLAN_VERSION, **asdict(plan)}, indent=1, ensure_ascii=False) + "\n"


def read_plan(text: str) -> Plan:
    """Return the plan in a JSON text; PlanError with the place of the first fault."""
    try:
        data = json.loads(text)
    except json.JSONDecodeError as error:
        raise PlanError(f"assembly plan: not valid JSON: {error}") from error
    if not isinstance(data, dict) or data.pop("schema_version", None) != PLAN_VERSION:
        raise PlanError(f"assembly plan: schema_version must be {PLAN_VERSION}; write it again with this version")
    try:
        plan: Plan = value_of(Plan, data, "plan")
    except FileError as error:
        raise PlanError(f"assembly {error}; write plans with plan_json") from error
    return plan
