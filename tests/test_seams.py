"""Each heavy library stays behind the file, or the room, that is named for it."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
SEAMS = {
    "typst": ("aag_cad/typesetting.py",),
    "jinja2": ("aag_cad/pages.py",),
    "markupsafe": ("aag_cad/pages.py",),
    "segno": ("assembly/booklet/qr.py",),
    "icalendar": ("assembly/booklet/calendar.py",),
    "ezdxf": ("aag_cad/export/workshop/dxf.py",),
    "compas": ("aag_cad/export/workshop/btlx.py",),
    "compas_timber": ("aag_cad/export/workshop/btlx.py",),
    "rhino3dm": ("aag_cad/export/cad/rhino.py",),
    "trimesh": ("aag_cad/export/cad/gltf.py",),
    "ifcopenshell": ("aag_cad/export/ifc/",),
    "OCP": ("aag_cad/export/cad/", "aag_cad/solids/"),
}


def imported(path: Path) -> set[str]:
    """Return the packages that a file imports, at its top or within its functions, by name or by ``import_module``."""
    names = set[str]()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        match node:
            case ast.Import(names=listed):
                names |= {alias.name for alias in listed}
            case ast.ImportFrom(module=str(name)):
                names.add(name)
            case ast.Call(func=ast.Attribute(attr="import_module"), args=[ast.Constant(value=str(name))]):
                names.add(name)
    return {name.split(".")[0] for name in names}


@pytest.fixture(scope="module")
def users() -> dict[str, list[str]]:
    """The files of both packages that import each library."""
    found: dict[str, list[str]] = {}
    for path in sorted([*(ROOT / "aag_cad").rglob("*.py"), *(ROOT / "assembly").rglob("*.py")]):
        for name in imported(path):
            found.setdefault(name, []).append(path.relative_to(ROOT).as_posix())
    return found


@pytest.mark.parametrize("library", SEAMS)
def test_a_library_is_known_behind_its_seam_only(library: str, users: dict[str, list[str]]) -> None:
    assert users[library]
    assert [path for path in users[library] if not path.startswith(SEAMS[library])] == []
