"""Fig. 2 and 3: four designs made of rotational surfaces only, each built all the way to STEP, IFC and assembly plan.

a) flipped: column and roof; b) cropped: half of a symmetric roof; c) cropped and rotated: three arches; d) intersected
and cropped: the vault. Not asserted: the figure's own sizes, which the paper does not print.
"""

import json
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from patches import Patch, border, distance_outside, joined
from shell_patches import shell_patches

from aag_cad.audit import audit
from aag_cad.design import Design, load_design
from aag_cad.findings import Finding
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Gridshell
from aag_cad.pipeline import Build, build, chart_of
from aag_cad.shop.purchases import purchases_of
from aag_cad.units import Floats

NAMES = ("column", "half-roof", "triple-arch", "vault")


@pytest.fixture(scope="module")
def designs() -> dict[str, Design]:
    """The shipped designs after Fig. 2 by name."""
    return {name: load_design(name) for name in NAMES}


@pytest.fixture(scope="module")
def patches(designs: dict[str, Design]) -> dict[str, tuple[Patch, ...]]:
    """The patches that each design is composed of."""
    return {name: shell_patches(design, chart_of(design)) for name, design in designs.items()}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder with a folder for each design but the vault."""
    return tmp_path_factory.mktemp("designs")


@pytest.fixture(scope="module")
def builds(designs: dict[str, Design], folder: Path) -> dict[str, Build]:
    """The designs but the vault, built to STEP, IFC and assembly plan."""
    return {name: build(designs[name], folder / name, only=("step", "ifc", "plan")) for name in NAMES[:3]}


@pytest.fixture(scope="module")
def gridshells(builds: dict[str, Build], gridshell: Gridshell) -> dict[str, Gridshell]:
    """The gridshells by name."""
    return {"vault": gridshell} | {name: made.model.gridshell for name, made in builds.items()}


@pytest.fixture(scope="module")
def findings(
    builds: dict[str, Build], designs: dict[str, Design], gridshell: Gridshell
) -> dict[str, Sequence[Finding]]:
    """What the audit finds in each design, and the checks of the plans of those that are built."""
    found = audit(designs["vault"], gridshell, purchases_of(gridshell, designs["vault"]))
    return {"vault": found} | {name: made.findings for name, made in builds.items()}


def flat_plank_points(gridshell: Gridshell) -> Floats:
    """Return points (n, 3) along the geodesics and boundary planks, in the coordinates of the whole."""
    moved = []
    for shell in gridshell.shells:
        matrix = frame_matrix(shell.placement)
        lines = np.concatenate([plank.curve.points for plank in shell.planks if plank.layer == 0])
        moved.append(lines @ matrix[:3, :3].T + matrix[:3, 3])
    return np.concatenate(moved)


@pytest.mark.parametrize("name", NAMES)
def test_the_flat_planks_lie_on_the_patches(
    patches: dict[str, tuple[Patch, ...]], gridshells: dict[str, Gridshell], name: str
) -> None:
    """The middle layer is the surface itself: within 0.01 mm, the error of curves interpolated every 150 mm."""
    points = flat_plank_points(gridshells[name])
    off = np.min([np.abs(distance_outside(patch, points)) for patch in patches[name]], axis=0)
    assert off.max() < 0.01


@pytest.mark.parametrize(
    ("name", "gap"), [("column", 1e-6), ("half-roof", 1e-6), ("triple-arch", 200.0), ("vault", 1e-6)]
)
def test_the_patches_hang_together(patches: dict[str, tuple[Patch, ...]], name: str, gap: float) -> None:
    """Roof and column at the neck, halves and shells at their ridges; the arches nearly touch, two set-backs apart."""
    assert joined(patches[name], gap) == patches[name]


@pytest.mark.parametrize("name", NAMES)
def test_nothing_in_the_audit_is_an_error(findings: dict[str, Sequence[Finding]], name: str) -> None:
    assert [finding.text for finding in findings[name] if finding.severity == "error"] == []


def test_a_flipped_surface_is_column_and_roof(
    patches: dict[str, tuple[Patch, ...]], gridshells: dict[str, Gridshell]
) -> None:
    """Fig. 2a: the roof opens to 1.8 m cosh(3250 / 1800) = 5.6 m; its flipped copy stands under the neck."""
    roof, column = patches["column"]
    assert np.linalg.det(column.motion) == pytest.approx(-1.0)
    top, foot = border(roof, 61), border(column, 61)
    assert np.hypot(top[:, 0], top[:, 1]).max() == pytest.approx(1800.0 * math.cosh(3250.0 / 1800.0), abs=1e-3)
    assert foot[:, 2].min() == pytest.approx(-1600.0, abs=1e-6)
    assert gridshells["column"].ground < foot[:, 2].min()
    assert len(gridshells["column"].shells) == 1


def test_a_cropped_surface_is_half_of_a_symmetric_roof(gridshells: dict[str, Gridshell]) -> None:
    """Fig. 2b: two halves that never pass the plane x = 0 between them, one the image of the other."""
    gridshell = gridshells["half-roof"]
    points = flat_plank_points(gridshell)
    first, second = np.split(points, 2)
    assert len(gridshell.shells) == 2
    assert first[:, 0].max() < 0.0 < second[:, 0].min()
    np.testing.assert_allclose(np.sort(first[:, 0]), np.sort(-second[:, 0]), atol=1e-6)
    np.testing.assert_allclose(np.sort(first[:, 1]), np.sort(second[:, 1]), atol=1e-3)


def test_a_cropped_surface_rotated_makes_three_arches(patches: dict[str, tuple[Patch, ...]]) -> None:
    """Fig. 2c: three copies 120 degrees apart; between two of them an arch, over the centre an open eye."""
    borders = [border(patch, 61) for patch in patches["triple-arch"]]
    assert len(borders) == 3
    eye = min(float(np.hypot(points[:, 0], points[:, 1]).min()) for points in borders)
    assert eye > 1000.0
    lowest = [points[points[:, 2] < 1e-6] for points in borders]
    opening = min(float(np.linalg.norm(lowest[0][:, None] - other[None], axis=2).min()) for other in lowest[1:])
    assert opening > 1500.0


def test_three_surfaces_intersected_and_cropped_make_the_vault(patches: dict[str, tuple[Patch, ...]]) -> None:
    """Fig. 2d: every border point of a shell under the ridge lies on a neighbour's surface as well."""
    first, *others = patches["vault"]
    points = border(first, 61)
    ridge = points[points[:, 2] > 2430.0]
    off = np.min([np.abs(distance_outside(other, ridge)) for other in others], axis=0)
    assert np.count_nonzero(off < 1e-6) > 50


def test_the_audit_says_where_joints_are_not_equiangular_and_boundaries_not_geodesic(
    findings: dict[str, Sequence[Finding]],
) -> None:
    """Fig. 3: "joints are not equiangular, and not all boundaries are geodesic"; the vault has neither fault."""
    told = {name: {(f.code, f.severity) for f in findings[name] if f.code[:4] == "AAG7"} for name in NAMES}
    assert told == {
        "column": {("AAG701", "note"), ("AAG702", "warning")},
        "half-roof": {("AAG701", "warning")},
        "triple-arch": {("AAG701", "note"), ("AAG702", "warning")},
        "vault": set(),
    }


@pytest.mark.parametrize(("name", "angle"), [("column", 90.0), ("triple-arch", 70.5288)])
def test_a_crpc_surface_of_another_ratio_has_one_angle_but_not_sixty_degrees(
    findings: dict[str, Sequence[Finding]], name: str, angle: float
) -> None:
    """The A lines meet the meridian at arctan sqrt(ratio): 90 degrees between them at ratio 1, 70.53 at 2."""
    finding = next(f for f in findings[name] if f.code == "AAG701")
    assert f"{angle:.1f} to {angle:.1f} degrees" in finding.what
    assert finding.found == pytest.approx(angle - 60.0, abs=0.05)


@pytest.mark.parametrize("name", NAMES[:3])
def test_each_design_is_built_to_step_ifc_and_plan(builds: dict[str, Build], folder: Path, name: str) -> None:
    """Fig. 3: every plank is a product in STEP and a member in IFC, and every part is placed by a step of the plan."""
    gridshell = builds[name].model.gridshell
    step = (folder / name / f"{gridshell.name}.step").read_text()
    ifc = (folder / name / f"{gridshell.name}.ifc").read_text()
    plan = json.loads((folder / name / "plan.json").read_text())
    planks = [plank.mark for shell in gridshell.shells for plank in shell.planks]
    assert [mark for mark in planks if f"'{mark}'" not in step] == []
    assert [mark for mark in planks if f"'{mark}'" not in ifc] == []
    assert len(plan["steps"]) > len(gridshell.shells)
