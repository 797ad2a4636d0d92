"""A booklet as one HTML file for telephones: pictures in the page, check boxes that stay, a search for marks."""

import re
from collections.abc import Iterator, Mapping
from html import escape
from typing import Any

from aag_cad.parts.index import index_of
from aag_cad.parts.marks import joint_of
from aag_cad.parts.model import Gridshell
from assembly.base.steps import Phase, Plan
from assembly.booklet.contents import Booklet, common_of, sequence_booklet
from assembly.booklet.graph_page import graph_html
from assembly.booklet.markup import card_section, contents, filled_page, html_list, html_table, rich_text, zoomed
from assembly.booklet.shared_pictures import shared_pictures
from assembly.plan.planned import Planned

__all__ = ["graph_html", "handled_marks", "page_html", "sequence_html"]

# The phases whose fasteners hold the planks at their joints; in the others they hold blocks, studs or the cover.
_FASTENED: tuple[Phase, ...] = (
    "studs", "edge planks", "fix geodesics", "stand", "ridges", "open ridges", "lift off", "release geodesics",
    "pull edge planks",
)  # fmt: skip


def _front(data: Mapping[str, Any], pictures: Mapping[str, str]) -> Iterator[str]:
    """Yield what stands before the steps: cover, contents, reading, maps, laying plans, schedule."""
    words, cover = data["words"], data["cover"]
    yield pictures[cover["picture"]]
    yield f"<p>{escape(cover['told'])}</p>"
    if data["findings"]:
        yield f"<h3>{escape(words['findings']['title'])}</h3>{html_list(data['findings'])}"
    yield contents(data["chapters"], words["page"]["contents"], words["list"]["hold"])
    lines = "".join(f"<li>{rich_text(line, pictures)}</li>" for line in words["read"]["lines"])
    yield f'<section id="read"><h2>{escape(words["read"]["title"])}</h2><ul>{lines}</ul></section>'
    if data["phases"]:
        told = "".join(
            f"<div>{pictures[phase['picture']]}<p><b>{escape(phase['name'])}.</b> {escape(phase['told'])}</p></div>"
            for phase in data["phases"]
        )
        title, text = escape(words["how"]["title"]), rich_text(words["how"]["text"], pictures)
        yield f'<section id="how"><h2>{title}</h2><p>{text}</p><div class="pair">{told}</div></section>'
    for i, sheet in enumerate(data["maps"]):
        drawn = zoomed(pictures[sheet["picture"]]) + (pictures[sheet["legend"]] if sheet["legend"] else "")
        note = f"<p>{escape(sheet['note'])}</p>"
        yield f'<section id="map-{i}"><h2>{escape(sheet["title"])}</h2>{note}{drawn}</section>'
    for i, sheet in enumerate(data["layings"]):
        tables = "".join(html_table(sheet[key]["head"], sheet[key]["rows"]) for key in ("members", "points"))
        drawn = f'<p>{escape(sheet["note"])}</p>{zoomed(pictures[sheet["picture"]])}<div class="wide">{tables}</div>'
        yield f'<section id="laying-{i}"><h2>{escape(sheet["title"])}</h2>{drawn}</section>'
    table = html_table(cover["totals"]["head"], cover["totals"]["rows"])
    yield f'<section id="totals"><h2>{escape(words["cover"]["made_of"])}</h2>{table}</section>'
    title = escape(words["schedule"]["title"])
    yield f'<section id="schedule"><h2>{title}</h2>{zoomed(pictures[data["schedule"]])}</section>'


def _back(data: Mapping[str, Any], pictures: Mapping[str, str]) -> Iterator[str]:
    """Yield what stands after the steps: locking and segments."""
    for i, sheet in enumerate(data["lockings"]):
        table = html_table(sheet["table"]["head"], sheet["table"]["rows"])
        told = f"<p>{escape(data['words']['locking']['text'])}</p>"
        notes = f"<p>{escape(sheet['hoists'])}</p><p>{escape(sheet['price'])}</p>"
        drawn = f'{zoomed(pictures[sheet["picture"]])}<div class="wide">{table}</div>{notes}'
        yield f'<section id="locking-{i}"><h2>{escape(sheet["title"])}</h2>{told}{drawn}</section>'
    for i, sheet in enumerate(data["segments"]):
        table = html_table(("", ""), sheet["facts"])
        for title, lines in ((sheet["braces_title"], sheet["braces"]), (sheet["loose_title"], sheet["loose_ends"])):
            table += f"<h3>{escape(title)}</h3>{html_list(lines)}" if lines else ""
        if sheet["splices"]:
            table += f"<h3>{escape(sheet['splices_title'])}</h3>{html_table(sheet['splices_head'], sheet['splices'])}"
        drawn = zoomed(pictures[sheet["picture"]])
        yield f'<section id="segment-{i}"><h2>{escape(sheet["title"])}</h2>{drawn}{table}</section>'


def _shown(data: Mapping[str, Any]) -> list[str]:
    """Return the pictures of a page by name, each as often as it is shown; QR codes are for paper."""
    names = [data["cover"]["picture"], data["schedule"], *(phase["picture"] for phase in data["phases"])]
    names += [f"legend-{name}" for name in re.findall(r"\[\[(\w+)\]\]", " ".join(data["words"]["read"]["lines"]))]
    names += [name for sheet in data["maps"] for name in (sheet["picture"], sheet["legend"]) if name]
    names += [sheet["picture"] for sheet in (*data["layings"], *data["lockings"], *data["segments"])]
    for card in data["cards"]:
        names += [*card["pictures"], *([card["key"]] if card["key"] else [])]
    return names


def handled_marks(plan: Plan, gridshell: Gridshell) -> list[tuple[int, str, tuple[str, ...]]]:
    """Return for each step its number, title and what it handles: its parts, beams, shells, and planks it fastens."""
    index = index_of(gridshell)
    found = []
    for step in plan.steps:
        own = set(step.marks)
        joints = {joint_of(mark) for mark in own} if step.phase in _FASTENED else set[str]()
        members = (mark for joint in joints if joint in index.joints for mark in index.joints[joint].members)
        fastened = {index.unit_of[mark] for mark in members if mark in index.unit_of}
        found.append((step.number, step.title, tuple(sorted({*own, *step.assemblies, *fastened}))))
    return found


def page_html(booklet: Booklet, plan: Plan, gridshell: Gridshell) -> str:
    """Return the booklet of a plan as one HTML page."""
    data = booklet.data
    shared = shared_pictures(booklet.pictures, _shown(data))
    pictures, said = shared.pictures, data["words"]["page"]
    cards = (card_section(card, data["words"]["card"], pictures) for card in data["cards"])
    body = "\n".join((*_front(data, pictures), *cards, *_back(data, pictures)))
    steps = [{"number": n, "title": t, "marks": " ".join(m)} for n, t, m in handled_marks(plan, gridshell)]
    example = next(iter((*index_of(gridshell).geodesics, *index_of(gridshell).planks)))
    return filled_page(data, body, steps, shared.defs, said["search"].format(example=example))


def sequence_html(planned: Planned, gridshell: Gridshell) -> str:
    """Return the booklet of putting together as one HTML page without links to anything else; same plan, same text."""
    return page_html(sequence_booklet(planned, common_of(gridshell, planned.plan.language)), planned.plan, gridshell)
