"""Files that are written whole or not at all."""

import csv
import io
import json
import os
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from aag_cad.errors import AagError, FileError


@contextmanager
def _writing(target: Path) -> Iterator[None]:
    """Turn what the system has against writing a file or folder into FileError."""
    try:
        yield
    except FileError:
        raise
    except OSError as error:
        raise FileError(
            f"{target}: cannot be written ({error.strerror or error}); choose a folder that you may write to, with "
            "free space, and close the file in other programs"
        ) from error


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a path in a temporary folder beside ``path``, then move what was written there to ``path``.

    Missing folders are made. If the block raises, ``path`` stays as it was; FileError if it cannot be written.
    """
    target = Path(path)
    with _writing(target):
        target.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=".writing-", dir=target.parent) as folder:
            # The name is kept because some writers choose the format by it or print it in the header.
            draft = Path(folder) / target.name
            yield draft
            os.replace(draft, target)


def sizes_below(folder: Path) -> dict[str, int]:
    """Return the size in bytes of every file in a folder and those below it, by its path from there, sorted."""
    paths = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*") if path.is_file()}
    return {name: paths[name].stat().st_size for name in sorted(paths)}


@contextmanager
def publishing(folder: Path) -> Iterator[Path]:
    """Yield a temporary folder inside ``folder``, then move all files in it to their places.

    If the block raises, nothing is moved and nothing left behind; FileError if the folder cannot be written.
    """
    with _writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
        holder = tempfile.TemporaryDirectory(prefix=".aag-", dir=folder)
    with holder as name:
        staging = Path(name)
        yield staging
        for path in sizes_below(staging):
            target = folder / path
            with _writing(target):
                target.parent.mkdir(parents=True, exist_ok=True)
                os.replace(staging / path, target)


def read_text(path: str | os.PathLike[str]) -> str:
    """Return the text of a file in UTF-8, a byte order mark left out; FileError if it cannot be read."""
    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        raise FileError(f"{path}: cannot be read as a text file: {error}") from error


def json_object(text: str, source: str, kind: type[AagError] = FileError) -> dict[str, Any]:
    """Return the object in a JSON text, an empty one for all else; ``kind`` of error with the source if it is none."""
    try:
        data = json.loads(text)
    except (json.JSONDecodeError, RecursionError) as error:
        raise kind(f"{source}: not valid JSON: {error}") from error
    return data if isinstance(data, dict) else {}


def write_bytes(path: str | os.PathLike[str], data: bytes) -> None:
    """Write bytes to a file as a whole; FileError if it cannot be written."""
    with replacing(path) as draft:
        draft.write_bytes(data)


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write text to a file as a whole, in UTF-8 with the line ends that it has; FileError if it cannot be written."""
    write_bytes(path, text.encode("utf-8"))


def write_csv(path: str | os.PathLike[str], header: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Write a table as CSV: one header line, LF, quotes only where needed; FileError if it cannot be written."""
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows([header, *rows])
    write_text(path, out.getvalue())
