"""Property sets, quantities and materials of the IFC file, read back with IfcOpenShell."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import ifcopenshell
import ifcopenshell.util.element
import pytest
from test_ifc_sample import sampled, sampled_work

from aag_cad.export.ifc.model import ifc_model
from aag_cad.export.ifc.options import IfcOptions
from aag_cad.export.ifc.properties import hole_text
from aag_cad.export.ifc.schedule import PlannedWork
from aag_cad.parts.forms import Hole
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import shell_of
from aag_cad.parts.model import Footing, Gridshell, Part, Plank, Rod, Strip, all_parts
from aag_cad.parts.quantities import largest_twist, mass, material_name, smallest_radius
from aag_cad.parts.shapes.sheet import flat_pattern
from aag_cad.shop.groups import drill_groups
from aag_cad.units import deg_per_m

File: TypeAlias = ifcopenshell.file
Sets: TypeAlias = Mapping[str, Mapping[str, Any]]


@pytest.fixture(scope="module")
def sample(gridshell: Gridshell) -> Gridshell:
    return sampled(gridshell)


@pytest.fixture(scope="module")
def work(gridshell: Gridshell, sample: Gridshell) -> PlannedWork:
    return sampled_work(gridshell, sample)


@pytest.fixture(scope="module")
def ifc(sample: Gridshell, work: PlannedWork) -> File:
    return ifc_model(sample, work).file


@pytest.fixture(scope="module")
def sets(ifc: File) -> Mapping[str, Sets]:
    return {each.Name: ifcopenshell.util.element.get_psets(each) for each in ifc.by_type("IfcElement")}


@pytest.fixture(scope="module")
def planks(sample: Gridshell) -> Sequence[Plank]:
    return [part for part in all_parts(sample) if isinstance(part, Plank)]


def of_kind(sample: Gridshell, kind: type[Part]) -> Part:
    return next(part for part in all_parts(sample) if isinstance(part, kind))


def test_a_plank_says_how_it_is_made(sample: Gridshell, sets: Mapping[str, Sets], planks: Sequence[Plank]) -> None:
    for plank in planks:
        made, quantities = sets[plank.mark]["AAG_Fabrication"], sets[plank.mark]["Qto_MemberBaseQuantities"]
        assert plank.mark == f"{shell_of(plank.mark)}-{made['Product'].removeprefix('Plank ')}"
        assert (made["Mark"], made["Family"], made["Layer"]) == (plank.mark, plank.family, plank.layer)
        assert made["BlankLength"] == pytest.approx(plank.blank.length, abs=1e-3)
        assert (made["BlankWidth"], made["BlankThickness"]) == (100.0, 12.0)
        assert made["SmallestRadius"] == pytest.approx(smallest_radius(plank), abs=1e-3)
        assert made["LargestTwistDegPerM"] == pytest.approx(deg_per_m(largest_twist(plank)), abs=1e-6)
        bored = sum(12.0 * (math.pi / 4.0 * h.diameter**2 + h.slot * h.diameter) for h in plank.blank.holes)
        assert quantities["Length"] == pytest.approx(plank.blank.length, abs=1e-3)
        assert quantities["CrossSectionArea"] == pytest.approx(0.1 * 0.012)
        assert quantities["GrossVolume"] == pytest.approx(0.1 * 0.012 * plank.blank.length / 1000.0, rel=1e-6)
        assert quantities["GrossVolume"] - quantities["NetVolume"] == pytest.approx(bored / 1e9, abs=2e-9)
        assert quantities["NetWeight"] == pytest.approx(mass(plank, sample.timber), abs=1e-6) == made["NetWeight"]


def test_the_hole_table_of_a_plank_lists_every_hole(sets: Mapping[str, Sets], planks: Sequence[Plank]) -> None:
    for plank in planks:
        made = sets[plank.mark]["AAG_Fabrication"]
        lines = made["Holes"].split("; ")
        assert made["HoleCount"] == len(lines) == len(plank.blank.holes)
        for number, (line, hole) in enumerate(zip(lines, plank.blank.holes, strict=True), start=1):
            assert line.startswith(f"{number}: x {hole.station:.1f}, y ")
            assert line.endswith(f"d {hole.diameter:g} {hole.use} {hole.joint}")


def test_a_slot_says_how_much_longer_than_round_it_is() -> None:
    assert hole_text(3, Hole(120.0, -30.0, 8.5, "bolt", "S1-N-001", slot=3.0)) == (
        "3: x 120.0, y -30.0, d 8.5 slot 3 bolt S1-N-001"
    )


def test_planks_name_the_template_that_they_are_drilled_by(
    sample: Gridshell, sets: Mapping[str, Sets], planks: Sequence[Plank]
) -> None:
    groups = {member.mark: g.mark for g in drill_groups(list(index_of(sample).planks.values())) for member in g.members}
    for plank in planks:
        assert sets[plank.mark]["AAG_Fabrication"]["DrillingGroup"] == groups[plank.mark]
        occurrence = sets[plank.mark]["Pset_ManufacturerOccurrence"]
        assert (occurrence["SerialNumber"], occurrence["BatchReference"]) == (plank.mark, groups[plank.mark])
    assert max(Counter(groups.values()).values()) >= 3


def test_every_part_tells_its_segment_and_its_step(
    sample: Gridshell, sets: Mapping[str, Sets], work: PlannedWork
) -> None:
    step_of = {mark: step for step in work.plan.steps for mark in step.marks}
    for part in all_parts(sample):
        row, step = sets[part.mark]["AAG_Assembly"], step_of[part.mark]
        assert (row["Step"], row["StepNumber"], row["Phase"]) == (step.id, step.number, step.phase)
        assert row["Segment"] == (part.mark[:2] if part.mark[0] == "S" else f"S{part.mark[1]}-S{part.mark[2]}")


def test_without_a_plan_a_part_tells_its_segment_only(sample: Gridshell) -> None:
    file = ifc_model(sample).file
    for element in file.by_type("IfcFooting"):
        row = ifcopenshell.util.element.get_psets(element)["AAG_Assembly"]
        assert set(row) == {"Segment", "id"}


def test_a_strip_is_measured_in_its_flat_pattern(sample: Gridshell, sets: Mapping[str, Sets]) -> None:
    """The perimeter of the outline's polygon, sampled every 25 mm, is short of the curve by less than 1e-4."""
    strip = of_kind(sample, Strip)
    assert isinstance(strip, Strip)
    row, pattern = sets[strip.mark]["Qto_PlateBaseQuantities"], flat_pattern(strip)
    around = [math.dist(a, b) for a, b in zip(pattern.outline, [*pattern.outline[1:], pattern.outline[0]], strict=True)]
    assert row["Perimeter"] == pytest.approx(sum(around), rel=1e-4)
    assert row["Width"] == strip.thickness
    assert row["GrossArea"] == pytest.approx(pattern.area / 1e6, rel=1e-6)
    assert row["GrossVolume"] == pytest.approx(pattern.area * strip.thickness / 1e9, rel=1e-6)
    assert sets[strip.mark]["Pset_PlateCommon"]["LoadBearing"] is False


def test_concrete_blocks_and_rods_have_the_quantities_of_their_kind(
    sample: Gridshell, sets: Mapping[str, Sets]
) -> None:
    block, rod = of_kind(sample, Footing), of_kind(sample, Rod)
    assert isinstance(block, Footing)
    assert isinstance(rod, Rod)
    row = sets[block.mark]["Qto_FootingBaseQuantities"]
    assert (row["Length"], row["Width"], row["Height"]) == (block.length, block.width, block.height)
    assert row["NetWeight"] == pytest.approx(block.length * block.width * block.height / 1e9 * 2400.0)
    bolt = sets[rod.mark]["Pset_MechanicalFastenerAnchorBolt"]
    assert (bolt["AnchorBoltDiameter"], bolt["AnchorBoltLength"]) == (rod.diameter, round(rod.length, 3))


def test_every_part_has_its_material(sample: Gridshell, ifc: File) -> None:
    parts = {part.mark: part for part in all_parts(sample)}
    for element in ifc.by_type("IfcElement"):
        if element.Name in parts:
            (material,) = ifcopenshell.util.element.get_materials(element)
            assert material.Name == material_name(parts[element.Name], sample.timber)


def test_planks_and_bars_have_their_section_as_profile_and_plates_their_thickness_as_layer(
    ifc: File, sample: Gridshell
) -> None:
    found = {}
    for element in (*ifc.by_type("IfcMember"), *ifc.by_type("IfcPlate"), *ifc.by_type("IfcMemberType")):
        material = ifcopenshell.util.element.get_material(element, should_inherit=False)
        title = element.Name.split("-")[1] if "-" in element.Name else element.Name
        if material.is_a("IfcMaterialProfileSet"):
            profile = material.MaterialProfiles[0].Profile
            found[title] = (profile.is_a(), profile.XDim, profile.YDim)
        elif material.is_a("IfcMaterialLayerSet"):
            found[title] = ("layer", material.MaterialLayers[0].LayerThickness)
        else:
            found[title] = (material.is_a(),)
    assert found["A1"] == found["G"] == found["E"] == ("IfcRectangleProfileDef", 100.0, 12.0)
    assert found["M"] == ("IfcRectangleProfileDef", 50.0, 3.0)
    assert found["D"] == ("IfcRectangleProfileDef", 50.0, 2.0)
    assert found["P"] == ("layer", 10.0)
    assert found["R"] == ("layer", 3.0)
    assert found["N"] == found["K"] == ("IfcMaterial",)


def test_timber_has_species_class_density_and_moduli(ifc: File, sample: Gridshell) -> None:
    timber = next(material for material in ifc.by_type("IfcMaterial") if material.Category == "wood")
    rows = {each.Name: {p.Name: p.NominalValue.wrappedValue for p in each.Properties} for each in timber.HasProperties}
    assert rows == {
        "Pset_MaterialCommon": {"MassDensity": sample.timber.density},
        "Pset_MaterialWood": {"Species": sample.timber.species, "StrengthGrade": sample.timber.strength_class},
        "Pset_MaterialMechanical": {
            "YoungModulus": sample.timber.modulus,
            "ShearModulus": sample.timber.shear_modulus,
        },
    }


def test_ifc2x3_keeps_the_same_figures_in_its_own_entities(sample: Gridshell) -> None:
    file = ifc_model(sample, options=IfcOptions(schema="IFC2X3")).file
    general = {each.Material.Name: each.MassDensity for each in file.by_type("IfcGeneralMaterialProperties")}
    assert general[material_name(sample.shells[0].planks[0], sample.timber)] == sample.timber.density
    plank = next(each for each in file.by_type("IfcMember") if each.Name == sample.shells[0].planks[0].mark)
    assert set(ifcopenshell.util.element.get_psets(plank)) == {
        "AAG_Fabrication", "AAG_Assembly", "Pset_MemberCommon", "Pset_ManufacturerOccurrence", "BaseQuantities",
    }  # fmt: skip
    block = file.by_type("IfcFooting")[0]
    assert block.PredefinedType == "PAD_FOOTING"
    assert ifcopenshell.util.element.get_type(block).is_a("IfcTypeProduct")
