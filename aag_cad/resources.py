"""Where the shipped data lie: inside the installed package, or beside it in a source checkout."""

from importlib.resources import files
from pathlib import Path

from aag_cad.errors import FileError
from aag_cad.files import read_text


def template(*names: str) -> Path:
    """Return the path of a shipped template, e.g. ``template("designs", "vault.toml")``; FileError if there is none."""
    package = Path(str(files("aag_cad")))
    for root in (package / "templates", package.parent / "templates"):
        path = root.joinpath(*names)
        if path.exists():
            return path
    raise FileError(f"templates/{'/'.join(names)}: not shipped with this installation; reinstall the package")


def shipped_names(folder: str, suffix: str) -> list[str]:
    """Return the names of the shipped files of a folder without their suffix, sorted."""
    return sorted(path.stem for path in template(folder).glob(f"*{suffix}"))


def shipped_text(folder: str, suffix: str, name_or_path: str, kind: str) -> str:
    """Return the text of a shipped file, by its name, or of a file of the user; FileError if neither can be read."""
    names = shipped_names(folder, suffix)
    if name_or_path in names:
        return read_text(template(folder, f"{name_or_path}{suffix}"))
    try:
        return read_text(name_or_path)
    except FileError as error:
        if isinstance(error.__cause__, FileNotFoundError):
            raise FileError(
                f"{name_or_path}: no such {kind} file, and not a shipped {kind} ({', '.join(names)})"
            ) from error
        raise
