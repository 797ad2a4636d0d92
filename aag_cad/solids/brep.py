"""Boundary representations from numbers: vertices, edges, faces and solids by direct construction."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from OCP.BRep import BRep_Builder
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.Geom import (
    Geom_BSplineCurve,
    Geom_BSplineSurface,
    Geom_Circle,
    Geom_Curve,
    Geom_Line,
    Geom_Plane,
    Geom_Surface,
)
from OCP.Geom2d import Geom2d_BSplineCurve, Geom2d_Curve, Geom2d_Line
from OCP.gp import gp_Ax2, gp_Ax3, gp_Dir, gp_Dir2d, gp_Pnt, gp_Pnt2d
from OCP.TColgp import TColgp_Array1OfPnt, TColgp_Array1OfPnt2d, TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TopAbs import TopAbs_ShapeEnum, TopAbs_State
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Shape, TopoDS_Shell, TopoDS_Solid, TopoDS_Vertex, TopoDS_Wire

from aag_cad.errors import SolidError
from aag_cad.units import Floats

TIGHT = 1e-5
_BUILDER = BRep_Builder()
_HERE = TopLoc_Location()


def point(values: Floats) -> gp_Pnt:
    """Return a (3,) array as a point."""
    return gp_Pnt(*values.tolist())


def direction(values: Floats) -> gp_Dir:
    """Return a (3,) array as a direction."""
    return gp_Dir(*values.tolist())


def _filled(array: Any, values: Iterable[Any]) -> Any:
    """Return an array of the kernel, which counts from 1, with its values."""
    for i, value in enumerate(values, 1):
        array.SetValue(i, value)
    return array


def reals(values: Sequence[float]) -> TColStd_Array1OfReal:
    """Return numbers as an array of the kernel."""
    return _filled(TColStd_Array1OfReal(1, len(values)), values)


def whole(values: Sequence[int]) -> TColStd_Array1OfInteger:
    """Return whole numbers as an array of the kernel."""
    return _filled(TColStd_Array1OfInteger(1, len(values)), values)


def points_2d(values: Floats) -> TColgp_Array1OfPnt2d:
    """Return points (n, 2) as an array of the kernel."""
    return _filled(TColgp_Array1OfPnt2d(1, len(values)), (gp_Pnt2d(u, v) for u, v in values.tolist()))


def knots_of(degree: int, padded: Floats) -> tuple[TColStd_Array1OfReal, TColStd_Array1OfInteger]:
    """Return the distinct knots and their multiplicities from the full knot vector of a clamped spline."""
    knots = [float(padded[0]), *padded[degree + 1 : -degree - 1].tolist(), float(padded[-1])]
    return reals(knots), whole([degree + 1, *[1] * (len(knots) - 2), degree + 1])


def spline_curve(degree: int, padded: Floats, poles: Floats) -> Geom_BSplineCurve:
    """Return the clamped B-spline curve with the full knot vector and poles (n, 3)."""
    array = _filled(TColgp_Array1OfPnt(1, len(poles)), map(point, poles))
    return Geom_BSplineCurve(array, *knots_of(degree, padded), degree)


def spline_curve_2d(degree: int, padded: Floats, poles: Floats) -> Geom2d_BSplineCurve:
    """Return the clamped B-spline curve in a parameter plane with the full knot vector and poles (n, 2)."""
    return Geom2d_BSplineCurve(points_2d(poles), *knots_of(degree, padded), degree)


def spline_surface(degrees: tuple[int, int], padded: tuple[Floats, Floats], poles: Floats) -> Geom_BSplineSurface:
    """Return the clamped B-spline surface with the full knot vectors of both directions and poles (n, m, 3)."""
    array = TColgp_Array2OfPnt(1, len(poles), 1, poles.shape[1])
    for (i, j), pole in zip(np.ndindex(poles.shape[:2]), poles.reshape(-1, 3), strict=True):
        array.SetValue(i + 1, j + 1, point(pole))
    (u, u_times), (v, v_times) = (knots_of(*each) for each in zip(degrees, padded, strict=True))
    return Geom_BSplineSurface(array, u, v, u_times, v_times, *degrees)


def ruled_surface(degree: int, padded: Floats, first: Floats, second: Floats, width: float) -> Geom_BSplineSurface:
    """Return the ruled B-spline surface from one row of poles (n, 3) at v = 0 to another at v = width."""
    across = np.array([0.0, 0.0, width, width])
    return spline_surface((degree, 1), (padded, across), np.stack([first, second], axis=1))


def closed_curve_2d(knots: Floats, poles: Floats) -> Geom2d_BSplineCurve:
    """Return the periodic quintic B-spline in the parameter plane with single knots (n + 1,) and poles (n, 2)."""
    return Geom2d_BSplineCurve(points_2d(poles), reals(knots.tolist()), whole([1] * len(knots)), 5, True)


def line_2d(u: float, v: float, du: float, dv: float) -> Geom2d_Line:
    """Return the line in the parameter plane from (u, v) along (du, dv), by its own length."""
    return Geom2d_Line(gp_Pnt2d(u, v), gp_Dir2d(du, dv))


def plane(origin: Floats, normal: Floats, along: Floats) -> Geom_Plane:
    """Return the plane through a point with its normal and the direction of its first parameter."""
    return Geom_Plane(gp_Ax3(point(origin), direction(normal), direction(along)))


def vertex(position: Floats, tolerance: float = TIGHT) -> TopoDS_Vertex:
    """Return a vertex at a (3,) position."""
    made = TopoDS_Vertex()
    _BUILDER.MakeVertex(made, point(position), tolerance)
    return made


def edge(
    curve: Geom_Curve, low: float, high: float, start: TopoDS_Vertex, end: TopoDS_Vertex, tolerance: float = TIGHT
) -> TopoDS_Edge:
    """Return the edge on a curve between two parameters, from one vertex to another (the same one if closed)."""
    made = TopoDS_Edge()
    _BUILDER.MakeEdge(made, curve, tolerance)
    _BUILDER.Add(made, start)
    _BUILDER.Add(made, end.Reversed())
    _BUILDER.Range(made, low, high)
    return made


def line_edge(a: Floats, b: Floats, length: float, start: TopoDS_Vertex, end: TopoDS_Vertex) -> TopoDS_Edge:
    """Return the straight edge from a to b, (3,) each, by its own length."""
    return edge(Geom_Line(point(a), direction(b - a)), 0.0, length, start, end)


def circle(centre: Floats, axis: Floats, start: Floats, radius: float) -> Geom_Circle:
    """Return the circle about an axis whose parameter begins in the direction ``start``."""
    return Geom_Circle(gp_Ax2(point(centre), direction(axis), direction(start)), radius)


def lay_on(made: TopoDS_Edge, surface: Geom_Surface, curve: Geom2d_Curve, tolerance: float = TIGHT) -> None:
    """Give an edge its curve in the parameters of a surface."""
    _BUILDER.UpdateEdge(made, curve, surface, _HERE, tolerance)


def lay_as_seam(made: TopoDS_Edge, surface: Geom_Surface, forward: Geom2d_Curve, backward: Geom2d_Curve) -> None:
    """Give a seam edge its two curves in the parameters of a closed surface."""
    _BUILDER.UpdateEdge(made, forward, backward, surface, _HERE, TIGHT)


def wire(edges: Sequence[TopoDS_Edge]) -> TopoDS_Wire:
    """Return the closed wire of edges in their order."""
    made = TopoDS_Wire()
    _BUILDER.MakeWire(made)
    for one in edges:
        _BUILDER.Add(made, one)
    made.Closed(True)
    return made


def face(surface: Geom_Surface, wires: Sequence[TopoDS_Wire]) -> TopoDS_Face:
    """Return the face of a surface bounded by an outer wire and, after it, inner wires."""
    made = TopoDS_Face()
    _BUILDER.MakeFace(made, surface, TIGHT)
    for one in wires:
        _BUILDER.Add(made, one)
    return made


def solid(faces: Sequence[TopoDS_Face]) -> TopoDS_Solid:
    """Return the solid inside a closed set of faces that turn outwards."""
    shell, made = TopoDS_Shell(), TopoDS_Solid()
    _BUILDER.MakeShell(shell)
    for one in faces:
        _BUILDER.Add(shell, one)
    shell.Closed(True)
    _BUILDER.MakeSolid(made)
    _BUILDER.Add(made, shell)
    return made


def checked(shape: TopoDS_Solid, mark: str) -> TopoDS_Solid:
    """Return a solid that closes, is valid and turns its faces outwards; SolidError naming the mark if it does not."""
    if not BRepCheck_Analyzer(shape).IsValid():
        raise SolidError(
            f"{mark}: the solid is invalid: faces do not close or run into each other; check holes and ends"
        )
    outside = BRepClass3d_SolidClassifier(shape)
    outside.PerformInfinitePoint(TIGHT)
    if outside.State() != TopAbs_State.TopAbs_OUT:
        raise SolidError(f"{mark}: the solid is inside out: its faces turn inwards, its volume is negative")
    return shape


def the_solid(shape: TopoDS_Shape, mark: str) -> TopoDS_Solid:
    """Return the one solid in a shape, valid and outwards; SolidError naming the mark if there is not just one."""
    explorer = TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_SOLID)
    found = []
    while explorer.More():
        found.append(explorer.Current())
        explorer.Next()
    if len(found) != 1:
        raise SolidError(f"{mark}: {len(found)} solids came out where one is due; check its sizes and holes")
    return checked(found[0], mark)
