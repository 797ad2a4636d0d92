"""Purchases: everything in the model is bought, in the sizes of the trade, and the lists add up."""

import csv
import json
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest

from aag_cad.design import Design
from aag_cad.export.office.purchases import (
    CUTTING_HEADER,
    PURCHASES_HEADER,
    write_purchases,
)
from aag_cad.parts.model import (
    Bolt,
    ClampingBar,
    CouplingBlock,
    Gridshell,
    Mullion,
    Plank,
    Rod,
    Screw,
    Strap,
    Strip,
    Stud,
    all_parts,
)
from aag_cad.parts.quantities import mass
from aag_cad.shop.passports import REUSE_HEADER, passports, reuse_row
from aag_cad.shop.purchases import Purchases, purchases_of, stock_summary


@pytest.fixture(scope="module")
def purchases(gridshell: Gridshell, design: Design) -> Purchases:
    return purchases_of(gridshell, design)


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_fasteners_are_counted_and_weighed_as_they_are_placed(purchases: Purchases, gridshell: Gridshell) -> None:
    """Bolt, nut and two washers together weigh what the bolts of the model weigh."""
    fasteners = [part for part in all_parts(gridshell) if isinstance(part, Bolt | Screw | Rod)]
    kinds = Counter(type(part) for part in fasteners)
    bought: Counter[str] = Counter()
    for line in purchases.lines:
        bought[line.item] += line.quantity
    assert bought["hexagon bolt"] == kinds[Bolt]
    assert bought["countersunk wood screw"] == kinds[Screw]
    assert bought["threaded rod"] == kinds[Rod]
    assert bought["hexagon nut"] == kinds[Bolt] + 2 * kinds[Rod]
    assert bought["washer"] == 2 * (kinds[Bolt] + kinds[Rod])
    standards = {"ISO 4014", "ISO 4032", "ISO 7089", "ISO 7093-1", "DIN 7997", "DIN 976-1"}
    weighed = sum(line.mass_kg for line in purchases.lines if line.standard in standards)
    # A rod has a washer at each of its two nuts; the shank is not cut to the grip.
    assert weighed == pytest.approx(sum(mass(part, gridshell.timber) for part in fasteners), rel=1e-6)


def test_every_joint_says_what_its_fasteners_are_for(purchases: Purchases) -> None:
    assert all(line.use for line in purchases.lines)


def test_every_part_that_is_cut_stands_in_the_cutting_list_once(
    purchases: Purchases, gridshell: Gridshell, tmp_path: Path
) -> None:
    write_purchases(purchases, tmp_path)
    listed = rows(tmp_path / "cutting.csv")
    assert tuple(listed[0]) == CUTTING_HEADER
    kinds = Plank | Stud | CouplingBlock | Strap | Mullion | ClampingBar | Strip
    cut = [part.mark for part in all_parts(gridshell) if isinstance(part, kinds)]
    assert Counter(row["mark"] for row in listed) == Counter(cut)
    for row in listed:
        if row["stock_length_mm"] and row["cut_length_mm"]:
            assert float(row["position_mm"]) + float(row["cut_length_mm"]) <= float(row["stock_length_mm"])
            assert float(row["length_mm"]) <= float(row["cut_length_mm"])


def test_boards_weigh_what_their_volume_says_and_hold_the_planks(purchases: Purchases, gridshell: Gridshell) -> None:
    """The paper, section 3: boards of 25 x 100 mm, split in two; the shells' planks are less than what is bought."""
    boards = [line for line in purchases.lines if line.item == "ash D50 board"]
    assert {line.size.rpartition(" x ")[0] for line in boards} == {"25 x 100"}
    kilograms = sum(line.mass_kg for line in boards)
    metres = sum(line.length_m for line in boards)
    assert kilograms == pytest.approx(metres * 0.025 * 0.1 * 700.0)
    planks = sum(mass(plank, gridshell.timber) for shell in gridshell.shells for plank in shell.planks)
    assert planks < kilograms < 1.2 * planks
    assert metres * 1000.0 == purchases.cut[0].plan.bought


def test_the_summary_is_plain_and_everything_cut_is_proven(purchases: Purchases) -> None:
    summary = stock_summary(purchases)
    assert json.loads(json.dumps(summary)) == summary
    cut = {name: value for name, value in summary.items() if isinstance(value, dict) and "proven" in value}
    assert {"ash D50 board 25 x 100", "ash D50 bar 24 x 28", "ash D50 bar 24 x 100"} <= set(cut)
    for value in cut.values():
        assert value["proven"]
        assert value["bound_m"] == value["bought_m"] <= value["first_fit_decreasing_m"]
    assert purchases.refused == ()


def test_the_purchase_list_is_read_back_and_the_same_each_time(
    purchases: Purchases, gridshell: Gridshell, design: Design, tmp_path: Path
) -> None:
    one, two = tmp_path / "one", tmp_path / "two"
    write_purchases(purchases, one)
    write_purchases(purchases_of(gridshell, design), two)
    for name in ("purchases.csv", "cutting.csv"):
        assert (one / name).read_bytes() == (two / name).read_bytes()
    listed = rows(one / "purchases.csv")
    assert tuple(listed[0]) == PURCHASES_HEADER
    assert len(listed) == len(purchases.lines)
    assert all(int(row["quantity"]) > 0 and float(row["mass_kg"]) > 0.0 for row in listed)


def test_boards_that_are_too_short_are_a_finding_for_each_plank(gridshell: Gridshell, design: Design) -> None:
    stock = design.stock.model_copy(update={"lengths": (4000.0, 6000.0)})
    short = purchases_of(gridshell, design.model_copy(update={"stock": stock}))
    findings = list(short.refused)
    long = [p.mark for shell in gridshell.shells for p in shell.planks if p.blank.length > 5980.0]
    assert sorted(finding.mark for finding in findings) == sorted(long)
    assert {finding.severity for finding in findings} == {"error"}
    assert all(finding.mark in finding.text and "finger-joint it at" in finding.text for finding in findings)
    assert not set(long) & {c.mark for b in short.cut[0].plan.boards for cut in b.cuts for c in cut.pieces}


def test_old_planks_are_used_before_boards(gridshell: Gridshell, design: Design, tmp_path: Path) -> None:
    """The geodesics and edge planks of the first shell come from their own predecessors, the rest from boards."""
    first = gridshell.shells[0]
    flat = tuple(plank for plank in first.planks if not plank.upright)
    small = replace(
        gridshell,
        shells=(replace(first, planks=flat, straps=(), studs=(), blocks=(), strips=(), mullions=(), clamps=()),),
    )
    path = tmp_path / "offcuts.csv"
    with path.open("w", encoding="utf-8", newline="") as file:
        kept = [reuse_row(held) for held in passports(small)][1:]
        csv.writer(file).writerows([REUSE_HEADER, *kept, ("spare", "3000", "80", "12", "ash", "D50", "")])
    stock = design.stock.model_copy(update={"offcuts": str(path), "accept_old_holes": True})
    made = purchases_of(small, design.model_copy(update={"stock": stock}))
    assert len(made.reused) == len(flat) - 1
    assert sum(len(cut.pieces) for board in made.cut[0].plan.boards for cut in board.cuts) == 1
    assert [(finding.code, finding.mark, finding.severity) for finding in made.refused] == [("AAG902", "spare", "note")]
    assert [line.quantity for line in made.lines if line.item == "old plank"] == [len(flat) - 1]
