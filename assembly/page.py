"""A booklet as one HTML file for telephones: pictures in the page, check boxes that stay, a search for marks."""

import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from string import Template
from typing import Any

from aag_cad.files import write_text
from aag_cad.parts.model import Gridshell
from aag_cad.resources import template
from assembly.booklet import Booklet, common_of, sequence_booklet
from assembly.graph import joint_of
from assembly.planned import Planned
from assembly.shared_pictures import shared_pictures
from assembly.steps import Plan


_SHORT = 16


def _rich(line: str, pictures: Mapping[str, str]) -> str:
    """Return a line with *bold* words and [[swatches]] as HTML."""
    bold = re.sub(r"\*([^*]+)\*", r"<b>\1</b>", escape(line, quote=False))

    def swatch(found: re.Match[str]) -> str:
        kind = "swatch square" if found[1] == "prop" else "swatch"
        return f'<span class="{kind}">{pictures[f"legend-{found[1]}"]}</span>'

    return re.sub(r"\[\[(\w+)\]\]", swatch, bold)


def _cell(text: str) -> str:
    """Return a cell; short ones and single marks are not broken."""
    if len(text) <= _SHORT:
        return f'<td class="n">{escape(text)}</td>'
    parts = (f"<span>{escape(part)}</span>" if len(part) <= _SHORT else escape(part) for part in text.split(", "))
    return f"<td>{', '.join(parts)}</td>"


def html_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table as HTML; an empty head gives none."""
    top = "".join(f"<th>{escape(cell)}</th>" for cell in head)
    lines = ("".join(_cell(str(cell)) for cell in row) for row in rows)
    body = "".join(f"<tr>{line}</tr>" for line in lines)
    return f"<table>{f'<thead><tr>{top}</tr></thead>' if any(head) else ''}<tbody>{body}</tbody></table>"


def _zoomed(picture: str) -> str:
    """Return a picture that a tap makes large enough for its small numbers."""
    return f'<div class="zoom">{picture}</div>'


def tick(name: str, told: str) -> str:
    """Return a check box with its words; it stays checked by its id."""
    return f'<label><input type="checkbox" id="{name}">{escape(told)}</label>'


def contents(chapters: Sequence[Mapping[str, Any]], title: str, hold: str) -> str:
    """Return the table of contents: all steps, chapter by chapter."""
    items = []
    for chapter in chapters:
        entries = "".join(
            f'<li id="entry-{step["number"]}"><a href="#step-{step["number"]}"><b>{step["number"]}</b>'
            f"<span>{escape(step['title'])}</span>"
            f'<span class="mark">{f"<b>{escape(hold)}</b>" if step["hold"] else ""}</span></a></li>'
            for step in chapter["steps"]
        )
        items.append(f"<h3>{escape(chapter['name'])}</h3><ol>{entries}</ol>")
    return f'<nav id="contents"><section><h2>{escape(title)}</h2>{"".join(items)}</section></nav>'


def _list(lines: Iterable[str], tag: str = "ul") -> str:
    items = "".join(f"<li>{escape(line)}</li>" for line in lines)
    return f"<{tag}>{items}</{tag}>" if items else ""


def card_section(card: Mapping[str, Any], said: Mapping[str, str], pictures: Mapping[str, str]) -> str:
    """Return the section of a step: what its printed card says, in one column."""
    number = f"step-{card['number']}"

    def items() -> Iterator[str]:
        if card["key"]:
            yield f'<div class="key">{pictures[card["key"]]}</div>'
        yield f'<h2><span class="number">{card["number"]}</span>{escape(card["title"])}</h2>'
        yield f'<p class="small">{escape(card["line"])}{escape(said["step"])} {escape(card["id"])}</p>'
        first, *more = [pictures[name] for name in card["pictures"]] or [""]
        yield _zoomed(first)
        yield f'<div class="pair">{"".join(more)}</div>' if more else ""
        yield f'<p class="caption">{escape(card["caption"])}</p>' if card["caption"] else ""
        yield f"<h3>{escape(said['do'])}</h3>{_list(card['instructions'], 'ol')}"
        if card["table"]:
            yield f'<div class="wide">{html_table(card["table"]["head"], card["table"]["rows"])}</div>'
        if card["parts"]:
            yield f"<h3>{escape(card['added'])}</h3>{html_table(said['head'], card['parts'])}"
        if card["extras"]:
            yield f"<h3>{escape(said['extras'])}</h3>{_list(card['extras'])}"
        yield f"<h3>{escape(said['props'])}</h3><p>{escape(card['propped'])}</p>" if card["propped"] else ""
        yield f"<h3>{escape(said['people'])}</h3><p>{card['crew']}</p>"
        yield f"<h3>{escape(said['tools'])}</h3><p>{escape(', '.join(card['tools']))}</p>"
        links = "".join(f'<a href="#step-{line.split()[0]}">{escape(line)}</a>' for line in card["after"])
        yield f'<h3>{escape(said["after"])}</h3><div class="after">{links or escape(said["free"])}</div>'
        yield f"<p>{escape(card['heaviest'])}</p>" if card["heaviest"] else ""
        if card["hold"]:
            told = f"<b>{escape(said['hold'])}</b> {escape(card['hold'])}"
            yield f'<div class="hold">{told}{tick(f"{number}-hold", said["checked"])}</div>'
        for kind, told in (("counted", said["counted"]), ("done", said["done"]), ("legible", said["legible"])):
            yield tick(f"{number}-{kind}", told)

    return f'<section class="step" id="{number}">{"".join(items())}</section>'


def _front(data: Mapping[str, Any], pictures: Mapping[str, str]) -> Iterator[str]:
    """Yield what stands before the steps: cover, contents, reading, maps, laying plans, schedule."""
    words, cover = data["words"], data["cover"]
    yield pictures[cover["picture"]]
    yield f"<p>{escape(cover['told'])}</p>"
    yield contents(data["chapters"], words["page"]["contents"], words["list"]["hold"])
    lines = "".join(f"<li>{_rich(line, pictures)}</li>" for line in words["read"]["lines"])
    yield f'<section id="read"><h2>{escape(words["read"]["title"])}</h2><ul>{lines}</ul></section>'
    if data["phases"]:
        told = "".join(
            f"<div>{pictures[phase['picture']]}<p><b>{escape(phase['name'])}.</b> {escape(phase['told'])}</p></div>"
            for phase in data["phases"]
        )
        title, text = escape(words["how"]["title"]), _rich(words["how"]["text"], pictures)
        yield f'<section id="how"><h2>{title}</h2><p>{text}</p><div class="pair">{told}</div></section>'
    for i, sheet in enumerate(data["maps"]):
        drawn = _zoomed(pictures[sheet["picture"]]) + (pictures[sheet["legend"]] if sheet["legend"] else "")
        note = f"<p>{escape(sheet['note'])}</p>"
        yield f'<section id="map-{i}"><h2>{escape(sheet["title"])}</h2>{note}{drawn}</section>'
    for i, sheet in enumerate(data["layings"]):
        tables = "".join(html_table(sheet[key]["head"], sheet[key]["rows"]) for key in ("members", "points"))
        drawn = f'<p>{escape(sheet["note"])}</p>{_zoomed(pictures[sheet["picture"]])}<div class="wide">{tables}</div>'
        yield f'<section id="laying-{i}"><h2>{escape(sheet["title"])}</h2>{drawn}</section>'
    table = html_table(cover["totals"]["head"], cover["totals"]["rows"])
    yield f'<section id="totals"><h2>{escape(words["cover"]["made_of"])}</h2>{table}</section>'
    title = escape(words["schedule"]["title"])
    yield f'<section id="schedule"><h2>{title}</h2>{_zoomed(pictures[data["schedule"]])}</section>'


def _back(data: Mapping[str, Any], pictures: Mapping[str, str]) -> Iterator[str]:
    """Yield what stands after the steps: locking and segments."""
    for i, sheet in enumerate(data["lockings"]):
        table = html_table(sheet["table"]["head"], sheet["table"]["rows"])
        told = f"<p>{escape(data['words']['locking']['text'])}</p>"
        drawn = f'{_zoomed(pictures[sheet["picture"]])}<div class="wide">{table}</div><p>{escape(sheet["price"])}</p>'
        yield f'<section id="locking-{i}"><h2>{escape(sheet["title"])}</h2>{told}{drawn}</section>'
    for i, sheet in enumerate(data["segments"]):
        table = html_table(("", ""), sheet["facts"])
        for title, lines in ((sheet["braces_title"], sheet["braces"]), (sheet["loose_title"], sheet["loose_ends"])):
            table += f"<h3>{escape(title)}</h3>{_list(lines)}" if lines else ""
        if sheet["splices"]:
            table += f"<h3>{escape(sheet['splices_title'])}</h3>{html_table(sheet['splices_head'], sheet['splices'])}"
        drawn = _zoomed(pictures[sheet["picture"]])
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
    beams = {plank.mark: plank.beam or plank.mark for shell in gridshell.shells for plank in shell.planks}
    joints = (*(joint for shell in gridshell.shells for joint in shell.joints), *gridshell.joints)
    members = {joint.mark: [beams[mark] for mark in joint.members if mark in beams] for joint in joints}
    found = []
    for step in plan.steps:
        own = set(step.marks)
        fastened = {mark for joint in sorted({joint_of(mark) for mark in own}) for mark in members.get(joint, ())}
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
    example = next((p.mark for p in gridshell.shells[0].planks if p.family == "G"), gridshell.shells[0].planks[0].mark)
    return filled_page(data, body, steps, shared.defs, said["search"].format(example=example))


def filled_page(
    data: Mapping[str, Any], body: str, steps: Sequence[Mapping[str, Any]], shared: str, search: str
) -> str:
    """Return the template ``printouts/sequence.html`` filled with the sections of a page and its search."""
    said = data["words"]["page"]
    name = f"{data['name']}:{data['kind']}"
    told = {"name": name, "words": {key: said[key] for key in ("sure", "found", "nothing")}, "steps": steps}
    # What closes a script must not stand in it.
    listed = json.dumps(told, ensure_ascii=False, separators=(",", ":")).replace("</", "<\\/")
    page = Template(template("printouts", "sequence.html").read_text(encoding="utf-8"))
    return page.substitute(
        language=data["language"],
        title=escape(f"{data['title']}: {data['words']['foot']}"),
        heading=escape(data["title"]),
        subtitle=escape(data["words"]["subtitle"]),
        search=escape(search),
        contents=escape(said["top"]),
        again=escape(said["again"]),
        shared=shared,
        body=body,
        marks=listed,
    )


def sequence_html(planned: Planned, gridshell: Gridshell) -> str:
    """Return the booklet of putting together as one HTML page without links to anything else; same plan, same text."""
    return page_html(sequence_booklet(planned, common_of(gridshell, planned.plan.language)), planned.plan, gridshell)


def write_page(planned: Planned, gridshell: Gridshell, path: str | os.PathLike[str]) -> None:
    """Write the booklet as an HTML file; FileError if it cannot be written, and then nothing is left behind."""
    write_text(path, sequence_html(planned, gridshell))
