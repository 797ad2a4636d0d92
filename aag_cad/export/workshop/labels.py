"""Adhesive labels as PDF, one for every plank and every coupled beam, by the template ``printouts/labels.typ``.

Two by seven on A4, each 99.1 x 38.1 mm, a common sheet. The picture of a blank shows the face that the label goes on.
"""

import os
from typing import Any

import numpy as np

from aag_cad.files import write_bytes
from aag_cad.parts.index import Index, index_of
from aag_cad.parts.marks import shell_of
from aag_cad.parts.model import Beam, Gridshell, Plank, Shell
from aag_cad.shop.groups import drawn_face, templates_of
from aag_cad.typesetting import printout_pdf
from aag_cad.units import Floats
from assembly.booklet.qr import qr_svg
from assembly.drawing.outline import Outline, shell_outline
from assembly.drawing.svg import UNITS_PER_MM, Style, group, polylines, svg

KEY_WIDTH, KEY_HEIGHT = 30.0, 21.0
_KEY_MARGIN = 0.8
_KEY_POINTS = 5
_PALE = Style("none", "#a6a6a6", 1.2)
_LAYERS = {-1: "inner", 0: "middle", 1: "outer"}


def qr_content(gridshell: Gridshell, mark: str) -> str:
    """Return what the QR code of a label says: the project's name and the mark."""
    return f"{gridshell.name} {mark}"


def _few(line: Floats) -> Floats:
    """Return a line by a few of its points, to 0.01 mm: enough for a picture of 30 mm."""
    chosen = np.linspace(0, len(line) - 1, min(len(line), _KEY_POINTS)).round().astype(int)
    return np.asarray(line[chosen].round(2))


def _key_outline(shell: Shell) -> Outline:
    """Return a shell seen from outside, small enough for the corner of a label."""
    outline = shell_outline(shell, KEY_WIDTH, _KEY_MARGIN)
    if outline.height <= KEY_HEIGHT:
        return outline
    return shell_outline(shell, KEY_WIDTH * KEY_HEIGHT / outline.height, _KEY_MARGIN)


def _key(shell: Shell, outline: Outline) -> dict[str, Any]:
    """Return the small drawing of a shell, seen from outside, as SVG: the lines of its beams and flat planks; mm."""
    marks = [beam.mark for beam in shell.beams] + [plank.mark for plank in shell.planks if not plank.beam]
    lines = polylines(UNITS_PER_MM * _few(outline.lines[mark]) for mark in sorted(marks))
    width, height = outline.width, outline.height
    return {
        "width": width,
        "height": height,
        "svg": svg(UNITS_PER_MM * width, UNITS_PER_MM * height, [group([lines], _PALE)]),
    }


def _of_plank(plank: Plank, template: str) -> dict[str, Any]:
    """Return what the label of a plank tells; its dots at fractions of length and width are holes, bolts filled."""
    blank, section = plank.blank, plank.blank.section
    return {
        "picture": [
            (hole.station / blank.length, 0.5 - hole.offset / section.width, hole.use == "bolt") for hole in blank.holes
        ],
        "facts": [
            f"{blank.length:.1f} x {section.width:g} x {section.thickness:g} mm",
            f"{plank.family} · {_LAYERS[plank.layer]} layer",
            template,
        ],
        "note": f"stick at START on {drawn_face(plank)}",
    }


def _of_beam(beam: Beam, index: Index) -> dict[str, Any]:
    """Return what the label of a coupled beam tells; its dots are its joints, those on studs filled."""
    left, right = (index.planks[mark].blank.length for mark in beam.planks)
    return {
        "picture": [(at.station / beam.curve.length, 0.5, at.joint in index.studs) for at in beam.joints],
        "facts": [
            f"coupled beam, {len(beam.joints)} joints",
            f"L {left:.1f} · R {right:.1f} mm",
            f"{beam.family} · {_LAYERS[beam.layer]} layer",
        ],
        "note": "stick at START, outer edge of plank L; dots: studs, rings: blocks",
    }


def labels_data(gridshell: Gridshell) -> dict[str, Any]:
    """Return the data that the labels are made from: first all planks, then all beams, each sorted by mark."""
    index, outlines = index_of(gridshell), {shell.mark: _key_outline(shell) for shell in gridshell.shells}
    templates = {
        m.mark: f"template {group.mark} · {m.laid}" for group in templates_of(gridshell) for m in group.members
    }
    told = {mark: _of_plank(plank, templates[mark]) for mark, plank in sorted(index.planks.items())}
    told |= {mark: _of_beam(beam, index) for mark, beam in sorted(index.beams.items())}
    labels = [
        label
        | {
            "mark": mark,
            "shell": shell_of(mark),
            "line": _few(outlines[shell_of(mark)].lines[mark]).tolist(),
            "qr": qr_svg(qr_content(gridshell, mark)),
        }
        for mark, label in told.items()
    ]
    keys = {shell.mark: _key(shell, outlines[shell.mark]) for shell in gridshell.shells}
    return {"title": gridshell.title, "keys": keys, "labels": labels}


def labels_pdf(gridshell: Gridshell) -> bytes:
    """Return the labels as PDF; the same gridshell gives the same bytes."""
    return printout_pdf("labels", labels_data(gridshell))


def write_labels(gridshell: Gridshell, path: str | os.PathLike[str]) -> None:
    """Write the labels of all planks and beams as an A4 PDF file; FileError if it cannot be written."""
    write_bytes(path, labels_pdf(gridshell))
