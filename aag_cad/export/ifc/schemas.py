"""What the three IFC schemas have and lack."""

from functools import cache

import ifcopenshell

from aag_cad.export.ifc.options import IfcSchema
from aag_cad.parts.kinds import IfcKind


@cache
def attributes_of(schema: IfcSchema, entity: str) -> frozenset[str]:
    """Return the names of an entity's attributes in a schema; none if the schema does not have the entity."""
    declarations = {each.name(): each for each in _declarations(schema)}
    if entity not in declarations:
        return frozenset()
    return frozenset(each.name() for each in declarations[entity].as_entity().all_attributes())


@cache
def _declarations(schema: IfcSchema) -> tuple[ifcopenshell.ifcopenshell_wrapper.entity, ...]:
    return tuple(ifcopenshell.schema_by_name(schema).entities())


def type_entity(schema: IfcSchema, kind: IfcKind) -> str:
    """Return the entity of a kind's type objects: IFC2X3 has no type of its own for footings."""
    entity = f"{kind.entity}Type"
    return entity if attributes_of(schema, entity) else "IfcTypeProduct"


def type_word(schema: IfcSchema, kind: IfcKind) -> str | None:
    """Return the word that says what a kind is where no predefined type of its type object does."""
    if "PredefinedType" in attributes_of(schema, type_entity(schema, kind)):
        return kind.element_type
    return kind.element_type or kind.predefined


def known(schema: IfcSchema, entity: str, **attributes: object) -> dict[str, object]:
    """Return those of the attributes that an entity has in a schema."""
    return {name: value for name, value in attributes.items() if name in attributes_of(schema, entity)}
