"""How long the steps of a plan take, in working days, and which of them are critical."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil

import networkx as nx

from assembly.steps import Phase, Step

HOURS_PER_DAY = 8.0

# Estimates, to be replaced by a contractor's own: minutes of the whole crew to set up and to check, and person-minutes
# for each part put in place and for each beam or shell moved.
_SET_UP: dict[Phase, float] = {
    "prefabricate": 15.0,
    "lay A1": 30.0,
    "lay G": 15.0,
    "lay A2": 15.0,
    "studs": 20.0,
    "hoist": 240.0,
    "edge planks": 30.0,
    "fix geodesics": 30.0,
    "tighten": 240.0,
    "feet": 60.0,
    "stand": 180.0,
    "ridges": 60.0,
    "cover": 30.0,
}
_EACH_PART: dict[Phase, float] = {"lay G": 15.0, "feet": 15.0, "ridges": 6.0, "cover": 4.0}
_EACH_ASSEMBLY = 20.0
_ANY_PART = 3.0


@dataclass(frozen=True)
class Timing:
    """When a step is done at the earliest and the latest: days from 0, of which the finish is the last worked.

    ``free`` is how many days it may slip without delaying a step after it, ``total`` without delaying the end.
    """

    person_hours: float
    days: int
    early_start: int
    late_start: int
    free: int

    @property
    def early_finish(self) -> int:
        """The last day of work if the step starts as early as it can."""
        return self.early_start + self.days - 1

    @property
    def late_finish(self) -> int:
        """The last day of work if the step starts as late as it may."""
        return self.late_start + self.days - 1

    @property
    def total(self) -> int:
        """The days by which the step may slip without delaying the end."""
        return self.late_start - self.early_start

    @property
    def critical(self) -> bool:
        """Whether the step lies on a longest path from the first day to the last."""
        return self.total == 0


def person_hours(step: Step) -> float:
    """Return the estimated work of a step: setting up by its crew, and the handling of parts and assemblies."""
    each = _EACH_PART.get(step.phase, _ANY_PART)
    handling = each * len(step.marks) + _EACH_ASSEMBLY * len(step.assemblies)
    return (_SET_UP[step.phase] * step.crew + handling) / 60.0


def working_days(step: Step) -> int:
    """Return the duration of a step: its work shared by its crew in days of 8 hours, begun days counted whole."""
    return max(1, ceil(person_hours(step) / (step.crew * HOURS_PER_DAY)))


def timings(steps: Sequence[Step]) -> dict[str, Timing]:
    """Return the timing of every step by its id, by the critical path method: a step starts when all before are done.

    There are as many crews as the plan allows at a time. Steps may stand in any order.
    """
    graph = nx.DiGraph()
    days = {step.id: working_days(step) for step in steps}
    graph.add_nodes_from(days)
    graph.add_edges_from((before, step.id) for step in steps for before in step.predecessors)
    order = list(nx.lexicographical_topological_sort(graph))
    early: dict[str, int] = {}
    for ident in order:
        early[ident] = max((early[before] + days[before] for before in graph.predecessors(ident)), default=0)
    end = max((early[ident] + days[ident] for ident in order), default=0)
    late: dict[str, int] = {}
    for ident in reversed(order):
        late[ident] = min((late[after] for after in graph.successors(ident)), default=end) - days[ident]
    return {
        step.id: Timing(
            person_hours=round(person_hours(step), 2),
            days=days[step.id],
            early_start=early[step.id],
            late_start=late[step.id],
            free=min((early[after] for after in graph.successors(step.id)), default=end)
            - early[step.id]
            - days[step.id],
        )
        for step in steps
    }
