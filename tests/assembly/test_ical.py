"""The calendar, read back by the words of RFC 5545, without the library that writes it."""

import re
import uuid
from dataclasses import replace
from datetime import date, datetime
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from making import a_step

from aag_cad.design_making import Crew, Minutes
from aag_cad.parts.model import Gridshell
from assembly.base.errors import PlanError
from assembly.base.steps import Plan
from assembly.booklet.calendar import calendar_bytes, write_calendar
from assembly.booklet.step_words import step_words
from assembly.plan.assembly_plan import plan_of
from assembly.plan.clock import Clock, clock_of, working_day
from assembly.plan.durations import step_minutes
from assembly.plan.schedule import Schedule, schedule_of

MONDAY = date(2027, 3, 1)
CLOCK = Clock(MONDAY, day_minutes=480, days_per_week=5)

Read = dict[str, str]


def read(data: bytes) -> tuple[Read, list[Read]]:
    """Return the properties of a calendar and of its events: unfolded (3.1), escapes of texts undone (3.3.11)."""
    head: Read = {}
    events: list[Read] = []
    for line in data.replace(b"\r\n ", b"").decode("utf-8").removesuffix("\r\n").split("\r\n"):
        name, value = line.split(":", 1)
        if line == "BEGIN:VEVENT":
            events.append({})
        elif name not in ("BEGIN", "END"):
            plain = re.sub(r"\\(.)", lambda found: "\n" if found[1] in "nN" else found[1], value)
            (events[-1] if events else head)[name] = plain
    return head, events


def at(event: Read, name: str) -> datetime:
    """Return a time of an event by the clock of the place (form 1 of 3.3.5)."""
    return datetime.strptime(event[name], "%Y%m%dT%H%M%S")


@pytest.fixture(scope="module")
def scheduled(gridshell: Gridshell) -> tuple[Plan, Schedule]:
    plan = plan_of(gridshell, 4, 25.0)
    return plan, schedule_of(plan, step_minutes(plan, gridshell, Minutes.model_validate({})), 4)


def test_each_step_is_one_event_with_its_times(scheduled: tuple[Plan, Schedule], tmp_path: Path) -> None:
    plan, schedule = scheduled
    write_calendar(plan, schedule, CLOCK, tmp_path / "schedule.ics")
    head, events = read((tmp_path / "schedule.ics").read_bytes())
    assert (head["VERSION"], head["CALSCALE"]) == ("2.0", "GREGORIAN")
    assert len(events) == len(plan.steps)
    assert len({event["UID"] for event in events}) == len(plan.steps)
    for step, when, event in zip(plan.steps, schedule.steps, events, strict=True):
        words = step_words(step, "en")
        assert event["SUMMARY"] == f"{step.number} {words.title}"
        assert all(line in event["DESCRIPTION"] for line in words.instructions)
        assert uuid.UUID(event["UID"]).version == 5
        begin, end = at(event, "DTSTART"), at(event, "DTEND")
        number, minute = divmod(when.start_minute, 480)
        day = working_day(MONDAY, number, 5)
        assert begin == datetime(day.year, day.month, day.day, 7 + minute // 60, minute % 60)
        assert begin < end
        assert end.weekday() < 5
        assert (end.hour, end.minute) <= (15, 0)
        assert event["DTSTAMP"] == "20270301T000000Z"


def test_a_calendar_prints_in_german(scheduled: tuple[Plan, Schedule]) -> None:
    plan, schedule = scheduled
    head, events = read(calendar_bytes(plan, schedule, CLOCK, "de"))
    assert head["PRODID"].endswith("//DE")
    for step, event in zip(plan.steps, events, strict=True):
        lines, words = event["DESCRIPTION"].splitlines(), step_words(step, "de")
        assert event["SUMMARY"] == f"{step.number} {words.title}"
        assert lines[0].startswith("1 Person" if step.crew == 1 else f"{step.crew} Leute")
        assert ("nach Schritt" in lines[0]) == bool(step.predecessors)
        assert lines[1] == f"Werkzeug: {', '.join(words.tools)}"
        assert (lines[-1] == f"HALT: {words.hold}") == step.held


def test_lines_end_with_cr_lf_and_have_at_most_75_octets(scheduled: tuple[Plan, Schedule]) -> None:
    lines = calendar_bytes(*scheduled, CLOCK).split(b"\r\n")
    assert lines[-1] == b""
    assert max(map(len, lines)) <= 75
    assert b"\n" not in b"".join(lines)
    assert all(line.decode("utf-8") for line in lines[:-1])


@given(st.text(st.characters(exclude_categories=["Cs", "Cc"], include_characters="\n,;\\"), min_size=1, max_size=300))
def test_any_title_survives_the_calendar(title: str) -> None:
    plan = Plan("one", (a_step(1, title),))
    data = calendar_bytes(plan, schedule_of(plan, {"s1": 60}, 1), CLOCK)
    assert read(data)[1][0]["SUMMARY"] == f"1 {title}"
    assert max(map(len, data.split(b"\r\n"))) <= 75


def test_a_step_that_ends_with_the_day_ends_in_the_evening_and_the_next_begins_in_the_morning() -> None:
    plan = Plan("two", (a_step(1, "1"), a_step(2, "2", predecessors=("s1",))))
    friday = replace(CLOCK, first=date(2027, 3, 5))
    _, (first, second) = read(calendar_bytes(plan, schedule_of(plan, {"s1": 480, "s2": 500}, 1), friday))
    assert at(first, "DTEND") == datetime(2027, 3, 5, 15)
    assert at(second, "DTSTART") == datetime(2027, 3, 8, 7)
    assert at(second, "DTEND") == datetime(2027, 3, 9, 7, 20)


def test_seven_days_a_week_have_no_weekend() -> None:
    assert working_day(MONDAY, 6, 7) == date(2027, 3, 7)
    assert working_day(MONDAY, 5, 5) == date(2027, 3, 8)


def test_a_start_on_a_day_off_is_refused(scheduled: tuple[Plan, Schedule]) -> None:
    crew = Crew.model_validate({"people": 4, "lift_limit": 25.0, "start": "2027-03-06"})
    with pytest.raises(PlanError, match=r"crew\.start: 2027-03-06 is a Saturday"):
        clock_of(scheduled[1], crew)


def test_the_same_schedule_gives_the_same_calendar(scheduled: tuple[Plan, Schedule]) -> None:
    assert calendar_bytes(*scheduled, CLOCK) == calendar_bytes(*scheduled, CLOCK)
