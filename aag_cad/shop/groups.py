"""Which planks share one drilling: clamped in a stack and drilled through one template.

"Groups of three identical planks (for three shells) are aligned, clamped and pre-drilled using templates" (paper,
section 3.2). Holes go right through, so a plank may also be turned end for end or over: mirror images share a template.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np

from aag_cad.once import once
from aag_cad.parts.forms import Blank, EndCut
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import parse_mark
from aag_cad.parts.model import FlatBar, Gridshell
from aag_cad.units import Floats

TOLERANCE = 0.05
# Planks of 12 mm that are clamped and drilled together.
STACK_LIMIT = 3
_SLACK = 1e-9
_CELL = 1.0

Laid: TypeAlias = Literal["as is", "turned end for end", "turned over", "turned end for end and over"]
LAID: tuple[Laid, ...] = get_args(Laid)
HOW_TO_LAY: dict[Laid, str] = {
    "as is": "start at START, drawn face up",
    "turned end for end": "start at END, drawn face up",
    "turned over": "start at START, drawn face down",
    "turned end for end and over": "start at END, drawn face down",
}


@dataclass(frozen=True)
class Member:
    """A plank of a group: its mark, how it lies under the template, and which of its holes each template hole drills.

    ``holes[i]`` is the index in the plank's own blank of the hole that hole i of the master plank drills.
    """

    mark: str
    laid: Laid
    holes: tuple[int, ...]


@dataclass(frozen=True)
class DrillGroup:
    """Planks with one template: its mark, the plank that it is drawn from (the first member), all members.

    Members of one family, index and side are neighbours, shell by shell.
    """

    mark: str
    master: FlatBar
    members: tuple[Member, ...]

    @property
    def stacks(self) -> tuple[tuple[Member, ...], ...]:
        """The members as they are clamped and drilled together."""
        return tuple(self.members[i : i + STACK_LIMIT] for i in range(0, len(self.members), STACK_LIMIT))


def template_mark(number: int) -> str:
    """Return the mark of a template, e.g. ``T-01``: the one place where it is printed; numbers from 1."""
    return f"T-{number:02d}"


def laid_points(points: Floats, length: float, laid: Laid) -> Floats:
    """Return blank coordinates (n, 2) of a plank as they lie under the template, or the way back.

    End for end is half a turn in the plane of the template, over is half a turn about the length; every one of the four
    ways is its own inverse.
    """
    turned, over = "end for end" in laid, "over" in laid
    station = length - points[:, 0] if turned else points[:, 0]
    return np.column_stack([station, -points[:, 1] if turned != over else points[:, 1]])


def cut_slope(cut: EndCut) -> float:
    """Return how far along the plank an end cut runs for each mm across: 0 if square.

    The cut line passes the end of the centre line; its angle counts from the length towards the positive offset.
    """
    return 0.0 if cut.angle_deg == 90.0 else 1.0 / math.tan(math.radians(cut.angle_deg))


def _ends(blank: Blank, laid: Laid) -> Floats:
    """Return how far the cuts at the start and at the end of the template reach along the plank, (2,) mm."""
    slopes = np.array([cut_slope(blank.start_cut), cut_slope(blank.end_cut)])
    turned = slopes[::-1] if "end for end" in laid else slopes
    return (-turned if "over" in laid else turned) * blank.section.width / 2.0


def _hole_figures(blank: Blank, laid: Laid) -> Floats:
    """Return station and offset under the template, diameter and slot of all holes, (n, 4)."""
    listed = [(h.station, h.offset, h.diameter, h.slot) for h in blank.holes]
    figures = np.array(listed, dtype=np.float64).reshape(-1, 4)
    return np.column_stack([laid_points(figures[:, :2], blank.length, laid), figures[:, 2:]])


def _paired(fits: Floats) -> tuple[int, ...] | None:
    """Return for each row the column that it is paired with, each column once, or None if there is no such pairing."""
    free, pairs = np.ones(fits.shape[1], dtype=bool), []
    for row in fits:
        columns = np.flatnonzero(row & free)
        if not len(columns):
            return None
        free[columns[0]] = False
        pairs.append(int(columns[0]))
    return tuple(pairs)


def _laid_as(master: Blank, blank: Blank, laid: Laid) -> tuple[int, ...] | None:
    """Return the holes of a blank in the order of the master's if it equals the master when so laid, else None."""
    reach = TOLERANCE + _SLACK
    if np.any(np.abs(_ends(master, "as is") - _ends(blank, laid)) > reach):
        return None
    gaps = np.abs(_hole_figures(master, "as is")[:, None] - _hole_figures(blank, laid)[None])
    same_use = np.array([[a.use == b.use for b in blank.holes] for a in master.holes], dtype=bool)
    return _paired(np.all(gaps <= reach, axis=2) & same_use.reshape(gaps.shape[:2]))


def member_of(master: FlatBar, plank: FlatBar) -> Member | None:
    """Return how a plank lies under the template of a master, None if no way of laying it makes them equal.

    Equal: length, section, end cuts and every hole (station, offset, diameter, slot) agree to 0.05 mm, uses are equal.
    """
    a, b = master.blank, plank.blank
    lengths = (a.length - b.length, a.section.width - b.section.width, a.section.thickness - b.section.thickness)
    if len(a.holes) != len(b.holes) or any(abs(gap) > TOLERANCE + _SLACK for gap in lengths):
        return None
    for laid in LAID:
        holes = _laid_as(a, b, laid)
        if holes is not None:
            return Member(plank.mark, laid, holes)
    return None


def _shop_order(plank: FlatBar) -> tuple[str, int, str, int]:
    mark = parse_mark(plank.mark)
    return mark.family, mark.index, mark.part, mark.shell


def drill_groups(planks: Iterable[FlatBar]) -> tuple[DrillGroup, ...]:
    """Return the drilling groups of planks, in the order of family, index and side; each plank is in one group.

    A plank joins the first group whose master it equals, so a group never spreads over more than 0.05 mm from its
    master.
    """
    drafts: list[tuple[FlatBar, list[Member]]] = []
    cells: dict[tuple[int, int], list[int]] = {}
    for plank in sorted(planks, key=_shop_order):
        count, length = len(plank.blank.holes), plank.blank.length
        # A master within the tolerance lies in the cell of its own length or over the border of it.
        near = {math.floor((length + gap) / _CELL) for gap in (-2.0 * TOLERANCE, 0.0, 2.0 * TOLERANCE)}
        for number in sorted(i for cell in near for i in cells.get((count, cell), ())):
            master, members = drafts[number]
            if member := member_of(master, plank):
                members.append(member)
                break
        else:
            cells.setdefault((count, math.floor(length / _CELL)), []).append(len(drafts))
            drafts.append((plank, [Member(plank.mark, "as is", tuple(range(count)))]))
    return tuple(
        DrillGroup(template_mark(number), master, tuple(members))
        for number, (master, members) in enumerate(drafts, start=1)
    )


@once
def templates_of(gridshell: Gridshell) -> tuple[DrillGroup, ...]:
    """Return the drilling groups of all planks of a gridshell."""
    return drill_groups(index_of(gridshell).planks.values())


def drawn_face(plank: FlatBar) -> str:
    """Return which face of a blank its drawings show, and which edge is up."""
    return "its right-hand face, outer edge up" if plank.upright else "its outer face, left edge up"


def drilled_joints(group: DrillGroup, planks: Mapping[str, FlatBar]) -> tuple[tuple[str, ...], ...]:
    """Return for each hole of the master the marks of the joints that it serves, member by member."""
    return tuple(
        tuple(planks[member.mark].blank.holes[member.holes[i]].joint for member in group.members)
        for i in range(len(group.master.blank.holes))
    )
