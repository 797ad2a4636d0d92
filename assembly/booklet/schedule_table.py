"""The schedule as a table: one line for each step."""

from math import ceil

from aag_cad.language import Language
from assembly.base.steps import Plan
from assembly.booklet.step_words import step_title
from assembly.plan.schedule import Schedule

SCHEDULE_HEADER = (
    "number", "step", "phase", "shell", "title", "people", "minutes", "start_minute", "end_minute", "start_day",
    "end_day", "slack_minutes", "critical", "predecessors",
)  # fmt: skip


def schedule_rows(plan: Plan, schedule: Schedule, language: Language = "en") -> list[tuple[str, ...]]:
    """Return one line for each step in the order of ``SCHEDULE_HEADER``; days count from 1, predecessors by number."""
    numbers = {step.id: step.number for step in plan.steps}
    rows: list[tuple[str, ...]] = []
    for step, when in zip(plan.steps, schedule.steps, strict=True):
        first = when.start_minute // schedule.day_minutes + 1
        last = max(first, ceil(when.end_minute / schedule.day_minutes))
        figures = (when.people, when.end_minute - when.start_minute, when.start_minute, when.end_minute)
        after = " ".join(str(numbers[before]) for before in step.predecessors)
        told = (step.number, step.id, step.phase, step.shell, step_title(step, language), *figures, first, last)
        rows.append((*map(str, told), str(when.slack), "yes" if when.critical else "no", after))
    return rows
