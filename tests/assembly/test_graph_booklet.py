"""The booklet of any graph of parts: who lies on whom is seen, where each piece lies is read, every part is counted."""

import json
import math
import re
from collections import Counter
from collections.abc import Iterator
from typing import Any

import networkx as nx
import numpy as np
import pytest
from pdf_texts import page_texts

from aag_cad.design_making import Minutes
from aag_cad.language import LANGUAGES, Language
from assembly.booklet.booklet_data import Booklet
from assembly.booklet.graph_booklet import graph_booklet
from assembly.booklet.pdf import booklet_pdf
from assembly.booklet.phone_page import page_html
from assembly.graph.files import graph_text, read_graph
from assembly.graph.interlacing import interlacing
from assembly.graph.laying_units import units_of
from assembly.graph.whole import whole_graph
from assembly.pictures.floor import Floor, floor_of
from assembly.pictures.weave_pictures import cover_svg
from assembly.plan.durations import step_minutes
from assembly.plan.graph_plan import graph_plan
from assembly.plan.schedule import schedule_of

MINUTES = Minutes.model_validate({})
Points = tuple[tuple[float, float, float], tuple[float, float, float]]


def made(graph: Any, language: Language = "en") -> Booklet:
    plan = graph_plan(graph, 4, 25.0)
    return graph_booklet(graph, plan, schedule_of(plan, step_minutes(plan, graph, MINUTES), 4), language)


def floor(graph: Any) -> Floor:
    whole = whole_graph(graph)
    return floor_of(whole, units_of(whole), interlacing(whole, later=()))


def printed(booklet: Booklet) -> str:
    return " ".join(page_texts(booklet_pdf(booklet)))


def planks(*lines: tuple[str, Points], **more: Any) -> "nx.Graph[str]":
    """Return planks that do not touch."""
    graph: nx.Graph[str] = nx.Graph(name="planks")
    for mark, (start, end) in lines:
        long = math.dist(start, end)
        graph.add_node(mark, kind="plank", mass_kg=long / 400.0, length_mm=long, start=start, end=end, **more)
    return graph


def along(y: float, long: float = 3000.0) -> Points:
    return (0.0, y, 0.0), (long, y, 0.0)


@pytest.fixture(scope="module")
def kagome() -> Any:
    return read_graph(graph_text("kagome"))


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_booklet_of_kagome_lists_its_planks_by_section_and_length(kagome: Any, language: Language) -> None:
    booklet = made(kagome, language)
    name = {"en": "plank 100 x 12", "de": "Brett 100 x 12"}[language]
    *rows, whole = booklet.data["cover"]["totals"]["rows"]
    assert [row[:3] for row in rows] == [[name, f"{long} mm", "6"] for long in (2685, 3685, 4685)]
    assert whole[2] == "18"
    text = printed(booklet)
    assert text.count(name) == 3 + 18
    assert {"en": "HOLD", "de": "HALT"}[language] in text
    assert re.search(r"\b(the|and|from|piece|start|people)\b", text) is None or language == "en"
    assert booklet_pdf(booklet) == booklet_pdf(made(kagome, language))


def filled(picture: str) -> Iterator[np.ndarray[Any, Any]]:
    """Yield the outlines of filled shapes in the order in which they are painted."""
    for fill, items in re.findall(r'<g fill="([^"]+)"[^>]*>(.*?)</g>', picture):
        if fill != "none":
            for path in re.findall(r'<path d="M([^"]*)Z"/>', items):
                yield np.array([float(x) for x in path.split()]).reshape(-1, 2)


def inside(outline: np.ndarray[Any, Any], point: np.ndarray[Any, Any]) -> bool:
    sides = np.roll(outline, -1, axis=0) - outline
    gaps = point - outline
    turns = sides[:, 0] * gaps[:, 1] - sides[:, 1] * gaps[:, 0]
    return bool(np.all(turns > 0.0) or np.all(turns < 0.0))


def test_at_every_crossing_of_the_cover_the_upper_plank_is_seen(kagome: Any) -> None:
    """The shape painted last over the middle of a crossing runs along the upper plank, for all 72, in a true weave."""
    found = floor(kagome)
    shapes = list(filled(cover_svg(found)))
    strips = dict(zip(found.lines, shapes, strict=False))
    assert len(found.crossings) == 72
    for lower, upper in found.crossings:
        (a, b), (c, d) = (strips[mark][[0, 1]] + strips[mark][[3, 2]] for mark in (lower, upper))
        shares = np.linalg.solve(np.column_stack([b - a, c - d]), c - a)
        seen = [shape for shape in shapes if inside(shape, (a + shares[0] * (b - a)) / 2.0)][-1]
        side, axis = seen[1] - seen[0], d - c
        assert abs(side[0] * axis[1] - side[1] * axis[0]) < 0.02 * np.linalg.norm(side) * np.linalg.norm(axis)


def test_the_tables_of_the_cards_say_where_each_plank_lies(kagome: Any) -> None:
    corner = np.min([node[end][:2] for _, node in kagome.nodes(data=True) for end in ("start", "end")], axis=0)
    rows = {row[0]: row for card in made(kagome).data["cards"] for row in card["table"]["rows"]}
    assert set(rows) == set(kagome)
    for mark, row in rows.items():
        for cell, end in zip(row[-2:], ("start", "end"), strict=True):
            told = [float(x) for x in cell.split(", ")]
            assert told == pytest.approx(np.array(kagome.nodes[mark][end][:2]) - corner, abs=0.501)


def test_without_sections_the_booklet_is_written_all_the_same(kagome: Any) -> None:
    bare = kagome.copy()
    for _, node in bare.nodes(data=True):
        del node["width_mm"]
    text = printed(made(bare))
    assert "plank 100" not in text
    assert "plank 2685 mm" in text
    assert all(width == 0.0 for width in floor(bare).widths.values())


def test_one_plank_alone_and_planks_that_nothing_ties_have_their_booklets() -> None:
    for graph in (planks(("a", along(0.0))), planks(("a", along(0.0)), ("b", along(900.0)))):
        booklet = made(graph)
        assert len(booklet.data["cards"]) == 1
        assert "0, 0" in printed(booklet)


def test_marks_of_any_letters_are_printed_whole_and_found_on_the_page() -> None:
    """With blanks, umlauts, what HTML and typst take for signs, small letters, and marks that look like ours."""
    marks = ("träger 1", "<b>&#", "$x_1$", "*fett*", "S1-G-05", "S2-G-05", "ж-7")
    booklet = made(planks(*((mark, along(500.0 * i)) for i, mark in enumerate(marks))))
    text, page = printed(booklet), page_html(booklet)
    assert [mark for mark in marks if mark not in text] == []
    (found,) = re.findall(r'<script type="application/json" id="marks">(.*?)</script>', page)
    assert sorted(json.loads(found)["steps"][0]["marks"].split("\n")) == sorted(marks)
    assert "<b>&#" not in page.replace(found, "")


def test_letters_that_the_pdf_does_not_have_are_a_note() -> None:
    plan = graph_plan(planks(("木-1", along(0.0)), ("ä-µ", along(500.0)), ("Ω", along(900.0))), 2, 25.0)
    (finding,) = plan.findings
    assert (finding.code, finding.severity, finding.mark) == ("AAG957", "note", "木-1")


def test_a_weave_on_a_wall_is_seen_square_on() -> None:
    lines = [(f"h{i}", ((0.0, 0.0, 500.0 * i), (3000.0, 0.0, 500.0 * i))) for i in range(4)]
    assert floor(planks(*lines)).size == pytest.approx((3000.0, 1500.0))
    turned = [(mark, (start[::-1], end[::-1])) for mark, (start, end) in lines]
    assert sorted(floor(planks(*turned)).size) == pytest.approx((1500.0, 3000.0))


def test_a_shallow_dome_is_seen_from_above() -> None:
    lines = [(f"x{i}", ((0.0, 500.0 * i, 90.0 * i), (3000.0, 500.0 * i, 70.0 * i))) for i in range(4)]
    found = floor(planks(*lines))
    assert found.ends["x3"] == pytest.approx(np.array([(0.0, 1500.0), (3000.0, 1500.0)]))


def test_a_step_that_takes_little_of_a_large_floor_is_drawn_larger_with_a_key() -> None:
    rows = [(f"{i:03d}", along(100.0 * i, 1200.0)) for i in range(300)]
    booklet = made(planks(*rows, width_mm=60.0, depth_mm=20.0))
    cards = booklet.data["cards"]
    assert len(cards) == math.ceil(300 / 7)
    assert all(card["key"] in booklet.pictures for card in cards)
    strips = [shape for shape in filled(booklet.pictures["step-1"]) if len(shape) == 4]
    assert max(np.linalg.norm(shape[1] - shape[2]) for shape in strips) > 20.0
    assert not any(card["key"] for card in made(planks(*rows[:6])).data["cards"])


def test_many_lengths_of_a_section_are_one_line_of_the_totals() -> None:
    rows = [(f"{i:03d}", along(100.0 * i, 1000.0 + 10.0 * i)) for i in range(40)]
    (line, whole) = made(planks(*rows, width_mm=60.0, depth_mm=20.0)).data["cover"]["totals"]["rows"]
    assert line[:3] == ["plank 60 x 20", "1000 … 1390 mm", "40"]
    assert whole[2] == "40"


def coupled() -> "nx.MultiGraph[str]":
    """Return two beams of two planks with a bolt each, one over the other, joined by a bolt without a place."""
    graph: nx.MultiGraph[str] = nx.MultiGraph(name="two beams")
    for beam, turn in (("lower", False), ("upper", True)):
        for side, aside in (("left", 18.0), ("right", -18.0)):
            ends = [(x, 1000.0 + aside) for x in (0.0, 2000.0)]
            start, end = ((*(point[::-1] if turn else point), 0.0) for point in ends)
            graph.add_node(
                f"{beam} {side}", kind="plank", beam=beam, mass_kg=2.0, length_mm=2000.0, start=start, end=end,
                upright=True, width_mm=12.0, depth_mm=100.0,
            )  # fmt: skip
        graph.add_node(f"{beam} bolt", kind="bolt", beam=beam, mass_kg=0.1, length_mm=65.0)
        for side in ("left", "right"):
            graph.add_edge(f"{beam} bolt", f"{beam} {side}", kind="bolted", joint=f"{beam} middle")
    for side in ("left", "right"):
        for other in ("left", "right"):
            graph.add_edge(f"lower {side}", f"upper {other}", kind="crossing", joint="J", above=f"upper {other}")
    graph.add_node("through", kind="bolt", mass_kg=0.2, length_mm=240.0)
    for beam in ("lower", "upper"):
        graph.add_edge("through", f"{beam} left", kind="bolted", joint="J")
    return graph


def test_a_beam_is_put_together_where_it_is_laid_with_all_its_parts() -> None:
    cards = made(coupled()).data["cards"]
    assert [card["phase"] for card in cards] == ["lay", "lay", "join"]
    first, _, last = cards
    assert first["table"]["rows"][0][:4] == ["lower", "2 x plank 100 x 12", "2000 mm", "4.1 kg"]
    assert "Put these together before they are laid" in first["instructions"][0]
    assert first["parts"] == [
        ["2", "plank 100 x 12", "lower left, lower right"], ["1", "bolt 65 mm", "at lower middle"],
    ]  # fmt: skip
    assert last["parts"] == [["1", "bolt 240 mm", "at J"]]
    assert last["after"] == ["1  Lay lower", "2  Lay upper"]


def test_a_bolt_without_a_place_is_drawn_where_its_planks_cross() -> None:
    assert floor(coupled()).points["J"] == pytest.approx((1000.0, 1000.0), abs=40.0)
    assert len(re.findall(r'<circle [^>]*r="10"/>', made(coupled()).pictures["step-3"])) == 1


def test_every_part_is_on_one_card_and_in_the_totals() -> None:
    graph, booklet = coupled(), made(coupled())
    listed: Counter[str] = Counter()
    for card in booklet.data["cards"]:
        listed["pieces"] += int(re.findall(r"\d+", card["added"])[0])
        listed["parts"] += sum(int(row[0]) for row in card["parts"])
    assert listed == {"pieces": len(graph), "parts": len(graph)}
    *kinds, whole = booklet.data["cover"]["totals"]["rows"]
    assert sum(int(row[2]) for row in kinds) == int(whole[2]) == len(graph)


def test_marks_that_look_like_ours_stand_whole_where_no_shell_is_said() -> None:
    marks = ("S1-G-01", "S1-G-02", "S1-G-03")
    graph = planks(*((mark, along(500.0 * i)) for i, mark in enumerate(marks)))
    (card,) = made(graph).data["cards"]
    assert all(mark in card["title"] for mark in marks)
    for _, node in graph.nodes(data=True):
        node["shell"] = "S1"
    (card,) = made(graph).data["cards"]
    assert card["title"] == "Lay G-01 … G-03"
    assert [row[0] for row in card["table"]["rows"]] == ["G-03", "G-02", "G-01"]


def test_parts_that_nobody_lays_have_a_booklet_too() -> None:
    graph: nx.Graph[str] = nx.Graph(name="two bolts")
    for mark in ("a", "b"):
        graph.add_node(mark, kind="bolt", mass_kg=0.0, length_mm=60.0)
    graph.add_edge("a", "b", kind="bolted")
    assert "bolt 60 mm" in printed(made(graph))
