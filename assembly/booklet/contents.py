"""What the booklets of a gridshell print: words, tables and pictures as plain data, for paper and for telephones."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from aag_cad.language import Language
from aag_cad.parts.index import Index, index_of
from aag_cad.parts.marks import joint_of, parse_mark
from aag_cad.parts.model import Gridshell
from assembly.base.phases import PHASE
from assembly.base.steps import Plan, Step
from assembly.booklet.booklet_data import Booklet, booklet_of
from assembly.booklet.card_tables import gridshell_known, step_table, totals
from assembly.booklet.cards import Known, Sheets, step_card
from assembly.booklet.drawn_pages import Made, laying_pages, locking_pages, map_pages, segment_pages
from assembly.booklet.words import Kind, sheet_words
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


def _handled(step: Step, index: Index) -> Iterable[str]:
    """Return what a step handles: its parts, beams, shells, and the planks that it fastens."""
    joints = {joint_of(mark) for mark in step.marks} if PHASE[step.phase].fastens else set[str]()
    members = (mark for joint in joints if joint in index.joints for mark in index.joints[joint].members)
    return (*step.marks, *step.assemblies, *(index.unit_of[mark] for mark in members if mark in index.unit_of))


def _cards(sheets: Sheets, backgrounds: Backgrounds, pictures: dict[str, str]) -> Iterator[dict[str, Any]]:
    """Yield the cards of all steps; their pictures are added to ``pictures``, those of steps alike only once."""
    gridshell, drawn = backgrounds.gridshell, dict[tuple[object, ...], list[str]]()
    for step in sheets.plan.steps:
        table = step_table(gridshell, sheets.plan, step, sheets.known)
        listed = () if PHASE[step.phase].listed else step.marks
        key = picture_key(backgrounds, step)
        if key not in drawn:
            made = {f"step-{step.number}-{i}": picture for i, picture in enumerate(step_pictures(backgrounds, step))}
            pictures |= made
            drawn[key] = list(made)
        yield step_card(sheets, step, table, listed, _handled(step, index_of(gridshell))) | {
            "caption": sheets.words["captions"].get(_caption(step), ""),
            "pictures": drawn[key],
            "key": f"key-{home}" if (home := home_shell(step) or _alone(step)) else "",
        }


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
    known, words = replace(common.known, weights=weights), sheet_words(kind, common.language)
    sheets = Sheets(kind, gridshell.title, plan, schedule, known, words)
    slides = [slide for order in planned.orders.values() for slide in order.slides]
    backgrounds = backgrounds_of(plan, gridshell, planned.segmentation, slides, common.language)
    booklet = booklet_of(
        sheets,
        totals(gridshell, known),
        _cards(sheets, backgrounds, pictures),
        pictures,
        cover="vault",
        rest=words["list"]["site"],
        example=next(iter((*index_of(gridshell).geodesics, *index_of(gridshell).planks))),
    )
    return Booklet(booklet.data | common.maps, pictures), backgrounds


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
