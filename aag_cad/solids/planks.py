"""Solids of a plank: formed in its place in the shell, and as the straight drilled blank."""

import numpy as np
from OCP.Geom import Geom_Line
from OCP.TopoDS import TopoDS_Solid
from scipy.interpolate import BSpline

from aag_cad.errors import SolidError
from aag_cad.parts.forming import CORNER_DEGREE, corner_splines, plank_axes
from aag_cad.parts.model import FlatBar
from aag_cad.parts.shapes.box import Box
from aag_cad.solids import brep
from aag_cad.solids.board import Bore, Skin, drilled_board
from aag_cad.solids.bores import formed_bores, require_inside
from aag_cad.units import Floats


def formed_plank(plank: FlatBar) -> TopoDS_Solid:
    """Return the bent, twisted and drilled plank or bar in the coordinates of its shell; SolidError if it is invalid.

    Its long edges are quintic splines by the arc length of the centre line, its faces ruled between them; a hole is a
    cylinder along the local thickness direction, with circular rims.
    """
    _require_square_ends(plank)
    spline = corner_splines(plank)
    bores = formed_bores(plank, spline)
    _point, tangents, widths, _thickness = plank_axes(plank, np.array([0.0, plank.blank.length]))
    corners = np.asarray(spline(np.array([0.0, plank.blank.length])))
    ends = (
        brep.plane(corners[0].mean(axis=0), -tangents[0], widths[0]),
        brep.plane(corners[1].mean(axis=0), tangents[1], widths[1]),
    )
    return brep.checked(drilled_board(_formed_skin(plank, spline, corners), ends, bores), plank.mark)


def drilled_box(box: Box, start: float, mark: str) -> TopoDS_Solid:
    """Return a box along x from ``start`` with its holes; SolidError names the mark if a hole breaks out."""
    y, end = box.width / 2.0, start + box.length
    for hole in box.holes:
        r = hole.diameter / 2.0
        require_inside(mark, hole, hole.station - r > start and hole.station + r < end and abs(hole.offset) + r < y)
    ring = np.array([(-y, box.low), (y, box.low), (y, box.high), (-y, box.high)])
    corners = np.array([np.column_stack([np.full(4, x), ring]) for x in (start, end)])
    x_axis, y_axis, z_axis = np.eye(3)
    outward = (-z_axis, y_axis, z_axis, -y_axis)
    skin = Skin(
        corners=corners,
        curves=[Geom_Line(brep.point(corner), brep.direction(x_axis)) for corner in corners[0]],
        surfaces=[brep.plane(corners[0, j], outward[j], x_axis) for j in range(4)],
        length=box.length,
        sides=_sides(box.width, box.thickness),
        flat=True,
    )
    ends = brep.plane(start * x_axis, -x_axis, y_axis), brep.plane(end * x_axis, x_axis, y_axis)
    through = box.low, box.high
    bores = [
        Bore(np.array([h.station, h.offset, 0.0]), x_axis, z_axis, h.diameter / 2.0, through, None, brep.TIGHT)
        for h in box.holes
    ]
    return drilled_board(skin, ends, bores)


def _require_square_ends(plank: FlatBar) -> None:
    for cut in (plank.blank.start_cut, plank.blank.end_cut):
        if cut.angle_deg != 90.0:
            raise SolidError(
                f"{plank.mark}: an end is cut at {cut.angle_deg:g} degrees; solids have square ends only (90)"
            )


def _sides(width: float, thickness: float) -> tuple[float, float, float, float]:
    return width, thickness, width, thickness


def _formed_skin(plank: FlatBar, spline: BSpline, corners: Floats) -> Skin:
    sides, poles = _sides(plank.blank.section.width, plank.blank.section.thickness), spline.c
    return Skin(
        corners=corners,
        curves=[brep.spline_curve(CORNER_DEGREE, spline.t, poles[:, j]) for j in range(4)],
        surfaces=[
            brep.ruled_surface(CORNER_DEGREE, spline.t, poles[:, (j + 1) % 4], poles[:, j], sides[j]) for j in range(4)
        ],
        length=plank.blank.length,
        sides=sides,
        flat=False,
    )
