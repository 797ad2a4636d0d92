"""From the IFC file alone the part list and the hole list can be written again."""

import math
import re
from collections.abc import Mapping
from typing import Any

import ifcopenshell
import ifcopenshell.util.element
import pytest
from making import work_of

from aag_cad.export.ifc.model import ifc_model
from aag_cad.export.ifc.schedule import PlannedWork
from aag_cad.export.office.tables import hole_rows, part_row
from aag_cad.parts.model import Gridshell, Plank, all_parts
from aag_cad.parts.quantities import mass, sizes

HOLE = re.compile(
    r"(?P<number>\d+): x (?P<x>[\d.]+), y (?P<y>[+-][\d.]+), d (?P<d>[\d.]+)( slot [\d.]+)? (?P<use>\w+) (?P<joint>\S+)"
)
# Columns of the table that are numbers: a figure on the edge between two printed ones may fall either way.
LENGTH, MASS, RADIUS, TWIST = 6, 10, 11, 12


@pytest.fixture(scope="module")
def work(gridshell: Gridshell) -> PlannedWork:
    return work_of(gridshell, 6)


@pytest.fixture(scope="module")
def file(gridshell: Gridshell, work: PlannedWork) -> ifcopenshell.file:
    return ifcopenshell.file.from_string(ifc_model(gridshell, work).file.to_string())


@pytest.fixture(scope="module")
def elements(file: ifcopenshell.file) -> Mapping[str, ifcopenshell.entity_instance]:
    """Give the parts by name; they live as long as their file."""
    return {each.Name: each for each in file.by_type("IfcElement") if not each.is_a("IfcElementAssembly")}


def read_part(element: ifcopenshell.entity_instance) -> tuple[str, ...]:
    """Return a line of the part table as the file tells it."""
    made: dict[str, Any] = ifcopenshell.util.element.get_pset(element, "AAG_Fabrication")
    blank = "Blank" if "BlankLength" in made else ""
    mark, whole = element.Name, ifcopenshell.util.element.get_aggregate(element)
    (material,) = ifcopenshell.util.element.get_materials(element)
    segment = ifcopenshell.util.element.get_pset(element, "AAG_Assembly", "Segment")
    twist, radius = made.get("LargestTwistDegPerM"), made.get("SmallestRadius", math.inf)
    return (
        mark,
        made["Kind"],
        ifcopenshell.util.element.get_type(element).Name,
        made.get("Family") or mark.split("-")[1 if mark.startswith("S") else 0],
        "" if "-" in segment else segment,
        whole.Name if made["Kind"] == "plank" and whole.ObjectType == "Coupled beam" else "",
        f"{made[blank + 'Length']:.1f}",
        f"{made[blank + 'Width']:g}",
        f"{made[blank + 'Thickness']:g}",
        str(made["HoleCount"]),
        f"{made['NetWeight']:.4f}",
        "" if math.isinf(radius) else f"{radius:.0f}",
        "" if twist is None else f"{twist:.2f}",
        material.Name,
        "1",
    )


def test_the_part_list_can_be_written_from_the_file(
    gridshell: Gridshell, elements: Mapping[str, ifcopenshell.entity_instance]
) -> None:
    assert set(elements) == {part.mark for part in all_parts(gridshell)}
    for part in all_parts(gridshell):
        read, row = read_part(elements[part.mark]), part_row(part, gridshell)
        numbers = {LENGTH, MASS, RADIUS, TWIST}
        assert [value for i, value in enumerate(read) if i not in numbers] == [
            value for i, value in enumerate(row) if i not in numbers
        ]
        for i, last in ((LENGTH, 0.1), (MASS, 1e-4), (RADIUS, 1.0), (TWIST, 0.01)):
            if read[i] != row[i]:
                assert abs(float(read[i]) - float(row[i])) == pytest.approx(last, rel=1e-6), part.mark


def test_lengths_and_masses_come_back_to_the_rounding_of_the_file(
    gridshell: Gridshell, elements: Mapping[str, ifcopenshell.entity_instance]
) -> None:
    for part in all_parts(gridshell):
        made = ifcopenshell.util.element.get_pset(elements[part.mark], "AAG_Fabrication")
        assert made.get("BlankLength", made.get("Length")) == pytest.approx(sizes(part)[0], abs=1e-3)
        assert made["NetWeight"] == pytest.approx(mass(part, gridshell.timber), abs=1e-6)


def test_the_hole_list_can_be_written_from_the_file(
    gridshell: Gridshell, elements: Mapping[str, ifcopenshell.entity_instance]
) -> None:
    for plank in (part for part in all_parts(gridshell) if isinstance(part, Plank)):
        table = ifcopenshell.util.element.get_pset(elements[plank.mark], "AAG_Fabrication", "Holes")
        found = [HOLE.fullmatch(line) for line in table.split("; ")]
        rows = [
            (plank.mark, hole["number"], hole["x"], f"{float(hole['y']):.1f}", hole["d"], hole["use"], hole["joint"])
            for hole in found
            if hole
        ]
        assert rows == [row[:7] for row in hole_rows(plank)]


def test_the_plan_can_be_read_from_the_file(
    elements: Mapping[str, ifcopenshell.entity_instance], work: PlannedWork
) -> None:
    read: dict[tuple[int, str], set[str]] = {}
    for mark, element in elements.items():
        row = ifcopenshell.util.element.get_pset(element, "AAG_Assembly")
        read.setdefault((row["StepNumber"], row["Step"]), set()).add(mark)
    assert read == {(step.number, step.id): set(step.marks) for step in work.plan.steps if step.marks}
