"""A booklet as one HTML file for telephones: pictures in the page, check boxes that stay, a search for marks."""

import re
from collections.abc import Mapping
from typing import Any

from aag_cad.pages import html_page
from assembly.booklet.booklet_data import Booklet
from assembly.booklet.shared_pictures import shared_pictures


def _shown(data: Mapping[str, Any]) -> list[str]:
    """Return the pictures of a page by name, each as often as it is shown; QR codes are for paper."""
    names = [data["cover"]["picture"], data["schedule"]]
    names += [f"legend-{name}" for name in re.findall(r"\[\[(\w+)\]\]", " ".join(data["words"]["read"]["lines"]))]
    names += [sheet["picture"] for key in ("phases", "maps", "layings", "lockings", "segments") for sheet in data[key]]
    names += [sheet["legend"] for sheet in data["maps"]]
    names += [name for card in data["cards"] for name in (*card["pictures"], card["key"])]
    return [name for name in names if name]


def page_html(booklet: Booklet) -> str:
    """Return a booklet as one HTML page without links to anything else; the same booklet gives the same text.

    Its search finds what steps handle.
    """
    data, shared = booklet.data, shared_pictures(booklet.pictures, _shown(booklet.data))
    search = data["words"]["page"]["search"].format(example=data["example"])
    # A mark may have blanks in it, but is in one line.
    marks = [
        {"number": card["number"], "title": card["title"], "marks": "\n".join(card["handled"])}
        for card in data["cards"]
    ]
    return html_page("booklet", data | {"search": search, "marks": marks}, shared.pictures | {"shared": shared.defs})
