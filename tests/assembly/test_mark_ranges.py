"""Marks printed as ranges say exactly which marks they stand for."""

import re

from hypothesis import given
from hypothesis import strategies as st

from aag_cad.parts.marks import Mark, parse_mark, short_mark
from assembly.base.mark_ranges import joined_ranges, mark_ranges

indices = st.integers(1, 30)
joints = st.builds(Mark, st.integers(1, 3), st.sampled_from(["K", "N", "G"]), indices)
sides = st.builds(Mark, st.just(2), st.sampled_from(["A1", "A2"]), indices, st.sampled_from(["L", "R"]))


def expanded(text: str, shell: int) -> set[str]:
    """Read a printed range back, as a carpenter would."""
    found = re.fullmatch(r"(\S+?)(?: … (\S+))?(?: ([LR+]+))?", text)
    assert found
    first, last, parts = found[1], found[2] or found[1], (found[3] or "").split("+")
    a, b = (parse_mark(end if end.startswith("S") else f"S{shell}-{end}") for end in (first, last))
    assert (a.shell, a.family) == (b.shell, b.family)
    return {str(Mark(a.shell, a.family, i, part)) for i in range(a.index, b.index + 1) for part in parts}


@given(st.sets(joints, min_size=1, max_size=25))
def test_ranges_of_joints_read_back(marks: set[Mark]) -> None:
    texts = mark_ranges([str(mark) for mark in marks])
    shell = next(iter(marks)).shell
    assert set().union(*(expanded(text, shell) for text in texts)) == {str(mark) for mark in marks}


@given(st.sets(sides, min_size=1, max_size=25))
def test_ranges_of_sibling_planks_read_back(marks: set[Mark]) -> None:
    texts = mark_ranges([str(mark) for mark in marks])
    assert set().union(*(expanded(text, 2) for text in texts)) == {str(mark) for mark in marks}


def test_three_neighbours_or_more_become_one_range() -> None:
    marks = [f"S1-A1-{i:02d}-{side}" for i in (1, 2, 3) for side in "LR"]
    assert joined_ranges(marks) == "A1-01 … A1-03 L+R"
    assert joined_ranges(["S1-K-004", "S1-K-001", "S1-K-002"]) == "K-001, K-002, K-004"
    assert joined_ranges(["S1-K-004", "S1-K-003", "S1-K-001", "S1-K-002"]) == "K-001 … K-004"


def test_marks_of_several_shells_keep_theirs() -> None:
    assert joined_ranges(["S1-F-01", "S2-F-01"]) == "S1-F-01, S2-F-01"
    assert short_mark("S2-G-05") == "G-05"
    assert short_mark("R12-03") == "R12-03"
    assert short_mark("S2") == "S2"
