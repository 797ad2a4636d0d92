"""What pages for telephones are put together from: tables, check boxes, contents, the sections of steps."""

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from string import Template
from typing import Any

from aag_cad.resources import template

_SHORT = 16


def rich_text(line: str, pictures: Mapping[str, str]) -> str:
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


def zoomed(picture: str) -> str:
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


def html_list(lines: Iterable[str], tag: str = "ul") -> str:
    """Return lines as a list, "" without any."""
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
        yield zoomed(first)
        yield f'<div class="pair">{"".join(more)}</div>' if more else ""
        yield f'<p class="caption">{escape(card["caption"])}</p>' if card["caption"] else ""
        yield f"<h3>{escape(said['do'])}</h3>{html_list(card['instructions'], 'ol')}"
        if card["table"]:
            yield f'<div class="wide">{html_table(card["table"]["head"], card["table"]["rows"])}</div>'
        if card["parts"]:
            yield f"<h3>{escape(card['added'])}</h3>{html_table(said['head'], card['parts'])}"
        if card["extras"]:
            yield f"<h3>{escape(said['extras'])}</h3>{html_list(card['extras'])}"
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
