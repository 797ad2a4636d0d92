"""Where the shipped data lie: inside the installed package, or beside it in a source checkout."""

from importlib.resources import files
from pathlib import Path

from aag_cad.errors import FileError


def template(*names: str) -> Path:
    """Return the path of a shipped template, e.g. ``template("designs", "vault.toml")``; FileError if there is none."""
    package = Path(str(files("aag_cad")))
    for root in (package / "templates", package.parent / "templates"):
        path = root.joinpath(*names)
        if path.exists():
            return path
    raise FileError(f"templates/{'/'.join(names)}: not shipped with this installation; reinstall the package")
