"""Solids of studs, bolts, screws and coupling blocks in the coordinates of their frames."""

import math

from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakePrism, BRepPrimAPI_MakeRevol
from OCP.gp import gp_Ax1, gp_Ax2, gp_Dir, gp_Pnt, gp_Vec
from OCP.TopoDS import TopoDS_Face, TopoDS_Shape, TopoDS_Solid

from aag_cad.parts.mesh import regular_polygon
from aag_cad.parts.model import Bolt, CouplingBlock, CrossSection, Screw, Stud
from aag_cad.solids.brep import the_solid
from aag_cad.solids.planks import drilled_box

_UP = gp_Dir(0.0, 0.0, 1.0)


def stud_solid(stud: Stud) -> TopoDS_Solid:
    """Return the hexagonal stud with its cross holes, centred on its frame; SolidError if a hole splits it."""
    shape = _hexagon(stud.across_flats, -stud.length / 2.0, stud.length / 2.0)
    for hole in stud.holes:
        along = gp_Dir(math.cos(hole.angle), math.sin(hole.angle), 0.0)
        reach = stud.across_flats
        start = gp_Pnt(-reach * along.X(), -reach * along.Y(), hole.height)
        drill = BRepPrimAPI_MakeCylinder(gp_Ax2(start, along), hole.diameter / 2.0, 2.0 * reach).Shape()
        shape = BRepAlgoAPI_Cut(shape, drill).Shape()
    return the_solid(shape, stud.mark)


def bolt_solid(bolt: Bolt) -> TopoDS_Solid:
    """Return head, washers, shank and nut of a bolt as one solid; z = 0 is the outer face of the first plank."""
    t, nut = bolt.washer_thickness, bolt.grip + bolt.washer_thickness
    tip = max(bolt.length - t, nut + bolt.nut_height)
    r, washer = bolt.diameter / 2.0, bolt.washer_diameter / 2.0
    washers_and_shank = [
        (0.0, -t), (washer, -t), (washer, 0.0), (r, 0.0),
        (r, bolt.grip), (washer, bolt.grip), (washer, nut), (r, nut), (r, tip), (0.0, tip),
    ]  # fmt: skip
    shape = BRepAlgoAPI_Fuse(_turned(washers_and_shank), _hexagon(bolt.across_flats, -t - bolt.head_height, -t)).Shape()
    shape = BRepAlgoAPI_Fuse(shape, _hexagon(bolt.across_flats, nut, nut + bolt.nut_height)).Shape()
    return the_solid(shape, bolt.mark)


def screw_solid(screw: Screw) -> TopoDS_Solid:
    """Return a screw with a head countersunk at 90 degrees, flush at z = 0, and a plain shank."""
    head, r = screw.head_diameter / 2.0, screw.diameter / 2.0
    return the_solid(
        _turned([(0.0, 0.0), (head, 0.0), (r, head - r), (r, screw.length), (0.0, screw.length)]), screw.mark
    )


def block_solid(block: CouplingBlock) -> TopoDS_Solid:
    """Return the coupling block, centred on its frame, with its holes along z; SolidError if one breaks out."""
    half, section = block.length / 2.0, CrossSection(block.width, block.thickness)
    return the_solid(drilled_box(-half, half, section, block.holes, block.mark), block.mark)


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
