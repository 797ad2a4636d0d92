"""The audit: what it finds in the vault, and that every code can be made to appear."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from aag_cad.audit import (
    audit,
    bolt_findings,
    clash_findings,
    end_findings,
    forming_findings,
    hole_findings,
    joint_findings,
    ridge_findings,
)
from aag_cad.design import Design
from aag_cad.findings import Finding
from aag_cad.parts.forms import Blank
from aag_cad.parts.model import Gridshell, Plank
from aag_cad.shop.purchases import purchases_of


def _with_plank(gridshell: Gridshell, mark: str, change: Callable[[Plank], Plank]) -> Gridshell:
    first = gridshell.shells[0]
    planks = tuple(change(plank) if plank.mark == mark else plank for plank in first.planks)
    return replace(gridshell, shells=(replace(first, planks=planks), *gridshell.shells[1:]))


def _codes(findings: list[Finding], mark: str) -> set[tuple[str, str]]:
    return {(finding.code, finding.severity) for finding in findings if finding.mark == mark}


def test_the_beams_of_the_vault_say_which_bolts_sit_near_the_ridge_ends(design: Design, gridshell: Gridshell) -> None:
    """24 planks of 60 to 68 mm at the end in place of the 80 mm that a loaded end asks: four kinds, named once each."""
    found = [f for f in hole_findings(design, gridshell) if f.mark[3:5] in ("A1", "A2")]
    assert [(f.code, f.severity, f.mark) for f in found] == [
        ("AAG201", "warning", mark) for mark in ("S1-A1-02-L", "S1-A1-02-R", "S1-A1-03-L", "S1-A1-03-R")
    ]
    assert all("loaded (EN 1995-1-1, table 8.4, a3,t)" in f.text and "allowed 80 mm" in f.text for f in found)
    assert sum(int(f.what.split()[2]) for f in found) == 24


def test_the_vault_has_no_error(design: Design, gridshell: Gridshell) -> None:
    found = audit(design, gridshell, purchases_of(gridshell, design))
    assert "error" not in {f.severity for f in found}
    clauses = {f"AAG20{i}" for i in range(1, 8)}
    assert {f.code for f in found} <= clauses | {"AAG402"}, "only fasteners miss a clause"
    (deepest,) = [f for f in found if f.code == "AAG402"]
    assert deepest.severity == "note"
    assert 0.25 < deepest.found < 1.0


def test_bolts_of_steel_miss_a_clause_in_edge_planks_and_in_no_geodesic(design: Design, gridshell: Gridshell) -> None:
    """A geodesic has room for 80 mm of end. A plank of 100 mm has not for 32 mm on either side of two M8 abreast."""
    found = [f for f in hole_findings(design, gridshell) if "shoe" in f.what or "strap" in f.what or "blade" in f.what]
    assert {f.severity for f in found} == {"warning"}
    assert {(f.code, f.mark) for f in found} == {
        ("AAG201", "S1-E-01"),
        ("AAG202", "S1-E-01"),
        ("AAG203", "S1-E-01"),
        ("AAG202", "S1-E-02"),
    }


def test_a_tighter_limit_turns_every_geodesic_into_a_finding(design: Design, gridshell: Gridshell) -> None:
    """The vault bends to 1 702 mm: a plank that must not go under 1 800 mm is refused on all 42 G lines."""
    strict = replace(gridshell, timber=replace(gridshell.timber, min_bending_radius=1800.0))
    found = list(forming_findings(design, strict))
    assert {f.code for f in found} == {"AAG101"}
    assert {f.mark[3] for f in found} == {"G"}
    assert len(found) == 42
    assert all(f.severity == "error" and 1700 < f.found < 1800 and f.allowed == 1800 for f in found)


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ({"bending_strength": 40.0}, "AAG103"),
        ({"shear_strength": 3.0}, "AAG104"),
        ({"modulus": 40_000.0}, "AAG105"),
    ],
)
def test_weaker_or_stiffer_timber_is_found(
    design: Design, gridshell: Gridshell, change: dict[str, Any], code: str
) -> None:
    weaker = replace(gridshell, timber=replace(gridshell.timber, **change))
    assert code in {f.code for f in forming_findings(design, weaker)}


def test_a_lower_twist_limit_is_found(design: Design, gridshell: Gridshell) -> None:
    timber = design.timber.model_copy(update={"max_twist_deg_per_m": 15.0})
    found = list(forming_findings(design.model_copy(update={"timber": timber}), gridshell))
    assert {f.code for f in found} == {"AAG102"}
    assert {f.mark[3:5] for f in found} == {"A1", "A2"}


def test_a_hole_drilled_too_near_to_end_or_edge_is_an_error(design: Design, gridshell: Gridshell) -> None:
    def at(station: float, offset: float) -> Callable[[Plank], Plank]:
        def change(plank: Plank) -> Plank:
            holes = (replace(plank.blank.holes[0], station=station, offset=offset), *plank.blank.holes[1:])
            return replace(plank, blank=replace(plank.blank, holes=holes))

        return change

    mark = "S1-A1-06-L"
    assert not _codes(list(hole_findings(design, gridshell)), mark)
    near_end = list(hole_findings(design, _with_plank(gridshell, mark, at(30.0, 18.0))))
    assert _codes(near_end, mark) == {("AAG201", "error")}
    near_edge = list(hole_findings(design, _with_plank(gridshell, mark, at(100.0, 30.0))))
    assert _codes(near_edge, mark) == {("AAG202", "error")}


def test_an_end_that_dangles_is_found(design: Design, gridshell: Gridshell) -> None:
    mark = "S1-A2-03-R"

    def longer(plank: Plank) -> Plank:
        blank = plank.blank
        return replace(plank, blank=Blank(blank.length + 60.0, blank.section, blank.holes))

    assert not list(end_findings(design, gridshell))
    found = list(end_findings(design, _with_plank(gridshell, mark, longer)))
    assert [(f.code, f.mark) for f in found] == [("AAG301", mark)]
    assert found[0].found == pytest.approx(160.0, abs=1.0)


def test_a_clash_names_both_marks_and_the_depth(design: Design, gridshell: Gridshell) -> None:
    first = gridshell.shells[0]
    stud = first.studs[0]
    lower = tuple(np.array(stud.frame.origin) + 30.0 * np.array(stud.frame.x))
    studs = (replace(stud, frame=replace(stud.frame, origin=lower)), *first.studs[1:])
    moved = replace(gridshell, shells=(replace(first, studs=studs), *gridshell.shells[1:]))
    found = [f for f in clash_findings(design, moved) if stud.mark in f.mark]
    assert found
    assert all(f.code == "AAG401" and " and " in f.mark and f.found > 1.0 for f in found)


def test_a_part_without_joint_and_a_joint_without_its_part_are_found(design: Design, gridshell: Gridshell) -> None:
    assert not list(joint_findings(design, gridshell))
    first = gridshell.shells[0]
    orphan = replace(first.screws[0], mark="S1-K-999-W1")
    swapped = replace(gridshell, shells=(replace(first, screws=(orphan, *first.screws[1:])), *gridshell.shells[1:]))
    found = {(f.code, f.mark) for f in joint_findings(design, swapped) if f.severity == "error"}
    assert found == {("AAG501", "S1-K-999-W1"), ("AAG502", first.screws[0].mark)}


def test_a_ridge_without_blades_and_a_joint_without_fastener_are_found(design: Design, gridshell: Gridshell) -> None:
    assert not list(ridge_findings(design, gridshell))
    kept = [blade for blade in gridshell.blades if not blade.mark.startswith("R23")]
    found = list(ridge_findings(design, replace(gridshell, blades=tuple(kept))))
    assert [(f.code, f.mark) for f in found] == [("AAG504", "R23")]
    first, *others = gridshell.joints
    loose = replace(gridshell, joints=(replace(first, fasteners=()), *others))
    assert ("AAG503", "R12-01") in {(f.code, f.mark) for f in joint_findings(design, loose)}


def test_a_blade_off_its_bolts_is_found(design: Design, gridshell: Gridshell) -> None:
    """A blade shifted by 2 mm along its fold: its four holes are 2 mm off their bolts."""
    blade, *others = gridshell.blades
    along = tuple(np.array(blade.frame.origin) + 2.0 * np.array(blade.frame.y))
    moved = replace(blade, frame=replace(blade.frame, origin=along))
    found = list(bolt_findings(design, replace(gridshell, blades=(moved, *others))))
    assert [(f.code, f.mark) for f in found] == [("AAG601", blade.mark)] * 4
    assert [f.found for f in found] == pytest.approx([2.0] * 4, abs=0.1)


def test_a_hole_off_its_bolt_and_a_missing_hole_are_found(design: Design, gridshell: Gridshell) -> None:
    mark = "S1-A1-05-L"
    assert not list(bolt_findings(design, gridshell))

    def shifted(plank: Plank) -> Plank:
        holes = (replace(plank.blank.holes[2], station=plank.blank.holes[2].station + 0.5), *plank.blank.holes[:2],
                 *plank.blank.holes[3:])  # fmt: skip
        return replace(plank, blank=replace(plank.blank, holes=holes))

    found = list(bolt_findings(design, _with_plank(gridshell, mark, shifted)))
    assert [(f.code, f.mark) for f in found] == [("AAG601", mark)]
    assert found[0].found == pytest.approx(0.5, abs=0.01)

    def undrilled(plank: Plank) -> Plank:
        return replace(plank, blank=replace(plank.blank, holes=plank.blank.holes[1:]))

    missing = list(bolt_findings(design, _with_plank(gridshell, mark, undrilled)))
    assert [f.code for f in missing] == ["AAG602"]


def test_findings_come_errors_first_with_figure_limit_unit_and_remedy(design: Design, gridshell: Gridshell) -> None:
    strict = replace(gridshell, timber=replace(gridshell.timber, min_bending_radius=1800.0))
    found = audit(design, strict, purchases_of(strict, design))
    severities = [f.severity for f in found]
    assert severities == sorted(severities, key=["error", "warning", "note"].index)
    assert found[0].text == (
        "S1-G-01: smallest bending radius 1702 mm, allowed 1800 mm; flatten the surface there or take thinner planks"
    )
