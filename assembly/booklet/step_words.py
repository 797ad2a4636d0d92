"""What the card of a step says in a language: title, tools, instructions, what to check, and what is no part."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from aag_cad.families import LAYERS
from aag_cad.language import Figure, Language, Text, has_words, printed, say, says, text
from aag_cad.parts.marks import joint_of, parse_mark, short_mark
from assembly.base.mark_ranges import joined_ranges
from assembly.base.steps import (
    Bracing,
    Extra,
    FastenersPut,
    Lashing,
    PropsAway,
    SplicePut,
    Step,
    WholeShell,
)
from assembly.booklet.segment_cards import brace_text
from assembly.drawing.names import phase_name

_KINDS = {"W": "screw", "B": "bolt", "K": "block", "R": "strap", "N": "stud"}
_NOTES = "{notes}"


@dataclass(frozen=True)
class StepWords:
    """The words of a step in one language, its phase by name; ``hold`` is what to check before work goes on, or ""."""

    phase: str
    title: str
    tools: tuple[str, ...]
    instructions: tuple[str, ...]
    hold: str
    extras: tuple[str, ...]


def _counted(marks: Sequence[str]) -> tuple[Text, ...]:
    """Return how many fasteners of each kind there are."""
    kinds = Counter(_KINDS.get(parse_mark(mark).letter, "bolt") for mark in marks)
    return tuple(
        text(f"site.count.{kind if count == 1 else f'{kind}s'}", count=count) for kind, count in sorted(kinds.items())
    )


def _spliced(splice: SplicePut) -> Text:
    work, side = splice.work, "inside" if parse_mark(splice.member).family == LAYERS[-1] else "outside"
    figures: dict[str, Figure] = {"side": text(f"site.{work}.{side}")} if work in ("divide", "splice") else {}
    return text(
        f"site.{work}.{splice.shape}",
        line=short_mark(splice.line),
        beam=short_mark(splice.member),
        joint=short_mark(splice.joint) if splice.joint else "",
        length=splice.length,
        bolts=splice.bolts,
        diameter=splice.diameter,
        left=splice.stations[0].station,
        right=splice.stations[-1].station,
        **figures,
    )


def extra_text(extra: Extra) -> Text:
    """Return what is said of something that a step adds or takes off and that is no part of the gridshell."""
    match extra:
        case SplicePut():
            return _spliced(extra)
        case FastenersPut():
            joints = joined_ranges(tuple(dict.fromkeys(map(joint_of, extra.marks))))
            line, told = short_mark(extra.line), _counted(extra.marks)
            return text(f"site.{extra.work}.fasteners", line=line, fasteners=told, joints=joints)
        case Lashing():
            return text(f"site.{extra.work}.lash", line=short_mark(extra.line), keeper=extra.keeper)
        case Bracing():
            return text(f"site.{extra.work}.brace", segment=extra.segment, brace=brace_text(extra.brace))
        case PropsAway():
            return text("site.ridge.props_off", joints=joined_ranges(extra.joints))
        case WholeShell():
            lines = tuple(map(short_mark, extra.lines))
            return text("site.unmade.whole", segments=extra.segments, lines=lines, mass=extra.mass)


def _instructions(step: Step, language: Language) -> Iterator[str]:
    """Yield the instructions of a step's phase, and its notes where these have a place among them, else last."""
    notes = [printed(note, language) for note in step.notes]
    key = f"{step.card.key}.instructions"
    listed = says(language, key, **step.card.figures, notes=_NOTES) if has_words(key) else ()
    for line in listed if _NOTES in listed else (*listed, _NOTES):
        yield from notes if line == _NOTES else (line,)


def step_title(step: Step, language: Language) -> str:
    """Return the title of a step in a language."""
    return printed(step.title, language)


def step_hold(step: Step, language: Language) -> str:
    """Return what is checked after a step before work goes on, or ""."""
    return say(language, f"{step.card.key}.hold", **step.card.figures) if step.held else ""


def step_words(step: Step, language: Language) -> StepWords:
    """Return all that the card of a step says in a language."""
    tools = says(language, f"{step.card.key}.tools", **step.card.figures)
    return StepWords(
        phase=phase_name(step.phase, language),
        title=step_title(step, language),
        tools=(*tools, say(language, "steps.gear")) if step.gear else tools,
        instructions=tuple(_instructions(step, language)),
        hold=step_hold(step, language),
        extras=tuple(printed(extra_text(extra), language) for extra in step.extras),
    )
