"""Who lies above whom in a shell: the heights of its members at each crossing."""

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from aag_cad.parts.index import index_of
from aag_cad.parts.model import Joint, Shell

SAME_HEIGHT = 1.0


@dataclass(frozen=True, order=True)
class Level:
    """A member at a crossing: how far its centre lies from the joint's point along the outward normal, mm."""

    height: float
    mark: str


def crossing_levels(shell: Shell) -> dict[str, tuple[Level, ...]]:
    """Return planks, studs and blocks of every joint of a shell from the lowest to the highest along its normal."""
    index = index_of(shell)
    hubs = index.studs | index.blocks

    def levels(joint: Joint) -> Iterator[Level]:
        for mark in joint.members:
            if mark in hubs:
                point = np.array(hubs[mark].frame.origin)
            elif (mark, joint.mark) in index.stations:
                point = index.planks[mark].curve.point_spline(index.stations[mark, joint.mark])
            else:
                continue
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
