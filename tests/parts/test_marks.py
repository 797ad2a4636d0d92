"""The grammar of marks: what is printed is read back, and nothing else is a mark."""

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from aag_cad.errors import MarkError
from aag_cad.parts.kinds import kind_of
from aag_cad.parts.marks import Mark, parse_mark, shell_of
from aag_cad.parts.model import Gridshell, all_parts, ridge_parts, shell_parts

FAMILIES = ("A1", "A2", "G", "E", "F", "R", "C", "P", "M", "D", "N", "K", "V")
SHELLS = st.integers(1, 99)
INDICES = st.integers(1, 99_999)
FASTENERS = st.builds("{}{}".format, st.sampled_from("BWT"), st.integers(1, 99))
PAIRS = st.permutations("123456789").map(lambda pair: f"R{pair[0]}{pair[1]}")
BLADE_BOLTS = st.one_of(st.just(""), st.integers(1, 99).map("B{}".format))

MARKS = st.one_of(
    st.builds(Mark, SHELLS),
    st.builds(Mark, SHELLS, st.sampled_from(FAMILIES), INDICES),
    st.builds(Mark, SHELLS, st.sampled_from(("A1", "A2")), INDICES, st.sampled_from("LR")),
    st.builds(Mark, SHELLS, st.sampled_from("NKFRCV"), INDICES, FASTENERS),
    st.builds(Mark, st.just(0), PAIRS, INDICES, BLADE_BOLTS),
)


@pytest.mark.parametrize(
    ("text", "mark"),
    [
        ("S1", Mark(1)),
        ("S3-A1-07", Mark(3, "A1", 7)),
        ("S1-A2-11-L", Mark(1, "A2", 11, "L")),
        ("S2-G-05", Mark(2, "G", 5)),
        ("S1-E-02", Mark(1, "E", 2)),
        ("S1-N-031", Mark(1, "N", 31)),
        ("S1-N-031-B4", Mark(1, "N", 31, "B4")),
        ("S1-K-204-W1", Mark(1, "K", 204, "W1")),
        ("S12-G-101", Mark(12, "G", 101)),
        ("S1-N-1234", Mark(1, "N", 1234)),
        ("R12-03", Mark(0, "R12", 3)),
        ("R12-03-B1", Mark(0, "R12", 3, "B1")),
        ("S1-F-05-B4", Mark(1, "F", 5, "B4")),
        ("S1-C-05-T1", Mark(1, "C", 5, "T1")),
        ("S1-D-05", Mark(1, "D", 5)),
        ("S1-V-012-W3", Mark(1, "V", 12, "W3")),
    ],
)
def test_marks_as_they_stand_on_planks_and_in_lists(text: str, mark: Mark) -> None:
    assert parse_mark(text) == mark
    assert str(mark) == text


@given(mark=MARKS)
def test_every_printed_mark_is_read_back_as_itself(mark: Mark) -> None:
    assert parse_mark(str(mark)) == mark


@pytest.mark.parametrize(
    "text",
    [
        "", " ", "S", "S0", "S01", "S100", "s1", "S1-", "S1-A1", "S1-A1-", "S1-A1-7", "S1-A1-007", "S1-A3-07",
        "S1-A-07", "S1-a1-07", "S1-A1-00", "S1-A1-07-", "S1-A1-07-l", "S1-A1-07-M", "S1-A1-07-LR", "S1-A1-07-L-B1",
        "S1-N-31", "S1-N-0031", "S1-N-000", "S1-N-031-B0", "S1-N-031-B01", "S1-N-031-B", "S1-N-031-B100", "S1-N-031-X1",
        "S1 A1 07", "S1_A1_07", "S1-A1-07 ", " S1-A1-07", "S1-A1-07\n", "S1--A1-07", "A1-07", "R12", "R12-3", "R12-00",
        "R1-03", "R123-03", "R12-03-W1", "R12-03-B0", "R11-01", "S1-G-05-L", "S1-A1-07-B1", "S1-N-031-L",
        "S1-R12-03", "S1-A1-\u0660\u0667", "S1-A1-0\uff17",
        "S-1-A1-07", "S1-A1-+7", "S1-A1--7",
    ],
)  # fmt: skip
def test_what_only_looks_like_a_mark_is_none(text: str) -> None:
    with pytest.raises(MarkError, match="is not a mark"):
        parse_mark(text)


@given(mark=MARKS, data=st.data())
def test_a_mark_with_one_sign_changed_is_another_mark_or_none(mark: Mark, data: st.DataObject) -> None:
    """Never is a mistyped mark taken for the one that was meant."""
    text = str(mark)
    place = data.draw(st.integers(0, len(text) - 1))
    sign = data.draw(st.sampled_from("SAGENKFRCPMDV0123456789-LBWTx "))
    assume(sign != text[place])
    mistyped = text[:place] + sign + text[place + 1 :]
    try:
        read = parse_mark(mistyped)
    except MarkError:
        return
    assert str(read) == mistyped
    assert read != mark


@given(text=st.text(max_size=12))
def test_no_text_is_read_as_a_mark_that_is_printed_otherwise(text: str) -> None:
    try:
        read = parse_mark(text)
    except MarkError:
        return
    assert str(read) == text


def test_the_refusal_shows_what_marks_look_like() -> None:
    with pytest.raises(MarkError, match="marks look like S1, S1-A1-07, S1-A1-07-L"):
        parse_mark("plank 7")
    with pytest.raises(MarkError, match="'S1-A1-07' would be"):
        parse_mark("S1-A1-007")


def test_marks_sort_by_shell_family_number_and_not_by_letters() -> None:
    texts = ["S10-A1-01", "S2-G-100", "S2-G-99", "S2-A1-10-R", "S2-A1-10-L", "S2-A1-09"]
    ordered = [str(mark) for mark in sorted(map(parse_mark, texts))]
    assert ordered == ["S2-A1-09", "S2-A1-10-L", "S2-A1-10-R", "S2-G-99", "S2-G-100", "S10-A1-01"]


@given(mark=MARKS)
def test_the_shell_of_a_mark_is_its_beginning_and_a_blade_has_none(mark: Mark) -> None:
    text = str(mark)
    assert shell_of(text) == (text.split("-")[0] if mark.shell else "")


def test_every_mark_of_the_vault_is_in_the_grammar_and_used_once(gridshell: Gridshell) -> None:
    marks = [part.mark for part in all_parts(gridshell)]
    beams = [beam.mark for shell in gridshell.shells for beam in shell.beams]
    assert all(str(parse_mark(mark)) == mark for mark in marks + beams)
    assert len(set(marks + beams)) == len(marks) + len(beams)


def test_every_part_of_a_shell_bears_its_shells_mark(gridshell: Gridshell) -> None:
    for shell in gridshell.shells:
        for plank in shell.planks:
            assert shell_of(plank.mark) == shell.mark
            assert parse_mark(plank.mark).family == plank.family
        assert {shell_of(part.mark) for part in shell_parts(shell)} == {shell.mark}
    assert {shell_of(part.mark) for part in ridge_parts(gridshell)} == {""}


def test_the_letter_of_a_mark_says_what_a_part_is(gridshell: Gridshell) -> None:
    """Fasteners by their last part, all others by their family; a blade is R and a pair of shells."""
    kinds: dict[str, set[str]] = {}
    for part in all_parts(gridshell):
        mark = parse_mark(part.mark)
        family = mark.family if mark.shell else "blade"
        letter = mark.part[0] if mark.part[:1] in ("B", "W", "T") else family
        kinds.setdefault(letter, set()).add(kind_of(part).name)
    assert kinds == {
        "A1": {"plank"}, "A2": {"plank"}, "G": {"plank"}, "E": {"plank"}, "N": {"stud"}, "K": {"coupling block"},
        "B": {"bolt"}, "W": {"screw"}, "T": {"threaded rod"}, "R": {"strap"}, "F": {"shoe"}, "C": {"concrete block"},
        "blade": {"blade"}, "P": {"strip"}, "M": {"mullion"}, "D": {"clamping bar"}, "V": {"coupling block"},
    }  # fmt: skip
