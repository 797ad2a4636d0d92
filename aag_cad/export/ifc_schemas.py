"""What the three IFC schemas have and lack, and how a file says which of them it follows."""

from dataclasses import dataclass
from functools import cache
from typing import Literal, TypeAlias, get_args

import ifcopenshell

from aag_cad.design_making import Crew
from aag_cad.design_sections import Site
from aag_cad.errors import DesignError
from aag_cad.export.ifc_kinds import IfcKind

IfcSchema: TypeAlias = Literal["IFC4", "IFC4X3_ADD2", "IFC2X3"]
IfcGeometry: TypeAlias = Literal["mesh", "brep"]
IFC_SCHEMAS: tuple[IfcSchema, ...] = get_args(IfcSchema)
IFC_GEOMETRIES: tuple[IfcGeometry, ...] = get_args(IfcGeometry)

# The Reference View leaves out bodies of B-spline surfaces: with them a file can only follow the Design Transfer View.
_VIEWS: dict[tuple[IfcSchema, IfcGeometry], str] = {
    ("IFC2X3", "mesh"): "CoordinationView_V2.0",
    ("IFC4", "mesh"): "ReferenceView_V1.2",
    ("IFC4", "brep"): "DesignTransferView_V1.0",
    ("IFC4X3_ADD2", "mesh"): "ReferenceView",
    ("IFC4X3_ADD2", "brep"): "DesignTransferView",
}


@dataclass(frozen=True)
class IfcOptions:
    """How an IFC file is written: schema, bodies of planks, where it stands, who made it, who puts it together.

    ``geometry`` "brep" gives planks and bars B-spline faces in place of triangles. ``crew`` gives the people, their
    hours, the minutes that their work takes and the first day.
    """

    schema: IfcSchema = "IFC4"
    geometry: IfcGeometry = "mesh"
    site: Site | None = None
    author: str = ""
    organisation: str = ""
    crew: Crew | None = None


def require_known(options: IfcOptions) -> None:
    """Raise DesignError if no file can be written with these options."""
    if options.schema not in IFC_SCHEMAS:
        raise DesignError(f"--ifc-schema: {options.schema!r} is not written; choose {', '.join(IFC_SCHEMAS)}")
    if options.geometry not in IFC_GEOMETRIES:
        raise DesignError(f"--ifc-geometry: {options.geometry!r} is not written; choose {', '.join(IFC_GEOMETRIES)}")
    if (options.schema, options.geometry) not in _VIEWS:
        raise DesignError(
            f"--ifc-geometry: {options.schema} has no B-spline faces; choose mesh, or --ifc-schema IFC4 or IFC4X3_ADD2"
        )


def view_definition(options: IfcOptions) -> str:
    """Return the view definition as it stands in the header of the file."""
    return f"ViewDefinition [{_VIEWS[options.schema, options.geometry]}]"


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
