"""The HTML report of an optimised web: its figures are those of the web, and it needs nothing but itself."""

import math
import re
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from aag_cad.errors import FileError
from aag_cad.export.office.optimise_report import report_html, write_report
from aag_cad.web.goals import Goals, Iteration, Optimised, PointGoal, Reason
from aag_cad.web.line_curvatures import largest_bending
from aag_cad.web.quality import quality
from aag_cad.web.web import Web, crpc_web

ASKED = Goals(
    angle=math.radians(120.0),
    bottom_row=2,
    height=1800.0,
    span=5100.0,
    points=(PointGoal(2, 0, (-4406.0, -2550.0, 3.0)),),
    closeness=1e-5,
    min_radius=1700.0,
    max_twist=math.radians(60.0) / 1000.0,
)
VOID = {"meta", "br", "path", "rect", "circle"}


def exact_web(columns: int = 15, rows: int = 10) -> Web:
    return crpc_web(5100.0, 3.0, -8823.0, np.linspace(-math.pi / 6.0, math.pi / 6.0, columns), 2, rows)


def optimised(web: Web, reason: Reason = "converged", explanation: str = "planarity per edge 4e-16") -> Optimised:
    """Return a web with a history of two stages whose energies are known, from a start 5 percent too high."""
    history = tuple(
        Iteration(k, "spline" if k < 4 else "mesh", {"A-net": 10.0 ** -(3 * k), "twist": 0.0}, 0.5**k) for k in range(7)
    )
    return Optimised(web, reason, explanation, history, web.vertices * np.array([1.0, 1.0, 1.05]))


@pytest.fixture(scope="module")
def html() -> str:
    return report_html(optimised(exact_web()), ASKED)


class _Reader(HTMLParser):
    """Tags that are open, rows of table cells, and the addresses that a page asks for."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.rows: list[list[str]] = []
        self.addresses: list[str] = []
        self.tags: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.addresses += [value or "" for name, value in attrs if name in ("src", "href", "data", "srcset")]
        if tag not in VOID:
            self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag: str) -> None:
        if tag not in VOID:
            assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] in ("td", "th"):
            self.rows[-1][-1] += data


def read(html: str) -> _Reader:
    reader = _Reader()
    reader.feed(html)
    assert not reader.open
    return reader


def table(html: str) -> dict[str, list[str]]:
    return {row[0]: row[1:] for row in read(html).rows}


def pictures(html: str) -> list[ElementTree.Element]:
    found = re.findall(r"<svg.*?</svg>", html, re.DOTALL)
    return [ElementTree.fromstring(svg.replace(' xmlns="http://www.w3.org/2000/svg"', "")) for svg in found]


def painted(picture: ElementTree.Element, key: str, value: str) -> list[ElementTree.Element]:
    """Return the groups of a picture that are painted so."""
    return [group for group in picture.iter("g") if group.attrib.get(key) == value]


def cells(picture: ElementTree.Element) -> dict[str, int]:
    """Return how many cells of a map there are of each colour."""
    shapes = {group.attrib["fill"]: group.findall("path") for group in painted(picture, "stroke-width", "0.4")}
    return {ink: sum(shape.attrib["d"].count("Z") for shape in found) for ink, found in shapes.items()}


def test_the_file_needs_no_other(html: str) -> None:
    """No scripts, no links, no pictures from elsewhere, no style that imports."""
    reader = read(html)
    assert reader.addresses == []
    assert not {"script", "link", "img", "iframe", "object"} & set(reader.tags)
    assert not re.search(r"https?://(?!www\.w3\.org)|url\(|@import", html)


def test_it_opens_with_the_reason_why_the_optimiser_stopped(html: str) -> None:
    assert "<b>Success: converged.</b> planarity per edge 4e-16" in html
    stalled = report_html(optimised(exact_web(), "stalled", "planarity 3e-5, allowed < 1e-7 & more"), ASKED)
    assert "<b>No success: stalled.</b> planarity 3e-5, allowed &lt; 1e-7 &amp; more" in stalled


def test_goals_stand_beside_what_was_reached(html: str) -> None:
    web = exact_web()
    rows = table(html)
    assert rows["Angle between the A lines, deg"] == ["120.00", "120.00 to 120.00"]
    assert float(rows["Height, mm"][1]) == pytest.approx(float(web.vertices[-1, 7, 2]), abs=0.51)
    assert rows["Span, mm"] == ["5100", "5100"]
    corner = float(np.linalg.norm(web.vertices[2, 0] - np.array(ASKED.points[0].point)))
    assert float(rows["Vertex 2, 0: distance from its point, mm"][1]) == pytest.approx(corner, abs=0.001)
    tightest = 1.0 / float(largest_bending(web).max())
    assert float(rows["Smallest bending radius, mm, at least"][1]) == pytest.approx(tightest, abs=0.51)
    assert rows["Largest twist, deg/m, at most"][0] == "60.00"
    move = 0.05 * float(np.abs(web.vertices[..., 2]).max())
    assert float(rows["Close to the start (weight 1e-05): largest move, mm"][1]) == pytest.approx(move, abs=0.01)


def test_goals_that_were_left_free_have_no_row() -> None:
    rows = table(report_html(optimised(exact_web()), Goals(angle=None, symmetric=False)))
    assert not {"Angle between the A lines, deg", "Height, mm", "Span, mm"} & set(rows)


def test_quality_is_given_before_and_after(html: str) -> None:
    web = exact_web()
    before, after = quality(Web(optimised(web).start)), quality(web)
    rows = table(html)
    found = [float(text) for text in rows["Extent z, m"]]
    assert found == pytest.approx([before.extent[2] / 1000.0, after.extent[2] / 1000.0], abs=5e-4)
    found = [float(text) for text in rows["Acute angle A to A, largest, deg"]]
    assert found == pytest.approx([before.angle_aa_deg.max, after.angle_aa_deg.max], abs=5e-3)
    assert float(rows["Planarity of the A stars, per edge, largest"][0]) == pytest.approx(
        before.planarity_per_edge, rel=0.05
    )


def test_the_history_is_drawn_on_a_logarithmic_scale(html: str) -> None:
    """Energies of 10^(-3k) fall on a straight line; one that is always zero has no line, and says so."""
    chart = pictures(html)[0]
    # Each energy has its line and a sample of it beside its name.
    (drawn, _), (sample,) = (group.findall("path") for group in painted(chart, "stroke-width", "1.5"))
    points = np.array(drawn.attrib["d"][1:].split(), dtype=float).reshape(-1, 2)
    assert points.shape == (7, 2)
    # Coordinates are printed to a tenth, so that second differences are within two tenths.
    assert np.abs(np.diff(points, 2, axis=0)).max() < 0.25
    assert points[-1, 1] > points[0, 1]
    assert len(sample.attrib["d"].split()) == 4
    texts = [text.text for text in chart.iter("text")]
    assert {"spline", "mesh", "A-net", "twist (zero)", "1e0", "1e-18"} <= set(texts)


def test_five_maps_cover_the_inner_vertices_and_give_their_range(html: str) -> None:
    web = exact_web()
    maps = dict(zip(re.findall(r"<figcaption><b>(.*?)</b>", html), pictures(html)[1:], strict=True))
    assert list(maps) == [
        "Normal curvature of A lines, 1/m",
        "Geodesic curvature of G lines, 1/m",
        "Twist, deg/m",
        "Bending radius, m",
        "Angle error, deg",
    ]
    inner = (web.vertices.shape[0] - 2) * (web.vertices.shape[1] - 2)
    for picture in maps.values():
        assert sum(cells(picture).values()) == inner
    low, high = (float(text.text or "") for text in maps["Bending radius, m"].iter("text"))
    bending = largest_bending(web)
    assert (low, high) == pytest.approx((1e-3 / bending.min(), 1e-3 / bending.max()), abs=0.01)
    assert float([*maps["Twist, deg/m"].iter("text")][1].text or "") == pytest.approx(
        quality(web).largest_twist_deg_per_m, abs=0.005
    )


def test_rounding_errors_are_not_painted_as_a_pattern(html: str) -> None:
    """Where a measure is zero to rounding, all cells have the lightest colour and the scale ends at the threshold."""
    for picture in pictures(html)[1:3]:
        assert cells(picture).keys() == {"#fffbdc"}
        assert [text.text for text in picture.iter("text")][1] == "1.0e-09"


def test_the_scale_darkens_evenly_for_a_print_in_black_and_white(html: str) -> None:
    groups = (group for group in pictures(html)[3].iter("g") if group.find("rect") is not None)
    inks = [group.attrib["fill"] for group in groups if group.attrib["fill"] != "none"]
    rgb = np.array([[int(ink[k : k + 2], 16) for k in (1, 3, 5)] for ink in inks])
    luminance = rgb @ np.array([0.2126, 0.7152, 0.0722])
    assert np.all(np.diff(luminance) < 0.0)
    assert luminance[0] - luminance[-1] > 190.0


def test_fine_webs_are_drawn_in_blocks_that_keep_the_worst_vertex() -> None:
    """A kink at one vertex of 12 000 stays the darkest cell, and the file stays small."""
    vertices = exact_web(150, 80).vertices.copy()
    vertices[40, 71, 1] += 1.0
    html = report_html(optimised(Web(vertices)), ASKED)
    assert len(html) < 1_500_000
    picture = pictures(html)[2]
    assert 1 <= cells(picture)["#221854"] <= 2
    assert re.search(r"at row (39|40|41), column 71", html)


def test_a_flat_web_is_reported_without_radii() -> None:
    """The collapsed web has no curvature: its radius has no bound and is printed as a dash."""
    x, y = np.meshgrid(np.arange(12) * 300.0, np.arange(9) * 300.0 / math.sqrt(3.0))
    flat = Web(np.stack([x, y, np.zeros_like(x)], axis=-1))
    collapsed = Optimised(flat, "collapsed", "the web has become flat", (), flat.vertices)
    html = report_html(collapsed, Goals(angle=math.radians(120.0), min_radius=1700.0))
    assert table(html)["Smallest bending radius, mm, at least"] == ["1700", "\N{EN DASH}"]
    assert "No iteration with an energy above zero." in html


def test_the_same_web_gives_the_same_bytes(tmp_path: Path, html: str) -> None:
    write_report(optimised(exact_web()), ASKED, tmp_path / "report.html")
    assert (tmp_path / "report.html").read_bytes() == html.encode("utf-8")


def test_a_folder_in_the_way_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "report.html" / "in-the-way").mkdir(parents=True)
    with pytest.raises(FileError, match=r"report\.html"):
        write_report(optimised(exact_web()), ASKED, tmp_path / "report.html")
