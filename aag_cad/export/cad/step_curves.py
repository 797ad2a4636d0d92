"""STEP AP242 of a curve network: the surface as a B-spline face, each plank's line as a B-spline edge, by name."""

import os

from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face, TopoDS_Shape
from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from aag_cad.export.cad.step_text import kernel_settings, named, placement, step_bytes
from aag_cad.families import FAMILIES
from aag_cad.files import write_bytes
from aag_cad.network.model import CurveNetwork, NetworkCurve
from aag_cad.parts.marks import short_mark
from aag_cad.parts.members import curve_mark
from aag_cad.solids import brep
from aag_cad.web.interpolation import InterpolatedSurface

_TOLERANCE = 1e-6


def write_step_curves(network: CurveNetwork, surface: InterpolatedSurface | None, path: str | os.PathLike[str]) -> None:
    """Write a network in mm, in shell coordinates: an assembly with the surface, if given, and a group for each family.

    Edges run from ``start`` to ``end`` of their curve, by arc length, and are named ``A1-01`` and so on. Equal models
    give equal bytes. SolidError if the kernel refuses; FileError if the file cannot be written.
    """
    with kernel_settings():
        data = step_bytes(_document(network, surface), "curves", "Curves and surface of a gridshell")
    write_bytes(path, data)


def curve_edge(item: NetworkCurve) -> TopoDS_Edge:
    """Return the part of a network curve that its plank lies on."""
    spline = item.curve.point_spline
    curve = brep.spline_curve(spline.k, spline.t, spline.c)
    return BRepBuilderAPI_MakeEdge(curve, item.start, item.end).Edge()


def surface_face(surface: InterpolatedSurface) -> TopoDS_Face:
    """Return the whole interpolated surface as one face."""
    made = brep.spline_surface(surface.degrees, surface.knots, surface.control)
    return BRepBuilderAPI_MakeFace(made, _TOLERANCE).Face()


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
