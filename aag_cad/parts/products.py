"""Which parts are the same product: equal in shape and make, whatever their marks and places."""

import hashlib

from aag_cad.geometry.framed import FramedCurve
from aag_cad.parts.marks import parse_mark, short_mark
from aag_cad.parts.model import (
    Blade,
    Bolt,
    ClampingBar,
    CouplingBlock,
    Footing,
    Frame,
    Mullion,
    Part,
    Plank,
    Rod,
    Screw,
    Shoe,
    Strap,
    Strip,
    Stud,
)

_OWN_TO_THE_PIECE = {"mark", "beam", "joints", "frame", "joint"}
_FRAMED = Stud | CouplingBlock | Bolt | Screw | Shoe | Rod | Footing | Blade


def part_frame(part: Part) -> Frame | None:
    """Return the frame that a product is placed by, or None if it is drawn in the coordinates of its shell."""
    return part.frame if isinstance(part, _FRAMED) else None


def _feed(value: object) -> str:
    if isinstance(value, FramedCurve):
        arrays = (value.stations.round(6), value.points.round(6), value.normals.round(9))
        return "".join(str((array + 0.0).tolist()) for array in arrays)
    if isinstance(value, tuple):
        return "(" + ",".join(_feed(item) for item in value) + ")"
    if hasattr(value, "__dataclass_fields__"):
        inner = (name for name in value.__dataclass_fields__ if name not in _OWN_TO_THE_PIECE)
        return type(value).__name__ + "".join(f";{name}={_feed(getattr(value, name))}" for name in inner)
    return f"{round(value, 6) + 0.0:.6f}" if isinstance(value, float) else repr(value)


def product_key(part: Part) -> str:
    """Return a key of 16 hexadecimal digits that equal products share, in any shell."""
    return hashlib.sha256(_feed(part).encode()).hexdigest()[:16]


def product_name(part: Part) -> str:
    """Return the name of a part's product as it stands in STEP and IFC, e.g. ``Hexagon stud 24 x 220``."""
    mark = parse_mark(part.mark)
    match part:
        case Plank():
            return f"Plank {short_mark(part.mark)}"
        case Stud():
            return f"Hexagon stud {part.across_flats:g} x {part.length:g}"
        case CouplingBlock():
            return f"Coupling block {part.length:g} x {part.width:g} x {part.thickness:g}"
        case Bolt():
            return f"Bolt M{part.diameter:g} x {part.length:g}"
        case Screw():
            return f"Screw {part.diameter:g} x {part.length:g}"
        case Strip():
            return f"Strip {mark.index:02d}"
        case Mullion():
            return f"Mullion {mark.index:02d}"
        case ClampingBar():
            return f"Clamping bar {mark.index:02d}"
        case Strap():
            section = part.blank.section
            return f"Strap {part.blank.length:.0f} x {section.width:g} x {section.thickness:g}"
        case Shoe():
            return f"Shoe {part.plate.width:g} x {part.plate.thickness:g}"
        case Rod():
            return f"Threaded rod M{part.diameter:g} x {part.length:g}"
        case Footing():
            return f"Concrete block {part.length:g} x {part.width:g} x {part.height:g}"
        case Blade():
            return f"Ridge blade {part.plate.width:g} x {part.plate.thickness:g}"
