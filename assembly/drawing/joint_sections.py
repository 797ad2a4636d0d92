"""Sections through the two kinds of joint: two beams on a stud, and a geodesic on a coupling block."""

from collections.abc import Iterator

import numpy as np

from aag_cad.colours import LEGEND
from aag_cad.families import BEAMS, FAMILIES, LAYERS
from aag_cad.language import Language, figure, say
from aag_cad.parts.forms import CrossSection
from aag_cad.parts.index import index_of
from aag_cad.parts.model import Bolt, Shell
from assembly.drawing.names import family_name
from assembly.drawing.svg import Style, circle, group, line, polygon, rectangle, svg, text

_INK = Style("#000")
_THIN, _HALO = Style("none", "#000", 1.5), Style("none", "#fff", 4.0)

_UNIT = 2.0
_AXIS = 200.0
_WORDS = 24.0


def callout(x: float, y: float, to_x: float, to_y: float, words: str, size: float = _WORDS) -> Iterator[str]:
    """Yield a line from a place on a part to words at its right."""
    for style in (_HALO, _THIN):
        yield line(np.array([(to_x, to_y), (x, y)]), style)
    yield group([circle((to_x, to_y), 3.0), text(words, x + 8.0, y, size, "start")], _INK)


def _word(language: Language, key: str, **sizes: float) -> str:
    return say(language, f"pictures.sections.{key}", **{k: figure(f"{v:g}", language) for k, v in sizes.items()})


def _cut(name: str) -> Style:
    """Return how a part is drawn that is cut, by its name in the legend."""
    return Style(LEGEND[name], "#000", 2.0)


def _beam(middle: float, section: CrossSection, gap: float, family: str) -> str:
    """Return the two planks of a beam in section; ``middle`` is the height of their centres on the sheet."""
    wide, thick = _UNIT * section.width, _UNIT * section.thickness
    left, right = _AXIS - _UNIT * gap / 2.0 - thick, _AXIS + _UNIT * gap / 2.0
    return group((rectangle(x, middle - wide / 2.0, thick, wide) for x in (left, right)), _cut(family))


def _bolt(y: float, bolt: Bolt) -> str:
    """Return a bolt across a beam: shank, washers, head and nut."""
    half, washer = _UNIT * bolt.grip / 2.0, _UNIT * bolt.washer_thickness

    def piece(start: float, length: float, across: float) -> str:
        return rectangle(_AXIS + start, y - _UNIT * across / 2.0, length, _UNIT * across)

    head, nut = _UNIT * bolt.head_height, _UNIT * bolt.nut_height
    pieces = (
        piece(-half - washer - head, head, bolt.across_flats),
        piece(-half - washer, washer, bolt.washer_diameter),
        piece(-half, 2.0 * half, bolt.diameter),
        piece(half, washer, bolt.washer_diameter),
        piece(half + washer, nut, bolt.across_flats),
    )
    return group(pieces, Style("#000", "#fff", 1.0))


def node_section_svg(shell: Shell, *, language: Language = "en") -> str:
    """Return the section through a crossing of two beams, drawn as if both ran the same way, at 1 : 5."""
    stud, plank = shell.studs[0], next(plank for plank in shell.planks if plank.upright)
    bolt = index_of(shell).bolts[index_of(shell).joints[stud.mark].fasteners[0]]
    section = plank.blank.section
    centre, long, flat = _UNIT * stud.length / 2.0 + 20.0, _UNIT * stud.length, _UNIT * stud.across_flats
    items = [group([rectangle(_AXIS - flat / 2.0, centre - long / 2.0, flat, long)], _cut("stud"))]
    lift = _UNIT * (section.width + section.thickness) / 2.0
    items += [_beam(centre - FAMILIES[beam].layer * lift, section, stud.across_flats, beam) for beam in BEAMS]
    items += [_bolt(centre - _UNIT * hole.height, bolt) for hole in stud.holes]
    right, plank_x = _AXIS + 130.0, _AXIS + flat / 2.0 + _UNIT * section.thickness / 2.0
    items += callout(right, centre - lift, plank_x, centre - lift, family_name(LAYERS[1], language))
    items += callout(right, centre, _AXIS, centre, _word(language, "stud", length=stud.length))
    items += callout(right, centre + lift, plank_x, centre + lift, family_name(LAYERS[-1], language))
    return svg(720.0, 2.0 * centre, items)


def block_section_svg(shell: Shell, *, language: Language = "en") -> str:
    """Return the section through a geodesic on a lower beam, at 1 : 5: coupling block, its bolt and the screw."""
    block, screw = shell.blocks[0], shell.screws[0]
    bolts = index_of(shell).bolts
    fasteners = next(joint.fasteners for joint in shell.joints if block.mark in joint.members)
    section = next(plank for plank in shell.planks if plank.upright).blank.section
    top, thick, wide, gap = 80.0, _UNIT * section.thickness, _UNIT * section.width, _UNIT * block.thickness
    low = top + thick
    items = [group([rectangle(_AXIS - gap / 2.0, low, gap, wide)], _cut("block"))]
    items.append(_beam(low + wide / 2.0, section, block.thickness, LAYERS[-1]))
    items.append(group([rectangle(_AXIS - 180.0, top, 360.0, thick)], _cut(LAYERS[0])))
    away = low + wide / 2.0 + _UNIT * max((abs(hole.offset) for hole in block.holes), default=0.0)
    items += [_bolt(away, bolts[mark]) for mark in fasteners if mark in bolts]
    head, shank, tip = _UNIT * screw.head_diameter / 2.0, _UNIT * screw.diameter / 2.0, _UNIT * screw.length
    half = np.array([(head, 0.0), (shank, head - shank), (shank, tip - 2.0 * shank), (0.0, tip)])
    outline = np.array([_AXIS, top]) + np.concatenate([half, half[::-1] * [-1.0, 1.0]])
    items.append(polygon(outline, _INK))
    right, plank_x = _AXIS + 210.0, _AXIS + gap / 2.0 + thick / 2.0
    driven = _word(language, "screw", diameter=screw.diameter, length=screw.length)
    items += callout(right, top - 45.0, _AXIS, top, driven)
    slides = say(language, "pictures.sections.slides", name=family_name(LAYERS[0], language))
    items += callout(right, top + thick / 2.0, _AXIS + 150.0, top + thick / 2.0, slides)
    items += callout(right, low + 0.4 * wide, _AXIS + gap / 3.0, low + 0.4 * wide, _word(language, "block"))
    items += callout(right, low + 0.9 * wide, plank_x, low + 0.9 * wide, family_name(LAYERS[-1], language))
    return svg(870.0, low + wide + 20.0, items)
