"""What the booklets of a gridshell print: words, tables and pictures as plain data, for paper and for telephones."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import ceil
from typing import Any, Literal, TypeAlias

from aag_cad.findings import worst_first
from aag_cad.language import Language
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import parse_mark
from aag_cad.parts.model import Gridshell
from assembly.base.steps import Plan, Step
from assembly.booklet.cards import Weights, step_card, totals
from assembly.booklet.drawn_pages import Made, laying_pages, locking_pages, map_pages, segment_pages
from assembly.booklet.gantt import gantt_svg
from assembly.booklet.qr import qr_svg
from assembly.booklet.step_words import step_title
from assembly.booklet.words import booklet_words, finding_lines
from assembly.drawing.joint_sections import block_section_svg, node_section_svg
from assembly.drawing.perspective import perspective_svg
from assembly.pictures.backgrounds import Backgrounds, backgrounds_of
from assembly.pictures.scenes import home_shell, legend_svgs, phase_svg, picture_key, step_pictures
from assembly.pictures.site_scenes import key_svg
from assembly.plan.piece_weights import piece_weights, segment_weights
from assembly.plan.planned import Planned
from assembly.plan.schedule import Schedule

Kind: TypeAlias = Literal["sequence", "disassembly"]

_MOST_PROPS = 30


@dataclass(frozen=True)
class Booklet:
    """A booklet: what its template prints, with pictures by name, and these pictures as SVG."""

    data: dict[str, Any]
    pictures: dict[str, str]


@dataclass(frozen=True)
class Common:
    """What all booklets of a gridshell share: masses and lengths of its pieces, and pictures of the whole."""

    gridshell: Gridshell
    weights: Weights
    pictures: dict[str, str]
    maps: dict[str, Any]
    language: Language


def _sheet_words(kind: Kind, language: Language) -> dict[str, Any]:
    """Return the words that depend on the kind of booklet."""
    words = booklet_words(language)
    side = "up" if kind == "sequence" else "down"
    card = words["card"]
    return words | {
        "subtitle": words[kind],
        "foot": words[f"{kind}_foot"],
        "read": {"title": words["read"]["title"], "lines": words["read"][kind]},
        "list": words["list"] | {"text": words["list"][kind]},
        "card": card | {"extras": card[f"extras_{side}"], "counted": card["at_hand" if side == "up" else "stored"]},
    }


def _days(schedule: Schedule) -> int:
    return ceil(schedule.days)


def _cover(words: Mapping[str, Any], plan: Plan, schedule: Schedule, common: Common) -> dict[str, Any]:
    people = max((step.crew for step in plan.steps), default=0)
    told = words["cover"]["crew"].format(steps=len(plan.steps), people=people, days=_days(schedule))
    return {"picture": "vault", "totals": totals(common.gridshell, common.weights, common.language), "told": told}


def _listing(words: Mapping[str, Any], plan: Plan, language: Language) -> list[dict[str, Any]]:
    """Return the steps by chapter: those of each shell and those on site, in the order of the plan."""
    names = dict.fromkeys(step.shell for step in plan.steps)
    return [
        {
            "name": words["list"]["shell"].format(shell=name) if name else words["list"]["site"],
            "steps": [
                {"number": step.number, "title": step_title(step, language), "crew": step.crew, "hold": step.held}
                for step in plan.steps
                if step.shell == name
            ],
        }
        for name in names
    ]


def _alone(step: Step) -> str:
    """Return the shell that a step on site moves or joins segments of, or ""."""
    return step.assemblies[0] if len(step.assemblies) == 1 else ""


def _caption(step: Step) -> str:
    """Return the key of the caption of a step's pictures, by its phase and by what there is to see."""
    if step.phase in ("edge planks", "pull edge planks") and not any(
        parse_mark(mark).family == "R" for mark in step.marks
    ):
        return f"{step.phase} alone"
    if step.phase == "stand" and step.segments:
        return "stand segment"
    return step.phase


def _card_words(kind: Kind, words: Mapping[str, Any], step: Step, card: Mapping[str, Any]) -> dict[str, Any]:
    """Return the lines of a card that are put together from words and figures."""
    said = words["card"]
    props = card["props"]
    more = said["and_more"].format(count=len(props) - _MOST_PROPS) if len(props) > _MOST_PROPS else ""
    added = said["parts_up" if kind == "sequence" else "parts_down"]
    return {
        "line": said["shell"].format(shell=step.shell) if step.shell else "",
        "caption": words["captions"].get(_caption(step), ""),
        "heaviest": said["heaviest"].format(piece=card["heaviest"]) if card["heaviest"] else "",
        "added": added.format(pieces=card["pieces"], mass=card["added"]),
        "propped": ", ".join(props[:_MOST_PROPS]) + (f" {more}" if more else ""),
    }


def _cards(
    kind: Kind, words: Mapping[str, Any], plan: Plan, backgrounds: Backgrounds, common: Common, pictures: dict[str, str]
) -> Iterator[dict[str, Any]]:
    """Yield the cards of all steps; their pictures are added to ``pictures``, those of steps alike only once."""
    gridshell, drawn = backgrounds.gridshell, dict[tuple[object, ...], list[str]]()
    parts = index_of(gridshell).parts
    for step in plan.steps:
        card = step_card(gridshell, plan, step, parts, common.weights, common.language)
        key = picture_key(backgrounds, step)
        if key not in drawn:
            made = {f"step-{step.number}-{i}": picture for i, picture in enumerate(step_pictures(backgrounds, step))}
            pictures |= made
            drawn[key] = list(made)
        pictures[f"qr-{step.number}"] = qr_svg(card["qr"])
        yield (
            card
            | _card_words(kind, words, step, card)
            | {
                "pictures": drawn[key],
                "qr": f"qr-{step.number}",
                "key": f"key-{home}" if (home := home_shell(step) or _alone(step)) else "",
            }
        )


def common_of(gridshell: Gridshell, language: Language) -> Common:
    """Return what all booklets of a gridshell share: it takes a second or two, so that it is worth making once."""
    swatches = {f"legend-{name}": picture for name, picture in legend_svgs().items()}
    keys = {f"key-{shell.mark}": key_svg(gridshell, shell.mark) for shell in gridshell.shells}
    pictures = {"vault": perspective_svg(gridshell)} | swatches | keys
    maps, drawn = map_pages(gridshell, language)
    return Common(gridshell, piece_weights(gridshell), pictures | drawn, maps, language)


def _booklet(kind: Kind, planned: Planned, common: Common) -> tuple[Booklet, Backgrounds]:
    """Return what both booklets have: cover, words, list of steps, schedule, cards."""
    up = kind == "sequence"
    plan, schedule = (planned.plan, planned.schedule) if up else (planned.down, planned.down_schedule)
    gridshell, pictures = common.gridshell, dict(common.pictures)
    common = replace(common, weights={**common.weights, **segment_weights(gridshell, planned.segmentation)})
    slides = [slide for order in planned.orders.values() for slide in order.slides]
    words, backgrounds = (
        _sheet_words(kind, common.language),
        backgrounds_of(plan, gridshell, planned.segmentation, slides, common.language),
    )
    pictures["schedule"] = gantt_svg(
        plan, schedule, f"{gridshell.title}: {words['schedule']['title']}", common.language
    )
    data = {
        "kind": kind,
        "language": common.language,
        "title": gridshell.title,
        "name": gridshell.name,
        "words": words,
        "cover": _cover(words, plan, schedule, common),
        "chapters": _listing(words, plan, common.language),
        "schedule": "schedule",
        "cards": list(_cards(kind, words, plan, backgrounds, common, pictures)),
        "phases": [],
        "sections": [],
        "layings": [],
        "lockings": [],
        "segments": [],
        "findings": finding_lines(worst_first(plan.findings), common.language),
        **common.maps,
    }
    return Booklet(data, pictures), backgrounds


def _how(words: Mapping[str, Any], plan: Plan, backgrounds: Backgrounds, cards: Sequence[Mapping[str, Any]]) -> Made:
    """Return the phases of the first shell, one picture each, and the sections through the joints."""
    first = backgrounds.gridshell.shells[0]
    lasts = {step.phase: step for step in plan.steps if step.shell == first.mark}
    names = {card["phase"]: name for card in cards for name, now in card["phases"] if now}
    pictures = {f"phase-{i}": phase_svg(backgrounds, plan, step) for i, step in enumerate(lasts.values())}
    phases = [
        {"picture": f"phase-{i}", "name": names[phase], "told": words["told"].get(phase, "")}
        for i, phase in enumerate(lasts)
    ]
    sections = {}
    if first.studs:
        sections["node"] = node_section_svg(first, language=backgrounds.language)
    if first.blocks and first.screws:
        sections["block"] = block_section_svg(first, language=backgrounds.language)
    return {"phases": phases, "sections": list(sections)}, pictures | sections


def sequence_booklet(planned: Planned, common: Common) -> Booklet:
    """Return the booklet of putting together, in the language of ``common``."""
    plan, gridshell = planned.plan, common.gridshell
    booklet, backgrounds = _booklet("sequence", planned, common)
    words, cards = booklet.data["words"], booklet.data["cards"]
    data, pictures = dict(booklet.data), dict(booklet.pictures)
    for more, drawn in (
        _how(words, plan, backgrounds, cards),
        laying_pages(gridshell, planned, common.language),
        locking_pages(gridshell, planned.locking, common.language),
        segment_pages(gridshell, planned.segmentation, common.language),
    ):
        data |= more
        pictures |= drawn
    return Booklet(data, pictures)


def disassembly_booklet(planned: Planned, common: Common) -> Booklet:
    """Return the booklet of taking down, in the language of ``common``."""
    return _booklet("disassembly", planned, common)[0]
