"""The pictures of the steps: what is new stands out heavily over the grey of what is already there."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from aag_cad.units import Floats
from assembly.drawing import (
    Box,
    Style,
    circle,
    group,
    label_box,
    label_svg,
    path,
    placed_labels,
    places_along,
    places_round,
    svg,
)
from assembly.outline import Outline

THERE = Style("#e4e4e4", "#8f8f8f", 1.2)
LATER = Style("none", "#c4c4c4", 0.8, "5 6")
NEW = {
    "A1": Style("#16315e", "#000", 2.0),
    "A2": Style("#9c3d10", "#000", 2.0),
    "G": Style("#3f7d4e", "#000", 2.5),
    "E": Style("#2b2b2b", "#000", 2.5),
}
FAINT_NEW = Style("#b9b9b9", "#000", 2.5)
DOT = Style("#000", "#fff", 2.0)
RING = Style("#fff", "#000", 3.0)
DONE = Style("#777")
LABEL_SIZE = 27.0
DOT_LABEL_SIZE = 23.0
_DOT = 10.0

_SHARES = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.12, 0.88)


@dataclass(frozen=True)
class Scene:
    """What a picture shows of a shell, by mark.

    ``there``, ``new`` and ``worked_on`` are planks; ``dots`` joints with a solid dot, ``rings`` joints with a ring,
    ``done`` joints with a small grey dot. ``names`` are framed labels of planks or beams along their lines, ``tags``
    framed and ``numbers`` plain labels at joints; ``starts`` are planks or beams whose start ends get a triangle.
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


def _triangle(start: Floats, towards: Floats, size: float) -> Floats:
    """Return a triangle (3, 2) before the start of a line that points into it."""
    along = (towards - start) / np.linalg.norm(towards - start)
    across = np.array([-along[1], along[0]])
    tip, base = start - 0.3 * size * along, start - 1.6 * size * along
    return np.array([tip, base + 0.5 * size * across, base - 0.5 * size * across])


def _labels(outline: Outline, scene: Scene) -> str:
    """Return the labels of planks (framed) and joints (plain), clear of the dots and of each other."""
    sheet: Box = (0.0, 0.0, outline.width, outline.height)
    dots = (outline.points[mark].tolist() for mark in (*scene.dots, *scene.rings))
    taken: list[Box] = [(x - _DOT, y - _DOT, x + _DOT, y + _DOT) for x, y in dots]
    points, size = outline.points, DOT_LABEL_SIZE
    tagged = [(name, places_round(points[mark], 1.5 * LABEL_SIZE)) for mark, name in scene.tags.items()]
    named = [(name, places_along(outline.lines[mark], _SHARES)) for mark, name in scene.names.items()]
    numbered = [(name, places_round(points[mark], 1.2 * size)) for mark, name in scene.numbers.items()]
    names = placed_labels([*tagged, *named], LABEL_SIZE, sheet, taken)
    numbers = placed_labels(numbered, size, sheet, [*taken, *(label_box(label) for label in names)])
    return label_svg(numbers, framed=False) + label_svg(names)


def scene_items(outline: Outline, scene: Scene) -> Iterable[str]:
    """Yield the shapes of a scene, from the lowest layer to the labels."""
    shown = {*scene.there, *scene.new, *scene.worked_on}
    yield group((path(points) for mark, points in outline.planks.items() if mark not in shown), LATER)
    for mark, points in outline.planks.items():
        if mark in scene.new:
            yield group([path(points)], NEW[mark.split("-")[1]])
        elif mark in shown:
            yield group([path(points)], FAINT_NEW if mark in scene.worked_on else THERE)
    triangles = (_triangle(outline.lines[mark][0], outline.lines[mark][1], 24.0) for mark in scene.starts)
    yield group((path(triangle) for triangle in triangles), Style("#000"))
    yield group((circle(outline.points[mark], 0.6 * _DOT) for mark in scene.done), DONE)
    yield group((circle(outline.points[mark], 0.8 * _DOT) for mark in scene.rings), RING)
    yield group((circle(outline.points[mark], _DOT) for mark in scene.dots), DOT)
    yield _labels(outline, scene)


def scene_svg(outline: Outline, scene: Scene) -> str:
    """Return the picture of a scene."""
    return svg(outline.width, outline.height, scene_items(outline, scene))
