"""A picture of the whole gridshell, as SVG and as PNG."""

import os

from aag_cad.files import write_bytes, write_text
from aag_cad.parts.model import Gridshell
from aag_cad.typesetting import png_of
from assembly.drawing.perspective import perspective_svg

BACKGROUND = "#fdfcf9"
PIXELS_WIDE = 1800


def write_overview(gridshell: Gridshell, svg_path: str | os.PathLike[str], png_path: str | os.PathLike[str]) -> None:
    """Write all planks and studs in perspective, on a light ground, as SVG and PNG; FileError if it cannot be."""
    svg = perspective_svg(gridshell, background=BACKGROUND)
    write_text(svg_path, svg)
    write_bytes(png_path, png_of(svg, PIXELS_WIDE))
