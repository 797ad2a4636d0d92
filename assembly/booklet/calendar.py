"""The schedule as a calendar (iCalendar, RFC 5545): one event for each step, the same plan giving the same bytes."""

import os
import uuid
from datetime import UTC, date, datetime, time, timedelta

import icalendar

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


def _event(plan: Plan, step: Step, begin: datetime, end: datetime, stamp: datetime) -> icalendar.Event:
    event = icalendar.Event()
    event.add("UID", str(uuid.uuid5(_NAMESPACE, f"{plan.name}/{step.id}")))
    event.add("DTSTAMP", stamp)
    event.add("DTSTART", begin)
    event.add("DTEND", end)
    event.add("SUMMARY", f"{step.number} {step.title}")
    event.add("DESCRIPTION", _description(plan, step))
    event.add("CATEGORIES", [phase_name(step.phase, plan.language)])
    return event


def calendar_bytes(plan: Plan, schedule: Schedule, start: date, days_per_week: int = 5) -> bytes:
    """Return the calendar of a scheduled plan from its first working day, in UTF-8 and lines that end with CR LF.

    Times are those of the place, whatever its zone; an event that runs on over night is one event. The time stamp is
    the first day, so that the bytes do not depend on when they were written. PlanError if that is not a working day.
    """
    stamp = datetime.combine(start, time(), UTC)
    calendar = icalendar.Calendar()
    calendar.add("VERSION", "2.0")
    calendar.add("PRODID", f"-//AAG toolkit//assembly schedule//{plan.language.upper()}")
    calendar.add("CALSCALE", "GREGORIAN")
    for step, when in zip(plan.steps, schedule.steps, strict=True):
        calendar.add_component(_event(plan, step, *times_of(when, schedule, start, days_per_week), stamp))
    data: bytes = calendar.to_ical(sorted=False)
    return data


def write_calendar(
    plan: Plan, schedule: Schedule, start: date, path: str | os.PathLike[str], days_per_week: int = 5
) -> None:
    """Write the calendar of a scheduled plan; PlanError as ``calendar_bytes``, FileError if it cannot be written."""
    write_bytes(path, calendar_bytes(plan, schedule, start, days_per_week))
