"""Flat patterns of the strips as DXF, and the table of strips and bars; equal ones of all shells once."""

import math
import os
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from aag_cad.design import Design
from aag_cad.export.workshop.blank_drawings import (
    CHECK_BAR,
    CHECK_LENGTH,
    DIMENSIONS,
    MARKS,
    OUTLINE,
    TITLE,
    Drawing,
    Item,
    Line,
    Point,
    Polyline,
    Text,
)
from aag_cad.export.workshop.dxf import dxf_bytes
from aag_cad.files import write_bytes, write_csv
from aag_cad.network.model import CurveId
from aag_cad.parts.facade import strip_neighbours
from aag_cad.parts.kinds import kind_of
from aag_cad.parts.marks import parse_mark, short_mark
from aag_cad.parts.members import curve_mark
from aag_cad.parts.model import FlatBar, Gridshell, Strip
from aag_cad.parts.products import product_key
from aag_cad.parts.quantities import mass, smallest_radius
from aag_cad.parts.shapes.sheet import FlatPattern, chord_offsets, flat_pattern, sheet_radius
from aag_cad.units import MM2_PER_M2, Floats
from assembly.base.mark_ranges import joined_ranges

FACADE_HEADER = (
    "pattern", "kind", "quantity", "marks", "mirror_of", "length_mm", "width_mm", "thickness_mm", "left_edge_mm",
    "right_edge_mm", "left_sagitta_mm", "right_sagitta_mm", "area_m2", "min_radius_mm", "mass_kg", "stock_mm", "holes",
)  # fmt: skip
ORDINATE_SPACING = 250.0
_SAME = 0.1
_COMPARED = 17
_SMALL, _LARGE = 32.0, 90.0
_ROW = 1.8


@dataclass(frozen=True, eq=False)
class StripPattern:
    """A flat pattern with all strips that are cut after it; ``mirror`` names the pattern that is its mirror image."""

    name: str
    strips: tuple[Strip, ...]
    flat: FlatPattern
    mirror: str


def _outline_samples(flat: FlatPattern) -> Floats:
    """Return points on edges and cuts, (n, 2), by which two patterns are compared."""
    t = np.linspace(0.0, 1.0, _COMPARED)
    edges = [
        np.column_stack([np.interp(t, np.linspace(0.0, 1.0, len(edge)), edge[:, axis]) for axis in (0, 1)])
        for edge in (flat.left, flat.right)
    ]
    return np.concatenate([*edges, flat.lower, flat.upper])


def _mirrored(flat: FlatPattern) -> Floats:
    """Return the samples of the mirror image about the middle line, left and right exchanged."""
    t = _outline_samples(flat) * np.array([1.0, -1.0])
    ends = t[2 * _COMPARED :]
    lower, upper = ends[: len(flat.lower)][::-1], ends[len(flat.lower) :][::-1]
    return np.concatenate([t[_COMPARED : 2 * _COMPARED], t[:_COMPARED], lower, upper])


def _same(a: Floats, b: Floats) -> bool:
    return a.shape == b.shape and bool(np.abs(a - b).max() < _SAME)


def strip_patterns(gridshell: Gridshell) -> list[StripPattern]:
    """Return the flat patterns of all strips, sorted by mark; strips are equal if no point differs by 0.1 mm."""
    flats: dict[str, FlatPattern] = {}
    groups: list[tuple[FlatPattern, Floats, list[Strip]]] = []
    for strip in (strip for shell in gridshell.shells for strip in shell.strips):
        key = product_key(strip)
        if key not in flats:
            flats[key] = flat_pattern(strip)
        samples = _outline_samples(flats[key])
        for _, others, strips in groups:
            if _same(samples, others):
                strips.append(strip)
                break
        else:
            groups.append((flats[key], samples, [strip]))
    names = [short_mark(strips[0].mark) for _, _, strips in groups]
    patterns = []
    for name, (flat, _, strips) in zip(names, groups, strict=True):
        image = _mirrored(flat)
        mirrors = [
            other
            for other, (_, samples, _) in zip(names, groups, strict=True)
            if other != name and _same(image, samples)
        ]
        patterns.append(StripPattern(name, tuple(strips), flat, mirrors[0] if mirrors else ""))
    return patterns


def edge_ordinates(edge: Floats) -> list[tuple[float, float]]:
    """Return (distance along the chord, ordinate left of it) of a flat edge (n, 2) every 250 mm, and at its end."""
    along, beside = chord_offsets(edge)
    stations = [*np.arange(0.0, along[-1], ORDINATE_SPACING).tolist(), float(along[-1])]
    return [(s, float(np.interp(s, along, beside))) for s in stations]


def _points(points: Floats) -> tuple[Point, ...]:
    return tuple((round(float(x), 3) + 0.0, round(float(y), 3) + 0.0) for x, y in points)


def _edge_items(edge: Floats) -> list[Item]:
    """Return the chord of an edge and a tick from chord to edge at every ordinate."""
    a, b = edge[0], edge[-1]
    direction = (b - a) / np.linalg.norm(b - a)
    left = np.array([-direction[1], direction[0]])
    items: list[Item] = [Line(DIMENSIONS, *_points(np.array([a, b])))]
    for station, ordinate in edge_ordinates(edge)[1:-1]:
        foot = a + station * direction
        items.append(Line(DIMENSIONS, *_points(np.array([foot, foot + ordinate * left]))))
    return items


def _arrow(x: float, y: float, length: float) -> list[Item]:
    tip = x + length
    return [
        Line(MARKS, (x, y), (tip, y)),
        Polyline(MARKS, ((tip, y), (tip - 60.0, y + 15.0), (tip - 60.0, y - 15.0))),
    ]


def _ordinate_table(flat: FlatPattern, names: Sequence[str], low: float) -> list[Item]:
    """Return the table of ordinates under the drawing, each column under its station."""
    items: list[Item] = [
        Text(TITLE, "distance of the edge from the straight line between its corners, inwards", (0.0, low), _SMALL)
    ]
    for row, (name, edge, inward) in enumerate(zip(names, (flat.left, flat.right), (1.0, -1.0), strict=True)):
        y = low - _ROW * _SMALL * (1.0 + 2.5 * row)
        for place, text in ((y, "along it"), (y - _ROW * _SMALL, f"edge on {name}")):
            items.append(Text(TITLE, text, (-60.0, place), _SMALL, "right"))
        ordinates = edge_ordinates(edge)
        if len(ordinates) > 2 and ordinates[-1][0] - ordinates[-2][0] < 4.5 * _SMALL:
            ordinates.pop(-2)
        for station, ordinate in ordinates:
            items.append(Text(TITLE, f"{station:.1f}".removesuffix(".0"), (station, y), _SMALL, "centre"))
            inwards = round(inward * ordinate, 1) + 0.0
            items.append(Text(TITLE, f"{inwards:.1f}", (station, y - _ROW * _SMALL), _SMALL, "centre"))
    return items


def _corner_text(flat: FlatPattern) -> str:
    corners = (("foot", flat.lower), ("top", flat.upper))
    texts = [
        f"{name} " + ", ".join(f"({round(x, 1) + 0.0:.1f}, {round(y, 1) + 0.0:.1f})" for x, y in points.tolist())
        for name, points in corners
    ]
    return "corners (along, across from the middle line), the lower edge first: " + "; ".join(texts)


def _title_lines(pattern: StripPattern, design: Design, title: str) -> tuple[str, ...]:
    flat, facade = pattern.flat, design.facade
    stock = stock_length(design, flat.length)
    sheet = f"{facade.sheet_width:g} x {stock:g}" if stock else "none in stock is long enough"
    mirror = f"; mirror image of {pattern.mirror}, which has its own drawing" if pattern.mirror else ""
    return (
        f"{pattern.name}   {title}",
        f"cut {len(pattern.strips)}: {joined_ranges([strip.mark for strip in pattern.strips])}{mirror}",
        f"flat {flat.length:.1f} x {flat.width:.1f}   sheet {sheet}   thickness {facade.sheet_thickness:g}   "
        f"{flat.area / MM2_PER_M2:.3f} m2   {flat.area / MM2_PER_M2 * facade.sheet_mass:.2f} kg",
        _corner_text(flat),
        "Seen from outside, weather side up; ribs along the arrow. All in mm.",
    )


def strip_drawing(pattern: StripPattern, design: Design, title: str) -> Drawing:
    """Return the flat pattern of a strip as a drawing, 1:1 in mm: x along the ribs from the foot, seen from outside."""
    flat = pattern.flat
    neighbours = strip_neighbours(design, parse_mark(pattern.strips[0].mark).index)
    names = [short_mark(curve_mark(1, CurveId("G", number))) for number in neighbours]
    middle, below = flat.length / 2.0, float(flat.outline[:, 1].min())
    above = float(flat.outline[:, 1].max())
    items: list[Item] = [Polyline(OUTLINE, _points(flat.outline))]
    items += [item for edge in (flat.left, flat.right) for item in _edge_items(edge)]
    items += _arrow(middle - 500.0, 0.0, 1000.0)
    items.append(Text(MARKS, pattern.name, (middle - 560.0, 0.0), _LARGE, "right"))
    items.append(Text(MARKS, "ribs, bending, upwards", (middle, 1.5 * _SMALL), _SMALL, "centre"))
    for name, edge, sign in zip(names, (flat.left, flat.right), (1.0, -1.0), strict=True):
        y = float(np.interp(middle, edge[:, 0], edge[:, 1])) + sign * 1.5 * _SMALL
        items.append(Text(MARKS, f"edge on {name}", (middle, y), _SMALL, "centre"))
    items.append(Text(MARKS, "FOOT", (-20.0, 0.0), _SMALL, "right"))
    items.append(Text(MARKS, "TOP", (flat.length + 20.0, 0.0), _SMALL))
    low = below - 3.0 * _SMALL
    items += _ordinate_table(flat, names, low)
    low -= 7.5 * _ROW * _SMALL
    items += [
        Line(CHECK_BAR, (0.0, low), (CHECK_LENGTH, low)),
        *(Line(CHECK_BAR, (x, low - 10.0), (x, low + 10.0)) for x in (0.0, CHECK_LENGTH)),
        Text(CHECK_BAR, f"check bar {CHECK_LENGTH:g} mm", (0.0, low + 1.2 * _SMALL), _SMALL),
    ]
    for number, line in enumerate(_title_lines(pattern, design, title)):
        items.append(Text(TITLE, line, (600.0, low - _ROW * _SMALL * number), _SMALL))
    low -= 6.0 * _ROW * _SMALL
    return Drawing(pattern.name, tuple(items), (-450.0, low, flat.length + 200.0, above + 60.0))


def write_flat_patterns(design: Design, gridshell: Gridshell, folder: str | os.PathLike[str]) -> None:
    """Write one DXF for each flat pattern into a folder, named by its first strip, e.g. ``P-01.dxf``.

    FileError if a file cannot be written.
    """
    for pattern in strip_patterns(gridshell):
        write_bytes(Path(folder) / f"{pattern.name}.dxf", dxf_bytes(strip_drawing(pattern, design, gridshell.title)))


def stock_length(design: Design, length: float) -> float | None:
    """Return the shortest stock sheet for a flat length, mm, or None if none is long enough."""
    return min((stock for stock in design.facade.sheet_lengths if stock >= length), default=None)


def _strip_row(pattern: StripPattern, design: Design) -> tuple[str, ...]:
    flat, stock = pattern.flat, stock_length(design, pattern.flat.length)
    area, radius = flat.area / MM2_PER_M2, sheet_radius(pattern.strips[0])
    return (
        pattern.name,
        "strip",
        str(len(pattern.strips)),
        joined_ranges([strip.mark for strip in pattern.strips]),
        pattern.mirror,
        f"{flat.length:.1f}",
        f"{flat.width:.1f}",
        f"{design.facade.sheet_thickness:g}",
        f"{flat.left_length:.1f}",
        f"{flat.right_length:.1f}",
        f"{flat.left_sagitta:.1f}",
        f"{flat.right_sagitta:.1f}",
        f"{area:.4f}",
        "" if math.isinf(radius) else f"{radius:.0f}",
        f"{area * design.facade.sheet_mass:.3f}",
        f"{stock:g}" if stock else "",
        "0",
    )


def _bar_row(bars: Sequence[FlatBar], gridshell: Gridshell) -> tuple[str, ...]:
    bar = bars[0]
    blank, radius = bar.blank, smallest_radius(bar)
    return (
        short_mark(bar.mark),
        kind_of(bar).name,
        str(len(bars)),
        joined_ranges([other.mark for other in bars]),
        "",
        f"{blank.length:.1f}",
        f"{blank.section.width:g}",
        f"{blank.section.thickness:g}",
        *("",) * 5,
        "" if math.isinf(radius) else f"{radius:.0f}",
        f"{mass(bar, gridshell.timber):.3f}",
        "",
        str(len(blank.holes)),
    )


def _bar_products(bars: Iterable[FlatBar]) -> list[list[FlatBar]]:
    products: dict[str, list[FlatBar]] = defaultdict(list)
    for bar in bars:
        products[product_key(bar)].append(bar)
    return list(products.values())


def write_facade_table(design: Design, gridshell: Gridshell, path: str | os.PathLike[str]) -> None:
    """Write one line for every flat pattern and every bar, with how many are wanted; FileError if it cannot be done."""
    rows = [_strip_row(pattern, design) for pattern in strip_patterns(gridshell)]
    for bars in (
        [bar for shell in gridshell.shells for bar in shell.mullions],
        [bar for shell in gridshell.shells for bar in shell.clamps],
    ):
        rows += [_bar_row(product, gridshell) for product in _bar_products(bars)]
    write_csv(path, FACADE_HEADER, rows)
