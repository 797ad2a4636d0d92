"""The booklets as PDF, by the template ``printouts/sequence.typ``: maps, schedule, one card a step."""

from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from aag_cad.files import write_bytes, write_text
from aag_cad.typesetting import printout_pdf
from assembly.booklet.booklet_data import Booklet
from assembly.booklet.phone_page import page_html


def booklet_pdf(booklet: Booklet) -> bytes:
    """Return a booklet as PDF on A4; the same booklet gives the same bytes."""
    return printout_pdf("sequence", booklet.data, booklet.pictures)


def write_booklets(folder: Path, makers: Mapping[str, Callable[[], Booklet]]) -> None:
    """Write booklets by name to a folder, each as PDF and as HTML page; FileError if one cannot be written."""
    # Typst sets each booklet in a thread, while here its page and the next booklet are made.
    with ThreadPoolExecutor(max_workers=len(makers)) as typesetters:
        pdfs = {}
        for name, made in makers.items():
            booklet = made()
            pdfs[name] = typesetters.submit(booklet_pdf, booklet)
            write_text(folder / f"{name}.html", page_html(booklet))
        for name, pdf in pdfs.items():
            write_bytes(folder / f"{name}.pdf", pdf.result())
