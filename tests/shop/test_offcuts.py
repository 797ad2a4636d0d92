"""Old planks: the table is read or its line is named, and new planks are cut around the old holes."""

import csv
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aag_cad.design import Design
from aag_cad.design_making import Stock
from aag_cad.errors import FileError
from aag_cad.parts.forms import Blank, CrossSection, Hole
from aag_cad.parts.model import Gridshell
from aag_cad.shop.offcuts import OldPlank, barred_starts, fitting_planks, read_offcuts, reused_planks
from aag_cad.shop.passports import REUSE_HEADER, passports, reuse_row

SECTION = CrossSection(100.0, 12.0)
HEADER = ",".join(REUSE_HEADER)
ROW = "S1-G-01,4200.0,100,12,ash,D50,800:0:6.5;1200.5:-18.0:9"
AROUND = Stock(accept_old_holes=True)


def hole(station: float, offset: float = 0.0, diameter: float = 9.0) -> Hole:
    return Hole(station, offset, diameter, "bolt", "")


def blank(length: float, *holes: Hole) -> Blank:
    return Blank(length, SECTION, holes)


def table(tmp_path: Path, *rows: str, header: str = HEADER) -> Path:
    path = tmp_path / "reuse.csv"
    path.write_text("\n".join((header, *rows)) + "\n", encoding="utf-8")
    return path


def starts(old: Blank, new: Blank, stock: Stock, turned: bool = False, face_down: bool = False) -> np.ndarray:
    """Return the starts (n,), every 0.5 mm, at which a new plank can be cut from an old one."""
    tried = np.arange(0.0, old.length - new.length + 1e-9, 0.5)
    bars = barred_starts(old, new, stock, turned, face_down)
    return np.array([s for s in tried if not any(low < s < high for low, high in bars)])


def test_a_table_is_read_line_by_line(tmp_path: Path) -> None:
    (old,) = read_offcuts(table(tmp_path, ROW, ""))
    assert old.blank == blank(4200.0, hole(800.0, 0.0, 6.5), hole(1200.5, -18.0))
    assert (old.mark, old.species, old.strength_class) == ("S1-G-01", "ash", "D50")


def test_the_passports_of_the_vault_are_read_as_they_were_written(tmp_path: Path, gridshell: Gridshell) -> None:
    """The table of the reuse passports is the input of the next design: 183 planks with all their holes to 0.1 mm."""
    path = tmp_path / "reuse.csv"
    with path.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([REUSE_HEADER, *(reuse_row(held) for held in passports(gridshell))])
    planks = {plank.mark: plank for shell in gridshell.shells for plank in shell.planks}
    old = read_offcuts(path)
    assert {plank.mark for plank in old} == set(planks)
    for plank in old:
        made = planks[plank.mark].blank
        assert plank.blank.length == pytest.approx(made.length, abs=0.051)
        assert len(plank.blank.holes) == len(made.holes)


@pytest.mark.parametrize(
    ("row", "told"),
    [
        (ROW.replace("4200.0", "long"), "line 3: length_mm: 'long'"),
        (ROW.replace("4200.0", "-1"), "line 3: length_mm: '-1'"),
        (ROW.replace("4200.0", "nan"), "line 3: length_mm: 'nan'"),
        (ROW.replace(",12,", ",0,"), "line 3: thickness_mm: '0'"),
        (ROW.replace("800:0:6.5", "800:0"), "line 3: holes: '800:0' is not station:offset:diameter"),
        (ROW.replace("800:0:6.5", "4800:0:6.5"), "line 3: holes: '4800:0:6.5' does not lie in the plank"),
        (ROW.replace("800:0:6.5", "800:60:6.5"), "line 3: holes: '800:60:6.5' does not lie in the plank"),
        (ROW.replace("800:0:6.5", "nan:0:6.5"), "line 3: holes"),
        (ROW.replace("ash", " "), "line 3: species: empty"),
        (ROW + ",more", "line 3: 8 columns, but the header has 7"),
        (ROW, "line 3: mark: 'S1-G-01' stands there twice"),
    ],
)
def test_a_bad_line_is_named_with_its_number_and_column(tmp_path: Path, row: str, told: str) -> None:
    with pytest.raises(FileError, match=re.escape(told)):
        read_offcuts(table(tmp_path, ROW, row))


def test_another_header_and_a_missing_file_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="line 1: the header must be mark,length_mm"):
        read_offcuts(table(tmp_path, ROW, header="mark,length"))
    with pytest.raises(FileError, match=r"none\.csv: cannot be read"):
        read_offcuts(tmp_path / "none.csv")


@settings(max_examples=60)
@given(text=st.text(max_size=60))
def test_no_line_at_all_raises_anything_but_a_file_error(text: str, tmp_path_factory: pytest.TempPathFactory) -> None:
    path = tmp_path_factory.mktemp("reuse") / "reuse.csv"
    path.write_text(f"{HEADER}\n{text}", encoding="utf-8", errors="replace", newline="")
    try:
        planks = read_offcuts(path)
    except FileError:
        return
    assert all(plank.blank.length > 0.0 for plank in planks)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"blank": Blank(2000.0, CrossSection(80.0, 12.0), ())}, "width"),
        ({"blank": Blank(2000.0, CrossSection(100.0, 15.0), ())}, "thickness"),
        ({"strength_class": "D40"}, "strength"),
        ({"strength_class": "C24"}, "strength"),
        ({"species": "oak"}, "oak"),
    ],
)
def test_old_planks_of_another_kind_are_told_and_left(design: Design, change: dict[str, object], word: str) -> None:
    good = {"mark": "old", "blank": blank(2000.0), "species": "ash", "strength_class": "D50"}
    fitting, refused = fitting_planks([OldPlank(**{**good, **change})], design.timber)  # type: ignore[arg-type]
    assert not fitting
    assert [refusal.code for refusal in refused] == ["AAG902"]
    assert word in refused[0].what
    assert fitting_planks([OldPlank(**good)], design.timber)[1] == ()  # type: ignore[arg-type]


def test_as_a_rule_no_old_hole_lies_in_a_new_plank() -> None:
    """A hole of 9 mm at 1000 in 2500: a plank of 900 starts between 0 and 95.5, or after 1004.5."""
    found = starts(blank(2500.0, hole(1000.0)), blank(900.0), Stock())
    assert found[found < 500.0].max() == 95.5
    assert found[found > 500.0].min() == 1004.5


def test_an_accepted_hole_keeps_clear_of_new_holes_and_is_not_cut_by_an_end() -> None:
    """New hole at 450 of 900: rims 24 mm apart, so the old hole at 1000 stays 33 mm from 450 + start."""
    old, new = blank(2500.0, hole(1000.0)), blank(900.0, hole(450.0))
    found = starts(old, new, AROUND)
    allowed = np.array([abs(s + 450.0 - 1000.0) >= 33.0 or abs(s - 550.0) <= 0.3 for s in np.arange(0.0, 1600.25, 0.5)])
    ends = np.array([min(abs(s - 1000.0), abs(s + 900.0 - 1000.0)) >= 4.5 for s in np.arange(0.0, 1600.25, 0.5)])
    assert found.tolist() == np.arange(0.0, 1600.25, 0.5)[allowed & ends].tolist()


def test_a_hole_across_the_plank_counts_by_its_distance() -> None:
    """Old hole at offset 30, new at -30: 60 mm apart across, more than 33, so any station will do."""
    old, new = blank(1000.0, hole(500.0, 30.0)), blank(900.0, hole(450.0, -30.0))
    assert len(starts(old, new, AROUND)) == 201


def test_an_old_hole_is_used_again_only_where_the_new_one_is_as_large() -> None:
    old = blank(1000.0, hole(450.0, 0.0, 9.0))
    assert 0.0 in starts(old, blank(1000.0, hole(450.2)), AROUND)
    assert 0.0 not in starts(old, blank(1000.0, hole(450.4)), AROUND)
    assert 0.0 not in starts(old, blank(1000.0, hole(450.0, 0.0, 6.5)), AROUND)


def test_an_old_plank_may_be_turned_and_laid_on_its_other_face() -> None:
    """A hole at (300, 18) of 1000 stands at (700, -18) when the plank is turned, at (700, 18) when laid over too."""
    old = blank(1000.0, hole(300.0, 18.0))
    assert 0.0 in starts(old, blank(1000.0, hole(700.0, -18.0)), AROUND, turned=True)
    assert 0.0 in starts(old, blank(1000.0, hole(700.0, 18.0)), AROUND, turned=True, face_down=True)
    assert 0.0 in starts(old, blank(1000.0, hole(300.0, -18.0)), AROUND, face_down=True)


def test_the_shell_is_built_again_from_its_own_planks(gridshell: Gridshell, design: Design) -> None:
    """Every old hole meets its new one, so every plank of G and E and of the first beams is its own successor."""
    planks = [plank for plank in gridshell.shells[0].planks if plank.family in ("G", "E")]
    old = [OldPlank(f"old {plank.mark}", plank.blank, "ash", "D50") for plank in planks]
    stock = design.stock.model_copy(update={"accept_old_holes": True})
    reused = reused_planks(planks, old, stock)
    assert sorted(item.mark for item in reused) == sorted(plank.mark for plank in planks)
    assert len({item.old for item in reused}) == len(planks)


def test_two_planks_from_one_old_plank_do_not_meet(gridshell: Gridshell, design: Design) -> None:
    """An old plank of 8 m with a hole at 4 m gives two of 3.9 m, a saw cut clear of each other and of the hole."""
    plank = next(plank for plank in gridshell.shells[0].planks if plank.family == "G")
    short = [
        type(plank)(**{**vars(plank), "mark": f"S1-G-0{i}", "blank": blank(3900.0), "joints": ()}) for i in (1, 2, 3)
    ]
    reused = reused_planks(short, [OldPlank("old", blank(8000.0, hole(4000.0)), "ash", "D50")], design.stock)
    assert [(item.mark, item.start) for item in reused] == [("S1-G-01", 0.0), ("S1-G-02", 4004.5)]


@settings(max_examples=20)
@given(
    old=st.lists(st.integers(500, 3000), min_size=1, max_size=3),
    new=st.lists(st.integers(400, 1500), min_size=1, max_size=4),
)
def test_most_length_comes_from_old_planks(
    old: list[int], new: list[int], gridshell: Gridshell, design: Design
) -> None:
    """Without holes it is a packing problem: every way to hand the new planks out is tried."""
    pattern = gridshell.shells[0].planks[0]
    planks = [
        type(pattern)(**{**vars(pattern), "mark": f"S1-G-{i + 1:02d}", "blank": blank(float(length))})
        for i, length in enumerate(new)
    ]
    offcuts = [OldPlank(f"old {i}", blank(float(length)), "ash", "D50") for i, length in enumerate(old)]
    reused = reused_planks(planks, offcuts, design.stock)
    best = 0
    for code in range((len(old) + 1) ** len(new)):
        heaps: list[list[int]] = [[] for _ in range(len(old) + 1)]
        for length in new:
            code, heap = divmod(code, len(old) + 1)
            heaps[heap].append(length)
        kerf = design.stock.kerf
        if all(sum(h) + kerf * (len(h) - 1) <= room for h, room in zip(heaps[1:], old, strict=True)):
            best = max(best, sum(map(sum, heaps[1:])))
    assert sum(item.length for item in reused) == best
    assert len({item.mark for item in reused}) == len(reused)
