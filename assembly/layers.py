"""Who lies above whom: the heights of the members at each crossing, and the order of laying that follows."""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

import networkx as nx
import numpy as np

from aag_cad.parts.model import Joint, Plank, Shell
from aag_cad.units import Floats
from assembly.errors import PlanError

SAME_HEIGHT = 1.0


@dataclass(frozen=True, order=True)
class Level:
    """A member at a crossing: how far its centre lies from the joint's point along the outward normal, mm."""

    height: float
    mark: str


def lying_unit(plank: Plank) -> str:
    """Return the mark of what is laid as one piece: the coupled beam of a sibling plank, or the plank itself."""
    return plank.beam or plank.mark


def _points_at_joints(shell: Shell) -> dict[tuple[str, str], Floats]:
    """Return the point (3,) of each plank's centre line at each of its joints, by plank and joint mark."""
    points: dict[tuple[str, str], Floats] = {}
    for plank in shell.planks:
        if plank.joints:
            found = plank.curve.point_spline(np.array([joint.station for joint in plank.joints]))
            points |= {(plank.mark, place.joint): p for place, p in zip(plank.joints, found, strict=True)}
    return points


def crossing_levels(shell: Shell) -> dict[str, tuple[Level, ...]]:
    """Return planks, studs and blocks of every joint of a shell from the lowest to the highest along its normal."""
    points = _points_at_joints(shell)
    studs = {stud.mark: np.array(stud.frame.origin) for stud in shell.studs}
    hubs = studs | {block.mark: np.array(block.frame.origin) for block in shell.blocks}

    def levels(joint: Joint) -> Iterator[Level]:
        for mark in joint.members:
            point = points.get((mark, joint.mark), hubs.get(mark))
            if point is not None:
                yield Level(float((point - np.array(joint.point)) @ np.array(joint.normal)), mark)

    return {joint.mark: tuple(sorted(levels(joint))) for joint in shell.joints}


def layer_precedence(shell: Shell) -> "nx.DiGraph[str]":
    """Return beams and flat planks with an edge from each to what lies on it; the edge's ``joints`` say where.

    What lies below must be laid first. Members whose centres differ by less than 1 mm meet end to end and have no
    order. PlanError if the members are woven so that none of them can be the lowest.
    """
    unit_of = {plank.mark: lying_unit(plank) for plank in shell.planks}
    graph: nx.DiGraph[str] = nx.DiGraph()
    graph.add_nodes_from(sorted(set(unit_of.values())))
    where: dict[tuple[str, str], list[str]] = defaultdict(list)
    for joint, levels in sorted(crossing_levels(shell).items()):
        heights: dict[str, list[float]] = defaultdict(list)
        for level in levels:
            if level.mark in unit_of:
                heights[unit_of[level.mark]].append(level.height)
        stack = sorted((sum(listed) / len(listed), unit) for unit, listed in heights.items())
        for (low, lower), (high, upper) in pairwise(stack):
            if high - low > SAME_HEIGHT:
                where[lower, upper].append(joint)
    for (lower, upper), joints in sorted(where.items()):
        graph.add_edge(lower, upper, joints=tuple(joints))
    _refuse_cycle(graph)
    return graph


def _refuse_cycle(graph: "nx.DiGraph[str]") -> None:
    """Raise PlanError with the marks of a cycle, if there is one."""
    if nx.is_directed_acyclic_graph(graph):
        return
    links = []
    for lower, upper in nx.find_cycle(graph):
        joints = graph.edges[lower, upper].get("joints", ())
        links.append(f"{upper} lies on {lower}" + (f" at {', '.join(joints[:3])}" if joints else ""))
    raise PlanError(
        f"{'; '.join(links)}: none of them can be laid first; give each family a layer of its own, or join one of "
        "these planks after the others are in place"
    )


def laying_order(precedence: "nx.DiGraph[str]", sweep: Mapping[str, tuple[float, ...]]) -> tuple[str, ...]:
    """Return the units so that none is laid before what it lies on, and otherwise by rising ``sweep``, then by mark.

    PlanError that names the marks if the precedence runs in a circle.
    """
    _refuse_cycle(precedence)
    return tuple(nx.lexicographical_topological_sort(precedence, key=lambda unit: (sweep[unit], unit)))
