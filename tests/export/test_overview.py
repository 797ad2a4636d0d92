"""The picture of the whole vault for the front page of the documentation."""

import struct
from pathlib import Path
from xml.etree import ElementTree

import pytest

from aag_cad.errors import FileError
from aag_cad.export.office.overview import BACKGROUND, PIXELS_WIDE, write_overview
from aag_cad.parts.model import Gridshell
from aag_cad.typesetting import png_of
from assembly.drawing.perspective import perspective_svg

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def folder(gridshell: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("overview")
    write_overview(gridshell, path / "vault.svg", path / "vault.png")
    return path


def _size_of_png(data: bytes) -> tuple[int, int]:
    assert data.startswith(b"\x89PNG\r\n\x1a\n")
    width, height = struct.unpack(">II", data[16:24])
    return width, height


def test_the_svg_is_well_formed_and_small_enough_for_a_web_page(folder: Path) -> None:
    text = (folder / "vault.svg").read_text(encoding="utf-8")
    root = ElementTree.fromstring(text)
    assert root.tag == f"{SVG}svg"
    assert len(text) < 2_000_000


def test_the_png_has_the_width_asked_for_and_the_shape_of_the_svg(folder: Path) -> None:
    width, height = _size_of_png((folder / "vault.png").read_bytes())
    *_, wide, high = map(float, ElementTree.parse(folder / "vault.svg").getroot().attrib["viewBox"].split())
    assert width == PIXELS_WIDE
    # Half a pixel of rounding on either side.
    assert height == pytest.approx(PIXELS_WIDE * high / wide, abs=1.0)


def test_the_same_gridshell_gives_the_same_picture(gridshell: Gridshell, folder: Path) -> None:
    svg = perspective_svg(gridshell, background=BACKGROUND)
    assert svg == (folder / "vault.svg").read_text(encoding="utf-8")
    assert png_of(svg, PIXELS_WIDE) == (folder / "vault.png").read_bytes()


def test_a_smaller_png_can_be_had(folder: Path) -> None:
    svg = (folder / "vault.svg").read_text(encoding="utf-8")
    assert _size_of_png(png_of(svg, 400))[0] == 400


def test_a_folder_in_the_way_is_an_error(gridshell: Gridshell, tmp_path: Path) -> None:
    (tmp_path / "vault.svg" / "in-the-way").mkdir(parents=True)
    with pytest.raises(FileError, match=r"vault\.svg"):
        write_overview(gridshell, tmp_path / "vault.svg", tmp_path / "vault.png")
    assert not (tmp_path / "vault.png").exists()
