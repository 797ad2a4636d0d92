"""A picture of the whole gridshell, as SVG and as PNG."""

import os

from aag_cad.files import write_bytes, write_text
from aag_cad.parts.model import Gridshell
from aag_cad.typesetting import png_of
from assembly.drawing.perspective import perspective_svg

BACKGROUND = "#fdfcf9"
PIXELS_WIDE = 1800


def overview_svg(gridshell: Gridshell) -> str:
    """Return the picture as SVG: all planks and studs in perspective, on a light ground."""
    return perspective_svg(gridshell, background=BACKGROUND)


def write_overview(gridshell: Gridshell, svg_path: str | os.PathLike[str], png_path: str | os.PathLike[str]) -> None:
    """Write the picture as SVG and as PNG; FileError if a file cannot be written."""
    svg = overview_svg(gridshell)
    png = png_of(svg, PIXELS_WIDE)
    write_text(svg_path, svg)
    write_bytes(png_path, png)
