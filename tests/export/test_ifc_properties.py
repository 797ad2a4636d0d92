"""Property sets, quantities and materials of the IFC file, read back with IfcOpenShell."""

import math
from collections.abc import Iterator, Mapping
from typing import TypeAlias

import ifcopenshell
import ifcopenshell.util.element
import ifcopenshell.util.pset
import pytest

from aag_cad.design import Design
from aag_cad.export.ifc import write_ifc
from aag_cad.export.ifc_kinds import IFC_KINDS
from aag_cad.parts.model import Gridshell, Part, Plank, all_parts
from aag_cad.parts.quantities import largest_twist, mass, smallest_radius
from aag_cad.pipeline import gridshell_of
from aag_cad.units import deg_per_m

File: TypeAlias = ifcopenshell.file

QUANTITIES = {
    "Q_LENGTH": "IfcQuantityLength",
    "Q_AREA": "IfcQuantityArea",
    "Q_VOLUME": "IfcQuantityVolume",
    "Q_WEIGHT": "IfcQuantityWeight",
}


@pytest.fixture(scope="module")
def small(design: Design) -> Gridshell:
    """Give a vault of six geodesics a shell: every kind of part, a tenth of the number."""
    pattern = design.pattern.model_copy(update={"geodesics": 6, "min_nodes": 2})
    return gridshell_of(design.model_copy(update={"pattern": pattern}))


@pytest.fixture(scope="module")
def ifc(small: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> File:
    path = tmp_path_factory.mktemp("ifc") / "vault.ifc"
    write_ifc(small, path)
    return ifcopenshell.open(str(path))


@pytest.fixture(scope="module")
def parts(small: Gridshell) -> dict[str, Part]:
    return {part.mark: part for part in all_parts(small)}


def sets_of(ifc: File, mark: str) -> Mapping[str, Mapping[str, object]]:
    element = next(element for element in ifc.by_type("IfcElement") if element.Name == mark)
    sets: Mapping[str, Mapping[str, object]] = ifcopenshell.util.element.get_psets(element)
    return sets


def test_a_plank_says_how_it_is_made(small: Gridshell, ifc: File, parts: dict[str, Part]) -> None:
    plank = parts["S2-A1-02-L"]
    assert isinstance(plank, Plank)
    sets = sets_of(ifc, plank.mark)
    assert sets["Pset_MemberCommon"]["Reference"] == "Plank A1-02-L"
    made = sets["AAG_Fabrication"]
    assert (made["Mark"], made["Family"], made["Index"], made["Layer"]) == ("S2-A1-02-L", "A1", 2, plank.layer)
    assert made["BlankLength"] == pytest.approx(plank.blank.length, abs=1e-3)
    assert made["SmallestRadius"] == pytest.approx(smallest_radius(plank), abs=0.1)
    assert made["LargestTwistDegPerM"] == pytest.approx(deg_per_m(largest_twist(plank)), abs=1e-3)
    quantities = sets["Qto_MemberBaseQuantities"]
    bored = sum(math.pi / 4.0 * hole.diameter**2 * 12.0 for hole in plank.blank.holes)
    assert quantities["Length"] == pytest.approx(plank.blank.length, abs=1e-3)
    assert quantities["CrossSectionArea"] == pytest.approx(0.1 * 0.012)
    assert quantities["GrossVolume"] == pytest.approx(0.1 * 0.012 * plank.blank.length / 1000.0, rel=1e-6)
    gross, net = quantities["GrossVolume"], quantities["NetVolume"]
    assert isinstance(gross, float)
    assert isinstance(net, float)
    assert gross - net == pytest.approx(bored / 1e9, abs=2e-9)
    assert quantities["NetWeight"] == pytest.approx(mass(plank, small.timber), abs=1e-6)


def test_the_hole_table_of_a_plank_lists_every_hole(ifc: File, parts: dict[str, Part]) -> None:
    plank = parts["S3-G-02"]
    assert isinstance(plank, Plank)
    made = sets_of(ifc, plank.mark)["AAG_Fabrication"]
    lines = str(made["Holes"]).split("; ")
    assert made["HoleCount"] == len(lines) == len(plank.blank.holes) > 0
    for number, (line, hole) in enumerate(zip(lines, plank.blank.holes, strict=True), start=1):
        assert line.startswith(f"{number}: x {hole.station:.1f}, y ")
        assert line.endswith(f"d {hole.diameter:g} {hole.use} {hole.joint}")


def test_own_sets_do_not_pretend_to_be_standard(ifc: File) -> None:
    names = {definition.Name for definition in ifc.by_type("IfcPropertySetDefinition")}
    assert names == {"AAG_Fabrication", "Pset_MemberCommon", "Qto_MemberBaseQuantities"}


def test_every_part_has_its_material(small: Gridshell, ifc: File, parts: dict[str, Part]) -> None:
    names = {
        element.Name: ifcopenshell.util.element.get_material(element).Name
        for element in ifc.by_type("IfcElement")
        if not element.is_a("IfcElementAssembly")
    }
    assert names == {
        mark: "steel" if IFC_KINDS[type(part)].entity == "IfcMechanicalFastener" else "ash D50"
        for mark, part in parts.items()
    }


def standard_properties(file: File) -> Iterator[tuple[str, str, str, str]]:
    """Yield (set, property, entity that has it, measure) of every property and quantity in a standard set."""
    for relation in file.by_type("IfcRelDefinesByProperties"):
        definition = relation.RelatingPropertyDefinition
        if definition.is_a("IfcElementQuantity"):
            rows = [(each.Name, each.is_a()) for each in definition.Quantities]
        else:
            rows = [(each.Name, each.NominalValue.is_a()) for each in definition.HasProperties]
        if definition.Name != "AAG_Fabrication":
            for name, measure in rows:
                yield definition.Name, name, relation.RelatedObjects[0].is_a(), measure
    for each in file.by_type("IfcMaterialProperties"):
        for value in each.Properties:
            yield each.Name, value.Name, "IfcMaterial", value.NominalValue.is_a()


def test_standard_sets_hold_what_the_standard_says(ifc: File) -> None:
    """Against the set templates of IFC4: the property exists, applies to the entity and has the measure."""
    templates = ifcopenshell.util.pset.PsetQto("IFC4")
    seen = set()
    for title, name, entity, measure in standard_properties(ifc):
        template = templates.get_by_name(title)
        assert title in templates.get_applicable_names(entity, "Wood" if title == "Pset_MaterialWood" else "")
        row = next(each for each in template.HasPropertyTemplates if each.Name == name)
        assert measure == (QUANTITIES[row.TemplateType] if title.startswith("Qto_") else row.PrimaryMeasureType)
        seen.add(title)
    assert seen == {
        "Pset_MemberCommon", "Qto_MemberBaseQuantities",
        "Pset_MaterialCommon", "Pset_MaterialWood", "Pset_MaterialMechanical",
    }  # fmt: skip
