"""Twins: shells made as copies say so, and what holds for the first of them is not worked out again."""

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from aag_cad.design import load_design
from aag_cad.errors import FileError
from aag_cad.parts.clash import clashes
from aag_cad.parts.index import index_of
from aag_cad.parts.model import Gridshell, Shell
from aag_cad.parts.store import gridshell_json, read_gridshell
from aag_cad.parts.twins import made_for_each, renamed
from aag_cad.pipeline import gridshell_of


def test_copies_about_the_centre_are_twins_of_the_first_shell(gridshell: Gridshell) -> None:
    assert [shell.twin_of for shell in gridshell.shells] == ["", "S1", "S1"]
    assert index_of(gridshell).twins == {"S1": "S1", "S2": "S1", "S3": "S1"}


@pytest.mark.parametrize(("name", "twins"), [("column", [""]), ("half-roof", ["", "S1"])])
def test_one_shell_is_nobodys_twin_and_mirror_shells_are_twins(name: str, twins: list[str]) -> None:
    """A shell that is its own mirror image is moved onto the one across the plane by half a turn, too."""
    assert [shell.twin_of for shell in gridshell_of(load_design(name)).shells] == twins


def test_twins_stay_twins_where_their_first_shell_is_left_out(gridshell: Gridshell) -> None:
    assert index_of(replace(gridshell, shells=gridshell.shells[1:])).twins == {"S2": "S2", "S3": "S2"}


def test_what_is_made_of_a_shell_is_made_once_for_its_twins_with_their_own_marks(gridshell: Gridshell) -> None:
    asked: list[str] = []

    def longest(shell: Shell) -> dict[str, tuple[float, str]]:
        asked.append(shell.mark)
        return {shell.mark: max((plank.blank.length, plank.mark) for plank in shell.planks)}

    made = made_for_each(gridshell, longest)
    assert asked == ["S1"]
    assert made == {shell.mark: longest(shell) for shell in gridshell.shells}


def test_without_the_record_every_shell_is_looked_at(gridshell: Gridshell) -> None:
    foreign = replace(gridshell, shells=tuple(replace(shell, twin_of="") for shell in gridshell.shells))
    made = made_for_each(foreign, lambda shell: shell.mark)
    assert made == {mark: mark for mark in index_of(foreign).twins} == index_of(foreign).twins


def test_renaming_reaches_keys_and_nested_data_and_leaves_numbers_alone() -> None:
    points = np.zeros(3)
    value = {"a": (("a", 1.0), "b"), "c": points}
    found: Any = renamed(value, lambda text: text.upper())
    assert found == {"A": (("A", 1.0), "B"), "C": points}
    assert found["C"] is points


def test_a_clash_inside_a_shell_is_told_once_for_its_twins(gridshell: Gridshell) -> None:
    """A stud pushed sideways by 40 mm in all three shells reaches into a plank of each."""

    def pushed(shell: Shell) -> Shell:
        stud = shell.studs[0]
        x, y, z = stud.frame.origin
        moved = replace(stud, frame=replace(stud.frame, origin=(x, y + 40.0, z)))
        return replace(shell, studs=(moved, *shell.studs[1:]))

    damaged = replace(gridshell, shells=tuple(map(pushed, gridshell.shells)))
    apart = replace(damaged, shells=tuple(replace(shell, twin_of="") for shell in damaged.shells))
    stud = gridshell.shells[0].studs[0].mark
    told = [(c.first, c.second) for c in clashes(damaged, 1.0) if stud[2:] in c.first + c.second]
    every = [(c.first, c.second) for c in clashes(apart, 1.0) if stud[2:] in c.first + c.second]
    assert told
    assert len(every) == 3 * len(told)
    assert all(first.startswith("S1-") and second.startswith("S1-") for first, second in told)


def test_the_record_is_written_and_a_file_without_it_has_no_twins(gridshell: Gridshell) -> None:
    data = json.loads(gridshell_json(gridshell))
    assert [shell["twin_of"] for shell in data["shells"]] == ["", "S1", "S1"]
    for shell in data["shells"]:
        del shell["twin_of"]
    assert {shell.twin_of for shell in read_gridshell(json.dumps(data)).shells} == {""}


def test_a_record_that_is_not_true_is_refused(gridshell: Gridshell) -> None:
    first, second, third = gridshell.shells
    plank = replace(second.planks[0], blank=replace(second.planks[0].blank, holes=()))
    changed = replace(second, planks=(plank, *second.planks[1:]))
    for shells, told in (
        ((first, changed, third), r"shells\[1\].twin_of: S2 differs from S1 in its own coordinates; leave twin_of out"),
        ((first, second, replace(third, twin_of="S2")), r"shells\[2\].twin_of: 'S2' is no shell before it"),
        ((replace(first, twin_of="S3"), second, third), r"shells\[0\].twin_of: 'S3' is no shell before it"),
    ):
        with pytest.raises(FileError, match=told):
            read_gridshell(gridshell_json(replace(gridshell, shells=shells)))
