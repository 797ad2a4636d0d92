"""The schedule as a calendar (iCalendar, RFC 5545): one event for each step, the same plan giving the same bytes."""

import os
import uuid
from collections.abc import Iterator
from datetime import date, datetime, time, timedelta

from aag_cad.files import write_bytes
from aag_cad.language import Figure, say
from assembly.base.errors import PlanError
from assembly.base.mark_ranges import joined_ranges
from assembly.base.names import phase_name
from assembly.base.steps import Plan, Step
from assembly.plan.schedule import Schedule, ScheduledStep

# Work begins at seven; breaks are not drawn.
BEGINS = time(7)
_DAYS = ("Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday", "Sunday")
_OCTETS = 75
# The name space of the events' identifiers: made once, kept for good.
_NAMESPACE = uuid.UUID("6d0c2f0a-5a0b-5f0e-9a53-8c1f4b7d2e61")


def working_day(start: date, number: int, days_per_week: int) -> date:
    """Return the working day that comes ``number`` working days after the first one; weeks begin on Monday.

    PlanError if the first day is none on which work is done.
    """
    if start.weekday() >= days_per_week:
        raise PlanError(
            f"crew.start: {start.isoformat()} is a {_DAYS[start.weekday()]}; allowed Monday to "
            f"{_DAYS[days_per_week - 1]} (crew.days_per_week = {days_per_week}): choose another day"
        )
    weeks, weekday = divmod(start.weekday() + number, days_per_week)
    return start + timedelta(days=7 * weeks + weekday - start.weekday())


def times_of(step: ScheduledStep, schedule: Schedule, start: date, days_per_week: int) -> tuple[datetime, datetime]:
    """Return when a step begins and ends by the clock of the place; one that ends with the day ends in the evening."""
    first, begin = divmod(step.start_minute, schedule.day_minutes)
    last, end = divmod(step.end_minute, schedule.day_minutes)
    if end == 0 and step.end_minute > step.start_minute:
        last, end = last - 1, schedule.day_minutes

    def clock(number: int, minutes: int) -> datetime:
        return datetime.combine(working_day(start, number, days_per_week), BEGINS) + timedelta(minutes=minutes)

    return clock(first, begin), clock(last, end)


def _escaped(text: str) -> str:
    """Return a text as the value of a property (RFC 5545, 3.3.11)."""
    for plain, escaped in (("\\", "\\\\"), (";", "\\;"), (",", "\\,"), ("\r\n", "\\n"), ("\n", "\\n"), ("\r", "\\n")):
        text = text.replace(plain, escaped)
    return text


def folded(line: str) -> str:
    """Return a content line folded at 75 octets, never within a character, with its line end (RFC 5545, 3.1)."""
    pieces, piece, room = [], "", _OCTETS
    for character in line:
        octets = len(character.encode("utf-8"))
        if octets > room:
            pieces.append(piece)
            # The space that begins a continued line is one of its octets.
            piece, room = "", _OCTETS - 1
        piece, room = piece + character, room - octets
    return "\r\n ".join([*pieces, piece]) + "\r\n"


def _description(plan: Plan, step: Step) -> str:
    def word(key: str, **figures: Figure) -> str:
        return say(plan.language, f"schedule.calendar.{key}", **figures)

    numbers = {each.id: each.number for each in plan.steps}
    after = ", ".join(str(numbers[before]) for before in step.predecessors)
    crew = word("person" if step.crew == 1 else "people", count=step.crew)
    lines = (
        "; ".join((crew, word("after", steps=after))) if after else crew,
        word("tools", tools=", ".join(step.tools)) if step.tools else "",
        word("props", joints=joined_ranges(step.props)) if step.props else "",
        *step.instructions,
        *step.extras,
        word("check", hold=step.hold) if step.hold else "",
    )
    return "\n".join(line for line in lines if line)


def _event(plan: Plan, step: Step, begin: datetime, end: datetime, stamp: str) -> Iterator[str]:
    yield "BEGIN:VEVENT"
    yield f"UID:{uuid.uuid5(_NAMESPACE, f'{plan.name}/{step.id}')}"
    yield f"DTSTAMP:{stamp}"
    yield f"DTSTART:{begin:%Y%m%dT%H%M%S}"
    yield f"DTEND:{end:%Y%m%dT%H%M%S}"
    yield f"SUMMARY:{_escaped(f'{step.number} {step.title}')}"
    yield f"DESCRIPTION:{_escaped(_description(plan, step))}"
    yield f"CATEGORIES:{_escaped(phase_name(step.phase, plan.language))}"
    yield "END:VEVENT"


def calendar_text(plan: Plan, schedule: Schedule, start: date, days_per_week: int = 5) -> str:
    """Return the calendar of a scheduled plan from its first working day, in lines that end with CR LF.

    Times are those of the place, whatever its zone; an event that runs on over night is one event. The time stamp is
    the first day, so that the text does not depend on when it was written. PlanError if that is not a working day.
    """
    stamp = f"{start:%Y%m%d}T000000Z"
    lines = [
        "BEGIN:VCALENDAR",
        "VERSION:2.0",
        f"PRODID:-//AAG toolkit//assembly schedule//{plan.language.upper()}",
        "CALSCALE:GREGORIAN",
    ]
    for step, when in zip(plan.steps, schedule.steps, strict=True):
        lines += _event(plan, step, *times_of(when, schedule, start, days_per_week), stamp)
    return "".join(folded(line) for line in (*lines, "END:VCALENDAR"))


def write_calendar(
    plan: Plan, schedule: Schedule, start: date, path: str | os.PathLike[str], days_per_week: int = 5
) -> None:
    """Write the calendar of a scheduled plan; PlanError as ``calendar_text``, FileError if it cannot be written."""
    write_bytes(path, calendar_text(plan, schedule, start, days_per_week).encode("utf-8"))
