"""The drill templates, measured in the vector content of the PDF."""

import io
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pytest
from pypdf import PageObject, PdfReader

from aag_cad.errors import DesignError
from aag_cad.export.workshop.drill_templates import PAPERS, PaperName, part_stations, templates_pdf
from aag_cad.parts.forms import Blank, CrossSection, EndCut, Hole
from aag_cad.parts.model import Gridshell, Plank
from aag_cad.units import Floats

MM_PER_POINT = 25.4 / 72.0
PAGE_LIMIT = 14400.0
# Single precision in the PDF file and its own rounding to 1e-4 points leave 0.002 mm at 5 m; the task asks for 0.1 mm.
AT_FIVE_METRES = 0.1


@dataclass(frozen=True)
class Segment:
    """A straight line as it is printed: ends in mm from the lower left corner of the page, line width in mm."""

    start: tuple[float, float]
    end: tuple[float, float]
    width: float

    @property
    def length(self) -> float:
        """Length in mm."""
        return math.dist(self.start, self.end)

    @property
    def middle(self) -> tuple[float, float]:
        """The point half-way, mm."""
        return (self.start[0] + self.end[0]) / 2.0, (self.start[1] + self.end[1]) / 2.0


def segments(page: PageObject) -> Iterator[Segment]:
    """Yield all stroked straight lines of a page, through its transformations; curves are passed over."""
    contents = page.get_contents()
    assert contents is not None
    matrix, width, stack = np.eye(3), 1.0, []
    path: list[tuple[str, Floats]] = []
    for operands, operator in contents.operations:
        if operator == b"q":
            stack.append((matrix, width))
        elif operator == b"Q":
            matrix, width = stack.pop()
        elif operator == b"cm":
            a, b, c, d, e, f = (float(value) for value in operands)
            matrix = matrix @ np.array([[a, c, e], [b, d, f], [0.0, 0.0, 1.0]])
        elif operator == b"w":
            width = float(operands[0])
        elif operator in (b"m", b"l", b"c"):
            point = matrix @ np.array([float(operands[-2]), float(operands[-1]), 1.0])
            path.append((operator.decode(), point[:2] * MM_PER_POINT))
        elif operator in (b"S", b"s"):
            scale = math.sqrt(abs(np.linalg.det(matrix[:2, :2]))) * MM_PER_POINT
            for (_, start), (kind, end) in pairwise(path):
                if kind == "l":
                    yield Segment((start[0], start[1]), (end[0], end[1]), width * scale)
            path = []
        elif operator in (b"f", b"F", b"f*", b"n", b"B", b"b"):
            path = []


def crosses(page: PageObject, width: float, least: float = 0.0) -> Floats:
    """Return the centres (n, 2) of crosses of two lines of a width, sorted from left to right, mm."""
    lines = [line for line in segments(page) if abs(line.width - width) < 0.005 and line.length >= least]
    level = [line.middle for line in lines if abs(line.start[1] - line.end[1]) < 0.01]
    plumb = [line.middle for line in lines if abs(line.start[0] - line.end[0]) < 0.01]
    found = {a for a in level for b in plumb if math.dist(a, b) < 0.005}
    return np.array(sorted(found)).reshape(-1, 2)


def hole_crosses(page: PageObject) -> Floats:
    return crosses(page, 0.12)


def register_crosses(page: PageObject) -> Floats:
    return crosses(page, 0.2, 8.9)


def alone(gridshell: Gridshell, *planks: Plank) -> Gridshell:
    """Return the gridshell with these planks only."""
    return replace(gridshell, shells=(replace(gridshell.shells[0], planks=planks),))


def pages(gridshell: Gridshell, paper: PaperName = "roll") -> list[PageObject]:
    return list(PdfReader(io.BytesIO(templates_pdf(gridshell, paper))).pages)


@pytest.fixture(scope="module")
def plank(gridshell: Gridshell) -> Plank:
    """A plank of one page: upright, 3.8 m, with bolts off its centre line."""
    return gridshell.shells[0].planks[0]


@pytest.fixture(scope="module")
def long_plank(plank: Plank) -> Plank:
    """A plank of 12 m: three pages on the roll."""
    holes = tuple(Hole(110.0 + 371.37 * i, 18.0 * (-1) ** i, 9.0, "bolt", f"S1-K-{i + 1:03d}") for i in range(32))
    return replace(plank, blank=Blank(12000.0, CrossSection(100.0, 12.0), holes))


def test_the_crosses_of_a_template_lie_where_the_holes_are(gridshell: Gridshell, plank: Plank) -> None:
    (page,) = pages(alone(gridshell, plank))
    drawn = hole_crosses(page)
    holes = np.array([(hole.station, hole.offset) for hole in plank.blank.holes])
    wanted = holes[np.lexsort((holes[:, 1], holes[:, 0]))]
    assert drawn.shape == wanted.shape
    gaps = (drawn - drawn[0]) - (wanted - wanted[0])
    assert np.abs(gaps).max() < AT_FIVE_METRES * plank.blank.length / 5000.0


def test_a_template_is_true_to_a_tenth_of_a_millimetre_in_five_metres(gridshell: Gridshell, plank: Plank) -> None:
    """The longest page: 4.7 m of plank, from the first cross to the last."""
    holes = (Hole(20.0, 0.0, 9.0, "bolt", "S1-K-001"), Hole(4640.0, 0.0, 9.0, "bolt", "S1-K-002"))
    single = replace(plank, blank=Blank(4660.0, CrossSection(100.0, 12.0), holes))
    (page,) = pages(alone(gridshell, single))
    (x1, y1), (x2, y2) = hole_crosses(page)
    assert x2 - x1 == pytest.approx(4620.0, abs=AT_FIVE_METRES * 4620.0 / 5000.0)
    assert x2 - x1 == pytest.approx(4620.0, abs=0.005)
    assert y1 == pytest.approx(y2, abs=0.001)


def test_the_outline_has_the_size_of_the_plank_and_starts_at_the_arrow(gridshell: Gridshell, plank: Plank) -> None:
    (page,) = pages(alone(gridshell, plank))
    lengths = [line.length for line in segments(page) if abs(line.width - 0.3) < 0.005]
    assert sum(abs(length - plank.blank.length) < 0.05 for length in lengths) == 2
    first = hole_crosses(page)[0]
    edges = [line for line in segments(page) if abs(line.length - plank.blank.length) < 0.05]
    start = min(line.start[0] for line in edges)
    assert first[0] - start == pytest.approx(plank.blank.holes[0].station, abs=0.005)


def test_skew_ends_are_drawn_skew(gridshell: Gridshell, plank: Plank) -> None:
    skew = replace(plank, blank=replace(plank.blank, start_cut=EndCut(60.0)))
    (page,) = pages(alone(gridshell, skew))
    tilted = [line for line in segments(page) if line.length > 100.0 and 1.0 < abs(line.end[0] - line.start[0]) < 100.0]
    (end,) = tilted
    assert end.length == pytest.approx(100.0 / math.sin(math.radians(60.0)), abs=0.01)


@pytest.mark.parametrize("paper", ["roll", "a3"])
def test_both_check_bars_measure_a_hundred_millimetres(gridshell: Gridshell, plank: Plank, paper: PaperName) -> None:
    wider = replace(plank, blank=replace(plank.blank, section=CrossSection(90.0, 12.0)))
    for page in pages(alone(gridshell, wider), paper):
        bars = [line for line in segments(page) if abs(line.length - 100.0) < 0.01]
        assert any(abs(line.start[0] - line.end[0]) < 0.01 for line in bars), "upright"
        assert any(abs(line.start[1] - line.end[1]) < 0.01 for line in bars), "level"


@pytest.mark.parametrize("paper", ["roll", "a3"])
def test_no_page_is_larger_than_a_pdf_page_may_be(gridshell: Gridshell, long_plank: Plank, paper: PaperName) -> None:
    """ISO 32000-1, annex C: 14 400 points."""
    sizes = [
        (float(page.mediabox.width), float(page.mediabox.height)) for page in pages(alone(gridshell, long_plank), paper)
    ]
    assert max(max(size) for size in sizes) <= PAGE_LIMIT
    if paper == "a3":
        assert np.allclose(sizes, (420.0 / MM_PER_POINT, 297.0 / MM_PER_POINT), atol=0.1)
    else:
        assert len(sizes) == 3
        assert all(height * MM_PER_POINT < 210.0 for _, height in sizes)


def test_parts_of_a_long_plank_meet_at_their_register_marks(gridshell: Gridshell, long_plank: Plank) -> None:
    """Laid register on register, the crosses of all parts keep the distances of the plank."""
    offset, placed = 0.0, []
    last: float | None = None
    for page in pages(alone(gridshell, long_plank)):
        marks = register_crosses(page)[:, 0]
        if last is not None:
            offset += last - marks.min()
        for x, _y in hole_crosses(page):
            placed.append(float(x) + offset)
        last = float(marks.max())
    # A hole in the overlap is drawn on both parts.
    distinct = [x for i, x in enumerate(sorted(placed)) if i == 0 or x - sorted(placed)[i - 1] > 0.05]
    stations = np.array([hole.station for hole in long_plank.blank.holes])
    assert len(distinct) == len(stations)
    assert np.abs((np.array(distinct) - distinct[0]) - (stations - stations[0])).max() < 0.1


def test_registers_of_tiles_lie_at_whole_millimetres_of_the_plank(gridshell: Gridshell, plank: Plank) -> None:
    """On A3: each part that shows a hole shows it at its distance from the line where the part begins."""
    stations = part_stations(plank.blank, PAPERS["a3"])
    assert all(station == round(station) for station in stations[1:-1])
    (first, *_others) = pages(alone(gridshell, plank), "a3")
    # The upper strip of the first sheet is part 1; its meeting line is at the second part station.
    marks = register_crosses(first)
    top = marks[marks[:, 1] > marks[:, 1].max() - 1.0]
    holes = hole_crosses(first)
    upper = holes[holes[:, 1] > first.mediabox.height * MM_PER_POINT / 2.0]
    assert top[-1, 0] - upper[0, 0] == pytest.approx(stations[1] - plank.blank.holes[0].station, abs=0.01)


@pytest.mark.parametrize("paper", ["roll", "a3"])
def test_parts_fit_the_paper_and_meet_clear_of_the_holes(gridshell: Gridshell, paper: PaperName) -> None:
    for plank in gridshell.shells[0].planks:
        stations = part_stations(plank.blank, PAPERS[paper])
        assert (stations[0], stations[-1]) == (0.0, plank.blank.length)
        assert all(0.0 < b - a <= PAPERS[paper].usable for a, b in pairwise(stations))
        for hole in plank.blank.holes:
            assert all(abs(hole.station - cut) > hole.diameter / 2.0 + 5.0 for cut in stations[1:-1])


@pytest.mark.parametrize("paper", ["roll", "a3"])
def test_every_station_is_printed_once(gridshell: Gridshell, long_plank: Plank, paper: PaperName) -> None:
    words = " ".join(page.extract_text() for page in pages(alone(gridshell, long_plank), paper)).split()
    for hole in long_plank.blank.holes:
        assert words.count(f"{hole.station:.1f}") == 1
        assert words.count(hole.joint.removeprefix("S1-")) == 1


def test_the_sheet_says_which_planks_how_to_lay_them_and_at_what_scale(gridshell: Gridshell) -> None:
    planks = [plank for shell in gridshell.shells for plank in shell.planks if plank.mark[2:] in ("-E-02", "-E-03")]
    shells = tuple(
        replace(shell, planks=tuple(p for p in planks if p.mark.startswith(shell.mark))) for shell in gridshell.shells
    )
    text = "\n".join(page.extract_text() for page in pages(replace(gridshell, shells=shells)))
    for plank in planks:
        assert text.count(plank.mark) >= 1
    for words in (
        "T-01",
        "START",
        "END",
        "print at 100 %",
        "turned over (start at START, drawn face down)",
        "4430.3 mm",
    ):
        assert words in text


def test_a_slot_is_drawn_as_long_as_it_is(gridshell: Gridshell, plank: Plank) -> None:
    slotted = replace(plank.blank.holes[0], slot=6.0)
    (page,) = pages(alone(gridshell, replace(plank, blank=replace(plank.blank, holes=(slotted,)))))
    (level,) = [line for line in segments(page) if abs(line.width - 0.12) < 0.005 and line.start[1] == line.end[1]]
    assert level.length == pytest.approx(9.0 + 6.0 + 8.0, abs=0.01)


def test_a_plank_too_wide_for_a_tile_is_refused_with_the_remedy(gridshell: Gridshell, plank: Plank) -> None:
    wide = replace(plank, blank=replace(plank.blank, section=CrossSection(260.0, 12.0)))
    with pytest.raises(DesignError, match=r"S1-A1-01-L: .* 260 mm wide .* print on a roll"):
        templates_pdf(alone(gridshell, wide), "a3")
    (page,) = pages(alone(gridshell, wide))
    assert float(page.mediabox.height) * MM_PER_POINT > 260.0


def test_an_unknown_paper_is_refused_with_those_that_there_are(gridshell: Gridshell) -> None:
    with pytest.raises(DesignError, match="paper: 'a4' is not known; choose one of roll, a3"):
        templates_pdf(gridshell, "a4")  # type: ignore[arg-type]


def test_the_same_gridshell_gives_the_same_bytes(gridshell: Gridshell, plank: Plank, long_plank: Plank) -> None:
    few = alone(gridshell, plank, replace(long_plank, mark="S1-A1-02-L"))
    assert templates_pdf(few) == templates_pdf(few)
