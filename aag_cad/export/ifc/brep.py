"""Planks and bars as IfcAdvancedBrep: ruled B-spline faces between the four long edges, without a CAD kernel."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline

from aag_cad.export.ifc.frame import Entity, IfcModel
from aag_cad.parts.forming import corner_splines, plank_axes
from aag_cad.parts.model import FlatBar
from aag_cad.units import Floats

_DEGREE = 5
# Points to 1e-6 mm, directions and knots to 1e-9.
_POINT_DIGITS = 6
_FINE_DIGITS = 9
_CORNERS = 4


@dataclass(frozen=True, eq=False)
class _Edges:
    """The twelve edges: ``long[j]`` along corner j, ``start[j]`` and ``end[j]`` from corner j to the next."""

    long: list[Entity]
    start: list[Entity]
    end: list[Entity]


def _knots(spline: BSpline) -> tuple[list[int], list[float]]:
    """Return multiplicities and distinct knots of a clamped spline."""
    inner = spline.t[_DEGREE + 1 : -_DEGREE - 1]
    knots = [spline.t[0], *inner, spline.t[-1]]
    return [_DEGREE + 1, *(1 for _ in inner), _DEGREE + 1], [round(float(knot), _FINE_DIGITS) for knot in knots]


def _direction(model: IfcModel, values: Floats) -> Entity:
    rounded = np.round(values / np.linalg.norm(values), _FINE_DIGITS) + 0.0
    return model.new("IfcDirection", rounded.tolist())


def _poles(model: IfcModel, spline: BSpline) -> list[list[Entity]]:
    """Return the control points of each long edge, the first and the last of which are its ends."""
    values = (np.round(spline.c, _POINT_DIGITS) + 0.0).tolist()
    return [[model.new("IfcCartesianPoint", row[j]) for row in values] for j in range(_CORNERS)]


def _edges(model: IfcModel, spline: BSpline, poles: list[list[Entity]]) -> _Edges:
    new, (multiplicities, knots) = model.new, _knots(spline)
    vertices = [[new("IfcVertexPoint", row[end]) for row in poles] for end in (0, -1)]
    long = []
    for j, row in enumerate(poles):
        curve = new(
            "IfcBSplineCurveWithKnots", _DEGREE, row, "UNSPECIFIED", False, False, multiplicities, knots, "UNSPECIFIED"
        )
        long.append(new("IfcEdgeCurve", vertices[0][j], vertices[1][j], curve, True))
    rings = []
    for end, ring in zip((0, -1), vertices, strict=True):
        straight = []
        for j in range(_CORNERS):
            along = spline.c[end, (j + 1) % _CORNERS] - spline.c[end, j]
            vector = new("IfcVector", _direction(model, along), 1.0)
            line = new("IfcLine", poles[j][end], vector)
            straight.append(new("IfcEdgeCurve", ring[j], ring[(j + 1) % _CORNERS], line, True))
        rings.append(straight)
    return _Edges(long, *rings)


def _face(model: IfcModel, surface: Entity, edges: list[tuple[Entity, bool]]) -> Entity:
    loop = model.new(
        "IfcEdgeLoop",
        [model.new("IfcOrientedEdge", None, None, edge, forward) for edge, forward in edges],
    )
    return model.new("IfcAdvancedFace", [model.new("IfcFaceOuterBound", loop, True)], surface, True)


def _sides(model: IfcModel, spline: BSpline, poles: list[list[Entity]], edges: _Edges) -> list[Entity]:
    """Return the four ruled faces; their rulings run from each corner back to the one before, so they turn outwards."""
    faces, (multiplicities, knots) = [], _knots(spline)
    for j in range(_CORNERS):
        k = (j + 1) % _CORNERS
        net = [[first, second] for first, second in zip(poles[k], poles[j], strict=True)]
        surface = model.new(
            "IfcBSplineSurfaceWithKnots", _DEGREE, 1, net, "RULED_SURF", False, False, False, multiplicities, [2, 2],
            knots, [0.0, 1.0], "UNSPECIFIED",
        )  # fmt: skip
        around = [(edges.long[k], True), (edges.end[j], False), (edges.long[j], False), (edges.start[j], True)]
        faces.append(_face(model, surface, around))
    return faces


def _ends(model: IfcModel, bar: FlatBar, poles: list[list[Entity]], edges: _Edges) -> list[Entity]:
    """Return the two plane ends, square to the centre line."""
    _point, tangents, widths, _thickness = plank_axes(bar, np.array([0.0, bar.blank.length]))
    start_loop = [(edge, False) for edge in reversed(edges.start)]
    end_loop = [(edge, True) for edge in edges.end]
    faces = []
    for corner, normal, width, loop in (
        (poles[0][0], -tangents[0], widths[0], start_loop),
        (poles[0][-1], tangents[1], widths[1], end_loop),
    ):
        place = model.new("IfcAxis2Placement3D", corner, _direction(model, normal), _direction(model, width))
        faces.append(_face(model, model.new("IfcPlane", place), loop))
    return faces


def advanced_brep(model: IfcModel, bar: FlatBar) -> Entity:
    """Return the bent and twisted plank or bar, without its holes, as a solid of four ruled and two plane faces."""
    spline = corner_splines(bar)
    poles = _poles(model, spline)
    edges = _edges(model, spline, poles)
    faces = [*_sides(model, spline, poles, edges), *_ends(model, bar, poles, edges)]
    return model.new("IfcAdvancedBrep", model.new("IfcClosedShell", faces))
