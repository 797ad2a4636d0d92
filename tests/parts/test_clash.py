"""Clashes: none in the vault, and each kind of damage found with its depth."""

from dataclasses import replace

import numpy as np
import pytest

from aag_cad.geometry.framed import FramedCurve
from aag_cad.parts.clash import clashes
from aag_cad.parts.forms import Frame
from aag_cad.parts.model import Gridshell, Shell
from aag_cad.units import vector


def _moved(frame: Frame, shift: tuple[float, float, float]) -> Frame:
    return replace(frame, origin=vector(np.array(frame.origin) + shift))


def _alone(gridshell: Gridshell, shell: Shell) -> Gridshell:
    return replace(gridshell, shells=(shell,), blades=(), bolts=(), joints=())


def test_no_two_parts_of_the_vault_reach_a_millimetre_into_each_other(gridshell: Gridshell) -> None:
    assert clashes(gridshell, 1.0) == []


def test_a_flat_shoe_and_a_square_beam_touch_the_twisted_bottom_plank_by_less_than_a_millimetre(
    gridshell: Gridshell, shell: Shell
) -> None:
    """Under 1 mm, more than paint and less than play: of timber and steel, blocks aside, nothing else touches."""
    bare = replace(shell, mullions=(), strips=(), clamps=())
    touching = [{clash.first, clash.second} for clash in clashes(_alone(gridshell, bare), 0.5)]
    pairs = [pair for pair in touching if not any("-K-" in mark or "-V-" in mark for mark in pair)]
    assert pairs
    assert all("S1-E-01" in pair for pair in pairs)


def test_the_twist_over_a_block_presses_its_corners_into_the_planks_by_less_than_a_millimetre(
    gridshell: Gridshell, shell: Shell
) -> None:
    """A flat block of 120 x 100 mm between planks that twist 19.5 deg/m: about 60 * 50 * tau = 1.0 mm at most."""
    found = [clash for clash in clashes(_alone(gridshell, shell), 0.75) if "-K-" in clash.first + clash.second]
    assert found
    assert found[0].depth == pytest.approx(0.84, abs=0.1)


def test_a_geodesic_lifted_out_of_its_layer_is_found_in_every_beam_above_it(gridshell: Gridshell, shell: Shell) -> None:
    lifted = next(plank for plank in shell.planks if plank.mark == "S1-G-07")
    curve = lifted.curve
    raised = replace(lifted, curve=FramedCurve(curve.stations, curve.points + 5.0 * curve.normals, curve.normals))
    planks = tuple(raised if plank is lifted else plank for plank in shell.planks)
    found = clashes(_alone(gridshell, replace(shell, planks=planks)), 1.0)
    beams = {mark for clash in found for mark in (clash.first, clash.second) if mark.startswith("S1-A2")}
    assert len(beams) > 10
    assert found[0].depth == pytest.approx(5.0, abs=0.5)


def test_a_stud_turned_off_the_planks_bites_into_them(gridshell: Gridshell, shell: Shell) -> None:
    """Turned by 30 degrees it shows its corners: 24 / sqrt(3) - 12 = 1.86 mm into each plank."""
    stud = shell.studs[40]
    x, y = np.array(stud.frame.x), np.array(stud.frame.y)
    cos, sin = np.cos(np.pi / 6), np.sin(np.pi / 6)
    turned = replace(stud.frame, x=vector(cos * x + sin * y), y=vector(cos * y - sin * x))
    studs = tuple(replace(stud, frame=turned) if s is stud else s for s in shell.studs)
    found = [
        c for c in clashes(_alone(gridshell, replace(shell, studs=studs)), 1.0) if stud.mark in (c.first, c.second)
    ]
    assert len(found) == 4
    assert all(clash.depth == pytest.approx(1.86, abs=0.2) for clash in found)


def test_shells_pushed_together_clash_across_the_ridge(gridshell: Gridshell) -> None:
    first, second, third = gridshell.shells
    inwards = np.array(second.placement.x) * 200.0
    pushed = replace(second, placement=_moved(second.placement, tuple(inwards)))
    found = clashes(replace(gridshell, shells=(first, pushed, third)), 1.0)
    assert any(c.first.startswith("S1") and c.second.startswith("S2") for c in found)


def test_a_bolt_is_not_held_against_its_own_joint_but_against_others(gridshell: Gridshell, shell: Shell) -> None:
    bolt = next(b for b in shell.bolts if b.mark == "S1-N-040-B1")
    block = min(shell.blocks, key=lambda b: np.linalg.norm(np.subtract(b.frame.origin, bolt.frame.origin)))
    head = np.array(block.frame.origin) - bolt.grip / 2.0 * np.array(bolt.frame.z)
    moved = replace(bolt, frame=replace(bolt.frame, origin=vector(head)))
    bolts = tuple(moved if b is bolt else b for b in shell.bolts)
    found = {frozenset((c.first, c.second)) for c in clashes(_alone(gridshell, replace(shell, bolts=bolts)), 1.0)}
    assert {bolt.mark, block.mark} in found
    planks = next(joint.members for joint in shell.joints if joint.mark == "S1-N-040")
    assert not any({bolt.mark, plank} in found for plank in planks)
