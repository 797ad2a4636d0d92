"""Only ``aag_cad/parts/marks.py`` takes a mark apart or puts one together; all others ask it."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

HOME = Path(__file__).parents[1]
GRAMMAR = HOME / "aag_cad" / "parts" / "marks.py"
SOURCES = sorted(path for room in ("aag_cad", "assembly") for path in (HOME / room).rglob("*.py") if path != GRAMMAR)

ONE = {
    "mark", "joint", "unit", "beam", "plank", "stud", "geodesic", "strap", "bolt", "screw", "fastener",
    "member", "shell", "family", "twin",
}  # fmt: skip
"""Names and attributes that hold the mark of one thing, wherever they hold a text at all."""

FIELDS = ONE | {"line", "part"}
"""Attributes that hold one too: the geodesic of a cut, what a parsed mark adds to its whole."""

SEVERAL = {"marks", "joints", "units", "beams", "members", "fasteners", "feet", "props", "geodesics", "families"}
"""Names and attributes that hold several: an item of them is one mark."""

TEXT_METHODS = {
    "split", "rsplit", "partition", "rpartition", "startswith", "endswith", "removeprefix", "removesuffix", "replace",
    "strip", "lstrip", "rstrip", "find", "rfind", "index", "rindex", "count", "isdigit", "zfill", "translate",
}  # fmt: skip
PATTERN_METHODS = {"match", "fullmatch", "search", "findall", "finditer", "sub"}

VALUE, MARK = "\0", "\1"
PUT_TOGETHER = re.compile(
    rf"(?<![\w-])(?:[SR][{VALUE}{MARK}]|(?:A[12]|[GEFRCPMDNKV])-[{VALUE}{MARK}]|{MARK}-(?:$|[A-Z{VALUE}{MARK}]))"
)
"""What an f-string may not hold: S or R and a number, a family and a number, or a mark with something behind a dash."""


def is_mark(node: ast.expr) -> bool:
    match node:
        case ast.Name(id=name):
            return name in ONE
        case ast.Attribute(attr=name):
            return name in FIELDS
        case ast.Subscript(value=ast.Name(id=name) | ast.Attribute(attr=name), slice=ast.Constant(value=int())):
            return name in SEVERAL
        case ast.Call(func=ast.Name(id="str"), args=[inner]):
            return is_mark(inner)
    return False


def template(node: ast.JoinedStr) -> str:
    """Return the text of an f-string with one sign in place of each value: MARK for marks."""
    texts = []
    for value in node.values:
        match value:
            case ast.Constant(value=str(text)):
                texts.append(text)
            case ast.FormattedValue(value=inner):
                texts.append(MARK if is_mark(inner) else VALUE)
    return "".join(texts)


def is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


def takes_apart(node: ast.AST) -> bool:
    match node:
        case ast.Call(func=ast.Attribute(attr="split"), args=[ast.Constant(value=", ")]):
            return False  # a list of marks
        case ast.Call(func=ast.Attribute(value=receiver, attr=method), args=args):
            asked = method in PATTERN_METHODS and any(is_mark(arg) for arg in args)
            return asked or (method in TEXT_METHODS and is_mark(receiver))
        case ast.Subscript(value=ast.Attribute(attr="line")):
            return False  # points of a plate
        case ast.Subscript(value=value, slice=ast.Slice() | ast.Constant(value=int()) | ast.UnaryOp(), ctx=ast.Load()):
            return is_mark(value)
        case ast.Compare(left=ast.Constant(value=str()), ops=[ast.In() | ast.NotIn()], comparators=[right]):
            return is_mark(right)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return (is_mark(left) and is_text(right)) or (is_text(left) and is_mark(right))
        case ast.JoinedStr():
            return bool(PUT_TOGETHER.search(template(node)))
    return False


def taken_apart(source: str) -> Iterator[str]:
    """Yield line and text of every place in a source that takes a mark apart or puts one together."""
    for node in ast.walk(ast.parse(source)):
        if takes_apart(node):
            assert isinstance(node, ast.expr)
            yield f"{node.lineno}: {ast.unparse(node)}"


def test_no_other_file_takes_a_mark_apart() -> None:
    assert GRAMMAR.is_file()
    assert len(SOURCES) > 200
    found = [f"{path.relative_to(HOME)}:{place}" for path in SOURCES for place in taken_apart(path.read_text("utf-8"))]
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    "source",
    [
        'mark.split("-")',
        'plank.mark.rpartition("-")[2]',
        'place.joint.startswith("R")',
        'screw.mark.removesuffix("-W1")',
        'splice.line.startswith(f"{shell}-")',
        'member.count("-") == 2',
        "mark[-3:]",
        "joint.mark[1:3]",
        "marks[0][:2]",
        "parse_mark(blade.mark).family[1:]",
        "parse_mark(fastener).part[0]",
        '"-K-" in place.joint',
        '"-K-" not in place.joint',
        're.match("S[12]", mark)',
        "_PATTERN.fullmatch(plank.mark)",
        'mark + "-B1"',
        '"S1-" + str(mark)',
        'f"S{number}"',
        'f"R{a}{b}-01"',
        'f"{mark}-B{i}"',
        'f"{beam.mark}-L"',
        'f"{shell}-"',
        'f"{family}-{number:02d}"',
        'f"geodesic G-{number:02d}: too short"',
        'f"A1-{number:02d}"',
    ],
)
def test_what_takes_a_mark_apart_is_found(source: str) -> None:
    assert len(list(taken_apart(f"found = {source}"))) >= 1


@pytest.mark.parametrize(
    "source",
    [
        "marks[0]",
        'finding.mark.split(", ")',
        "family[mark]",
        "shoe.plate.line[1:3]",
        "joint + offset",
        "weights[mark]",
        "by_mark[plank.mark][0]",
        "marks[1:]",
        "joint.members[0]",
        "mark in marks",
        'marks.index("S1")',
        "parse_mark(mark).family == 'K'",
        'f"map-{shell.mark}-{i}"',
        'f"{mark}: too short"',
        'f"step-{number}"',
        'f"M{x} {y}"',
        'f"T-{number:02d}"',
        'line.startswith("v ")',
        'text.split("-")',
    ],
)
def test_what_leaves_a_mark_whole_is_not(source: str) -> None:
    assert list(taken_apart(f"found = {source}")) == []
