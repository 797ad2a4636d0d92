"""The assembly plan in IFC: a work plan with a schedule of one task for each step, its times and what it builds."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import date, datetime

from aag_cad.design_making import Crew
from aag_cad.export.ifc.frame import TIMESTAMP, Entity, IfcModel, declare, rooted
from aag_cad.export.ifc.sets import Property, write_property_set
from assembly.base.segments import Segmentation
from assembly.base.steps import Plan, Step
from assembly.booklet.step_words import step_hold, step_words
from assembly.plan.clock import Clock, clock_of
from assembly.plan.schedule import Schedule, ScheduledStep

# A Monday: a file must not change with the day on which it is written.
_NO_DATE = date(2000, 1, 3)


@dataclass(frozen=True)
class PlannedWork:
    """What an IFC file says of the plan: its steps, their schedule for a crew, and the segments of cut shells."""

    plan: Plan
    schedule: Schedule
    crew: Crew
    segmentation: Segmentation | None = None

    @property
    def clock(self) -> Clock:
        """When the work is done: from the crew's first day, or from a Monday that stands for any."""
        clock = clock_of(self.schedule, self.crew, _NO_DATE)
        assert clock is not None
        return clock


def _span(minutes: int) -> str:
    return f"PT{minutes}M"


def _iso(moment: datetime) -> str:
    return moment.isoformat()


def _task_time(model: IfcModel, step: ScheduledStep, clock: Clock) -> Entity:
    """Write the times of a task: as scheduled for the crew, and the earliest and latest if people were no limit."""
    timing = step.timing
    return model.new(
        "IfcTaskTime", DataOrigin="PREDICTED", DurationType="WORKTIME", ScheduleDuration=_span(timing.minutes),
        ScheduleStart=_iso(clock.begins(step.start_minute)), ScheduleFinish=_iso(clock.ends(step.end_minute)),
        EarlyStart=_iso(clock.begins(timing.early_start)), EarlyFinish=_iso(clock.ends(timing.early_finish)),
        LateStart=_iso(clock.begins(timing.late_start)), LateFinish=_iso(clock.ends(timing.late_finish)),
        FreeFloat=_span(timing.free), TotalFloat=_span(timing.total), IsCritical=timing.critical,
    )  # fmt: skip


def _task(model: IfcModel, step: Step, time: Entity) -> Entity:
    words = step_words(step, "en")
    return rooted(
        model, "IfcTask", ("task", step.id), words.title, " ".join(words.instructions) or None, step.phase, step.id,
        IsMilestone=False, TaskTime=time, PredefinedType="INSTALLATION",
    )  # fmt: skip


def _write_step(
    model: IfcModel, step: Step, minutes: int, tasks: Mapping[str, Entity], elements: Mapping[str, Entity]
) -> None:
    """Write what a step works on, what it adds, what must be finished before it, and the people it takes."""
    task = tasks[step.id]
    for before in step.predecessors:
        names = ("sequence", before, step.id)
        rooted(model, "IfcRelSequence", names, None, None, tasks[before], task, None, "FINISH_START")
    if worked_on := [elements[mark] for mark in dict.fromkeys((*step.marks, *step.assemblies))]:
        rooted(model, "IfcRelAssignsToProcess", ("worked on", step.id), None, None, worked_on, None, task)
    for mark in dict.fromkeys(step.marks):
        names = ("built", step.id, mark)
        rooted(model, "IfcRelAssignsToProduct", names, None, None, [task], None, elements[mark])
    rows: list[Property] = [
        ("StepNumber", "IfcInteger", step.number),
        ("Crew", "IfcInteger", step.crew),
        ("PersonHours", "IfcReal", round(step.crew * minutes / 60.0, 3)),
    ]
    if step.held:
        rows.append(("Hold", "IfcText", step_hold(step, "en")))
    write_property_set(model, "AAG_Step", f"task/{step.id}", rows, [task])


def write_schedule(model: IfcModel, name: str, work: PlannedWork, elements: Mapping[str, Entity]) -> None:
    """Write the steps in their order; ``elements`` holds parts and assemblies by mark.

    PlanError if the first day of work is none on which the crew works, or the steps are no order.
    """
    schedule, clock = work.schedule, work.clock
    dates = {
        "CreationDate": TIMESTAMP,
        "StartTime": _iso(clock.begins(0)),
        "FinishTime": _iso(clock.ends(schedule.makespan)),
        "PredefinedType": "PLANNED",
    }
    plan = rooted(model, "IfcWorkPlan", ("plan",), f"Assembly of {name}", **dates)
    control = rooted(model, "IfcWorkSchedule", ("schedule",), f"Steps of {name}", **dates)
    declare(model, "plan", [plan])
    rooted(model, "IfcRelAggregates", ("aggregates", "plan"), None, None, plan, [control])
    tasks = {
        step.id: _task(model, step, _task_time(model, when, clock))
        for step, when in zip(work.plan.steps, schedule.steps, strict=True)
    }
    if tasks:
        related = list(tasks.values())
        rooted(model, "IfcRelAssignsToControl", ("scheduled",), None, None, related, None, control)
    for step, when in zip(work.plan.steps, schedule.steps, strict=True):
        _write_step(model, step, when.timing.minutes, tasks, elements)
