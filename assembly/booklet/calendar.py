"""The schedule as a calendar (iCalendar, RFC 5545): one event for each step, the same plan giving the same bytes."""

import os
import uuid
from datetime import UTC, datetime, time

import icalendar

from aag_cad.files import write_bytes
from aag_cad.language import Figure, Language, say
from assembly.base.mark_ranges import joined_ranges
from assembly.base.steps import Plan, Step
from assembly.booklet.step_words import StepWords, step_words
from assembly.drawing.names import phase_name
from assembly.plan.clock import Clock
from assembly.plan.schedule import Schedule

# The name space of the events' identifiers: made once, kept for good.
_NAMESPACE = uuid.UUID("6d0c2f0a-5a0b-5f0e-9a53-8c1f4b7d2e61")


def _description(plan: Plan, step: Step, words: StepWords, language: Language) -> str:
    def word(key: str, **figures: Figure) -> str:
        return say(language, f"schedule.calendar.{key}", **figures)

    numbers = {each.id: each.number for each in plan.steps}
    after = ", ".join(str(numbers[before]) for before in step.predecessors)
    crew = word("person" if step.crew == 1 else "people", count=step.crew)
    lines = (
        "; ".join((crew, word("after", steps=after))) if after else crew,
        word("tools", tools=words.tools) if words.tools else "",
        word("props", joints=joined_ranges(step.propped)) if step.props else "",
        *words.instructions,
        *words.extras,
        word("check", hold=words.hold) if words.hold else "",
    )
    return "\n".join(line for line in lines if line)


def _event(
    plan: Plan, step: Step, begin: datetime, end: datetime, stamp: datetime, language: Language
) -> icalendar.Event:
    event, words = icalendar.Event(), step_words(step, language)
    event.add("UID", str(uuid.uuid5(_NAMESPACE, f"{plan.name}/{step.id}")))
    event.add("DTSTAMP", stamp)
    event.add("DTSTART", begin)
    event.add("DTEND", end)
    event.add("SUMMARY", f"{step.number} {words.title}")
    event.add("DESCRIPTION", _description(plan, step, words, language))
    event.add("CATEGORIES", [phase_name(step.phase, language)])
    return event


def calendar_bytes(plan: Plan, schedule: Schedule, clock: Clock, language: Language = "en") -> bytes:
    """Return the calendar of a scheduled plan, in UTF-8 and lines that end with CR LF.

    Times are those of the place, whatever its zone; an event that runs on over night is one event. The time stamp is
    the first day, so that the bytes do not depend on when they were written.
    """
    stamp = datetime.combine(clock.first, time(), UTC)
    calendar = icalendar.Calendar()
    calendar.add("VERSION", "2.0")
    calendar.add("PRODID", f"-//AAG toolkit//assembly schedule//{language.upper()}")
    calendar.add("CALSCALE", "GREGORIAN")
    for step, when in zip(plan.steps, schedule.steps, strict=True):
        begin, end = clock.begins(when.start_minute), clock.ends(when.end_minute)
        calendar.add_component(_event(plan, step, begin, end, stamp, language))
    data: bytes = calendar.to_ical(sorted=False)
    return data


def write_calendar(
    plan: Plan, schedule: Schedule, clock: Clock, path: str | os.PathLike[str], language: Language = "en"
) -> None:
    """Write the calendar of a scheduled plan; FileError if it cannot be written."""
    write_bytes(path, calendar_bytes(plan, schedule, clock, language))
