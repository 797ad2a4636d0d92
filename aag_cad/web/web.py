"""The discrete web: a grid of vertices whose columns are geodesics and whose diagonals are asymptotic."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from aag_cad.geometry.surface import Surface
from aag_cad.units import Floats


@dataclass(frozen=True, eq=False)
class Web:
    """Vertices (rows, columns, 3) in mm: columns are G lines, both diagonals of the grid are A lines."""

    vertices: Floats


def sampled_web(chart: Surface, s: Floats, theta: Floats) -> Web:
    """Return the web of a smooth chart at the grid s (rows,) x theta (columns,) of equal steps.

    Its stars are planar to O(step^3) and its angles constant to O(step^2).
    """
    grid_s, grid_theta = np.meshgrid(s, theta, indexing="ij")
    points = chart.jet(grid_s.ravel(), grid_theta.ravel()).point
    return Web(points.reshape(len(s), len(theta), 3))


def crpc_rings(neck_radius: float, ratio: float, step: float, count: int) -> Floats:
    """Return the rings (count + 1, 2) of (radius, height) of the exact discrete CRPC web, from the neck upwards.

    ``step`` is the half-step of rotation between rings. Neighbouring rings keep every star planar, because
    (r_{m+1} c, z_{m+1}) lies on the line through (r_{m-1} c, z_{m-1}) and (r_m, z_m) with c = cos(step), and keep the
    angle between the A lines, t1.t2 = cos(2 arctan sqrt(ratio)).
    """
    cos, tan = math.cos(step), math.tan(step)
    half_angle = math.atan(math.sqrt(ratio))
    first = neck_radius / cos
    rings = [(neck_radius, 0.0), (first, first * math.sin(step) / math.tan(half_angle))]

    def angle_error(factor: float, previous: tuple[float, float], ring: tuple[float, float]) -> float:
        rise = np.array([ring[0] - previous[0] * cos, ring[1] - previous[1]])
        ahead = factor * rise
        side_up = tan * (ring[0] + ahead[0])
        side_down = tan * previous[0] * cos
        up, down = np.array([*ahead, side_up]), np.array([*-rise, -side_down])
        tangent = up / np.linalg.norm(up) - down / np.linalg.norm(down)
        return float(math.atan2(tangent[2], math.hypot(tangent[0], tangent[1])) - half_angle)

    while len(rings) <= count:
        previous, ring = rings[-2], rings[-1]
        factor = float(brentq(angle_error, 0.2, 5.0, args=(previous, ring), xtol=1e-15, rtol=1e-15))
        radius = (ring[0] + factor * (ring[0] - previous[0] * cos)) / cos
        rings.append((radius, ring[1] + factor * (ring[1] - previous[1])))
    return np.array(rings[: count + 1])


def crpc_web(neck_radius: float, ratio: float, axis_x: float, theta: Floats, rows_below: int, rows_above: int) -> Web:
    """Return the exact discrete AAG web of a CRPC surface over columns theta (n,) of equal steps.

    The rows run from ``rows_below`` under the neck, where the web is the mirror image, to ``rows_above`` over it.
    """
    step = float(theta[1] - theta[0])
    rings = crpc_rings(neck_radius, ratio, step, max(rows_below, rows_above))
    below = rings[1 : rows_below + 1][::-1] * np.array([1.0, -1.0])
    r, z = np.concatenate([below, rings[: rows_above + 1]]).T
    vertices = np.stack(
        [
            axis_x + np.multiply.outer(r, np.cos(theta)),
            np.multiply.outer(r, np.sin(theta)),
            np.repeat(z[:, None], len(theta), axis=1),
        ],
        axis=-1,
    )
    return Web(vertices)
