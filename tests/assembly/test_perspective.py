"""The painter's order: what is hidden is left out, what is near is painted last."""

from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aag_cad.parts.model import Gridshell, Shell
from aag_cad.units import Floats
from assembly.drawing.faces import gridshell_faces, tube_faces
from assembly.drawing.painting import covers_of, painting_order, samples_of, unhidden
from assembly.drawing.part_outlines import plank_rings
from assembly.drawing.perspective import perspective_svg


def square(x: float, y: float, size: float) -> Floats:
    return np.array([(x, y), (x + size, y), (x + size, y + size), (x, y + size)])


def test_a_face_behind_another_is_left_out() -> None:
    flat = np.array([square(0, 0, 100), square(20, 20, 40), square(150, 0, 40)])
    depth = np.array([[1000.0] * 4, [2000.0] * 4, [2000.0] * 4])
    assert unhidden(samples_of(flat, depth)).tolist() == [0, 2]


def test_a_face_that_peeps_out_is_kept() -> None:
    flat = np.array([square(0, 0, 100), square(80, 80, 40)])
    depth = np.array([[1000.0] * 4, [2000.0] * 4])
    assert unhidden(samples_of(flat, depth)).tolist() == [0, 1]


def test_a_face_as_wide_as_the_sheet_has_no_holes_for_what_lies_behind() -> None:
    flat = np.array([square(0, 0, 300), square(101, 57, 3)])
    depth = np.array([[1000.0] * 4, [2000.0] * 4])
    assert unhidden(samples_of(flat, depth)).tolist() == [0]


def test_a_long_face_in_front_is_painted_over_one_whose_middle_is_nearer() -> None:
    # The first face runs from far away to close by and passes in front of the second, though its middle is farther.
    flat = np.array([[(0, 0), (0, 10), (200, 10), (200, 0)], square(180, 0, 10)], dtype=float)
    depth = np.array([[3000.0, 3000.0, 1000.0, 1000.0], [1500.0] * 4])
    covers = covers_of(samples_of(flat, depth), 2)
    assert depth[0].mean() > depth[1].mean()
    assert painting_order(covers, depth.mean(axis=1)) == [1, 0]


@given(st.data())
def test_whatever_covers_another_face_is_painted_later(data: st.DataObject) -> None:
    count = data.draw(st.integers(1, 12))
    pair = st.tuples(st.integers(0, count - 1), st.integers(0, count - 1)).filter(lambda p: p[0] < p[1])
    covers = data.draw(st.lists(pair, max_size=20, unique=True)) if count > 1 else []
    depth = np.array(data.draw(st.lists(st.floats(0, 100), min_size=count, max_size=count)))
    order = painting_order(np.array(covers, dtype=np.int64).reshape(-1, 2), depth)
    assert sorted(order) == list(range(count))
    for lower, upper in covers:
        assert order.index(lower) < order.index(upper)


@given(st.integers(2, 8))
def test_faces_that_cover_each_other_in_a_circle_are_all_painted(count: int) -> None:
    ring = np.array([(i, (i + 1) % count) for i in range(count)])
    order = painting_order(ring, np.arange(count, dtype=float))
    assert sorted(order) == list(range(count))
    assert order[0] == count - 1


def test_the_faces_of_a_plank_close_round_it_and_turn_outwards(shell: Shell) -> None:
    plank = shell.planks[0]
    faces = tube_faces(plank_rings(plank, 110.0))
    a, b, c, d = (faces[:, i] for i in range(4))
    six_volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) + np.einsum("ij,ij->i", a, np.cross(c, d))
    section = plank.blank.section
    # Chords of 110 mm on radii over 1.7 m, and one diagonal of each twisted face: within 2 per cent.
    assert six_volumes.sum() / 6.0 == pytest.approx(section.width * section.thickness * plank.blank.length, rel=0.02)


def test_the_faces_of_three_shells_are_three_times_those_of_one(gridshell: Gridshell) -> None:
    faces = gridshell_faces(gridshell)
    assert len(faces.corners) % len(gridshell.shells) == 0
    assert faces.corners.shape[1:] == (4, 3)
    assert faces.colours.shape == (len(faces.corners), 3)


def test_the_picture_is_well_formed_and_the_same_every_time(gridshell: Gridshell) -> None:
    svg = perspective_svg(gridshell)
    root = ElementTree.fromstring(svg)
    assert len(list(root.iter("{http://www.w3.org/2000/svg}path"))) > 1000
    assert perspective_svg(replace(gridshell)) == svg
