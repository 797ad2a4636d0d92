"""Between the straight blank and the formed plank: one map and its inverse."""

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from aag_cad.geometry.framed import Frames, frames_at, nearest_station
from aag_cad.geometry.surface import dot
from aag_cad.parts.model import FlatBar
from aag_cad.units import Floats

CORNER_DEGREE = 5


def plank_axes(plank: FlatBar, stations: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return centre points, length, width and thickness directions at stations; each (n, 3), a right-handed frame.

    An upright plank turns its width to the surface normal, a flat one its thickness; so does every metal bar.
    """
    frames: Frames = frames_at(plank.curve, stations)
    if plank.upright:
        return frames.point, frames.tangent, frames.normal, -frames.binormal
    return frames.point, frames.tangent, frames.binormal, frames.normal


def section_corners(bar: FlatBar) -> Floats:
    """Return the corners (4, 2) of a section across width and thickness, counter-clockwise, (-, -) first."""
    y, z = bar.blank.section.width / 2.0, bar.blank.section.thickness / 2.0
    return np.array([(-y, -z), (y, -z), (y, z), (-y, z)])


def corner_splines(bar: FlatBar) -> BSpline:
    """Return the four long edges of a formed bar as one quintic spline into (4, 3) by the length of its centre line.

    They are interpolated at the samples of the centre line, so that their mean is the centre line itself.
    """
    stations = bar.curve.stations
    blank = np.column_stack([np.repeat(stations, 4), np.tile(section_corners(bar), (len(stations), 1))])
    return make_interp_spline(stations, formed_points(bar, blank).reshape(-1, 4, 3), k=CORNER_DEGREE)


def formed_points(plank: FlatBar, blank_points: Floats) -> Floats:
    """Return where the points (n, 3) of the straight blank go when the plank is bent and twisted into place, (n, 3)."""
    point, _tangent, width, thickness = plank_axes(plank, blank_points[:, 0])
    return point + blank_points[:, 1:2] * width + blank_points[:, 2:3] * thickness


def blank_points(plank: FlatBar, points: Floats) -> Floats:
    """Return the coordinates (n, 3) in the straight blank of points (n, 3) near the formed plank."""
    stations = nearest_station(plank.curve, points)
    centre, _tangent, width, thickness = plank_axes(plank, stations)
    gap = points - centre
    return np.column_stack([stations, dot(gap, width), dot(gap, thickness)])


def axis_piercings(plank: FlatBar, origins: Floats, directions: Floats) -> Floats:
    """Return the blank coordinates (n, 2) where straight axes (n, 3) pierce the middle surface of the formed plank.

    The origins must lie near the plank. This is what makes siblings differ: the bolt is straight in space, and each
    plank is drilled where the bolt meets it.
    """
    points = origins.astype(float)
    for _ in range(8):
        coordinates = blank_points(plank, points)
        _point, _tangent, _width, thickness = plank_axes(plank, coordinates[:, 0])
        step = coordinates[:, 2] / dot(directions, thickness)
        points = points - step[:, None] * directions
        if np.all(np.abs(step) < 1e-9):
            break
    return blank_points(plank, points)[:, :2]
