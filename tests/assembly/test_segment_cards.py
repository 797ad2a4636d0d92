"""Sheets and pictures of segments say what the segments are, in both languages."""

import re
from dataclasses import replace
from xml.etree import ElementTree

import pytest

from aag_cad.language import LANGUAGES, Language, printed
from aag_cad.parts.model import Gridshell
from assembly.base.segments import Limits, Segmentation, splices_of
from assembly.booklet.segment_cards import (
    SEGMENTS_HEADER,
    SPLICES_HEADER,
    brace_text,
    segment_cards,
    segment_rows,
    splice_rows,
)
from assembly.pictures.segment_picture import segment_svg
from assembly.transport.segments import segments

LORRY = Limits(12000.0, 2400.0, 2600.0, 3000.0)
SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def single(gridshell: Gridshell) -> Gridshell:
    """The first shell of the vault, alone."""
    return replace(gridshell, shells=gridshell.shells[:1], blades=(), bolts=(), joints=())


@pytest.fixture(scope="module")
def cut(single: Gridshell) -> Segmentation:
    """The shell in three segments."""
    return segments(single, LORRY)


def test_rows_have_the_columns_of_their_tables(cut: Segmentation) -> None:
    rows = segment_rows(cut)
    assert all(len(row) == len(SEGMENTS_HEADER) for row in rows)
    assert [row[0] for row in rows] == ["S1.1", "S1.2", "S1.3"]
    assert all(len(row) == len(SPLICES_HEADER) for row in splice_rows(cut))
    assert len(splice_rows(cut)) == sum(len(splice.cuts) for splice in cut.splices)


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_splice_stands_on_one_card_and_as_a_bare_end_on_another(cut: Segmentation, language: Language) -> None:
    cards = segment_cards(cut, language)
    assert sum(len(card["splices"]) for card in cards) == len(cut.splices)
    pairs = [splices_of(cut, segment) for segment in cut.segments]
    own = [splice for carried, _ in pairs for splice in carried]
    loose = [splice for _, bare in pairs for splice in bare]
    # Each cut joins two segments: the geodesic of its line is with one, the other's ends are bare.
    assert len(own) == len(loose) == len(cut.splices)
    assert set(map(id, own)) == set(map(id, loose))
    for card, segment in zip(cards, cut.segments, strict=True):
        assert len(card["braces"]) == len(segment.braces)
        assert all(len(row) == len(card["splices_head"]) for row in card["splices"])


def test_a_card_tells_mass_room_and_props(cut: Segmentation) -> None:
    card = segment_cards(cut)[1]
    segment = cut.segments[1]
    facts = dict(row for row in card["facts"] if isinstance(row, list))
    assert facts["Mass"].startswith(f"{segment.mass:.0f} kg, ")
    assert facts["Transport"].startswith("fits; ")
    assert facts["Geodesics"] == "G-06 … G-09"
    assert all(mark[3:] in facts["Props on site at"] for mark in segment.props)


def test_the_cards_say_the_same_in_both_languages(cut: Segmentation) -> None:
    def figures(language: Language) -> list[list[str]]:
        return [re.findall(r"\d[\d.,]*", " ".join(map(str, card.values()))) for card in segment_cards(cut, language)]

    english, german = figures("en"), figures("de")
    assert english == german
    assert segment_cards(cut, "de") != segment_cards(cut, "en")


def test_a_brace_is_told_with_its_ends_and_length(cut: Segmentation) -> None:
    brace = cut.segments[0].braces[0]
    for language in LANGUAGES:
        words = printed(brace_text(brace), language)
        assert brace.start[3:] in words
        assert brace.end[3:] in words
        assert f"{brace.length:.0f} mm" in words


def test_a_segment_that_does_not_fit_says_by_how_much(single: Gridshell) -> None:
    whole = segments(single, replace(LORRY, crane=10.0))
    card = segment_cards(whole, "de")[0]
    assert card["title"] == "Schale S1 am Stück"
    told = str(card["facts"])
    assert "mm zu hoch" in told
    assert "kg zu schwer" in told


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_picture_numbers_the_splices_and_names_the_cut_lines(
    single: Gridshell, cut: Segmentation, language: Language
) -> None:
    for segment in cut.segments:
        picture = ElementTree.fromstring(segment_svg(single, cut, segment, language))
        texts = [text.text or "" for text in picture.iter(f"{SVG}text")]
        carried, loose = splices_of(cut, segment)
        assert {str(i) for i in range(1, len(carried) + 1)} <= set(texts)
        assert {splice.line[3:] for splice in (*carried, *loose)} <= set(texts)
        assert sum(text in ("H", "HP") for text in texts) == 3
        assert sum(text in ("P", "HP") for text in texts) == 2
        # Length and height from the side, width and height from the end.
        for size, count in zip(segment.pose.size, (1, 1, 2), strict=True):
            assert texts.count(f"{size:.0f}") >= count


def test_a_whole_shell_has_a_picture_without_cuts(single: Gridshell) -> None:
    plan = segments(single, Limits(*(4 * (float("inf"),))))
    texts = segment_svg(single, plan, plan.segments[0])
    assert texts.count(">H<") == 3
    assert ">P<" not in texts
    assert "nan" not in texts
    assert "inf" not in texts
