"""The labels, read back: their texts, and the QR codes from the vector content, decoded by hand."""

import io
import re
from dataclasses import replace

import numpy as np
import pytest
import segno
from numpy.typing import NDArray
from pdf_texts import page_texts, undrawn
from pypdf import PageObject, PdfReader

from aag_cad.export.workshop.labels import labels_pdf
from aag_cad.parts.index import index_of
from aag_cad.parts.model import Gridshell
from aag_cad.shop.groups import templates_of

MM_PER_POINT = 25.4 / 72.0
LABEL = (99.1, 38.1)
# A dark bar is at least a module high; the dots of a blank's picture are curves and have no straight sides.
LEAST_BARS = 60

Modules = NDArray[np.bool_]


@pytest.fixture(scope="module")
def pdf(printed: bytes) -> PdfReader:
    return PdfReader(io.BytesIO(printed))


@pytest.fixture(scope="module")
def printed(gridshell: Gridshell) -> bytes:
    return labels_pdf(gridshell)


@pytest.fixture(scope="module")
def text(printed: bytes) -> str:
    return "\n".join(undrawn(page).extract_text() for page in PdfReader(io.BytesIO(printed)).pages)


@pytest.fixture(scope="module")
def labelled(text: str) -> list[str]:
    """The marks of planks and beams in the order of the labels."""
    return [word for word in text.split() if re.fullmatch(r"S\d-(A[12]|G|E)-\d+(-[LR])?", word)]


def test_the_texts_of_a_page_are_the_same_without_its_drawings(printed: bytes, pdf: PdfReader) -> None:
    """What ``pdf_texts`` leaves out for other tests holds no text."""
    pages = page_texts(printed)
    assert len(pages) == len(pdf.pages)
    for i in (0, len(pages) - 1):
        assert pages[i] == " ".join(pdf.pages[i].extract_text().split())


def codes(page: PageObject) -> list[tuple[tuple[float, float], Modules]]:
    """Return the QR codes of a page: place of the upper left corner in mm from that of the page, and their modules."""
    contents = page.get_contents()
    assert contents is not None
    matrix, stack, bars, found = np.eye(3), [], [], []
    corners: list[tuple[float, float]] = []
    for operands, operator in contents.operations:
        if operator == b"q":
            stack.append(matrix)
        elif operator == b"Q":
            matrix = stack.pop()
        elif operator == b"cm":
            a, b, c, d, e, f = (float(value) for value in operands)
            matrix = matrix @ np.array([[a, c, e], [b, d, f], [0.0, 0.0, 1.0]])
        elif operator in (b"m", b"l"):
            corners.append((float(operands[0]), float(operands[1])))
        elif operator == b"h":
            bars.append(corners)
            corners = []
        elif operator in (b"f", b"S", b"n", b"B", b"f*"):
            if operator == b"f" and len(bars) >= LEAST_BARS:
                size = round(max(x for bar in bars for x, _ in bar))
                modules = np.zeros((size, size), dtype=bool)
                for bar in bars:
                    (left, top), (right, bottom) = np.array(bar).min(axis=0), np.array(bar).max(axis=0)
                    modules[round(top) : round(bottom), round(left) : round(right)] = True
                x, y, _ = matrix @ np.array([0.0, 0.0, 1.0])
                found.append(((x * MM_PER_POINT, (float(page.mediabox.height) - y) * MM_PER_POINT), modules))
            bars, corners = [], []
    return found


@pytest.fixture(scope="module")
def first_codes(pdf: PdfReader) -> list[Modules]:
    """The codes of the first six sheets and of the last, row by row as the labels are read."""
    return [
        modules
        for page in (*pdf.pages[:6], pdf.pages[-1])
        for _, modules in sorted(codes(page), key=lambda c: (round(c[0][1]), c[0][0]))
    ]


@pytest.fixture(scope="module")
def first_marks(labelled: list[str]) -> list[str]:
    """The marks on the same sheets."""
    return [*labelled[: 6 * 14], *labelled[-(len(labelled) % 14 or 14) :]]


MASKS = (
    lambda i, j: (i + j) % 2,
    lambda i, j: i % 2,
    lambda i, j: j % 3,
    lambda i, j: (i + j) % 3,
    lambda i, j: (i // 2 + j // 3) % 2,
    lambda i, j: i * j % 2 + i * j % 3,
    lambda i, j: (i * j % 2 + i * j % 3) % 2,
    lambda i, j: ((i + j) % 2 + i * j % 3) % 2,
)


def decoded(modules: Modules) -> str:
    """Return the text of a QR code of version 1 or 2 in byte mode, without error correction (ISO/IEC 18004)."""
    size = len(modules)
    assert size in (21, 25)
    free = np.ones((size, size), dtype=bool)
    free[:9, :9] = free[:9, -8:] = free[-8:, :9] = free[6] = free[:, 6] = False
    if size == 25:
        free[16:21, 16:21] = False
    # Bits 12 to 10 of the format, masked with 101: they stand in row 8, columns 2 to 4.
    number = int("".join(str(int(bit)) for bit in modules[8, 2:5]), 2) ^ 0b101
    bits = []
    columns = [column for column in range(size - 1, 0, -2) if column > 6] + [5, 3, 1]
    for turn, column in enumerate(columns):
        for row in range(size - 1, -1, -1) if turn % 2 == 0 else range(size):
            for j in (column, column - 1):
                if free[row, j]:
                    bits.append(bool(modules[row, j]) ^ (MASKS[number](row, j) == 0))
    stream = "".join("1" if bit else "0" for bit in bits)
    assert stream[:4] == "0100", "byte mode"
    length = int(stream[4:12], 2)
    return bytes(int(stream[12 + 8 * k : 20 + 8 * k], 2) for k in range(length)).decode("ascii")


def test_every_plank_and_every_beam_has_one_label(gridshell: Gridshell, labelled: list[str]) -> None:
    planks = list(index_of(gridshell).planks)
    beams = [beam.mark for shell in gridshell.shells for beam in shell.beams]
    assert sorted(labelled) == sorted([*planks, *beams])
    assert len(planks) == 183
    assert len(beams) == 66


def test_labels_are_sorted_by_mark_planks_first(gridshell: Gridshell, labelled: list[str]) -> None:
    count = len(index_of(gridshell).planks)
    assert labelled[:count] == sorted(labelled[:count])
    assert labelled[count:] == sorted(labelled[count:])


def test_a_sheet_holds_fourteen_labels_on_a4(pdf: PdfReader, gridshell: Gridshell) -> None:
    count = len(index_of(gridshell).planks) + sum(len(shell.beams) for shell in gridshell.shells)
    assert len(pdf.pages) == -(-count // 14)
    for page in pdf.pages:
        assert float(page.mediabox.width) * MM_PER_POINT == pytest.approx(210.0, abs=0.01)
        assert float(page.mediabox.height) * MM_PER_POINT == pytest.approx(297.0, abs=0.01)


def test_labels_lie_in_the_grid_of_the_sheet(pdf: PdfReader) -> None:
    """Two columns 101.6 mm apart, seven rows of 38.1 mm, each code with four modules of quiet zone in its label."""
    places = np.array([place for place, _ in codes(pdf.pages[0])])
    columns, rows = np.unique(places[:, 0].round(2)), np.unique(places[:, 1].round(2))
    assert np.diff(columns) == pytest.approx([101.6], abs=0.02)
    assert np.diff(rows) == pytest.approx([LABEL[1]] * 6, abs=0.02)
    module = 19.0 / 25.0
    assert min(columns[0] - 4.65, rows[0] - 15.15) > 4.0 * module


def test_the_codes_say_the_project_and_the_mark(
    gridshell: Gridshell, first_codes: list[Modules], first_marks: list[str]
) -> None:
    assert [decoded(modules) for modules in first_codes] == [f"{gridshell.name} {mark}" for mark in first_marks]


def test_the_codes_are_drawn_module_by_module(
    gridshell: Gridshell, first_codes: list[Modules], first_marks: list[str]
) -> None:
    for modules, mark in zip(first_codes, first_marks, strict=True):
        masked = [segno.make_qr(f"{gridshell.name} {mark}", error="m", mask=mask) for mask in range(8)]
        assert all(made.error in ("M", "Q", "H") for made in masked)
        drawn = [np.array([list(row) for row in made.matrix], dtype=bool) for made in masked]
        assert any(np.array_equal(modules, matrix) for matrix in drawn)


def test_a_label_tells_length_section_and_template(gridshell: Gridshell, text: str) -> None:
    templates = {member.mark: group.mark for group in templates_of(gridshell) for member in group.members}
    for plank in index_of(gridshell).planks.values():
        _, found, rest = text.partition(f"{plank.mark}\n")
        facts = rest[:120]
        assert found
        assert f"{plank.blank.length:.1f} x 100 x 12 mm" in facts
        assert f"template {templates[plank.mark]} " in facts
        assert f"{plank.family} · " in facts


def test_the_same_gridshell_gives_the_same_bytes(gridshell: Gridshell) -> None:
    one = replace(gridshell, shells=gridshell.shells[:1])
    assert labels_pdf(one) == labels_pdf(one)
