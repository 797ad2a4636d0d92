"""Which parts are the same product: equal in shape and make, whatever their marks and places."""

import hashlib
from dataclasses import fields, is_dataclass

from aag_cad.geometry.framed import FramedCurve
from aag_cad.parts.forms import Frame
from aag_cad.parts.kinds import kind_of
from aag_cad.parts.marks import number_of, short_mark
from aag_cad.parts.model import Part
from aag_cad.parts.quantities import sizes

_OWN_TO_THE_PIECE = {"mark", "beam", "joints", "frame", "joint"}


def part_frame(part: Part) -> Frame | None:
    """Return the frame that a product is placed by, or None if it is drawn in the coordinates of its shell."""
    frame: Frame | None = getattr(part, "frame", None)
    return frame


def _feed(value: object) -> str:
    if isinstance(value, FramedCurve):
        arrays = (value.stations.round(6), value.points.round(6), value.normals.round(9))
        return "".join(str((array + 0.0).tolist()) for array in arrays)
    if isinstance(value, tuple):
        return "(" + ",".join(_feed(item) for item in value) + ")"
    if is_dataclass(value):
        inner = (field.name for field in fields(value) if field.name not in _OWN_TO_THE_PIECE)
        return type(value).__name__ + "".join(f";{name}={_feed(getattr(value, name))}" for name in inner)
    return f"{round(value, 6) + 0.0:.6f}" if isinstance(value, float) else repr(value)


def product_key(part: Part) -> str:
    """Return a key of 16 hexadecimal digits that equal products share, in any shell."""
    return hashlib.sha256(_feed(part).encode()).hexdigest()[:16]


def product_name(part: Part) -> str:
    """Return the name of a part's product as it stands in STEP and IFC, e.g. ``Hexagon stud 24 x 220``."""
    length, width, thickness = sizes(part)
    return kind_of(part).product.format(
        length=length, width=width, thickness=thickness, short=short_mark(part.mark), number=number_of(part.mark)
    )
