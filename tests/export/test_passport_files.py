"""The passports as files, read back by json, csv and pypdf, against the model that they were written from."""

import csv
import io
import json
import math
from pathlib import Path
from typing import Any

import pypdf
import pytest

from aag_cad.export.workshop.passports import passports_pdf, write_passports
from aag_cad.parts.model import Gridshell, Plank
from aag_cad.parts.quantities import largest_twist, smallest_radius
from aag_cad.shop.passports import REUSE_HEADER, passports
from aag_cad.units import deg_per_m


@pytest.fixture(scope="module")
def folder(gridshell: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("passports")
    write_passports(gridshell, folder / "passports.json", folder / "passports.pdf", folder / "reuse.csv")
    return folder


@pytest.fixture(scope="module")
def planks(gridshell: Gridshell) -> dict[str, Plank]:
    return {plank.mark: plank for shell in gridshell.shells for plank in shell.planks}


@pytest.fixture(scope="module")
def data(folder: Path) -> dict[str, Any]:
    read: dict[str, Any] = json.loads((folder / "passports.json").read_text(encoding="utf-8"))
    return read


@pytest.fixture(scope="module")
def pages(folder: Path) -> list[str]:
    return [page.extract_text() for page in pypdf.PdfReader(folder / "passports.pdf").pages]


def test_the_json_holds_every_plank_by_mark(data: dict[str, Any], planks: dict[str, Plank]) -> None:
    assert (data["schema_version"], data["design"], data["title"]) == (1, "vault", "Timber Vault")
    assert [each["mark"] for each in data["planks"]] == sorted(planks)
    assert {each["service_life_years"] for each in data["planks"]} == {2.0}


def test_every_hole_is_in_the_history_of_its_plank(data: dict[str, Any], planks: dict[str, Plank]) -> None:
    """Printed to 0.001 mm."""
    for each in data["planks"]:
        blank = planks[each["mark"]].blank
        assert each["length_mm"] == pytest.approx(blank.length, abs=0.00051)
        assert len(each["holes"]) == len(blank.holes)
        for read, hole in zip(each["holes"], blank.holes, strict=True):
            assert read["station_mm"] == pytest.approx(hole.station, abs=0.00051)
            assert read["offset_mm"] == pytest.approx(hole.offset, abs=0.00051)
            assert (read["diameter_mm"], read["slot_mm"]) == (hole.diameter, hole.slot)
            assert (read["use"], read["joint"]) == (hole.use, hole.joint)


def test_curvature_in_the_json_is_that_of_the_part_list(data: dict[str, Any], planks: dict[str, Plank]) -> None:
    """Printed to 0.1 mm of radius and 0.001 deg/m."""
    for each in data["planks"][::7]:
        plank = planks[each["mark"]]
        radius = smallest_radius(plank)
        assert (each["smallest_radius_mm"] or math.inf) == pytest.approx(radius, abs=0.051)
        assert each["largest_twist_deg_per_m"] == pytest.approx(deg_per_m(largest_twist(plank)), abs=0.00051)
        assert (each["largest_twist_at_mm"] is None) == (deg_per_m(largest_twist(plank)) < 0.01)


def test_clear_stretches_and_holes_make_up_the_whole_plank(data: dict[str, Any]) -> None:
    """No two holes of the vault overlap along the plank but those of one joint: what is left is less than each hole."""
    for each in data["planks"]:
        lengths = [stretch["length_mm"] for stretch in each["clear_stretches"]]
        assert lengths == sorted(lengths, reverse=True)
        bored = sum(hole["diameter_mm"] + hole["slot_mm"] for hole in each["holes"])
        assert each["length_mm"] - bored - 0.1 <= sum(lengths) < each["length_mm"] or not each["holes"]


def test_the_next_design_reads_every_plank_as_stock(folder: Path, planks: dict[str, Plank]) -> None:
    """Printed to 0.1 mm."""
    text = (folder / "reuse.csv").read_bytes().decode("ascii")
    assert "\r" not in text
    assert text.endswith("\n")
    lines = list(csv.reader(io.StringIO(text), strict=True))
    assert tuple(lines[0]) == REUSE_HEADER
    assert text.splitlines()[0] == "mark,length_mm,width_mm,thickness_mm,species,strength_class,holes"
    assert [line[0] for line in lines[1:]] == sorted(planks)
    for mark, length, width, thickness, species, strength, holes in lines[1:]:
        blank = planks[mark].blank
        assert (width, thickness, species, strength) == ("100", "12", "ash", "D50")
        assert float(length) == pytest.approx(blank.length, abs=0.051)
        read = [tuple(map(float, item.split(":"))) for item in holes.split(";") if item]
        assert len(read) == len(blank.holes)
        for (station, offset, diameter), hole in zip(read, blank.holes, strict=True):
            assert station == pytest.approx(hole.station, abs=0.051)
            assert offset == pytest.approx(hole.offset, abs=0.051)
            assert diameter == hole.diameter + hole.slot


def test_the_booklet_has_each_mark_once_on_a4_sheets(folder: Path, pages: list[str], planks: dict[str, Plank]) -> None:
    lines = [line.strip() for page in pages for line in page.splitlines()]
    assert all(lines.count(mark) == 1 for mark in planks)
    for page in pypdf.PdfReader(folder / "passports.pdf").pages:
        size = [float(side) / 72.0 * 25.4 for side in (page.mediabox.width, page.mediabox.height)]
        assert size == pytest.approx([210.0, 297.0], abs=0.1)
    assert len(planks) / len(pages) > 3.0


def test_a_passport_prints_length_and_first_hole_of_its_plank(pages: list[str], planks: dict[str, Plank]) -> None:
    for mark in ("S1-A1-05-L", "S2-G-07", "S3-E-01"):
        page = next(page for page in pages if mark in page.splitlines())
        card = page[page.index(mark) :]
        blank = planks[mark].blank
        assert f"{blank.length:.1f} mm long" in card
        assert f"{blank.holes[0].station:.1f}" in card


def test_the_same_gridshell_gives_the_same_bytes(gridshell: Gridshell, folder: Path) -> None:
    assert passports_pdf(passports(gridshell), gridshell) == (folder / "passports.pdf").read_bytes()
