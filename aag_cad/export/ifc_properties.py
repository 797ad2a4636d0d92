"""Property sets and quantities in IFC: what the parts weigh, how they are drilled and how far they are bent."""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeAlias

from aag_cad.export.ifc_base import Entity, IfcModel, guid
from aag_cad.parts.marks import parse_mark
from aag_cad.parts.model import CouplingBlock, Hole, Part, Plank, Stud, Timber
from aag_cad.parts.products import product_name
from aag_cad.parts.quantities import (
    density,
    gross_volume,
    hole_count,
    largest_twist,
    mass,
    section_area,
    sizes,
    smallest_radius,
    volume,
)
from aag_cad.units import MM2_PER_M2, MM3_PER_M3, deg_per_m

FABRICATION = "AAG_Fabrication"
MEMBER_COMMON = "Pset_MemberCommon"
MEMBER_QUANTITIES = "Qto_MemberBaseQuantities"

Value: TypeAlias = str | int | float | bool
Property: TypeAlias = tuple[str, str, Value]


def hole_text(number: int, hole: Hole) -> str:
    """Return a hole as it stands in the hole table: number, station, offset, diameter, use and joint."""
    return (
        f"{number}: x {hole.station:.1f}, y {round(hole.offset, 1) + 0.0:+.1f}, "
        f"d {hole.diameter:g} {hole.use} {hole.joint}"
    )


def hole_table(part: Part) -> str:
    """Return the holes of a part as one text, in mm, separated by semicolons; empty if it has none."""
    match part:
        case Plank():
            texts = [hole_text(number, hole) for number, hole in enumerate(part.blank.holes, start=1)]
        case CouplingBlock():
            texts = [hole_text(number, hole) for number, hole in enumerate(part.holes, start=1)]
        case Stud():
            texts = [
                f"{number}: z {hole.height:+.1f}, at {math.degrees(hole.angle):.1f} deg, d {hole.diameter:g}"
                for number, hole in enumerate(part.holes, start=1)
            ]
        case _:
            texts = []
    return "; ".join(texts)


def fabrication(part: Part) -> list[Property]:
    """Return the properties of ``AAG_Fabrication``: what the workshop needs to make and find one piece."""
    mark = parse_mark(part.mark)
    rows: list[Property] = [
        ("Mark", "IfcIdentifier", part.mark),
        ("Family", "IfcLabel", mark.family),
        ("Index", "IfcInteger", mark.index),
        ("HoleCount", "IfcInteger", hole_count(part)),
    ]
    if holes := hole_table(part):
        rows.append(("Holes", "IfcText", holes))
    if not isinstance(part, Plank):
        return rows
    rows += [
        ("Layer", "IfcInteger", part.layer),
        ("BlankLength", "IfcPositiveLengthMeasure", round(part.blank.length, 3)),
        ("BlankWidth", "IfcPositiveLengthMeasure", part.blank.section.width),
        ("BlankThickness", "IfcPositiveLengthMeasure", part.blank.section.thickness),
        ("LargestTwistDegPerM", "IfcReal", round(deg_per_m(largest_twist(part)), 3)),
    ]
    if math.isfinite(radius := smallest_radius(part)):
        rows.append(("SmallestRadius", "IfcPositiveLengthMeasure", round(radius, 1)))
    return rows


def member_common(part: Part) -> list[Property]:
    """Return the properties of ``Pset_MemberCommon`` that the model knows."""
    return [
        ("Reference", "IfcIdentifier", product_name(part)),
        ("IsExternal", "IfcBoolean", True),
        ("LoadBearing", "IfcBoolean", True),
    ]


def member_quantities(part: Part, timber: Timber) -> list[tuple[str, str, float]]:
    """Return the quantities of a timber part: mm, m2, m3 and kg; net is less the holes."""
    gross = gross_volume(part) / MM3_PER_M3
    return [
        ("Length", "IfcQuantityLength", round(sizes(part)[0], 3)),
        ("CrossSectionArea", "IfcQuantityArea", round(section_area(part) / MM2_PER_M2, 9)),
        ("GrossVolume", "IfcQuantityVolume", round(gross, 9)),
        ("NetVolume", "IfcQuantityVolume", round(volume(part) / MM3_PER_M3, 9)),
        ("GrossWeight", "IfcQuantityWeight", round(gross * density(part, timber), 6)),
        ("NetWeight", "IfcQuantityWeight", round(mass(part, timber), 6)),
    ]


def _values(model: IfcModel, rows: Iterable[Property]) -> list[Entity]:
    return [
        model.file.create_entity("IfcPropertySingleValue", name, None, model.file.create_entity(measure, value))
        for name, measure, value in rows
    ]


def _define(model: IfcModel, name: str, owner: str, definition: Entity, related: Sequence[Entity]) -> None:
    model.file.create_entity(
        "IfcRelDefinesByProperties",
        guid(model.project_id, "defined", name, owner),
        None,
        None,
        None,
        related,
        definition,
    )


def write_property_set(
    model: IfcModel, name: str, owner: str, rows: Iterable[Property], related: Sequence[Entity]
) -> None:
    """Write a property set and give it to entities; ``owner`` (a mark or a product's key) makes its GUID."""
    ident = guid(model.project_id, "set", name, owner)
    definition = model.file.create_entity("IfcPropertySet", ident, None, name, None, _values(model, rows))
    _define(model, name, owner, definition, related)


def write_quantities(
    model: IfcModel, name: str, owner: str, rows: Iterable[tuple[str, str, float]], related: Sequence[Entity]
) -> None:
    """Write a quantity set and give it to entities; ``owner`` (a mark or a product's key) makes its GUID."""
    quantities = [model.file.create_entity(entity, title, None, None, value) for title, entity, value in rows]
    ident = guid(model.project_id, "set", name, owner)
    definition = model.file.create_entity("IfcElementQuantity", ident, None, name, None, None, quantities)
    _define(model, name, owner, definition, related)


def write_product_sets(
    model: IfcModel, key: str, parts: Sequence[Part], occurrences: Mapping[str, Entity], timber: Timber
) -> None:
    """Write what the parts of one product share: the member sets of timber, the mass of a fastener."""
    first, related = parts[0], [occurrences[part.mark] for part in parts]
    if isinstance(first, Plank | Stud | CouplingBlock):
        write_property_set(model, MEMBER_COMMON, key, member_common(first), related)
        write_quantities(model, MEMBER_QUANTITIES, key, member_quantities(first, timber), related)
    else:
        rows: list[Property] = [
            ("Product", "IfcLabel", product_name(first)),
            ("NetWeight", "IfcMassMeasure", round(mass(first, timber), 6)),
        ]
        write_property_set(model, FABRICATION, key, rows, related)


def write_piece_sets(model: IfcModel, parts: Iterable[Part], occurrences: Mapping[str, Entity]) -> None:
    """Write the fabrication set of every piece of timber."""
    for part in parts:
        if isinstance(part, Plank | Stud | CouplingBlock):
            write_property_set(model, FABRICATION, part.mark, fabrication(part), [occurrences[part.mark]])


def material_properties(model: IfcModel, material: Entity, density: float, timber: Timber | None = None) -> None:
    """Write the density (kg/m3), and for timber species, strength class and moduli, of a material."""
    sets: dict[str, list[Property]] = {"Pset_MaterialCommon": [("MassDensity", "IfcMassDensityMeasure", density)]}
    if timber is not None:
        sets["Pset_MaterialWood"] = [
            ("Species", "IfcLabel", timber.species),
            ("StrengthGrade", "IfcLabel", timber.strength_class),
        ]
        sets["Pset_MaterialMechanical"] = [
            ("YoungModulus", "IfcModulusOfElasticityMeasure", timber.modulus),
            ("ShearModulus", "IfcModulusOfElasticityMeasure", timber.shear_modulus),
        ]
    for name, rows in sets.items():
        model.file.create_entity("IfcMaterialProperties", name, None, _values(model, rows), material)
