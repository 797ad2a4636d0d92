"""What parts look like on a sheet: the outline of each and, of long ones, the line along their middle."""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from scipy.spatial import ConvexHull

from aag_cad.parts.forming import formed_points
from aag_cad.parts.mesh import shell_mesh
from aag_cad.parts.model import ClampingBar, FlatBar, Mullion, Part, Plank, Strap, Strip
from aag_cad.parts.shapes.sheet import ruling_spans, sheet_of
from aag_cad.units import Floats

Flat: TypeAlias = Callable[[Floats], Floats]

_SPACING = 300.0
_LEAST_RINGS = 7
_RULINGS = 25


def plank_rings(plank: FlatBar, spacing: float = _SPACING) -> Floats:
    """Return the four corners of a formed plank or bar at even stations, (k, 4, 3), in the coordinates of its shell."""
    section, length = plank.blank.section, plank.blank.length
    count = max(_LEAST_RINGS, int(length / spacing) + 2)
    y, z = section.width / 2.0, section.thickness / 2.0
    corners = np.array([(-y, -z), (y, -z), (y, z), (-y, z)])
    stations = np.repeat(np.linspace(0.0, length, count), 4)
    return formed_points(plank, np.column_stack([stations, np.tile(corners, (count, 1))])).reshape(count, 4, 3)


def silhouette(rings: Floats) -> tuple[Floats, Floats]:
    """Return outline (2k, 2) and centre line (k, 2) of rings (k, 4, 2) seen flat: the outermost corners of each."""
    centre = rings.mean(axis=1)
    along = np.gradient(centre, axis=0)
    across = np.column_stack([-along[:, 1], along[:, 0]])
    reach = np.einsum("kcj,kj->kc", rings - centre[:, None], across)
    rows = np.arange(len(rings))
    left, right = rings[rows, reach.argmax(axis=1)], rings[rows, reach.argmin(axis=1)]
    return np.concatenate([left, right[::-1]]), centre


def _strip_corners(strip: Strip) -> Floats:
    """Return left and right ends of rulings of a strip from its lower to its upper cut, (n, 2, 3)."""
    sheet = sheet_of(strip)
    u = np.linspace(min(strip.lower), max(strip.upper), _RULINGS)
    u = np.unique(np.concatenate([u, strip.lower, strip.upper]))
    spans = ruling_spans(sheet, u)
    return np.stack([sheet.formed(u, spans[:, side], 0.0) for side in (0, 1)], axis=1)


def _hull(points: Floats) -> Floats:
    return np.asarray(points[ConvexHull(points).vertices])


def piece_outline(part: Part, flat: Flat) -> tuple[Floats, Floats]:
    """Return outline (n, 2) and middle line (k, 2) of a piece; ``flat`` takes points (n, 3) to the sheet.

    What is folded or round is drawn as the convex hull of its mesh, its middle line is a point.
    """
    match part:
        case Plank() | Strap() | Mullion() | ClampingBar():
            rings = plank_rings(part)
            return silhouette(flat(rings.reshape(-1, 3)).reshape(len(rings), 4, 2))
        case Strip():
            corners = _strip_corners(part)
            left, right = flat(corners[:, 0]), flat(corners[:, 1])
            return np.concatenate([left, right[::-1]]), (left + right) / 2.0
        case _:
            points = flat(shell_mesh(part).vertices)
            return _hull(points), points.mean(axis=0)[None]
