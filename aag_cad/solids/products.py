"""The solid of every product, each built once, by its shape."""

from collections.abc import Callable
from typing import Any

from OCP.TopoDS import TopoDS_Solid

from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import shaped
from aag_cad.parts.model import Gridshell, Part
from aag_cad.parts.shapes.shape import ShapeName
from aag_cad.solids.hardware import box_solid, folded_plate_solid, prism_solid, threaded_solid
from aag_cad.solids.planks import formed_plank
from aag_cad.solids.strips import strip_solid

# Of a form and its part's mark; SolidError names the mark.
_SOLIDS: dict[ShapeName, Callable[[Any, str], TopoDS_Solid]] = {
    "bar": lambda bar, _: formed_plank(bar),
    "prism": prism_solid,
    "box": box_solid,
    "threaded": threaded_solid,
    "folded plate": folded_plate_solid,
    "sheet": lambda strip, _: strip_solid(strip),
}


def product_solid(part: Part) -> TopoDS_Solid:
    """Return a part's solid in product coordinates: those of its frame, or of its shell where it has none.

    SolidError names the mark if the solid comes out invalid.
    """
    shape, form = shaped(part)
    return _SOLIDS[shape.name](form, part.mark)


def product_solids(gridshell: Gridshell) -> dict[str, TopoDS_Solid]:
    """Return the solids of all products by their key, in the order in which the parts first need them."""
    solids: dict[str, TopoDS_Solid] = {}
    index = index_of(gridshell)
    for mark, key in index.keys.items():
        if key not in solids:
            solids[key] = product_solid(index.parts[mark])
    return solids
