"""The pictures: well-formed, small, every plank in them, and labels that can be read."""

import itertools
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aag_cad.parts.model import Gridshell, Shell
from assembly.base.shell_axes import shell_view
from assembly.base.steps import Plan
from assembly.drawing.bench import beam_strips_svg
from assembly.drawing.joint_sections import block_section_svg, node_section_svg
from assembly.drawing.outline import ridge_outline, shell_outline, vault_outline
from assembly.drawing.steel_sections import blade_section_svg, foot_section_svg, strap_section_svg
from assembly.drawing.svg import Box, label_box, number, placed_labels, places_round
from assembly.pictures.backgrounds import PAGE_WIDTH, Backgrounds, backgrounds_of
from assembly.pictures.scenes import step_pictures
from assembly.plan.assembly_plan import plan_of
from assembly.plan.shape_control import control_figures, outer_end, sling_points

SVG = "{http://www.w3.org/2000/svg}"
BOLT_FILL = 'fill="#222"'
coordinates = st.floats(-1e6, 1e6)


def overlap(a: Box, b: Box) -> bool:
    return min(a[2], b[2]) - max(a[0], b[0]) > 1e-9 and min(a[3], b[3]) - max(a[1], b[1]) > 1e-9


def words(svg: str) -> list[str]:
    return [element.text or "" for element in ElementTree.fromstring(svg).iter(f"{SVG}text")]


@pytest.fixture(scope="module")
def plan(gridshell: Gridshell) -> Plan:
    return plan_of(gridshell, 4, 25.0)


@pytest.fixture(scope="module")
def backgrounds(plan: Plan, gridshell: Gridshell) -> Backgrounds:
    return backgrounds_of(plan, gridshell)


@given(coordinates)
def test_coordinates_are_written_to_a_tenth_without_trailing_zeros(value: float) -> None:
    text = number(value)
    # A tenth of a sheet unit is a hundredth of a millimetre on paper.
    assert float(text) == pytest.approx(value, abs=0.0501)
    assert not text.endswith(".0")
    assert text != "-0"


@given(st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), max_size=20, unique=True))
def test_labels_of_joints_that_lie_apart_do_not_cover_each_other(cells: list[tuple[int, int]]) -> None:
    wanted = [(f"{i:03d}", places_round(np.array(cell) * 160.0 + 100.0, 28.0)) for i, cell in enumerate(cells)]
    boxes = [label_box(label) for label in placed_labels(wanted, 23.0, (0.0, 0.0, 1700.0, 1700.0))]
    assert not [pair for pair in itertools.combinations(boxes, 2) if overlap(*pair)]


def test_every_plank_of_a_shell_has_an_outline_on_the_sheet(shell: Shell) -> None:
    outline = shell_outline(shell, 1800.0, 50.0)
    assert sorted(outline.planks) == sorted(plank.mark for plank in shell.planks)
    points = np.concatenate(list(outline.planks.values()))
    assert points.min() >= 50.0 - 1e-9
    assert points[:, 0].max() <= 1750.0 + 1e-9
    assert points[:, 1].max() <= outline.height - 50.0 + 1e-9


def test_a_geodesic_is_drawn_in_its_true_width_where_it_is_seen_square_on(shell: Shell) -> None:
    outline = shell_outline(shell, 1800.0, 0.0)
    widths = []
    for plank in (plank for plank in shell.planks if plank.family == "G"):
        polygon = outline.planks[plank.mark]
        half = len(polygon) // 2
        widths.append(np.linalg.norm(polygon[:half] - polygon[half:][::-1], axis=1) / outline.scale)
    widest = float(max(width.max() for width in widths))
    # The diagonal of 100 x 12 is the most that can be seen, the width itself is seen where the surface faces the eye.
    assert 99.0 <= widest <= np.hypot(100.0, 12.0)


def test_pictures_are_well_formed_and_small(plan: Plan, backgrounds: Backgrounds) -> None:
    for step in plan.steps:
        if step.shell in ("S1", ""):
            for svg in step_pictures(backgrounds, step):
                ElementTree.fromstring(svg)
                assert len(svg) < 150_000


def test_new_beams_and_planks_are_named_in_their_picture(plan: Plan, backgrounds: Backgrounds) -> None:
    for step in plan.steps:
        if step.shell == "S1" and step.phase.startswith("lay"):
            (svg,) = step_pictures(backgrounds, step)
            assert {unit[3:] for unit in (*step.assemblies, *step.marks)} == set(words(svg))


def test_every_stud_of_a_step_is_numbered_in_its_picture(plan: Plan, backgrounds: Backgrounds) -> None:
    for step in plan.steps:
        if step.shell == "S1" and step.phase == "studs":
            (svg,) = step_pictures(backgrounds, step)
            assert sorted(words(svg)) == sorted(mark[-3:] for mark in step.marks if mark.count("-") == 2)


def test_numbers_in_the_crowded_pictures_hardly_cover_each_other(plan: Plan, backgrounds: Backgrounds) -> None:
    for step in plan.steps:
        if step.shell == "S1" and step.phase in ("studs", "fix geodesics"):
            (svg,) = step_pictures(backgrounds, step)
            plates = [
                tuple(float(rect.attrib[key]) for key in ("x", "y", "width", "height"))
                for rect in ElementTree.fromstring(svg).iter(f"{SVG}rect")
            ]
            boxes: list[Box] = [(x, y, x + w, y + h) for x, y, w, h in plates]
            covered = [pair for pair in itertools.combinations(boxes, 2) if overlap(*pair)]
            # A few labels in a hundred may touch where a name and a number want the same place.
            assert len(covered) <= 0.05 * len(boxes)


def test_a_beam_strip_names_all_its_blocks_and_studs(shell: Shell) -> None:
    beam = shell.beams[4]
    found = words(beam_strips_svg(shell, [beam.mark], PAGE_WIDTH))
    assert {place.joint[-3:] for place in beam.joints if place.joint[3] in "KN"} <= set(found)
    assert beam.mark[3:] in found


def test_sections_name_what_they_cut(shell: Shell) -> None:
    assert {"A1 lower beam", "A2 upper beam"} <= set(words(node_section_svg(shell)))
    assert {"K coupling block", "A1 lower beam"} <= set(words(block_section_svg(shell)))


def test_the_pieces_of_a_sheet_are_those_asked_for(gridshell: Gridshell, shell: Shell) -> None:
    """Those of the places asked for that are large enough to be seen; joints are drawn as dots."""
    sheet = shell_outline(shell, 1800.0, 50.0, ("shell", "cover"))
    pieces = (*shell.straps, *shell.mullions, *shell.strips, *shell.clamps)
    assert list(sheet.pieces) == [piece.mark for piece in pieces]
    assert shell_outline(shell, 1800.0, 50.0).pieces == {}
    plan = vault_outline(gridshell, 1800.0, 50.0, ("ground", "ridge"))
    grounded = sum(len(shell.footings) + len(shell.rods) + len(shell.shoes) for shell in gridshell.shells)
    assert len(plan.pieces) == grounded + len(gridshell.blades)


def test_a_concrete_block_in_plan_is_as_large_as_it_is(gridshell: Gridshell) -> None:
    """400 x 380 mm at the scale of the sheet, by the shoelace formula; it lies about the middle of its rod."""
    plan = vault_outline(gridshell, 1800.0, 50.0, ("ground",))
    for footing in (footing for shell in gridshell.shells for footing in shell.footings):
        x, y = plan.pieces[footing.mark].T
        area = 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))
        assert area == pytest.approx(400.0 * 380.0 * plan.scale**2, rel=1e-9)
        middle = plan.pieces[f"{footing.mark}-T1"].mean(axis=0)
        np.testing.assert_allclose(plan.pieces[footing.mark].mean(axis=0), middle, atol=5.0 * plan.scale)


def test_strips_lie_between_their_mullions_on_the_sheet(shell: Shell) -> None:
    sheet = shell_outline(shell, 1800.0, 50.0, ("cover",))
    for strip in shell.strips:
        number = int(strip.mark[-2:])
        middles = [sheet.lines[f"S1-M-{i:02d}"].mean(axis=0) for i in (number, number + 1)]
        place = sheet.lines[strip.mark].mean(axis=0)
        assert min(m[0] for m in middles) < place[0] < max(m[0] for m in middles)


def test_a_ridge_is_drawn_from_the_crown_with_all_its_blades(gridshell: Gridshell) -> None:
    """The last blade is at the crown, at the left; both ridge planks lie on the sheet, mirrored in its middle."""
    sheet = ridge_outline(gridshell, ("S1-E-02", "S2-E-03"), 1800.0, 50.0)
    blades = [blade.mark for blade in gridshell.blades if blade.mark.startswith("R12")]
    across = [float(sheet.pieces[mark].mean(axis=0)[0]) for mark in blades]
    assert across == sorted(across, reverse=True)
    for mark in ("S1-E-02", "S2-E-03"):
        assert np.all(sheet.planks[mark] >= 50.0 - 1e-6)
        assert np.all(sheet.planks[mark] <= np.array([sheet.width, sheet.height]) - 50.0 + 1e-6)
    one, other = (sheet.lines[mark][:, 1].mean() for mark in ("S1-E-02", "S2-E-03"))
    assert one + other == pytest.approx(sheet.height, abs=0.5)


def test_sections_through_the_steel_show_every_bolt_of_the_joint(gridshell: Gridshell, shell: Shell) -> None:
    """Head, two washers, shank, nut and tip: six pieces a bolt; a rod has seven."""
    straps = {joint.mark: len(joint.fasteners) for joint in shell.joints if joint.kind == "ridge"}
    for strap in shell.straps[:3]:
        assert strap_section_svg(shell, strap).count(BOLT_FILL) == 6 * straps[strap.mark]
    assert blade_section_svg(gridshell, gridshell.blades[0]).count(BOLT_FILL) == 6 * 4
    assert foot_section_svg(shell, shell.shoes[0], named=True).count(BOLT_FILL) == 6 * 4 + 7


def test_the_upright_of_a_shoe_changes_sides_from_foot_to_foot_in_its_section(shell: Shell) -> None:
    first, second = (foot_section_svg(shell, shoe, named=False) for shoe in shell.shoes[:2])
    assert first != second
    assert all(ElementTree.fromstring(picture).tag.endswith("svg") for picture in (first, second))


def test_control_heights_are_counted_from_the_foot_line_and_not_from_the_ground(shell: Shell) -> None:
    control, studs = control_figures(shell), {stud.mark: stud for stud in shell.studs}
    foot = min(joint.point[2] for joint in shell.joints if joint.kind == "foot")
    for name, mark in control.studs.items():
        assert control.heights[name] == pytest.approx(outer_end(studs[mark])[2] - foot, abs=1e-9)


def test_the_view_of_a_shell_does_not_turn_with_its_feet_and_cover(shell: Shell) -> None:
    bare = replace(shell, joints=tuple(joint for joint in shell.joints if joint.kind not in ("footing", "cover")))
    np.testing.assert_array_equal(shell_view(shell).axes, shell_view(bare).axes)


def test_control_figures_are_distances_between_outer_ends_of_studs(shell: Shell) -> None:
    control, studs = control_figures(shell), {stud.mark: stud for stud in shell.studs}
    assert len(control.studs) == len(set(control.studs.values())) == 5
    for (a, b), distance in control.distances.items():
        gap = outer_end(studs[control.studs[a]]) - outer_end(studs[control.studs[b]])
        assert distance == pytest.approx(float(np.linalg.norm(gap)), abs=1e-9)
    # The shell is mirror-symmetric, so both diagonals and both heights of a pair agree to rounding.
    assert control.distances["P1", "P4"] == pytest.approx(control.distances["P2", "P3"], abs=1e-3)
    assert control.heights["P1"] == pytest.approx(control.heights["P2"], abs=1e-3)


def test_a_shell_is_slung_at_four_nodes_round_its_middle(shell: Shell) -> None:
    slings = sling_points(shell)
    assert len(set(slings)) == 4
    points = {stud.mark: np.array(stud.frame.origin) for stud in shell.studs}
    held = np.array([points[mark] for mark in slings])
    middle = np.mean(list(points.values()), axis=0)
    # The middle of the four lies within half a metre of the middle of all nodes: the shell hangs level.
    assert np.linalg.norm(held.mean(axis=0) - middle) < 500.0
