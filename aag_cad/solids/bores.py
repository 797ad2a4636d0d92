"""Where the drilled holes of a formed plank meet its wide faces."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline
from scipy.linalg import circulant

from aag_cad.errors import SolidError
from aag_cad.geometry.surface import unit
from aag_cad.parts.forms import Hole
from aag_cad.parts.model import FlatBar
from aag_cad.solids import brep
from aag_cad.solids.board import Bore
from aag_cad.units import Floats

_LOOP_SAMPLES = 12
_LOOP_ERROR = 1e-5
_NEWTON_STEPS = 10
_NEWTON_LIMIT = 1e-9


@dataclass(frozen=True, eq=False)
class _Ruled:
    """The ruled surface middle(x) + y across(x) of a plank at one height through its thickness."""

    middle: BSpline
    across: BSpline

    def points(self, x: Floats, y: Floats) -> Floats:
        """Return the points (..., 3) at stations and offsets (...)."""
        return np.asarray(self.middle(x) + y[..., None] * self.across(x))

    def along(self, x: Floats, y: Floats) -> Floats:
        """Return the derivatives (..., 3) by the station."""
        return np.asarray(self.middle(x, nu=1) + y[..., None] * self.across(x, nu=1))


@dataclass(frozen=True, eq=False)
class _Drill:
    """All holes of a plank: stations, offsets, radii (n,), centres (n, 3) and frames (n, 3, 3) of rows x, y, axis."""

    x: Floats
    y: Floats
    radius: Floats
    centre: Floats
    frame: Floats


def require_inside(mark: str, hole: Hole, inside: bool) -> None:
    """Raise SolidError naming the mark and the hole unless the hole lies inside the faces that it goes through."""
    if not inside:
        raise SolidError(
            f"{mark}: the hole of {hole.diameter:g} mm for {hole.joint or 'no joint'} at {hole.station:.1f} mm, offset "
            f"{hole.offset:.1f} mm, breaks through an edge; move it inwards"
        )


def formed_bores(plank: FlatBar, edges: BSpline) -> list[Bore]:
    """Return the holes of a formed plank whose long edges are a spline into (4, 3); SolidError if one breaks out.

    On each wide face the loop where the cylinder meets it is found by Newton's method; the rim is the circle at the
    mean height of that loop.
    """
    if not plank.blank.holes:
        return []
    width, poles = plank.blank.section.width, edges.c
    middle = _ruled(edges, (poles[:, 0] + poles[:, 3]) / 2.0, (poles[:, 1] + poles[:, 2]) / 2.0, width)
    drill = _drill(plank.blank.holes, middle)
    angles = np.linspace(0.0, 2.0 * math.pi, _LOOP_SAMPLES + 1)
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    lower = _loops(_ruled(edges, poles[:, 0], poles[:, 1], width), drill, circle)
    upper = _loops(_ruled(edges, poles[:, 3], poles[:, 2], width), drill, circle)
    loops = np.stack([lower, upper], axis=1)
    x, y, height = np.moveaxis(loops, -1, 0)
    inside = (x > 0.0) & (x < plank.blank.length) & (np.abs(y) < width / 2.0)
    for hole, fits in zip(plank.blank.holes, inside.all(axis=(1, 2)), strict=True):
        require_inside(plank.mark, hole, bool(fits))
    level = height[..., :-1].mean(axis=-1)
    # A loop goes up and down twice a turn, so that samples may pass its highest point by half a step.
    between = math.cos(2.0 * math.pi / _LOOP_SAMPLES)
    off = np.abs(height - level[..., None]).max(axis=(1, 2)) / between + _LOOP_ERROR * drill.radius
    parameters = np.stack([x, width / 2.0 + np.array([[-1.0], [1.0]]) * y], axis=-1)
    poles_2d = _closed_poles(parameters[:, :, :-1])
    return [
        Bore(
            centre=drill.centre[i],
            start=drill.frame[i, 0],
            axis=drill.frame[i, 2],
            radius=float(drill.radius[i]),
            heights=(float(level[i, 0]), float(level[i, 1])),
            loops=(brep.closed_curve_2d(angles, poles_2d[i, 0]), brep.closed_curve_2d(angles, poles_2d[i, 1])),
            tolerance=float(off[i]),
        )
        for i in range(len(plank.blank.holes))
    ]


def _ruled(edges: BSpline, left: Floats, right: Floats, width: float) -> _Ruled:
    """Return the ruled surface between two curves given by their poles (n, 3) over the knots of the long edges."""
    return _Ruled(BSpline(edges.t, (left + right) / 2.0, edges.k), BSpline(edges.t, (right - left) / width, edges.k))


def _drill(holes: tuple[Hole, ...], middle: _Ruled) -> _Drill:
    """Return the holes at a right angle to the plank where they sit.

    On a twisted plank that differs from the thickness direction of the centre line by offset times twist; only so do
    the rims come out as circles.
    """
    x, y = np.array([hole.station for hole in holes]), np.array([hole.offset for hole in holes])
    along, across = unit(middle.along(x, y)), middle.across(x)
    axis = unit(np.cross(along, across))
    frame = np.stack([along, np.cross(axis, along), axis], axis=1)
    return _Drill(x, y, np.array([hole.diameter / 2.0 for hole in holes]), middle.points(x, y), frame)


def _loops(face: _Ruled, drill: _Drill, circle: Floats) -> Floats:
    """Return where the holes meet a face, (n, angles, 3): station, offset, and height over the hole's centre."""
    target = drill.radius[:, None, None] * circle
    x, y = drill.x[:, None] + target[..., 0], drill.y[:, None] + target[..., 1]
    for _ in range(_NEWTON_STEPS):
        local = np.einsum("hij,haj->hai", drill.frame, face.points(x, y) - drill.centre[:, None])
        slopes = np.stack([face.along(x, y), face.across(x)], axis=-1)
        matrix = drill.frame[:, None, :2] @ slopes
        step = np.linalg.solve(matrix, (target - local[..., :2])[..., None])[..., 0]
        if np.abs(step).max() < _NEWTON_LIMIT:
            break
        x, y = x + step[..., 0], y + step[..., 1]
    return np.stack([x, y, local[..., 2]], axis=-1)


def _closed_poles(values: Floats) -> Floats:
    """Return the poles (..., n, 2) of the uniform periodic quintic splines through values (..., n, 2)."""
    row = np.zeros(values.shape[-2])
    row[[-2, -1, 0, 1, 2]] = np.array([1.0, 26.0, 66.0, 26.0, 1.0]) / 120.0
    return np.roll(np.linalg.solve(circulant(row), values), 2, axis=-2)
