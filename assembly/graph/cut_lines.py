"""Where the beams and edge planks of a shell cross its geodesics: the lines along which a shell can be cut.

Geodesics are lines 1 to n in the order of their marks; bay i lies between line i and line i + 1, bays 0 and n outside
the first and the last line; around a closed ring bay n is bay 0. A stop is a place to cut: 2 i just before line i,
which leaves its geodesic to the upper segment, 2 i + 1 just after it. Both run along the geodesic: beams are cut at
their crossings with it, and only the geodesic itself changes sides.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from aag_cad.parts.index import index_of
from aag_cad.parts.model import Beam, FlatBar, Joint, JointStation, Member, Shell
from assembly.base.errors import PlanError


@dataclass(frozen=True)
class CutPlace:
    """Where a beam or edge plank crosses a line; ``direction`` is 1 if it runs into the upper bay there, else -1."""

    joint: str
    line: int
    station: float
    direction: int


@dataclass(frozen=True)
class CutMember:
    """A beam (two planks) or an edge plank (one), where it crosses lines, and the stations of its AA nodes."""

    mark: str
    planks: tuple[str, ...]
    places: tuple[CutPlace, ...]
    studs: tuple[float, ...]
    edge: bool

    def bay(self, station: float) -> int:
        """Return the bay of a station, not yet counted around a ring."""
        after = [place for place in self.places if place.station > station]
        if not after:
            last = self.places[-1]
            return last.line if last.direction > 0 else last.line - 1
        return after[0].line - 1 if after[0].direction > 0 else after[0].line

    def cut_at(self, place: CutPlace) -> bool:
        """Return whether a cut along the line cuts this beam: it does if the beam has studs on both sides."""
        return any(s < place.station for s in self.studs) and any(s > place.station for s in self.studs)


@dataclass(frozen=True)
class CutLines:
    """The lines of a shell (marks of its geodesics), whether they close to a ring, and what crosses them."""

    lines: tuple[str, ...]
    ring: bool
    members: tuple[CutMember, ...]

    def bay(self, bay: int) -> int:
        """Return a bay counted once around a ring."""
        return bay % len(self.lines) if self.ring else bay

    def line(self, stop: int) -> int:
        """Return the line of a stop, which may be a turn further on around a ring."""
        return (stop // 2 - 1) % len(self.lines) + 1

    def stops(self) -> tuple[int, ...]:
        """Return all stops: of a chain its ends and two at each inner line, of a ring two at each line."""
        n = len(self.lines)
        return tuple(range(2, 2 * n + 2)) if self.ring else (2, *range(4, 2 * n), 2 * n + 1)

    def inner(self, stop: int) -> bool:
        """Return whether a stop is a cut and not the end of a chain."""
        return self.ring or 2 < stop < 2 * len(self.lines) + 1

    def owned(self, start: int, end: int) -> tuple[int, ...]:
        """Return the lines whose geodesics belong to the run between two stops."""
        return tuple(self.line(2 * i) for i in range((start + 1) // 2, (end + 1) // 2))

    def bays(self, start: int, end: int) -> frozenset[int]:
        """Return the bays of the run between two stops."""
        low = start // 2 if self.inner(start) else 0
        high = end // 2 if self.inner(end) else len(self.lines) + 1
        return frozenset(self.bay(bay) for bay in range(low, high))


def _listed(member: Member, joints: dict[str, Joint], lines: dict[str, int]) -> Iterator[tuple[JointStation, int]]:
    """Yield the joints of a member with a geodesic, and its line."""
    for place in member.joints:
        joint = joints.get(place.joint)
        for line in sorted(lines[mark] for mark in (joint.members if joint else ()) if mark in lines):
            yield place, line


def _direction(member: Member, place: JointStation, line: int, geodesics: tuple[FlatBar, ...]) -> int:
    """Return in which bay a member goes on where it crosses just one line, by the nearest neighbour of that line."""
    up = line < len(geodesics)
    neighbour = geodesics[line if up else line - 2].curve.points
    point = member.curve.point_spline(place.station)
    towards = neighbour[np.argmin(np.linalg.norm(neighbour - point, axis=1))] - point
    ahead = float(towards @ member.curve.point_spline(place.station, nu=1)) > 0.0
    return 1 if ahead == up else -1


def _cut_member(
    member: Member, joints: dict[str, Joint], lines: dict[str, int], geodesics: tuple[FlatBar, ...]
) -> CutMember:
    listed, n = list(_listed(member, joints, lines)), len(lines)
    steps = []
    for (place, line), (_, following) in pairwise(listed):
        step = (following - line + n // 2) % n - n // 2
        if abs(step) != 1:
            raise PlanError(
                f"{member.mark}: after {geodesics[line - 1].mark} (at {place.joint}) it crosses "
                f"{geodesics[following - 1].mark}, expected a neighbour; number the geodesics across the shell"
            )
        steps.append(step)
    if len(listed) == 1:
        steps = [_direction(member, *listed[0], geodesics)]
    return CutMember(
        member.mark,
        member.planks if isinstance(member, Beam) else (member.mark,),
        tuple(
            CutPlace(place.joint, line, place.station, steps[min(i, len(steps) - 1)])
            for i, (place, line) in enumerate(listed)
        ),
        tuple(place.station for place in member.joints if place.joint in joints and joints[place.joint].kind == "AA"),
        not isinstance(member, Beam),
    )


def cut_lines(shell: Shell) -> CutLines:
    """Return the lines of a shell and what crosses them; PlanError without three geodesics, or if they are unordered.

    A beam or edge plank that crosses no geodesic has no place in a cut and is an error too.
    """
    geodesics = tuple(index_of(shell).geodesics.values())
    if len(geodesics) < 3:
        raise PlanError(f"{shell.mark}: {len(geodesics)} geodesics, at least 3 to cut along; carry the shell whole")
    lines = {plank.mark: i for i, plank in enumerate(geodesics, start=1)}
    joints = index_of(shell).joints
    crossing: list[Member] = [*shell.beams, *index_of(shell).edges.values()]
    members = tuple(_cut_member(member, joints, lines, geodesics) for member in crossing)
    lone = [member.mark for member in members if not member.places]
    if lone:
        raise PlanError(f"{', '.join(lone)}: crosses no geodesic, so no segment can hold it; carry the shell whole")
    ends = {1, len(lines)}
    ring = any({a.line, b.line} == ends for member in members for a, b in pairwise(member.places))
    return CutLines(tuple(lines), ring, members)
