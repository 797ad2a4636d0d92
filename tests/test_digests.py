"""The script that compares built files tells every file that is not as before, and no other."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from digests import differences, digests_of, main

ROOT = Path(__file__).parent.parent


@pytest.fixture
def built(tmp_path: Path) -> Path:
    folder = tmp_path / "out"
    (folder / "labels").mkdir(parents=True)
    (folder / "plan.json").write_bytes(b'{"steps": []}\n')
    (folder / "labels" / "S1-G-05.svg").write_bytes(b"<svg/>")
    (folder / "summary.json").write_text(json.dumps({"files": {"plan.json": 14}, "seconds": {"plan": 1.25}}))
    return folder


def test_a_folder_is_as_it_was(built: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    kept = tmp_path / "digests.json"
    assert main(["write", str(built), str(kept)]) == 0
    assert main(["compare", str(kept), str(built)]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "3 files, 0 not as before"


def test_a_changed_byte_a_missing_and_a_new_file_are_told(
    built: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    kept = tmp_path / "digests.json"
    main(["write", str(built), str(kept)])
    (built / "plan.json").write_bytes(b'{"steps": []} ')
    (built / "labels" / "S1-G-05.svg").rename(built / "labels" / "S1-G-06.svg")
    capsys.readouterr()
    assert main(["compare", str(kept), str(built)]) == 1
    assert capsys.readouterr().out.splitlines() == [
        "missing  labels/S1-G-05.svg",
        "new      labels/S1-G-06.svg",
        "differs  plan.json",
        "3 files, 3 not as before",
    ]


def test_the_time_that_a_build_took_does_not_count_but_all_else_of_the_summary_does(built: Path) -> None:
    before, path = digests_of(built), built / "summary.json"
    path.write_text(json.dumps({"files": {"plan.json": 14}, "seconds": {"plan": 9.5}}))
    assert not list(differences(before, digests_of(built)))
    path.write_text(json.dumps({"files": {"plan.json": 15}, "seconds": {"plan": 1.25}}))
    assert list(differences(before, digests_of(built))) == ["differs  summary.json"]


def test_the_script_runs_as_contributing_says(built: Path, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "tests.digests", "write", str(built), str(tmp_path / "digests.json")]
    assert f"python {' '.join(command[1:4])} OUT digests.json" in (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    assert done.stdout.startswith("3 files")


def test_a_folder_that_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["write", str(tmp_path / "nowhere"), str(tmp_path / "digests.json")])
