"""Between the straight blank and the formed plank: one map and its inverse."""

import numpy as np

from aag_cad.geometry.framed import Frames, frames_at, nearest_station
from aag_cad.geometry.surface import dot
from aag_cad.parts.model import Plank
from aag_cad.units import Floats


def plank_axes(plank: Plank, stations: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return centre points, length, width and thickness directions at stations; each (n, 3), a right-handed frame.

    An upright plank turns its width to the surface normal, a flat one its thickness.
    """
    frames: Frames = frames_at(plank.curve, stations)
    if plank.upright:
        return frames.point, frames.tangent, frames.normal, -frames.binormal
    return frames.point, frames.tangent, frames.binormal, frames.normal


def formed_points(plank: Plank, blank_points: Floats) -> Floats:
    """Return where the points (n, 3) of the straight blank go when the plank is bent and twisted into place, (n, 3)."""
    point, _tangent, width, thickness = plank_axes(plank, blank_points[:, 0])
    return point + blank_points[:, 1:2] * width + blank_points[:, 2:3] * thickness


def blank_points(plank: Plank, points: Floats) -> Floats:
    """Return the coordinates (n, 3) in the straight blank of points (n, 3) near the formed plank."""
    samples = plank.curve.points
    nearest = np.argmin(np.linalg.norm(points[:, None, :] - samples[None, :, :], axis=2), axis=1)
    stations = nearest_station(plank.curve, points, plank.curve.stations[nearest])
    centre, _tangent, width, thickness = plank_axes(plank, stations)
    gap = points - centre
    return np.column_stack([stations, dot(gap, width), dot(gap, thickness)])
