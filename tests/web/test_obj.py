"""A web goes out as OBJ and comes in again, grid and all; every other mesh is refused with its reason."""

import contextlib
from collections.abc import Callable

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from aag_cad.design import Design
from aag_cad.errors import FileError
from aag_cad.geometry.revolution import AsymptoticChart
from aag_cad.pipeline import web_of
from aag_cad.units import Floats
from aag_cad.web.obj import read_web_obj, web_obj
from aag_cad.web.quality import quality, star_normals
from aag_cad.web.web import Web, crpc_web

Quad = tuple[int, int, int, int]
ROWS, COLUMNS = 6, 5


def web(rows_above: int = ROWS - 2, columns: int = COLUMNS) -> Web:
    return crpc_web(5100.0, 3.0, -8823.0, np.linspace(-0.3, 0.3, columns), 1, rows_above)


def grid(rows: int = ROWS, columns: int = COLUMNS, spacing: float = 500.0) -> tuple[list[list[float]], list[Quad]]:
    """Return a plane grid: vertices row by row and quads by numbers from 1."""
    vertices = [[spacing * i, spacing * j, 0.0] for i in range(rows) for j in range(columns)]
    corners = [i * columns + j + 1 for i in range(rows - 1) for j in range(columns - 1)]
    return vertices, [(k, k + columns, k + columns + 1, k + 1) for k in corners]


def obj(vertices: list[list[float]], faces: list[Quad], *more: str) -> str:
    lines = ["v " + " ".join(map(repr, vertex)) for vertex in vertices]
    lines += ["f " + " ".join(map(str, face)) for face in faces]
    return "\n".join([*lines, *more]) + "\n"


def test_a_web_comes_back_bit_for_bit() -> None:
    assert np.array_equal(read_web_obj(web_obj(web()), "web.obj").vertices, web().vertices)


def test_the_web_of_the_vault_comes_back_too(design: Design, chart: AsymptoticChart) -> None:
    vault = web_of(design, chart)
    assert np.array_equal(read_web_obj(web_obj(vault), "vault.obj").vertices, vault.vertices)


def test_the_mesh_faces_the_outside_for_an_independent_reader() -> None:
    mesh = trimesh.load(trimesh.util.wrap_as_stream(web_obj(web())), file_type="obj", process=False)
    assert isinstance(mesh, trimesh.Trimesh)
    outside = star_normals(web()).reshape(-1, 3).mean(axis=0)
    assert len(mesh.vertices) == ROWS * COLUMNS
    assert np.all(mesh.face_normals @ outside > 0.5)


@given(st.permutations(range((ROWS - 1) * (COLUMNS - 1) - 1)), st.permutations(range(ROWS * COLUMNS)))
def test_the_order_of_vertices_and_of_later_faces_changes_nothing(order: list[int], shuffle: list[int]) -> None:
    """Only the first face anchors the grid."""
    vertices, faces = grid()
    number = {old + 1: new + 1 for new, old in enumerate(shuffle)}
    moved = [vertices[k] for k in shuffle]
    sorted_faces = [faces[0], *(faces[1:][k] for k in order)]
    renamed = [(number[a], number[b], number[c], number[d]) for a, b, c, d in sorted_faces]
    found = read_web_obj(obj(moved, renamed), "grid.obj").vertices
    assert np.array_equal(found.reshape(-1, 3), np.array(vertices))


@pytest.mark.parametrize("turn", [0, 1, 2, 3])
def test_the_first_corner_of_the_first_face_is_where_rows_and_columns_begin_to_rise(turn: int) -> None:
    vertices, faces = grid()
    first = faces[0][turn:] + faces[0][:turn]
    a, b, c, _ = first
    found = read_web_obj(obj(vertices, [(first[0], first[1], first[2], first[3]), *faces[1:]]), "grid.obj").vertices
    down, right = found[1, 0] - found[0, 0], found[0, 1] - found[0, 0]
    assert np.array_equal(down, np.subtract(vertices[b - 1], vertices[a - 1]))
    assert np.array_equal(right, np.subtract(vertices[c - 1], vertices[b - 1]))


def test_the_geodesics_run_along_the_first_edge_unless_the_file_says_otherwise() -> None:
    """Both answers keep the outside outside: rows x columns is the normal of the faces."""
    plain = obj(*grid())
    stated = "# geodesics: second edge\n" + plain
    first, second = (read_web_obj(text, "grid.obj").vertices for text in (plain, stated))
    assert first.shape == (ROWS, COLUMNS, 3)
    assert second.shape == (COLUMNS, ROWS, 3)
    for found in (first, second):
        assert np.cross(found[1, 0] - found[0, 0], found[0, 1] - found[0, 0])[2] > 0.0
    assert np.array_equal(read_web_obj("# geodesics: first edge\n" + plain, "grid.obj").vertices, first)


def test_what_is_geodesic_in_the_web_is_geodesic_when_it_is_read() -> None:
    found = quality(read_web_obj(web_obj(web()), "web.obj"))
    assert found.geodesic_deviation_deg < 1e-9


def test_textures_normals_names_backward_numbers_and_continued_lines_are_read() -> None:
    vertices, faces = grid(3, 3)
    count = len(vertices)
    lines = ["mtllib a.mtl", "o web", *("v " + " ".join(map(str, v)) + " 1.0" for v in vertices), "vn 0 0 1", "vt 0 0"]
    for a, b, c, d in faces:
        lines.append(f"f {a}/1/1 {b - count - 1}//1 \\")
        lines.append(f"{c}/1 {d} # a quad")
    assert np.array_equal(
        read_web_obj("\r\n".join(lines), "rich.obj").vertices, read_web_obj(obj(*grid(3, 3)), "plain.obj").vertices
    )


def _with(vertices: dict[int, list[float]]) -> str:
    points, faces = grid()
    for number, point in vertices.items():
        points[number - 1] = point
    return obj(points, faces)


def _without(*left_out: int) -> str:
    points, faces = grid()
    return obj(points, [face for k, face in enumerate(faces) if k not in left_out])


def _flipped() -> str:
    points, faces = grid()
    a, b, c, d = faces[5]
    return obj(points, [*faces[:5], (d, c, b, a), *faces[6:]])


def _duplicate_seam() -> str:
    """Return two halves that touch along a seam that was never welded."""
    points, faces = grid()
    seam = {10 + k + 1: len(points) + k + 1 for k in range(COLUMNS)}
    upper = [face if k < 8 else tuple(seam.get(c, c) for c in face) for k, face in enumerate(faces)]
    doubled = [*points, *(points[old - 1] for old in seam)]
    return obj(doubled, [(face[0], face[1], face[2], face[3]) for face in upper])


def _ring(sides: int) -> Floats:
    angle = 2.0 * np.pi * np.arange(sides) / sides
    return np.column_stack([1000.0 * np.cos(angle), 1000.0 * np.sin(angle)])


def _tube(closed: bool) -> str:
    """Return a tube of six sides, or the same bent into a torus."""
    sides, rows = 6, 5
    points = [[x, y, 500.0 * row] for row in range(rows) for x, y in _ring(sides).tolist()]
    faces = []
    for row in range(rows if closed else rows - 1):
        for k in range(sides):
            a, b = row * sides + k, row * sides + (k + 1) % sides
            c, d = ((n + sides) % (rows * sides) for n in (b, a))
            faces.append((a + 1, b + 1, c + 1, d + 1))
    return obj(points, faces)


def _star(arms: int) -> str:
    """Return quads around one inner vertex with as many edges as ``arms``."""
    points = [[0.0, 0.0, 0.0], *([x, y, 0.0] for x, y in _ring(2 * arms).tolist())]
    return obj(points, [(1, 2 * k + 2, 2 * k + 3, (2 * k + 3) % (2 * arms) + 1 + 0) for k in range(arms)])


def _fin() -> str:
    points, faces = grid()
    count = len(points)
    return obj([*points, [500.0, 500.0, 400.0], [500.0, 1000.0, 400.0]], [*faces, (7, 8, count + 2, count + 1)])


def _two_parts() -> str:
    points, faces = grid(3, 3)
    far = [[x + 9000.0, y, z] for x, y, z in points]
    return obj([*points, *far], [*faces, *((a + 9, b + 9, c + 9, d + 9) for a, b, c, d in faces)])


def _touching_corners() -> str:
    points = grid(3, 3)[0]
    return obj([p for p in points if p not in ([0.0, 1000.0, 0.0], [1000.0, 0.0, 0.0])], [(1, 3, 4, 2), (4, 6, 7, 5)])


BROKEN: dict[str, tuple[Callable[[], str], str]] = {
    "NaN": (lambda: _with({7: [np.nan, 0.0, 0.0]}), r"line 7: the vertex \(nan 0.0 0.0\) is not finite"),
    "infinite": (lambda: _with({7: [0.0, np.inf, 0.0]}), r"line 7: .* is not finite"),
    "far away": (lambda: _with({3: [4.5e9, 5e8, 0.0]}), r"line 3: .*more than 1000 m from the origin; move the mesh"),
    "in metres": (lambda: obj(*grid(spacing=0.5)), r"edges are 0\.5 long; .* probably in metres, scale it by 1000"),
    "too many": (lambda: "v 0 0 0\n" * 100_001, r"more than 100000 vertices; .*coarsen"),
    "duplicate vertices": (_duplicate_seam, r"vertices 11 and 31 \(lines 11 and 31\) lie at the same point, 5 such"),
    "collapsed edge": (lambda: _with({8: [500.0, 500.0, 0.0]}), r"vertices 7 and 8 .* lie at the same point, 1 such"),
    "loose vertex": (lambda: obj([*grid()[0], [1.0, 2.0, 3.0]], grid()[1]), r"line 31: vertex 31 belongs to no face"),
    "flipped face": (_flipped, r"line 36: the face is flipped against the face of line \d+ .*unify the normals"),
    "hole": (lambda: _without(5, 6), r"2 borders, a web has one; it has a hole.*\(6 edges around\)"),
    "one face missing": (lambda: _without(5), r"2 borders, .*it has a hole"),
    "tube": (lambda: _tube(False), r"2 borders, .*or is a tube"),
    "closed": (lambda: _tube(True), r"the mesh is closed, a web has one border; cut it open"),
    "valence 5": (lambda: _star(5), r"line 1: vertex 1 has 5 edges; inner vertices of a web have 4"),
    "valence 3": (lambda: _star(3), r"line 1: vertex 1 has 3 edges; inner vertices of a web have 4"),
    "fin": (_fin, r"3 faces meet at the edge \d+ - \d+; the mesh is not a manifold"),
    "two parts": (_two_parts, r"line 23: the face is cut off from the first; 4 of 8 faces hang together"),
    "touching corners": (_touching_corners, r"vertex 4 joins faces that share no edge; the mesh is not a manifold"),
    "empty": (lambda: "", r"0 vertices and 0 faces; the file holds no mesh"),
    "points only": (lambda: obj(grid()[0], []), r"30 vertices and 0 faces; the file holds no mesh"),
    "triangles": (lambda: obj(grid()[0], [], "f 1 2 6"), r"line 31: a triangle; .*without triangulation"),
    "five corners": (lambda: obj(grid()[0], [], "f 1 2 3 8 7"), r"line 31: a face of 5 corners; .*quads only"),
    "corner twice": (lambda: obj(grid()[0], [(1, 6, 6, 2)]), r"line 31: the face names a vertex twice"),
    "missing vertex": (lambda: obj(grid()[0], [(1, 6, 70, 2)]), r"line 31: .*names vertex 70, the file has 30"),
    "number nought": (lambda: obj(grid()[0], [(0, 6, 7, 2)]), r"line 31: vertex numbers start at 1"),
    "no number": (lambda: "v 1 2 drei\n", r"line 1: '1 2 drei' is no vertex"),
    "plane points": (lambda: "v 1 2\n", r"line 1: a vertex of 2 numbers"),
    "no face": (lambda: obj(grid()[0], [], "f a b c d"), r"line 31: 'a b c d' is no face"),
    "another format": (lambda: "solid web\nfacet normal 0 0 1\n", r"line 1: 'solid' begins no line of an OBJ mesh"),
    "one cell wide": (lambda: obj(*grid(6, 2)), r"6 x 2 vertices; a web needs at least 3 x 3"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_mesh_is_refused_with_its_reason(name: str) -> None:
    text, reason = BROKEN[name]
    with pytest.raises(FileError, match=reason) as caught:
        read_web_obj(text(), "broken.obj")
    assert str(caught.value).startswith("broken.obj")


def test_a_re_entrant_corner_is_no_web() -> None:
    """An L of quads has valence 4 on its border and five outer corners."""
    points, faces = grid(5, 5)
    kept = [face for k, face in enumerate(faces) if not (k % 4 < 2 and k < 8)]
    used = sorted({corner for face in kept for corner in face})
    number = {old: new for new, old in enumerate(used, start=1)}
    renamed = [(number[a], number[b], number[c], number[d]) for a, b, c, d in kept]
    with pytest.raises(FileError, match="re-entrant corner"):
        read_web_obj(obj([points[k - 1] for k in used], renamed), "l.obj")


@given(st.text(alphabet="vfg# 0123456789-./e\n\\", max_size=200))
def test_no_text_breaks_the_reader_otherwise_than_with_its_own_error(text: str) -> None:
    with contextlib.suppress(FileError):
        web = read_web_obj(text, "noise.obj")
        assert min(web.vertices.shape[:2]) >= 3
