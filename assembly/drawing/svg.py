"""Plain SVG: shapes as text, and labels that keep clear of each other. Sheet units, y down."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import TypeAlias

import numpy as np

from aag_cad.units import Floats

FONT = "DejaVu Sans Mono"
UNITS_PER_MM = 10.0
CHARACTER = 0.602
_CAPITAL = 0.73
_SAME_AREA = 1e-6
# What rounds to 0.0 at one decimal.
_NOTHING = 0.05

Box: TypeAlias = tuple[float, float, float, float]


@dataclass(frozen=True)
class Style:
    """How a shape is painted; widths in sheet units, ``dash`` as in SVG or ""."""

    fill: str = "none"
    stroke: str = "none"
    width: float = 1.0
    dash: str = ""


@dataclass(frozen=True)
class Label:
    """A text in its box, centred at (x, y)."""

    text: str
    x: float
    y: float
    size: float


def number(value: float) -> str:
    """Return a coordinate with at most one decimal."""
    return f"{value:.1f}".removesuffix(".0") if abs(value) >= _NOTHING else "0"


def _paint(style: Style) -> str:
    text = f' fill="{style.fill}"'
    if style.stroke != "none":
        text += f' stroke="{style.stroke}" stroke-width="{style.width:g}" stroke-linejoin="round"'
        text += f' stroke-dasharray="{style.dash}"' if style.dash else ""
    return text


def group(items: Iterable[str], style: Style) -> str:
    """Return items painted alike."""
    body = "".join(items)
    return f"<g{_paint(style)}>{body}</g>" if body else ""


def _steps(points: Floats) -> str:
    # As ``number`` does it, but all in one go: the booklets have half a million of them.
    values = np.where(np.abs(points) < _NOTHING, 0.0, points).ravel().tolist()
    return "M" + ("%.1f " * len(values) % tuple(values)).replace(".0 ", " ").rstrip()


def path(points: Floats, closed: bool = True) -> str:
    """Return a polygon or polyline through points (n, 2), to be painted by its group."""
    return f'<path d="{_steps(points)}{"Z" if closed else ""}"/>'


def polylines(lines: Iterable[Floats], closed: bool = False) -> str:
    """Return lines or polygons, each through points (n, 2), as one shape, to be painted by its group."""
    end = "Z" if closed else ""
    return f'<path d="{"".join(_steps(points) + end for points in lines)}"/>'


def polygon(points: Floats, style: Style) -> str:
    """Return a closed polygon over points (n, 2)."""
    return group([path(points)], style)


def line(points: Floats, style: Style) -> str:
    """Return an open line through points (n, 2)."""
    return group([path(points, closed=False)], style)


def circle(centre: Sequence[float] | Floats, radius: float) -> str:
    """Return a circle, to be painted by its group."""
    return f'<circle cx="{number(float(centre[0]))}" cy="{number(float(centre[1]))}" r="{number(radius)}"/>'


def rectangle(x: float, y: float, width: float, height: float, radius: float = 0.0) -> str:
    """Return a rectangle from its upper left corner, its corners rounded by a radius, to be painted by its group."""
    rounded = f' rx="{number(radius)}"' if radius else ""
    return f'<rect x="{number(x)}" y="{number(y)}" width="{number(width)}" height="{number(height)}"{rounded}/>'


def text(content: str, x: float, y: float, size: float, anchor: str = "middle", bold: bool = False) -> str:
    """Return a text whose capitals are centred at height y; ``anchor`` is start, middle or end."""
    weight = ' font-weight="bold"' if bold else ""
    return (
        f'<text x="{number(x)}" y="{number(y + _CAPITAL * size / 2.0)}" font-size="{number(size)}" '
        f'text-anchor="{anchor}"{weight}>{escape(content)}</text>'
    )


def svg(width: float, height: float, items: Iterable[str]) -> str:
    """Return an SVG file of the given size in sheet units (a tenth of a millimetre each)."""
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width / UNITS_PER_MM:g}mm" '
    head += f'height="{height / UNITS_PER_MM:g}mm" '
    view = f'viewBox="0 0 {number(width)} {number(height)}" font-family="{FONT}">'
    return head + view + "".join(items) + "</svg>\n"


def label_box(label: Label) -> Box:
    """Return the box (left, top, right, bottom) that a label covers."""
    half = CHARACTER * label.size * len(label.text) / 2.0 + 0.25 * label.size
    return label.x - half, label.y - 0.62 * label.size, label.x + half, label.y + 0.62 * label.size


def _overlaps(boxes: Floats, others: Floats) -> Floats:
    """Return the areas (n, m) that boxes (n, 4) share with others (m, 4)."""
    wide = np.minimum(boxes[:, None, 2], others[:, 2]) - np.maximum(boxes[:, None, 0], others[:, 0])
    high = np.minimum(boxes[:, None, 3], others[:, 3]) - np.maximum(boxes[:, None, 1], others[:, 1])
    return np.asarray(np.clip(wide, 0.0, None) * np.clip(high, 0.0, None))


def placed_labels(
    wanted: Sequence[tuple[str, Floats]], size: float, sheet: Box, taken: Sequence[Box] = ()
) -> tuple[Label, ...]:
    """Return labels, each at that of its places (k, 2) where it covers least of earlier labels and ``taken`` boxes.

    Earlier places are better where the cover is equal; what would stick out of the ``sheet`` counts as covered.
    """
    held = len(taken)
    boxes = np.zeros((held + len(wanted), 4))
    boxes[:held] = np.array(taken, dtype=float).reshape(held, 4)
    page = np.array([sheet])
    labels: list[Label] = []
    for content, places in wanted:
        tried = [Label(content, x, y, size) for x, y in places.tolist()]
        found = np.array([label_box(label) for label in tried])
        areas = (found[:, 2] - found[:, 0]) * (found[:, 3] - found[:, 1])
        covers = _overlaps(found, boxes[: held + len(labels)]).sum(axis=1) + 10.0 * (
            areas - _overlaps(found, page)[:, 0]
        )
        best = 0
        for i, cover in enumerate(covers.tolist()):
            best = i if cover < covers[best] - _SAME_AREA else best
        boxes[held + len(labels)] = found[best]
        labels.append(tried[best])
    return tuple(labels)


def label_svg(labels: Iterable[Label], framed: bool = True) -> str:
    """Return labels as black text, on white boxes with a thin frame or without."""
    listed = tuple(labels)
    boxes = (label_box(label) for label in listed)
    plates = (rectangle(a, b, c - a, d - b) for a, b, c, d in boxes)
    style = Style("#fff", "#000", 1.5) if framed else Style("#fff")
    texts = (text(label.text, label.x, label.y, label.size, bold=framed) for label in listed)
    return group(plates, style) + group(texts, Style("#000"))


def places_along(points: Floats, shares: Sequence[float]) -> Floats:
    """Return places (k, 2) at shares of the length of a polyline (n, 2)."""
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    at = np.array(shares) * lengths[-1]
    return np.column_stack([np.interp(at, lengths, points[:, 0]), np.interp(at, lengths, points[:, 1])])


def places_round(centre: Floats, distance: float) -> Floats:
    """Return places (16, 2) round a point (2,) for a label: close by in eight directions, then farther away."""
    around = np.array([(0, -1), (0, 1), (1.4, 0), (-1.4, 0), (1.4, -0.8), (-1.4, -0.8), (1.4, 0.8), (-1.4, 0.8)])
    return np.asarray(centre + distance * np.concatenate([around, 1.7 * around]))
