"""Printouts by typst, the one file that knows it: templates with their data and pictures as PDF, pictures as PNG."""

import json
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import typst

from aag_cad.resources import template

_INCHES = 10.0
_PICTURE_ALONE = f'#set page(width: auto, height: auto, margin: 0pt)\n#image("picture.svg", width: {_INCHES:g}in)\n'


def printout_pdf(name: str, data: object, pictures: Mapping[str, str] = MappingProxyType({})) -> bytes:
    """Return the template ``printouts/name.typ`` filled as PDF; the same data and pictures give the same bytes.

    The template reads ``data`` from data.json and each SVG picture under its name. FileError if there is no such
    template.
    """
    main = template("printouts", f"{name}.typ")
    files = {path.name: path.read_bytes() for path in main.parent.glob("*.typ")}
    files |= {f"{title}.svg": picture.encode() for title, picture in pictures.items()}
    files |= {"main.typ": main.read_bytes(), "data.json": json.dumps(data, ensure_ascii=False).encode()}
    return _compiled(files, format="pdf")


def png_of(svg: str, pixels_wide: int) -> bytes:
    """Return an SVG picture as PNG, ``pixels_wide`` pixels wide."""
    files = {"main.typ": _PICTURE_ALONE.encode(), "picture.svg": svg.encode()}
    return _compiled(files, format="png", ppi=pixels_wide / _INCHES)


def _compiled(files: Any, **options: Any) -> bytes:
    # Files by name are what the library takes, though its type hints know of one file only.
    compiled: bytes = typst.compile(files, ignore_system_fonts=True, **options)
    return compiled
