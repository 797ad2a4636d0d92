"""Type objects of the products in IFC, each with the shape that all its occurrences share, and their materials."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from aag_cad.export.ifc_base import Entity, IfcModel, guid
from aag_cad.export.ifc_bodies import representation_maps, surface_style
from aag_cad.export.ifc_kinds import IFC_KINDS, colour_name
from aag_cad.export.ifc_properties import material_properties
from aag_cad.parts.model import Bolt, Part, Rod, Screw, Timber
from aag_cad.parts.products import product_key, product_name
from aag_cad.parts.quantities import Material, density, material, material_name

# The categories that IfcMaterial proposes.
_CATEGORIES: dict[Material, str] = {
    "timber": "wood",
    "steel": "steel",
    "aluminium": "aluminium",
    "polycarbonate": "plastic",
    "concrete": "concrete",
}


@dataclass(frozen=True, eq=False)
class Product:
    """A type object, its representation maps, and the parts that are made to it."""

    key: str
    type: Entity
    maps: tuple[Entity, ...]
    parts: tuple[Part, ...]


def _by_product(parts: Iterable[Part]) -> dict[str, list[Part]]:
    groups: dict[str, list[Part]] = {}
    for part in parts:
        groups.setdefault(product_key(part), []).append(part)
    return groups


def _type_object(model: IfcModel, key: str, part: Part, maps: list[Entity]) -> Entity:
    kind = IFC_KINDS[type(part)]
    nominal = (
        {"NominalDiameter": part.diameter, "NominalLength": part.length} if isinstance(part, Bolt | Screw | Rod) else {}
    )
    return model.file.create_entity(
        f"{kind.entity}Type", guid(model.project_id, "type", key), None, product_name(part),
        RepresentationMaps=maps, ElementType=kind.element_type, PredefinedType=kind.predefined, **nominal,
    )  # fmt: skip


def products(model: IfcModel, parts: Iterable[Part]) -> list[Product]:
    """Write one type object for every product and return them in the order of their first parts."""
    styles: dict[str, Entity] = {}
    found = []
    for key, members in _by_product(parts).items():
        first = members[0]
        name = colour_name(first)
        if name not in styles:
            styles[name] = surface_style(model, first)
        maps = representation_maps(model, first, styles[name])
        found.append(Product(key, _type_object(model, key, first, maps), tuple(maps), tuple(members)))
    return found


def define_types(model: IfcModel, found: list[Product], occurrences: Mapping[str, Entity]) -> None:
    """Declare the types in the project and write which occurrences (by mark) are of which type."""
    if types := [product.type for product in found]:
        declares = guid(model.project_id, "declares", "types")
        model.file.create_entity("IfcRelDeclares", declares, None, None, None, model.project, types)
    for product in found:
        model.file.create_entity(
            "IfcRelDefinesByType", guid(model.project_id, "typed", product.key), None, None, None,
            [occurrences[part.mark] for part in product.parts], product.type,
        )  # fmt: skip


def associate_materials(
    model: IfcModel, found: list[Product], occurrences: Mapping[str, Entity], timber: Timber
) -> None:
    """Write the materials, and give them to types and occurrences (not every viewer looks at the type)."""
    for name, category in _CATEGORIES.items():
        of_it = [product for product in found if material(product.parts[0]) == name]
        if not of_it:
            continue
        title = material_name(of_it[0].parts[0], timber)
        entity = model.file.create_entity("IfcMaterial", title, None, category)
        material_properties(model, entity, density(of_it[0].parts[0], timber), timber if name == "timber" else None)
        related = [product.type for product in of_it]
        related += [occurrences[part.mark] for product in of_it for part in product.parts]
        model.file.create_entity(
            "IfcRelAssociatesMaterial", guid(model.project_id, "material", name), None, None, None, related, entity
        )
