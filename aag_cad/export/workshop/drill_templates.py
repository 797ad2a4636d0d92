"""Drill templates at full size as PDF, one for each drilling group, by the template ``printouts/templates.typ``.

A PDF page ends at 14 400 points (5 080 mm; ISO 32000-1, annex C), so a longer plank is printed in parts that meet at
register marks.
"""

import math
import os
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from aag_cad.errors import DesignError
from aag_cad.export.workshop.blank_drawings import (
    CHECK_LENGTH,
    hole_kinds,
    is_upper,
    joint_names,
    laying_lines,
    outline_corners,
    spread,
)
from aag_cad.files import write_bytes
from aag_cad.parts.forms import Blank, Hole
from aag_cad.parts.index import index_of
from aag_cad.parts.model import Gridshell, Timber
from aag_cad.shop.groups import STACK_LIMIT, DrillGroup, drawn_face, drilled_joints, templates_of
from aag_cad.typesetting import printout_pdf
from aag_cad.units import MM_PER_M

PaperName: TypeAlias = Literal["roll", "a3"]


@dataclass(frozen=True)
class Paper:
    """A paper: largest page width, page height (0: as high as needed), margin left and right, zone for texts; mm.

    ``overlap`` is how far a part is drawn past the line where it meets its neighbour, ``shift`` how far that line may
    move to keep clear of holes.
    """

    width: float
    height: float
    margin: float
    zone: float
    overlap: float
    shift: int

    @property
    def usable(self) -> float:
        """The longest piece of a plank between two meeting lines, mm."""
        return self.width - 2.0 * (self.margin + self.overlap)


PAPERS: dict[PaperName, Paper] = {
    "roll": Paper(width=4800.0, height=0.0, margin=25.0, zone=24.0, overlap=40.0, shift=60),
    "a3": Paper(width=420.0, height=297.0, margin=25.0, zone=14.0, overlap=12.0, shift=12),
}
_LEAST_WIDTH = 420.0
_CLEAR_OF_CUT = 45.0
_LINE = 3.6
_LINE_LENGTH = 120
_HEAD = 8.0
_FOOT = 12.0
_LABEL_PITCH = 8.5


def _reach(hole: Hole) -> float:
    return (hole.diameter + hole.slot) / 2.0


def _clearance(holes: Sequence[Hole], station: float) -> float:
    return min((abs(hole.station - station) - _reach(hole) for hole in holes), default=math.inf)


def part_stations(blank: Blank, paper: Paper) -> list[float]:
    """Return where the parts of a template begin and end: 0, whole millimetres clear of the holes, the length.

    No part is longer than the paper's usable length; the parts are nearly equal.
    """
    if blank.length <= paper.usable:
        return [0.0, blank.length]
    count = math.ceil(blank.length / (paper.usable - 2.0 * paper.shift - 1.0))
    cuts = []
    for i in range(1, count):
        nominal = round(blank.length * i / count)
        # The nearest comes first, and max keeps the first of equals.
        places = [nominal + shift for shift in sorted(range(-paper.shift, paper.shift + 1), key=abs)]
        cuts.append(float(max(places, key=lambda s: min(_CLEAR_OF_CUT, _clearance(blank.holes, s)))))
    return [0.0, *cuts, blank.length]


def _labels(named: Sequence[tuple[Hole, tuple[str, ...]]], upper: bool) -> list[dict[str, Any]]:
    """Return the texts of the holes of one side of a part, with their places: station, then joints, line by line."""
    chosen = [(hole, names) for hole, names in named if is_upper(hole) == upper]
    places = spread([hole.station for hole, _ in chosen], _LABEL_PITCH)
    return [
        {"at": hole.station, "place": place, "station": f"{hole.station:.1f}", "joints": list(names)}
        for place, (hole, names) in zip(places, chosen, strict=True)
    ]


def _strip(
    group: DrillGroup, joints: Sequence[Sequence[str]], stations: Sequence[float], number: int, overlap: float
) -> dict[str, Any]:
    """Return what is drawn of one part: stations along the blank, heights from its upper edge down, mm."""
    blank = group.master.blank
    half, first, last = blank.section.width / 2.0, stations[number], stations[number + 1]
    begins, ends = number == 0, number == len(stations) - 2
    low, high = first - (0.0 if begins else overlap), last + (0.0 if ends else overlap)
    named = [
        (hole, joint_names(marks))
        for hole, marks in zip(blank.holes, joints, strict=True)
        if first <= hole.station < last
    ]
    return {
        "number": number + 1,
        "first": first,
        "last": last,
        "low": low,
        "high": high,
        "begins": begins,
        "ends": ends,
        "outline": [[x, half - y] for x, y in outline_corners(blank)],
        "holes": [
            {"x": hole.station, "y": half - hole.offset, "diameter": hole.diameter, "slot": hole.slot}
            for hole in blank.holes
            if low + _reach(hole) <= hole.station <= high - _reach(hole)
        ],
        "upper": _labels(named, upper=True),
        "lower": _labels(named, upper=False),
        "metres": [k * MM_PER_M for k in range(1, math.ceil(last / MM_PER_M)) if first <= k * MM_PER_M < last],
    }


def _sheets(
    group: DrillGroup, joints: Sequence[Sequence[str]], paper: Paper, title: str, timber: Timber
) -> dict[str, Any]:
    """Return the pages of one template; DesignError if the plank is wider than the paper."""
    blank = group.master.blank
    laying = [
        line for text in laying_lines(group) for line in textwrap.wrap(text, _LINE_LENGTH, subsequent_indent="  ")
    ]
    head = _HEAD + _LINE * max(4, len(laying))
    high = blank.section.width + 2.0 * paper.zone
    rows = max(1, int((paper.height - head - _FOOT) // high)) if paper.height else 1
    if paper.height and head + rows * high + _FOOT > paper.height:
        raise DesignError(
            f"{group.master.mark}: a template {blank.section.width:g} mm wide with its texts needs a page "
            f"{head + high + _FOOT:.0f} mm high, the paper has {paper.height:g}; print on a roll"
        )
    stations = part_stations(blank, paper)
    strips = [_strip(group, joints, stations, i, paper.overlap) for i in range(len(stations) - 1)]
    longest = max(strip["last"] - strip["first"] for strip in strips)
    overlaps = 2.0 * paper.overlap if len(strips) > 1 else 0.0
    width = paper.width if paper.height else max(_LEAST_WIDTH, longest + overlaps + 2.0 * paper.margin)
    return {
        "mark": group.mark,
        "width": width,
        "height": paper.height or head + high + _FOOT,
        "head": head,
        "high": high,
        "length": blank.length,
        "length-text": f"{blank.length:.1f} mm",
        "plank_width": blank.section.width,
        "facts": [
            title,
            f"length {blank.length:.1f}, section {blank.section.width:g} x {blank.section.thickness:g}, "
            f"{timber.species} {timber.strength_class}",
            f"{', '.join(hole_kinds(blank)).replace('%%c', 'Ø')}; stations in mm from START",
            f"drawn: {group.master.mark}, {drawn_face(group.master)}",
        ],
        "laying": laying,
        "count": len(group.members),
        "stack": STACK_LIMIT,
        "parts": len(strips),
        "pages": [strips[i : i + rows] for i in range(0, len(strips), rows)],
    }


def templates_data(gridshell: Gridshell, paper: PaperName) -> dict[str, Any]:
    """Return the data of the printout of all templates; DesignError on an unknown paper or if a plank does not fit."""
    if paper not in PAPERS:
        raise DesignError(f"paper: {paper!r} is not known; choose one of {', '.join(PAPERS)}")
    chosen, planks = PAPERS[paper], index_of(gridshell).planks
    return {
        "title": gridshell.title,
        "margin": chosen.margin,
        "zone": chosen.zone,
        "foot": _FOOT,
        "check": CHECK_LENGTH,
        "templates": [
            _sheets(group, drilled_joints(group, planks), chosen, gridshell.title, gridshell.timber)
            for group in templates_of(gridshell)
        ],
    }


def templates_pdf(gridshell: Gridshell, paper: PaperName = "roll") -> bytes:
    """Return the drill templates as PDF; the same gridshell gives the same bytes."""
    return printout_pdf("templates", templates_data(gridshell, paper))


def write_templates(gridshell: Gridshell, path: str | os.PathLike[str], paper: PaperName = "roll") -> None:
    """Write the drill templates at full size, on a roll or as A3 tiles; FileError if the file cannot be written."""
    write_bytes(path, templates_pdf(gridshell, paper))
