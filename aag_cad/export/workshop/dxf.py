"""Flat drawings as DXF R2010 in millimetres: the one place that knows ezdxf. The same drawing gives the same bytes."""

import io
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import ezdxf
from ezdxf.enums import TextEntityAlignment

from aag_cad.errors import FileError
from aag_cad.export.workshop.blank_drawings import (
    DIMENSIONS,
    EXTENSION,
    LAYERS,
    SMALL,
    Circle,
    Dimension,
    Drawing,
    Item,
    Line,
    Obround,
    Polyline,
    Text,
    blank_drawing,
)
from aag_cad.files import write_bytes
from aag_cad.parts.index import index_of
from aag_cad.parts.model import Gridshell
from aag_cad.shop.groups import drilled_joints, templates_of

_ALIGN = {
    "left": TextEntityAlignment.MIDDLE_LEFT,
    "centre": TextEntityAlignment.MIDDLE_CENTER,
    "right": TextEntityAlignment.MIDDLE_RIGHT,
}
_MARGIN = 20.0
_STYLE = "AAG"
_STYLE_OPTIONS = {
    "dimtxt": SMALL,
    "dimtsz": SMALL * 0.3,
    "dimexo": 2.0,
    "dimexe": EXTENSION,
    # What stands in a block takes the colour of its layer only from readers that follow blocks.
    "dimclrd": LAYERS[DIMENSIONS],
    "dimclre": LAYERS[DIMENSIONS],
    # The text stays where it is put.
    "dimtmove": 2,
}


@contextmanager
def _without_clock() -> Iterator[None]:
    """Let ezdxf write fixed times and GUIDs, and put its option back afterwards."""
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before


def _add(space: "ezdxf.layouts.Modelspace", item: Item) -> None:
    layer = {"layer": item.layer}
    match item:
        case Line():
            space.add_line(item.start, item.end, dxfattribs=layer)
        case Polyline():
            space.add_lwpolyline(item.points, close=item.closed, dxfattribs=layer)
        case Circle():
            space.add_circle(item.centre, item.diameter / 2.0, dxfattribs=layer)
        case Obround():
            (x, y), half, radius = item.centre, item.slot / 2.0, item.diameter / 2.0
            # A bulge of 1 is a half circle, anticlockwise, to the next corner.
            corners = [
                (x - half, y - radius, 0.0),
                (x + half, y - radius, 1.0),
                (x + half, y + radius, 0.0),
                (x - half, y + radius, 1.0),
            ]
            space.add_lwpolyline(corners, format="xyb", close=True, dxfattribs=layer)
        case Text():
            text = space.add_text(item.content, height=item.height, rotation=item.rotation_deg, dxfattribs=layer)
            text.set_placement(item.at, align=_ALIGN[item.anchor])
        case Dimension():
            base = (item.start[0], item.line)
            told = {"text": item.content, "location": item.at, "dimstyle": _STYLE, "dxfattribs": layer}
            space.add_linear_dim(base, item.start, item.end, **told).render()


def dxf_bytes(drawing: Drawing) -> bytes:
    """Return a drawing as a DXF file; FileError if it does not stand up to the audit of ezdxf."""
    with _without_clock():
        document = ezdxf.new("R2010", units=ezdxf.units.MM)
        document.header["$MEASUREMENT"] = 1
        for name, colour in LAYERS.items():
            document.layers.add(name, color=colour)
        if any(isinstance(item, Dimension) for item in drawing.items):
            document.dimstyles.new(_STYLE, dxfattribs=_STYLE_OPTIONS)
        space = document.modelspace()
        for item in drawing.items:
            _add(space, item)
        left, low, right, high = drawing.extent
        space.reset_extents((left, low, 0.0), (right, high, 0.0))
        document.set_modelspace_vport(high - low + 2.0 * _MARGIN, center=((left + right) / 2.0, (low + high) / 2.0))
        errors = document.audit().errors
        if errors:
            raise FileError(f"{drawing.name}: the DXF drawing is not sound: {errors[0].message}; report this design")
        # The library would register the classes in use in the order of a set, which differs from run to run.
        for kind in sorted(document.entitydb.dxf_types_in_use()):
            document.classes.add_class(kind)
        stream = io.StringIO()
        document.write(stream)
    data: bytes = document.encode(stream.getvalue())
    return data


def write_blank_dxfs(gridshell: Gridshell, folder: str | os.PathLike[str]) -> None:
    """Write one DXF for each drilling group into a folder, named by its template, e.g. ``T-01.dxf``.

    FileError if a file cannot be written.
    """
    planks = index_of(gridshell).planks
    for group in templates_of(gridshell):
        drawing = blank_drawing(group, drilled_joints(group, planks), gridshell.title, gridshell.timber)
        write_bytes(Path(folder) / f"{group.mark}.dxf", dxf_bytes(drawing))
