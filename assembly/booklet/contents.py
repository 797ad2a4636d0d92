"""What the booklets of a gridshell print: words, tables and pictures as plain data, for paper and for telephones."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from aag_cad.language import Language
from aag_cad.parts.index import Index, index_of
from aag_cad.parts.marks import joint_of, parse_mark
from aag_cad.parts.model import Gridshell
from assembly.base.phases import PHASE
from assembly.base.steps import Plan, Step
from assembly.booklet.booklet_data import Booklet, Handled, Kind, booklet_data, card_lines, sheet_words
from assembly.booklet.card_tables import gridshell_known, step_table, totals
from assembly.booklet.cards import Known, step_card
from assembly.booklet.drawn_pages import Made, laying_pages, locking_pages, map_pages, segment_pages
from assembly.booklet.qr import qr_svg
from assembly.booklet.step_words import step_title
from assembly.drawing.joint_sections import block_section_svg, node_section_svg
from assembly.drawing.perspective import perspective_svg
from assembly.pictures.backgrounds import Backgrounds, backgrounds_of
from assembly.pictures.scenes import home_shell, legend_svgs, phase_svg, picture_key, step_pictures
from assembly.pictures.site_scenes import key_svg
from assembly.plan.piece_weights import segment_weights
from assembly.plan.planned import Planned


@dataclass(frozen=True)
class Common:
    """What all booklets of a gridshell share: what is known of its parts, and pictures of the whole."""

    gridshell: Gridshell
    known: Known
    pictures: dict[str, str]
    maps: dict[str, Any]

    @property
    def language(self) -> Language:
        """The language of the booklets."""
        return self.known.language


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


def _cards(
    kind: Kind, words: Mapping[str, Any], plan: Plan, backgrounds: Backgrounds, common: Common, pictures: dict[str, str]
) -> Iterator[dict[str, Any]]:
    """Yield the cards of all steps; their pictures are added to ``pictures``, those of steps alike only once."""
    gridshell, drawn = backgrounds.gridshell, dict[tuple[object, ...], list[str]]()
    for step in plan.steps:
        listed = () if PHASE[step.phase].listed else step.marks
        card = step_card(plan, step, common.known, step_table(gridshell, plan, step, common.known), listed)
        key = picture_key(backgrounds, step)
        if key not in drawn:
            made = {f"step-{step.number}-{i}": picture for i, picture in enumerate(step_pictures(backgrounds, step))}
            pictures |= made
            drawn[key] = list(made)
        pictures[f"qr-{step.number}"] = qr_svg(card["qr"])
        yield (
            card
            | card_lines(kind, words, step, card)
            | {
                "caption": words["captions"].get(_caption(step), ""),
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
    return Common(gridshell, gridshell_known(gridshell, language), pictures | drawn, maps)


def _booklet(kind: Kind, planned: Planned, common: Common) -> tuple[Booklet, Backgrounds]:
    """Return what both booklets have: cover, words, list of steps, schedule, cards."""
    up = kind == "sequence"
    plan, schedule = (planned.plan, planned.schedule) if up else (planned.down, planned.down_schedule)
    gridshell, pictures = common.gridshell, dict(common.pictures)
    weights = {**common.known.weights, **segment_weights(gridshell, planned.segmentation)}
    common = replace(common, known=replace(common.known, weights=weights))
    slides = [slide for order in planned.orders.values() for slide in order.slides]
    words = sheet_words(kind, common.language)
    backgrounds = backgrounds_of(plan, gridshell, planned.segmentation, slides, common.language)
    data, pictures["schedule"] = booklet_data(
        kind,
        gridshell.title,
        words,
        plan,
        schedule,
        totals(gridshell, common.known),
        _cards(kind, words, plan, backgrounds, common, pictures),
        common.language,
        cover="vault",
        rest=words["list"]["site"],
    )
    index = index_of(gridshell)
    example = next(iter((*index.geodesics, *index.planks)))
    return Booklet(data | common.maps, pictures, tuple(_handled(plan, index, common.language)), example), backgrounds


def _handled(plan: Plan, index: Index, language: Language) -> Iterator[Handled]:
    """Yield for each step its number, title and what it handles: its parts, beams, shells, and planks it fastens."""
    for step in plan.steps:
        own = set(step.marks)
        joints = {joint_of(mark) for mark in own} if PHASE[step.phase].fastens else set[str]()
        members = (mark for joint in joints if joint in index.joints for mark in index.joints[joint].members)
        fastened = {index.unit_of[mark] for mark in members if mark in index.unit_of}
        yield step.number, step_title(step, language), sorted({*own, *step.assemblies, *fastened})


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
    return replace(booklet, data=data, pictures=pictures)


def disassembly_booklet(planned: Planned, common: Common) -> Booklet:
    """Return the booklet of taking down, in the language of ``common``."""
    return _booklet("disassembly", planned, common)[0]
