"""A booklet as one HTML file for telephones: pictures in the page, check boxes that stay, a search for marks."""

import re
from collections.abc import Iterable, Mapping
from typing import Any, TypeAlias

from aag_cad.pages import html_page
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import joint_of
from aag_cad.parts.model import Gridshell
from assembly.base.phases import PHASE
from assembly.base.steps import Plan
from assembly.booklet.contents import Booklet
from assembly.booklet.shared_pictures import shared_pictures

# A step by its number and title, with the marks of what it handles.
Handled: TypeAlias = tuple[int, str, Iterable[str]]


def _shown(data: Mapping[str, Any]) -> list[str]:
    """Return the pictures of a page by name, each as often as it is shown; QR codes are for paper."""
    names = [data["cover"]["picture"], data["schedule"]]
    names += [f"legend-{name}" for name in re.findall(r"\[\[(\w+)\]\]", " ".join(data["words"]["read"]["lines"]))]
    names += [sheet["picture"] for key in ("phases", "maps", "layings", "lockings", "segments") for sheet in data[key]]
    names += [sheet["legend"] for sheet in data["maps"]]
    names += [name for card in data["cards"] for name in (*card["pictures"], card["key"])]
    return [name for name in names if name]


def _handled(booklet: Booklet, plan: Plan, gridshell: Gridshell) -> Iterable[Handled]:
    """Yield for each step its number, title and what it handles: its parts, beams, shells, and planks it fastens."""
    index, titles = index_of(gridshell), {card["number"]: card["title"] for card in booklet.data["cards"]}
    for step in plan.steps:
        own = set(step.marks)
        joints = {joint_of(mark) for mark in own} if PHASE[step.phase].fastens else set[str]()
        members = (mark for joint in joints if joint in index.joints for mark in index.joints[joint].members)
        fastened = {index.unit_of[mark] for mark in members if mark in index.unit_of}
        yield step.number, titles[step.number], sorted({*own, *step.assemblies, *fastened})


def filled_page(booklet: Booklet, listed: Iterable[Handled], example: str) -> str:
    """Return a booklet as one HTML page without links to anything else.

    Its search finds what steps handle, ``listed`` by number and title; ``example`` is a mark to look for.
    """
    data, shared = booklet.data, shared_pictures(booklet.pictures, _shown(booklet.data))
    search = data["words"]["page"]["search"].format(example=example)
    marks = [{"number": number, "title": title, "marks": " ".join(marks)} for number, title, marks in listed]
    return html_page("booklet", data | {"search": search, "marks": marks}, shared.pictures | {"shared": shared.defs})


def page_html(booklet: Booklet, plan: Plan, gridshell: Gridshell) -> str:
    """Return the booklet of a plan as one HTML page; the same plan gives the same text."""
    example = next(iter((*index_of(gridshell).geodesics, *index_of(gridshell).planks)))
    return filled_page(booklet, _handled(booklet, plan, gridshell), example)
