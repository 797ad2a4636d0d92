"""The words of the step cards of any plan, as plain data for the templates."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from aag_cad.language import Language, figure, say, says
from aag_cad.parts.marks import short_in
from assembly.base.mark_ranges import named_marks, ranges_of
from assembly.base.phases import PHASES
from assembly.base.steps import Plan, Step, carried
from assembly.booklet.step_words import step_title, step_words
from assembly.booklet.words import Kind
from assembly.drawing.names import phase_name
from assembly.plan.schedule import Schedule

Weights: TypeAlias = Mapping[str, tuple[float, float]]

_WORTH_SAYING = 1.0
_MOST_PROPS = 30
# A square code of the size on the card stays readable for a telephone up to here.
_QR_CHARACTERS = 300


@dataclass(frozen=True)
class Known:
    """What cards know of parts by their marks: what each is called, and the joint of a fastener; in one language.

    ``weights`` are (kg, mm) of all that is carried: parts, beams, shells, segments.
    """

    names: Mapping[str, str]
    joints: Mapping[str, str]
    weights: Weights
    language: Language


@dataclass(frozen=True)
class Sheets:
    """What the sheets of a booklet are made from: its plan and schedule, what is known of its parts, its words."""

    kind: Kind
    title: str
    plan: Plan
    schedule: Schedule
    known: Known
    words: Mapping[str, Any]


def length_words(mm: float) -> str:
    """Return a length as it is printed."""
    return f"{mm:.0f} mm"


def mass_words(kg: float, language: Language) -> str:
    """Return a mass as it is printed."""
    return figure(f"{kg:.1f} kg" if kg < 100.0 else f"{kg:.0f} kg", language)


def card_table(language: Language, name: str, rows: Sequence[Sequence[str]]) -> dict[str, Any]:
    """Return a table of a card as its template needs it; its head is that of ``words/cards.toml``."""
    return {"head": list(says(language, f"cards.{name}.head")), "rows": rows}


def part_rows(known: Known, marks: Iterable[str]) -> list[list[str]]:
    """Return one line for each product among the marks: count, what it is, and which marks or at which joints."""
    language, groups = known.language, dict[str, list[str]]()
    for mark in marks:
        groups.setdefault(known.names[mark], []).append(mark)
    rows = []
    for name, listed in groups.items():
        if listed[0] not in known.joints:
            where = named_marks(listed)
        else:
            joints = tuple(dict.fromkeys(known.joints[mark] for mark in listed))
            each, left = divmod(len(listed), len(joints))
            key = "each" if each > 1 and not left else "at"
            where = say(language, f"cards.where.{key}", joints=named_marks(joints), count=each)
        rows.append([str(len(listed)), name, where])
    return rows


def qr_text(name: str, step: Step, weights: Weights) -> str:
    """Return what the square code of a card holds: gridshell, step and the ranges of its marks, cut off where long."""
    known = tuple(mark for mark in step.assemblies if mark in weights)
    ranges = (*(mark for mark in step.assemblies if mark not in weights), *ranges_of((*known, *step.marks)))
    text, head = "", f"{name} {step.id}: "
    for i, part in enumerate(ranges):
        longer = f"{text}, {part}" if text else part
        room = 0 if i == len(ranges) - 1 else len(", …")
        if len(head) + len(longer) + room >= _QR_CHARACTERS:
            return f"{head}{text}, …"
        text = longer
    return head + (text or step.shell)


def gathered(extras: Sequence[str]) -> list[str]:
    """Return extras as they are printed: those alike before their last colon in one line, each after a semicolon."""
    tails: dict[str, list[str]] = defaultdict(list)
    for extra in extras:
        head, colon, tail = extra.rpartition(": ")
        tails[head + colon].append(tail)
    return [head + "; ".join(listed) for head, listed in tails.items()]


def step_card(
    sheets: Sheets, step: Step, table: dict[str, Any] | None, parts: Sequence[str], handled: Iterable[str]
) -> dict[str, Any]:
    """Return what the card of a step of putting together or of taking down prints, without its pictures.

    ``parts`` are those of its marks that are listed beside its ``table``; a search finds all that is ``handled``.
    """
    known, said = sheets.known, sheets.words["card"]
    language, weights = known.language, known.weights
    words = step_words(step, language)
    titles = {s.id: f"{s.number}  {step_title(s, language)}" for s in sheets.plan.steps}
    chapter = {s.phase for s in sheets.plan.steps if s.shell == step.shell}
    moved = carried(step.phase, step.marks, step.assemblies, step.segments)
    heaviest = max((mark for mark in moved if mark in weights), key=lambda mark: (weights[mark][0], mark), default="")
    told = bool(heaviest) and weights[heaviest][0] >= _WORTH_SAYING
    piece = f"{heaviest}: {mass_words(weights[heaviest][0], language)}" if told else ""
    added = mass_words(sum(weights[mark][0] for mark in step.marks), language)
    props = [short_in(mark, step.shell) for mark in step.propped]
    more = f" {said['and_more'].format(count=len(props) - _MOST_PROPS)}" if len(props) > _MOST_PROPS else ""
    return {
        "number": step.number,
        "id": step.id,
        "phase": step.phase,
        "phases": [[phase_name(phase, language), phase == step.phase] for phase in PHASES if phase in chapter],
        "title": words.title,
        "shell": step.shell,
        "line": said["shell"].format(shell=step.shell) if step.shell else "",
        "parts": part_rows(known, parts),
        "added": said["parts_up" if sheets.kind == "sequence" else "parts_down"].format(
            pieces=len(step.marks), mass=added
        ),
        "heaviest": said["heaviest"].format(piece=piece) if piece else "",
        "table": table,
        "tools": list(words.tools),
        "crew": step.crew,
        "after": [titles[before] for before in step.predecessors],
        "instructions": list(words.instructions),
        "hold": words.hold,
        "propped": ", ".join(props[:_MOST_PROPS]) + more,
        "extras": gathered(words.extras),
        "qr": qr_text(sheets.plan.name, step, weights),
        "handled": sorted(set(handled)),
    }
