"""The floor plan of a shell laid flat, to scale for a landscape page, and the table of coordinates to set it out by.

Made for black-and-white printers: lower beams are two black planks, geodesics hollow strips over them, upper beams two
dashed planks over both. Coordinates as in ``assembly.laying.flattening``; on the paper y runs up.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from aag_cad.colours import LEGEND
from aag_cad.families import FAMILIES, LAYERS, Family
from aag_cad.language import Language, figure, say, says
from aag_cad.parts.marks import number_of, short_mark
from aag_cad.parts.model import Shell
from aag_cad.units import MM_PER_M, Floats
from assembly.base.errors import PlanError
from assembly.base.names import LAYER_WORDS
from assembly.drawing.svg import (
    Box,
    Label,
    Style,
    circle,
    group,
    label_box,
    label_svg,
    line,
    path,
    placed_labels,
    places_round,
    rectangle,
    svg,
    text,
)
from assembly.laying.flattening import FlatMember, FlatState, outline_of
from assembly.laying.order import FlatOrder

Page: TypeAlias = Literal["a4", "a3"]
Row: TypeAlias = tuple[str, ...]

# Inside the margins of a landscape page, tenths of a mm: 12 mm left and right. A heading goes over the upper edge.
PAGES: dict[Page, tuple[float, float]] = {"a4": (2730.0, 1780.0), "a3": (3960.0, 2600.0)}
SCALES = (10, 20, 25, 30, 40, 50, 75, 100, 125, 150, 200, 250)
_LEFT, _TOP, _RIGHT, _BOTTOM = 95.0, 60.0, 95.0, 180.0
_UNITS_PER_MM = 10.0

_GRID = Style("none", "#b5b5b5", 1.5)
_FLOOR = Style("none", "#777", 2.0, "14 8")
_FOOT = Style("none", "#000", 5.0, "30 9 5 9")
_STUD = Style("#fff", "#000", 3.0)
_INK = Style("#000")
_HOLLOW = Style("#fff", "#000", 2.5)
_STACK = Style("#e4e4e4", "#000", 3.0)

_NAME, _NUMBER, _GRID_NUMBER, _WORDS = 23.0, 20.0, 26.0, 27.0
_TRIANGLE = 26.0


@dataclass(frozen=True)
class _Paper:
    """The scale 1 : n and where floor points (k, 2) come on the paper; ``low`` and ``high`` are shown corners, mm."""

    n: int
    low: tuple[float, float]
    high: tuple[float, float]
    width: float
    height: float

    def __call__(self, points: Floats) -> Floats:
        k = _UNITS_PER_MM / self.n
        left = _LEFT + (self.width - _LEFT - _RIGHT - k * (self.high[0] - self.low[0])) / 2.0
        foot = self.height - _BOTTOM
        return np.column_stack([left + k * (points[:, 0] - self.low[0]), foot - k * (points[:, 1] - self.low[1])])


def _stacks(state: FlatState, order: FlatOrder | None) -> dict[str, Floats]:
    """Return the places of the stacks of this shell on the floor (2,), by family; none for a ring."""
    if order is None or state.view_origin is None:
        return {}
    own = ((family, place) for (shell, family), place in sorted(order.stacks.items()) if shell == state.shell)
    return {family: np.array(place) + state.view_origin for family, place in own}


def _paper(state: FlatState, stacks: dict[str, Floats], page: Page) -> _Paper:
    shown = np.array([(0.0, 0.0), state.size, *stacks.values()])
    low, high = shown.min(axis=0), shown.max(axis=0)
    wide, tall = PAGES[page]
    room = (wide - _LEFT - _RIGHT, tall - _TOP - _BOTTOM)
    needed = float(((high - low) * _UNITS_PER_MM / np.array(room)).max())
    fitting = [n for n in SCALES if n >= needed]
    if not fitting:
        raise PlanError(
            f"{state.shell}: a floor of {state.size[0] / MM_PER_M:.1f} x {state.size[1] / MM_PER_M:.1f} m needs 1 : "
            f"{needed:.0f} on {page.upper()}, at most 1 : {SCALES[-1]}; take a larger page"
        )
    height = float((high - low)[1]) * _UNITS_PER_MM / fitting[0] + _TOP + _BOTTOM
    return _Paper(fitting[0], (float(low[0]), float(low[1])), (float(high[0]), float(high[1])), wide, height)


def _grid(state: FlatState, paper: _Paper) -> tuple[str, list[Box]]:
    """Return the lines of whole metres over the floor and its edge, with their numbers and the boxes of those."""
    x, y = state.size
    lines: list[str] = []
    numbers: list[Label] = []
    for axis, far in ((0, x), (1, y)):
        last = int(far / MM_PER_M)
        for metre in range(last + 1):
            at = metre * MM_PER_M
            ends = np.array([(at, 0.0), (at, y)] if axis == 0 else [(0.0, at), (x, at)])
            lines.append(path(paper(ends), closed=False))
            place = paper(ends)[0] + ([0.0, 32.0] if axis == 0 else [-42.0, 0.0])
            words = f"{metre} m" if metre == last else str(metre)
            numbers.append(Label(words, float(place[0]), float(place[1]), _GRID_NUMBER))
    edge = path(paper(np.array([(0.0, 0.0), (x, 0.0), (x, y), (0.0, y)])))
    texts = (text(label.text, label.x, label.y, label.size) for label in numbers)
    return group(lines, _GRID) + group([edge], _FLOOR) + group(texts, _INK), [label_box(label) for label in numbers]


def _planks(member: FlatMember, thickness: float) -> Iterator[Floats]:
    """Yield the outlines (2 k, 2) of the two planks of a beam on the floor."""
    edge = outline_of(member)
    count = len(member.points)
    inwards = thickness / member.width
    for a, b in ((edge[:count], edge[count:][::-1]), (edge[count:][::-1], edge[:count])):
        yield np.concatenate([a, (a + inwards * (b - a))[::-1]])


def _members(shell: Shell, state: FlatState, paper: _Paper) -> Iterator[str]:
    thickness = shell.planks[0].blank.section.thickness
    for member in state.members:
        colour = LEGEND[member.family]
        if member.layer == 0:
            yield group([path(paper(outline_of(member)))], Style(colour, "#000", 2.0))
        elif member.layer < 0:
            yield group((path(paper(plank)) for plank in _planks(member, thickness)), Style(colour, colour, 1.5))
        else:
            # A dashed outline of so thin a plank would be a blot: its middle line is dashed instead.
            half = member.points.shape[0] * 2
            middles = ((p[: half // 2] + p[half // 2 :][::-1]) / 2.0 for p in _planks(member, thickness))
            yield group((path(paper(middle), closed=False) for middle in middles), Style("none", colour, 4.0, "13 7"))


def _start(member: FlatMember, paper: _Paper) -> tuple[Floats, Floats]:
    """Return the start of a member on the paper and the direction (2,) out of it."""
    ends = paper(member.points[:2])
    return ends[0], (ends[0] - ends[1]) / np.linalg.norm(ends[0] - ends[1])


def _triangle_points(member: FlatMember, paper: _Paper) -> Floats:
    start, out = _start(member, paper)
    across = np.array([-out[1], out[0]])
    tip, base = start + 5.0 * out, start + (5.0 + _TRIANGLE) * out
    return np.array([tip, base + 0.45 * _TRIANGLE * across, base - 0.45 * _TRIANGLE * across])


def _names(state: FlatState, paper: _Paper, page: Box, taken: list[Box]) -> tuple[str, list[Box]]:
    """Return the framed marks, of beams at their start ends and of geodesics at the others, and their boxes."""
    wanted = []
    triangles = [_triangle_points(member, paper) for member in state.members]
    taken = [*taken, *((*points.min(axis=0).tolist(), *points.max(axis=0).tolist()) for points in triangles)]
    for member in sorted(state.members, key=lambda member: member.layer == 0):
        start, out = _start(member, paper)
        if member.layer == 0:
            start, out = paper(member.points)[-1], -out
        across = np.array([-out[1], out[0]])
        aways = [(66.0, 0.0), (62.0, 45.0), (62.0, -45.0), (95.0, 0.0), (90.0, 55.0), (90.0, -55.0), (130.0, 0.0)]
        aways = [(32.0, 0.0), *aways, (-40.0, 0.0), (-90.0, 0.0)] if member.layer == 0 else aways
        places = np.array([start + along * out + aside * across for along, aside in aways])
        wanted.append((short_mark(member.mark), places))
    labels = placed_labels(wanted, _NAME, page, taken)
    return label_svg(labels), [label_box(label) for label in labels]


def _studs(state: FlatState, paper: _Paper, page: Box, taken: list[Box]) -> str:
    places = {mark: paper(point[None])[0] for mark, point in state.studs.items()}
    wanted = [(number_of(mark), places_round(place, 29.0)) for mark, place in places.items()]
    dots = [(x - 9.0, y - 9.0, x + 9.0, y + 9.0) for x, y in (place.tolist() for place in places.values())]
    labels = placed_labels(wanted, _NUMBER, page, [*taken, *dots])
    return label_svg(labels, framed=False) + group((circle(place, 8.0) for place in places.values()), _STUD)


def _swatch(x: float, y: float, paper: _Paper, family: Family, shell: Shell, width: float) -> str:
    """Return a short piece of a member as the plan draws it."""
    k = paper.n / _UNITS_PER_MM
    ends = np.array([(0.0, 0.0), (90.0 * k, 0.0)])
    member = FlatMember("", family, FAMILIES[family].layer, width, np.zeros(2), ends, ("", ""))
    alone = FlatState("", (member,), {}, {}, {}, (0.0, 0.0), None, 0.0, 0.0, {}, 0.0, 0.0, "", 0.0, ())
    shapes = "".join(_members(shell, alone, _Paper(paper.n, (0.0, 0.0), (0.0, 0.0), _LEFT + _RIGHT, _BOTTOM)))
    return f'<g transform="translate({x - _LEFT:.1f} {y:.1f})">{shapes}</g>'


def _key(shell: Shell, state: FlatState, paper: _Paper, language: Language) -> Iterator[str]:
    """Yield the line below the plan: what is drawn how, the scale and the size of the floor."""
    widths = {member.family: member.width for member in state.members}
    y, x = paper.height - 94.0, 20.0
    for layer, family in LAYERS.items():
        if family in widths:
            yield _swatch(x, y, paper, family, shell, widths[family])
            words = say(language, f"drawings.plan.{LAYER_WORDS[layer]}", family=family)
            yield group([text(words, x + 105.0, y, _WORDS, "start")], _INK)
            x += 150.0 + 0.602 * _WORDS * len(words)
    marks: tuple[tuple[str, Callable[[], str]], ...] = (
        ("stud", lambda: group([circle((x + 20.0, y), 8.0)], _STUD)),
        ("start", lambda: group([f'<path d="M{x + 30:.1f} {y:.1f}l-26 -12v24Z"/>'], _INK)),
        ("foot", lambda: line(np.array([(x - 40.0, y), (x + 35.0, y)]), _FOOT)),
    )
    for word, shape in marks:
        words = say(language, f"drawings.plan.{word}")
        x += 45.0 if word == "foot" else 0.0
        yield shape()
        yield group([text(words, x + 45.0, y, _WORDS, "start")], _INK)
        x += 90.0 + 0.602 * _WORDS * len(words)
    yield from _scale_bar(state, paper, language)


def _scale_bar(state: FlatState, paper: _Paper, language: Language) -> Iterator[str]:
    y, metre = paper.height - 32.0, _UNITS_PER_MM * MM_PER_M / paper.n
    yield group(
        [text(say(language, "drawings.plan.scale", n=paper.n), 20.0, y, 1.3 * _WORDS, "start", bold=True)], _INK
    )
    x, count = 230.0, 3
    for i in range(count):
        yield group(
            [rectangle(x + i * metre, y - 8.0, metre, 16.0)], Style("#000" if i % 2 == 0 else "#fff", "#000", 2.0)
        )
    numbers = [text(str(i), x + i * metre, y - 26.0, 0.8 * _WORDS) for i in range(count + 1)]
    unit = text(say(language, "drawings.plan.metre"), x + count * metre + 18.0, y, _WORDS, "start")
    size = [figure(f"{value / MM_PER_M:.2f}", language) for value in state.size]
    words = say(language, "drawings.plan.floor", x=size[0], y=size[1])
    if state.left_open:
        words += "; " + say(language, "drawings.plan.open", count=len(state.left_open))
    yield group([*numbers, unit, text(words, x + count * metre + 90.0, y, _WORDS, "start")], _INK)


def laying_plan_svg(
    shell: Shell, state: FlatState, order: FlatOrder | None = None, language: Language = "en", page: Page = "a4"
) -> str:
    """Return the plan of a shell laid flat, to the scale printed on it; print it neither enlarged nor reduced.

    It fits inside the margins of a landscape page, A4 or A3. ``order`` adds the stacks beside the floor. PlanError if
    the floor is too large for the page.
    """
    stacks = _stacks(state, order)
    paper = _paper(state, stacks, page)
    box: Box = (0.0, 0.0, paper.width, paper.height - 105.0)
    feet = sorted(state.foot.values(), key=lambda point: float(point[0]))
    grid, taken = _grid(state, paper)
    items = [grid]
    if len(feet) > 1:
        items.append(line(paper(np.array(feet)), _FOOT))
    items += _members(shell, state, paper)
    solid = [m for m in state.members if m.layer <= 0]
    items.append(group((path(_triangle_points(m, paper)) for m in solid), _INK))
    items.append(group((path(_triangle_points(m, paper)) for m in state.members if m.layer > 0), _HOLLOW))
    piles, boxes = _piles(stacks, paper, language)
    taken += boxes
    names, boxes = _names(state, paper, box, taken)
    items += [piles, _studs(state, paper, box, [*boxes, *taken]), names]
    corner = paper(np.zeros((1, 2)))[0]
    items.append(
        group(
            [
                circle(corner, 9.0),
                text(say(language, "drawings.plan.datum"), corner[0] - 22.0, corner[1] + 32.0, 0.85 * _WORDS, "end"),
            ],
            _INK,
        )
    )
    return svg(paper.width, paper.height, [*items, *_key(shell, state, paper, language)])


def _piles(stacks: dict[str, Floats], paper: _Paper, language: Language) -> tuple[str, list[Box]]:
    """Return the stacks beside the floor, those in the same place side by side, and their boxes."""
    boxes: list[Box] = []
    shapes, end = "", -np.inf
    for family, place in sorted(stacks.items(), key=lambda item: (round(float(item[1][1])), float(item[1][0]))):
        x, y = paper(place[None])[0].tolist()
        words = say(language, "drawings.plan.stack", family=family)
        half = 0.602 * _WORDS * len(words) / 2.0 + 14.0
        beside = bool(boxes) and abs(y - (boxes[-1][1] + boxes[-1][3]) / 2.0) < 50.0
        x = max(x, end + half + 8.0) if beside else min(max(x, half), paper.width - half)
        end = x + half
        boxes.append((x - half, y - 24.0, x + half, y + 24.0))
        shapes += group([rectangle(x - half, y - 24.0, 2.0 * half, 48.0)], _STACK)
        shapes += group([text(words, x, y, _WORDS, bold=True)], _INK)
    return shapes, boxes


def laying_header(language: Language = "en") -> Row:
    """Return the head of the table of floor coordinates."""
    return says(language, "drawings.setting_out.header")


def laying_rows(shell: Shell, state: FlatState, language: Language = "en") -> list[Row]:
    """Return the floor coordinates, whole mm, of the ends of beams and geodesics, of studs and of the foot line.

    A row has the mark, what it is, x and y (of the start of a member), and x and y of its end, "" for a single point.
    The order is that of laying: layer by layer, then studs; the foot line, which is chalked first, comes first.
    """

    def numbers(point: Floats) -> tuple[str, str]:
        return f"{round(float(point[0]))}", f"{round(float(point[1]))}"

    def single(points: dict[str, Floats], word: str) -> list[Row]:
        what = say(language, f"drawings.setting_out.{word}")
        return [(short_mark(mark), what, *numbers(point), "", "") for mark, point in points.items()]

    long = [
        (
            short_mark(member.mark),
            say(language, f"drawings.setting_out.{'beam' if member.layer else 'geodesic'}"),
            *numbers(member.points[0]),
            *numbers(member.points[-1]),
        )
        for member in state.members
    ]
    return [*single(state.foot, "foot"), *long, *single(state.studs, "stud")]
