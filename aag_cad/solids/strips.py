"""The solid of a strip: two ruled faces along its rulings, edges and cuts square to them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from OCP.Geom import Geom_BSplineSurface
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Solid, TopoDS_Vertex
from scipy.interpolate import BSpline, make_interp_spline

from aag_cad.parts.model import Strip
from aag_cad.parts.shapes.sheet import Sheet, rulings_through, sheet_of
from aag_cad.solids import brep
from aag_cad.units import Floats

_DEGREE = 5
_CUT_SAMPLES = 13
_BELOW, _ABOVE = 0, 1


@dataclass(frozen=True, eq=False)
class _Skin:
    """The faces of a sheet that is not yet cut: ruled surfaces over the knots of its edges, the parameter in mm.

    ``edges`` are the splines of the four long edges, (side, face); a wide face has v from 0 to ``width``.
    """

    sheet: Sheet
    length: float
    width: float
    edges: dict[tuple[int, int], BSpline]
    wide: tuple[Geom_BSplineSurface, Geom_BSplineSurface]
    sides: tuple[Geom_BSplineSurface, Geom_BSplineSurface]

    def across(self, face: int, v: Floats) -> Floats:
        """Return the second parameter of a wide face at fractions v: the lower face runs from right to left."""
        return self.width * (v if face == _ABOVE else 1.0 - v)


@dataclass(frozen=True, eq=False)
class _Corner:
    """A corner of the cuts: its vertices on both faces, and the edge between them, upwards."""

    vertices: tuple[TopoDS_Vertex, TopoDS_Vertex]
    rise: TopoDS_Edge
    u: float


def _ruled(first: BSpline, second: BSpline, width: float) -> Geom_BSplineSurface:
    return brep.ruled_surface(_DEGREE, first.t, first.c, second.c, width)


def _skin(strip: Strip) -> _Skin:
    sheet, half, length = sheet_of(strip), strip.thickness / 2.0, strip.left.length
    u = np.linspace(0.0, 1.0, len(strip.left.stations))
    edges = {
        (side, face): make_interp_spline(
            u * length, sheet.formed(u, np.full_like(u, side), half if face == _ABOVE else -half), k=_DEGREE
        )
        for side in (0, 1)
        for face in (_BELOW, _ABOVE)
    }
    width = float(np.linalg.norm(strip.right.points - strip.left.points, axis=1).mean())
    return _Skin(
        sheet,
        length,
        width,
        edges,
        (_ruled(edges[1, _BELOW], edges[0, _BELOW], width), _ruled(edges[0, _ABOVE], edges[1, _ABOVE], width)),
        (
            _ruled(edges[0, _BELOW], edges[0, _ABOVE], strip.thickness),
            _ruled(edges[1, _ABOVE], edges[1, _BELOW], strip.thickness),
        ),
    )


def _on_faces(skin: _Skin, u: Floats, v: Floats) -> Floats:
    """Return the points (2, n, 3) of the lower and the upper face at rulings u and fractions v."""
    x = u * skin.length
    faces = []
    for face in (_BELOW, _ABOVE):
        left, right = (np.asarray(skin.edges[side, face](x)) for side in (0, 1))
        faces.append(left + v[:, None] * (right - left))
    return np.array(faces)


def _corners(skin: _Skin, cut: Sequence[float]) -> list[_Corner]:
    u, v = np.array(cut), np.linspace(0.0, 1.0, len(cut))
    below, above = _on_faces(skin, u, v)
    corners = []
    for i, (low, high) in enumerate(zip(below, above, strict=True)):
        vertices = brep.vertex(low), brep.vertex(high)
        rise = brep.line_edge(low, high, float(np.linalg.norm(high - low)), *vertices)
        corners.append(_Corner(vertices, rise, float(u[i])))
    for corner, side in ((corners[0], 0), (corners[-1], 1)):
        start, way = (0.0, 1.0) if side == 0 else (skin.sheet.thickness, -1.0)
        brep.lay_on(corner.rise, skin.sides[side], brep.line_2d(corner.u * skin.length, start, 0.0, way))
    return corners


def _cut(
    skin: _Skin, flat: Floats, corners: tuple[_Corner, _Corner], upper: bool
) -> tuple[list[TopoDS_Edge], TopoDS_Face]:
    """Return the two edges of a straight cut from left to right, (lower, upper face), and the face between them."""
    t = np.linspace(0.0, 1.0, _CUT_SAMPLES)
    length = float(np.linalg.norm(flat[1] - flat[0]))
    u, v = rulings_through(skin.sheet, flat[0] + t[:, None] * (flat[1] - flat[0]))
    points = _on_faces(skin, u, v)
    splines = [make_interp_spline(t * length, points[face], k=_DEGREE) for face in (_BELOW, _ABOVE)]
    first, second = (_BELOW, _ABOVE) if upper else (_ABOVE, _BELOW)
    surface = _ruled(splines[first], splines[second], skin.sheet.thickness)
    edges = []
    for face, spline in enumerate(splines):
        start, end = corners[0].vertices[face], corners[1].vertices[face]
        edge = brep.edge(brep.spline_curve(_DEGREE, spline.t, spline.c), 0.0, length, start, end)
        parameters = make_interp_spline(t * length, np.column_stack([u * skin.length, skin.across(face, v)]), k=_DEGREE)
        brep.lay_on(edge, skin.wide[face], brep.spline_curve_2d(_DEGREE, parameters.t, parameters.c))
        brep.lay_on(edge, surface, brep.line_2d(0.0, 0.0 if face == first else skin.sheet.thickness, 1.0, 0.0))
        edges.append(edge)
    start, way = (0.0, 1.0) if upper else (skin.sheet.thickness, -1.0)
    for corner, x in zip(corners, (0.0, length), strict=True):
        brep.lay_on(corner.rise, surface, brep.line_2d(x, start, 0.0, way))
    a, b = (corner.rise for corner in corners)
    if upper:
        around = [edges[_BELOW], b, edges[_ABOVE].Reversed(), a.Reversed()]
    else:
        around = [edges[_ABOVE], b.Reversed(), edges[_BELOW].Reversed(), a]
    return edges, brep.face(surface, [brep.wire(around)])


def _long_edges(skin: _Skin, low: _Corner, high: _Corner, side: int) -> list[TopoDS_Edge]:
    """Return the two long edges of a side, upwards, on the lower and on the upper face."""
    made = []
    thickness = skin.sheet.thickness
    for face in (_BELOW, _ABOVE):
        spline = skin.edges[side, face]
        curve = brep.spline_curve(_DEGREE, spline.t, spline.c)
        ends = low.u * skin.length, high.u * skin.length
        edge = brep.edge(curve, *ends, low.vertices[face], high.vertices[face])
        across = float(skin.across(face, np.array([float(side)]))[0])
        brep.lay_on(edge, skin.wide[face], brep.line_2d(0.0, across, 1.0, 0.0))
        brep.lay_on(edge, skin.sides[side], brep.line_2d(0.0, 0.0 if side == face else thickness, 1.0, 0.0))
        made.append(edge)
    return made


def strip_solid(strip: Strip) -> TopoDS_Solid:
    """Return the formed strip in the coordinates of its shell; SolidError if it comes out invalid.

    Both wide faces are ruled along the sheet's own rulings; the cuts, straight in the flat pattern, trim them.
    """
    skin = _skin(strip)
    lower, upper = _corners(skin, strip.lower), _corners(skin, strip.upper)
    low_cuts = [_cut(skin, skin.sheet.lower[i : i + 2], (lower[i], lower[i + 1]), False) for i in range(len(lower) - 1)]
    high_cuts = [_cut(skin, skin.sheet.upper[i : i + 2], (upper[i], upper[i + 1]), True) for i in range(len(upper) - 1)]
    left, right = _long_edges(skin, lower[0], upper[0], 0), _long_edges(skin, lower[-1], upper[-1], 1)
    below = [
        right[_BELOW],
        *(edges[_BELOW].Reversed() for edges, _ in reversed(high_cuts)),
        left[_BELOW].Reversed(),
        *(edges[_BELOW] for edges, _ in low_cuts),
    ]
    above = [
        left[_ABOVE],
        *(edges[_ABOVE] for edges, _ in high_cuts),
        right[_ABOVE].Reversed(),
        *(edges[_ABOVE].Reversed() for edges, _ in reversed(low_cuts)),
    ]
    beside = (
        [left[_BELOW], upper[0].rise, left[_ABOVE].Reversed(), lower[0].rise.Reversed()],
        [right[_ABOVE], upper[-1].rise.Reversed(), right[_BELOW].Reversed(), lower[-1].rise],
    )
    faces = [
        brep.face(skin.wide[_BELOW], [brep.wire(below)]),
        brep.face(skin.wide[_ABOVE], [brep.wire(above)]),
        *(brep.face(skin.sides[side], [brep.wire(edges)]) for side, edges in enumerate(beside)),
        *(face for _, face in (*low_cuts, *high_cuts)),
    ]
    return brep.checked(brep.solid(faces), strip.mark)
