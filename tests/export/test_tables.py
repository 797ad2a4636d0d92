"""The tables, read back with the csv module, against the model that they were written from."""

import csv
import math
from itertools import pairwise
from pathlib import Path

import pytest

from aag_cad.export.office.tables import HOLES_HEADER, PARTS_HEADER, write_tables
from aag_cad.parts.model import Gridshell, all_parts
from aag_cad.parts.quantities import largest_twist, mass, smallest_radius
from aag_cad.units import deg_per_m


@pytest.fixture(scope="module")
def folder(gridshell: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("tables")
    write_tables(gridshell, folder)
    return folder


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file, strict=True))


@pytest.fixture(scope="module")
def parts(folder: Path) -> dict[str, dict[str, str]]:
    return {row["mark"]: row for row in rows(folder / "parts.csv")}


@pytest.fixture(scope="module")
def holes(folder: Path) -> dict[str, list[dict[str, str]]]:
    by_plank: dict[str, list[dict[str, str]]] = {}
    for row in rows(folder / "holes.csv"):
        by_plank.setdefault(row["mark"], []).append(row)
    return by_plank


@pytest.mark.parametrize(("name", "header"), [("parts.csv", PARTS_HEADER), ("holes.csv", HOLES_HEADER)])
def test_a_table_is_plain_csv_with_a_header_line_feeds_and_one_width(
    folder: Path, name: str, header: tuple[str, ...]
) -> None:
    data = (folder / name).read_bytes()
    assert b"\r" not in data
    assert data.endswith(b"\n")
    lines = list(csv.reader(data.decode("ascii").splitlines(), strict=True))
    assert tuple(lines[0]) == header
    assert {len(line) for line in lines} == {len(header)}
    marks = [line[0] for line in lines[1:]]
    assert marks == sorted(marks)


def test_every_part_of_the_model_has_one_line(
    gridshell: Gridshell, parts: dict[str, dict[str, str]], folder: Path
) -> None:
    assert set(parts) == {part.mark for part in all_parts(gridshell)}
    assert len(rows(folder / "parts.csv")) == len(parts) == len(all_parts(gridshell))
    assert {row["quantity"] for row in parts.values()} == {"1"}


def test_the_vault_has_sixty_six_coupled_beams_and_forty_two_geodesics(parts: dict[str, dict[str, str]]) -> None:
    """The paper, section 3.1 and figure 8: 66 pre-curved beams, 14 geodesic planks in each of three shells."""
    planks = [row for row in parts.values() if row["kind"] == "plank"]
    beams = [row["beam"] for row in planks if row["family"] in ("A1", "A2")]
    assert len(set(beams)) == 66
    assert all(beams.count(beam) == 2 for beam in beams)
    assert sum(row["family"] == "G" for row in planks) == 42


def test_sizes_masses_and_strain_of_planks_are_those_of_the_model(
    gridshell: Gridshell, parts: dict[str, dict[str, str]]
) -> None:
    """Printed to 0.1 mm, 0.1 g, 1 mm of radius and 0.01 deg/m: half a unit of the last digit is allowed."""
    for plank in (plank for shell in gridshell.shells for plank in shell.planks):
        row = parts[plank.mark]
        assert float(row["length_mm"]) == pytest.approx(plank.blank.length, abs=0.051)
        assert (row["width_mm"], row["thickness_mm"]) == ("100", "12")
        assert int(row["holes"]) == len(plank.blank.holes)
        assert float(row["mass_kg"]) == pytest.approx(mass(plank, gridshell.timber), abs=0.51e-4)
        radius = smallest_radius(plank)
        assert float(row["min_radius_mm"] or math.inf) == pytest.approx(radius, abs=0.51)
        assert float(row["max_twist_deg_per_m"]) == pytest.approx(deg_per_m(largest_twist(plank)), abs=0.0051)


def test_words_of_a_line_say_what_a_part_is(parts: dict[str, dict[str, str]]) -> None:
    plank = parts["S2-A1-07-L"]
    assert [plank[key] for key in ("kind", "product", "family", "shell", "beam", "material")] == [
        "plank", "Plank A1-07-L", "A1", "S2", "S2-A1-07", "ash D50",
    ]  # fmt: skip
    bolt = parts["S1-N-001-B1"]
    assert [bolt[key] for key in ("kind", "shell", "beam", "holes", "min_radius_mm", "material")] == [
        "bolt", "S1", "", "0", "", "steel",
    ]  # fmt: skip
    assert parts["S3-N-001"]["product"] == "Hexagon stud 24 x 220"


def test_the_masses_add_up_to_the_total_of_the_model(gridshell: Gridshell, parts: dict[str, dict[str, str]]) -> None:
    total = sum(mass(part, gridshell.timber) for part in all_parts(gridshell))
    assert sum(float(row["mass_kg"]) for row in parts.values()) == pytest.approx(total, abs=0.51e-4 * len(parts))


def test_every_hole_has_one_line_in_the_order_of_a_tape_along_the_plank(
    gridshell: Gridshell, holes: dict[str, list[dict[str, str]]]
) -> None:
    for plank in (plank for shell in gridshell.shells for plank in shell.planks):
        lines = holes.get(plank.mark, [])
        assert [int(line["number"]) for line in lines] == list(range(1, len(plank.blank.holes) + 1))
        for line, hole in zip(lines, plank.blank.holes, strict=True):
            assert float(line["station_mm"]) == pytest.approx(hole.station, abs=0.051)
            assert float(line["offset_mm"]) == pytest.approx(hole.offset, abs=0.051)
            assert float(line["diameter_mm"]) == hole.diameter
            assert (line["use"], line["joint"]) == (hole.use, hole.joint)
    assert set(holes) <= {plank.mark for shell in gridshell.shells for plank in shell.planks}


def test_spacings_are_the_differences_of_the_printed_stations(folder: Path) -> None:
    lines = rows(folder / "holes.csv")
    for before, line in pairwise(lines):
        if line["mark"] != before["mark"]:
            assert line["spacing_mm"] == ""
        else:
            difference = float(line["station_mm"]) - float(before["station_mm"])
            assert float(line["spacing_mm"]) == pytest.approx(difference, abs=1e-6)
            assert difference >= 0.0


def test_no_figure_is_printed_as_negative_zero(folder: Path) -> None:
    values = [value for row in rows(folder / "holes.csv") for value in row.values()]
    assert "-0.0" not in values
    assert "0.0" in values


def test_the_same_gridshell_gives_the_same_bytes(gridshell: Gridshell, folder: Path, tmp_path: Path) -> None:
    write_tables(gridshell, tmp_path)
    for name in ("parts.csv", "holes.csv", "checks.csv"):
        assert (tmp_path / name).read_bytes() == (folder / name).read_bytes()
