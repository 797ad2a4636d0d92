"""What the booklets of a gridshell print: words, tables and pictures as plain data, for paper and for telephones."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import ceil
from typing import Any, Literal, TypeAlias

from aag_cad.parts.model import Gridshell, all_parts
from assembly.cards import step_card, totals
from assembly.gantt import gantt_svg
from assembly.language import Language, say, says, words_table
from assembly.perspective import perspective_svg
from assembly.plan import piece_weights
from assembly.planned import Planned
from assembly.qr import qr_svg
from assembly.ranges import short_mark
from assembly.scenes import legend_svgs, phase_svg, picture_key, step_pictures
from assembly.schedule import Schedule
from assembly.sections import block_section_svg, node_section_svg
from assembly.sheets import Sheets, sheets_of
from assembly.site_scenes import key_svg
from assembly.steps import Plan, Step

Kind: TypeAlias = Literal["sequence", "disassembly"]

_MOST_PROPS = 12


@dataclass(frozen=True)
class Booklet:
    """A booklet: what its template prints, with pictures by name, and these pictures as SVG."""

    data: dict[str, Any]
    pictures: dict[str, str]


def booklet_words(language: Language) -> dict[str, Any]:
    """Return the words of the booklets in a language, as nested as their table."""

    def spoken(found: Any) -> Any:
        if language in found:
            return found[language]
        return {key: spoken(value) for key, value in found.items()}

    words: dict[str, Any] = spoken(words_table("booklet"))
    return words


def _sheet_words(kind: Kind, plan: Plan) -> dict[str, Any]:
    """Return the words that depend on the kind of booklet."""
    words = booklet_words(plan.language)
    side = "up" if kind == "sequence" else "down"
    card = words["card"]
    return words | {
        "subtitle": words[kind],
        "foot": words[f"{kind}_foot"],
        "read": {"title": words["read"]["title"], "lines": words["read"][kind]},
        "list": words["list"] | {"text": words["list"][kind]},
        "card": card | {"extras": card[f"extras_{side}"], "counted": card["at_hand" if side == "up" else "stored"]},
    }
