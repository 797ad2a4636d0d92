"""Bars: planks and flat bars of metal, bent and twisted out of a straight blank."""

import math

import numpy as np
from scipy.spatial import cKDTree

from aag_cad.geometry.surface import dot
from aag_cad.parts.forming import blank_points, formed_points, plank_axes, section_corners
from aag_cad.parts.model import FlatBar
from aag_cad.parts.shapes.box import box_points
from aag_cad.parts.shapes.shape import Shape
from aag_cad.parts.triangles import Mesh, circle_area, tube
from aag_cad.units import Floats

MESH_SPACING = 120.0


def bar_rings(bar: FlatBar, count: int) -> Floats:
    """Return the four corners of a formed plank or bar at ``count`` even stations, (count, 4, 3)."""
    corners = section_corners(bar)
    stations = np.repeat(np.linspace(0.0, bar.blank.length, count), 4)
    return formed_points(bar, np.column_stack([stations, np.tile(corners, (count, 1))])).reshape(count, 4, 3)


def plank_mesh(bar: FlatBar, spacing: float = MESH_SPACING) -> Mesh:
    """Return the formed plank or bar without its holes, with a ring of four corners about every ``spacing`` mm."""
    return tube(bar_rings(bar, max(2, math.ceil(bar.blank.length / spacing) + 1)))


def _sizes(bar: FlatBar) -> tuple[float, float, float]:
    return bar.blank.length, bar.blank.section.width, bar.blank.section.thickness


def _section(bar: FlatBar) -> float:
    return bar.blank.section.width * bar.blank.section.thickness


def _volume(bar: FlatBar) -> float:
    """Return the volume less the holes: the centre line of a bent and twisted bar runs through its section's centroid.

    End cuts turn about the ends of the centre line and so leave the volume alone.
    """
    bored = sum(circle_area(hole.diameter) + hole.slot * hole.diameter for hole in bar.blank.holes)
    return _section(bar) * bar.blank.length - bar.blank.section.thickness * bored


def _points(bar: FlatBar) -> Floats:
    return formed_points(bar, box_points(*_sizes(bar)) + np.array([bar.blank.length / 2.0, 0.0, 0.0]))


def _blank_depths(bar: FlatBar, blank: Floats) -> Floats:
    """Return how deep points (n, 3) of the straight blank's coordinates lie inside it, (n,)."""
    (x, y, z), section = blank.T, bar.blank.section
    sides = [x, bar.blank.length - x, section.width / 2.0 - np.abs(y), section.thickness / 2.0 - np.abs(z)]
    return np.asarray(np.minimum.reduce(sides))


def _rough_depths(bar: FlatBar, points: Floats) -> tuple[Floats, float]:
    """Return depths (n,) in the straight bar that touches a formed one at the nearest sample, and their error, mm.

    Points farther from the curve than the section reaches get minus infinity. Between two samples the bar turns by the
    angle between their frames; half of it acts over the reach at most, so that the whole of it is on the safe side.
    """
    stations, section = bar.curve.stations, bar.blank.section
    away, nearest = cKDTree(bar.curve.points).query(points)
    reach = float(np.hypot(np.diff(stations).max() / 2.0, np.hypot(section.width, section.thickness) / 2.0))
    centre, *axes = plank_axes(bar, stations)
    turn = max(float(np.linalg.norm(np.diff(axis, axis=0), axis=1).max()) for axis in axes)
    depths = np.full(len(points), -np.inf)
    near = np.flatnonzero(away <= reach)
    at = np.asarray(nearest)[near]
    gap = points[near] - centre[at]
    x, y, z = (dot(gap, axis[at]) for axis in axes)
    depths[near] = _blank_depths(bar, np.column_stack([stations[at] + x, y, z]))
    return depths, reach * turn


def _bar_depths(bar: FlatBar, points: Floats) -> Floats:
    """Return depths in a formed bar; those of points that are surely outside are rough."""
    depths, error = _rough_depths(bar, points)
    near = depths > -error
    if near.any():
        depths[near] = _blank_depths(bar, blank_points(bar, points[near]))
    return depths


BAR = Shape[FlatBar](
    name="bar",
    sizes=_sizes,
    section=_section,
    volume=_volume,
    mesh=plank_mesh,
    points=_points,
    depths=_bar_depths,
    holes=lambda bar: bar.blank.holes,
    lines=lambda bar: (bar.curve,),
)
