"""A kind of part is described in its row: few modules name its class, and none asks a part which of several it is."""

import ast
from collections import defaultdict
from pathlib import Path

from aag_cad.parts.kinds import KINDS

HOME = Path(__file__).parents[1]
PARTS = HOME / "aag_cad" / "parts"
OUTSIDE = sorted(
    path for room in ("aag_cad", "assembly") for path in (HOME / room).rglob("*.py") if PARTS not in path.parents
)
CLASSES = {kind.__name__ for kind in KINDS}
MOST = 6


def test_few_modules_outside_parts_name_the_class_of_a_kind() -> None:
    """Those that draw, shape or calculate that very kind; what holds for all kinds is read from the rows."""
    found: dict[str, set[str]] = defaultdict(set)
    for path in OUTSIDE:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom):
                for name in CLASSES & {alias.name for alias in node.names}:
                    found[name].add(path.relative_to(HOME).as_posix())
    assert {name: sorted(paths) for name, paths in found.items() if len(paths) > MOST} == {}


def classes_asked(node: ast.AST) -> set[str]:
    """Return the classes of kinds that an isinstance or a case tells a part from."""
    match node:
        case ast.Call(func=ast.Name(id="isinstance"), args=[_, asked]):
            named = ast.walk(asked)
        case ast.MatchClass(cls=asked):
            named = ast.walk(asked)
        case _:
            return set()
    return CLASSES & {each.id for each in named if isinstance(each, ast.Name)}


def test_no_module_outside_the_table_asks_a_part_for_its_class() -> None:
    """Only planks are told apart, one by one, where they alone have a strain to speak of."""
    table = PARTS / "kinds.py"
    asked = {
        (path.relative_to(HOME).as_posix(), name)
        for path in [*OUTSIDE, *sorted(PARTS.rglob("*.py"))]
        if path != table
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        for name in classes_asked(node)
    }
    assert asked == {("aag_cad/export/ifc/properties.py", "Plank")}
