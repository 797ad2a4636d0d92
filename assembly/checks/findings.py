"""What the independent walks over a plan find, as error findings: one for all faults of a kind."""

import re
from collections.abc import Iterator, Mapping, Sequence

import networkx as nx

from aag_cad.findings import Finding
from aag_cad.language import text
from aag_cad.parts.model import Gridshell
from assembly.base.locking_order import LockingOrder
from assembly.base.segments import Segmentation
from assembly.base.steps import Plan
from assembly.checks.disassembly import check_disassembly
from assembly.checks.graph_plan import check_graph_plan
from assembly.checks.plan import check_plan
from assembly.checks.walking import crew_problems, time_problems

# What names one thing among many alike: marks, ids of steps, numbers.
_NAMES = re.compile(r"\b[\w.+-]*\d[\w.+-]*")


def _findings(code: str, problems: Sequence[str]) -> Iterator[Finding]:
    """Yield a finding for each kind of fault: the first in full, and how many there are."""
    kinds: dict[str, list[str]] = {}
    for problem in problems:
        kinds.setdefault(_NAMES.sub("", problem), []).append(problem)
    for alike in kinds.values():
        first, _, rest = alike[0].partition(": ")
        mark, told = (first, rest) if rest and " " not in first else ("", alike[0])
        what = text(f"checks.{code}.what", problem=told)
        yield Finding(code, "error", mark or "plan", what, float(len(alike)), 0.0, "", text("checks.remedy"))


def plan_faults(
    plan: Plan, gridshell: Gridshell, segmentation: Segmentation | None, locking: Sequence[LockingOrder]
) -> tuple[Finding, ...]:
    """Return what is wrong with a plan of putting together, as AAG981; see ``check_plan``."""
    return tuple(_findings("AAG981", check_plan(plan, gridshell, segmentation, locking)))


def disassembly_faults(plan: Plan, gridshell: Gridshell) -> tuple[Finding, ...]:
    """Return what is wrong with a plan of taking down, as AAG982; see ``check_disassembly``."""
    return tuple(_findings("AAG982", check_disassembly(plan, gridshell)))


def schedule_faults(plan: Plan, times: Mapping[str, tuple[int, int]], people: int) -> tuple[Finding, ...]:
    """Return which steps of a plan cannot be done at their times by so many people, as AAG984.

    ``times`` are the minutes of work at which each step begins and ends, by its id.
    """
    return tuple(_findings("AAG984", [*crew_problems(plan, people), *time_problems(plan, times, people)]))


def graph_plan_faults(plan: Plan, graph: "nx.Graph[str]", people: int) -> tuple[Finding, ...]:
    """Return what is wrong with the plan of any graph of parts, as AAG983; see ``check_graph_plan``."""
    return tuple(_findings("AAG983", check_graph_plan(plan, graph, people)))
