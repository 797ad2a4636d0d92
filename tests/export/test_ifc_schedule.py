"""The assembly plan in the IFC file: tasks, their order, times, and what they build."""

from collections.abc import Mapping
from datetime import date, datetime, timedelta

import ifcopenshell
import ifcopenshell.api.sequence
import ifcopenshell.util.date
import networkx as nx
import pytest
from making import a_step, planned_work
from test_ifc_sample import sampled, sampled_steps

from aag_cad.design import Design
from aag_cad.export.ifc.model import ifc_model
from aag_cad.export.ifc.options import IfcOptions
from aag_cad.export.ifc.schedule import PlannedWork
from aag_cad.parts.model import Gridshell, all_parts
from assembly.base.errors import PlanError
from assembly.base.steps import Plan, Step
from assembly.booklet.step_words import step_hold, step_title
from assembly.plan.clock import Clock
from assembly.plan.schedule import Timing, critical_path, precedence, timings

FIRST = datetime(2000, 1, 1, 9)


@pytest.fixture(scope="module")
def sample(gridshell: Gridshell) -> Gridshell:
    return sampled(gridshell)


@pytest.fixture(scope="module")
def steps(gridshell: Gridshell, sample: Gridshell) -> tuple[Step, ...]:
    return sampled_steps(gridshell, sample)


@pytest.fixture(scope="module")
def work(sample: Gridshell, steps: tuple[Step, ...], design: Design) -> PlannedWork:
    return planned_work(sample, steps, design.crew)


@pytest.fixture(scope="module")
def ifc(sample: Gridshell, work: PlannedWork) -> ifcopenshell.file:
    return ifc_model(sample, work).file


@pytest.fixture(scope="module")
def times(work: PlannedWork) -> Mapping[str, Timing]:
    return {step.id: step.timing for step in work.schedule.steps}


def test_every_step_is_a_task_under_the_schedule_of_a_work_plan(
    ifc: ifcopenshell.file, steps: tuple[Step, ...]
) -> None:
    (plan,), (schedule,) = ifc.by_type("IfcWorkPlan"), ifc.by_type("IfcWorkSchedule")
    assert [relation.RelatedObjects for relation in plan.IsDecomposedBy] == [(schedule,)]
    assert [relation.RelatingContext for relation in plan.HasContext] == [*ifc.by_type("IfcProject")]
    (control,) = schedule.Controls
    assert [(task.Identification, task.Name, task.ObjectType) for task in control.RelatedObjects] == [
        (step.id, step_title(step, "en"), step.phase) for step in steps
    ]


def test_tasks_follow_each_other_as_the_steps_do(ifc: ifcopenshell.file, steps: tuple[Step, ...]) -> None:
    order = {
        (each.RelatingProcess.Identification, each.RelatedProcess.Identification, each.SequenceType)
        for each in ifc.by_type("IfcRelSequence")
    }
    assert order == {(before, step.id, "FINISH_START") for step in steps for before in step.predecessors}


def test_each_part_is_built_by_one_task_and_each_task_names_what_it_works_on(
    ifc: ifcopenshell.file, steps: tuple[Step, ...], sample: Gridshell
) -> None:
    built = [each.RelatingProduct.Name for each in ifc.by_type("IfcRelAssignsToProduct")]
    assert sorted(built) == sorted(part.mark for part in all_parts(sample))
    worked_on = {
        each.RelatingProcess.Identification: {element.Name for element in each.RelatedObjects}
        for each in ifc.by_type("IfcRelAssignsToProcess")
    }
    assert worked_on == {step.id: {*step.marks, *step.assemblies} for step in steps if step.marks or step.assemblies}


def test_tasks_have_the_times_of_the_schedule(ifc: ifcopenshell.file, work: PlannedWork) -> None:
    when, clock = {step.id: step for step in work.schedule.steps}, work.clock
    for task in ifc.by_type("IfcTask"):
        time, step = task.TaskTime, when[task.Identification]
        assert time.ScheduleDuration == f"PT{step.end_minute - step.start_minute}M"
        assert time.ScheduleStart == clock.begins(step.start_minute).isoformat()
        assert time.ScheduleFinish == clock.ends(step.end_minute).isoformat()
        assert time.TotalFloat == f"PT{step.slack}M"
        assert time.IsCritical == step.critical
        assert time.EarlyStart <= time.ScheduleStart < time.ScheduleFinish
        assert datetime.fromisoformat(time.EarlyStart) <= datetime.fromisoformat(time.LateStart)


def test_a_step_by_step_longest_path_is_critical(
    times: Mapping[str, Timing], sample: Gridshell, steps: tuple[Step, ...]
) -> None:
    """By networkx on the same minutes: its longest path holds only critical steps and ends where the last step ends."""
    path = critical_path(Plan("vault", steps), {step: timing.minutes for step, timing in times.items()})
    assert all(times[step].critical for step in path)
    assert sum(times[step].minutes for step in path) == max(timing.early_finish for timing in times.values())


def _with_minutes_as_days(file: ifcopenshell.file) -> ifcopenshell.file:
    """Return a copy in which each minute of work is a day: IfcOpenShell counts in whole days only."""
    copy = ifcopenshell.file.from_string(file.to_string())
    for time in copy.by_type("IfcTaskTime"):
        days = int(time.ScheduleDuration.removeprefix("PT").removesuffix("M"))
        time.ScheduleDuration = f"P{days}D"
        time.DurationType = "ELAPSEDTIME"
        time.ScheduleStart = FIRST.isoformat()
        time.ScheduleFinish = (FIRST + timedelta(days=days - 1, hours=8)).isoformat()
        for name in ("EarlyStart", "EarlyFinish", "LateStart", "LateFinish", "FreeFloat", "TotalFloat", "IsCritical"):
            setattr(time, name, None)
    return copy


def test_the_librarys_own_critical_path_agrees_with_ours(ifc: ifcopenshell.file, times: Mapping[str, Timing]) -> None:
    """Cascaded and recalculated by IfcOpenShell: the same critical steps, floats and earliest starts."""
    copy = _with_minutes_as_days(ifc)
    tasks = {task.Identification: task for task in copy.by_type("IfcTask")}
    for task in tasks.values():
        if not task.IsSuccessorFrom:
            ifcopenshell.api.sequence.cascade_schedule(copy, task=task)
    ifcopenshell.api.sequence.recalculate_schedule(copy, work_schedule=copy.by_type("IfcWorkSchedule")[0])
    days = ifcopenshell.util.date.ifc2datetime
    for ident, task in tasks.items():
        time, timing = task.TaskTime, times[ident]
        assert time.IsCritical == timing.critical
        assert days(time.TotalFloat).days == timing.total
        assert days(time.FreeFloat).days == timing.free
        assert (days(time.EarlyStart) - FIRST).days == timing.early_start
        assert (days(time.ScheduleStart) - FIRST).days == timing.early_start
        assert (days(time.LateFinish) - FIRST).days + 1 == timing.late_finish
    assert 0 < sum(timing.critical for timing in times.values()) < len(times)


def test_floats_of_a_diamond_of_steps_are_those_of_the_textbook() -> None:
    """A 10 min, then b 30 and c 5 side by side, then d 20: c may be 25 min late, and delays nothing before d."""
    chain = (("a", ()), ("b", ("a",)), ("c", ("a",)), ("d", ("b", "c")))
    plan = Plan("x", tuple(a_step(i, id=name, predecessors=after) for i, (name, after) in enumerate(chain, start=1)))
    minutes = {"a": 10, "b": 30, "c": 5, "d": 20}
    found = timings(precedence(plan, minutes), minutes)
    assert {ident: timing.total for ident, timing in found.items()} == {"a": 0, "b": 0, "c": 25, "d": 0}
    assert found["c"].free == 25
    assert (found["d"].early_start, found["d"].early_finish) == (40, 60)


def test_work_goes_on_the_next_working_day() -> None:
    """Eight hours a day from 7 o'clock, Monday to Friday."""
    work = Clock(date(2000, 1, 3), 480, 5)
    assert work.begins(0) == datetime(2000, 1, 3, 7)
    assert work.ends(480) == datetime(2000, 1, 3, 15)
    assert work.begins(480) == datetime(2000, 1, 4, 7)
    assert work.ends(5 * 480) == datetime(2000, 1, 7, 15)
    assert work.begins(5 * 480 + 30) == datetime(2000, 1, 10, 7, 30)
    assert Clock(date(2000, 1, 5), 480, 7).begins(3 * 480) == datetime(2000, 1, 8, 7)


def test_tasks_tell_their_people_and_what_to_check(ifc: ifcopenshell.file, steps: tuple[Step, ...]) -> None:
    told = {
        relation.RelatedObjects[0].Identification: {
            each.Name: each.NominalValue.wrappedValue for each in relation.RelatingPropertyDefinition.HasProperties
        }
        for relation in ifc.by_type("IfcRelDefinesByProperties")
        if relation.RelatingPropertyDefinition.Name == "AAG_Step"
    }
    assert {ident: (row["StepNumber"], row["Crew"], row.get("Hold", "")) for ident, row in told.items()} == {
        step.id: (step.number, step.crew, step_hold(step, "en")) for step in steps
    }


def test_a_first_day_without_work_is_named(sample: Gridshell, steps: tuple[Step, ...], design: Design) -> None:
    crew = design.crew.model_copy(update={"start": "2027-03-06"})
    with pytest.raises(PlanError, match=r"crew\.start: 2027-03-06 is a Saturday"):
        ifc_model(sample, planned_work(sample, steps, crew))


def test_a_file_without_steps_and_one_of_ifc2x3_have_no_schedule(sample: Gridshell, work: PlannedWork) -> None:
    for model in (ifc_model(sample), ifc_model(sample, work, IfcOptions(schema="IFC2X3"))):
        assert not model.file.by_type("IfcWorkSchedule")
        assert not model.file.by_type("IfcTask")


def test_the_order_of_tasks_is_acyclic(ifc: ifcopenshell.file) -> None:
    graph = nx.DiGraph((each.RelatingProcess, each.RelatedProcess) for each in ifc.by_type("IfcRelSequence"))
    assert nx.is_directed_acyclic_graph(graph)
