"""Type objects of the products in IFC, each with the shape that all its occurrences share."""

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass

from aag_cad.export.ifc.bodies import representation_maps, surface_style
from aag_cad.export.ifc.frame import Entity, IfcModel, declare, rooted
from aag_cad.export.ifc.schemas import type_entity, type_word
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import colour_name, kind_of
from aag_cad.parts.model import Gridshell, Part
from aag_cad.parts.products import product_name
from aag_cad.parts.quantities import sizes


@dataclass(frozen=True, eq=False)
class Product:
    """A type object, its representation maps, and the parts that are made to it."""

    key: str
    type: Entity
    maps: tuple[Entity, ...]
    parts: tuple[Part, ...]


def _type_object(model: IfcModel, key: str, part: Part, maps: list[Entity]) -> Entity:
    kind, (length, width, _thickness) = kind_of(part).ifc, sizes(part)
    threaded = kind.entity == "IfcMechanicalFastener"
    nominal = {"NominalDiameter": width, "NominalLength": length} if threaded else {}
    return rooted(
        model, type_entity(model.schema, kind), ("type", key), product_name(part),
        RepresentationMaps=maps, ElementType=type_word(model.schema, kind), PredefinedType=kind.predefined, **nominal,
    )  # fmt: skip


def products(model: IfcModel, gridshell: Gridshell) -> list[Product]:
    """Write one type object for every product and return them in the order of their first parts."""
    styles: dict[str, Entity] = {}
    found, index, groups = [], index_of(gridshell), defaultdict[str, list[Part]](list)
    for mark, key in index.keys.items():
        groups[key].append(index.parts[mark])
    for key, members in groups.items():
        first = members[0]
        name = colour_name(first)
        if name not in styles:
            styles[name] = surface_style(model, first)
        maps = representation_maps(model, first, styles[name])
        found.append(Product(key, _type_object(model, key, first, maps), tuple(maps), tuple(members)))
    return found


def define_types(model: IfcModel, found: list[Product], occurrences: Mapping[str, Entity]) -> None:
    """Declare the types in the project and write which occurrences (by mark) are of which type."""
    declare(model, "types", [product.type for product in found])
    for product in found:
        related = [occurrences[part.mark] for part in product.parts]
        rooted(model, "IfcRelDefinesByType", ("typed", product.key), None, None, related, product.type)
