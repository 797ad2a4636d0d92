"""The ``aag`` command as a user meets it: a process with exit code, output and files."""

import json
import subprocess
import sys
from pathlib import Path

import jsonschema
import pytest
from builds import aag, small_vault

from aag_cad import __version__
from aag_cad.design import design_text, parse_design
from assembly.booklet.plan_file import PLAN_VERSION, plan_schema

AAG = [sys.executable, "-m", "aag_cad"]


def _aag(*arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run([*AAG, *arguments], capture_output=True, text=True, cwd=cwd, timeout=300, check=False)


def _changed(tmp_path: Path, old: str, new: str, text: str = "") -> str:
    text = text or design_text("vault")
    assert old in text
    path = tmp_path / "changed.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    return str(path)


def test_the_version_is_that_of_the_package() -> None:
    run = _aag("--version")
    assert (run.returncode, run.stdout.strip()) == (0, f"aag {__version__}")


def test_the_schema_is_json_and_knows_every_table_of_the_design_file() -> None:
    run = _aag("schema")
    schema = json.loads(run.stdout)
    assert set(schema["properties"]) == {
        "project", "surface", "shells", "pattern", "timber", "joints", "boundary", "facade", "supports", "transport",
        "crew", "stock", "optimise", "ridge", "site",
    }  # fmt: skip
    assert schema["additionalProperties"] is False


def test_the_schema_of_plans_is_that_by_which_they_are_read(tmp_path: Path) -> None:
    """A plan that was written keeps it, by an independent validator; and not if a key is missing."""
    run = _aag("schema", "plan")
    assert run.returncode == 0, run.stderr
    schema = json.loads(run.stdout)
    validator = jsonschema.Draft202012Validator(schema)
    validator.check_schema(schema)
    assert schema == plan_schema()
    assert schema["properties"]["schema_version"]["const"] == PLAN_VERSION
    plan = json.loads(_aag("plan", "kagome", "-o", str(tmp_path / "woven"), "--json").stdout)
    validator.validate(plan)
    del plan["steps"][0]["step"]["predecessors"]
    assert not validator.is_valid(plan)


def test_a_schema_that_there_is_not_is_refused_with_those_that_there_are() -> None:
    run = aag("schema", "studio")
    assert run.exit_code == 2
    assert "no schema of 'studio'; there are design and plan" in run.stderr


def test_new_writes_a_commented_design_that_parses_and_is_not_overwritten(tmp_path: Path) -> None:
    run = _aag("new", "pavilion", cwd=tmp_path)
    assert run.returncode == 0
    text = (tmp_path / "pavilion.toml").read_text(encoding="utf-8")
    assert parse_design(text).project.name == "pavilion"
    assert text.count("#") > 30
    again = _aag("new", "pavilion", cwd=tmp_path)
    assert again.returncode == 2
    assert "pavilion.toml" in again.stderr
    assert (tmp_path / "pavilion.toml").read_text(encoding="utf-8") == text


def test_new_refuses_a_name_that_could_not_be_a_file_name(tmp_path: Path) -> None:
    run = aag("new", "My Pavilion/2", cwd=tmp_path)
    assert run.exit_code == 2
    assert "project.name" in run.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("neck_radius = 5100.0", "neck_radius = -5100.0", ("surface", "neck_radius", "-5100", "greater than 0")),
        ("sector_deg = 60.0", "sector_deg = 75.0", ("shells.sector_deg", "75", "at most 60")),
        ("thickness = 12.0", "thickness = 30.0", ("timber.thickness", "30", "joints.gap 24")),
        ("[crew]", "[crew]\ncoffee = true", ("crew.coffee", "unknown key")),
        ("axis_distance = 8823.0", "axis_distance = 5000.0", ("shells.axis_distance", "enlarge")),
        ("geodesics = 14 ", "geodesics = 60 ", ("pattern.geodesics", "60", "fewer geodesics")),
    ],
)
def test_a_bad_design_is_one_message_with_exit_code_2_and_no_folder(
    tmp_path: Path, old: str, new: str, words: tuple[str, ...]
) -> None:
    run = aag("build", _changed(tmp_path, old, new), "-o", "out", cwd=tmp_path)
    assert run.exit_code == 2
    assert all(word in run.stderr for word in words)
    assert not (tmp_path / "out").exists()


def test_a_meridian_that_bulges_outwards_is_refused_with_the_height(tmp_path: Path) -> None:
    dome = "[[5000,-300],[5100,0],[5150,300],[5180,800],[5150,1500],[5000,2500],[4800,3000]]"
    path = Path(_changed(tmp_path, 'profile = "crpc"', f'profile = "spline"\npoints = {dome}'))
    lines = [line for line in path.read_text().splitlines() if not line.startswith(("neck_radius", "ratio"))]
    path.write_text("\n".join(lines))
    run = aag("check", str(path))
    assert run.exit_code == 2
    assert "K >= 0 at height" in run.stderr


def test_empty_missing_and_unreadable_designs_are_said_so(tmp_path: Path) -> None:
    (tmp_path / "empty.toml").write_text("")
    (tmp_path / "broken.toml").write_text("[project\nname=")
    for name, word in (
        ("empty.toml", "empty"),
        ("missing.toml", "no such design file"),
        ("broken.toml", "not valid TOML"),
        (".", "cannot be read"),
    ):
        run = aag("build", name, "-o", "out", cwd=tmp_path)
        assert run.exit_code == 2
        assert word in run.stderr
    assert not (tmp_path / "out").exists()


def test_a_folder_that_cannot_be_written_is_said_so(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    (tmp_path / "small.toml").write_text(small_vault(cover=False), encoding="utf-8")
    run = aag("build", "small.toml", "-o", str(tmp_path / "file" / "out"), "--only", "gridshell", cwd=tmp_path)
    assert run.exit_code == 2
    assert "cannot be written" in run.stderr
    assert "Traceback" not in run.stderr


def test_an_unknown_output_is_refused_with_the_list_of_outputs(tmp_path: Path) -> None:
    run = aag("build", "vault", "-o", str(tmp_path / "out"), "--only", "step,dwg")
    assert run.exit_code == 2
    assert "dwg" in run.stderr
    assert "ifc" in run.stderr
    assert not (tmp_path / "out").exists()


def test_check_ends_with_0_for_the_vault_and_with_1_for_planks_that_would_break(tmp_path: Path) -> None:
    assert _aag("check", "vault").returncode == 0
    uncovered = small_vault(cover=False)
    stiff = _changed(tmp_path, "min_bending_radius = 1700.0", "min_bending_radius = 1800.0", uncovered)
    run = _aag("check", stiff, "--json")
    assert run.returncode == 1
    assert {finding["code"] for finding in json.loads(run.stdout) if finding["severity"] == "error"} == {"AAG101"}


def test_only_writes_what_is_asked_for_and_json_prints_the_summary_alone(tmp_path: Path) -> None:
    (tmp_path / "small.toml").write_text(small_vault(cover=False), encoding="utf-8")
    run = _aag("build", "small.toml", "-o", "out", "--only", "gridshell,tables", "--json", cwd=tmp_path)
    assert run.returncode == 0
    summary = json.loads(run.stdout)
    names = {path.relative_to(tmp_path / "out").as_posix() for path in (tmp_path / "out").rglob("*") if path.is_file()}
    assert names == {"summary.json", *summary["files"]}
    assert set(summary["files"]) == {"gridshell.json", "tables/parts.csv", "tables/holes.csv", "tables/checks.csv"}
    assert json.loads((tmp_path / "out" / "summary.json").read_text()) == summary


def test_the_heavy_libraries_stay_out_of_the_help_the_parts_and_the_planner() -> None:
    code = (
        "import aag_cad.cli, aag_cad.parts.build, aag_cad.parts.store, assembly.plan.assembly_plan, sys;"
        "heavy = {'OCP', 'cadquery', 'ifcopenshell', 'typst', 'trimesh', 'ezdxf'} & set(sys.modules);"
        "sys.exit(', '.join(sorted(heavy)) or 0)"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (run.returncode, run.stderr) == (0, "")
