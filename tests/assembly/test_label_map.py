"""The maps of marks and the drawing of the layers: every mark once, none over another, heights of the real parts."""

import itertools
from dataclasses import replace
from xml.etree import ElementTree

import pytest

from aag_cad.language import LANGUAGES, Language
from aag_cad.parts.marks import parse_mark, short_mark
from aag_cad.parts.model import Shell
from assembly.base.errors import PlanError
from assembly.drawing.svg import Box, Label, label_box
from assembly.pictures.label_map import MAP_SIZE, label_map_svg
from assembly.pictures.layer_legend import layer_legend_svg

SVG = "{http://www.w3.org/2000/svg}"


def texts(svg: str) -> list[Label]:
    found = []
    for element in ElementTree.fromstring(svg).iter(f"{SVG}text"):
        size = float(element.attrib["font-size"])
        y = float(element.attrib["y"]) - 0.365 * size
        found.append(Label(element.text or "", float(element.attrib["x"]), y, size))
    return found


def overlap(a: Box, b: Box) -> bool:
    return min(a[2], b[2]) - max(a[0], b[0]) > 0.5 and min(a[3], b[3]) - max(a[1], b[1]) > 0.5


def wanted(shell: Shell, families: tuple[str, ...]) -> list[str]:
    joints = [joint.mark for joint in shell.joints if parse_mark(joint.mark).family in families]
    names = [mark[-3:] if parse_mark(mark).family in ("N", "K") else short_mark(mark) for mark in joints]
    flat = [plank.mark for plank in shell.planks if not plank.beam]
    return [*names, *(short_mark(mark) for mark in (*(beam.mark for beam in shell.beams), *flat))]


@pytest.mark.parametrize("families", [("N", "F", "R"), ("K",)])
def test_every_mark_stands_once_on_its_map_and_none_covers_another(shell: Shell, families: tuple[str, ...]) -> None:
    names = wanted(shell, families)
    labels = [label for label in texts(label_map_svg(shell, families)) if label.text in set(names)]
    assert sorted(label.text for label in labels) == sorted(names)
    boxes = [label_box(label) for label in labels]
    assert not [pair for pair in itertools.combinations(boxes, 2) if overlap(*pair)]


@pytest.mark.parametrize("size", [MAP_SIZE, (1800.0, 2600.0), (1800.0, 900.0)])
def test_a_map_is_no_larger_than_its_page(shell: Shell, size: tuple[float, float]) -> None:
    _, _, wide, high = map(float, ElementTree.fromstring(label_map_svg(shell, size=size)).attrib["viewBox"].split())
    assert wide <= size[0] + 0.1
    assert high <= size[1] + 0.1
    assert max(wide / size[0], high / size[1]) > 0.99


def test_numbers_on_a_map_can_be_read(shell: Shell) -> None:
    # 2 mm of type: capitals of 1.5 mm, as on the labels of the parts.
    assert min(label.size for label in texts(label_map_svg(shell))) >= 20.0


def test_the_layers_are_drawn_at_the_heights_of_the_parts(shell: Shell) -> None:
    found = {label.text for label in texts(layer_legend_svg(shell))}
    wide = next(plank for plank in shell.planks if plank.upright).blank.section.width
    thick = next(plank for plank in shell.planks if plank.family == "G").blank.section.thickness
    half = shell.studs[0].length / 2.0
    faces = (half, thick / 2.0 + wide, thick / 2.0, -thick / 2.0, -thick / 2.0 - wide, -half)
    assert {f"{height:+.0f}" for height in faces} <= found
    assert {"A1", "G", "A2"} <= found


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_layers_are_named_in_both_languages(shell: Shell, language: Language) -> None:
    joined = " ".join(label.text for label in texts(layer_legend_svg(shell, language)))
    for word in {"en": ("outside", "inside", "stud"), "de": ("außen", "innen", "Knotenstab")}[language]:
        assert word in joined


def test_layers_cannot_be_shown_without_a_node(shell: Shell) -> None:
    with pytest.raises(PlanError, match="S1"):
        layer_legend_svg(replace(shell, studs=()))


def test_the_drawings_are_the_same_each_time(shell: Shell) -> None:
    assert label_map_svg(shell) == label_map_svg(shell)
    assert layer_legend_svg(shell) == layer_legend_svg(shell)
