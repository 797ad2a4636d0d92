"""The main job: one design file in, a folder out, twice, and what its summary says."""

import json
from pathlib import Path
from typing import Any

import icalendar
import ifcopenshell
import pytest
from builds import build_vault
from ifcopenshell.util.element import get_pset

from aag_cad.parts.model import Gridshell
from aag_cad.parts.store import read_gridshell

FILES = {
    "vault.step", "vault.ifc", "vault.glb", "vault.btlx", "gridshell.json", "plan.json", "sequence.pdf", "overview.svg",
    "overview.png", "templates.pdf", "labels.pdf", "summary.json", "tables/parts.csv", "tables/holes.csv",
    "tables/checks.csv", "tables/prefabrication.csv", "tables/drilling.csv", "tables/purchases.csv",
    "tables/cutting.csv", "tables/facade.csv", "tables/schedule.csv", "tables/locking.csv", "locking.svg",
    "schedule.svg", "schedule.ics", "disassembly.json", "disassembly.pdf", "disassembly.html", "sequence.html",
    "tables/segments.csv", "tables/splices.csv", "tables/laying.csv", "reuse/passports.json", "reuse/passports.pdf",
    "reuse/reuse.csv",
    *(f"facade/P-{number:02d}.dxf" for number in range(1, 14)),
}  # fmt: skip


@pytest.fixture(scope="module")
def summary(vault_build: Path) -> dict[str, Any]:
    """The summary of the build."""
    data: dict[str, Any] = json.loads((vault_build / "summary.json").read_text(encoding="utf-8"))
    return data


def _files(folder: Path) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def test_the_folder_holds_every_file_and_nothing_left_over(vault_build: Path, summary: dict[str, Any]) -> None:
    found = _files(vault_build)
    blanks = sorted(name for name in found if name.startswith("blanks/"))
    assert blanks == [f"blanks/T-{number:02d}.dxf" for number in range(1, len(blanks) + 1)]
    assert found - set(blanks) == FILES
    assert summary["files"] == {name: (vault_build / name).stat().st_size for name in found - {"summary.json"}}


def test_the_step_file_of_three_shells_stays_under_15_megabytes(summary: dict[str, Any]) -> None:
    assert summary["files"]["vault.step"] < 15e6


def test_a_second_build_gives_the_same_bytes_but_for_the_seconds(vault_build: Path, tmp_path: Path) -> None:
    again = tmp_path / "again"
    build_vault(again, "2")
    for name in sorted(_files(vault_build) - {"summary.json"}):
        assert (vault_build / name).read_bytes() == (again / name).read_bytes(), name
    first, second = (json.loads((folder / "summary.json").read_text()) for folder in (vault_build, again))
    assert first.pop("seconds") != second.pop("seconds")
    assert first == second


def test_calendar_and_ifc_tell_the_same_times(vault_build: Path) -> None:
    """Read back by their own libraries: when each step begins and ends, by its number."""
    events = icalendar.Calendar.from_ical((vault_build / "schedule.ics").read_bytes()).walk("VEVENT")
    told = {
        int(str(event["SUMMARY"]).split(" ")[0]): (event["DTSTART"].dt.isoformat(), event["DTEND"].dt.isoformat())
        for event in events
    }
    file = ifcopenshell.open(str(vault_build / "vault.ifc"))
    assert told == {
        get_pset(task, "AAG_Step", "StepNumber"): (task.TaskTime.ScheduleStart, task.TaskTime.ScheduleFinish)
        for task in file.by_type("IfcTask")
    }
    assert min(begin for begin, _ in told.values()) == "2027-03-01T07:00:00"


def test_gridshell_json_is_the_model_itself(vault_build: Path, gridshell: Gridshell) -> None:
    assert read_gridshell((vault_build / "gridshell.json").read_text(encoding="utf-8")) == gridshell


def test_the_summary_counts_what_the_paper_counts(summary: dict[str, Any]) -> None:
    """Sections 3.1 and 3.2: three shells, 66 coupled beams; 14 geodesics a shell, as its 42 concrete blocks say."""
    counts = summary["counts"]
    assert (counts["shells"], counts["coupled beams"], counts["planks G"]) == (3, 66, 42)
    assert counts["planks A1"] + counts["planks A2"] == 132
    assert counts["planks E"] == 9


def test_the_summary_gives_the_papers_figures(summary: dict[str, Any]) -> None:
    figures = summary["figures"]
    assert figures["plan_area_m2"] == pytest.approx(60.27, abs=0.1)
    assert figures["crown_height_mm"] == pytest.approx(2720.0, abs=2.0)
    assert figures["smallest_bending_radius_mm"] == pytest.approx(1700.0, abs=1.0)
    assert figures["largest_twist_deg_per_m"] == pytest.approx(19.5, abs=0.1)
    for lines in ("aa", "ag"):
        assert figures[f"smallest_angle_{lines}_deg"] == pytest.approx(60.0, abs=1e-6)
        assert figures[f"largest_angle_{lines}_deg"] == pytest.approx(60.0, abs=1e-6)


def test_the_vault_has_the_supports_and_the_cover_of_the_paper(summary: dict[str, Any]) -> None:
    """Section 3.2: 42 precast concrete blocks, 14 a shell; 13 strips of polycarbonate a shell."""
    counts = summary["counts"]
    assert (counts["concrete blocks"], counts["strips"], counts["shoes"]) == (42, 39, 42)


def test_the_masses_stand_beside_those_of_the_paper(summary: dict[str, Any]) -> None:
    """Section 3.2: about 300 kg of timber, 30 kg of steel and 40 kg of facade a shell, 11 kg/m2 of roof."""
    weights = {item["group"]: item for item in summary["weights"]["shell"]}
    assert {name: item["paper_kg"] for name, item in weights.items()} == {
        "timber": 300.0, "steel": 30.0, "facade": 40.0,
    }  # fmt: skip
    assert weights["timber"]["kg"] == pytest.approx(300.0, rel=0.1)
    for name, item in weights.items():
        masses = summary["mass_per_shell_kg"]["S1"]
        listed = {"timber": ("all timber",), "steel": ("all steel",), "facade": ("all aluminium", "all polycarbonate")}
        # The ridges' blades and bolts, 7 blades of 1 kg with 28 bolts, are shared between the shells.
        ridge = 9.0 if name == "steel" else 0.0
        assert item["kg"] == pytest.approx(sum(masses[key] for key in listed[name]) + ridge, abs=1.0)
        assert "against the paper's" in item["why"]
    assert summary["weights"]["paper_roof_kg_per_m2"] == 11.0
    assert summary["figures"]["roof_area_m2"] == pytest.approx(81.8, abs=0.1)


def test_the_boards_are_bought_with_proof(summary: dict[str, Any]) -> None:
    boards = summary["stock"]["ash D50 board 25 x 100"]
    assert boards["proven"]
    assert boards["used_m"] <= boards["bought_m"] == boards["bound_m"] <= boards["first_fit_decreasing_m"]
    assert boards["refused"] == 0


def test_every_stage_is_timed_and_every_finding_is_in_words(summary: dict[str, Any]) -> None:
    assert {"web", "curves", "parts", "stock", "audit", "step", "ifc", "btlx"} <= set(summary["seconds"])
    assert all(finding["mark"] in finding["text"] for finding in summary["findings"])
