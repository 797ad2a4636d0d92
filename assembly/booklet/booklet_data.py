"""A booklet as data for its templates: what the booklets of gridshells and of any graph of parts have alike."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import ceil
from typing import Any, Literal, TypeAlias

from aag_cad.findings import worst_first
from aag_cad.language import Language
from assembly.base.steps import Plan, Step
from assembly.booklet.gantt import gantt_svg
from assembly.booklet.step_words import step_title
from assembly.booklet.words import booklet_words, finding_lines
from assembly.plan.schedule import Schedule, people_curve

Kind: TypeAlias = Literal["sequence", "disassembly"]
# A step by its number and title, with the marks of what it handles.
Handled: TypeAlias = tuple[int, str, Iterable[str]]

_MOST_PROPS = 30


@dataclass(frozen=True)
class Booklet:
    """A booklet: what its template prints, with pictures by name, and these pictures as SVG.

    A search on its page finds what steps handle; ``example`` is a mark to look for.
    """

    data: dict[str, Any]
    pictures: dict[str, str]
    handled: tuple[Handled, ...]
    example: str


def sheet_words(kind: Kind, language: Language, read: str = "") -> dict[str, Any]:
    """Return the words of a kind of booklet; its cards are ``read`` in a way of their own where words are given."""
    words, how = booklet_words(language), read or kind
    side = "up" if kind == "sequence" else "down"
    card = words["card"]
    return words | {
        "subtitle": words[kind],
        "foot": words[f"{kind}_foot"],
        "read": {"title": words["read"]["title"], "lines": words["read"][how]},
        "list": words["list"] | {"text": words["list"][how]},
        "card": card | {"extras": card[f"extras_{side}"], "counted": card["at_hand" if side == "up" else "stored"]},
    }


def _listing(words: Mapping[str, Any], plan: Plan, rest: str, language: Language) -> list[dict[str, Any]]:
    """Return the steps by chapter in the order of the plan: those of each shell, and the ``rest`` under its name."""
    names = dict.fromkeys(step.shell for step in plan.steps)
    return [
        {
            "name": words["list"]["shell"].format(shell=name) if name else rest,
            "steps": [
                {"number": step.number, "title": step_title(step, language), "crew": step.crew, "hold": step.held}
                for step in plan.steps
                if step.shell == name
            ],
        }
        for name in names
    ]


def card_lines(kind: Kind, words: Mapping[str, Any], step: Step, card: Mapping[str, Any]) -> dict[str, Any]:
    """Return the lines of a card that are put together from words and figures."""
    said = words["card"]
    props = card["props"]
    more = said["and_more"].format(count=len(props) - _MOST_PROPS) if len(props) > _MOST_PROPS else ""
    added = said["parts_up" if kind == "sequence" else "parts_down"]
    return {
        "line": said["shell"].format(shell=step.shell) if step.shell else "",
        "heaviest": said["heaviest"].format(piece=card["heaviest"]) if card["heaviest"] else "",
        "added": added.format(pieces=card["pieces"], mass=card["added"]),
        "propped": ", ".join(props[:_MOST_PROPS]) + (f" {more}" if more else ""),
    }


def booklet_data(
    kind: Kind,
    title: str,
    words: Mapping[str, Any],
    plan: Plan,
    schedule: Schedule,
    totals: Mapping[str, Any],
    cards: Iterable[Mapping[str, Any]],
    language: Language,
    *,
    cover: str,
    rest: str,
) -> tuple[dict[str, Any], str]:
    """Return the data of a booklet without pages of its own, and the picture of its schedule.

    ``cover`` is the name of the cover's picture, ``rest`` that of the chapter of steps that belong to no shell.
    """
    people, days = max((count for _, count in people_curve(schedule)), default=0), ceil(schedule.days)
    told = words["cover"]["crew" if days > 1 else "crew_day"].format(steps=len(plan.steps), people=people, days=days)
    data = {
        "kind": kind,
        "language": language,
        "title": title,
        "name": plan.name,
        "words": words,
        "cover": {"picture": cover, "totals": totals, "told": told},
        "chapters": _listing(words, plan, rest, language),
        "schedule": "schedule",
        "cards": list(cards),
        **{pages: [] for pages in ("maps", "phases", "sections", "layings", "lockings", "segments")},
        "findings": finding_lines(worst_first(plan.findings), language),
    }
    return data, gantt_svg(plan, schedule, f"{title}: {words['schedule']['title']}", language)
