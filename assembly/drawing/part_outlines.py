"""What parts look like on a sheet: the outline of each and, of long ones, the line along their middle."""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from scipy.spatial import ConvexHull

from aag_cad.parts.kinds import shaped
from aag_cad.parts.mesh import shell_mesh
from aag_cad.parts.model import FlatBar, Part, Strip
from aag_cad.parts.shapes.bar import BAR, bar_rings
from aag_cad.parts.shapes.sheet import SHEET, ruling_spans, sheet_of
from aag_cad.units import Floats

Flat: TypeAlias = Callable[[Floats], Floats]

_SPACING = 300.0
_LEAST_RINGS = 7
_RULINGS = 25


def plank_rings(plank: FlatBar, spacing: float = _SPACING) -> Floats:
    """Return the four corners of a formed plank or bar at even stations, (k, 4, 3), in the coordinates of its shell."""
    return bar_rings(plank, max(_LEAST_RINGS, int(plank.blank.length / spacing) + 2))


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
    shape, form = shaped(part)
    if shape is BAR:
        rings = plank_rings(form)
        return silhouette(flat(rings.reshape(-1, 3)).reshape(len(rings), 4, 2))
    if shape is SHEET:
        corners = _strip_corners(form)
        left, right = flat(corners[:, 0]), flat(corners[:, 1])
        return np.concatenate([left, right[::-1]]), (left + right) / 2.0
    points = flat(shell_mesh(part).vertices)
    return _hull(points), points.mean(axis=0)[None]
