"""The whole gridshell in perspective as SVG: what the eye sees of it, shaded by family, on its ground."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from aag_cad.geometry.surface import unit
from aag_cad.once import once
from aag_cad.parts.model import Gridshell
from aag_cad.units import Floats
from assembly.drawing.faces import Faces, gridshell_faces, picture_spacing, placed_points
from assembly.drawing.painting import covers_of, painting_order, samples_of, unhidden
from assembly.drawing.part_outlines import plank_rings
from assembly.drawing.svg import Style, group, path, polygon, svg

WIDTH = 1800.0
SHADOW = Style("#dedad1")
FOOT_LINE = Style("none", "#8f887b", 2.5, "9 6")
FIGURE = Style("#9d978e")

# Where the picture is taken from and where the sun stands: round the vertical from the middle of an entry, and above
# the ground; the distance is in widths of the gridshell.
_AZIMUTH_DEG, _ELEVATION_DEG, _DISTANCE = 31.0, 23.0, 1.5
_SUN_AZIMUTH_DEG, _SUN_ELEVATION_DEG = -40.0, 66.0
_MARGIN = 30.0
_FAR_FADE = 0.3
_EDGE = 0.7
_EDGE_WIDTH = 6.0
_THIN = 1.6
_LAP = 0.4
_FIGURE_REACH = 0.72
_FIGURE_TURN = -0.1
_HEAD = (1640.0, 114.0)
_BODY = ((12, 0), (112, 0), (118, 25), (86, 70), (98, 300), (94, 470), (130, 760), (150, 900), (138, 1060), (165, 1280),
         (184, 1400), (150, 1455), (68, 1492), (50, 1520), (50, 1590))  # fmt: skip
_ARM = ((140, 1455), (190, 1430), (224, 1360), (240, 1150), (262, 960), (264, 860), (242, 790), (216, 800), (214, 880),
        (202, 960), (182, 1130), (160, 1290))  # fmt: skip


def _direction(azimuth: float, elevation_deg: float) -> Floats:
    """Return the unit vector (3,) to a point at an azimuth in radians and an elevation in degrees."""
    elevation = math.radians(elevation_deg)
    flat = math.cos(elevation)
    return np.array([flat * math.cos(azimuth), flat * math.sin(azimuth), math.sin(elevation)])


def _entry(gridshell: Gridshell) -> float:
    """Return the azimuth, in radians, half-way between the first shell and the next one round the centre."""
    first = gridshell.shells[0]
    middle = placed_points(np.mean([joint.point for joint in first.joints], axis=0), first)
    return math.atan2(float(middle[1]), float(middle[0])) + math.pi / len(gridshell.shells)


@dataclass(frozen=True, eq=False)
class Projection:
    """A perspective from ``eye`` with the axes right, up and back (3, 3); ``scale`` and ``shift`` go to the sheet."""

    eye: Floats
    axes: Floats
    scale: float
    shift: Floats

    def __call__(self, points: Floats) -> tuple[Floats, Floats]:
        """Return sheet coordinates (..., 2), y down, and distances in front of the eye (...)."""
        seen = (points - self.eye) @ self.axes.T
        depth = -seen[..., 2]
        flat = np.stack([seen[..., 0], -seen[..., 1]], axis=-1) / depth[..., None]
        return flat * self.scale + self.shift, depth


def _projection(points: Floats, back: Floats) -> tuple[Projection, float]:
    """Return the projection that fills the width of the sheet with points (n, 3), and the sheet's height."""
    right = unit(np.cross(np.array([0.0, 0.0, 1.0]), back))
    axes = np.array([right, np.cross(back, right), back])
    middle = (points.min(axis=0) + points.max(axis=0)) / 2.0
    away = _DISTANCE * float(np.ptp(points[:, :2], axis=0).max())
    raw = Projection(middle + away * back, axes, 1.0, np.zeros(2))
    flat, _ = raw(points)
    low, high = flat.min(axis=0), flat.max(axis=0)
    scale = (WIDTH - 2.0 * _MARGIN) / float(high[0] - low[0])
    height = float(high[1] - low[1]) * scale + 2.0 * _MARGIN
    return Projection(raw.eye, axes, scale, _MARGIN - low * scale), height


def _shaded(faces: Faces, depth: Floats, sun: Floats) -> tuple[list[str], list[str]]:
    """Return the colour of each face and of its edges, by its normal to the sun and paler with the distance."""
    a, b, c = faces.corners[:, 0], faces.corners[:, 1], faces.corners[:, 2]
    light = 0.64 + 0.36 * (unit(np.cross(b - a, c - a)) @ sun)
    colour = faces.colours * np.clip(light, 0.45, 1.0)[:, None]
    far = (depth - depth.min()) / float(np.ptp(depth)) * _FAR_FADE
    colour = colour + far[:, None] * (238.0 - colour)
    return _hexadecimal(colour), _hexadecimal(colour * _EDGE)


def _hexadecimal(colours: Floats) -> list[str]:
    return [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in np.clip(colours, 0, 255).astype(int).tolist()]


def _shadow(points: Floats, ground: float, sun: Floats) -> Floats:
    """Return points (..., 3) cast by the sun on the ground."""
    fall = (points[..., 2] - ground) / sun[2]
    return np.asarray(points - fall[..., None] * sun)


def _ground_items(gridshell: Gridshell, project: Projection, sun: Floats) -> Iterator[str]:
    """Yield the shadows of the planks and the foot line of each shell."""
    shadows, feet, spacing = [], [], 2.0 * picture_spacing(gridshell)
    for shell in gridshell.shells:
        for plank in shell.planks:
            edges = placed_points(plank_rings(plank, spacing)[:, :2], shell)
            strip = np.concatenate([edges[:, 0], edges[::-1, 1]])
            shadows.append(path(project(_shadow(strip, gridshell.ground, sun))[0]))
        points = np.array([joint.point for joint in shell.joints if joint.kind == "foot"])
        if len(points):
            line = placed_points(points, shell)
            line[:, 2] = gridshell.ground
            feet.append(path(project(line)[0], closed=False))
    yield group(shadows, SHADOW)
    yield group(feet, FOOT_LINE)


def _figure_items(place: Floats, project: Projection, sun: Floats) -> Iterator[str]:
    """Yield a grown person of 1.75 m who stands at a place (3,) on the ground, turned to the eye."""
    body = np.array([*_BODY, *((-x, z) for x, z in reversed(_BODY)), (-10, 800), (10, 800)], dtype=float)
    right = np.array(_ARM, dtype=float)
    angles = np.arange(24) * math.pi / 12.0
    head = np.array([0.0, _HEAD[0]]) + _HEAD[1] * np.column_stack([0.74 * np.cos(angles), np.sin(angles)])
    up = np.array([0.0, 0.0, 1.0])
    shapes = [place + p[:, :1] * project.axes[0] + p[:, 1:] * up for p in (body, right, right * [-1.0, 1.0], head)]
    yield group((path(project(_shadow(p, float(place[2]), sun))[0]) for p in shapes), SHADOW)
    yield group((path(project(p)[0]) for p in shapes), FIGURE)


def _face_items(faces: Faces, project: Projection, sun: Floats) -> Iterator[str]:
    """Yield the faces that are turned to the eye and not hidden, the farthest first; in tenths of sheet units."""
    flat, depth = project(faces.corners)
    d1, d2 = flat[:, 2] - flat[:, 0], flat[:, 3] - flat[:, 1]
    seen = np.flatnonzero(d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0] < 0.0)
    seen = seen[unhidden(samples_of(flat[seen], depth[seen]))]
    covers = covers_of(samples_of(flat[seen], depth[seen]), len(seen))
    colours, edges = _shaded(faces, depth.mean(axis=1), sun)
    order = seen[painting_order(covers, depth[seen].mean(axis=1))]
    shown = flat[order]
    sides = zip(_relative(shown[:, 1:3]), _relative(shown[:, [3, 0]]), strict=True)
    wide = (np.linalg.norm(shown[:, 1] - shown[:, 0], axis=1) > _THIN).tolist()
    for i, outline, (left, right), edged in zip(order.tolist(), _relative(_grown(shown)), sides, wide, strict=True):
        yield f'<path fill="{colours[i]}" d="{outline}z"/>'
        if edged:
            yield f'<path stroke="{edges[i]}" d="{left}{right}"/>'


def _grown(flat: Floats) -> Floats:
    """Return faces (n, 4, 2) a little longer at both ends, so that no gap shows between neighbours."""
    along = flat[:, [3, 2]] - flat[:, [0, 1]]
    reach = _LAP * along / np.maximum(np.linalg.norm(along, axis=2, keepdims=True), _LAP)
    return np.concatenate([flat[:, :2] - reach, flat[:, 2:] + reach[:, ::-1]], axis=1)


def _relative(points: Floats) -> list[str]:
    """Return paths through points (n, k, 2), each as a start and moves from point to point: the shortest to write."""
    tenths = np.round(points * 10.0).astype(int)
    starts, moves = tenths[:, 0].tolist(), np.diff(tenths, axis=1).tolist()
    return [
        f"M{x} {y}l{' '.join(f'{dx} {dy}' for dx, dy in steps)}".replace(" -", "-")
        for (x, y), steps in zip(starts, moves, strict=True)
    ]


@once
def _picture(gridshell: Gridshell) -> tuple[float, tuple[str, ...]]:
    """Return the height of the picture and what is drawn on it."""
    entry = _entry(gridshell)
    azimuth = entry + math.radians(_AZIMUTH_DEG)
    sun = _direction(azimuth + math.radians(_SUN_AZIMUTH_DEG), _SUN_ELEVATION_DEG)
    faces = gridshell_faces(gridshell)
    points = faces.corners.reshape(-1, 3)
    shadows = _shadow(points, gridshell.ground, sun)
    project, height = _projection(np.concatenate([points, shadows]), _direction(azimuth, _ELEVATION_DEG))
    reach = float(np.linalg.norm(points[:, :2], axis=1).max())
    place = _FIGURE_REACH * reach * _direction(entry + _FIGURE_TURN, 0.0) + np.array([0.0, 0.0, gridshell.ground])
    tenths = f'<g transform="scale(.1)" stroke-width="{_EDGE_WIDTH:g}">{"".join(_face_items(faces, project, sun))}</g>'
    return height, (*_ground_items(gridshell, project, sun), *_figure_items(place, project, sun), tenths)


def perspective_svg(gridshell: Gridshell, background: str = "none") -> str:
    """Return a picture of the whole gridshell on its ground with a person in an entry, ``WIDTH`` sheet units wide."""
    height, items = _picture(gridshell)
    sheet = np.array([(0.0, 0.0), (WIDTH, 0.0), (WIDTH, height), (0.0, height)])
    return svg(WIDTH, height, [polygon(sheet, Style(background)) if background != "none" else "", *items])
