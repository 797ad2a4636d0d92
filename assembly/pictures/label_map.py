"""Maps of a shell's marks, square on from outside; for black-and-white printers."""

from collections.abc import Iterator, Sequence

import numpy as np

from aag_cad.colours import mixed
from aag_cad.families import BEAMS, EDGES, FAMILIES, GEODESICS
from aag_cad.language import Language, say
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import number_of, parse_mark, short_mark
from aag_cad.parts.model import Shell
from aag_cad.units import Floats
from assembly.drawing.outline import Outline, shell_outline
from assembly.drawing.svg import (
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
    text,
)

# Inside the margins of an A4 landscape page, below a heading.
MAP_SIZE = (2500.0, 1780.0)
_MARGIN = 95.0
_NAME, _NUMBER = 24.0, 22.0
_DOT = 8.0
_FOOT = 60.0
_AWAY = 29.0

# Pale, for the marks stand over them.
_PLANKS = {family: Style(mixed(row.colour, "#ffffff", 0.7), "#777", 1.0) for family, row in FAMILIES.items()}
_INK = Style("#000")
_OPEN = Style("#fff", "#000", 2.5)


def _triangle(line: Floats) -> Floats:
    """Return a triangle (3, 2) before the start of a line that points into it."""
    out = (line[0] - line[1]) / np.linalg.norm(line[0] - line[1])
    across = np.array([-out[1], out[0]])
    return np.array([line[0] + 5.0 * out, *(line[0] + 28.0 * out + side * 11.0 * across for side in (1.0, -1.0))])


def _lines(shell: Shell, outline: Outline) -> dict[str, Floats]:
    """Return the lines of beams and flat planks from their start, by mark."""
    return {mark: outline.lines[mark] for mark in index_of(shell).units}


def _plank_items(shell: Shell, outline: Outline) -> Iterator[str]:
    planks = index_of(shell).planks
    for mark, points in outline.planks.items():
        yield group([path(points)], _PLANKS[planks[mark].family])


def _names(lines: dict[str, Floats], sheet: Box, taken: list[Box]) -> str:
    """Return framed marks: of beams at their start ends, of geodesics beyond the others, of edge planks on them."""
    wanted = []
    for mark, line in sorted(lines.items(), key=lambda item: (parse_mark(item[0]).family not in BEAMS, item[0])):
        family = parse_mark(mark).family
        if family in EDGES:
            wanted.append((short_mark(mark), places_along(line, (0.5, 0.42, 0.58, 0.34, 0.66, 0.26, 0.74, 0.18, 0.82))))
            continue
        ends = line[::-1] if family in GEODESICS else line
        out = (ends[0] - ends[1]) / np.linalg.norm(ends[0] - ends[1])
        across = np.array([-out[1], out[0]])
        aways = ((66, 0), (60, 40), (60, -40), (95, 0), (90, 55), (90, -55), (130, 0), (125, 50), (125, -50), (165, 0))
        places = np.array([ends[0] + along * out + aside * across for along, aside in aways])
        wanted.append((short_mark(mark), places))
    return label_svg(placed_labels(wanted, _NAME, sheet, taken))


def _name(mark: str) -> str:
    """Return what stands beside a joint: its number; its short mark where others have like numbers."""
    return number_of(mark) if parse_mark(mark).family in ("N", "K") else short_mark(mark)


def _crossing(shell: Shell) -> dict[str, tuple[str, ...]]:
    """Return the beams and flat planks that meet at each joint."""
    unit = index_of(shell).unit_of
    return {j.mark: tuple(dict.fromkeys(unit[mark] for mark in j.members if mark in unit)) for j in shell.joints}


def _direction(line: Floats, point: Floats) -> Floats:
    """Return the direction (2,) of a line near a point."""
    at = min(max(int(np.linalg.norm(line - point, axis=1).argmin()), 1), len(line) - 2)
    way = line[at + 1] - line[at - 1]
    return np.asarray(way / np.linalg.norm(way))


def _places(mark: str, crossing: dict[str, tuple[str, ...]], outline: Outline, lines: dict[str, Floats]) -> Floats:
    """Return places (k, 2) for the label of a joint: in the wider angles of what crosses there, at the rim outwards."""
    point = outline.points[mark]
    if parse_mark(mark).family not in ("N", "K"):
        out = point - np.mean(list(outline.points.values()), axis=0)
        out = out / np.linalg.norm(out)
        across = np.array([-out[1], out[0]])
        aways = ((48, 0), (44, 35), (44, -35), (75, 0), (70, 45), (70, -45), (100, 0))
        return np.array([point + along * out + aside * across for along, aside in aways])
    meeting = [line for other in crossing[mark] if (line := lines.get(other)) is not None and len(line) > 2]
    if len(meeting) < 2:
        return places_round(point, _AWAY)
    a, b = (_direction(line, point) for line in meeting[:2])
    wide = a - np.copysign(1.0, a @ b) * b
    wide = wide / np.linalg.norm(wide) * [1.35, 1.0]
    wide *= np.copysign(1.0, -wide[1])
    return np.concatenate([[point + _AWAY * wide, point - _AWAY * wide], places_round(point, _AWAY)])


def label_map_svg(
    shell: Shell,
    families: Sequence[str] = ("N", "F", "R"),
    language: Language = "en",
    size: tuple[float, float] = MAP_SIZE,
) -> str:
    """Return the map of a shell's joints of some families, square on from outside, with the marks of all its members.

    Studs N are open circles with their numbers, coupling blocks K dots with theirs; feet F and straps R have their
    short marks. Triangles point to start ends. ``size`` is what the sheet may measure at most, in tenths of a mm.
    """
    outline = shell_outline(shell, size[0], _MARGIN)
    if outline.height + _FOOT > size[1]:
        share = (size[1] - _FOOT - 2.0 * _MARGIN) / (outline.height - 2.0 * _MARGIN)
        outline = shell_outline(shell, 2.0 * _MARGIN + share * (size[0] - 2.0 * _MARGIN), _MARGIN)
    lines = _lines(shell, outline)
    crossing = _crossing(shell)
    joints = [joint.mark for joint in shell.joints if parse_mark(joint.mark).family in families]
    # Names at the rim have fewer places to go to than numbers inside.
    joints.sort(key=lambda mark: parse_mark(mark).family in ("N", "K"))
    sheet: Box = (0.0, 0.0, outline.width, outline.height + _FOOT)
    triangles = [_triangle(line) for line in lines.values()]
    dots: list[Box] = [
        (x - _DOT, y - _DOT, x + _DOT, y + _DOT) for x, y in (outline.points[m].tolist() for m in joints)
    ]
    taken = [*dots, *((*t.min(axis=0).tolist(), *t.max(axis=0).tolist()) for t in triangles)]
    wanted = [(_name(mark), _places(mark, crossing, outline, lines)) for mark in joints]
    labels = placed_labels(wanted, _NUMBER, sheet, taken)
    names = _names(lines, sheet, [*taken, *(label_box(label) for label in labels)])
    open_ones = (circle(outline.points[mark], _DOT) for mark in joints if parse_mark(mark).family == "N")
    solid = (circle(outline.points[mark], 0.75 * _DOT) for mark in joints if parse_mark(mark).family != "N")
    items = [
        *_plank_items(shell, outline),
        group((path(triangle) for triangle in triangles), _INK),
        label_svg(labels, framed=False),
        group(open_ones, _OPEN),
        group(solid, _INK),
        names,
        group([text(say(language, "drawings.map.from_outside"), _MARGIN, sheet[3] - 20.0, _NUMBER, "start")], _INK),
    ]
    return svg(outline.width, sheet[3], items)
