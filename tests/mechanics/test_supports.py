"""The check of the concrete blocks by hand: a case worked out on paper, and the vault."""

from dataclasses import replace

import pytest

from aag_cad.audit import support_findings
from aag_cad.design import Design
from aag_cad.mechanics.checks.supports import footing_checks, plan_area
from aag_cad.parts.model import Footing, Gridshell, Shell, shell_parts
from aag_cad.parts.quantities import mass


def _with_supports(design: Design, **changes: float) -> Design:
    return design.model_copy(update={"supports": design.supports.model_copy(update=changes)})


def test_the_plan_area_between_the_joints_is_that_of_the_vault_less_the_strips_at_the_ridges(shell: Shell) -> None:
    """60.27 m2 in plan for three shells (REFERENCE VAULT); 90 to 107 mm by 4.43 m on both sides of each stay free."""
    assert plan_area(shell, closed=False) * 3e-6 == pytest.approx(60.27 - 6 * 0.097 * 4.43, rel=0.005)


def test_suction_without_own_weight_lifts_a_block_when_it_exceeds_nine_tenths_of_it(
    design: Design, gridshell: Gridshell
) -> None:
    check = next(footing_checks(design, gridshell))
    own = sum(mass(p, gridshell.timber) for p in shell_parts(gridshell.shells[0]) if not isinstance(p, Footing))
    block = 0.4 * 0.38 * 0.3 * 2400.0
    assert check.block == pytest.approx(block * 9.81e-3)
    assert check.uplift == pytest.approx(1.5 * 0.5 * check.plan_area_m2 / 14)
    assert check.uplift_utilisation == pytest.approx(check.uplift / (0.9 * (own / 14 + block) * 9.81e-3))


def test_the_thrust_of_a_parabolic_arch_is_its_load_times_span_over_four_rises(
    design: Design, gridshell: Gridshell
) -> None:
    check = next(footing_checks(design, gridshell))
    assert check.thrust == pytest.approx(check.vertical * check.span_mm / (4.0 * check.rise_mm))


def test_the_blocks_of_the_vault_hold_and_the_needed_mass_is_what_just_holds(
    design: Design, gridshell: Gridshell
) -> None:
    assert list(support_findings(design, gridshell)) == []
    check = next(footing_checks(design, gridshell))
    length, width, height = design.supports.block_size
    scale = check.needed_mass / (check.block / 9.81e-3)
    just = _with_supports(design, block_size=(length, width, height * scale))
    footings = [
        tuple(replace(footing, height=height * scale) for footing in shell.footings) for shell in gridshell.shells
    ]
    shells = tuple(replace(shell, footings=heavier) for shell, heavier in zip(gridshell.shells, footings, strict=True))
    held = next(footing_checks(just, replace(gridshell, shells=shells)))
    assert max(held.uplift_utilisation, held.sliding_utilisation) == pytest.approx(1.0, abs=1e-9)


def test_a_storm_is_found_with_the_block_that_it_takes(design: Design, gridshell: Gridshell) -> None:
    found = list(support_findings(_with_supports(design, wind_suction=1.0), gridshell))
    assert {finding.code for finding in found} == {"AAG801"}
    assert len(found) == 3
    assert "take blocks of" in found[0].text


def test_ice_under_the_blocks_is_found(design: Design, gridshell: Gridshell) -> None:
    found = list(support_findings(_with_supports(design, friction=0.2), gridshell))
    assert {finding.code for finding in found} == {"AAG802"}
