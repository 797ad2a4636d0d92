"""When each step is done: a schedule that never needs more people than the crew has."""

from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from math import ceil

import networkx as nx

from assembly.base.errors import PlanError
from assembly.base.phases import PHASE
from assembly.base.steps import Plan

MINUTES_PER_HOUR = 60


@dataclass(frozen=True)
class Timing:
    """When a step is done at the earliest and at the latest if people are no limit, in minutes of work from the start.

    ``free`` is by how much it may be late without delaying any step after it, ``total`` without delaying the end.
    """

    minutes: int
    early_start: int
    late_start: int
    free: int

    @property
    def early_finish(self) -> int:
        """The end of the step if it starts as early as it can."""
        return self.early_start + self.minutes

    @property
    def late_finish(self) -> int:
        """The end of the step if it starts as late as it may."""
        return self.late_start + self.minutes

    @property
    def total(self) -> int:
        """By how much the step may be late without delaying the end."""
        return self.late_start - self.early_start

    @property
    def critical(self) -> bool:
        """Whether the step lies on a longest chain of steps."""
        return self.total == 0


@dataclass(frozen=True)
class ScheduledStep:
    """When a step is done, in minutes of work since the start, by how many people; ``timing`` if these are no limit."""

    id: str
    start_minute: int
    end_minute: int
    people: int
    timing: Timing

    @property
    def slack(self) -> int:
        """By how many minutes it could be late, with people enough, without a later end of the whole."""
        return self.timing.total

    @property
    def critical(self) -> bool:
        """Whether it has no slack."""
        return self.timing.critical


@dataclass(frozen=True)
class Schedule:
    """The steps of a plan in their order, for a crew of ``people``.

    ``critical_path`` is a longest chain of steps if people were no limit; no schedule of this crew is shorter than
    ``lower_bound`` minutes.
    """

    name: str
    people: int
    day_minutes: int
    steps: tuple[ScheduledStep, ...]
    critical_path: tuple[str, ...]
    lower_bound: int

    @property
    def makespan(self) -> int:
        """Minutes of work from the start of the first step to the end of the last."""
        return max((step.end_minute for step in self.steps), default=0)

    @property
    def ratio(self) -> float:
        """How many times the lower bound the schedule takes; 1 is the shortest possible."""
        return self.makespan / self.lower_bound if self.lower_bound else 1.0

    @property
    def days(self) -> float:
        """The makespan in working days."""
        return self.makespan / self.day_minutes


def precedence(plan: Plan, minutes: Mapping[str, int]) -> "nx.DiGraph[str]":
    """Return the steps as a graph: an edge to each step from what it waits for, weighted by the minutes of the latter.

    PlanError if an id stands twice, a predecessor or a time is missing, or steps wait for each other in a circle.
    """
    graph: nx.DiGraph[str] = nx.DiGraph()
    for step in plan.steps:
        if step.id in graph:
            raise PlanError(f"step {step.id}: the id stands twice, allowed once; rename one of the steps")
        if minutes.get(step.id, -1) < 0:
            raise PlanError(f"step {step.id}: {minutes.get(step.id)} minutes; give each step 0 minutes or more")
        graph.add_node(step.id)
    for step in plan.steps:
        for before in step.predecessors:
            if before not in graph:
                raise PlanError(
                    f"step {step.id}: it waits for {before}, which is no step of the plan; remove or add it"
                )
            graph.add_edge(before, step.id, minutes=minutes[before])
    if not nx.is_directed_acyclic_graph(graph):
        circle = " -> ".join(before for before, _ in nx.find_cycle(graph))
        raise PlanError(f"steps {circle}: each waits for the one before and the first for the last; break the circle")
    return graph


def timings(graph: "nx.DiGraph[str]", minutes: Mapping[str, int]) -> dict[str, Timing]:
    """Return when each step of a ``precedence`` can be done if people are no limit, by the critical path method."""
    order = list(nx.topological_sort(graph))
    early: dict[str, int] = {}
    for step in order:
        early[step] = max((early[before] + minutes[before] for before in graph.predecessors(step)), default=0)
    end = max((early[step] + minutes[step] for step in order), default=0)
    late: dict[str, int] = {}
    for step in reversed(order):
        late[step] = min((late[after] for after in graph.successors(step)), default=end) - minutes[step]
    following = {step: min((early[after] for after in graph.successors(step)), default=end) for step in order}
    return {s: Timing(minutes[s], early[s], late[s], following[s] - early[s] - minutes[s]) for s in order}


def critical_path(plan: Plan, minutes: Mapping[str, int]) -> tuple[str, ...]:
    """Return the ids of a longest chain of steps by their minutes, if people are no limit; PlanError as precedence."""
    graph = precedence(plan, minutes)
    # The time of the last step of a chain counts too: an edge to an end that takes no time carries it.
    graph.add_weighted_edges_from(((step.id, "", minutes[step.id]) for step in plan.steps), weight="minutes")
    return tuple(nx.dag_longest_path(graph, weight="minutes")[:-1]) if plan.steps else ()


def _span(found: Mapping[str, Timing]) -> int:
    return max((timing.early_finish for timing in found.values()), default=0)


def lower_bound(plan: Plan, minutes: Mapping[str, int], people: int) -> int:
    """Return minutes that no schedule of a crew can undercut.

    The largest of the longest chain, the person-minutes of all steps shared by the crew, and the time of steps of which
    no two go on at once because each needs more than half of the crew (half of the time of those that need just half).
    """
    chain = _span(timings(precedence(plan, minutes), minutes))
    shared = sum(step.crew * minutes[step.id] for step in plan.steps)
    alone = sum(minutes[step.id] for step in plan.steps if 2 * step.crew > people)
    halves = sum(minutes[step.id] for step in plan.steps if 2 * step.crew == people)
    return max(chain, ceil(shared / people), alone + ceil(halves / 2))


def _first_fit(times: list[int], free: list[int], earliest: int, minutes: int, people: int) -> int:
    """Return the first time from ``earliest`` on at which ``people`` are free for ``minutes``.

    ``free[i]`` people are free from ``times[i]`` until the next of the times.
    """
    start, i = earliest, bisect_right(times, earliest) - 1
    while i < len(times) and times[i] < start + minutes:
        if free[i] < people:
            start = times[i + 1]
        i += 1
    return start


def _take(times: list[int], free: list[int], start: int, end: int, people: int) -> None:
    """Take people away from ``start`` to ``end``."""
    for time in (start, end):
        i = bisect_right(times, time)
        if times[i - 1] != time:
            times.insert(i, time)
            free.insert(i, free[i - 1])
    for i in range(bisect_right(times, start) - 1, bisect_right(times, end) - 1):
        free[i] -= people


def _starts(plan: Plan, graph: "nx.DiGraph[str]", found: Mapping[str, Timing], people: int, day: int) -> dict[str, int]:
    """Return the start of each step by the serial scheme: of the steps that may begin, that with the longest tail.

    It starts as early as what it waits for and free people allow; an unbroken step waits for the next morning where it
    would not end on the same day.
    """
    by_id, span = {step.id: step for step in plan.steps}, _span(found)
    minutes = {step: timing.minutes for step, timing in found.items()}
    tails = {step: span - timing.late_start for step, timing in found.items()}
    number = {step.id: i for i, step in enumerate(plan.steps)}
    waiting = {step: degree for step, degree in graph.in_degree() if degree}
    ready = [(-tails[step], number[step], step) for step in graph if step not in waiting]
    heapify(ready)
    times, free, starts = [0], [people], dict[str, int]()
    while ready:
        _, _, step = heappop(ready)
        length, crew = minutes[step], by_id[step].crew
        earliest = max((starts[before] + minutes[before] for before in graph.predecessors(step)), default=0)
        start = _first_fit(times, free, earliest, length, crew)
        while PHASE[by_id[step].phase].unbroken and start % day > 0 and start % day + length > day:
            start = _first_fit(times, free, (start // day + 1) * day, length, crew)
        if length:
            _take(times, free, start, start + length, crew)
        starts[step] = start
        for after in graph.successors(step):
            waiting[after] -= 1
            if not waiting[after]:
                heappush(ready, (-tails[after], number[after], after))
    return starts


def schedule_of(plan: Plan, minutes: Mapping[str, int], people: int, hours_per_day: float = 8.0) -> Schedule:
    """Return the schedule of a plan for a crew; ``minutes`` of each step by id (``assembly.plan.durations``).

    List scheduling by the serial scheme (Kolisch 1996), priority to the longest remaining path. Steps that hold a shell
    in slings end on the day on which they begin, or begin in the morning if they take longer. PlanError if a step needs
    more people than there are, or the plan is no order at all.
    """
    day = round(hours_per_day * MINUTES_PER_HOUR)
    if day < 1:
        raise PlanError(f"crew.hours_per_day: {hours_per_day:g} hours; allowed more than 0: mend it")
    crowded = [step for step in plan.steps if not 1 <= step.crew <= people]
    if crowded:
        raise PlanError(
            f"step {crowded[0].id}: it takes {crowded[0].crew} people, allowed 1 to {people}: plan it for this "
            "crew, or enlarge crew.people"
        )
    graph = precedence(plan, minutes)
    found = timings(graph, minutes)
    starts = _starts(plan, graph, found, people, day)
    steps = (ScheduledStep(s.id, starts[s.id], starts[s.id] + minutes[s.id], s.crew, found[s.id]) for s in plan.steps)
    bound = lower_bound(plan, minutes, people)
    return Schedule(plan.name, people, day, tuple(steps), critical_path(plan, minutes), bound)


def people_curve(schedule: Schedule) -> tuple[tuple[int, int], ...]:
    """Return (minute, people at work from then on) wherever their number changes, from 0 to the end of the schedule."""
    changes: dict[int, int] = {0: 0}
    for step in schedule.steps:
        changes[step.start_minute] = changes.get(step.start_minute, 0) + step.people
        changes[step.end_minute] = changes.get(step.end_minute, 0) - step.people
    curve: list[tuple[int, int]] = []
    busy = 0
    for minute, change in sorted(changes.items()):
        busy += change
        if not curve or curve[-1][1] != busy:
            curve.append((minute, busy))
    return tuple(curve)
