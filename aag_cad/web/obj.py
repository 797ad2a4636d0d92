"""Webs as Wavefront OBJ: a quad mesh out, and in again with rows and columns recovered from its topology.

Convention: faces run counter-clockwise seen from outside. Rows and columns both rise from the first corner of the first
face, which is what makes the recovered grid one and the same each time. The G lines run along the edge from the first
to the second corner of the first face, or along the next one if a comment ``# geodesics: second edge`` says so.
"""

import math
import re
from collections import Counter
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

import networkx as nx
import numpy as np

from aag_cad.errors import FileError
from aag_cad.units import Floats
from aag_cad.web.web import Web

Face: TypeAlias = tuple[int, int, int, int]
DirectedEdges: TypeAlias = dict[tuple[int, int], int]

_STATED = re.compile(r"#\s*geodesics:\s*(first edge|second edge)\s*")
# Lines that carry no quad mesh: normals, textures, names, display.
_IGNORED = frozenset(("g", "l", "lod", "mg", "mtllib", "o", "p", "s", "usemtl", "vn", "vp", "vt"))
_LARGEST_COORDINATE = 1e6
_LARGEST_COUNT = 100_000
_SMALLEST_EDGE = 1.0
_SAME_PLACE = 1e-3


@dataclass(frozen=True, eq=False)
class _Mesh:
    """Vertices (n, 3), mm, and faces of numbers from 0, with the lines of the text that they stand on."""

    source: str
    vertices: Floats
    vertex_lines: list[int]
    faces: list[Face]
    face_lines: list[int]
    along_second: bool


def web_obj(web: Web) -> str:
    """Return a web as the text of an OBJ file in mm: vertices row by row, one quad for each cell, outside up."""
    rows, columns = web.vertices.shape[:2]
    lines = [
        "# AAG web, mm; columns of the grid are geodesics, both diagonals are asymptotic",
        "# geodesics: first edge",
        f"# {rows} rows x {columns} columns",
    ]
    lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in web.vertices.reshape(-1, 3).tolist()]
    for i in range(rows - 1):
        for j in range(columns - 1):
            corner = i * columns + j + 1
            lines.append(f"f {corner} {corner + columns} {corner + columns + 1} {corner + 1}")
    return "\n".join(lines) + "\n"


def read_web_obj(text: str, source: str) -> Web:
    """Return the web of an OBJ text; ``source`` names the file in errors.

    FileError with the line and the reason for what is not one rectangular grid of quads in mm.
    """
    mesh = _parsed(text, source)
    _check_vertices(mesh)
    edges = _directed_edges(mesh)
    neighbours = nx.Graph((face, edges[b, a]) for (a, b), face in edges.items() if (b, a) in edges)
    neighbours.add_nodes_from(range(len(mesh.faces)))
    _check_topology(mesh, edges, neighbours)
    places = _grid_places(mesh, edges, neighbours)
    index = np.array([places[k] for k in range(len(places))])
    index -= index.min(axis=0)
    rows, columns = (int(k) + 1 for k in index.max(axis=0))
    if min(rows, columns) < 3:
        raise FileError(
            f"{source}: {rows} x {columns} vertices; a web needs at least 3 x 3, because curvature is measured "
            "at inner vertices: refine the mesh"
        )
    vertices = np.empty((rows, columns, 3))
    vertices[index[:, 0], index[:, 1]] = mesh.vertices
    return Web(vertices)


def _logical_lines(text: str) -> list[tuple[int, str]]:
    """Return the lines with their numbers, those that a backslash continues joined."""
    lines: list[tuple[int, str]] = []
    held, first = "", 0
    for number, line in enumerate(text.splitlines(), start=1):
        first = first if held else number
        if line.endswith("\\"):
            held += line[:-1] + " "
            continue
        lines.append((first, (held + line).strip()))
        held = ""
    return [*lines, (first, held.strip())] if held else lines


def _parsed(text: str, source: str) -> _Mesh:
    vertices: list[list[float]] = []
    faces: list[Face] = []
    vertex_lines, face_lines = [], []
    along_second = False
    for number, line in _logical_lines(text):
        where = f"{source}, line {number}"
        if found := _STATED.fullmatch(line):
            along_second = found[1] == "second edge"
        word, *values = line.split("#", 1)[0].split() or [""]
        if word == "v":
            vertices.append(_vertex(values, where))
            vertex_lines.append(number)
            if len(vertices) > _LARGEST_COUNT:
                raise FileError(
                    f"{source}: more than {_LARGEST_COUNT} vertices; a web needs far fewer: coarsen the mesh"
                )
        elif word == "f":
            faces.append(_face(values, len(vertices), where))
            face_lines.append(number)
        elif word and word not in _IGNORED:
            raise FileError(f"{where}: {word[:40]!r} begins no line of an OBJ mesh; export the web as OBJ with quads")
    if not vertices or not faces:
        raise FileError(
            f"{source}: {len(vertices)} vertices and {len(faces)} faces; the file holds no mesh: export the quad mesh"
        )
    for corners, number in zip(faces, face_lines, strict=True):
        if max(corners) >= len(vertices):
            raise FileError(
                f"{source}, line {number}: the face names vertex {max(corners) + 1}, the file has {len(vertices)}; "
                "export the mesh again"
            )
    return _Mesh(source, np.array(vertices), vertex_lines, faces, face_lines, along_second)


def _vertex(values: list[str], where: str) -> list[float]:
    try:
        numbers = [float(value) for value in values]
    except ValueError as error:
        raise FileError(f"{where}: {' '.join(values)[:60]!r} is no vertex; it needs three numbers x y z") from error
    # Some programs append a weight or a colour.
    if len(numbers) not in (3, 4, 6, 7):
        raise FileError(f"{where}: a vertex of {len(numbers)} numbers; it needs three, x y z")
    if not all(math.isfinite(value) for value in numbers[:3]):
        raise FileError(
            f"{where}: the vertex ({' '.join(values[:3])}) is not finite; repair it in the program it is from"
        )
    if max(abs(value) for value in numbers[:3]) > _LARGEST_COORDINATE:
        raise FileError(
            f"{where}: the vertex ({' '.join(values[:3])}) lies more than {_LARGEST_COORDINATE / 1000:g} m from the "
            "origin; move the mesh to the origin and export it in mm"
        )
    return numbers[:3]


def _face(values: list[str], known: int, where: str) -> Face:
    if len(values) == 3:
        raise FileError(f"{where}: a triangle; a web is made of quads only: export it without triangulation")
    if len(values) != 4:
        raise FileError(f"{where}: a face of {len(values)} corners; a web is made of quads only")
    try:
        numbers = [int(value.split("/", 1)[0]) for value in values]
    except ValueError as error:
        raise FileError(f"{where}: {' '.join(values)[:60]!r} is no face; it needs four vertex numbers") from error
    # Negative numbers count backwards from the vertices read so far.
    a, b, c, d = (number - 1 if number > 0 else known + number for number in numbers)
    if 0 in numbers or min(a, b, c, d) < 0:
        raise FileError(
            f"{where}: vertex numbers start at 1, or at -1 backwards from {known}; found {' '.join(values)}"
        )
    if len({a, b, c, d}) < 4:
        raise FileError(
            f"{where}: the face names a vertex twice ({' '.join(values)}); it is a triangle or less: repair it"
        )
    return a, b, c, d


def _check_vertices(mesh: _Mesh) -> None:
    """Refuse vertices at one place, vertices of no face, and meshes that are too small to be in mm."""
    tidy = np.round(mesh.vertices / _SAME_PLACE)
    _, first, inverse = np.unique(tidy, axis=0, return_index=True, return_inverse=True)
    doubles = np.flatnonzero(first[inverse.ravel()] != np.arange(len(tidy)))
    if doubles.size:
        later = int(doubles[0])
        earlier = int(first[inverse.ravel()[later]])
        raise FileError(
            f"{mesh.source}: vertices {earlier + 1} and {later + 1} (lines {mesh.vertex_lines[earlier]} and "
            f"{mesh.vertex_lines[later]}) lie at the same point, {doubles.size} such in all; weld the mesh"
        )
    loose = sorted(set(range(len(mesh.vertices))) - {corner for face in mesh.faces for corner in face})
    if loose:
        raise FileError(
            f"{_vertex_place(mesh, loose[0])} belongs to no face, {len(loose)} such in all; delete loose vertices"
        )
    corners = mesh.vertices[np.array(mesh.faces)]
    edge = float(np.median(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)))
    if edge < _SMALLEST_EDGE:
        raise FileError(
            f"{mesh.source}: the edges are {edge:.3g} long; webs are in mm with edges of at least {_SMALLEST_EDGE:g} "
            "mm: the mesh is probably in metres, scale it by 1000"
        )


def _around(face: Face) -> list[tuple[int, int]]:
    return [*pairwise(face), (face[3], face[0])]


def _directed_edges(mesh: _Mesh) -> DirectedEdges:
    """Return the face of each directed edge; refuse edges of three faces and faces that look the other way."""
    users = Counter(frozenset(edge) for face in mesh.faces for edge in _around(face))
    edges: DirectedEdges = {}
    for number, face in enumerate(mesh.faces):
        for a, b in _around(face):
            if users[frozenset((a, b))] > 2:
                raise FileError(
                    f"{mesh.source}, line {mesh.face_lines[number]}: {users[frozenset((a, b))]} faces meet at the edge "
                    f"{a + 1} - {b + 1}; the mesh is not a manifold: keep one sheet"
                )
            if (a, b) in edges:
                other = mesh.face_lines[edges[a, b]]
                raise FileError(
                    f"{mesh.source}, line {mesh.face_lines[number]}: the face is flipped against the face of line "
                    f"{other} at the edge {a + 1} - {b + 1}; unify the normals"
                )
            edges[a, b] = number
    return edges


def _check_topology(mesh: _Mesh, edges: DirectedEdges, neighbours: "nx.Graph[int]") -> None:
    """Refuse what is not one rectangle: sheets, parts, holes, tubes, irregular vertices, re-entrant corners."""
    border = [(a, b) for a, b in edges if (b, a) not in edges]
    touching = Counter(a for a, _ in border)
    for vertex in sorted(touching):
        if touching[vertex] > 1:
            raise FileError(
                f"{_vertex_place(mesh, vertex)} joins faces that share no edge; the mesh is not a manifold: separate "
                "them there"
            )
    reached = nx.node_connected_component(neighbours, 0)
    if len(reached) < len(mesh.faces):
        apart = next(line for number, line in enumerate(mesh.face_lines) if number not in reached)
        raise FileError(
            f"{mesh.source}, line {apart}: the face is cut off from the first; {len(reached)} of {len(mesh.faces)} "
            "faces hang together: keep one part, or weld its seam"
        )
    loops = list(nx.connected_components(nx.Graph(border)))
    if not loops:
        raise FileError(f"{mesh.source}: the mesh is closed, a web has one border; cut it open")
    if len(loops) > 1:
        count, first = min((len(loop), min(loop)) for loop in loops)
        raise FileError(
            f"{mesh.source}: the mesh has {len(loops)} borders, a web has one; it has a hole, or is a tube, at vertex "
            f"{first + 1} ({count} edges around): fill the hole or cut the tube open"
        )
    valence = Counter(vertex for edge in {frozenset(edge) for edge in edges} for vertex in edge)
    for vertex in sorted(valence):
        if vertex in touching and valence[vertex] > 3:
            raise FileError(
                f"{_vertex_place(mesh, vertex)} on the border has {valence[vertex]} edges, a re-entrant corner; a web "
                "is a full rectangle of rows and columns with 2 or 3: fill up or crop the mesh"
            )
        if vertex not in touching and valence[vertex] != 4:
            raise FileError(
                f"{_vertex_place(mesh, vertex)} has {valence[vertex]} edges; inner vertices of a web have 4: remesh "
                "without singular vertices"
            )


def _vertex_place(mesh: _Mesh, vertex: int) -> str:
    return f"{mesh.source}, line {mesh.vertex_lines[vertex]}: vertex {vertex + 1}"


def _grid_places(mesh: _Mesh, edges: DirectedEdges, neighbours: "nx.Graph[int]") -> dict[int, tuple[int, int]]:
    """Return (row, column) of each vertex, walking from face to face; turning left turns +row into +column."""
    a, b, c, d = mesh.faces[0]
    along = (b, c, d, a) if mesh.along_second else (a, b, c, d)
    places = dict(zip(along, ((0, 0), (1, 0), (1, 1), (0, 1)), strict=True))
    for known, number in nx.bfs_edges(neighbours, 0):
        p, q = next((p, q) for p, q in _around(mesh.faces[known]) if edges.get((q, p)) == number)
        face = mesh.faces[number]
        start = face.index(p)
        row, column = places[p][0] - places[q][0], places[p][1] - places[q][1]
        places[face[(start + 1) % 4]] = places[p][0] - column, places[p][1] + row
        places[face[(start + 2) % 4]] = places[q][0] - column, places[q][1] + row
    return places
