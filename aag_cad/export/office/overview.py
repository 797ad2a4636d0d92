"""A picture of the whole gridshell, as SVG and as PNG."""

import os
import tempfile
from pathlib import Path

import typst

from aag_cad.files import write_bytes, write_text
from aag_cad.parts.model import Gridshell
from assembly.drawing.perspective import perspective_svg

BACKGROUND = "#fdfcf9"
PIXELS_WIDE = 1800
_PAGE = """#set page(width: auto, height: auto, margin: 0pt)
#image("picture.svg", width: 10in)
"""


def overview_svg(gridshell: Gridshell) -> str:
    """Return the picture as SVG: all planks and studs in perspective, on a light ground."""
    return perspective_svg(gridshell, background=BACKGROUND)


def png_of(svg: str, pixels_wide: int = PIXELS_WIDE) -> bytes:
    """Return an SVG as PNG, ``pixels_wide`` pixels wide."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "picture.svg").write_text(svg, encoding="utf-8")
        page = folder / "page.typ"
        page.write_text(_PAGE, encoding="utf-8")
        png: bytes = typst.compile(
            str(page), root=str(folder), ignore_system_fonts=True, format="png", ppi=pixels_wide / 10.0
        )
    return png


def write_overview(gridshell: Gridshell, svg_path: str | os.PathLike[str], png_path: str | os.PathLike[str]) -> None:
    """Write the picture as SVG and as PNG; FileError if a file cannot be written."""
    svg = overview_svg(gridshell)
    png = png_of(svg)
    write_text(svg_path, svg)
    write_bytes(png_path, png)
