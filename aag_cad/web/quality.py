"""How good a discrete web is: planarity, geodesics, angles, checkerboard, extent, curvature."""

from dataclasses import dataclass

import numpy as np

from aag_cad.geometry.surface import unit
from aag_cad.units import MM_PER_M, Floats
from aag_cad.web.web import Web


@dataclass(frozen=True)
class Span:
    """Smallest, mean and largest value of a measure."""

    min: float
    mean: float
    max: float


@dataclass(frozen=True)
class WebQuality:
    """Measures over the interior vertices of a web; angles between lines in degrees, lengths in mm."""

    vertices: int
    planarity_per_edge: float
    geodesic_deviation_deg: float
    angle_aa_deg: Span
    angle_ag_deg: Span
    parity_per_edge: float
    extent: tuple[float, float, float]
    normal_turning_deg: float
    smallest_radius_a: float
    smallest_radius_g: float
    largest_twist_deg_per_m: float


def _angle(a: Floats, b: Floats) -> Floats:
    """Angle between directions, radians, exact also where they are nearly parallel."""
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1)))


def _between_lines(a: Floats, b: Floats) -> Floats:
    angle = _angle(a, b)
    return np.degrees(np.minimum(angle, np.pi - angle))


def _span(values: Floats) -> Span:
    return Span(float(values.min()), float(values.mean()), float(values.max()))


def _radius(back: Floats, ahead: Floats) -> Floats:
    """Radius of the circle through three points, from the edges before and behind the middle one."""
    chord = np.linalg.norm(ahead - back, axis=-1)
    double_area = np.linalg.norm(np.cross(back, ahead), axis=-1)
    product = np.linalg.norm(back, axis=-1) * np.linalg.norm(ahead, axis=-1) * chord
    straight = np.full_like(product, np.inf)
    return np.asarray(np.divide(product, 2.0 * double_area, out=straight, where=double_area > 1e-9 * product))


def star_normals(web: Web) -> Floats:
    """Return the unit normals (rows - 2, columns - 2, 3) of the A stars, (d1 - d3) x (d2 - d4) normalised."""
    v = web.vertices
    return unit(np.cross(v[2:, 2:] - v[:-2, :-2], v[2:, :-2] - v[:-2, 2:]) * -1.0)


def quality(web: Web) -> WebQuality:
    """Return the measures of a web (paper section 2.1 and equations (1) to (3)).

    Planarity is the largest distance of a neighbour from the plane of its A star, per mean edge. The geodesic
    deviation is the largest turn of a G line seen in the tangent plane. Parity is the largest amplitude of the
    checkerboard mode (-1)^(i+j), per mean edge. The normal turning is the largest sum of angles between successive
    normals along a G line: it goes to zero when a web collapses to a plane.
    """
    v = web.vertices
    centre = v[1:-1, 1:-1]
    arms = [
        corner - centre for corner in (v[2:, 2:], v[2:, :-2], v[:-2, :-2], v[:-2, 2:])
    ]  # up right, up left, down left, down right
    up, down = v[2:, 1:-1] - centre, v[:-2, 1:-1] - centre
    normal = star_normals(web)
    edge = float(np.mean([np.linalg.norm(arm, axis=-1).mean() for arm in arms]))
    flatness = np.max([np.abs(np.sum(arm * normal, axis=-1)) for arm in arms])

    def tangential(a: Floats) -> Floats:
        return np.asarray(a - np.sum(a * normal, axis=-1, keepdims=True) * normal)

    first = unit(unit(arms[0]) - unit(arms[2]))
    second = unit(unit(arms[1]) - unit(arms[3]))
    meridian = tangential(unit(up) - unit(down))
    twists = (
        _angle(normal[1:, 1:], normal[:-1, :-1]) / np.linalg.norm(arms[0][:-1, :-1], axis=-1),
        _angle(normal[1:, :-1], normal[:-1, 1:]) / np.linalg.norm(arms[1][:-1, 1:], axis=-1),
    )
    checker = np.diff(np.diff(v, 2, axis=0), 2, axis=1) / 16.0
    return WebQuality(
        vertices=v.shape[0] * v.shape[1],
        planarity_per_edge=float(flatness / edge),
        geodesic_deviation_deg=float(np.degrees(_angle(tangential(up), tangential(-down)).max())),
        angle_aa_deg=_span(_between_lines(first, second)),
        angle_ag_deg=_span(np.concatenate([_between_lines(first, meridian), _between_lines(second, meridian)])),
        parity_per_edge=float(np.linalg.norm(checker, axis=-1).max() / edge),
        extent=tuple(float(x) for x in np.ptp(v.reshape(-1, 3), axis=0)),  # type: ignore[arg-type]
        normal_turning_deg=float(np.degrees(_angle(normal[1:], normal[:-1]).sum(axis=0).max())),
        smallest_radius_a=float(min(_radius(arms[0], arms[2]).min(), _radius(arms[1], arms[3]).min())),
        smallest_radius_g=float(_radius(up, down).min()),
        largest_twist_deg_per_m=float(np.degrees(max(twist.max() for twist in twists)) * MM_PER_M),
    )
