"""The requirements shipped for a receiving office (templates/ids/aag.ids), checked with ifctester."""

from collections.abc import Callable
from pathlib import Path

import ifcopenshell
import pytest
from ifctester import ids
from test_ifc_sample import sampled, sampled_work

from aag_cad.export.ifc.model import write_ifc
from aag_cad.export.ifc.options import IFC_SCHEMAS, IfcOptions, IfcSchema
from aag_cad.parts.model import Gridshell
from aag_cad.resources import template


@pytest.fixture(scope="module")
def paths(gridshell: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> dict[IfcSchema, Path]:
    folder, sample = tmp_path_factory.mktemp("ids"), sampled(gridshell, of_a_kind=1)
    work = sampled_work(gridshell, sample)
    for schema in IFC_SCHEMAS:
        write_ifc(sample, folder / f"{schema}.ifc", work, IfcOptions(schema=schema))
    return {schema: folder / f"{schema}.ifc" for schema in IFC_SCHEMAS}


def failed(file: ifcopenshell.file) -> set[str]:
    """Return the names of the specifications that a file does not meet."""
    with template("ids/aag.ids").open("rb") as source:
        specifications = ids.from_string(source.read().decode("utf-8"))
    specifications.validate(file)
    return {each.name for each in specifications.specifications if not each.status}


@pytest.mark.parametrize("schema", IFC_SCHEMAS)
def test_the_file_meets_the_requirements(paths: dict[IfcSchema, Path], schema: IfcSchema) -> None:
    assert failed(ifcopenshell.open(str(paths[schema]))) == set()


def _remove(name: str, title: str, entity: str = "IfcMember") -> Callable[[ifcopenshell.file], None]:
    """Return what takes one property out of the first set of that name that an entity has."""

    def damage(file: ifcopenshell.file) -> None:
        sets = [
            relation.RelatingPropertyDefinition
            for relation in file.by_type("IfcRelDefinesByProperties")
            if relation.RelatedObjects[0].is_a(entity) and relation.RelatingPropertyDefinition.Name == name
        ]
        file.remove(next(row for row in sets[0].HasProperties if row.Name == title))

    return damage


def _misprint_a_mark(file: ifcopenshell.file) -> None:
    row = next(row for row in file.by_type("IfcPropertySingleValue") if row.Name == "Mark")
    row.NominalValue.wrappedValue = "S1-X-01"


def _take_a_material_away(file: ifcopenshell.file) -> None:
    file.remove(file.by_type("IfcRelAssociatesMaterial")[0])


PIECES, PLANKS = "Pieces carry their mark and make", "Planks say how they are cut, drilled and bent"
HOLES, FASTENERS = "Drilled planks carry their hole table", "Fasteners say what they are"
STEPS, MATERIALS = "Every part knows its segment and step", "Every part has a material"


@pytest.mark.parametrize(
    ("damage", "name"),
    [
        (_remove("AAG_Fabrication", "Mark"), PIECES),
        (_remove("AAG_Fabrication", "NetWeight"), PIECES),
        (_misprint_a_mark, PIECES),
        (_remove("AAG_Fabrication", "DrillingGroup"), PLANKS),
        (_remove("AAG_Fabrication", "BlankLength"), PLANKS),
        (_remove("AAG_Fabrication", "Holes"), HOLES),
        (_remove("AAG_Fabrication", "Length", "IfcMechanicalFastener"), FASTENERS),
        (_remove("AAG_Assembly", "Step"), STEPS),
        (_remove("AAG_Assembly", "Segment"), STEPS),
        (_take_a_material_away, MATERIALS),
    ],
)
def test_a_file_with_one_thing_missing_fails(
    paths: dict[IfcSchema, Path], damage: Callable[[ifcopenshell.file], None], name: str
) -> None:
    file = ifcopenshell.open(str(paths["IFC4"]))
    damage(file)
    assert name in failed(file)
