"""The drawing that explains the layers of a shell: one node pulled apart, and beside it how high each layer sits.

Made from the sizes of the shell itself; black and white.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull

from aag_cad.colours import LEGEND, mixed
from aag_cad.families import LAYERS
from aag_cad.geometry.framed import frames_at
from aag_cad.geometry.surface import unit
from aag_cad.language import Language, figure, say
from aag_cad.parts.index import index_of
from aag_cad.parts.model import Beam, CouplingBlock, Joint, Member, Shell, Stud
from aag_cad.units import Floats
from assembly.base.errors import PlanError
from assembly.base.names import LAYER_WORDS
from assembly.base.shell_axes import shell_view
from assembly.drawing.joint_sections import callout
from assembly.drawing.names import family_name
from assembly.drawing.svg import Style, group, line, path, rectangle, svg, text
from assembly.laying.flattening import beam_width

_UNITS = 1.45
_SECTION_UNITS = 1.9
_LONG = 460.0
_BEYOND = 110.0
_FARTHEST = 300.0
_WIDTH, _HEIGHT = 1800.0, 960.0
_LIFT = {-1: 0.0, 0: 95.0, 1: 265.0}
_AZIMUTH, _ELEVATION = np.radians(-76.0), np.radians(30.0)

# Each colour of the legend on top, and darker at the sides.
_SHADES = {name: (code, mixed(code, "#000000", 0.15)) for name, code in LEGEND.items()}
_EDGE = 2.2
_AXIS = Style("none", "#000", 2.0, "9 6")
_THIN = Style("none", "#000", 1.5)
_INK = Style("#000")
_WORDS, _FIGURES = 25.0, 23.0


@dataclass(frozen=True, eq=False)
class _Node:
    """A stud with its beams and the geodesic beside it, in a frame of the stud: y along the geodesic, z outwards.

    ``lower``, ``upper`` and ``along`` are directions (3,), ``beside`` the place (3,) where the geodesic crosses the
    lower beam, drawn nearer if that is far away; ``offset`` is how far the middles of the beams are from the surface.
    """

    stud: Stud
    turn: float
    lower: Floats
    upper: Floats
    along: Floats
    beside: Floats
    offset: float
    block: CouplingBlock


def _beside(stud: Stud, joint: Joint, shell: Shell) -> tuple[Beam, Beam, CouplingBlock, Member, float] | None:
    """Return lower and upper beam of a stud, the next block on the lower one with its geodesic, and how far.

    The block is the next one to the right of the stud for who looks along the geodesic from outside.
    """
    beams = sorted((beam for beam in shell.beams if set(beam.planks) & set(joint.members)), key=lambda beam: beam.layer)
    if len(beams) != 2:
        return None
    index, lower = index_of(shell), beams[0]
    here, there = index.stations[lower.mark, stud.mark], (p for p in lower.joints if p.joint in index.blocks)
    normal, ahead = np.array(stud.frame.z), _tangent(lower, here)
    for _, mark, at in sorted((abs(p.station - here), p.joint, p.station) for p in there):
        crossing = [index.geodesics[member] for member in index.joints[mark].members if member in index.geodesics]
        if crossing:
            along = _tangent(crossing[0], index.stations[crossing[0].mark, mark])
            if (at - here) * float(np.cross(along, normal) @ ahead) > 0.0:
                return lower, beams[1], index.blocks[mark], crossing[0], at - here
    return None


def _tangent(member: Member, station: float) -> Floats:
    return np.asarray(frames_at(member.curve, np.array([station])).tangent[0])


def _middle_node(shell: Shell) -> _Node:
    """Return the node nearest to the middle of a shell that has a geodesic beside it; PlanError without one."""
    joints, stations = index_of(shell).joints, index_of(shell).stations
    studs = sorted(shell.studs, key=lambda stud: stud.mark)
    flat = shell_view(shell)(np.array([stud.frame.origin for stud in studs]).reshape(-1, 3))[:, :2]
    away = np.linalg.norm(flat - flat.mean(axis=0), axis=1).round(3) if len(studs) else flat
    for i in np.argsort(away, kind="stable").tolist():
        stud = studs[i]
        found = _beside(stud, joints[stud.mark], shell)
        if found is None:
            continue
        lower, upper, block, geodesic, distance = found
        normal = np.array(stud.frame.z)
        ahead = _tangent(geodesic, stations[geodesic.mark, block.mark])
        y = unit(ahead - (ahead @ normal) * normal)
        axes = np.array([np.cross(y, normal), y, normal])
        first = unit((axes @ _tangent(lower, stations[lower.mark, stud.mark])) * [1.0, 1.0, 0.0])
        second = unit((axes @ _tangent(upper, stations[upper.mark, stud.mark])) * [1.0, 1.0, 0.0])
        x = axes @ np.array(stud.frame.x)
        return _Node(
            stud,
            float(np.arctan2(x[1], x[0])),
            first,
            second,
            np.array([0.0, 1.0, 0.0]),
            float(np.clip(distance, -_FARTHEST, _FARTHEST)) * first,
            float(np.mean([abs(hole.height) for hole in stud.holes])),
            block,
        )
    raise PlanError(f"{shell.mark}: no stud with a geodesic beside it; the layers cannot be shown at one")


def _view() -> Floats:
    """Return the axes of the paper in space: right, up, towards the viewer; (3, 3) with one axis a row."""
    c, s, high, level = np.cos(_AZIMUTH), np.sin(_AZIMUTH), np.sin(_ELEVATION), np.cos(_ELEVATION)
    return np.array([(-s, c, 0.0), (-c * high, -s * high, level), (c * level, s * level, high)])


def _board(middle: Floats, along: Floats, size: tuple[float, float, float]) -> Floats:
    """Return the corners (8, 3) of a box: its length along a level direction, its width across it, its height up."""
    across = np.array([-along[1], along[0], 0.0])
    signs = np.array([(a, b, c) for a in (-0.5, 0.5) for b in (-0.5, 0.5) for c in (-0.5, 0.5)])
    frame = np.array([along, across, (0.0, 0.0, 1.0)])
    return np.asarray(middle + (signs * np.array(size)) @ frame)


def _solid(corners: Floats, shades: tuple[str, str], axes: Floats, centre: Floats) -> Iterator[str]:
    """Yield the faces of a convex solid (n, 3) that are seen, darker at its sides than on top."""
    hull = ConvexHull(corners)
    faces: dict[tuple[float, ...], set[int]] = {}
    for triangle, plane in zip(hull.simplices, hull.equations, strict=True):
        faces.setdefault(tuple((np.round(plane[:3], 6) + 0.0).tolist()), set()).update(triangle.tolist())
    for normal, members in sorted(faces.items()):
        if float(np.array(normal) @ axes[2]) <= 1e-6:
            continue
        seen = (corners[sorted(members)] @ axes.T)[:, :2]
        middle = seen.mean(axis=0)
        turn = np.argsort(np.arctan2(seen[:, 1] - middle[1], seen[:, 0] - middle[0]))
        on_sheet = centre + _UNITS * seen[turn] * [1.0, -1.0]
        yield group([path(on_sheet)], Style(shades[0] if normal[2] > 0.5 else shades[1], "#000", _EDGE))


def _hexagon(node: _Node) -> Floats:
    angles = node.turn + np.radians(30.0 + 60.0 * np.arange(6))
    ring = node.stud.across_flats / np.sqrt(3.0) * np.column_stack([np.cos(angles), np.sin(angles)])
    half = node.stud.length / 2.0
    return np.concatenate([np.column_stack([ring, np.full(6, height)]) for height in (-half, half)])


def _beam(node: _Node, layer: int, shell: Shell) -> list[tuple[Floats, tuple[str, str]]]:
    """Return the two planks of a beam, the far one first, with their shades."""
    section = next(plank for plank in shell.planks if plank.upright).blank.section
    along = node.lower if layer < 0 else node.upper
    across = np.array([-along[1], along[0], 0.0])
    across *= np.copysign(1.0, across @ _view()[2])
    half = (beam_width(shell) - section.thickness) / 2.0
    height = np.array([0.0, 0.0, layer * node.offset + _LIFT[layer]])
    # The lower beam reaches past the block on one side.
    far = float(node.beside @ along) if layer < 0 else 0.0
    long = _LONG / 2.0 + max(abs(far) + _BEYOND, _LONG / 2.0) if layer < 0 else _LONG
    height = height + np.copysign((long - _LONG) / 2.0, far) * along
    size = (long, section.thickness, section.width)
    return [(_board(height + side * half * across, along, size), _SHADES[LAYERS[layer]]) for side in (-1.0, 1.0)]


def _apart(node: _Node, shell: Shell, centre: Floats, language: Language) -> Iterator[str]:
    """Yield the node pulled apart, from the lowest layer to the highest, with the words beside it."""
    axes = _view()

    def sheet(point: Floats) -> Floats:
        return np.asarray(centre + _UNITS * (axes[:2] @ point) * [1.0, -1.0])

    def told(layer: int) -> str:
        name = family_name(LAYERS[layer], language)
        return say(language, f"drawings.layers.{LAYER_WORDS[layer]}", name=name)

    flat = next(iter(index_of(shell).geodesics.values())).blank.section
    lower, upper = _beam(node, -1, shell), _beam(node, 1, shell)
    block = _board(
        node.beside - [0.0, 0.0, node.offset], node.lower, (node.block.length, node.block.thickness, node.block.width)
    )
    inner = [(block, _SHADES["block"]), (_hexagon(node), _SHADES["stud"])]
    inner.sort(key=lambda item: float((item[0] @ axes[2]).mean()))
    for corners, shades in (lower[0], *inner, lower[1]):
        yield from _solid(corners, shades, axes, centre)
    top = np.array([0.0, 0.0, node.stud.length / 2.0])
    held = node.beside + np.array([0.0, 0.0, _LIFT[0]])
    hung = np.array([0.0, 0.0, _LIFT[1] + node.offset])
    yield line(np.array([sheet(node.beside), sheet(held)]), _AXIS)
    lying = _board(held, node.along, (_LONG, flat.width, flat.thickness))
    yield from _solid(lying, _SHADES[LAYERS[0]], axes, centre)
    yield from _solid(*upper[0], axes, centre)
    yield line(np.array([sheet(top), sheet(hung)]), _AXIS)
    yield from _solid(*upper[1], axes, centre)
    section = next(plank for plank in shell.planks if plank.upright).blank.section
    end = np.array([0.0, 0.0, -section.width / 2.0]) + 0.4 * _LONG * _rightwards(node.lower)
    shown, block_word = node.block.width / 2.0 - node.offset, say(language, "drawings.layers.block")
    words = (
        (told(1), sheet(upper[1][0].mean(axis=0) + 0.3 * _LONG * _rightwards(node.upper))),
        (told(0), sheet(held + 0.35 * _LONG * _rightwards(node.along))),
        (block_word, sheet(node.beside + 0.42 * node.block.length * _rightwards(node.lower) + [0.0, 0.0, shown])),
        (told(-1), sheet(lower[1][0].mean(axis=0) + end - [0.0, 0.0, -section.width / 2.0])),
    )
    x, y = float(centre[0]) + _UNITS * (0.5 * _LONG + 90.0), -np.inf
    for word, place in sorted(words, key=lambda item: float(item[1][1])):
        y = max(float(place[1]), y + 1.7 * _WORDS)
        yield from callout(x, y, float(place[0]), float(place[1]), word, _WORDS)
    place = sheet(0.7 * top)
    words_left = say(language, "drawings.layers.stud", length=f"{node.stud.length:g}")
    yield line(np.array([place, place - [52.0, 74.0]]), _THIN)
    yield group([text(words_left, float(place[0]) - 58.0, float(place[1]) - 78.0, _WORDS, "end")], _INK)


def _together(node: _Node, shell: Shell, centre: Floats, language: Language) -> Iterator[str]:
    """Yield the section through the node with its layers put together, and the heights of their faces."""
    k, (x, y) = _SECTION_UNITS, centre.tolist()
    section = next(plank for plank in shell.planks if plank.upright).blank.section
    flat = next(iter(index_of(shell).geodesics.values())).blank.section
    wide, thick, gap = section.width, section.thickness, beam_width(shell) - 2.0 * section.thickness

    def box(left: float, low: float, width: float, height: float, fill: str) -> str:
        return group(
            [rectangle(x + k * left, y - k * (low + height), k * width, k * height)], Style(fill, "#000", _EDGE)
        )

    half = node.stud.length / 2.0
    yield box(-node.stud.across_flats / 2.0, -half, node.stud.across_flats, 2.0 * half, _SHADES["stud"][0])
    for layer in (-1, 1):
        for left in (-gap / 2.0 - thick, gap / 2.0):
            yield box(left, layer * node.offset - wide / 2.0, thick, wide, _SHADES[LAYERS[layer]][0])
    aside = gap / 2.0 + thick + 14.0
    yield box(aside, -flat.thickness / 2.0, flat.width, flat.thickness, _SHADES[LAYERS[0]][0])
    beside, above = x + k * (aside + flat.width / 2.0), y - k * flat.thickness / 2.0 - 24.0
    places = {layer: (x - k * (aside + 8.0), y - k * layer * node.offset) for layer in (1, -1)} | {0: (beside, above)}
    yield group((text(LAYERS[layer], *at, 1.2 * _WORDS, bold=True) for layer, at in places.items()), _INK)
    faces = [half, *(layer * node.offset + side * wide / 2.0 for layer in (1, -1) for side in (1, -1)), -half]
    yield from _heights(faces, x - k * (aside + 36.0), x - k * 4.0, centre, "end", language)
    right = x + k * (aside + flat.width)
    yield from _heights(
        [flat.thickness / 2.0, -flat.thickness / 2.0], right + 40.0, right + 6.0, centre, "start", language
    )
    for word, height in (("outside", half), ("inside", -half)):
        up = -1.0 if height > 0.0 else 1.0
        yield group([text(say(language, f"drawings.layers.{word}"), x, y - k * height + up * 34.0, _WORDS)], _INK)
    yield group([text(say(language, "drawings.layers.heights"), x, y + k * half + 78.0, _FIGURES)], _INK)


def _heights(
    heights: list[float], x: float, to_x: float, centre: Floats, anchor: str, language: Language
) -> Iterator[str]:
    """Yield heights above the surface as figures one above the other, with lines to what they measure."""
    places: list[float] = []
    for height in heights:
        y = float(centre[1]) - _SECTION_UNITS * height
        places.append(y if not places else max(y, places[-1] + 1.15 * _FIGURES))
    shift = sum(float(centre[1]) - _SECTION_UNITS * h - y for h, y in zip(heights, places, strict=True)) / len(heights)
    for height, place in zip(heights, places, strict=True):
        y, at = place + shift, float(centre[1]) - _SECTION_UNITS * height
        knee = x + 0.35 * (to_x - x)
        yield line(np.array([(x, y), (knee, at), (to_x, at)]), Style("none", "#000", 1.0))
        words = figure(f"{height:+.1f}".removesuffix(".0"), language)
        yield group([text(words, x + (-8.0 if anchor == "end" else 8.0), y, _FIGURES, anchor)], _INK)


def _rightwards(way: Floats) -> Floats:
    """Return a direction or its opposite, whichever leads to the right of the paper."""
    return np.asarray(way * np.copysign(1.0, _view()[0] @ way))


def layer_legend_svg(shell: Shell, language: Language = "en") -> str:
    """Return the layers at a node of a shell, pulled apart and put together with heights in mm from the surface.

    PlanError without a stud that has a geodesic beside it.
    """
    node = _middle_node(shell)
    items = [
        *_apart(node, shell, np.array([375.0, 590.0]), language),
        *_together(node, shell, np.array([1450.0, 400.0]), language),
    ]
    heads = (("lifted", 375.0), ("together", 1450.0))
    items += [
        group([text(say(language, f"drawings.layers.{word}"), x, 24.0, _WORDS, bold=True)], _INK) for word, x in heads
    ]
    return svg(_WIDTH, _HEIGHT, items)
