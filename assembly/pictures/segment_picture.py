"""The picture of a segment: where it is in its shell, where it is slung, braced and spliced, and how it is loaded."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from aag_cad.language import Language, say, says
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import short_mark
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Gridshell, Plank, Shell
from aag_cad.units import Floats
from assembly.base.segments import Brace, PlankPiece, Segment, Segmentation, Splice, splices_of
from assembly.drawing.outline import Outline, clipped, shell_outline
from assembly.drawing.part_outlines import plank_rings
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
    places_along,
    places_round,
    rectangle,
    svg,
    text,
)
from assembly.pictures.step_pictures import NEW

WIDTH = 1800.0
_MARGIN = 60.0
_OTHERS = Style("#efefef", "#b9b9b9", 1.0)
_CUT = Style("none", "#000", 5.0, "22 12")
_HALO = Style("none", "#fff", 10.0)
_SIZE, _SMALL = 27.0, 23.0
_DOT, _BALL = 11.0, 15.0
_ROOM = Style("none", "#000", 3.0)
_BOX = Style("none", "#555", 1.5, "8 8")
_HULL = Style("none", "#333", 1.0)
_FOOTER = 90.0
_EVEN = tuple(i / 12.0 for i in range(13))
_BESIDE = 0.6
_SHARES = (0.96, 0.9, 0.04, 0.1, 0.84, 0.16, 0.7)


def _part_of(outline: Outline, plank: Plank, piece: PlankPiece | None) -> Floats:
    """Return the outline (n, 2) of a plank, or of a piece of it."""
    whole, length = outline.planks[plank.mark], plank.blank.length
    return clipped(whole, piece.start / length, piece.end / length) if piece else whole


def _held(shell: Shell, segment: Segment) -> Iterator[tuple[Plank, PlankPiece | None]]:
    """Yield the planks of a segment, whole ones without a piece."""
    planks, own = index_of(shell).planks, set(segment.parts)
    yield from ((plank, None) for plank in shell.planks if plank.mark in own)
    yield from ((planks[piece.plank], piece) for piece in segment.pieces)


def _timber(outline: Outline, shell: Shell, segment: Segment) -> Iterator[str]:
    """Yield the shell in pale grey and the segment over it, from the lowest layer to the highest."""
    yield group((path(points) for points in outline.planks.values()), _OTHERS)
    held = sorted(_held(shell, segment), key=lambda pair: (pair[0].layer, pair[0].mark))
    for plank, piece in held:
        yield group([path(_part_of(outline, plank, piece))], NEW[plank.family])


def _place(outline: Outline, shell: Shell, splice: Splice) -> Floats:
    """Return where a splice is on the sheet (2,)."""
    if splice.joint:
        return outline.points[splice.joint]
    plank = index_of(shell).planks[splice.member]
    share = splice.cuts[0].station / plank.blank.length
    return np.asarray(places_along(outline.lines[plank.mark], (share,))[0])


def _double(points: Floats) -> str:
    """Return a line drawn double, as a brace."""
    return line(points, Style("none", "#000", 12.0)) + line(points, Style("none", "#fff", 6.0))


def _brace_line(outline: Outline, brace: Brace, bare: Sequence[str]) -> Floats:
    """Return the line of a brace on the sheet (n, 2); a bar runs between its studs' chord and the line of the cut."""
    ends = np.array([outline.points[brace.start], outline.points[brace.end]])
    if brace.kind != "bar" or not bare:
        return ends
    cuts = [places_along(outline.lines[mark], _EVEN) for mark in dict.fromkeys(bare)]
    cut = min(cuts, key=lambda points: float(np.linalg.norm(points.mean(axis=0) - ends.mean(axis=0))))
    rising = float((cut[-1] - cut[0]) @ (ends[1] - ends[0])) > 0.0
    chord = places_along(ends, _EVEN)
    return np.asarray(_BESIDE * (cut if rising else cut[::-1]) + (1.0 - _BESIDE) * chord)[1:-1]


def _cross(centre: Floats) -> str:
    """Return the sign of a centre of gravity: a circle with two black quarters."""
    x, y = centre.tolist()
    r = 1.5 * _BALL
    turn = np.linspace(0.0, math.pi / 2.0, 9)
    arc = np.column_stack([np.cos(turn), np.sin(turn)]) * r
    quarters = [np.concatenate([[centre], centre + sign * arc]) for sign in (1.0, -1.0)]
    return group([circle((x, y), r)], Style("#fff", "#000", 3.0)) + group(map(path, quarters), Style("#000"))


def _seen(outline: Outline, shell: Shell, segment: Segment) -> Floats:
    """Return where the centre of gravity is on the sheet (2,): from joints of the shell, as the view is affine."""
    matrix = frame_matrix(shell.placement)
    local = (np.array(segment.centre) - matrix[:3, 3]) @ matrix[:3, :3]
    joints = [joint for joint in shell.joints if joint.mark in outline.points]
    space = np.column_stack([[joint.point for joint in joints], np.ones(len(joints))])
    sheet = np.array([outline.points[joint.mark] for joint in joints])
    return np.asarray(np.array([*local, 1.0]) @ np.linalg.lstsq(space, sheet, rcond=None)[0])


def _shell_items(outline: Outline, shell: Shell, plan: Segmentation, segment: Segment) -> Iterator[str]:
    """Yield the shell square on with all that is told about the segment."""
    carried, loose = splices_of(plan, segment)
    yield from _timber(outline, shell, segment)
    lines = dict.fromkeys(splice.line for splice in (*carried, *loose))
    for mark in lines:
        yield line(outline.lines[mark], _HALO) + line(outline.lines[mark], _CUT)
    for brace in segment.braces:
        yield _double(_brace_line(outline, brace, [splice.line for splice in loose]))
    yield group((circle(_place(outline, shell, splice), _DOT) for splice in loose), Style("#fff", "#000", 3.0))
    places = [_place(outline, shell, splice) for splice in carried]
    yield group((circle(place, _DOT) for place in places), Style("#000", "#fff", 2.0))
    held = dict.fromkeys(segment.lifting.studs, "H")
    for mark in segment.props:
        held[mark] = held.get(mark, "") + "P"
    studs = [outline.points[mark] for mark in held]
    yield group((circle(point, _BALL) for point in studs), Style("#000", "#fff", 3.0))
    propped = (outline.points[mark] for mark, name in held.items() if name == "P")
    yield group((circle(point, 0.5 * _BALL) for point in propped), Style("#fff"))
    centre = _seen(outline, shell, segment)
    yield _cross(centre)
    sheet: Box = (0.0, 0.0, outline.width, outline.height)
    taken: list[Box] = [
        (x - _BALL, y - _BALL, x + _BALL, y + _BALL) for x, y in [*map(tuple, [*places, *studs, centre])]
    ]
    tags = [(name, places_round(outline.points[mark], 1.5 * _SIZE)) for mark, name in held.items()]
    names = [(short_mark(mark), places_along(outline.lines[mark], _SHARES)) for mark in lines]
    framed = placed_labels([*tags, *names], _SIZE, sheet, taken)
    numbers = [(str(i), places_round(place, 1.2 * _SMALL)) for i, place in enumerate(places, start=1)]
    plain = placed_labels(numbers, _SMALL, sheet, [*taken, *(label_box(label) for label in framed)])
    yield label_svg(plain, framed=False) + label_svg(framed)


def _in_pose(shell: Shell, segment: Segment) -> list[Floats]:
    """Return the centre lines (n, 3) of the planks of a segment along the axes of its pose, from its lowest corner."""
    turn = frame_matrix(shell.placement)[:3, :3].T @ np.array(segment.pose.axes).T
    lines, corners = [], []
    for plank, piece in _held(shell, segment):
        rings = plank_rings(plank, 120.0) @ turn
        stations = np.linspace(0.0, plank.blank.length, len(rings))
        inside = rings if piece is None else rings[(stations >= piece.start) & (stations <= piece.end)]
        corners.append(inside.reshape(-1, 3))
        lines.append(inside.mean(axis=1))
    low = np.concatenate(corners).min(axis=0) if corners else np.zeros(3)
    return [points - low for points in lines if len(points) > 1]


def _loaded(
    lines: Sequence[Floats],
    axes: tuple[int, int],
    room: Sequence[float],
    size: Sequence[float],
    at: Floats,
    scale: float,
) -> Iterator[str]:
    """Yield a segment in its transport seen along an axis; ``at`` is the lower left corner of the room on the sheet."""
    wide, high = axes
    x, y = at.tolist()
    start = x + (room[wide] - size[wide]) / 2.0 * scale

    def seen(points: Floats) -> Floats:
        return np.column_stack([start + points[:, wide] * scale, y - points[:, high] * scale])

    yield group((path(seen(points), closed=False) for points in lines), _HULL)
    yield group([rectangle(start, y - size[high] * scale, size[wide] * scale, size[high] * scale)], _BOX)
    yield group([rectangle(x, y - room[high] * scale, room[wide] * scale, room[high] * scale)], _ROOM)
    middle, height = start + size[wide] * scale / 2.0, y - size[high] * scale / 2.0
    labels = (
        Label(f"{size[wide]:.0f}", middle, y + 24.0, _SMALL),
        Label(f"{size[high]:.0f}", x + room[wide] * scale + 50.0, height, _SMALL),
    )
    yield label_svg(labels, framed=False)


def _transport_items(
    shell: Shell, plan: Segmentation, segment: Segment, top: float, language: Language
) -> tuple[float, list[str]]:
    """Return the height and the shapes of the two views of a segment on its transport, from the side and the end."""
    size = segment.pose.size
    room = [limit if math.isfinite(limit) else own for limit, own in zip(plan.limits.room, size, strict=True)]
    reach = [max(a, b) for a, b in zip(room, size, strict=True)]
    scale = (WIDTH - 2.0 * _MARGIN - 320.0) / (reach[0] + reach[1])
    height = reach[2] * scale
    lines = _in_pose(shell, segment)
    base = top + 40.0 + height
    left = np.array([_MARGIN, base])
    right = np.array([_MARGIN + reach[0] * scale + 200.0, base])
    items = [*_loaded(lines, (0, 2), room, size, left, scale), *_loaded(lines, (1, 2), room, size, right, scale)]
    for name, place in (("side", left), ("end", right)):
        items.append(
            group(
                [text(say(language, f"segments.picture.{name}"), float(place[0]), base + 60.0, _SMALL, "start")],
                Style("#000"),
            )
        )
    return height + 40.0 + _FOOTER, items


def segment_svg(gridshell: Gridshell, segmentation: Segmentation, segment: Segment, language: Language = "en") -> str:
    """Return the picture of a segment, 180 mm wide: its shell square on, the segment dark over pale grey, and its load.

    H are the studs to sling it by, P those under its props, the quartered circle is its centre of gravity, double lines
    are braces, dashed ones cuts; black dots are splices along its geodesics, numbered as on its card, rings those of
    its other cut ends. Below: the segment in the room of the transport from the side and from the end, with the sizes
    of the box that it takes, mm.
    """
    shell = index_of(gridshell).shells[segment.shell]
    outline = shell_outline(shell, WIDTH, _MARGIN)
    legend = " \u00b7 ".join(says(language, "segments.picture.legend"))
    words = group([text(legend, _MARGIN, outline.height + 10.0, 0.8 * _SMALL, "start")], Style("#000"))
    height, below = _transport_items(shell, segmentation, segment, outline.height + 30.0, language)
    items = [*_shell_items(outline, shell, segmentation, segment), words, *below]
    return svg(WIDTH, outline.height + 30.0 + height, items)
