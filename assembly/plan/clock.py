"""When the steps of a schedule are done by the clock of the place, from the first working day."""

from dataclasses import dataclass
from datetime import date, datetime, time, timedelta

from aag_cad.design_making import Crew
from assembly.base.errors import PlanError
from assembly.plan.schedule import Schedule

# Work begins at seven; breaks are not drawn.
BEGINS = time(7)
_DAYS = ("Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday", "Sunday")


@dataclass(frozen=True)
class Clock:
    """The first working day, the minutes of work in each, and the days of a week from Monday on."""

    first: date
    day_minutes: int
    days_per_week: int

    def begins(self, minute: int) -> datetime:
        """Return when work begins after so many minutes of work: at the end of a day, the next morning."""
        return self._at(*divmod(minute, self.day_minutes))

    def ends(self, minute: int) -> datetime:
        """Return when so many minutes of work are done: at the end of a day, in the evening."""
        day, rest = divmod(max(minute - 1, 0), self.day_minutes)
        return self._at(day, min(rest + 1, minute))

    def _at(self, number: int, minutes: int) -> datetime:
        day = working_day(self.first, number, self.days_per_week)
        return datetime.combine(day, BEGINS) + timedelta(minutes=minutes)


def working_day(start: date, number: int, days_per_week: int) -> date:
    """Return the working day that comes ``number`` working days after the first one; weeks begin on Monday."""
    weeks, weekday = divmod(start.weekday() + number, days_per_week)
    return start + timedelta(days=7 * weeks + weekday - start.weekday())


def clock_of(schedule: Schedule, crew: Crew, otherwise: date | None = None) -> Clock | None:
    """Return the clock of a crew's schedule; None if the crew has no first working day and there is no ``otherwise``.

    PlanError if that is no day on which the crew works.
    """
    first = date.fromisoformat(crew.start) if crew.start is not None else otherwise
    if first is None:
        return None
    if first.weekday() >= crew.days_per_week:
        raise PlanError(
            f"crew.start: {first.isoformat()} is a {_DAYS[first.weekday()]}; allowed Monday to "
            f"{_DAYS[crew.days_per_week - 1]} (crew.days_per_week = {crew.days_per_week}): choose another day"
        )
    return Clock(first, schedule.day_minutes, crew.days_per_week)
