"""The solid of every product, each built once."""

from OCP.TopoDS import TopoDS_Solid

from aag_cad.parts.model import (
    Blade,
    Bolt,
    ClampingBar,
    CouplingBlock,
    Footing,
    Gridshell,
    Mullion,
    Part,
    Plank,
    Rod,
    Screw,
    Shoe,
    Strap,
    Strip,
    Stud,
    all_parts,
)
from aag_cad.parts.products import product_key
from aag_cad.solids.hardware import (
    block_solid,
    bolt_solid,
    folded_plate_solid,
    footing_solid,
    rod_solid,
    screw_solid,
    stud_solid,
)
from aag_cad.solids.planks import formed_plank
from aag_cad.solids.strips import strip_solid


def product_solid(part: Part) -> TopoDS_Solid:
    """Return a part's solid in product coordinates: those of its frame, or of its shell where it has none.

    SolidError names the mark if the solid comes out invalid.
    """
    match part:
        case Plank() | Mullion() | ClampingBar() | Strap():
            return formed_plank(part)
        case Stud():
            return stud_solid(part)
        case CouplingBlock():
            return block_solid(part)
        case Bolt():
            return bolt_solid(part)
        case Screw():
            return screw_solid(part)
        case Rod():
            return rod_solid(part)
        case Footing():
            return footing_solid(part)
        case Shoe() | Blade():
            return folded_plate_solid(part.plate, part.mark)
        case Strip():
            return strip_solid(part)


def product_solids(gridshell: Gridshell) -> dict[str, TopoDS_Solid]:
    """Return the solids of all products by their key, in the order in which the parts first need them."""
    solids: dict[str, TopoDS_Solid] = {}
    for part in all_parts(gridshell):
        key = product_key(part)
        if key not in solids:
            solids[key] = product_solid(part)
    return solids
