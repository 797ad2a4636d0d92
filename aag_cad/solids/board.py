"""A board with round holes: eight corners, four long faces, two ends and a cylinder wall for each hole."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from OCP.Geom import Geom_Curve, Geom_CylindricalSurface, Geom_Line, Geom_Surface
from OCP.Geom2d import Geom2d_Curve
from OCP.gp import gp_Ax3
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Solid, TopoDS_Vertex, TopoDS_Wire

from aag_cad.solids import brep
from aag_cad.units import Floats

LOWER, UPPER = 0, 2
_SIDES = range(4)
_TURN = 2.0 * math.pi


@dataclass(frozen=True, eq=False)
class Skin:
    """The outside of a board without holes.

    ``corners`` (2, 4, 3): start and end, counter-clockwise seen against the length, (-y, -z) first. ``curves``: the
    long edges, all with the parameter range [0, ``length``]. ``surfaces``: number j lies between the long edges j + 1,
    where v = 0, and j, where v = ``sides[j]``, and turns outwards; 0 is the lower wide face, 2 the upper. ``flat``:
    all of them are planes.
    """

    corners: Floats
    curves: Sequence[Geom_Curve]
    surfaces: Sequence[Geom_Surface]
    length: float
    sides: tuple[float, float, float, float]
    flat: bool


@dataclass(frozen=True, eq=False)
class Bore:
    """A hole: centre, first direction and axis (3,), radius, heights of its lower and upper rim over the centre.

    ``loops`` are the rims in the parameters of the lower and upper wide face by the angle about the axis, or None where
    the faces are planes; ``tolerance`` is how far the rims lie off the faces at most, mm.
    """

    centre: Floats
    start: Floats
    axis: Floats
    radius: float
    heights: tuple[float, float]
    loops: tuple[Geom2d_Curve, Geom2d_Curve] | None
    tolerance: float


def _wall(bore: Bore, surfaces: Sequence[Geom_Surface]) -> tuple[TopoDS_Face, TopoDS_Wire, TopoDS_Wire]:
    """Return the wall of a hole and the wires that it cuts into the lower and the upper wide face."""
    low, high = bore.heights
    cylinder = Geom_CylindricalSurface(
        gp_Ax3(brep.point(bore.centre), brep.direction(bore.axis), brep.direction(bore.start)), bore.radius
    )
    corners, rims = [], []
    for side, height in enumerate(bore.heights):
        centre = bore.centre + height * bore.axis
        corner = brep.vertex(centre + bore.radius * bore.start, bore.tolerance)
        circle = brep.circle(centre, bore.axis, bore.start, bore.radius)
        rim = brep.edge(circle, 0.0, _TURN, corner, corner, bore.tolerance)
        brep.lay_on(rim, cylinder, brep.line_2d(0.0, height, 1.0, 0.0), bore.tolerance)
        if bore.loops is not None:
            brep.lay_on(rim, surfaces[LOWER if side == 0 else UPPER], bore.loops[side], bore.tolerance)
        corners.append(corner)
        rims.append(rim)
    foot = bore.centre + bore.radius * bore.start
    seam = brep.edge(Geom_Line(brep.point(foot), brep.direction(bore.axis)), low, high, *corners)
    brep.lay_as_seam(seam, cylinder, brep.line_2d(_TURN, 0.0, 0.0, 1.0), brep.line_2d(0.0, 0.0, 0.0, 1.0))
    wall = brep.face(cylinder, [brep.wire([rims[0], seam, rims[1].Reversed(), seam.Reversed()])])
    return wall.Reversed(), brep.wire([rims[0]]), brep.wire([rims[1].Reversed()])


def _long_edges(skin: Skin, vertices: Sequence[Sequence[TopoDS_Vertex]]) -> list[TopoDS_Edge]:
    edges = []
    for j in _SIDES:
        edge = brep.edge(skin.curves[j], 0.0, skin.length, vertices[0][j], vertices[1][j])
        if not skin.flat:
            before = (j - 1) % 4
            brep.lay_on(edge, skin.surfaces[before], brep.line_2d(0.0, 0.0, 1.0, 0.0))
            brep.lay_on(edge, skin.surfaces[j], brep.line_2d(0.0, skin.sides[j], 1.0, 0.0))
        edges.append(edge)
    return edges


def _end_edges(skin: Skin, vertices: Sequence[Sequence[TopoDS_Vertex]], end: int) -> list[TopoDS_Edge]:
    edges = []
    for j in _SIDES:
        after, width = (j + 1) % 4, skin.sides[j]
        a, b = skin.corners[end, j], skin.corners[end, after]
        edge = brep.line_edge(a, b, width, vertices[end][j], vertices[end][after])
        if not skin.flat:
            brep.lay_on(edge, skin.surfaces[j], brep.line_2d(end * skin.length, width, 0.0, -1.0))
        edges.append(edge)
    return edges


def drilled_board(skin: Skin, ends: tuple[Geom_Surface, Geom_Surface], bores: Sequence[Bore]) -> TopoDS_Solid:
    """Return the solid in a skin, closed by two planes that turn outwards, with holes through its wide faces."""
    vertices = [[brep.vertex(corner) for corner in ring] for ring in skin.corners]
    long = _long_edges(skin, vertices)
    start, end = (_end_edges(skin, vertices, which) for which in (0, 1))
    walls = [_wall(bore, skin.surfaces) for bore in bores]
    inner: dict[int, list[TopoDS_Wire]] = {LOWER: [wall[1] for wall in walls], UPPER: [wall[2] for wall in walls]}
    faces = []
    for j in _SIDES:
        outer = brep.wire([long[(j + 1) % 4], end[j].Reversed(), long[j].Reversed(), start[j]])
        faces.append(brep.face(skin.surfaces[j], [outer, *inner.get(j, [])]))
    faces.append(brep.face(ends[0], [brep.wire([edge.Reversed() for edge in reversed(start)])]))
    faces.append(brep.face(ends[1], [brep.wire(end)]))
    return brep.solid([*faces, *(wall[0] for wall in walls)])
