"""What each kind of part is in IFC and which colour it has: plain data, no IFC library."""

from dataclasses import dataclass

from aag_cad.colours import LEGEND, srgb
from aag_cad.parts.model import (
    Blade,
    Bolt,
    ClampingBar,
    CouplingBlock,
    Footing,
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


@dataclass(frozen=True)
class IfcKind:
    """An entity, the predefined type that its type object carries, and the word for it if that is USERDEFINED."""

    entity: str
    predefined: str
    element_type: str | None = None


IFC_KINDS: dict[type[Part], IfcKind] = {
    Plank: IfcKind("IfcMember", "MEMBER"),
    Stud: IfcKind("IfcMember", "USERDEFINED", "Hexagon stud"),
    CouplingBlock: IfcKind("IfcMember", "USERDEFINED", "Coupling block"),
    Bolt: IfcKind("IfcMechanicalFastener", "BOLT"),
    Screw: IfcKind("IfcMechanicalFastener", "SCREW"),
    Strip: IfcKind("IfcPlate", "SHEET"),
    Mullion: IfcKind("IfcMember", "MULLION"),
    ClampingBar: IfcKind("IfcMember", "USERDEFINED", "Clamping bar"),
    Strap: IfcKind("IfcPlate", "USERDEFINED", "Strap"),
    Shoe: IfcKind("IfcDiscreteAccessory", "SHOE"),
    Rod: IfcKind("IfcMechanicalFastener", "ANCHORBOLT"),
    Footing: IfcKind("IfcFooting", "PAD_FOOTING"),
    Blade: IfcKind("IfcPlate", "USERDEFINED", "Ridge blade"),
}

_LEGEND: dict[type[Part], str] = {
    Stud: "stud",
    CouplingBlock: "block",
    Bolt: "steel",
    Screw: "steel",
    Strip: "sheet",
    Mullion: "aluminium",
    ClampingBar: "aluminium",
    Strap: "steel",
    Shoe: "steel",
    Rod: "steel",
    Footing: "concrete",
    Blade: "steel",
}


def colour_name(part: Part) -> str:
    """Return the name of a part's colour in the legend: the family of a plank, else what it is or is made of."""
    return part.family if isinstance(part, Plank) else _LEGEND[type(part)]


def colour(part: Part) -> tuple[float, float, float]:
    """Return the colour of a part as sRGB numbers (red, green, blue), each 0 to 1."""
    return srgb(LEGEND[colour_name(part)])
