"""The main job: one design file in, a folder out, twice, and what its summary says."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from aag_cad.parts.model import Gridshell
from aag_cad.parts.store import read_gridshell

FILES = {
    "vault.step", "vault.ifc", "vault.glb", "gridshell.json", "plan.json", "sequence.pdf", "overview.svg",
    "overview.png", "tables/parts.csv", "tables/holes.csv", "tables/checks.csv", "summary.json",
}  # fmt: skip


def _build(folder: Path, seed: str) -> Path:
    command = [sys.executable, "-m", "aag_cad", "build", "vault", "-o", str(folder)]
    environment = {"PYTHONHASHSEED": seed, "PATH": "/usr/bin:/bin", "HOME": str(folder)}
    subprocess.run(command, check=True, capture_output=True, env=environment)
    return folder


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a build of the vault in a process of its own."""
    return _build(tmp_path_factory.mktemp("first"), "1")


@pytest.fixture(scope="module")
def summary(built: Path) -> dict[str, Any]:
    """Its summary."""
    data: dict[str, Any] = json.loads((built / "summary.json").read_text(encoding="utf-8"))
    return data


def _files(folder: Path) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def test_the_folder_holds_every_file_and_nothing_left_over(built: Path, summary: dict[str, Any]) -> None:
    assert _files(built) == FILES
    assert summary["files"] == {name: (built / name).stat().st_size for name in FILES - {"summary.json"}}


def test_a_second_build_gives_the_same_bytes_but_for_the_seconds(built: Path, tmp_path: Path) -> None:
    again = _build(tmp_path / "again", "2")
    for name in sorted(FILES - {"summary.json"}):
        assert (built / name).read_bytes() == (again / name).read_bytes(), name
    first, second = (json.loads((folder / "summary.json").read_text()) for folder in (built, again))
    assert first.pop("seconds") != second.pop("seconds")
    assert first == second


def test_gridshell_json_is_the_model_itself(built: Path, gridshell: Gridshell) -> None:
    assert read_gridshell((built / "gridshell.json").read_text(encoding="utf-8")) == gridshell


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


def test_the_masses_stand_beside_those_of_the_paper(summary: dict[str, Any]) -> None:
    """Section 3.2: about 300 kg of timber and 30 kg of steel per shell; plates and edge doubling are not placed yet."""
    assert summary["paper_mass_per_shell_kg"] == {"timber": 300.0, "steel": 30.0}
    for masses in summary["mass_per_shell_kg"].values():
        assert masses["all timber"] == pytest.approx(300.0, rel=0.1)
        assert masses["planks"] + masses["studs"] + masses["coupling blocks"] == pytest.approx(
            masses["all timber"], abs=0.05
        )


def test_every_stage_is_timed_and_every_finding_is_in_words(summary: dict[str, Any]) -> None:
    assert {"web", "curves", "parts", "audit", "step", "ifc"} <= set(summary["seconds"])
    assert all(finding["mark"] in finding["text"] for finding in summary["findings"])
