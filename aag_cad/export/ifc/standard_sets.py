"""The property and quantity sets of the IFC standard that apply to the parts."""

from collections.abc import Mapping, Sequence

import numpy as np

from aag_cad.export.ifc.frame import Entity, IfcModel
from aag_cad.export.ifc.options import IfcSchema
from aag_cad.export.ifc.sets import Property, Quantity, write_property_set, write_quantities
from aag_cad.parts.kinds import kind_of, shaped
from aag_cad.parts.model import FlatBar, Part, Timber
from aag_cad.parts.products import product_name
from aag_cad.parts.quantities import density, gross_volume, mass, section_area, sizes, volume
from aag_cad.parts.shapes.sheet import SHEET, flat_pattern
from aag_cad.units import MM2_PER_M2, MM3_PER_M3, Floats

_COMMON = {
    "IfcMember": "Pset_MemberCommon",
    "IfcPlate": "Pset_PlateCommon",
    "IfcFooting": "Pset_FootingCommon",
    "IfcMechanicalFastener": "Pset_ElementComponentCommon",
    "IfcDiscreteAccessory": "Pset_ElementComponentCommon",
}
_QUANTITIES = {
    "IfcMember": "Qto_MemberBaseQuantities",
    "IfcPlate": "Qto_PlateBaseQuantities",
    "IfcFooting": "Qto_FootingBaseQuantities",
}
_NOT_IN_IFC2X3 = {
    "Pset_FootingCommon",
    "Pset_ElementComponentCommon",
    "Pset_MechanicalFastenerBolt",
    "Pset_MechanicalFastenerAnchorBolt",
}
MANUFACTURER = "Pset_ManufacturerOccurrence"


def _common(part: Part) -> list[Property]:
    entity = kind_of(part).ifc.entity
    rows: list[Property] = [("Reference", "IfcIdentifier", product_name(part))]
    if entity in ("IfcMember", "IfcPlate"):
        rows.append(("IsExternal", "IfcBoolean", True))
    if entity in ("IfcMember", "IfcPlate", "IfcFooting"):
        rows.append(("LoadBearing", "IfcBoolean", kind_of(part).place != "cover"))
    return rows


def property_sets(part: Part, schema: IfcSchema) -> dict[str, list[Property]]:
    """Return the standard property sets of a part's product, by name, as far as the schema has them."""
    kind, (length, diameter, _thickness) = kind_of(part).ifc, sizes(part)
    found = {_COMMON[kind.entity]: _common(part)}
    if kind.predefined == "BOLT":
        found["Pset_MechanicalFastenerBolt"] = [
            ("ThreadDiameter", "IfcPositiveLengthMeasure", diameter),
            ("NutsCount", "IfcCountMeasure", 1),
            ("WashersCount", "IfcCountMeasure", 2),
            ("HeadShape", "IfcLabel", "hexagon"),
            ("NutShape", "IfcLabel", "hexagon"),
            ("WasherShape", "IfcLabel", "round"),
        ]
    if kind.predefined == "ANCHORBOLT":
        found["Pset_MechanicalFastenerAnchorBolt"] = [
            ("AnchorBoltLength", "IfcPositiveLengthMeasure", round(length, 3)),
            ("AnchorBoltDiameter", "IfcPositiveLengthMeasure", diameter),
            ("AnchorBoltThreadLength", "IfcPositiveLengthMeasure", round(length, 3)),
        ]
    return {name: rows for name, rows in found.items() if schema != "IFC2X3" or name not in _NOT_IN_IFC2X3}


def _bulk(part: Part, timber: Timber) -> list[Quantity]:
    """Return volumes (m3) and masses (kg); net is less the holes."""
    gross = gross_volume(part) / MM3_PER_M3
    return [
        ("GrossVolume", "IfcQuantityVolume", round(gross, 9)),
        ("NetVolume", "IfcQuantityVolume", round(volume(part) / MM3_PER_M3, 9)),
        ("GrossWeight", "IfcQuantityWeight", round(gross * density(part, timber), 6)),
        ("NetWeight", "IfcQuantityWeight", round(mass(part, timber), 6)),
    ]


def _perimeter(part: Part) -> float:
    shape, form = shaped(part)
    if shape is SHEET:
        pattern = flat_pattern(form)
        cuts = _polyline_length(pattern.lower) + _polyline_length(pattern.upper)
        return pattern.left_length + pattern.right_length + cuts
    length, width, _thickness = sizes(part)
    return 2.0 * (length + width)


def _polyline_length(points: Floats) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def base_quantities(part: Part, timber: Timber) -> list[Quantity]:
    """Return the base quantities of a part in mm, m2, m3 and kg; none for fasteners and shoes.

    Plates are measured in their flat pattern; their width is the thickness, as the standard has it.
    """
    entity = kind_of(part).ifc.entity
    length, width, thickness = (round(size, 3) for size in sizes(part))
    if entity == "IfcFooting":
        return [
            ("Length", "IfcQuantityLength", length),
            ("Width", "IfcQuantityLength", width),
            ("Height", "IfcQuantityLength", thickness),
            *_bulk(part, timber),
        ]
    if entity == "IfcPlate":
        return [
            ("Width", "IfcQuantityLength", thickness),
            ("Perimeter", "IfcQuantityLength", round(_perimeter(part), 3)),
            ("GrossArea", "IfcQuantityArea", round(gross_volume(part) / thickness / MM2_PER_M2, 9)),
            ("NetArea", "IfcQuantityArea", round(volume(part) / thickness / MM2_PER_M2, 9)),
            *_bulk(part, timber),
        ]
    if entity == "IfcMember":
        return [
            ("Length", "IfcQuantityLength", length),
            ("CrossSectionArea", "IfcQuantityArea", round(section_area(part) / MM2_PER_M2, 9)),
            *_bulk(part, timber),
        ]
    return []


def write_product_sets(
    model: IfcModel, key: str, parts: Sequence[Part], occurrences: Mapping[str, Entity], timber: Timber
) -> None:
    """Write the standard sets that the parts of one product share."""
    first, related = parts[0], [occurrences[part.mark] for part in parts]
    for name, rows in property_sets(first, model.schema).items():
        write_property_set(model, name, key, rows, related)
    if quantities := base_quantities(first, timber):
        write_quantities(model, _QUANTITIES[kind_of(first).ifc.entity], key, quantities, related)


def write_serial_numbers(
    model: IfcModel, planks: Sequence[FlatBar], occurrences: Mapping[str, Entity], groups: Mapping[str, str]
) -> None:
    """Write the mark of each plank as its serial number and its drilling group as the batch that it is made in."""
    for plank in planks:
        rows: list[Property] = [
            ("SerialNumber", "IfcIdentifier", plank.mark),
            ("BatchReference", "IfcIdentifier", groups[plank.mark]),
        ]
        write_property_set(model, MANUFACTURER, plank.mark, rows, [occurrences[plank.mark]])
