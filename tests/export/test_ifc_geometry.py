"""The bodies in the IFC file, read by two independent geometry kernels, against the figures of the model."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.util.shape
import numpy as np
import pytest
from test_ifc_sample import sampled

from aag_cad.export.ifc.bodies import welded
from aag_cad.export.ifc.model import ifc_model, write_ifc
from aag_cad.export.ifc.options import IfcOptions
from aag_cad.parts.forming import corner_splines, formed_points
from aag_cad.parts.mesh import frame_matrix, shell_mesh
from aag_cad.parts.model import Bolt, Gridshell, Part, Plank, Rod, Screw, Shell, all_parts, shell_parts
from aag_cad.parts.quantities import gross_volume
from aag_cad.parts.triangles import Mesh
from aag_cad.units import MM3_PER_M3, MM_PER_M, Floats

# Circles are read as chords of at most so many radians: 1 - sinc(0.02) = 7e-5 of their area.
CHORD = 0.02


@dataclass(frozen=True)
class Body:
    """What a reader makes of a body: volume, mm3, and the corners of its box in the coordinates of the vault, mm."""

    volume: float
    low: Floats
    high: Floats


def read(path: Path, kernel: str) -> dict[str, Body]:
    """Return the bodies of a file by mark as a kernel sees them."""
    file, settings = ifcopenshell.open(str(path)), ifcopenshell.geom.settings()
    settings.set("mesher-angular-deflection", CHORD)
    iterator = ifcopenshell.geom.iterator(settings, file, 1, geometry_library=kernel)
    found, more = {}, iterator.initialize()
    while more:
        shape = iterator.get()
        matrix = ifcopenshell.util.shape.get_shape_matrix(shape)
        points = ifcopenshell.util.shape.get_vertices(shape.geometry) @ matrix[:3, :3].T + matrix[:3, 3]
        volume = ifcopenshell.util.shape.get_volume(shape.geometry) * MM3_PER_M3
        mark = file.by_id(shape.id).Name
        found[mark] = Body(volume, points.min(axis=0) * MM_PER_M, points.max(axis=0) * MM_PER_M)
        more = iterator.next()
    return found


@pytest.fixture(scope="module")
def sample(gridshell: Gridshell) -> Gridshell:
    return sampled(gridshell, of_a_kind=1)


@pytest.fixture(scope="module")
def seen(sample: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Mapping[str, Body]]:
    path = tmp_path_factory.mktemp("ifc") / "vault.ifc"
    write_ifc(sample, path)
    return {kernel: read(path, kernel) for kernel in ("opencascade", "cgal")}


def placed_meshes(sample: Gridshell) -> Iterator[tuple[Part, Floats]]:
    """Yield every part with the points (n, 3) of its mesh in the coordinates of the vault."""
    placed: list[tuple[Part, Shell | None]] = [(part, s) for s in sample.shells for part in shell_parts(s)]
    placed += [(part, None) for part in (*sample.blades, *sample.bolts)]
    for part, shell in placed:
        matrix = np.eye(4) if shell is None else frame_matrix(shell.placement)
        yield part, shell_mesh(part).vertices @ matrix[:3, :3].T + matrix[:3, 3]


@pytest.mark.parametrize("kernel", ["opencascade", "cgal"])
def test_every_part_has_a_body_of_its_volume(
    sample: Gridshell, seen: Mapping[str, Mapping[str, Body]], kernel: str
) -> None:
    """1e-3: planks are chords every 120 mm. Folded plates are measured in their flat pattern, which the bends keep."""
    parts = {part.mark: part for part in all_parts(sample)}
    assert set(seen[kernel]) == set(parts)
    for mark, body in seen[kernel].items():
        assert body.volume == pytest.approx(gross_volume(parts[mark]), rel=1e-3), mark


@pytest.mark.parametrize("kernel", ["opencascade", "cgal"])
def test_every_body_lies_in_the_box_of_its_part(
    sample: Gridshell, seen: Mapping[str, Mapping[str, Body]], kernel: str
) -> None:
    """1 mm: round parts are polygons in the model's meshes, so these are compared by the axis only."""
    for part, points in placed_meshes(sample):
        if not isinstance(part, Bolt | Screw | Rod):
            body = seen[kernel][part.mark]
            np.testing.assert_allclose(body.low, points.min(axis=0), rtol=0, atol=1.0)
            np.testing.assert_allclose(body.high, points.max(axis=0), rtol=0, atol=1.0)


def test_both_kernels_see_the_same_bodies(seen: Mapping[str, Mapping[str, Body]]) -> None:
    for mark, body in seen["opencascade"].items():
        other = seen["cgal"][mark]
        assert body.volume == pytest.approx(other.volume, rel=1e-3), mark
        np.testing.assert_allclose((body.low, body.high), (other.low, other.high), rtol=0, atol=1.0)


def test_a_mesh_with_an_edge_of_no_length_is_welded_closed() -> None:
    """A wedge drawn as a box whose upper edge has its corners twice: 6 of 8 points and 8 of 12 faces are left."""
    points = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (0, 1, 0), (1, 0, 1), (1, 0, 1), (1, 1, 1), (1, 1, 1)]
    quads = [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    mesh = welded(Mesh(np.array(points, dtype=float), np.array(faces)))
    assert (len(mesh.vertices), len(mesh.faces)) == (6, 8)
    edges = {(int(f[i]), int(f[(i + 1) % 3])) for f in mesh.faces for i in range(3)}
    assert len(edges) == 24
    assert edges == {(b, a) for a, b in edges}


def test_b_spline_bodies_are_the_solids_of_the_planks(gridshell: Gridshell, tmp_path: Path) -> None:
    """By the OCC kernel, meshed to 0.02 mm: section x length holds to 1e-3 for a bent and twisted plank."""
    shell = gridshell.shells[0]
    planks = [next(plank for plank in shell.planks if plank.family == family) for family in ("A1", "G", "E")]
    bare = replace(shell, planks=tuple(replace(p, beam="") for p in planks), beams=(), studs=(), blocks=(), bolts=())
    bare = replace(bare, screws=(), joints=(), straps=(), shoes=(), rods=(), footings=(), mullions=(), strips=())
    one = replace(gridshell, shells=(replace(bare, clamps=()),), blades=(), bolts=(), joints=())
    file = ifc_model(one, options=IfcOptions(geometry="brep")).file
    assert len(file.by_type("IfcAdvancedBrep")) == len(planks)
    settings = ifcopenshell.geom.settings()
    settings.set("mesher-linear-deflection", 2e-5)
    for kind, plank in zip(file.by_type("IfcMemberType"), planks, strict=True):
        shape = ifcopenshell.geom.create_shape(settings, kind.RepresentationMaps[0].MappedRepresentation)
        volume = ifcopenshell.util.shape.get_volume(shape) * MM3_PER_M3
        assert volume == pytest.approx(gross_volume(plank), rel=1e-3)


def test_every_edge_of_a_b_spline_body_is_used_once_in_each_direction(sample: Gridshell) -> None:
    file = ifc_model(sample, options=IfcOptions(geometry="brep")).file
    for body in file.by_type("IfcAdvancedBrep"):
        loops = [face.Bounds[0].Bound.EdgeList for face in body.Outer.CfsFaces]
        used = sorted((edge.EdgeElement.id(), edge.Orientation) for loop in loops for edge in loop)
        assert len(used) == 24
        assert used == sorted((ident, way) for ident in {ident for ident, _ in used} for way in (False, True))
        for loop in loops:
            corners = [(e.EdgeElement.EdgeStart, e.EdgeElement.EdgeEnd)[:: 1 if e.Orientation else -1] for e in loop]
            assert all(a[1] == b[0] for a, b in zip(corners, corners[1:] + corners[:1], strict=True))


def test_the_splines_of_a_body_follow_the_formed_plank(shell: Shell) -> None:
    """Between the samples too: 0.01 mm, as the corners of the solid do."""
    for plank in shell.planks[:6]:
        stations = np.linspace(0.0, plank.blank.length, 50)
        y, z = plank.blank.section.width / 2.0, plank.blank.section.thickness / 2.0
        expected = formed_points(plank, np.column_stack([stations, np.full(50, -y), np.full(50, -z)]))
        np.testing.assert_allclose(corner_splines(plank)(stations)[:, 0], expected, rtol=0, atol=0.01)


def test_planks_have_their_centre_line_as_axis_and_nothing_else_has(sample: Gridshell) -> None:
    file = ifc_model(sample).file
    parts = {part.mark: part for part in all_parts(sample)}
    for element in file.by_type("IfcElement"):
        if element.Representation is None:
            continue
        shapes = {shape.RepresentationIdentifier: shape for shape in element.Representation.Representations}
        part = parts[element.Name]
        assert set(shapes) == ({"Body", "Axis"} if isinstance(part, Plank) else {"Body"})
        if isinstance(part, Plank):
            line = np.array(shapes["Axis"].Items[0].MappingSource.MappedRepresentation.Items[0].Points.CoordList)
            length = float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())
            assert length == pytest.approx(part.blank.length, rel=1e-3)
