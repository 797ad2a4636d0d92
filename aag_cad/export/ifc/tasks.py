"""When the steps of a plan can be done, in minutes of work, and which of them are critical."""

from collections.abc import Mapping
from dataclasses import dataclass

import networkx as nx

from assembly.base.steps import Plan
from assembly.plan.schedule import precedence


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


def timings(plan: Plan, minutes: Mapping[str, int]) -> dict[str, Timing]:
    """Return the timing of every step by its id, by the critical path method; PlanError if the plan is no order."""
    graph = precedence(plan, minutes)
    order = list(nx.topological_sort(graph))
    early: dict[str, int] = {}
    for step in order:
        early[step] = max((early[before] + minutes[before] for before in graph.predecessors(step)), default=0)
    end = max((early[step] + minutes[step] for step in order), default=0)
    late: dict[str, int] = {}
    for step in reversed(order):
        late[step] = min((late[after] for after in graph.successors(step)), default=end) - minutes[step]
    next_start = {step: min((early[after] for after in graph.successors(step)), default=end) for step in order}
    return {
        step.id: Timing(
            minutes=minutes[step.id],
            early_start=early[step.id],
            late_start=late[step.id],
            free=next_start[step.id] - early[step.id] - minutes[step.id],
        )
        for step in plan.steps
    }
