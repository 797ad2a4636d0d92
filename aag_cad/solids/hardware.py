"""Solids of prisms, threaded fasteners, boxes and folded plates in the coordinates of their frames."""

import math

from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakePrism, BRepPrimAPI_MakeRevol
from OCP.gp import gp_Ax1, gp_Ax2, gp_Dir, gp_Pnt, gp_Vec
from OCP.TopoDS import TopoDS_Face, TopoDS_Shape, TopoDS_Solid

from aag_cad.parts.forms import FoldedPlate
from aag_cad.parts.model import Stud
from aag_cad.parts.shapes.box import Box
from aag_cad.parts.shapes.folded_plate import hole_axes, plate_rings
from aag_cad.parts.shapes.threaded import Threaded
from aag_cad.parts.triangles import regular_polygon
from aag_cad.solids.brep import the_solid
from aag_cad.solids.planks import drilled_box

_UP = gp_Dir(0.0, 0.0, 1.0)


def prism_solid(stud: Stud, mark: str) -> TopoDS_Solid:
    """Return the hexagonal stud with its cross holes, centred on its frame; SolidError if a hole splits it."""
    shape = _hexagon(stud.across_flats, -stud.length / 2.0, stud.length / 2.0)
    for hole in stud.holes:
        along = gp_Dir(math.cos(hole.angle), math.sin(hole.angle), 0.0)
        reach = stud.across_flats
        start = gp_Pnt(-reach * along.X(), -reach * along.Y(), hole.height)
        drill = BRepPrimAPI_MakeCylinder(gp_Ax2(start, along), hole.diameter / 2.0, 2.0 * reach).Shape()
        shape = BRepAlgoAPI_Cut(shape, drill).Shape()
    return the_solid(shape, mark)


def threaded_solid(form: Threaded, mark: str) -> TopoDS_Solid:
    """Return the pieces of a fastener as one solid: the round ones turned in one go, then the hexagons.

    A head is countersunk at 90 degrees. SolidError with the mark if the solid comes out invalid.
    """
    profile = [(0.0, form.pieces[0].low)]
    for piece in form.pieces:
        radius = (form.diameter if piece.hexagonal else piece.size) / 2.0
        if piece.countersunk:
            head = piece.countersunk / 2.0
            profile += [(head, piece.low), (radius, piece.low + head - radius)]
        elif radius != profile[-1][0]:
            profile.append((radius, piece.low))
        else:
            profile.pop()
        profile.append((radius, piece.high))
    shape = _turned([*profile, (0.0, form.pieces[-1].high)])
    for piece in form.pieces:
        if piece.hexagonal:
            shape = BRepAlgoAPI_Fuse(shape, _hexagon(piece.size, piece.low, piece.high)).Shape()
    return the_solid(shape, mark)


def box_solid(box: Box, mark: str) -> TopoDS_Solid:
    """Return a box with its holes along z; SolidError with the mark if one breaks out."""
    if box.holes or box.low == -box.high:
        return the_solid(drilled_box(box, -box.length / 2.0, mark), mark)
    x, y = box.length / 2.0, box.width / 2.0
    base = _outline([gp_Pnt(*corner, box.low) for corner in ((-x, -y), (x, -y), (x, y), (-x, y))])
    return the_solid(BRepPrimAPI_MakePrism(base, gp_Vec(0.0, 0.0, box.thickness)).Shape(), mark)


def folded_plate_solid(plate: FoldedPlate, mark: str) -> TopoDS_Solid:
    """Return a folded plate with its holes; SolidError with the mark if it comes out invalid."""
    rings = plate_rings(plate)
    outline = [*rings[:, 0], *rings[::-1, 3]]
    base = _outline([gp_Pnt(*corner.tolist()) for corner in outline])
    shape = BRepPrimAPI_MakePrism(base, gp_Vec(0.0, plate.width, 0.0)).Shape()
    reach = 2.0 * plate.thickness
    for hole, centre, axis in zip(plate.holes, *hole_axes(plate), strict=True):
        start = gp_Pnt(*(centre - reach / 2.0 * axis).tolist())
        drill = BRepPrimAPI_MakeCylinder(gp_Ax2(start, gp_Dir(*axis.tolist())), hole.diameter / 2.0, reach).Shape()
        shape = BRepAlgoAPI_Cut(shape, drill).Shape()
    return the_solid(shape, mark)


def _outline(points: list[gp_Pnt]) -> TopoDS_Face:
    polygon = BRepBuilderAPI_MakePolygon()
    for corner in points:
        polygon.Add(corner)
    polygon.Close()
    return BRepBuilderAPI_MakeFace(polygon.Wire()).Face()


def _hexagon(across_flats: float, low: float, high: float) -> TopoDS_Shape:
    base = _outline([gp_Pnt(x, y, low) for x, y in regular_polygon(6, across_flats).tolist()])
    return BRepPrimAPI_MakePrism(base, gp_Vec(0.0, 0.0, high - low)).Shape()


def _turned(profile: list[tuple[float, float]]) -> TopoDS_Shape:
    """Return the solid of revolution about z of a profile of (radius, height)."""
    face = _outline([gp_Pnt(radius, 0.0, height) for radius, height in profile])
    return BRepPrimAPI_MakeRevol(face, gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), _UP), 2.0 * math.pi).Shape()
