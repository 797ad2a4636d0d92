"""Every kind of part, described once: a row says all that lists, files, drawings, checks and the plan ask of it.

A new kind is its class, its row here and its placement; its name in print stands in ``words/parts.toml``.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Generic, Literal, TypeAlias, TypeVar

from aag_cad.colours import LEGEND, srgb
from aag_cad.families import FAMILIES
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
from aag_cad.parts.shapes.bar import BAR
from aag_cad.parts.shapes.box import BOX, Box
from aag_cad.parts.shapes.folded_plate import FOLDED_PLATE
from aag_cad.parts.shapes.prism import PRISM
from aag_cad.parts.shapes.shape import Shape
from aag_cad.parts.shapes.sheet import SHEET
from aag_cad.parts.shapes.threaded import THREADED, bolt_form, rod_form, screw_form

Material: TypeAlias = Literal["timber", "steel", "aluminium", "polycarbonate", "concrete"]
Role: TypeAlias = Literal["member", "connector", "fastener"]
Place: TypeAlias = Literal["shell", "ground", "cover", "ridge"]
Source: TypeAlias = Literal["board", "bar", "sheet", "piece", "box"]

_P = TypeVar("_P")
_F = TypeVar("_F")


@dataclass(frozen=True)
class IfcKind:
    """An entity, the predefined type that its type object carries, and the word for it if that is USERDEFINED."""

    entity: str
    predefined: str
    element_type: str | None = None


@dataclass(frozen=True)
class Bought:
    """How a kind is bought: cut from boards, bars or sheets, by the piece, or out of a box; as what, by which standard.

    ``washers`` is the standard of the washers on a fastener, "" if it has none.
    """

    source: Source
    item: str
    standard: str
    washers: str = ""


@dataclass(frozen=True, eq=False)
class Kind(Generic[_P, _F]):
    """A row of the table of kinds.

    ``key`` finds its name in ``words/parts.toml`` and, unless ``minutes`` names another, its time in
    ``aag_cad.design_making.Minutes``; ``name`` is the word for it in part lists. ``product`` names a make of it by
    ``length``, ``width``, ``thickness``, the ``short`` mark and its ``number``. ``field`` of a shell or gridshell holds
    its parts: ``more`` those of a kind that has none of its own. ``letter`` is that of its marks, of a fastener what it
    adds to its joint's; none for planks and blades, which are marked by family and by ridge. ``form`` is what a part is
    to its ``shape``; ``colour`` is its name in the legend (``aag_cad.colours``), "" for planks, which have their own.

    A ``role``: members are joined, connectors and fasteners join them; fasteners come in boxes and have no mark on
    them. A ``place``: in a shell, on the ground under it, in its cover, or between two shells. ``long`` parts are
    carried by their metres; ``outlined`` ones are drawn in the pictures of the plan, besides the planks.
    """

    part: type[_P]
    key: str
    name: str
    product: str
    field: str
    letter: str
    shape: Shape[_F]
    form: Callable[[_P], _F]
    material: Material
    colour: str
    ifc: IfcKind
    bought: Bought
    role: Role
    place: Place
    digits: int = 2
    minutes: str = ""
    long: bool = False
    outlined: bool = False


def _itself(part: _P) -> _P:
    return part


# In the order in which they are put in place.
_ROWS = (
    Kind(
        Plank, "plank", "plank", "Plank {short}", "planks", "", BAR, _itself,
        "timber", "", IfcKind("IfcMember", "MEMBER"), Bought("board", "board", "EN 338"), "member", "shell", long=True,
    ),
    Kind(
        Stud, "stud", "stud", "Hexagon stud {width:g} x {length:g}", "studs", "N", PRISM, _itself,
        "timber", "stud", IfcKind("IfcMember", "USERDEFINED", "Hexagon stud"),
        Bought("bar", "timber bar", "EN 338"), "connector", "shell", digits=3,
    ),
    Kind(
        CouplingBlock, "block", "coupling block", "Coupling block {length:g} x {width:g} x {thickness:g}",
        "blocks", "K", BOX, lambda b: Box(b.length, b.width, -b.thickness / 2.0, b.thickness / 2.0, b.holes),
        "timber", "block", IfcKind("IfcMember", "USERDEFINED", "Coupling block"),
        Bought("bar", "timber bar", "EN 338"), "connector", "shell", digits=3,
    ),
    Kind(
        Bolt, "bolt", "bolt", "Bolt M{width:g} x {length:g}", "bolts", "B", THREADED, bolt_form,
        "steel", "steel", IfcKind("IfcMechanicalFastener", "BOLT"),
        Bought("box", "hexagon bolt", "ISO 4014", washers="ISO 7093-1"), "fastener", "shell",
    ),
    Kind(
        Screw, "screw", "screw", "Screw {width:g} x {length:g}", "screws", "W", THREADED, screw_form,
        "steel", "steel", IfcKind("IfcMechanicalFastener", "SCREW"),
        Bought("box", "countersunk wood screw", "DIN 7997"), "fastener", "shell",
    ),
    Kind(
        Strap, "strap", "strap", "Strap {length:.0f} x {width:g} x {thickness:g}", "straps", "R", BAR, _itself,
        "steel", "steel", IfcKind("IfcPlate", "USERDEFINED", "Strap"),
        Bought("bar", "steel flat bar", "EN 10058"), "connector", "shell", outlined=True,
    ),
    Kind(
        Footing, "footing", "concrete block", "Concrete block {length:g} x {width:g} x {thickness:g}",
        "footings", "C", BOX, lambda footing: Box(footing.length, footing.width, -footing.height, 0.0),
        "concrete", "concrete", IfcKind("IfcFooting", "PAD_FOOTING"),
        Bought("piece", "precast concrete block", "EN 13369"), "member", "ground", outlined=True,
    ),
    Kind(
        Rod, "rod", "threaded rod", "Threaded rod M{width:g} x {length:g}", "rods", "T", THREADED, rod_form,
        "steel", "steel", IfcKind("IfcMechanicalFastener", "ANCHORBOLT"),
        Bought("box", "threaded rod", "DIN 976-1", washers="ISO 7089"), "fastener", "ground", outlined=True,
    ),
    Kind(
        Shoe, "shoe", "shoe", "Shoe {width:g} x {thickness:g}", "shoes", "F", FOLDED_PLATE, lambda shoe: shoe.plate,
        "steel", "steel", IfcKind("IfcDiscreteAccessory", "SHOE"),
        Bought("piece", "steel plate, folded to a shoe", "EN 10025-2"), "connector", "ground", outlined=True,
    ),
    Kind(
        Mullion, "mullion", "mullion", "Mullion {number}", "mullions", "M", BAR, _itself,
        "aluminium", "aluminium", IfcKind("IfcMember", "MULLION"),
        Bought("bar", "aluminium flat bar", "EN 755-5"), "member", "cover", long=True, outlined=True,
    ),
    Kind(
        Strip, "strip", "strip", "Strip {number}", "strips", "P", SHEET, _itself,
        "polycarbonate", "sheet", IfcKind("IfcPlate", "SHEET"),
        Bought("sheet", "multiwall polycarbonate sheet", "EN 16153"), "member", "cover", long=True, outlined=True,
    ),
    Kind(
        ClampingBar, "clamp", "clamping bar", "Clamping bar {number}", "clamps", "D", BAR, _itself,
        "aluminium", "aluminium", IfcKind("IfcMember", "USERDEFINED", "Clamping bar"),
        Bought("bar", "aluminium flat bar", "EN 755-5"), "member", "cover", long=True, outlined=True,
    ),
    Kind(
        Blade, "blade", "blade", "Ridge blade {width:g} x {thickness:g}", "blades", "", FOLDED_PLATE,
        lambda blade: blade.plate, "steel", "steel", IfcKind("IfcPlate", "USERDEFINED", "Ridge blade"),
        Bought("piece", "steel plate, folded to a blade", "EN 10025-2"), "connector", "ridge", outlined=True,
    ),
)  # fmt: skip
KINDS: dict[type[Any], Kind[Any, Any]] = {row.part: row for row in _ROWS}


def kind_of(part: Part) -> Kind[Any, Any]:
    """Return the row of the kind of a part."""
    return KINDS[type(part)]


def kind_named(word: str) -> Kind[Any, Any] | None:
    """Return the row of a kind by the word for it in part lists, as graphs of parts have it; None for other words."""
    return next((row for row in KINDS.values() if row.name == word), None)


def is_fastener(word: str) -> bool:
    """Return whether a kind, given by the word for it, only holds others together."""
    row = kind_named(word)
    return row is not None and row.role == "fastener"


def shaped(part: Part) -> tuple[Shape[Any], Any]:
    """Return the shape of a part, and what the part is to it."""
    row = KINDS[type(part)]
    return row.shape, row.form(part)


def parts_at(parts: Iterable[Part], *places: Place) -> list[Part]:
    """Return those of some parts that have one of some places, in the order in which kinds are put in place."""
    order = list(KINDS)
    return sorted((p for p in parts if kind_of(p).place in places), key=lambda part: order.index(type(part)))


def is_driven(part: Part) -> bool:
    """Return whether a part is a fastener without a nut, which is driven into the timber."""
    shape, form = shaped(part)
    return shape is THREADED and all(piece.name != "nut" for piece in form.pieces)


def minutes_key(part: Part) -> str:
    """Return the key of the crew's time for putting a part in place (``aag_cad.design_making.Minutes``)."""
    row = kind_of(part)
    return FAMILIES[part.family].minutes if isinstance(part, Plank) else row.minutes or row.key


def colour_name(part: Part) -> str:
    """Return the name of a part's colour in the legend: the family of a plank, else what it is or is made of."""
    return part.family if isinstance(part, Plank) else kind_of(part).colour


def colour(part: Part) -> tuple[float, float, float]:
    """Return the colour of a part as sRGB numbers (red, green, blue), each 0 to 1."""
    return srgb(LEGEND[colour_name(part)])
