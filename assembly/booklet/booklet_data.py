"""A booklet as data for its templates: what the booklets of gridshells and of any graph of parts have alike."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import ceil
from typing import Any

from aag_cad.findings import worst_first
from assembly.booklet.cards import Sheets
from assembly.booklet.gantt import gantt_svg
from assembly.booklet.qr import qr_svg
from assembly.booklet.step_words import step_title
from assembly.booklet.words import finding_lines
from assembly.plan.schedule import people_curve


@dataclass(frozen=True)
class Booklet:
    """A booklet: what its template prints, with pictures by name, and these pictures as SVG."""

    data: dict[str, Any]
    pictures: dict[str, str]


def _listing(sheets: Sheets, rest: str) -> list[dict[str, Any]]:
    """Return the steps by chapter in the order of the plan: those of each shell, and the ``rest`` under its name."""
    steps, language = sheets.plan.steps, sheets.known.language
    return [
        {
            "name": sheets.words["list"]["shell"].format(shell=name) if name else rest,
            "steps": [
                {"number": step.number, "title": step_title(step, language), "crew": step.crew, "hold": step.held}
                for step in steps
                if step.shell == name
            ],
        }
        for name in dict.fromkeys(step.shell for step in steps)
    ]


def booklet_of(
    sheets: Sheets,
    totals: Mapping[str, Any],
    cards: Iterable[Mapping[str, Any]],
    pictures: dict[str, str],
    *,
    cover: str,
    rest: str,
    example: str,
) -> Booklet:
    """Return a booklet with cover, list of steps, schedule and cards; ``pictures`` learn the schedule and the codes.

    ``cover`` is the name of the cover's picture, ``rest`` that of the chapter of steps that belong to no shell,
    ``example`` a mark to look for.
    """
    plan, schedule, language, words = sheets.plan, sheets.schedule, sheets.known.language, sheets.words
    people, days = max((count for _, count in people_curve(schedule)), default=0), ceil(schedule.days)
    told = words["cover"]["crew" if days > 1 else "crew_day"].format(steps=len(plan.steps), people=people, days=days)
    listed = list(cards)
    data = {
        "kind": sheets.kind,
        "language": language,
        "title": sheets.title,
        "name": plan.name,
        "words": words,
        "cover": {"picture": cover, "totals": totals, "told": told},
        "chapters": _listing(sheets, rest),
        "schedule": "schedule",
        "cards": listed,
        **{pages: [] for pages in ("maps", "phases", "sections", "layings", "lockings", "segments")},
        "findings": finding_lines(worst_first(plan.findings), language),
        "example": example,
    }
    pictures |= {f"qr-{card['number']}": qr_svg(card["qr"]) for card in listed}
    pictures["schedule"] = gantt_svg(plan, schedule, f"{sheets.title}: {words['schedule']['title']}", language)
    return Booklet(data, pictures)
