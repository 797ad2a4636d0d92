"""The view square on to a shell from outside: its axes on paper, and how far along the shell something lies."""

from dataclasses import dataclass

import numpy as np

from aag_cad.families import EDGES
from aag_cad.geometry.surface import unit
from aag_cad.parts.marks import parse_mark
from aag_cad.parts.model import Shell
from aag_cad.units import Floats

_UPRIGHT = 1e-3
_ONE_LINE = 1e-9
# The cosine of 45 degrees.
_STEEP = 0.7071
_NOT_TIMBER = ("footing", "cover")


@dataclass(frozen=True, eq=False)
class View:
    """Directions of the paper in space: right, up and towards the viewer, (3, 3) float with one axis a row."""

    axes: Floats

    def __call__(self, points: Floats) -> Floats:
        """Return points (n, 3) as (right, up, towards the viewer), (n, 3) mm."""
        return np.asarray(points @ self.axes.T)


def shell_view(shell: Shell) -> View:
    """Return the view against the mean outward normal of a shell's timber joints, with the foot at the bottom."""
    timber = [joint.normal for joint in shell.joints if joint.kind not in _NOT_TIMBER]
    towards = unit(np.mean(timber, axis=0))
    vertical = np.array([0.0, 0.0, 1.0])
    up = vertical - (vertical @ towards) * towards
    if float(np.linalg.norm(up)) < _UPRIGHT:
        up = np.array([0.0, 1.0, 0.0]) - towards[1] * towards
    up = unit(up)
    return View(np.array([np.cross(up, towards), up, towards]))


def sweep_direction(shell: Shell) -> Floats:
    """Return the direction (3,) across a shell in which its flat planks are numbered."""
    right: Floats = shell_view(shell).axes[0]
    flat = [plank for plank in shell.planks if not plank.upright and plank.family not in EDGES]
    if len(flat) < 2:
        return right
    across = np.array([plank.curve.point_spline(plank.curve.length / 2.0) @ right for plank in flat])
    number = np.array([parse_mark(plank.mark).index for plank in flat])
    falling = float((across - across.mean()) @ (number - number.mean())) < 0.0
    return -right if falling else right


def elevation_view(shell: Shell) -> View:
    """Return the horizontal view along a shell, its foot to the left."""
    across = shell_view(shell).axes[0]
    vertical = np.array([0.0, 0.0, 1.0])
    inwards = np.cross(vertical, across)
    return View(np.array([inwards, vertical, np.cross(inwards, vertical)]))


def vault_view() -> View:
    """Return the plan: seen from above, x to the right and y up the sheet."""
    return View(np.eye(3))


def floor_view(points: Floats) -> View:
    """Return the view square on to the floor that points (n, 3) lie on: the plan, unless they lie on a steep plane."""
    axes = best_plane(points)
    return View(axes) if axes[2, 2] < _STEEP else vault_view()


def best_plane(points: Floats) -> Floats:
    """Return the axes of the plane nearest to points (n, 3): right, up and outward, (3, 3) with one axis a row.

    The plane is level if that fits as well as any; up is then y, and else the vertical as seen in the plane.
    """
    centred = points - points.mean(axis=0) if len(points) else points
    spread = centred.T @ centred
    sizes, axes = np.linalg.eigh(spread)
    level = spread[2, 2] - sizes[0] <= _ONE_LINE * sizes[2]
    normal = np.array([0.0, 0.0, 1.0]) if level else axes[:, 0]
    normal *= np.sign(next(part for part in normal[::-1] if abs(part) > _ONE_LINE))
    upright = np.array([0.0, 1.0, 0.0]) if 1.0 - normal[2] ** 2 < _ONE_LINE else np.array([0.0, 0.0, 1.0])
    up = upright - (upright @ normal) * normal
    up /= np.linalg.norm(up)
    return np.array([np.cross(up, normal), up, normal])
