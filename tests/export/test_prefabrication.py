"""The tables for making beams, read back with the csv module, against model and closed forms."""

import csv
import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from aag_cad.errors import FileError
from aag_cad.export.workshop.prefabrication import (
    DRILLING_HEADER,
    PREFABRICATION_HEADER,
    write_prefabrication,
)
from aag_cad.geometry.framed import curvatures_at
from aag_cad.parts.model import Gridshell


@pytest.fixture(scope="module")
def folder(gridshell: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("prefabrication")
    write_prefabrication(gridshell, folder)
    return folder


def _rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file, strict=True))


@pytest.fixture(scope="module")
def beams(folder: Path) -> dict[str, dict[str, str]]:
    return {row["beam"]: row for row in _rows(folder / "prefabrication.csv")}


@pytest.mark.parametrize(
    ("name", "header"), [("prefabrication.csv", PREFABRICATION_HEADER), ("drilling.csv", DRILLING_HEADER)]
)
def test_a_table_is_plain_csv_sorted_by_beam(folder: Path, name: str, header: tuple[str, ...]) -> None:
    data = (folder / name).read_bytes()
    assert b"\r" not in data
    lines = list(csv.reader(data.decode("ascii").splitlines(), strict=True))
    assert tuple(lines[0]) == header
    assert {len(line) for line in lines} == {len(header)}
    marks = [line[0] for line in lines[1:]]
    assert marks == sorted(marks)
    assert not re.search(r"(^|,)-0\.0(,|$)|nan|inf", data.decode(), re.MULTILINE)


def test_sixty_six_beams_have_a_line_and_shells_are_alike(beams: dict[str, dict[str, str]]) -> None:
    assert len(beams) == 66
    for mark, row in beams.items():
        twin = beams["S1" + mark[2:]]
        ours = {key: value for key, value in row.items() if key not in ("beam", "upper_plank")}
        assert ours == {key: twin[key] for key in ours}
        assert row["upper_plank"] in (f"{mark}-L", f"{mark}-R")


def test_a_beams_difference_is_36_mm_times_its_turn(gridshell: Gridshell, beams: dict[str, dict[str, str]]) -> None:
    """The turn is summed here by the trapezoidal rule from first to last joint of the beam, 0.1 mm is printed."""
    for beam in gridshell.shells[1].beams:
        joints = [joint.station for joint in beam.joints if "-N-" in joint.joint or "-K-" in joint.joint]
        # A block that is shifted to be flush with the end takes its bolt along: there the ends are 40 mm apart.
        stations = np.linspace(joints[0], joints[-1], 801)
        turn = float(np.trapezoid(curvatures_at(beam.curve, stations).geodesic, stations))
        shift = 36.0 * 40.0 * float(np.abs(curvatures_at(beam.curve, stations).geodesic).max())
        assert float(beams[beam.mark]["right_minus_left_mm"]) == pytest.approx(36.0 * turn, abs=0.05 + shift)


def test_the_sprung_sagitta_is_27_28ths_of_the_target(beams: dict[str, dict[str, str]]) -> None:
    """Printed to 0.1 mm; arcs in the bays of a long beam are worth up to half a percent."""
    for row in beams.values():
        target, sprung = float(row["target_sagitta_mm"]), float(row["sprung_sagitta_mm"])
        assert sprung == pytest.approx(27.0 / 28.0 * target, rel=5e-3, abs=0.1)
        assert float(row["over_drilled_deviation_mm"]) < 0.6


def test_stands_and_overhangs_add_up_to_the_length(beams: dict[str, dict[str, str]]) -> None:
    for row in beams.values():
        figures = [float(row[key]) for key in ("overhang_start_mm", "stand_spacing_mm", "overhang_end_mm")]
        assert sum(figures) == pytest.approx(float(row["length_mm"]), abs=0.6)
        assert all(figure % 10.0 == 0.0 for figure in (figures[0], figures[2]))
        assert 0.0 < float(row["sag_mm"]) < 0.1 * figures[1]


def test_every_bolt_hole_of_a_beam_is_drilled_where_the_blanks_say(gridshell: Gridshell, folder: Path) -> None:
    rows = _rows(folder / "drilling.csv")
    for shell in gridshell.shells:
        for plank in (plank for plank in shell.planks if plank.beam):
            side = "left" if plank.mark.endswith("L") else "right"
            listed = sorted(
                (float(row[f"{side}_mm"]), float(row[f"{side}_offset_mm"]), row["joint"])
                for row in rows
                if row["beam"] == plank.beam
            )
            bolts = (hole for hole in plank.blank.holes if hole.use == "bolt")
            expected = sorted((round(h.station, 1), round(h.offset, 1), h.joint) for h in bolts)
            assert listed == expected


def test_over_drilling_makes_the_difference_grow_by_a_27th(folder: Path) -> None:
    """From joint to joint along each row of bolts, as printed to 0.1 mm: four roundings of 0.05 mm."""
    rows = _rows(folder / "drilling.csv")
    for row in rows:
        over = float(row["right_over_drilled_mm"]) - float(row["left_over_drilled_mm"])
        nominal = float(row["right_mm"]) - float(row["left_mm"])
        assert over == pytest.approx(nominal * 28.0 / 27.0, abs=0.21)
        assert float(row["right_minus_left_mm"]) == pytest.approx(nominal, abs=1e-6)
    for before, row in pairwise(row for row in rows if row["left_offset_mm"] == "-18.0"):
        if before["beam"] == row["beam"]:
            assert float(row["left_mm"]) > float(before["left_mm"])


def test_the_same_gridshell_gives_the_same_bytes(gridshell: Gridshell, folder: Path, tmp_path: Path) -> None:
    write_prefabrication(gridshell, tmp_path)
    for name in ("prefabrication.csv", "drilling.csv"):
        assert (tmp_path / name).read_bytes() == (folder / name).read_bytes()


def test_a_table_that_cannot_be_written_names_its_file(gridshell: Gridshell, tmp_path: Path) -> None:
    (tmp_path / "tables").write_text("a file, not a folder")
    with pytest.raises(FileError, match=r"prefabrication\.csv: cannot be written"):
        write_prefabrication(gridshell, tmp_path / "tables")
