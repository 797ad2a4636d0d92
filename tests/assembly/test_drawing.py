"""The pictures: well-formed, small, every plank in them, and labels that can be read."""

import itertools
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aag_cad.parts.model import Gridshell, Shell
from assembly.control import control_figures, outer_end, sling_points
from assembly.details import beam_strips_svg
from assembly.drawing import Box, label_box, number, placed_labels, places_round
from assembly.outline import shell_outline
from assembly.plan import plan_of
from assembly.scenes import PAGE_WIDTH, Sheets, sheets_of, step_pictures
from assembly.sections import block_section_svg, node_section_svg
from assembly.steps import Plan

SVG = "{http://www.w3.org/2000/svg}"
coordinates = st.floats(-1e6, 1e6)


def overlap(a: Box, b: Box) -> bool:
    return min(a[2], b[2]) - max(a[0], b[0]) > 1e-9 and min(a[3], b[3]) - max(a[1], b[1]) > 1e-9


def words(svg: str) -> list[str]:
    return [element.text or "" for element in ElementTree.fromstring(svg).iter(f"{SVG}text")]


@pytest.fixture(scope="module")
def plan(gridshell: Gridshell) -> Plan:
    return plan_of(gridshell, 4, 25.0)


@pytest.fixture(scope="module")
def sheets(plan: Plan, gridshell: Gridshell) -> Sheets:
    return sheets_of(plan, gridshell)


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


def test_pictures_are_well_formed_and_small(plan: Plan, sheets: Sheets) -> None:
    for step in plan.steps:
        if step.shell in ("S1", ""):
            for svg in step_pictures(sheets, step, ["S1"]):
                ElementTree.fromstring(svg)
                assert len(svg) < 150_000


def test_new_beams_and_planks_are_named_in_their_picture(plan: Plan, sheets: Sheets) -> None:
    for step in plan.steps:
        if step.shell == "S1" and step.phase.startswith("lay"):
            (svg,) = step_pictures(sheets, step)
            assert {unit[3:] for unit in (*step.assemblies, *step.marks)} == set(words(svg))


def test_every_stud_of_a_step_is_numbered_in_its_picture(plan: Plan, sheets: Sheets) -> None:
    for step in plan.steps:
        if step.shell == "S1" and step.phase == "studs":
            (svg,) = step_pictures(sheets, step)
            assert sorted(words(svg)) == sorted(mark[-3:] for mark in step.marks if mark.count("-") == 2)


def test_numbers_in_the_crowded_pictures_hardly_cover_each_other(plan: Plan, sheets: Sheets) -> None:
    for step in plan.steps:
        if step.shell == "S1" and step.phase in ("studs", "fix geodesics"):
            (svg,) = step_pictures(sheets, step)
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
