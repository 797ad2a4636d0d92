"""The texts of a PDF, read by pypdf, which is spared the lines of its drawings."""

import re
from io import BytesIO

from pypdf import PageObject, PdfReader
from pypdf.generic import DecodedStreamObject, NameObject


def _string(depth: int) -> bytes:
    """Return a pattern for strings that hold brackets escaped, or in pairs, some deep in each other."""
    inner = rb"[^()\\]|\\." + (rb"|" + _string(depth - 1) if depth else b"")
    return rb"\((?:" + inner + rb")*\)"


# What texts stand in, and what moves them.
_TEXTS = re.compile(rb"\bBT\s(?:" + _string(8) + rb"|[^()])*?\bET\b|\b[qQ]\b|(?:-?[\d.]+ ){6}cm\b", re.DOTALL)


def undrawn(page: PageObject) -> PageObject:
    """Return the page without its drawings, which take twenty times as long to read as its texts."""
    contents = page.get_contents()
    assert contents is not None
    texts = DecodedStreamObject()
    texts.set_data(b"\n".join(_TEXTS.findall(contents.get_data())))
    page[NameObject("/Contents")] = texts
    return page


def page_texts(pdf: bytes) -> list[str]:
    """Return the text of each page on one line."""
    return [" ".join(undrawn(page).extract_text().split()) for page in PdfReader(BytesIO(pdf)).pages]
