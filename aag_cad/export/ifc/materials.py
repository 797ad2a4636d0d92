"""Materials of an IFC file: profiles of planks and bars, layers of sheets and plates, and what they are made of."""

from collections.abc import Mapping

from aag_cad.export.ifc.frame import Entity, IfcModel, rooted
from aag_cad.export.ifc.sets import Property, properties
from aag_cad.export.ifc.types import Product
from aag_cad.parts.kinds import Material, kind_of
from aag_cad.parts.model import Part, Timber
from aag_cad.parts.quantities import density, material_name, sizes
from aag_cad.parts.shapes.bar import BAR

# The categories that IfcMaterial proposes.
_CATEGORIES: dict[Material, str] = {
    "timber": "wood",
    "steel": "steel",
    "aluminium": "aluminium",
    "polycarbonate": "plastic",
    "concrete": "concrete",
}


def _wood(timber: Timber) -> list[Property]:
    return [("Species", "IfcLabel", timber.species), ("StrengthGrade", "IfcLabel", timber.strength_class)]


def _material(model: IfcModel, part: Part, timber: Timber) -> Entity:
    """Write the material of a part with its density (kg/m3), and for timber species, class and moduli (N/mm2)."""
    name, made_of = material_name(part, timber), kind_of(part).material
    wooden = made_of == "timber"
    if model.schema == "IFC2X3":
        written = model.new("IfcMaterial", name)
        model.new("IfcGeneralMaterialProperties", written, MassDensity=density(part, timber))
        if wooden:
            model.new(
                "IfcMechanicalMaterialProperties", written, YoungModulus=timber.modulus,
                ShearModulus=timber.shear_modulus,
            )  # fmt: skip
            model.new(
                "IfcExtendedMaterialProperties", written, properties(model, _wood(timber)), None, "AAG_MaterialWood"
            )
        return written
    written = model.new("IfcMaterial", name, None, _CATEGORIES[made_of])
    sets: dict[str, list[Property]] = {
        "Pset_MaterialCommon": [("MassDensity", "IfcMassDensityMeasure", density(part, timber))]
    }
    if wooden:
        sets["Pset_MaterialWood"] = _wood(timber)
        sets["Pset_MaterialMechanical"] = [
            ("YoungModulus", "IfcModulusOfElasticityMeasure", timber.modulus),
            ("ShearModulus", "IfcModulusOfElasticityMeasure", timber.shear_modulus),
        ]
    for title, rows in sets.items():
        model.new("IfcMaterialProperties", title, None, properties(model, rows), written)
    return written


def _profiled(model: IfcModel, made_of: Entity, name: str, width: float, thickness: float) -> Entity:
    title = f"{width:g} x {thickness:g}"
    profile = model.new("IfcRectangleProfileDef", "AREA", title, None, width, thickness)
    one = model.new("IfcMaterialProfile", title, None, made_of, profile)
    return model.new("IfcMaterialProfileSet", f"{name} {title}", None, [one])


def _layered(model: IfcModel, made_of: Entity, name: str, thickness: float) -> Entity:
    layer = model.new("IfcMaterialLayer", made_of, thickness, False)
    return model.new("IfcMaterialLayerSet", [layer], f"{name} {thickness:g}")


def material_key(part: Part, schema: str) -> tuple[str, str, float, float]:
    """Return what parts of one material definition share: "profile", "layer" or "plain", material, and sizes in mm.

    Planks and bars have their section as a profile (not in IFC2X3, which has no material profiles), plates and
    sheets their thickness as a layer.
    """
    _length, width, thickness = (round(size, 3) for size in sizes(part))
    row = kind_of(part)
    if row.ifc.entity == "IfcPlate":
        return "layer", row.material, 0.0, thickness
    if row.shape is BAR and schema != "IFC2X3":
        return "profile", row.material, width, thickness
    return "plain", row.material, 0.0, 0.0


def associate_materials(
    model: IfcModel, found: list[Product], occurrences: Mapping[str, Entity], timber: Timber
) -> None:
    """Write the materials and give them to types and occurrences (not every viewer looks at the type)."""
    groups: dict[tuple[str, str, float, float], list[Product]] = {}
    for product in found:
        groups.setdefault(material_key(product.parts[0], model.schema), []).append(product)
    made: dict[str, Entity] = {}
    for (shape, made_of, width, thickness), members in groups.items():
        first = members[0].parts[0]
        if made_of not in made:
            made[made_of] = _material(model, first, timber)
        definition, name = made[made_of], material_name(first, timber)
        if shape == "profile":
            definition = _profiled(model, made[made_of], name, width, thickness)
        elif shape == "layer":
            definition = _layered(model, made[made_of], name, thickness)
        related = [product.type for product in members]
        related += [occurrences[part.mark] for product in members for part in product.parts]
        names = ("material", made_of) if shape == "plain" else ("material", made_of, shape, f"{width:g} {thickness:g}")
        rooted(model, "IfcRelAssociatesMaterial", names, None, None, related, definition)
