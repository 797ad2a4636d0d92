"""Who lies above whom: the heights of the members at each crossing, and the order of laying that follows."""

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import networkx as nx
import numpy as np

from aag_cad.parts.index import index_of
from aag_cad.parts.model import Joint, Shell
from aag_cad.units import Floats
from assembly.base.errors import PlanError
from assembly.graph.circles import circle_links, knots, part_of, relations
from assembly.graph.laying_units import Overlap

SAME_HEIGHT = 1.0


@dataclass(frozen=True, order=True)
class Level:
    """A member at a crossing: how far its centre lies from the joint's point along the outward normal, mm."""

    height: float
    mark: str


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
    hubs = index_of(shell).studs | index_of(shell).blocks

    def levels(joint: Joint) -> Iterator[Level]:
        for mark in joint.members:
            point = np.array(hubs[mark].frame.origin) if mark in hubs else points.get((mark, joint.mark))
            if point is not None:
                yield Level(float((point - np.array(joint.point)) @ np.array(joint.normal)), mark)

    return {joint.mark: tuple(sorted(levels(joint))) for joint in shell.joints}


def stacked_planks(shell: Shell) -> Iterator[tuple[Joint, tuple[str, ...], tuple[str, ...], bool]]:
    """Yield where a unit lies on the next lower one: the joint, the planks of the lower and of the upper unit, True.

    Members whose centres differ by less than 1 mm meet end to end; for them the last is False.
    """
    unit_of = index_of(shell).unit_of
    levels = crossing_levels(shell)
    for joint in shell.joints:
        units: dict[str, list[Level]] = defaultdict(list)
        for level in levels[joint.mark]:
            if level.mark in unit_of:
                units[unit_of[level.mark]].append(level)
        stack = sorted((sum(level.height for level in at) / len(at), unit) for unit, at in units.items())
        for (low, lower), (high, upper) in pairwise(stack):
            planks = [tuple(sorted(level.mark for level in units[unit])) for unit in (lower, upper)]
            yield joint, planks[0], planks[1], high - low > SAME_HEIGHT


def layer_precedence(shell: Shell) -> "nx.DiGraph[str]":
    """Return beams and flat planks with an edge from each to what lies on it; the edge's ``joints`` say where.

    What lies below must be laid first. Members whose centres differ by less than 1 mm meet end to end and have no
    order. PlanError with every circle in which the members are woven, so that none of them can be the lowest.
    """
    unit_of = index_of(shell).unit_of
    overlaps = [
        Overlap(joint.mark, unit_of[lower[0]], unit_of[upper[0]], 0.0, 0.0)
        for joint, lower, upper, lies in stacked_planks(shell)
        if lies
    ]
    graph = relations(unit_of.values(), overlaps)
    if found := knots(graph):
        told = "\n".join(f"{', '.join(knot)}: {circle_links(part_of(graph, knot))}" for knot in found)
        raise PlanError(
            f"{told}\nnone of them can be laid first; give each family a layer of its own, or join one of these planks "
            "after the others are in place"
        )
    return graph
