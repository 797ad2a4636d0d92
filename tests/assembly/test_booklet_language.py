"""The German booklets are German throughout, and every part of the vault is found on some card."""

import re
from collections.abc import Iterable, Iterator
from typing import Any

import pytest
from pdf_texts import page_texts

from aag_cad.parts.marks import joint_of, parse_mark
from aag_cad.parts.model import Gridshell, all_parts
from aag_cad.resources import template
from assembly.base.phases import PHASES
from assembly.booklet.booklet_data import Booklet
from assembly.booklet.contents import common_of, disassembly_booklet, sequence_booklet
from assembly.booklet.pdf import booklet_pdf
from assembly.booklet.words import booklet_words
from assembly.plan.planned import Planned

# Words that stand on nearly every English card and are no words, marks or names in German.
ENGLISH = re.compile(
    r"\b(the|and|with|from|each|beams?|planks?|geodesics?|studs?|screws?|bolts?|shell|step|tools|people|after|parts"
    r"|count|done|initials|checked|schedule|sheet|day|assembly)\b",
    re.IGNORECASE,
)
GERMAN = ("Träger", "Geodäten", "Knotenstäbe", "Schale", "Werkzeug", "Leute", "Erst nach Schritt", "HALT", "Blatt")
# The name of the design is as its file has it.
TITLE = "Timber Vault"
_RANGE = re.compile(r"(?:(S\d)-)?([A-Z]+\d*)-(\d+)(?: … (?:S\d-)?[A-Z]+\d*-(\d+))?(?: ([LR](?:\+[LR])*))?")


@pytest.fixture(scope="module")
def booklets(planned: Planned, gridshell: Gridshell) -> tuple[Booklet, Booklet]:
    common = common_of(gridshell, "de")
    return sequence_booklet(planned, common), disassembly_booklet(planned, common)


def test_the_german_booklets_have_no_english_words(booklets: tuple[Booklet, Booklet]) -> None:
    for booklet in booklets:
        pages = [page.replace(TITLE, "") for page in page_texts(booklet_pdf(booklet))]
        # Ids of steps such as S1.fix.2 are keys and no words.
        left = {
            (i, word[0]) for i, page in enumerate(pages) for word in ENGLISH.finditer(re.sub(r"\S+\.\S+", "", page))
        }
        assert left == set()
        whole = " ".join(pages).casefold()
        # Small headings are printed in capitals.
        assert [word for word in GERMAN if word.casefold() not in whole] == []


def test_the_templates_have_no_words_of_their_own() -> None:
    """What stands in quotes in a template is a key, a font, a unit or a sign: no words with a blank between them."""
    for name in ("sequence.typ", "booklet.typ", "card.typ"):
        code = "\n".join(
            line.partition("//")[0] for line in template("printouts", name).read_text("utf-8").splitlines()
        )
        quoted = {found for found in re.findall(r'"([^"]*)"', code) if re.search(r"[a-z] [a-z]", found)}
        fonts = {"Libertinus Serif", "DejaVu Sans Mono"}
        assert quoted - set(PHASES) - fonts == set()
        # Words in content brackets stand after a sign that opens them, and before no call.
        bare = re.findall(r"\[\s*([A-Za-z][a-z]+(?: [a-z]+)+)", code)
        assert bare == []


def test_both_languages_have_the_same_tables() -> None:
    def keys(words: Any, path: str = "") -> Iterator[str]:
        if isinstance(words, dict):
            for key, value in words.items():
                yield from keys(value, f"{path}.{key}")
        else:
            yield path

    assert list(keys(booklet_words("en"))) == list(keys(booklet_words("de")))


def marks_in(text: str, shell: str) -> Iterator[str]:
    """Yield the marks that a text of a card names, ranges in full; ``shell`` is that of the card."""
    for own, family, first, last, sides in _RANGE.findall(text):
        for index in range(int(first), int(last or first) + 1):
            digits = len(first)
            number = f"{family}-{index:0{digits}d}"
            whole = number if family[0] == "R" and len(family) > 1 else f"{own or shell}-{number}"
            yield whole
            yield from (f"{whole}-{side}" for side in sides.split("+") if side)


def card_texts(card: dict[str, Any]) -> Iterable[str]:
    rows = [*card["parts"], *((card["table"] or {}).get("rows", ()))]
    return [card["title"], *(cell for row in rows for cell in row)]


def test_every_part_is_found_on_the_cards_of_its_shell(gridshell: Gridshell, booklets: tuple[Booklet, Booklet]) -> None:
    """By its own mark, or a bolt, screw or rod by the mark of its joint."""
    for booklet in booklets:
        named: set[str] = set()
        for card in booklet.data["cards"]:
            home = card["shell"] or card["key"].removeprefix("key-")
            for text in card_texts(card):
                named.update(marks_in(text, home))
        missing = [
            part.mark
            for part in all_parts(gridshell)
            if part.mark not in named and joint_of(part.mark) not in named and parse_mark(part.mark).family != "V"
        ]
        assert missing == []
