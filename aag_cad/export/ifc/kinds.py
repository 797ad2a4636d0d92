"""What each kind of part is in IFC and which colour it has: plain data, no IFC library."""

from dataclasses import dataclass

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

_FAMILY_COLOURS = {"A1": "#8A4B2A", "A2": "#D9A05B", "G": "#F0D9A8", "E": "#5F7F6A"}
_KIND_COLOURS: dict[type[Part], str] = {
    Stud: "#5A3A1E",
    CouplingBlock: "#A87848",
    Bolt: "#8A9099",
    Screw: "#B8BEC6",
    Strip: "#CFE6F2",
    Mullion: "#A7ADB5",
    ClampingBar: "#C3C8CE",
    Strap: "#6C737C",
    Shoe: "#6C737C",
    Rod: "#8A9099",
    Footing: "#9C9A95",
    Blade: "#6C737C",
}


def colour_name(part: Part) -> str:
    """Return the name under which parts share a colour: the family of a plank, else the kind."""
    return f"Plank {part.family}" if isinstance(part, Plank) else type(part).__name__


def colour(part: Part) -> tuple[float, float, float]:
    """Return the colour of a part as (red, green, blue), each 0 to 1."""
    code = _FAMILY_COLOURS[part.family] if isinstance(part, Plank) else _KIND_COLOURS[type(part)]
    return int(code[1:3], 16) / 255.0, int(code[3:5], 16) / 255.0, int(code[5:7], 16) / 255.0
