"""A new kind of part is its class, its row, its placement and its words; everything else finds it in the table.

A steel packing plate lies on each concrete block, round the threaded rod that carries the shoe.
"""

import csv
import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import ifcopenshell
import pytest
import trimesh

from aag_cad.colours import LEGEND, linear
from aag_cad.design import Design, design_text, parse_design
from aag_cad.errors import FileError
from aag_cad.language import words_table
from aag_cad.network.model import CurveNetwork
from aag_cad.parts import build as building
from aag_cad.parts.clash import clashes
from aag_cad.parts.forms import FoldedPlate, Frame, PlateHole
from aag_cad.parts.kinds import KINDS, Bought, IfcKind, Kind
from aag_cad.parts.marks import Mark, parse_mark
from aag_cad.parts.model import Gridshell, Joint, Shell, all_parts
from aag_cad.parts.quantities import mass
from aag_cad.parts.shapes.folded_plate import FOLDED_PLATE
from aag_cad.parts.store import gridshell_json, read_gridshell
from aag_cad.pipeline import Build, build

SIDE, THICKNESS, HOLE = 120.0, 6.0, 18.0


@dataclass(frozen=True)
class PackingPlate:
    """A flat steel plate under a shoe, on the block: the origin of its frame is the middle of its lower face."""

    mark: str
    frame: Frame
    plate: FoldedPlate


ROW = Kind(
    PackingPlate, "packing", "packing plate", "Packing plate {width:g} x {thickness:g}", "more", "U", FOLDED_PLATE,
    lambda packing: packing.plate, "steel", "steel", IfcKind("IfcDiscreteAccessory", "USERDEFINED", "Packing plate"),
    Bought("piece", "steel plate, cut to a packing plate", "EN 10025-2"), "connector", "ground", minutes="shoe",
    outlined=True,
)  # fmt: skip
WORDS = {"en": "Packing plate {width} x {thick}", "de": "Futterblech {width} x {thick}"}


def packed(design: Design, network: CurveNetwork, shell: Shell) -> Shell:
    """Return a shell with a packing plate on every block, as one more member of the joint of its shoe and block."""
    middle = ((-SIDE / 2.0, THICKNESS / 2.0), (SIDE / 2.0, THICKNESS / 2.0))
    plate = FoldedPlate(middle, SIDE, THICKNESS, (PlateHole(SIDE / 2.0, 0.0, HOLE),))
    plates = {
        footing.mark: PackingPlate(str(Mark(1, "U", parse_mark(footing.mark).index)), footing.frame, plate)
        for footing in shell.footings
    }

    def joined(joint: Joint) -> Joint:
        return replace(joint, members=(*joint.members, plates[joint.mark].mark)) if joint.mark in plates else joint

    return replace(shell, more=tuple(plates.values()), joints=tuple(map(joined, shell.joints)))


@pytest.fixture(scope="module")
def made() -> Iterator[None]:
    """The kind as long as these tests run."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(KINDS, PackingPlate, ROW)
        patch.setitem(words_table("parts")["names"], ROW.key, WORDS)
        patch.setattr(building, "ADDITIONS", [*building.ADDITIONS, packed])
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("packed")


@pytest.fixture(scope="module")
def built(made: None, folder: Path) -> Build:
    """A vault on six geodesics a shell, with packing plates, in all files that hold parts."""
    text = design_text("vault")
    text = text.replace("geodesics = 14 ", "geodesics = 6 ")
    outputs = ("gridshell", "step", "ifc", "glb", "tables", "shop", "labels", "plan", "schedule", "sequence")
    return build(parse_design(text), folder, outputs)


@pytest.fixture(scope="module")
def gridshell(built: Build) -> Gridshell:
    return built.model.gridshell


@pytest.fixture(scope="module")
def plates(gridshell: Gridshell) -> list[PackingPlate]:
    return [part for part in all_parts(gridshell) if isinstance(part, PackingPlate)]


def test_every_shell_has_a_plate_on_each_block(gridshell: Gridshell, plates: list[PackingPlate]) -> None:
    """Copies of the first shell have their own marks, by the letter of the row."""
    assert [plate.mark for plate in plates] == [
        f"{shell.mark}-U-{number:02d}" for shell in gridshell.shells for number in range(1, len(shell.footings) + 1)
    ]
    assert parse_mark(plates[0].mark) == Mark(1, "U", 1)


def test_gridshell_json_brings_it_back(built: Build, folder: Path, gridshell: Gridshell) -> None:
    text = (folder / "gridshell.json").read_text(encoding="utf-8")
    assert read_gridshell(text) == gridshell
    assert gridshell_json(gridshell) == text
    with pytest.raises(FileError, match=r"shells\[0\].more\[0\]: kind 'wafer' is none of plank, stud"):
        read_gridshell(text.replace('"packing plate"', '"wafer"'))


def test_step_places_it_as_one_product(built: Build, folder: Path, plates: list[PackingPlate]) -> None:
    text = (folder / "vault.step").read_text(encoding="ascii")
    assert text.count("PRODUCT('Packing plate 120 x 6'") == 1
    assert all(f"'{plate.mark}'" in text for plate in plates)


def test_ifc_has_it_with_entity_type_material_set_and_joint(
    built: Build, folder: Path, plates: list[PackingPlate]
) -> None:
    ifc = ifcopenshell.open(str(folder / "vault.ifc"))
    found = {element.Name: element for element in ifc.by_type("IfcDiscreteAccessory")}
    assert {plate.mark for plate in plates} <= set(found)
    element = found[plates[0].mark]
    kind = element.IsTypedBy[0].RelatingType
    assert (kind.Name, kind.PredefinedType) == ("Packing plate 120 x 6", "USERDEFINED")
    assert kind.ElementType == "Packing plate"
    materials = [each.RelatingMaterial.Name for each in element.HasAssociations]
    assert materials == ["steel"]
    defined = (relation.RelatingPropertyDefinition for relation in element.IsDefinedBy)
    (fabrication,) = (each for each in defined if each.Name == "AAG_Fabrication")
    values = {each.Name: each.NominalValue.wrappedValue for each in fabrication.HasProperties}
    assert (values["Kind"], values["Holes"]) == ("packing plate", f"1: x 60.0, y +0.0, d {HOLE:g}")
    joined = [r for r in ifc.by_type("IfcRelConnectsElements") if element in (r.RelatingElement, r.RelatedElement)]
    assert {relation.Name for relation in joined} == {"S1-C-01"}
    tasks = [r.RelatingProcess.Identification for r in element.HasAssignments if r.is_a("IfcRelAssignsToProcess")]
    assert tasks == ["site.feet"]


def test_glb_shows_it_in_the_colour_of_steel(built: Build, folder: Path, plates: list[PackingPlate]) -> None:
    scene = trimesh.load(folder / "vault.glb", force="scene")
    geometries = {scene.graph[plate.mark][1] for plate in plates}
    assert len(geometries) == 1
    mesh = scene.geometry[geometries.pop()]
    assert mesh.is_watertight
    assert mesh.volume * 1e9 == pytest.approx(SIDE**2 * THICKNESS, rel=1e-4)
    assert mesh.visual.material.baseColorFactor[:3] / 255.0 == pytest.approx(linear(LEGEND["steel"]), abs=0.003)


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_the_part_list_has_a_line_for_each(built: Build, folder: Path, plates: list[PackingPlate]) -> None:
    listed = {row["mark"]: row for row in rows(folder / "tables" / "parts.csv")}
    line = listed[plates[0].mark]
    assert {plate.mark for plate in plates} <= set(listed)
    assert (line["kind"], line["product"], line["holes"], line["material"]) == (
        "packing plate", "Packing plate 120 x 6", "1", "steel",
    )  # fmt: skip
    assert (line["length_mm"], line["width_mm"], line["thickness_mm"]) == ("120.0", "120", "6")


def test_it_is_bought_by_the_piece(built: Build, folder: Path, plates: list[PackingPlate]) -> None:
    (line,) = [row for row in rows(folder / "tables" / "purchases.csv") if "packing" in row["item"]]
    assert (line["item"], line["size_mm"]) == ("steel plate, cut to a packing plate", "6 x 120 x 120")
    assert (line["standard"], line["quantity"]) == ("EN 10025-2", str(len(plates)))


def test_the_summary_counts_and_weighs_it(built: Build, gridshell: Gridshell, plates: list[PackingPlate]) -> None:
    weight = mass(plates[0], gridshell.timber)
    assert weight == pytest.approx((SIDE**2 - 3.14159265 * HOLE**2 / 4.0) * THICKNESS * 7850e-9, rel=1e-6)
    assert built.summary["counts"]["packing plates"] == len(plates)
    ours = len(plates) // len(gridshell.shells)
    assert built.summary["mass_per_shell_kg"]["S1"]["packing plates"] == pytest.approx(ours * weight, abs=0.005)


def test_the_clash_test_sees_it(gridshell: Gridshell, plates: list[PackingPlate]) -> None:
    """On the block it touches nothing; sunk by 2 mm it is found in the block."""
    marks = {plate.mark for plate in plates}
    assert not [c for c in clashes(gridshell, 0.1) if {c.first, c.second} & marks]
    first, x = gridshell.shells[0], plates[0].frame.origin
    sunk = replace(plates[0], frame=replace(plates[0].frame, origin=(x[0], x[1], x[2] - 2.0)))
    moved = replace(gridshell, shells=(replace(first, more=(sunk, *first.more[1:])), *gridshell.shells[1:]))
    (clash,) = [c for c in clashes(moved, 0.1) if {c.first, c.second} & marks]
    assert {clash.first, clash.second} == {sunk.mark, "S1-C-01"}
    assert clash.depth == pytest.approx(2.0, abs=1e-6)


def test_the_plan_sets_it_with_the_feet(built: Build, folder: Path, plates: list[PackingPlate]) -> None:
    told: dict[str, Any] = json.loads((folder / "plan.json").read_text(encoding="utf-8"))
    steps = [planned["step"] for planned in told["steps"]]
    marks = {plate.mark for plate in plates}
    assert [step["id"] for step in steps if marks & set(step["marks"])] == ["site.feet"]
    (pieces,) = [piece for piece in told["pieces"] if marks & set(piece["marks"])]
    assert set(pieces["marks"]) == marks
    assert pieces["name"] == {"en": "Packing plate 120 x 6", "de": "Futterblech 120 x 6"}


def test_the_card_of_that_step_lists_it_in_the_language_of_the_booklet(built: Build, folder: Path) -> None:
    page = (folder / "sequence.html").read_text(encoding="utf-8")
    assert "Packing plate 120 x 6" in page


def test_taking_down_takes_it_away(built: Build, plates: list[PackingPlate]) -> None:
    leaving = {mark for step in built.planned.down.steps for mark in step.marks}
    assert {plate.mark for plate in plates} <= leaving
    assert not [finding for finding in built.planned.findings if finding.severity == "error"]
