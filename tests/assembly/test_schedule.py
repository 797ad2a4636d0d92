"""Scheduling a crew: nobody in two places, nothing before its turn, as short as can be told."""

from dataclasses import replace
from itertools import pairwise

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st
from making import a_step

from aag_cad.design import Design, design_text, parse_design
from aag_cad.design_making import Minutes
from aag_cad.errors import DesignError
from aag_cad.parts.model import Gridshell
from assembly.base.errors import PlanError
from assembly.base.phases import PHASE
from assembly.base.steps import Plan, Step
from assembly.booklet.schedule_table import SCHEDULE_HEADER, schedule_rows
from assembly.plan.assembly_plan import plan_of
from assembly.plan.durations import person_minutes, step_minutes, step_works
from assembly.plan.schedule import critical_path, lower_bound, people_curve, schedule_of

MINUTES = Minutes.model_validate({})


def chained(number: int, after: tuple[str, ...] = (), crew: int = 1) -> Step:
    return a_step(number, f"Step {number}", shell="S1", predecessors=after, crew=crew)


@st.composite
def plans(draw: st.DrawFn) -> tuple[Plan, dict[str, int], int]:
    """Return a random plan whose steps wait only for earlier ones, times of its steps and a crew that can do them."""
    people = draw(st.integers(1, 5))
    steps: list[Step] = []
    for number in range(1, draw(st.integers(1, 14)) + 1):
        before = draw(st.sets(st.sampled_from([step.id for step in steps]), max_size=3)) if steps else set()
        hoisted = draw(st.booleans())
        step = chained(number, tuple(sorted(before)), draw(st.integers(1, people)))
        steps.append(replace(step, phase="hoist") if hoisted else step)
    return Plan("random", tuple(steps)), {step.id: draw(st.integers(0, 200)) for step in steps}, people


@given(plans())
def test_every_plan_is_scheduled_within_its_crew_and_order(case: tuple[Plan, dict[str, int], int]) -> None:
    plan, minutes, people = case
    schedule = schedule_of(plan, minutes, people, hours_per_day=4.0)
    assert [when.id for when in schedule.steps] == [step.id for step in plan.steps]
    times = {when.id: when for when in schedule.steps}
    for step in plan.steps:
        when = times[step.id]
        assert when.end_minute - when.start_minute == minutes[step.id]
        assert all(times[before].end_minute <= when.start_minute for before in step.predecessors)
        if PHASE[step.phase].unbroken and minutes[step.id] <= 240:
            assert when.start_minute // 240 == max(when.start_minute, when.end_minute - 1) // 240
    for minute in range(schedule.makespan):
        assert sum(when.people for when in schedule.steps if when.start_minute <= minute < when.end_minute) <= people
    assert schedule.makespan >= schedule.lower_bound
    assert schedule == schedule_of(plan, minutes, people, hours_per_day=4.0)


@given(plans())
def test_with_people_enough_the_schedule_is_as_long_as_the_critical_path(
    case: tuple[Plan, dict[str, int], int],
) -> None:
    plan, minutes, _ = case
    loose = replace(plan, steps=tuple(replace(step, phase="studs") for step in plan.steps))
    schedule = schedule_of(loose, minutes, 100)
    path = schedule.critical_path
    assert schedule.makespan == schedule.lower_bound == sum(minutes[step] for step in path)
    times, steps = {when.id: when for when in schedule.steps}, {step.id: step for step in plan.steps}
    assert all(times[step].critical for step in path)
    assert all(before in steps[after].predecessors for before, after in pairwise(path))


@given(plans())
def test_slack_is_how_late_a_step_may_be_without_a_later_end(case: tuple[Plan, dict[str, int], int]) -> None:
    plan, minutes, _ = case
    loose = replace(plan, steps=tuple(replace(step, phase="studs", crew=1) for step in plan.steps))
    schedule = schedule_of(loose, minutes, 100)
    for when in schedule.steps:
        late = minutes | {when.id: minutes[when.id] + when.slack}
        later = minutes | {when.id: minutes[when.id] + when.slack + 1}
        assert schedule_of(loose, late, 100).makespan == schedule.makespan
        assert schedule_of(loose, later, 100).makespan == schedule.makespan + 1


@given(plans())
def test_nobody_beats_the_lower_bound_even_with_the_best_order(case: tuple[Plan, dict[str, int], int]) -> None:
    """Try all orders of the first five steps by the serial scheme, one of which is the shortest (Kolisch 1996)."""
    plan, minutes, people = case
    few = Plan("few", tuple(replace(step, phase="studs") for step in plan.steps[:5]))
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from(step.id for step in few.steps)
    graph.add_edges_from((before, step.id) for step in few.steps for before in step.predecessors)
    steps, best = {step.id: step for step in few.steps}, 10**9
    for order in nx.all_topological_sorts(graph):
        busy, ends = [0] * 2000, dict[str, int]()
        for name in order:
            start = max((ends[before] for before in steps[name].predecessors), default=0)
            span = minutes[name]
            while any(busy[minute] + steps[name].crew > people for minute in range(start, start + span)):
                start += 1
            for minute in range(start, start + span):
                busy[minute] += steps[name].crew
            ends[name] = start + span
        best = min(best, max(ends.values()))
    assert lower_bound(few, minutes, people) <= best <= schedule_of(few, minutes, people).makespan


def test_three_steps_of_two_people_take_three_turns_for_a_crew_of_three() -> None:
    plan = Plan("three", tuple(chained(i, crew=2) for i in (1, 2, 3)))
    minutes = {"s1": 10, "s2": 20, "s3": 30}
    assert lower_bound(plan, minutes, 3) == 60
    assert schedule_of(plan, minutes, 3).makespan == 60
    assert people_curve(schedule_of(plan, minutes, 3)) == ((0, 2), (60, 0))


def test_a_hoist_that_would_run_into_the_night_waits_for_the_morning() -> None:
    hoist = replace(chained(2, ("s1",)), phase="hoist")
    schedule = schedule_of(Plan("two", (chained(1), hoist)), {"s1": 400, "s2": 100}, 1)
    assert [when.start_minute for when in schedule.steps] == [0, 480]
    assert schedule.days == pytest.approx(580 / 480)


@pytest.mark.parametrize(
    ("steps", "words"),
    [
        ((chained(1, ("s2",)), chained(2, ("s1",))), "s1.*circle"),
        ((chained(1, ("s9",)),), "s1.*s9"),
        ((chained(1, crew=3),), "s1.*3 people.*crew.people"),
        ((chained(1), chained(1)), "s1.*twice"),
        ((chained(3),), "s3.*None minutes"),
    ],
)
def test_a_plan_that_is_no_order_is_refused_by_its_step(steps: tuple[Step, ...], words: str) -> None:
    with pytest.raises(PlanError, match=words):
        schedule_of(Plan("bad", steps), {"s1": 5, "s2": 5}, 2)


@pytest.fixture(scope="module")
def plan(gridshell: Gridshell) -> Plan:
    return plan_of(gridshell, 4, 25.0)


def test_the_time_of_a_step_is_the_sum_of_what_is_done_in_it(plan: Plan, gridshell: Gridshell) -> None:
    works, steps = step_works(plan, gridshell), {step.id: step for step in plan.steps}
    stud = works["S1.stud.1"].done
    assert (stud["stud"], stud["bolt"]) == (24, 96)
    assert person_minutes(steps["S1.stud.1"], works["S1.stud.1"], MINUTES) == 2 * 10 + 24 * 4 + 96 * 2
    assert step_minutes(plan, gridshell, MINUTES)["S1.stud.1"] == 154
    beams = [beam for beam in gridshell.shells[0].beams if beam.mark in steps["S1.lay.1"].assemblies]
    assert works["S1.lay.1"].done["carry"] == pytest.approx(sum(beam.curve.length for beam in beams) / 1000.0)
    assert all(not work.undone for work in works.values())


def test_measured_times_replace_our_estimates(plan: Plan, gridshell: Gridshell) -> None:
    swift = Minutes.model_validate({"stud": 2.0})
    assert step_minutes(plan, gridshell, swift)["S1.stud.1"] == 154 - 24
    assert step_minutes(plan, gridshell, swift)["S1.tighten"] == step_minutes(plan, gridshell, MINUTES)["S1.tighten"]


def test_four_people_build_the_vault_in_less_than_three_weeks(plan: Plan, gridshell: Gridshell) -> None:
    """Our estimates, not the paper's: it prints no times."""
    schedule = schedule_of(plan, step_minutes(plan, gridshell, MINUTES), 4)
    assert 10.0 < schedule.days < 15.0
    assert 1.0 <= schedule.ratio < 1.2
    assert schedule.critical_path == critical_path(plan, step_minutes(plan, gridshell, MINUTES))
    assert max(people for _, people in people_curve(schedule)) == 4


def test_more_people_never_make_the_bound_longer(gridshell: Gridshell) -> None:
    bounds = []
    for people in (2, 4, 8):
        found = plan_of(gridshell, people, 25.0)
        bounds.append(lower_bound(found, step_minutes(found, gridshell, MINUTES), people))
    assert bounds[0] > bounds[1] > bounds[2]


def test_the_table_tells_the_schedule(plan: Plan, gridshell: Gridshell) -> None:
    minutes = step_minutes(plan, gridshell, MINUTES)
    schedule = schedule_of(plan, minutes, 4)
    rows = [dict(zip(SCHEDULE_HEADER, row, strict=True)) for row in schedule_rows(plan, schedule)]
    assert [row["step"] for row in rows] == [step.id for step in plan.steps]
    assert {row["step"]: int(row["minutes"]) for row in rows} == minutes
    assert max(int(row["end_day"]) for row in rows) == -(-schedule.makespan // 480)


def test_the_design_says_hours_start_and_times(design: Design) -> None:
    assert (design.crew.hours_per_day, design.crew.days_per_week, design.crew.start) == (8.0, 5, "2027-03-01")
    assert design.crew.minutes == MINUTES


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('start = "2027-03-01"', 'start = "2027-02-30"', "crew.start"),
        ('start = "2027-03-01"', 'start = "1 March"', "year-month-day"),
        ("hours_per_day = 8.0", "hours_per_day = 25.0", "crew.hours_per_day"),
        ("[crew.minutes]", "[crew.minutes]\ncoffee = 15.0", "crew.minutes.coffee"),
    ],
)
def test_a_bad_crew_is_refused_by_its_key(old: str, new: str, words: str) -> None:
    text = design_text("vault")
    assert old in text
    with pytest.raises(DesignError, match=words):
        parse_design(text.replace(old, new))
