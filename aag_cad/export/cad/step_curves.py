"""STEP AP242 of a curve network: the surface as a B-spline face, each plank's line as a B-spline edge, by name."""

import os

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace
from OCP.Geom import Geom_BSplineCurve, Geom_BSplineSurface
from OCP.gp import gp_Pnt
from OCP.TColgp import TColgp_Array1OfPnt, TColgp_Array2OfPnt
from OCP.TCollection import TCollection_ExtendedString
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Shape
from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from aag_cad.export.cad.step_text import Header, kernel_settings, named, placement, step_bytes
from aag_cad.families import FAMILIES
from aag_cad.files import write_bytes
from aag_cad.network.model import CurveNetwork, NetworkCurve
from aag_cad.parts.marks import short_mark
from aag_cad.parts.members import curve_mark
from aag_cad.units import Floats
from aag_cad.web.interpolation import InterpolatedSurface

_TOLERANCE = 1e-6


def write_step_curves(
    network: CurveNetwork,
    surface: InterpolatedSurface | None,
    path: str | os.PathLike[str],
    header: Header | None = None,
) -> None:
    """Write a network in mm, in shell coordinates: an assembly with the surface, if given, and a group for each family.

    Edges run from ``start`` to ``end`` of their curve, by arc length, and are named ``A1-01`` and so on. Equal models
    give equal bytes. SolidError if the kernel refuses; FileError if the file cannot be written.
    """
    with kernel_settings():
        data = step_bytes(_document(network, surface), "curves", "Curves and surface of a gridshell", header)
    write_bytes(path, data)


def curve_edge(item: NetworkCurve) -> TopoDS_Edge:
    """Return the part of a network curve that its plank lies on."""
    spline = item.curve.point_spline
    poles = TColgp_Array1OfPnt(1, len(spline.c))
    for i, point in enumerate(np.asarray(spline.c, dtype=np.float64).tolist(), start=1):
        poles.SetValue(i, gp_Pnt(*point))
    knots, times = _knots(spline.t)
    curve = Geom_BSplineCurve(poles, knots, times, spline.k)
    return BRepBuilderAPI_MakeEdge(curve, item.start, item.end).Edge()


def surface_face(surface: InterpolatedSurface) -> TopoDS_Face:
    """Return the whole interpolated surface as one face."""
    rows, columns = surface.control.shape[:2]
    poles = TColgp_Array2OfPnt(1, rows, 1, columns)
    for i, row in enumerate(surface.control.tolist(), start=1):
        for j, point in enumerate(row, start=1):
            poles.SetValue(i, j, gp_Pnt(*point))
    (u, u_times), (v, v_times) = (_knots(knots) for knots in surface.knots)
    return BRepBuilderAPI_MakeFace(
        Geom_BSplineSurface(poles, u, v, u_times, v_times, surface.degrees[0], surface.degrees[1]), _TOLERANCE
    ).Face()


def _knots(knots: Floats) -> tuple[TColStd_Array1OfReal, TColStd_Array1OfInteger]:
    """Return distinct knots and their multiplicities, as the kernel keeps them."""
    distinct, counts = np.unique(knots, return_counts=True)
    values, times = TColStd_Array1OfReal(1, len(distinct)), TColStd_Array1OfInteger(1, len(distinct))
    for i, (knot, count) in enumerate(zip(distinct.tolist(), counts.tolist(), strict=True), start=1):
        values.SetValue(i, knot)
        times.SetValue(i, count)
    return values, times


def _document(network: CurveNetwork, surface: InterpolatedSurface | None) -> TDocStd_Document:
    document = TDocStd_Document(TCollection_ExtendedString("XmlOcaf"))
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    whole = _group(shapes, "Network")
    if surface is not None:
        _add(shapes, whole, surface_face(surface), "Surface")
    for family in FAMILIES:
        items = sorted((item for item in network.curves if item.id.family == family), key=lambda item: item.id)
        if not items:
            continue
        group = _group(shapes, family)
        for item in items:
            _add(shapes, group, curve_edge(item), short_mark(curve_mark(1, item.id)))
        named(shapes.AddComponent(whole, group, placement(None)), family)
    shapes.UpdateAssemblies()
    return document


def _group(shapes: XCAFDoc_ShapeTool, name: str) -> TDF_Label:
    label = shapes.NewShape()
    named(label, name)
    return label


def _add(shapes: XCAFDoc_ShapeTool, parent: TDF_Label, shape: TopoDS_Shape, name: str) -> None:
    label = shapes.AddShape(shape, False, False)
    named(label, name)
    named(shapes.AddComponent(parent, label, placement(None)), name)
