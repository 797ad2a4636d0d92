"""The assembly plan in IFC: a work plan with a schedule of one task for each step, its times and what it builds."""

from collections.abc import Mapping, Sequence
from datetime import date

from aag_cad.design_making import Minutes
from aag_cad.errors import DesignError
from aag_cad.export.ifc.frame import TIMESTAMP, Entity, IfcModel, declare, rooted
from aag_cad.export.ifc.options import IfcOptions
from aag_cad.export.ifc.sets import Property, write_property_set
from aag_cad.export.ifc.tasks import Timing, WorkingTime, timings
from aag_cad.parts.model import Gridshell
from assembly.base.steps import Plan, Step
from assembly.plan.durations import step_minutes
from assembly.plan.schedule import Schedule, ScheduledStep, schedule_of

# A Monday: a file must not change with the day on which it is written.
_NO_DATE = "2000-01-03"
_HOURS_PER_DAY = 8.0
_DAYS_PER_WEEK = 5


def scheduled(gridshell: Gridshell, steps: Sequence[Step], options: IfcOptions) -> tuple[dict[str, Timing], Schedule]:
    """Return the timing of each step by its id and the schedule for the crew of the options.

    Without a crew the times are the estimates of ``Minutes``, and there are as many people as the largest step takes.
    PlanError if the steps are no order or take more people than there are.
    """
    crew, plan = options.crew, Plan(gridshell.name, tuple(steps))
    minutes = step_minutes(plan, gridshell, crew.minutes if crew else Minutes.model_validate({}))
    people = crew.people if crew else max((step.crew for step in steps), default=1)
    hours = crew.hours_per_day if crew else _HOURS_PER_DAY
    return timings(plan, minutes), schedule_of(plan, minutes, people, hours)


def _working_time(schedule: Schedule, options: IfcOptions) -> WorkingTime:
    text = (options.crew.start if options.crew else None) or _NO_DATE
    days = options.crew.days_per_week if options.crew else _DAYS_PER_WEEK
    try:
        return WorkingTime(date.fromisoformat(text), schedule.day_minutes, days)
    except ValueError as error:
        raise DesignError(f"crew.start: {text!r} is not a date; write YYYY-MM-DD") from error


def _span(minutes: int) -> str:
    return f"PT{minutes}M"


def _task_time(model: IfcModel, timing: Timing, step: ScheduledStep, work: WorkingTime) -> Entity:
    """Write the times of a task: as scheduled for the crew, and the earliest and latest if people were no limit."""
    return model.file.create_entity(
        "IfcTaskTime", DataOrigin="PREDICTED", DurationType="WORKTIME", ScheduleDuration=_span(timing.minutes),
        ScheduleStart=work.start(step.start_minute), ScheduleFinish=work.finish(step.end_minute),
        EarlyStart=work.start(timing.early_start), EarlyFinish=work.finish(timing.early_finish),
        LateStart=work.start(timing.late_start), LateFinish=work.finish(timing.late_finish),
        FreeFloat=_span(timing.free), TotalFloat=_span(timing.total), IsCritical=timing.critical,
    )  # fmt: skip


def _task(model: IfcModel, step: Step, time: Entity) -> Entity:
    return rooted(
        model, "IfcTask", ("task", step.id), step.title, " ".join(step.instructions) or None, step.phase, step.id,
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
    if step.hold:
        rows.append(("Hold", "IfcText", step.hold))
    write_property_set(model, "AAG_Step", f"task/{step.id}", rows, [task])


def write_schedule(
    model: IfcModel, gridshell: Gridshell, steps: Sequence[Step], elements: Mapping[str, Entity]
) -> None:
    """Write the steps in their order; ``elements`` holds parts and assemblies by mark.

    DesignError if the first day of work is no date, PlanError if the steps are no order.
    """
    found, schedule = scheduled(gridshell, steps, model.options)
    work = _working_time(schedule, model.options)
    dates = {
        "CreationDate": TIMESTAMP,
        "StartTime": work.start(0),
        "FinishTime": work.finish(schedule.makespan),
        "PredefinedType": "PLANNED",
    }
    plan = rooted(model, "IfcWorkPlan", ("plan",), f"Assembly of {gridshell.name}", **dates)
    control = rooted(model, "IfcWorkSchedule", ("schedule",), f"Steps of {gridshell.name}", **dates)
    declare(model, "plan", [plan])
    rooted(model, "IfcRelAggregates", ("aggregates", "plan"), None, None, plan, [control])
    tasks = {
        step.id: _task(model, step, _task_time(model, found[step.id], when, work))
        for step, when in zip(steps, schedule.steps, strict=True)
    }
    if tasks:
        related = list(tasks.values())
        rooted(model, "IfcRelAssignsToControl", ("scheduled",), None, None, related, None, control)
    for step in steps:
        _write_step(model, step, found[step.id].minutes, tasks, elements)
