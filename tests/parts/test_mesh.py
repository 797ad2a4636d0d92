"""Triangle meshes of the parts: closed, turned outwards, and of the right volume; read by an independent library."""

import math

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from aag_cad.parts.forms import Frame
from aag_cad.parts.mesh import frame_matrix, placed, product_mesh, shell_mesh
from aag_cad.parts.model import Part, Shell, shell_parts
from aag_cad.parts.products import part_frame, product_key
from aag_cad.parts.shapes.bar import plank_mesh
from aag_cad.parts.triangles import Mesh, joined, prism, regular_polygon, round_polygon


def products(shell: Shell) -> list[Part]:
    """Return one part of each product of a shell."""
    return list({product_key(part): part for part in shell_parts(shell)}.values())


def as_trimesh(mesh: Mesh) -> trimesh.Trimesh:
    return trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)


def rotated_frame(angle: float, tilt: float, origin: tuple[float, float, float]) -> Frame:
    cos, sin, c, s = math.cos(angle), math.sin(angle), math.cos(tilt), math.sin(tilt)
    return Frame(origin, (cos, sin, 0.0), (-sin * c, cos * c, s), (sin * s, -cos * s, c))


def test_every_product_of_the_vault_is_closed_and_turned_outwards(shell: Shell) -> None:
    for part in products(shell):
        for body in as_trimesh(product_mesh(part)).split(only_watertight=False):
            assert body.is_watertight, part.mark
            assert body.is_winding_consistent, part.mark
            assert body.volume > 0.0, part.mark


def test_the_volume_agrees_with_an_independent_reader(shell: Shell) -> None:
    for part in products(shell):
        mesh = product_mesh(part)
        assert mesh.volume == pytest.approx(as_trimesh(mesh).volume, rel=1e-9)


def test_a_formed_plank_keeps_the_volume_of_its_blank(shell: Shell) -> None:
    """The centre line runs through the middle of the section: section x length, less 0.5 per mille for the chords."""
    for plank in shell.planks:
        section = plank.blank.section
        expected = section.width * section.thickness * plank.blank.length
        assert plank_mesh(plank).volume == pytest.approx(expected, rel=5e-4)


def test_the_volume_of_a_bent_plank_is_met_to_second_order_in_the_spacing(shell: Shell) -> None:
    """Half the spacing, a quarter of what is missing: the tightest plank of the vault is a geodesic."""
    plank = next(plank for plank in shell.planks if plank.family == "G")
    exact = 1200.0 * plank.blank.length
    errors = [exact - plank_mesh(plank, spacing).volume for spacing in (200.0, 100.0)]
    assert errors[0] > 0.0
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.3)


@given(across=st.floats(1.0, 100.0), low=st.floats(-100.0, 0.0), height=st.floats(1.0, 300.0), sides=st.integers(3, 24))
def test_a_prism_has_the_volume_of_its_section_times_its_height(
    across: float, low: float, height: float, sides: int
) -> None:
    """A regular polygon of m sides and across-flats w has the area m w^2 tan(pi / m) / 4."""
    mesh = prism(regular_polygon(sides, across), low, low + height)
    expected = sides * across**2 * math.tan(math.pi / sides) / 4.0 * height
    assert mesh.volume == pytest.approx(expected, rel=1e-9)
    assert as_trimesh(mesh).is_watertight


def test_the_hexagon_of_a_stud_is_24_mm_across_flats_with_a_flat_towards_x() -> None:
    corners = regular_polygon(6, 24.0)
    assert corners[:, 0].max() == pytest.approx(12.0, rel=1e-12)
    assert np.sum(np.isclose(corners[:, 0], 12.0)) == 2
    np.testing.assert_allclose(np.linalg.norm(corners, axis=1), 24.0 / math.sqrt(3.0), rtol=1e-12)


@given(diameter=st.floats(1.0, 50.0))
def test_round_sections_keep_the_area_of_their_circle(diameter: float) -> None:
    x, y = round_polygon(diameter).T
    area = 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))
    assert area == pytest.approx(math.pi * diameter**2 / 4.0, rel=1e-12)


@given(angle=st.floats(-3.0, 3.0), tilt=st.floats(-3.0, 3.0), origin=st.tuples(*[st.floats(-1e4, 1e4)] * 3))
def test_placing_a_mesh_keeps_its_shape(angle: float, tilt: float, origin: tuple[float, float, float]) -> None:
    frame = rotated_frame(angle, tilt, origin)
    mesh = prism(regular_polygon(6, 24.0), -110.0, 110.0)
    moved = placed(mesh, frame)
    # far from the origin the divergence theorem subtracts numbers some 1e6 times larger
    assert moved.volume == pytest.approx(mesh.volume, rel=1e-6)
    matrix = frame_matrix(frame)
    np.testing.assert_allclose(matrix[:3, :3] @ matrix[:3, :3].T, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(matrix[:3, 3], origin)


def test_a_part_stands_in_its_shell_where_its_frame_says(shell: Shell) -> None:
    stud = shell.studs[0]
    box = shell_mesh(stud).vertices
    axis = (box - np.array(stud.frame.origin)) @ np.array(stud.frame.z)
    assert (axis.min(), axis.max()) == pytest.approx((-110.0, 110.0), abs=1e-9)
    for part in shell_parts(shell)[:80]:
        if part_frame(part) is None:
            np.testing.assert_array_equal(shell_mesh(part).vertices, product_mesh(part).vertices)


def test_several_meshes_joined_have_the_sum_of_their_volumes() -> None:
    one, other = prism(regular_polygon(6, 24.0), 0.0, 10.0), prism(regular_polygon(4, 8.0), 20.0, 50.0)
    both = joined([one, other])
    assert both.volume == pytest.approx(one.volume + other.volume, rel=1e-12)
    assert len(as_trimesh(both).split()) == 2


def test_the_ends_of_a_plank_mesh_are_square_rectangles_of_its_section(shell: Shell) -> None:
    for plank in shell.planks[::7]:
        vertices = plank_mesh(plank).vertices
        for ring in (vertices[:4], vertices[-4:]):
            sides = np.linalg.norm(ring - np.roll(ring, -1, axis=0), axis=1)
            np.testing.assert_allclose(sides, [100.0, 12.0, 100.0, 12.0], atol=1e-9)
