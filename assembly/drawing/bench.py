"""Drawings for the bench: coupled beams as straight strips with the places of all their blocks and studs."""

from collections.abc import Iterator, Sequence

import numpy as np

from aag_cad.colours import LEGEND
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import number_of, parse_mark, short_mark
from aag_cad.parts.model import Beam, CouplingBlock, FlatBar, Shell
from assembly.drawing.svg import Style, circle, group, label_svg, placed_labels, rectangle, svg, text

_BLOCK = Style("#000")
_OPEN = Style("#fff", "#000", 2.0)
_INK = Style("#000")

_STRIP = 165.0
_LEFT = 150.0
_RIGHT = 60.0
_PLANK_HEIGHT = 13.0
_GAP_HEIGHT = 30.0
_NUMBER = 20.0


def _strip(
    beam: Beam, planks: Sequence[FlatBar], blocks: dict[str, CouplingBlock], y: float, scale: float
) -> Iterator[str]:
    """Yield one beam seen from outside, its left plank above; ``y`` is the middle of its gap."""
    half = _GAP_HEIGHT / 2.0
    tops = (y - half - _PLANK_HEIGHT, y + half)
    yield group(
        (rectangle(_LEFT, top, p.blank.length * scale, _PLANK_HEIGHT) for p, top in zip(planks, tops, strict=True)),
        Style(LEGEND[beam.family], "#000", 1.5),
    )
    places = [(place.joint, _LEFT + place.station * scale) for place in beam.joints]
    made = [(mark, x, blocks[mark].length * scale) for mark, x in places if mark in blocks]
    yield group((rectangle(x - long / 2.0, y - half, long, _GAP_HEIGHT) for _, x, long in made), _BLOCK)
    studs = [(mark, x) for mark, x in places if parse_mark(mark).family == "N"]
    yield group((circle((x, y), 7.0) for _, x in studs), _OPEN)
    end = _LEFT + beam.curve.length * scale
    for listed, height, away in (([(m, x) for m, x, _ in made], tops[0] - 16.0, -19.0), (studs, tops[1] + 29.0, 19.0)):
        wanted = [(number_of(mark), np.array([(x, height), (x, height + away)])) for mark, x in listed]
        yield label_svg(placed_labels(wanted, _NUMBER, (0.0, 0.0, end + 200.0, 1e6)), framed=False)
    triangle = f'<path d="M{_LEFT - 6:g} {y:g}l-26 -12v24Z"/>'
    sides = (text(side, _LEFT - 48.0, top + _PLANK_HEIGHT / 2.0, 22.0) for side, top in zip("LR", tops, strict=True))
    rows = (text(name, _LEFT - 20.0, h, 20.0, bold=True) for name, h in (("K", tops[0] - 16.0), ("N", tops[1] + 29.0)))
    name = text(short_mark(beam.mark), 0.0, y, 27.0, "start", bold=True)
    yield group([triangle, *sides, *rows, name], _INK)


def beam_strips_svg(shell: Shell, beams: Sequence[str], width: float) -> str:
    """Return beams as straight strips, one below the other: blocks solid with K numbers, places of studs open with N.

    Lengths are to one scale for the shell; the gap and the planks' thickness are drawn wider than they are.
    """
    scale = (width - _LEFT - _RIGHT) / max(beam.curve.length for beam in shell.beams)
    planks, blocks = index_of(shell).planks, index_of(shell).blocks
    by_mark = index_of(shell).beams
    items: list[str] = []
    for i, mark in enumerate(beams):
        beam = by_mark[mark]
        items += _strip(beam, [planks[side] for side in beam.planks], blocks, (i + 0.5) * _STRIP, scale)
    return svg(width, len(beams) * _STRIP, items)
