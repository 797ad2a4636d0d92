"""The booklets as PDF, by the template ``printouts/sequence.typ``: maps, schedule, one card a step."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from aag_cad.files import write_bytes, write_text
from aag_cad.language import Language
from aag_cad.parts.model import Gridshell
from aag_cad.typesetting import printout_pdf
from assembly.booklet.contents import Booklet, common_of, disassembly_booklet, sequence_booklet
from assembly.booklet.phone_page import page_html
from assembly.plan.planned import Planned


def booklet_pdf(booklet: Booklet) -> bytes:
    """Return a booklet as PDF on A4; the same booklet gives the same bytes."""
    return printout_pdf("sequence", booklet.data, booklet.pictures)


def write_booklets(planned: Planned, gridshell: Gridshell, folder: Path, language: Language = "en") -> None:
    """Write both booklets to a folder, each as PDF and as HTML page: what they share is made only once.

    The files are sequence.pdf, sequence.html, disassembly.pdf and disassembly.html. FileError if one cannot be written.
    """
    common = common_of(gridshell, language)
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
