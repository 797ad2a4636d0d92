"""The workshop drawing of a drilling group: the blank with holes, marks and dimensions, as plain shapes in mm, y up.

x runs along the blank from its start, y across it from its centre line.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise
from typing import Literal, TypeAlias, get_args

from aag_cad.parts.forms import Blank, Hole, HoleUse
from aag_cad.parts.marks import short_mark
from aag_cad.parts.model import Timber
from aag_cad.shop.groups import HOW_TO_LAY, STACK_LIMIT, DrillGroup, cut_slope, drawn_face

Point: TypeAlias = tuple[float, float]
Side: TypeAlias = Literal["left", "centre", "right"]

OUTLINE, MARKS, DIMENSIONS, CHECK_BAR, TITLE = "OUTLINE", "MARKS", "DIMENSIONS", "CHECK_BAR", "TITLE"
HOLE_LAYERS: dict[HoleUse, str] = {use: f"HOLES_{use.upper()}" for use in get_args(HoleUse)}
_COLOURS = (1, 5, 6, 30, 150)
# Colours of the AutoCAD index: 7 is black on white and white on black, 3 green, 4 cyan, 8 grey.
LAYERS: dict[str, int] = {
    OUTLINE: 7,
    **dict(zip(HOLE_LAYERS.values(), _COLOURS, strict=False)),
    MARKS: 3,
    DIMENSIONS: 8,
    CHECK_BAR: 4,
    TITLE: 7,
}
CHECK_LENGTH = 100.0
# Height of the texts, and how far a dimension's side lines reach past its line, mm.
SMALL = 5.0
EXTENSION = 3.0

_LARGE = 7.0
_CHARACTER = 1.0
_CHAIN = 14.0
_RUNNING = 30.0
_PITCH = 14.0
_BESIDE = 6.5
_ON_THE_LINE = 0.05
_MOST_NAMES = 2


@dataclass(frozen=True)
class Line:
    """A straight line."""

    layer: str
    start: Point
    end: Point


@dataclass(frozen=True)
class Polyline:
    """A line through points, closed or open."""

    layer: str
    points: tuple[Point, ...]
    closed: bool = True


@dataclass(frozen=True)
class Circle:
    """A circle."""

    layer: str
    centre: Point
    diameter: float


@dataclass(frozen=True)
class Obround:
    """A slot along x: two half circles of a diameter, their centres ``slot`` apart."""

    layer: str
    centre: Point
    diameter: float
    slot: float


@dataclass(frozen=True)
class Text:
    """A line of text, its middle height at a point; anticlockwise rotation; ``%%c`` stands for the diameter sign."""

    layer: str
    content: str
    at: Point
    height: float
    anchor: Side = "left"
    rotation_deg: float = 0.0


@dataclass(frozen=True)
class Dimension:
    """A dimension along x between two points: the height of its line, what it says, and the middle of its text."""

    layer: str
    start: Point
    end: Point
    line: float
    content: str
    at: Point


Item: TypeAlias = Line | Polyline | Circle | Obround | Text | Dimension


@dataclass(frozen=True)
class Drawing:
    """A named sheet of shapes and its extent (left, low, right, high), mm."""

    name: str
    items: tuple[Item, ...]
    extent: tuple[float, float, float, float]


def spread(wanted: Sequence[float], gap: float) -> list[float]:
    """Return places for texts that are wanted at rising places, at least a gap apart and moved as little as can be.

    Least squares: texts that crowd each other are moved as a block about their mean.
    """
    blocks: list[tuple[float, int]] = []
    for i, place in enumerate(wanted):
        total, count = place - i * gap, 1
        while blocks and blocks[-1][0] / blocks[-1][1] > total / count:
            total, count = total + blocks[-1][0], count + blocks.pop()[1]
        blocks.append((total, count))
    bases = [total / count for total, count in blocks for _ in range(count)]
    return [base + i * gap for i, base in enumerate(bases)]


def outline_corners(blank: Blank) -> tuple[Point, Point, Point, Point]:
    """Return the corners of a blank, anticlockwise from the low corner at its start."""
    half, start, end = blank.section.width / 2.0, cut_slope(blank.start_cut), cut_slope(blank.end_cut)
    length = blank.length
    return (
        (-half * start, -half),
        (length - half * end, -half),
        (length + half * end, half),
        (half * start, half),
    )


def is_upper(hole: Hole) -> bool:
    """Return whether a hole is dimensioned above the blank: those on the centre line are."""
    return hole.offset > -_ON_THE_LINE


def joint_names(marks: Sequence[str]) -> tuple[str, ...]:
    """Return the joints that one hole serves in the planks of a group, without their shell: ``K-001``, ``K-049``.

    More than two are cut short to the first and how many follow.
    """
    names = tuple(dict.fromkeys(short_mark(mark) for mark in marks))
    return names if len(names) <= _MOST_NAMES else (names[0], f"+ {len(names) - 1}")


def diameter_text(diameter: float, slot: float) -> str:
    """Return the size of a hole, e.g. ``%%c9`` or ``%%c9 slot +6``: how much longer than round it is."""
    return f"%%c{diameter:g}" + (f" slot +{slot:g}" if slot else "")


def hole_kinds(blank: Blank) -> tuple[str, ...]:
    """Return how many holes there are of each kind, e.g. ``16 bolt %%c9``; slots with their extra length."""
    kinds = Counter((hole.use, hole.diameter, hole.slot) for hole in blank.holes)
    return tuple(
        f"{count} {use} {diameter_text(diameter, slot)}" for (use, diameter, slot), count in sorted(kinds.items())
    )


def laying_lines(group: DrillGroup) -> tuple[str, ...]:
    """Return the stacks of a group in words: which planks, and how those lie that are not as drawn."""
    lines = []
    for number, stack in enumerate(group.stacks, start=1):
        runs = groupby(stack, key=lambda member: member.laid)
        texts = [f"{', '.join(m.mark for m in members)}: {laid} ({HOW_TO_LAY[laid]})" for laid, members in runs]
        lines.append(f"Stack {number}: {'; '.join(texts)}")
    return tuple(lines)


def _hole_items(blank: Blank) -> list[Item]:
    items: list[Item] = []
    for hole in blank.holes:
        centre, layer, reach = (hole.station, hole.offset), HOLE_LAYERS[hole.use], hole.diameter / 2.0 + 2.0
        if hole.slot:
            items.append(Obround(layer, centre, hole.diameter, hole.slot))
        else:
            items.append(Circle(layer, centre, hole.diameter))
        wide = reach + hole.slot / 2.0
        items.append(Line(DIMENSIONS, (hole.station - wide, hole.offset), (hole.station + wide, hole.offset)))
        items.append(Line(DIMENSIONS, (hole.station, hole.offset - reach), (hole.station, hole.offset + reach)))
    return items


def _mark_items(group: DrillGroup) -> list[Item]:
    """Return the template's mark and the ends."""
    return [
        Polyline(MARKS, ((-3.0, 0.0), (-15.0, 6.0), (-15.0, -6.0))),
        Text(MARKS, "START", (-20.0, 0.0), _LARGE, "right"),
        Text(MARKS, group.mark, (-20.0, 25.0), 2.0 * _LARGE, "right"),
        Text(MARKS, "END", (group.master.blank.length + 8.0, 0.0), _LARGE),
    ]


def _callout(hole: Hole) -> str:
    offset = round(hole.offset, 1) + 0.0
    across = f"{offset:+.1f}" if offset else "0"
    return f"{across}  {diameter_text(hole.diameter, hole.slot)}"


def _running_items(blank: Blank, named: Sequence[tuple[Hole, str]], sign: float) -> list[Item]:
    """Return what stands at each hole of one side: station, offset, diameter, and beside them the joint."""
    edge, length = blank.section.width / 2.0, blank.length
    chain, foot, text = (sign * (edge + reach) for reach in (_CHAIN, _RUNNING - 4.0, _RUNNING))
    entries = [
        (0.0, "0.0", ""),
        *((hole.station, f"{hole.station:.1f}  {_callout(hole)}", name) for hole, name in named),
        (length, f"{length:.1f} end", ""),
    ]
    items: list[Item] = []
    for place, (at, content, name) in zip(spread([entry[0] for entry in entries], _PITCH), entries, strict=True):
        items.append(Line(DIMENSIONS, (at, chain + sign * EXTENSION), (place, foot)))
        side: Side = "left" if sign > 0.0 else "right"
        items.append(Text(DIMENSIONS, content, (place, text), SMALL, side, 90.0))
        if name:
            items.append(Text(MARKS, name, (place + _BESIDE, text), SMALL, side, 90.0))
    return items


def _chain_items(blank: Blank, holes: Sequence[Hole], sign: float) -> list[Item]:
    """Return the dimensions from hole to hole on one side, between the blank and the chain line.

    They are differences of printed stations, so that a tape along the plank agrees with them.
    """
    edge = sign * blank.section.width / 2.0
    chain = edge + sign * _CHAIN
    pairs = list(pairwise([0.0, *(hole.station for hole in holes), blank.length]))
    steps = [f"{round(b, 1) - round(a, 1):.1f}" for a, b in pairs]
    widest = max(len(step) for step in steps) * _CHARACTER * SMALL
    places = spread([(a + b) / 2.0 for a, b in pairs], widest)
    return [
        Dimension(DIMENSIONS, (a, edge), (b, edge), chain, step, (place, chain - sign * SMALL * 0.8))
        for (a, b), step, place in zip(pairs, steps, places, strict=True)
    ]


def _title_lines(group: DrillGroup, title: str, timber: Timber) -> tuple[str, ...]:
    blank, count = group.master.blank, len(group.members)
    return (
        f"{group.mark}   {title}",
        f"length {blank.length:.1f}   section {blank.section.width:g} x {blank.section.thickness:g}"
        f"   {timber.species} {timber.strength_class}   holes {', '.join(hole_kinds(blank)) or 'none'}",
        f"{count} plank{'s' if count > 1 else ''}, clamped and drilled in stacks of at most {STACK_LIMIT}",
        *laying_lines(group),
        f"Drawn: {group.master.mark}, {drawn_face(group.master)}. Joints stand without their shell.",
        "Dimensions in mm from the start; per hole: station, offset from the centre line (up is +), diameter, joint.",
    )


def _check_bar(x: float, y: float) -> list[Item]:
    return [
        Line(CHECK_BAR, (x, y), (x + CHECK_LENGTH, y)),
        *(Line(CHECK_BAR, (at, y - 4.0), (at, y + 4.0)) for at in (x, x + CHECK_LENGTH)),
        Text(CHECK_BAR, f"check bar {CHECK_LENGTH:g} mm", (x, y + 9.0), SMALL),
    ]


def blank_drawing(group: DrillGroup, joints: Sequence[Sequence[str]], title: str, timber: Timber) -> Drawing:
    """Return the drawing of a drilling group; ``joints`` are the joints that each hole of the master serves."""
    blank = group.master.blank
    edge = blank.section.width / 2.0
    named = [(hole, "  ".join(joint_names(marks))) for hole, marks in zip(blank.holes, joints, strict=True)]
    lower = any(not is_upper(hole) for hole in blank.holes)
    reach = _RUNNING + 20.0 * _CHARACTER * SMALL
    items: list[Item] = [Polyline(OUTLINE, outline_corners(blank)), *_hole_items(blank), *_mark_items(group)]
    for sign in (1.0, -1.0) if lower else (1.0,):
        side = [(hole, name) for hole, name in named if is_upper(hole) == (sign > 0.0)]
        items += [*_running_items(blank, side, sign), *_chain_items(blank, [hole for hole, _ in side], sign)]
    below = -edge - (reach if lower else 1.5 * _CHAIN)
    items += _check_bar(0.0, below - 2.0 * _LARGE)
    lines = _title_lines(group, title, timber)
    for number, line in enumerate(lines):
        items.append(Text(TITLE, line, (CHECK_LENGTH + 60.0, below - 1.8 * _LARGE * number), _LARGE))
    widest = CHECK_LENGTH + 60.0 + max(len(line) for line in lines) * _CHARACTER * _LARGE
    low = below - 1.8 * _LARGE * len(lines)
    return Drawing(group.mark, tuple(items), (-110.0, low, max(blank.length + 40.0, widest), edge + reach))
