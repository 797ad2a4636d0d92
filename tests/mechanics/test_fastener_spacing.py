"""Minimum distances of EN 1995-1-1 by their tables, and the clauses that drilled planks, blocks and studs miss."""

import math
from collections.abc import Callable, Iterator
from dataclasses import astuple, replace

import numpy as np
import pytest

from aag_cad.audit import bolt_findings
from aag_cad.design import Design, parse_design
from aag_cad.errors import DesignError
from aag_cad.findings import Finding
from aag_cad.mechanics.checks.fastener_spacing import (
    FastenerDistances,
    bolt_distances,
    screw_distances,
    shortfalls,
)
from aag_cad.network.model import CurveNetwork
from aag_cad.parts.build import gridshell_from
from aag_cad.parts.forms import Hole
from aag_cad.parts.model import Gridshell
from aag_cad.resources import template

MARK = "S1-A1-06-L"


def test_table_8_4_for_m8_bolts_along_and_across_the_grain() -> None:
    """EN 1995-1-1, table 8.4, d = 8 mm: (4 + |cos a|) d, 4 d, max(7 d, 80), (1 + 6 sin a) d >= 4 d, ..., 3 d."""
    along, across = bolt_distances(8.0, 0.0), bolt_distances(8.0, math.pi / 2.0)
    assert (along.a1, along.a2, along.a3_t, along.a3_c, along.a4_t, along.a4_c) == (40.0, 32.0, 80.0, 32.0, 24.0, 24.0)
    found = (across.a1, across.a2, across.a3_t, across.a3_c, across.a4_t, across.a4_c)
    assert found == pytest.approx((32.0, 32.0, 80.0, 56.0, 32.0, 24.0))
    assert bolt_distances(16.0, 0.0).a3_t == 112.0
    assert bolt_distances(8.0, math.radians(30.0)).a3_c == pytest.approx(32.0)


def test_table_8_2_for_screws_in_pre_drilled_holes() -> None:
    """EN 1995-1-1, table 8.2, last column: the factor at the loaded edge is 2 below 5 mm and 4 from there on."""
    along, across = screw_distances(6.0, 0.0), screw_distances(6.0, math.pi / 2.0)
    assert (along.a1, along.a2, along.a3_t, along.a3_c, along.a4_t, along.a4_c) == (30.0, 18.0, 72.0, 42.0, 18.0, 18.0)
    found = (across.a1, across.a2, across.a3_t, across.a3_c, across.a4_t, across.a4_c)
    assert found == pytest.approx((24.0, 24.0, 42.0, 42.0, 42.0, 18.0))
    assert screw_distances(4.0, math.pi / 2.0).a4_t == pytest.approx(20.0)
    assert screw_distances(5.0, math.pi / 2.0).a4_t == pytest.approx(35.0)


def test_screws_over_6_mm_count_as_bolts() -> None:
    """EN 1995-1-1, 8.7.1(4)."""
    assert screw_distances(8.0, 0.3) == bolt_distances(8.0, 0.3)


@pytest.mark.parametrize("distances", [lambda a: bolt_distances(8.0, a), lambda a: screw_distances(6.0, a)])
def test_distances_do_not_depend_on_the_sense_of_force_or_grain(
    distances: Callable[[float], FastenerDistances],
) -> None:
    for angle in np.linspace(0.1, 1.5, 5):
        assert distances(angle) == distances(-angle)
        assert astuple(distances(angle)) == pytest.approx(astuple(distances(math.pi - angle)))


def _with_holes(gridshell: Gridshell, change: Callable[[list[Hole]], list[Hole]]) -> Gridshell:
    first = gridshell.shells[0]
    planks = tuple(
        replace(p, blank=replace(p.blank, holes=tuple(change(list(p.blank.holes))))) if p.mark == MARK else p
        for p in first.planks
    )
    return replace(gridshell, shells=(replace(first, planks=planks), *gridshell.shells[1:]))


def _of(gridshell: Gridshell, code: str, mark: str = "") -> Iterator[Finding]:
    return (item for item in shortfalls(gridshell) if item.code == code and item.mark.startswith(mark))


def test_the_default_pattern_of_12_by_100_beams_keeps_every_spacing_and_edge(gridshell: Gridshell) -> None:
    """Bolts 36 mm apart (a2 = 32) and 32 mm from the edges (a4,t = 32): only the loaded ends at the ridge are short."""
    beams = [item for item in shortfalls(gridshell) if item.mark[3:5] in ("A1", "A2")]
    assert {(item.code, item.severity) for item in beams} == {("AAG201", "warning")}


def test_a_slot_counts_from_its_end(gridshell: Gridshell) -> None:
    def slotted(holes: list[Hole]) -> list[Hole]:
        return [replace(holes[0], station=81.0, slot=4.0), *holes[1:]]

    (found,) = _of(_with_holes(gridshell, slotted), "AAG201", MARK)
    assert (found.severity, found.allowed) == ("warning", 80.0)
    assert found.found == pytest.approx(79.0)
    assert not list(_of(_with_holes(gridshell, lambda h: [replace(h[0], station=81.0), *h[1:]]), "AAG201", MARK))


def test_two_holes_that_are_near_along_and_across_the_grain_are_found_once(gridshell: Gridshell) -> None:
    """5 d = 40 mm along or 4 d = 32 mm across is enough; under 4 d both ways is an error."""

    def moved(station: float, offset: float) -> Callable[[list[Hole]], list[Hole]]:
        return lambda holes: [replace(holes[0], station=200.0, offset=0.0), replace(holes[1], station=200.0 + station,
                              offset=offset), *holes[2:]]  # fmt: skip

    for far in ((41.0, 0.0), (0.0, 32.0)):
        assert not list(_of(_with_holes(gridshell, moved(*far)), "AAG203", MARK))
    (near,) = _of(_with_holes(gridshell, moved(36.0, 0.0)), "AAG203", MARK)
    assert (near.found, near.allowed) == pytest.approx((36.0, 40.0))
    assert near.severity == "warning"
    assert "a block from each other along the grain, loaded (EN 1995-1-1, table 8.4, a1)" in near.what
    (worse,) = _of(_with_holes(gridshell, moved(10.0, 28.0)), "AAG203", MARK)
    assert (worse.found, worse.allowed) == pytest.approx((28.0, 32.0))
    assert worse.severity == "error"
    assert "table 8.4, a2" in worse.what


def test_a_hole_wider_than_the_bolt_and_1_mm_is_an_error(gridshell: Gridshell) -> None:
    wide = _with_holes(gridshell, lambda holes: [replace(holes[0], diameter=10.0), *holes[1:]])
    found = [item for item in _of(wide, "AAG204", MARK) if item.severity == "error"]
    assert [(item.found, item.allowed) for item in found] == [(10.0, 9.0)]
    assert "10.4.3" in found[0].what
    assert not [item for item in _of(gridshell, "AAG204") if item.severity == "error"]


def test_what_a_24_mm_gap_cannot_give_is_said_with_clause_and_figure(gridshell: Gridshell) -> None:
    """Screws in the 24 mm face of a block: 12 mm where 3 d = 18; bolts in the flats of studs: 6.9 where 3 d = 24."""
    named = {(item.code, item.what.split("(")[-1]): item for item in shortfalls(gridshell)}
    face = named["AAG205", "EN 1995-1-1, table 8.2, a4,c)"]
    assert (face.found, face.allowed) == pytest.approx((12.0, 18.0), abs=0.06)
    assert face.severity == "warning"
    assert "612 blocks" in face.what
    flat = named["AAG206", "EN 1995-1-1, table 8.4, a4,c)"]
    assert (flat.found, flat.allowed) == pytest.approx((24.0 / 2.0 / math.sqrt(3.0), 24.0))
    block = next(item for item in _of(gridshell, "AAG205") if "M8 bolt" in item.what)
    assert (block.found, block.allowed) == pytest.approx((60.0, 80.0))
    assert block.severity == "warning"
    assert "a3,t" in block.what


def test_screws_of_4_mm_keep_their_distance_in_a_24_mm_block(gridshell: Gridshell) -> None:
    shells = tuple(
        replace(shell, screws=tuple(replace(screw, diameter=4.0, length=40.0) for screw in shell.screws))
        for shell in gridshell.shells
    )
    what = [
        item.what for item in _of(replace(gridshell, shells=shells), "AAG205") if "4 mm screw in a 24 mm" in item.what
    ]
    distances = [text for text in what if "a4," in text or "a3," in text]
    assert distances
    assert all("a4,t" in text for text in distances)


def test_washers_thinner_than_three_tenths_of_the_bolt_are_named_once(gridshell: Gridshell) -> None:
    thin = tuple(
        replace(shell, bolts=tuple(replace(bolt, washer_thickness=2.0) for bolt in shell.bolts))
        for shell in gridshell.shells
    )
    (found,) = _of(replace(gridshell, shells=thin, bolts=()), "AAG207")
    assert (found.found, found.allowed) == pytest.approx((2.0, 2.4))
    thick = tuple(
        replace(shell, bolts=tuple(replace(bolt, washer_thickness=3.0) for bolt in shell.bolts))
        for shell in gridshell.shells
    )
    assert not list(_of(replace(gridshell, shells=thick, bolts=()), "AAG207"))


def _changed(design: Design, **joints: object) -> Design:
    return design.model_copy(update={"joints": design.joints.model_copy(update=joints)})


def test_slots_are_cut_for_the_bolts_of_studs_only_and_stay_on_their_axes(
    design: Design, network: CurveNetwork, gridshell: Gridshell
) -> None:
    slotted = gridshell_from(_changed(design, stud_hole="slot", slot_length=3.0), network)
    for plank, round_plank in zip(slotted.shells[0].planks, gridshell.shells[0].planks, strict=True):
        for hole, plain in zip(plank.blank.holes, round_plank.blank.holes, strict=True):
            assert hole.slot == (3.0 if "-N-" in hole.joint else 0.0)
            assert replace(hole, slot=0.0) == plain
    assert not [f for f in bolt_findings(design, replace(slotted, shells=slotted.shells[:1])) if "-N-" in f.what]
    note = next(item for item in _of(slotted, "AAG204") if "slot" in item.what)
    assert (note.severity, note.found, note.allowed) == ("note", 12.0, 9.0)


@pytest.mark.parametrize(("length", "words"), [("0.0", "makes no slot"), ("15.5", "washer of 3 d .* at most 15")])
def test_a_slot_without_length_or_longer_than_its_washer_is_refused(length: str, words: str) -> None:
    text = template("designs", "vault.toml").read_text(encoding="utf-8")
    slotted = text.replace('stud_hole = "round"', 'stud_hole = "slot"')
    assert parse_design(slotted).joints.stud_slot == 3.0
    assert parse_design(text).joints.stud_slot == 0.0
    with pytest.raises(DesignError, match=f"joints.slot_length: .*{words}"):
        parse_design(slotted.replace("slot_length = 3.0", f"slot_length = {length}"))
