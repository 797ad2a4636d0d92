"""Digests of a folder of built files, to see which files a change of the code changes.

    python -m tests.digests write OUT digests.json      before the change
    python -m tests.digests compare digests.json OUT    after it; exit code 1 and the files that differ, if any do

What a build took (``seconds`` in ``summary.json``) does not count.
"""

import argparse
import hashlib
import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path


def _content(path: Path) -> bytes:
    if path.name != "summary.json":
        return path.read_bytes()
    summary = json.loads(path.read_text("utf-8"))
    summary.pop("seconds", None)
    return json.dumps(summary).encode()


def digests_of(folder: Path) -> dict[str, str]:
    """Return the SHA-256 of every file in a folder and below it, by its path from there, sorted."""
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): hashlib.sha256(_content(path)).hexdigest() for path in files}


def differences(before: Mapping[str, str], after: Mapping[str, str]) -> Iterator[str]:
    """Yield what became of the files that are not as before: differs, is missing or is new."""
    for name in sorted(before.keys() | after.keys()):
        if name not in after:
            yield f"missing  {name}"
        elif name not in before:
            yield f"new      {name}"
        elif before[name] != after[name]:
            yield f"differs  {name}"


def main(arguments: Sequence[str]) -> int:
    """Write or compare; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m tests.digests", description="Digests of a folder of built files.")
    commands = parser.add_subparsers(dest="command", required=True)
    write = commands.add_parser("write", help="write the digests of a folder")
    compare = commands.add_parser("compare", help="compare a folder with digests written before")
    for command, names in ((write, ("folder", "digests")), (compare, ("digests", "folder"))):
        for name in names:
            command.add_argument(name, type=Path)
    chosen = parser.parse_args(arguments)
    if not chosen.folder.is_dir():
        parser.error(f"{chosen.folder}: not a folder")
    found = digests_of(chosen.folder)
    if chosen.command == "write":
        chosen.digests.write_text(json.dumps(found, indent=1) + "\n", "utf-8")
        print(f"{len(found)} files: {chosen.digests}")
        return 0
    told = list(differences(json.loads(chosen.digests.read_text("utf-8")), found))
    print("\n".join((*told, f"{len(found)} files, {len(told)} not as before")))
    return 1 if told else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
