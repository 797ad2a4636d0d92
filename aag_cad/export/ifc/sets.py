"""Property sets and quantity sets of an IFC file: how they are written and given to entities."""

from collections.abc import Iterable, Sequence
from typing import TypeAlias

from aag_cad.export.ifc.frame import Entity, IfcModel, rooted

Value: TypeAlias = str | int | float | bool | tuple[str, ...]
# Name, measure, value; several values make a list.
Property: TypeAlias = tuple[str, str, Value]
# Name, quantity entity, value.
Quantity: TypeAlias = tuple[str, str, float]


def properties(model: IfcModel, rows: Iterable[Property]) -> list[Entity]:
    """Write properties: single values, or a list of values where a tuple is given."""
    written = []
    for name, measure, value in rows:
        if isinstance(value, tuple):
            values = [model.new(measure, each) for each in value]
            written.append(model.new("IfcPropertyListValue", name, None, values))
        else:
            nominal = model.new(measure, value)
            written.append(model.new("IfcPropertySingleValue", name, None, nominal))
    return written


def _define(model: IfcModel, name: str, owner: str, definition: Entity, related: Sequence[Entity]) -> None:
    rooted(model, "IfcRelDefinesByProperties", ("defined", name, owner), None, None, related, definition)


def write_property_set(
    model: IfcModel, name: str, owner: str, rows: Iterable[Property], related: Sequence[Entity]
) -> Entity:
    """Write a property set, give it to entities and return it.

    ``owner`` (a mark, a step or a product's key) makes its GUID.
    """
    definition = rooted(model, "IfcPropertySet", ("set", name, owner), name, None, properties(model, rows))
    _define(model, name, owner, definition, related)
    return definition


def write_quantities(
    model: IfcModel, name: str, owner: str, rows: Iterable[Quantity], related: Sequence[Entity]
) -> None:
    """Write a quantity set and give it to entities; IFC2X3 knows quantity sets by the one name BaseQuantities."""
    quantities = [model.new(entity, title, None, None, value) for title, entity, value in rows]
    title = "BaseQuantities" if model.schema == "IFC2X3" else name
    definition = rooted(model, "IfcElementQuantity", ("set", name, owner), title, None, None, quantities)
    _define(model, name, owner, definition, related)
