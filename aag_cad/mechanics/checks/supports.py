"""Whether the concrete blocks hold the shells down and together: a simple check by hand, EN 1990 factors."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from aag_cad.design import Design
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import kind_of
from aag_cad.parts.model import Gridshell, Shell, shell_parts
from aag_cad.parts.quantities import mass
from aag_cad.parts.triangles import polygon_area
from aag_cad.units import MM2_PER_M2

# Partial factors of EN 1990, table A1.2(A) and (B).
PERMANENT, PERMANENT_FAVOURABLE, VARIABLE = 1.35, 0.9, 1.5
_GRAVITY = 9.81e-3


@dataclass(frozen=True)
class FootingCheck:
    """The forces at one foot of a shell, kN, design values, and how far they use the block (1 is full).

    ``uplift`` is the wind suction at a foot, ``vertical`` and ``thrust`` come from own weight and snow; ``block`` is
    the characteristic weight of a block; ``needed_mass`` is the block in kg that both checks ask for.
    """

    shell: str
    feet: int
    plan_area_m2: float
    span_mm: float
    rise_mm: float
    block: float
    uplift: float
    vertical: float
    thrust: float
    uplift_utilisation: float
    sliding_utilisation: float
    needed_mass: float


def plan_area(shell: Shell, closed: bool) -> float:
    """Return the area of a shell in plan, mm2: the fields between neighbouring geodesics, from joint to joint.

    ``closed``: the shell runs all the way round its axis.
    """
    ends = {mark: joint.point for joint in shell.joints if joint.kind == "ridge" for mark in joint.members}
    feet = {mark: joint.point for joint in shell.joints if joint.kind == "foot" for mark in joint.members}
    lines = [
        np.array([feet[plank.mark], *plank.curve.points, ends[plank.mark]])[:, :2]
        for plank in index_of(shell).geodesics.values()
        if plank.mark in feet and plank.mark in ends
    ]
    fields = pairwise([*lines, *lines[:1]] if closed else lines)
    return sum(polygon_area(np.concatenate([a, b[::-1]])) for a, b in fields)


def footing_checks(design: Design, gridshell: Gridshell) -> Iterator[FootingCheck]:
    """Yield for each shell with feet the check of its blocks; each foot is taken to carry the same share.

    Uplift: 1.5 x suction x plan area against 0.9 x (own weight + block). Sliding: the thrust V span / (4 rise) of a
    parabolic arch under 1.35 x own weight + 1.5 x snow against friction x (V + 0.9 x block). The span is twice the mean
    distance of the feet from the centre, the rise is from them to the highest plank.
    """
    supports = design.supports
    for shell in gridshell.shells:
        feet = [joint.point for joint in shell.joints if joint.kind == "foot"]
        if not feet or not shell.footings:
            continue
        carried = (part for part in shell_parts(shell) if kind_of(part).material != "concrete")
        own = sum(mass(part, gridshell.timber) for part in carried) * _GRAVITY
        block_mass = mass(shell.footings[0], gridshell.timber)
        block, count, area = block_mass * _GRAVITY, len(feet), plan_area(shell, design.closed)
        span = 2.0 * float(np.linalg.norm(np.array(feet)[:, :2], axis=1).mean())
        rise = max(float(p.curve.points[:, 2].max()) for p in shell.planks) - float(np.array(feet)[:, 2].min())
        uplift = VARIABLE * supports.wind_suction * area / MM2_PER_M2 / count
        vertical = (PERMANENT * own + VARIABLE * supports.snow * area / MM2_PER_M2) / count
        thrust = vertical * span / (4.0 * rise)
        held = PERMANENT_FAVOURABLE * (own / count + block)
        rubbed = supports.friction * (vertical + PERMANENT_FAVOURABLE * block)
        needed = max(
            uplift / PERMANENT_FAVOURABLE - own / count,
            (thrust / supports.friction - vertical) / PERMANENT_FAVOURABLE,
        )
        yield FootingCheck(
            shell=shell.mark,
            feet=count,
            plan_area_m2=area / MM2_PER_M2,
            span_mm=span,
            rise_mm=rise,
            block=block,
            uplift=uplift,
            vertical=vertical,
            thrust=thrust,
            uplift_utilisation=uplift / held,
            sliding_utilisation=thrust / rubbed,
            needed_mass=max(0.0, needed) / _GRAVITY,
        )
