"""The words of the printouts: the same in English and in German, complete, and nothing of one language in the other."""

import re
from collections.abc import Iterator
from dataclasses import replace
from string import Formatter
from typing import Any
from xml.etree import ElementTree

import pytest
from making import a_step, sheets_for

from aag_cad.language import LANGUAGES, Language, figure, language_of, say, says, words_table
from aag_cad.parts.model import ClampingBar, Gridshell, Mullion, Plank, Shell, Strap, Strip, all_parts
from aag_cad.parts.products import product_name
from aag_cad.resources import template
from assembly.base.locking_order import LockingOrder, LockingStep, Prop
from assembly.base.phases import DOWN_PHASES, PHASES, UP_PHASES, Phase
from assembly.base.steps import Plan
from assembly.booklet.card_tables import gridshell_known, step_table, totals
from assembly.booklet.cards import qr_text, step_card
from assembly.booklet.gantt import gantt_svg
from assembly.booklet.step_words import StepWords, step_words
from assembly.drawing.joint_sections import block_section_svg, node_section_svg
from assembly.drawing.names import part_name, phase_name
from assembly.drawing.steel_sections import blade_section_svg, foot_section_svg, strap_section_svg
from assembly.pictures.locking_chart import locking_svg, locking_table
from assembly.plan.assembly_plan import plan_of
from assembly.plan.disassembly import disassembly_of
from assembly.plan.piece_weights import piece_weights
from assembly.plan.schedule import schedule_of
from assembly.plan.step_cards import Fasteners, card, fasteners_by_kind

TABLES = sorted(path.stem for path in template("printouts", "words").glob("*.toml"))
# Texts for special cases of a phase: segments of cut shells, edges and shells without straps.
SPECIAL = {
    "phases": ("edge planks alone", "tighten alone", "stand free", "stand segment", "raise segment"),
    "down": ("pull edge planks alone",),
}
OWN = ("phases", "down", "cards", "parts", "schedule", "pictures")
ENGLISH = (
    "after all and are at before beam beams block both bolt bolts by crown each edge for from geodesic geodesics hold "
    "inside it its length lower mark marks mass not of on or outside people plank planks prop props screw screws shell "
    "shells side step steps stud studs take the them then this to tools under until upper when where which with"
)
# Words of both languages.
BOTH = {"all", "block", "hold", "marks", "it", "on"}
_ENGLISH_WORD = re.compile(rf"\b({'|'.join(word for word in ENGLISH.split() if word not in BOTH)})\b", re.IGNORECASE)
_GERMAN_LETTER = re.compile("[äöüßÄÖÜ]")
# Figures to be filled in, names of swatches, and keys of design files: these are no words.
_NAMED = re.compile(r"\{[^}]*\}|\[\[\w+\]\]|\b\w+\.\w+\b")
_MARK = re.compile(r"\b(?:A1|A2|[GENK])-\d+\b")


def entries(table: dict[str, Any], path: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield each text of a table by its path: what has a language as a key."""
    for key, found in table.items():
        assert isinstance(found, dict), f"{path}{key}: not in a language"
        if set(found) & set(LANGUAGES):
            yield f"{path}{key}", found
        else:
            yield from entries(found, f"{path}{key}.")


def lines(text: str | list[str]) -> list[str]:
    return [text] if isinstance(text, str) else text


def fields(text: str | list[str]) -> set[str]:
    return {field for line in lines(text) for _, field, _, _ in Formatter().parse(line) if field is not None}


@pytest.mark.parametrize("name", TABLES)
def test_each_text_stands_in_both_languages_with_the_same_figures(name: str) -> None:
    for path, found in entries(words_table(name)):
        assert set(found) == set(LANGUAGES), path
        english, german = found["en"], found["de"]
        assert type(english) is type(german), path
        assert len(lines(english)) == len(lines(german)), path
        assert fields(english) == fields(german), path
        assert re.findall(r"\[\[.*?\]\]", str(english)) == re.findall(r"\[\[.*?\]\]", str(german)), path
        for line in (*lines(english), *lines(german)):
            assert line.strip() or path == "words.and", f"{path}: empty"


@pytest.mark.parametrize("name", TABLES)
def test_no_english_is_left_in_the_german_and_no_german_in_the_english(name: str) -> None:
    for path, found in entries(words_table(name)):
        for line in lines(found["de"]):
            assert not _ENGLISH_WORD.search(_NAMED.sub("", line)), f"{path}: {line}"
        for line in lines(found["en"]):
            assert not _GERMAN_LETTER.search(line), f"{path}: {line}"


def test_the_tables_of_this_file_are_shipped() -> None:
    assert set(OWN) <= set(TABLES)


@pytest.mark.parametrize(("name", "phases", "others"), [
    ("phases", UP_PHASES, {"words", *SPECIAL["phases"]}), ("down", DOWN_PHASES, {"words", "titles", *SPECIAL["down"]}),
])  # fmt: skip
def test_every_phase_has_its_words_and_no_other(name: str, phases: tuple[Phase, ...], others: set[str]) -> None:
    table = words_table(name)
    assert set(table) == set(phases) | others
    for phase in phases:
        assert set(table[phase]) == {"name", "tools", "instructions", "hold"}
    for told in SPECIAL[name]:
        assert set(table[told]) == {"tools", "instructions", "hold"}


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_name_of_a_phase_fits_the_strip_of_the_card(language: Language) -> None:
    """Nine boxes share 180 mm: twelve letters of 7.5 pt stand in 19 mm."""
    names = [phase_name(phase, language) for phase in PHASES]
    assert max(map(len, names)) <= 12
    assert len(set(names)) == len(names)


def _told(phase: Phase, fasteners: Fasteners, language: Language) -> StepWords:
    return step_words(replace(a_step(1, phase=phase, held=True), card=card(phase, fasteners)), language)


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_words_of_every_phase_are_filled_in(language: Language, gridshell: Gridshell) -> None:
    fasteners = fasteners_by_kind(gridshell, gridshell.shells[:1])
    for phase in UP_PHASES:
        for words in (_told(phase, fasteners, language), _told(phase, {}, language)):
            told = (*words.tools, *words.instructions, words.hold)
            assert all(told), phase
            assert not any("{" in line or "}" in line for line in told), phase


def test_spanners_drills_and_bolts_are_those_of_the_joints(gridshell: Gridshell) -> None:
    fasteners = fasteners_by_kind(gridshell, gridshell.shells[:1])
    english, german = (_told("studs", fasteners, language) for language in LANGUAGES)
    assert (english.tools[0], german.tools[0]) == ("two 13 mm spanners", "zwei Schlüssel SW 13")
    assert "(Bolt M8 x 65, a washer" in english.instructions[1]
    assert "(Sechskantbolzen M8 x 65, an jedem Ende" in german.instructions[1]
    # 0.7 of the 4 mm and 6 mm screws of the cover.
    assert _told("cover", fasteners, "en").tools[0] == "cordless drill, 2.8 mm bit and 4.2 mm bit, screw bit"
    assert _told("cover", fasteners, "de").tools[0] == ("Akkuschrauber, Bohrer 2,8 mm und Bohrer 4,2 mm, Schrauberbit")


@pytest.mark.parametrize(("language", "stay", "away"), [("en", "stay", "let down"), ("de", "bleib", "ablassen")])
def test_a_stiff_shell_keeps_its_props_until_every_ridge_is_joined(language: Language, stay: str, away: str) -> None:
    """Alone on its feet it sags by 64 mm (docs/locking.md): only the last step of the ridges lets the props down."""
    told = {p: " ".join((*says(language, f"phases.{p}.instructions"), say(language, f"phases.{p}.hold"))) for p in (
        "tighten", "stand", "ridges")}  # fmt: skip
    assert stay in told["tighten"]
    assert stay in told["stand"]
    assert away in say(language, "phases.ridges.hold")
    assert not any(away in told[phase] for phase in ("tighten", "stand"))


@pytest.fixture(scope="module", params=["up", "down"])
def plan(request: pytest.FixtureRequest, gridshell: Gridshell) -> Plan:
    return (plan_of if request.param == "up" else disassembly_of)(gridshell, 4, 25.0)


def test_a_step_says_the_same_in_german_as_in_english(plan: Plan) -> None:
    for step in plan.steps:
        one, other = (step_words(step, language) for language in LANGUAGES)
        assert one.title != other.title
        assert _MARK.findall(one.title) == _MARK.findall(other.title)
        for name in ("tools", "instructions", "extras"):
            assert len(getattr(one, name)) == len(getattr(other, name))
        assert bool(one.hold) == bool(other.hold) == step.held
        for line in (other.title, *other.tools, *other.instructions, other.hold, *other.extras):
            assert not _ENGLISH_WORD.search(line), line


def test_german_cards_print_the_figures_of_the_english_ones(plan: Plan, gridshell: Gridshell) -> None:
    known = [gridshell_known(gridshell, language) for language in LANGUAGES]
    seen: set[str] = set()
    for step in plan.steps:
        if step.phase in seen:
            continue
        seen.add(step.phase)
        english, german = (
            step_card(sheets_for(plan, each), step, step_table(gridshell, plan, step, each), step.marks, step.marks)
            for each in known
        )
        assert set(english) == set(german)
        for name in ("id", "crew", "qr", "handled"):
            assert english[name] == german[name]
        for name in ("added", "heaviest", "propped"):
            told = (re.findall(r"\d+(?:[.,]\d+)?", card[name]) for card in (english, german))
            assert next(told) == [number.replace(",", ".") for number in next(told)]
        assert [row[0] for row in english["parts"]] == [row[0] for row in german["parts"]]
        assert sum(now for _, now in german["phases"]) == 1
        if english["table"] is None:
            assert german["table"] is None
            continue
        for table in (english["table"], german["table"]):
            assert {len(table["head"])} == {len(row) for row in table["rows"]}
        told = " ".join([*german["table"]["head"], *(cell for row in german["table"]["rows"] for cell in row)])
        assert not _ENGLISH_WORD.search(told), told
        assert not re.search(r"\d\.\d", told)


def test_the_code_of_a_card_names_its_parts_and_stays_short(plan: Plan, gridshell: Gridshell) -> None:
    weights = piece_weights(gridshell)
    for step in plan.steps:
        text = qr_text("vault", step, weights)
        assert text.startswith(f"vault {step.id}: ")
        assert len(text) < 300
        assert len(text) > len(f"vault {step.id}: ")
    lay = next(step for step in plan.steps if step.phase in ("lay A1", "take off geodesics"))
    shown = {"lay A1": "vault S1.lay.1: A1-01 … A1-06", "take off geodesics": "vault S1.down.off.3: G-08 … G-14"}
    assert qr_text("vault", lay, weights) == shown[lay.phase]


def test_a_make_is_called_in_english_as_the_files_call_the_product(gridshell: Gridshell) -> None:
    """Bars and strips of all lengths are one make; of all other parts the make is the product."""
    makes = {part_name(part): part for part in all_parts(gridshell)}
    for name, part in makes.items():
        if not isinstance(part, Plank | Mullion | ClampingBar | Strap | Strip):
            assert name == product_name(part)
        german = part_name(part, "de")
        assert german != name
        assert re.findall(r"\d+", german) == re.findall(r"\d+", name)


def test_the_totals_of_the_cover_have_a_decimal_comma_in_german(gridshell: Gridshell) -> None:
    english, german = (totals(gridshell, gridshell_known(gridshell, language)) for language in LANGUAGES)
    assert [row[1:3] for row in english["rows"]] == [row[1:3] for row in german["rows"]]
    assert [row[3].replace(".", ",") for row in english["rows"]] == [row[3] for row in german["rows"]]
    assert ["Holz", "Esche D50"] in german["facts"]
    assert ["timber", "ash D50"] in english["facts"]


def svg_words(picture: str) -> list[str]:
    return [text for node in ElementTree.fromstring(picture).iter() if (text := (node.text or "").strip())]


def test_no_english_is_left_in_a_german_chart(plan: Plan) -> None:
    chart = gantt_svg(plan, schedule_of(plan, {step.id: 60 for step in plan.steps}, 4), "Gewölbe", "de")
    words = svg_words(chart)
    assert {"Platz", "Tag", "Leute", "S1"} <= set(words)
    assert [text for text in words if _ENGLISH_WORD.search(text)] == []


def test_no_english_is_left_in_german_pictures(gridshell: Gridshell, shell: Shell) -> None:
    pictures = (
        node_section_svg(shell, language="de"),
        block_section_svg(shell, language="de"),
        foot_section_svg(shell, shell.shoes[0], named=True, language="de"),
        strap_section_svg(shell, shell.straps[0], language="de"),
        blade_section_svg(gridshell, gridshell.blades[0], language="de"),
    )
    for picture in pictures:
        for text in svg_words(picture):
            assert not _ENGLISH_WORD.search(text), text


def an_order() -> LockingOrder:
    """Return an order of two steps, with round figures."""
    values = (10.0, 40.0, 90.0, 160.0)
    steps = (
        LockingStep((), values, 2, 38.4, "S1-K-015", (Prop("S1-K-015", 38.4, 900.0),), 14.2),
        LockingStep(("S1-G-01", "S1-G-14"), values, 0, 17.0, "S1-K-198", (), 17.0),
    )
    return LockingOrder("S1", (), (), True, 30.0, 20.0, steps, steps[1], 1.0, 1.0)


def test_the_locking_order_prints_alike_in_both_languages() -> None:
    english, german = (locking_table(an_order(), language) for language in LANGUAGES)
    assert english["rows"][0][2:] == ["2", "0.50", "1.01", "38", "K-015", "K-015", "14"]
    assert german["rows"][0][2:] == ["2", "0,50", "1,01", "38", "K-015", "K-015", "14"]
    assert german["rows"][1][1] == "G-01, G-14"
    assert german["rows"][2][1] == "Bolzen fest, Stützen weg"
    assert {len(german["head"])} == {len(row) for row in german["rows"]}
    words = svg_words(locking_svg(an_order(), "de"))
    assert {"gehoben", "weich", "S1: weichste Eigenform und die nächsten", "0,5"} <= set(words)
    assert {"hoisted", "soft", "0.5"} <= set(svg_words(locking_svg(an_order())))


def test_a_figure_has_the_decimal_sign_of_its_language() -> None:
    assert (figure("12.5", "en"), figure("12.5", "de")) == ("12.5", "12,5")
    assert [language_of(text) for text in ("en", "de")] == list(LANGUAGES)
