"""The house keeps its measures: rooms, files, and where a language may appear."""

import ast
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGES = ("aag_cad", "assembly")
# What plans speaks no language: sentences are made where they are printed.
SILENT = ("base", "graph", "locking", "laying", "transport", "plan", "checks")


def modules() -> Iterator[Path]:
    for package in PACKAGES:
        yield from (path for path in (ROOT / package).rglob("*.py") if "templates" not in path.parts)


def lines(path: Path) -> int:
    return len(path.read_text(encoding="utf-8").splitlines())


def test_no_file_has_more_than_400_lines() -> None:
    assert {str(path): lines(path) for path in modules() if lines(path) > 400} == {}


def test_no_room_has_more_than_25_files_or_a_fifth_of_all_lines() -> None:
    files, sizes = Counter[Path](), Counter[Path]()
    for path in modules():
        files[path.parent] += path.name != "__init__.py"
        sizes[path.parent] += lines(path)
    assert {str(room): count for room, count in files.items() if count > 25} == {}
    assert {str(room): size for room, size in sizes.items() if size > sum(sizes.values()) / 5} == {}


def names_in(source: str) -> set[str]:
    """Return every name that a module imports, reads or takes as a parameter."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        match node:
            case ast.ImportFrom():
                found |= {alias.name for alias in node.names}
            case ast.Name():
                found.add(node.id)
            case ast.arg():
                found.add(node.arg)
    return found


@pytest.mark.parametrize("room", SILENT)
def test_planning_speaks_no_language(room: str) -> None:
    told = {"Language", "LANGUAGES", "language", "say", "says"}
    spoken = {
        path.name: sorted(names_in(path.read_text(encoding="utf-8")) & told)
        for path in (ROOT / "assembly" / room).glob("*.py")
    }
    assert {name: names for name, names in spoken.items() if names} == {}


def test_a_language_is_found_where_it_is_taken() -> None:
    assert "language" in names_in("def plan(shell, language): return shell")
    assert "say" in names_in("from aag_cad.language import say")


def test_the_top_level_holds_what_the_layout_names() -> None:
    known = {
        "pyproject.toml", "aag_cad", "assembly", "tests", "templates", "docs", "README.md", "CONTRIBUTING.md",
        "CHANGELOG.md", "LICENSE", "out",
    }  # fmt: skip
    found = {path.name for path in ROOT.iterdir() if not path.name.startswith((".", "__"))}
    assert {name for name in found - known if not name.endswith(".egg-info")} == set()
