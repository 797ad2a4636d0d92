"""The pictures of the steps: what is new stands out heavily over the grey of what is already there."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from aag_cad.colours import LEGEND
from aag_cad.families import FAMILIES
from aag_cad.parts.marks import parse_mark, plank_of
from aag_cad.units import Floats
from assembly.drawing.outline import Outline
from assembly.drawing.svg import (
    Box,
    Style,
    circle,
    group,
    label_box,
    label_svg,
    number,
    path,
    placed_labels,
    places_along,
    places_round,
    rectangle,
    svg,
)

THERE = Style("#e4e4e4", "#8f8f8f", 1.2)
LATER = Style("none", "#c4c4c4", 0.8, "5 6")
NEW: dict[str, Style] = {
    family: Style(row.colour, "#000", 2.0 if row.upright else 2.5) for family, row in FAMILIES.items()
}
# Pieces by their colour in the legend.
PIECES = {
    "steel": Style(LEGEND["steel"], "#000", 1.5),
    "concrete": Style(LEGEND["concrete"], "#000", 2.0),
    "sheet": Style(LEGEND["sheet"], "#4b7389", 1.5),
    "aluminium": Style(LEGEND["aluminium"], "#000", 0.8),
}
FAINT_NEW = Style("#b9b9b9", "#000", 2.5)
DOT = Style("#000", "#fff", 2.0)
RING = Style("#fff", "#000", 3.0)
DONE = Style("#777")
LABEL_SIZE = 27.0
DOT_LABEL_SIZE = 23.0
_DOT = 10.0
_TRIANGLE = 24.0
_PROP = 12.0
_BESIDE = 230.0

_SHARES = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.12, 0.88)


@dataclass(frozen=True)
class Scene:
    """What a picture shows of a shell, by mark.

    ``there`` and ``new`` are planks and other pieces, ``worked_on`` planks; ``dots`` joints with a solid dot, ``rings``
    joints with a ring, ``done`` joints with a small grey dot, ``props`` joints on a prop. ``names`` are framed labels
    of planks, beams or pieces along their lines, ``tags`` framed and ``numbers`` plain labels at joints; ``starts`` are
    planks or beams whose start ends get a triangle. ``slides`` are planks or beams that are slid in along their line,
    each with the end that lies outside longest.
    """

    there: Collection[str] = ()
    new: Collection[str] = ()
    worked_on: Collection[str] = ()
    dots: Sequence[str] = ()
    rings: Sequence[str] = ()
    done: Sequence[str] = ()
    names: Mapping[str, str] = field(default_factory=dict)
    numbers: Mapping[str, str] = field(default_factory=dict)
    tags: Mapping[str, str] = field(default_factory=dict)
    starts: Sequence[str] = ()
    props: Sequence[str] = ()
    slides: Mapping[str, Literal["start", "end"]] = field(default_factory=dict)


def start_triangle(points: Floats) -> Floats:
    """Return a triangle (3, 2) before the start of a line (n, 2) that points into it."""
    start, along = points[0], (points[1] - points[0]) / np.linalg.norm(points[1] - points[0])
    across = np.array([-along[1], along[0]])
    tip, base = start - 0.3 * _TRIANGLE * along, start - 1.6 * _TRIANGLE * along
    return np.array([tip, base + 0.5 * _TRIANGLE * across, base - 0.5 * _TRIANGLE * across])


def slide_arrow(points: Floats, outside: Literal["start", "end"]) -> str:
    """Return an arrow beside the middle of a line (n, 2), from the end that lies outside longest."""
    ends = places_along(points, (0.06, 0.3) if outside == "start" else (0.94, 0.7))
    along = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    across = np.array([-along[1], along[0]])
    tail, tip = ends + 34.0 * across
    neck = tip - 46.0 * along
    shaft = np.array([tail + 7.0 * across, neck + 7.0 * across, neck - 7.0 * across, tail - 7.0 * across])
    head = np.array([tip, neck + 24.0 * across, neck - 24.0 * across])
    return group([path(np.array([*shaft[:2], head[1], head[0], head[2], *shaft[2:]]))], Style("#000", "#fff", 3.0))


def prop_items(points: Iterable[Floats]) -> str:
    """Return squares with a cross over places (2,): props."""
    crossed = []
    for x, y in (point.tolist() for point in points):
        a, b, c, d = x - _PROP, y - _PROP, x + _PROP, y + _PROP
        crossed.append(rectangle(a, b, 2.0 * _PROP, 2.0 * _PROP))
        crossed += [path(np.array(diagonal), closed=False) for diagonal in (((a, b), (c, d)), ((a, d), (c, b)))]
    return group(crossed, Style("#fff", "#000", 3.0))


def _labels(outline: Outline, scene: Scene) -> str:
    """Return the labels of planks (framed) and joints (plain), clear of the dots and of each other."""
    sheet: Box = (0.0, 0.0, outline.width, outline.height)
    new = ((outline.kinds[mark], piece) for mark, piece in outline.pieces.items() if mark in scene.new)
    fittings = [piece for row, piece in new if row.role == "connector" and row.place != "ground"]
    dots = (outline.points[mark].tolist() for mark in (*scene.dots, *scene.rings, *scene.props))
    taken: list[Box] = [(x - _DOT, y - _DOT, x + _DOT, y + _DOT) for x, y in dots]
    taken += [(*piece.min(axis=0).tolist(), *piece.max(axis=0).tolist()) for piece in fittings]
    points, size = outline.points, DOT_LABEL_SIZE
    tagged = [(name, places_round(points[mark], 1.5 * LABEL_SIZE)) for mark, name in scene.tags.items()]
    named = [(name, places_along(outline.lines[mark], _SHARES)) for mark, name in scene.names.items()]
    numbered = [(name, places_round(points[mark], 1.2 * size)) for mark, name in scene.numbers.items()]
    names = placed_labels([*tagged, *named], LABEL_SIZE, sheet, taken)
    numbers = placed_labels(numbered, size, sheet, [*taken, *(label_box(label) for label in names)])
    return label_svg(numbers, framed=False) + label_svg(names)


def _piece_items(outline: Outline, scene: Scene, beneath: bool) -> Iterable[str]:
    """Yield the pieces of a scene beside its planks: those on the ground, which are ``beneath``, or the others."""
    for mark, points in outline.pieces.items():
        row = outline.kinds[mark]
        if (row.place == "ground") != beneath:
            continue
        if mark in scene.new:
            yield group([path(points)], PIECES[row.colour])
        elif mark in scene.there:
            yield group([path(points)], THERE)


def scene_items(outline: Outline, scene: Scene) -> Iterable[str]:
    """Yield the shapes of a scene, from the lowest layer to the labels."""
    shown = {*scene.there, *scene.new, *scene.worked_on}
    yield group((path(points) for mark, points in outline.planks.items() if mark not in shown), LATER)
    yield from _piece_items(outline, scene, beneath=True)
    for mark, points in outline.planks.items():
        if mark in scene.new:
            yield group([path(points)], NEW[parse_mark(plank_of(mark)).family])
        elif mark in shown:
            yield group([path(points)], FAINT_NEW if mark in scene.worked_on else THERE)
    yield from _piece_items(outline, scene, beneath=False)
    triangles = (start_triangle(outline.lines[mark]) for mark in scene.starts)
    yield group((path(triangle) for triangle in triangles), Style("#000"))
    yield group((circle(outline.points[mark], 0.6 * _DOT) for mark in scene.done), DONE)
    yield group((circle(outline.points[mark], 0.8 * _DOT) for mark in scene.rings), RING)
    yield group((circle(outline.points[mark], _DOT) for mark in scene.dots), DOT)
    yield prop_items(outline.points[mark] for mark in scene.props)
    yield from (slide_arrow(outline.lines[mark], outside) for mark, outside in scene.slides.items())
    yield _labels(outline, scene)


def scene_svg(outline: Outline, scene: Scene, around: Collection[str] = ()) -> str:
    """Return the picture of a scene; of its height only what lies ``around`` some planks, if any are named."""
    if not around:
        return svg(outline.width, outline.height, scene_items(outline, scene))
    heights = np.concatenate([outline.planks[mark][:, 1] for mark in around])
    top, foot = max(0.0, float(heights.min()) - _BESIDE), min(outline.height, float(heights.max()) + _BESIDE)
    moved = (f'<g transform="translate(0 {number(-top)})">', *scene_items(outline, scene), "</g>")
    return svg(outline.width, foot - top, moved)
