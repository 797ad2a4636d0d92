"""The floor plan: to scale, readable, and the same figures in the drawing as in the table."""

import itertools
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from aag_cad.language import LANGUAGES
from aag_cad.parts.marks import short_mark
from aag_cad.parts.model import Shell
from aag_cad.units import Floats
from assembly.base.errors import PlanError
from assembly.drawing.svg import Box, Label, label_box
from assembly.laying.flattening import FlatState, flat_state
from assembly.laying.order import FlatOrder
from assembly.pictures.laying_plan import PAGES, Page, laying_header, laying_plan_svg, laying_rows

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def state(shell: Shell) -> FlatState:
    return flat_state(shell)


def texts(svg: str) -> list[Label]:
    """Return the texts of a drawing that stand centred, with their places and sizes."""
    found = []
    for element in ElementTree.fromstring(svg).iter(f"{SVG}text"):
        size = float(element.attrib["font-size"])
        y = float(element.attrib["y"]) - 0.365 * size
        if element.attrib["text-anchor"] == "middle":
            found.append(Label(element.text or "", float(element.attrib["x"]), y, size))
    return found


def words(svg: str) -> set[str]:
    return {element.text or "" for element in ElementTree.fromstring(svg).iter(f"{SVG}text")}


def scale_of(svg: str) -> int:
    return int(next(word for word in words(svg) if word.startswith("1 : ")).removeprefix("1 : "))


def circles(svg: str, radius: float) -> Floats:
    found = [e.attrib for e in ElementTree.fromstring(svg).iter(f"{SVG}circle") if float(e.attrib["r"]) == radius]
    return np.array([(float(a["cx"]), float(a["cy"])) for a in found])


def overlap(a: Box, b: Box) -> bool:
    return min(a[2], b[2]) - max(a[0], b[0]) > 0.5 and min(a[3], b[3]) - max(a[1], b[1]) > 0.5


@pytest.mark.parametrize("page", ["a4", "a3"])
def test_the_plan_is_to_the_scale_that_it_states(shell: Shell, state: FlatState, page: Page) -> None:
    svg = laying_plan_svg(shell, state, page=page)
    n = scale_of(svg)
    drawn = circles(svg, 8.0)[: len(state.studs)]
    floor = np.array(list(state.studs.values()))
    # A tenth of a mm on paper is a sheet unit; coordinates are rounded to a tenth of it.
    assert (drawn - drawn[0]) * [1.0, -1.0] * n / 10.0 == pytest.approx(floor - floor[0], abs=0.011 * n)


@pytest.mark.parametrize("page", ["a4", "a3"])
def test_the_plan_fits_its_page(shell: Shell, state: FlatState, page: Page) -> None:
    _, _, wide, high = map(
        float, ElementTree.fromstring(laying_plan_svg(shell, state, page=page)).attrib["viewBox"].split()
    )
    assert (wide, high) <= PAGES[page]
    assert high <= PAGES[page][1]
    assert scale_of(laying_plan_svg(shell, state, page=page)) <= {"a4": 50, "a3": 25}[page]


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_member_and_stud_is_named_and_no_name_covers_another(
    shell: Shell, state: FlatState, language: str
) -> None:
    svg = laying_plan_svg(shell, state, language="de" if language == "de" else "en")
    names = {short_mark(member.mark) for member in state.members}
    numbers = {stud.mark[-3:] for stud in shell.studs}
    assert names | numbers <= words(svg)
    boxes = [label_box(label) for label in texts(svg) if label.text in names | numbers]
    assert len(boxes) == len(names) + len(numbers)
    assert not [pair for pair in itertools.combinations(boxes, 2) if overlap(*pair)]


def test_the_grid_is_numbered_in_whole_metres(shell: Shell, state: FlatState) -> None:
    svg = laying_plan_svg(shell, state)
    across = int(state.size[0] // 1000.0)
    assert {str(metre) for metre in range(across)} | {f"{across} m"} <= words(svg)


def test_stacks_stand_beside_the_floor_in_the_plan(shell: Shell, state: FlatState) -> None:
    assert state.view_origin is not None
    beside = np.array([state.size[0] / 2.0, -1000.0]) - state.view_origin
    order = FlatOrder((), (), stacks={("S1", "A1"): (float(beside[0]), float(beside[1])), ("S2", "A1"): (0.0, 0.0)})
    plain, stacked = laying_plan_svg(shell, state), laying_plan_svg(shell, state, order, "de")
    (found,) = [label for label in texts(stacked) if label.text == "Stapel A1"]
    lowest = max(circles(stacked, 8.0)[: len(state.studs), 1])
    studs = min(point[1] for point in state.studs.values())
    assert (found.y - lowest) * scale_of(stacked) / 10.0 == pytest.approx(studs + 1000.0, abs=5.0)
    assert not [word for word in words(plain) if "stack" in word]


def test_a_floor_that_no_page_holds_is_an_error(shell: Shell, state: FlatState) -> None:
    with pytest.raises(PlanError, match="larger page"):
        laying_plan_svg(shell, replace(state, size=(90_000.0, 60_000.0)))


def test_the_table_sets_out_every_end_and_stud(shell: Shell, state: FlatState) -> None:
    rows = laying_rows(shell, state)
    assert all(len(row) == len(laying_header()) for row in rows)
    assert len(rows) == len(state.foot) + len(state.members) + len(state.studs)
    by_mark = {row[0]: row for row in rows}
    for plank in (plank for plank in shell.planks if plank.family == "G"):
        x, y, to_x, to_y = map(float, by_mark[short_mark(plank.mark)][2:])
        # A plank that lies straight: its ends are its length apart, each rounded to a mm.
        assert np.hypot(to_x - x, to_y - y) == pytest.approx(plank.curve.length, abs=1.5)
    for row in rows:
        figures = np.array([float(value) for value in row[2:] if value]).reshape(-1, 2)
        assert (figures >= 0.0).all()
        assert (figures <= np.ceil(np.array(state.size))).all()
        assert "-0" not in row


def test_german_and_english_tables_differ_in_words_only(shell: Shell, state: FlatState) -> None:
    english, german = laying_rows(shell, state), laying_rows(shell, state, "de")
    assert [row[0:1] + row[2:] for row in english] == [row[0:1] + row[2:] for row in german]
    assert laying_header() != laying_header("de")
    assert {row[1] for row in english}.isdisjoint({row[1] for row in german})
