"""Volumes of solids, and the straight blank of a plank as one, to test with."""

from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.TopoDS import TopoDS_Shape, TopoDS_Solid

from aag_cad.parts.model import FlatBar
from aag_cad.parts.shapes.box import Box
from aag_cad.solids import brep
from aag_cad.solids.planks import drilled_box


def signed_volume(shape: TopoDS_Shape, error: float = 1e-6) -> float:
    """Return the volume in mm3 to a relative error; negative where the faces turn inwards."""
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties, error)
    return float(properties.Mass())


def straight_blank(plank: FlatBar) -> TopoDS_Solid:
    """Return the straight drilled blank in blank coordinates (x along it from its start)."""
    blank, half = plank.blank, plank.blank.section.thickness / 2.0
    box = Box(blank.length, blank.section.width, -half, half, blank.holes)
    return brep.checked(drilled_box(box, 0.0, plank.mark), plank.mark)
