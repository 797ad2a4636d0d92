"""The booklets as PDF, by the template ``printouts/sequence.typ``: maps, schedule, one card a step."""

import json
import os
import shutil
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import typst

from aag_cad.files import write_bytes, write_text
from aag_cad.parts.model import Gridshell
from aag_cad.resources import template
from assembly.booklet.contents import Booklet, common_of, disassembly_booklet, sequence_booklet
from assembly.booklet.phone_page import page_html
from assembly.plan.planned import Planned

_TEMPLATES = ("sequence.typ", "booklet.typ", "card.typ")


def booklet_pdf(booklet: Booklet) -> bytes:
    """Return a booklet as PDF on A4; the same booklet gives the same bytes."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for title, picture in booklet.pictures.items():
            (folder / f"{title}.svg").write_text(picture, encoding="utf-8")
        (folder / "data.json").write_text(json.dumps(booklet.data, ensure_ascii=False), encoding="utf-8")
        for file in _TEMPLATES:
            shutil.copyfile(template("printouts", file), folder / file)
        main = str(folder / _TEMPLATES[0])
        pdf: bytes = typst.compile(main, root=str(folder), ignore_system_fonts=True, format="pdf")
    return pdf


def sequence_pdf(planned: Planned, gridshell: Gridshell) -> bytes:
    """Return the booklet of putting together as PDF; the same plan gives the same bytes."""
    return booklet_pdf(sequence_booklet(planned, common_of(gridshell, planned.plan.language)))


def disassembly_pdf(planned: Planned, gridshell: Gridshell) -> bytes:
    """Return the booklet of taking down as PDF; the same plan gives the same bytes."""
    return booklet_pdf(disassembly_booklet(planned, common_of(gridshell, planned.down.language)))


def write_sequence(planned: Planned, gridshell: Gridshell, path: str | os.PathLike[str]) -> None:
    """Write the booklet as an A4 PDF file; FileError if it cannot be written, and then nothing is left behind."""
    write_bytes(path, sequence_pdf(planned, gridshell))


def write_booklets(planned: Planned, gridshell: Gridshell, folder: Path) -> None:
    """Write both booklets to a folder, each as PDF and as HTML page: what they share is made only once.

    The files are sequence.pdf, sequence.html, disassembly.pdf and disassembly.html. FileError if one cannot be written.
    """
    common = common_of(gridshell, planned.plan.language)
    makers = (("sequence", sequence_booklet, planned.plan), ("disassembly", disassembly_booklet, planned.down))
    # Typst sets each booklet in a thread, while here its page and the next booklet are made.
    with ThreadPoolExecutor(max_workers=len(makers)) as typesetters:
        pdfs = {}
        for name, made, plan in makers:
            booklet = made(planned, common)
            pdfs[name] = typesetters.submit(booklet_pdf, booklet)
            write_text(folder / f"{name}.html", page_html(booklet, plan, gridshell))
        for name, pdf in pdfs.items():
            write_bytes(folder / f"{name}.pdf", pdf.result())
