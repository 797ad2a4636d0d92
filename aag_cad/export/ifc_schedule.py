"""The assembly plan in IFC: a work plan with a schedule of one task for each step, its dates and what it builds."""

from collections.abc import Mapping, Sequence
from datetime import date, timedelta

from aag_cad.errors import DesignError
from aag_cad.export.ifc_base import TIMESTAMP, Entity, IfcModel, declare, rooted
from aag_cad.export.ifc_sets import Property, write_property_set
from aag_cad.export.ifc_tasks import Timing, timings
from aag_cad.parts.model import Gridshell
from assembly.steps import Step

_BEGIN, _END = "T09:00:00", "T17:00:00"


def _first_day(text: str) -> date:
    try:
        return date.fromisoformat(text)
    except ValueError as error:
        raise DesignError(f"ifc start: {text!r} is not a date; write YYYY-MM-DD") from error


def _task_time(model: IfcModel, timing: Timing, first: date) -> Entity:
    """Write the times of a task; each day counts, as no calendar says otherwise."""

    def at(day: int, hour: str) -> str:
        return f"{first + timedelta(days=day)}{hour}"

    start, finish = at(timing.early_start, _BEGIN), at(timing.early_finish, _END)
    return model.file.create_entity(
        "IfcTaskTime", DataOrigin="PREDICTED", DurationType="ELAPSEDTIME", ScheduleDuration=f"P{timing.days}D",
        ScheduleStart=start, ScheduleFinish=finish, EarlyStart=start, EarlyFinish=finish,
        LateStart=at(timing.late_start, _BEGIN), LateFinish=at(timing.late_finish, _END),
        FreeFloat=f"P{timing.free}D", TotalFloat=f"P{timing.total}D", IsCritical=timing.critical,
    )  # fmt: skip


def _task(model: IfcModel, step: Step, timing: Timing, first: date) -> Entity:
    return rooted(
        model, "IfcTask", ("task", step.id), step.title, " ".join(step.instructions) or None, step.phase, step.id,
        IsMilestone=False, TaskTime=_task_time(model, timing, first), PredefinedType="INSTALLATION",
    )  # fmt: skip


def _write_step(
    model: IfcModel, step: Step, timing: Timing, tasks: Mapping[str, Entity], elements: Mapping[str, Entity]
) -> None:
    """Write what a step works on, what it adds, what must be finished before it, and the people it takes."""
    task = tasks[step.id]
    for before in step.predecessors:
        rooted(
            model, "IfcRelSequence", ("sequence", before, step.id), None, None, tasks[before], task, None,
            "FINISH_START",
        )  # fmt: skip
    if worked_on := [elements[mark] for mark in dict.fromkeys((*step.marks, *step.assemblies))]:
        rooted(model, "IfcRelAssignsToProcess", ("worked on", step.id), None, None, worked_on, None, task)
    for mark in dict.fromkeys(step.marks):
        rooted(
            model, "IfcRelAssignsToProduct", ("built", step.id, mark), None, None, [task], None, elements[mark]
        )  # fmt: skip
    rows: list[Property] = [
        ("StepNumber", "IfcInteger", step.number),
        ("Crew", "IfcInteger", step.crew),
        ("PersonHours", "IfcReal", timing.person_hours),
    ]
    if step.hold:
        rows.append(("Hold", "IfcText", step.hold))
    write_property_set(model, "AAG_Step", f"task/{step.id}", rows, [task])


def write_schedule(
    model: IfcModel, gridshell: Gridshell, steps: Sequence[Step], elements: Mapping[str, Entity]
) -> None:
    """Write the steps in their order; ``elements`` holds parts and assemblies by mark.

    DesignError if the first day of the options is no date.
    """
    first, found = _first_day(model.options.start), timings(steps)
    start = f"{first}{_BEGIN}"
    last = first + timedelta(days=max((timing.early_finish for timing in found.values()), default=0))
    dates = {"CreationDate": TIMESTAMP, "StartTime": start, "FinishTime": f"{last}{_END}", "PredefinedType": "PLANNED"}
    plan = rooted(model, "IfcWorkPlan", ("plan",), f"Assembly of {gridshell.name}", **dates)
    schedule = rooted(model, "IfcWorkSchedule", ("schedule",), f"Steps of {gridshell.name}", **dates)
    declare(model, "plan", [plan])
    rooted(model, "IfcRelAggregates", ("aggregates", "plan"), None, None, plan, [schedule])
    tasks = {step.id: _task(model, step, found[step.id], first) for step in steps}
    if tasks:
        rooted(
            model, "IfcRelAssignsToControl", ("scheduled",), None, None, list(tasks.values()), None, schedule
        )  # fmt: skip
    for step in steps:
        _write_step(model, step, found[step.id], tasks, elements)
