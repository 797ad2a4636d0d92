"""The wheel: templates inside the package, nothing else at its top, the command declared."""

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from aag_cad.errors import FileError
from aag_cad.resources import template

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> zipfile.ZipFile:
    """The wheel built from this checkout."""
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    return zipfile.ZipFile(next(folder.glob("*.whl")))


def test_the_wheel_holds_the_two_packages_and_its_metadata_only(wheel: zipfile.ZipFile) -> None:
    tops = {name.split("/")[0] for name in wheel.namelist()}
    assert {top for top in tops if not top.endswith(".dist-info")} == {"aag_cad", "assembly"}


def test_every_template_ships_inside_the_package(wheel: zipfile.ZipFile) -> None:
    ours = {path.relative_to(ROOT).as_posix() for path in (ROOT / "templates").rglob("*") if path.is_file()}
    shipped = {name.removeprefix("aag_cad/") for name in wheel.namelist() if name.startswith("aag_cad/templates/")}
    assert shipped == ours
    assert "templates/designs/vault.toml" in shipped


def test_both_packages_say_that_they_are_typed(wheel: zipfile.ZipFile) -> None:
    assert {"aag_cad/py.typed", "assembly/py.typed"} <= set(wheel.namelist())


def test_the_command_is_declared(wheel: zipfile.ZipFile) -> None:
    entry = next(name for name in wheel.namelist() if name.endswith("entry_points.txt"))
    assert "aag = aag_cad.cli:app" in wheel.read(entry).decode()


def test_a_template_that_is_not_shipped_is_said_so() -> None:
    assert template("designs", "vault.toml").is_file()
    with pytest.raises(FileError, match=r"templates/designs/nothing\.toml"):
        template("designs", "nothing.toml")
