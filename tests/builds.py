"""What is dear to make for tests: made once in a run, whoever asks first, and shared by all of its processes."""

import fcntl
import os
import subprocess
import sys
from collections.abc import Callable
from contextlib import chdir
from pathlib import Path

from click.testing import Result
from typer.testing import CliRunner

from aag_cad.cli import app
from aag_cad.design import design_text

# A small vault: six geodesics in a sector of 50 degrees, in place of 14 in 60.
_SMALL = (("geodesics = 14 ", "geodesics = 6 "), ("sector_deg = 60.0", "sector_deg = 50.0"))


def small_vault(cover: bool = True) -> str:
    """Return the text of the vault's design made small: a third of its parts, of every kind.

    Its strips are wider than the sheets that are sold, which are errors: without a cover there are none.
    """
    text = design_text("vault")
    for old, new in _SMALL:
        assert old in text
        text = text.replace(old, new)
    assert "\ncover = true" in text
    return text if cover else text.replace("\ncover = true", "\ncover = false")


def aag(*arguments: str, cwd: Path | None = None) -> Result:
    """Run the command in this process, which spares it the imports: for what is refused before any work is done."""
    with chdir(cwd or Path.cwd()):
        return CliRunner().invoke(app, arguments)


def made_once(target: Path, make: Callable[[Path], None]) -> Path:
    """Return a file or folder that ``make`` has made; other processes that ask for it wait until it is whole."""
    with target.with_name(f"{target.name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not target.exists():
            draft = target.with_name(f"{target.name}.draft")
            make(draft)
            draft.rename(target)
    return target


def build_vault(folder: Path, seed: str) -> None:
    """Build the vault into a folder in a process of its own, with a seed for the hashes of texts."""
    command = [sys.executable, "-m", "aag_cad", "build", "vault", "-o", str(folder)]
    # The rest stays as it is here: last digits depend on the kernels that the BLAS takes by its environment.
    environment = os.environ | {"PYTHONHASHSEED": seed, "HOME": str(folder.parent)}
    subprocess.run(command, check=True, capture_output=True, env=environment, cwd=Path(__file__).parents[1])
