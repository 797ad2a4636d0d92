"""The booklet as a page for telephones: whole, self-contained, every step in it, marks that can be searched."""

import json
import re
from html.parser import HTMLParser
from xml.etree import ElementTree

import pytest

from aag_cad.design import Design
from aag_cad.parts.model import Gridshell, all_parts
from aag_cad.resources import template
from assembly.booklet.booklet_data import Booklet
from assembly.booklet.contents import common_of, disassembly_booklet, sequence_booklet
from assembly.booklet.graph_booklet import graph_booklet
from assembly.booklet.phone_page import page_html
from assembly.booklet.shared_pictures import shared_pictures
from assembly.booklet.step_words import step_title
from assembly.graph.files import read_graph
from assembly.graph.interlacing import interlacing
from assembly.plan.durations import step_minutes
from assembly.plan.graph_plan import graph_plan
from assembly.plan.planned import Planned
from assembly.plan.schedule import schedule_of

# What a telephone loads in a few seconds where the network is bad.
MOST_BYTES = 6_000_000
_VOID = ("meta", "input", "br", "link")


class Reader(HTMLParser):
    """Reads a page: its ids, what it points to, check boxes, and whether every element is closed in its order."""

    def __init__(self) -> None:
        """Begin with nothing read."""
        super().__init__()
        self.open: list[str] = []
        self.ids: list[str] = []
        self.links: list[str] = []
        self.boxes: list[str] = []
        self.faults: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note the id and the links of an element."""
        named = dict(attrs)
        self.ids += [name] if (name := named.get("id")) else []
        self.links += [value for key in ("href", "src") if (value := named.get(key))]
        if tag == "input" and named.get("type") == "checkbox":
            self.boxes.append(named["id"] or "")
        if tag not in _VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note an element that closes itself."""
        self.handle_starttag(tag, attrs)
        if tag not in _VOID:
            self.open.pop()

    def handle_endtag(self, tag: str) -> None:
        """Close an element, the last one that was opened."""
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"{tag} at {self.getpos()}")


def read(page: str) -> Reader:
    reader = Reader()
    reader.feed(page)
    reader.close()
    return reader


@pytest.fixture(scope="module")
def booklet(planned: Planned, gridshell: Gridshell) -> Booklet:
    return sequence_booklet(planned, common_of(gridshell, "en"))


@pytest.fixture(scope="module")
def page(booklet: Booklet) -> str:
    return page_html(booklet)


@pytest.fixture(scope="module")
def reader(page: str) -> Reader:
    return read(page)


def listed_marks(page: str) -> list[dict[str, str]]:
    found = re.search(r'<script type="application/json" id="marks">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    steps: list[dict[str, str]] = json.loads(found[1])["steps"]
    return steps


def assert_sound(reader: Reader) -> None:
    assert reader.faults == []
    assert reader.open == []
    assert len(reader.ids) == len(set(reader.ids))
    assert {link for link in reader.links if not link.startswith("#")} == set()
    assert {link[1:] for link in reader.links} <= set(reader.ids)


def test_the_page_is_sound_and_points_to_nothing_outside(reader: Reader, page: str) -> None:
    assert_sound(reader)
    assert not re.search(r"@import|url\((?!#)|https?://(?!www\.w3\.org)", page)
    assert len(page.encode()) < MOST_BYTES


def test_each_step_has_its_section_and_check_boxes(planned: Planned, reader: Reader) -> None:
    for step in planned.plan.steps:
        assert f"step-{step.number}" in reader.ids
        assert f"entry-{step.number}" in reader.ids
        assert {f"step-{step.number}-{kind}" for kind in ("counted", "done", "legible")} <= set(reader.boxes)
        assert (f"step-{step.number}-hold" in reader.boxes) == step.held


def test_a_search_for_a_mark_finds_the_steps_that_handle_it(planned: Planned, page: str) -> None:
    """A geodesic is laid, held at the edge and fixed; a beam is made and laid, its studs are set."""
    steps = listed_marks(page)
    phases = {str(step.number): step.phase for step in planned.plan.steps}

    def handled(mark: str) -> set[str]:
        return {phases[str(step["number"])] for step in steps if mark in step["marks"].split()}

    assert {"lay G", "fix geodesics"} <= handled("S1-G-05")
    assert "prefabricate" not in handled("S1-G-05")
    assert {"lay A1", "studs"} <= handled("S2-A1-03")
    assert handled("S2-A1-03-L") == {"prefabricate"}


def test_every_part_can_be_searched(gridshell: Gridshell, page: str) -> None:
    known = {mark for step in listed_marks(page) for mark in step["marks"].split()}
    assert [part.mark for part in all_parts(gridshell) if part.mark not in known] == []


def test_pictures_are_shared_without_loss(booklet: Booklet) -> None:
    """With its uses written out, each shared picture is the one that the paper booklet has."""
    names = [name for card in booklet.data["cards"] for name in card["pictures"]]
    shared = shared_pictures(booklet.pictures, names)
    assert len(shared.defs) + sum(map(len, shared.pictures.values())) < 0.6 * sum(
        len(booklet.pictures[n]) for n in names
    )
    paths = {name: f'<path d="{d}"/>' for name, d in re.findall(r'<path id="(\w+)" d="([^"]+)"/>', shared.defs)}
    groups = dict(re.findall(r'<g id="pic-([\w-]+)">(.*?)</g>(?=<g id="pic-|$)', shared.defs))
    for name, picture in shared.pictures.items():
        inner = groups.get(name, picture[picture.index(">") + 1 : -len("</svg>")])
        whole = re.sub(r'<use href="#(p\d+)"/>', lambda found: paths[found[1]], inner)
        original = booklet.pictures[name]
        assert whole == original[original.index(">") + 1 : original.rindex("</svg>")]


def test_every_picture_of_the_booklet_is_well_formed(booklet: Booklet) -> None:
    assert booklet.pictures
    for name, picture in booklet.pictures.items():
        root = ElementTree.fromstring(picture)
        assert root.tag == "{http://www.w3.org/2000/svg}svg", name
        assert len(root) > 0, name


def test_the_german_page_is_german_and_the_same_each_time(planned: Planned, gridshell: Gridshell) -> None:
    def made() -> str:
        return page_html(sequence_booklet(planned, common_of(gridshell, "de")))

    page = made()
    assert page.startswith('<!doctype html>\n<html lang="de">')
    assert_sound(read(page))
    sections = re.sub(r"<svg.*?</svg>|<script.*?</script>|<style.*?</style>", "", page, flags=re.DOTALL)
    # Keys of the design file, such as crew.people, are no words.
    words = re.sub(r"<[^>]+>|\b\w+\.\w+\b", " ", sections).replace("Timber Vault", "")
    assert not re.search(r"\b(the|with|from|beams?|planks?|studs?|people|tools|after|search|contents)\b", words)
    assert "Inhalt" in words
    assert page == made()


def test_taking_down_has_a_page_of_its_own(planned: Planned, gridshell: Gridshell) -> None:
    booklet = disassembly_booklet(planned, common_of(gridshell, "en"))
    reader = read(page_html(booklet))
    assert_sound(reader)
    assert [step.number for step in planned.down.steps if f"step-{step.number}-done" not in reader.boxes] == []


def test_a_picture_that_is_no_svg_is_refused() -> None:
    with pytest.raises(ValueError, match="not an SVG"):
        shared_pictures({"a": "<html></html>"}, ["a"])


@pytest.mark.parametrize("name", ["kagome", "impossible"])
def test_a_plain_graph_has_a_page_too(name: str, design: Design) -> None:
    graph = read_graph(template("graphs", f"{name}.json").read_text("utf-8"))
    plan = graph_plan(graph, 4, 25.0)
    schedule = schedule_of(plan, step_minutes(plan, graph, design.crew.minutes), 4, 8.0)
    page = page_html(graph_booklet(graph, plan, schedule))
    reader = read(page)
    assert_sound(reader)
    assert [step.number for step in plan.steps if f"step-{step.number}-done" not in reader.boxes] == []
    assert [finding.mark for finding in plan.findings if finding.mark not in page] == []
    slid = [step for step in plan.steps if step.phase == "slide"]
    assert all(step_title(step, "en") in page for step in slid)
    passed = [joint for slide in interlacing(graph, later=()).slides for joint in slide.joints]
    assert len(re.findall(r'<circle [^>]*r="26"/>', page)) == len(passed)
    assert bool(passed) == bool(slid)
