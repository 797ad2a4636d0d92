"""Steel at the ridge (paper section 3.2, Fig. 7k): straps on the geodesics, folded blades between the shells."""

from itertools import pairwise

import numpy as np
import pytest

from aag_cad.design import Design, load_design
from aag_cad.network.model import CurveNetwork
from aag_cad.parts.bolting import axis_distance, bolt_holes, bolts_by_joint
from aag_cad.parts.build import gridshell_from
from aag_cad.parts.marks import parse_mark
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Gridshell, Shell


def test_every_geodesic_has_a_strap_at_its_upper_end_and_the_crown_one_more(shell: Shell) -> None:
    ridges = [joint for joint in shell.joints if joint.kind == "ridge"]
    assert [strap.mark for strap in shell.straps] == [joint.mark for joint in ridges]
    assert len(ridges) == 15
    for joint in ridges:
        assert len(joint.fasteners) in (3, 4)


def test_straps_lie_flat_on_both_planks(shell: Shell) -> None:
    """Half a plank and half a strap apart: 6 + 1.5 mm from the point of the joint along the normal."""
    for joint in (joint for joint in shell.joints if joint.kind == "ridge" and "-G-" in joint.members[0]):
        strap = next(strap for strap in shell.straps if strap.mark == joint.mark)
        gaps = np.linalg.norm(strap.curve.point_spline(np.linspace(0, strap.curve.length, 400)) - joint.point, axis=1)
        assert gaps.min() == pytest.approx(7.5, abs=0.01)


def test_seven_blades_join_each_pair_of_neighbouring_shells(gridshell: Gridshell) -> None:
    pairs = [parse_mark(blade.mark).family for blade in gridshell.blades]
    assert {pair: pairs.count(pair) for pair in pairs} == {"R12": 7, "R23": 7, "R31": 7}


def test_blades_are_folded_in_the_ridge_plane(gridshell: Gridshell) -> None:
    """Ridge planes are vertical through the centre, 120 degrees apart; the blade is its own mirror image in them."""
    for blade in gridshell.blades:
        across = np.array(blade.frame.x)
        assert across[2] == pytest.approx(0.0, abs=1e-12)
        assert np.array(blade.frame.origin) @ across == pytest.approx(0.0, abs=1e-6)
        (x, z), (u, w), (y, v) = blade.plate.line
        assert (u, w) == (0.0, 0.0)
        assert (x, z) == pytest.approx((-y, v))
        assert blade.frame.z[2] > 0.9


def test_each_blade_has_two_bolts_in_either_ridge_plank(gridshell: Gridshell) -> None:
    holes = {(p.mark, h.joint) for shell in gridshell.shells for p in shell.planks for h in p.blank.holes}
    for joint in gridshell.joints:
        left, right, blade = joint.members
        assert blade == joint.mark
        assert len(joint.fasteners) == 4
        assert {(left, joint.mark), (right, joint.mark)} <= holes
        first, second = list(parse_mark(joint.mark).family[1:])
        assert (left, right) == (f"S{first}-E-02", f"S{second}-E-03")


def test_every_bolt_passes_the_holes_of_plank_and_steel_on_its_axis(gridshell: Gridshell) -> None:
    """0.1 mm is what a drill template can do; each bolt passes exactly two parts."""
    bolts = bolts_by_joint(gridshell)
    seen: dict[str, set[str]] = {}
    for part, joint, _station, centre in bolt_holes(gridshell):
        gap, mark = min((axis_distance(axis, centre), name) for name, axis in bolts[joint].items())
        assert gap < 0.1
        seen.setdefault(mark, set()).add(part)
    every = {bolt.mark for shell in gridshell.shells for bolt in shell.bolts} | {b.mark for b in gridshell.bolts}
    assert set(seen) == every
    assert {len(parts) for parts in seen.values()} == {2}


def test_the_ridges_are_copies_of_each_other_turned_by_120_degrees(gridshell: Gridshell) -> None:
    turned = frame_matrix(gridshell.shells[1].placement)[:3, :3]
    first = [blade for blade in gridshell.blades if blade.mark.startswith("R12")]
    second = [blade for blade in gridshell.blades if blade.mark.startswith("R23")]
    for a, b in zip(first, second, strict=True):
        assert turned @ np.array(a.frame.origin) == pytest.approx(np.array(b.frame.origin), abs=1e-9)


def test_blades_at_equal_spacing_are_nearly_equally_spaced(design: Design, network: CurveNetwork) -> None:
    """Each may move by half the spacing to clear a beam."""
    equal = design.model_copy(
        update={"ridge": design.ridge.model_copy(update={"blades": "equal", "blade_spacing": 800})}
    )
    blades = [blade for blade in gridshell_from(equal, network).blades if blade.mark.startswith("R12")]
    gaps = [np.linalg.norm(np.subtract(a.frame.origin, b.frame.origin)) for a, b in pairwise(blades)]
    assert len(blades) >= 4
    assert min(gaps) > 150.0
    assert max(gaps) < 1700.0


def test_a_single_shell_and_shells_that_stand_apart_have_no_blades() -> None:
    from aag_cad.pipeline import gridshell_of

    assert gridshell_of(load_design("triple-arch")).blades == ()
