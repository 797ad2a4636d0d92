"""What steel, concrete and cover look like on a sheet: the outline of each piece and, of long ones, their middle."""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from scipy.spatial import ConvexHull

from aag_cad.parts.mesh import shell_mesh
from aag_cad.parts.model import Blade, ClampingBar, Footing, Mullion, Part, Rod, Shell, Shoe, Strap, Strip
from aag_cad.parts.strips import ruling_spans, sheet_of
from aag_cad.units import Floats
from assembly.outline import plank_rings, silhouette

Flat: TypeAlias = Callable[[Floats], Floats]
Piece: TypeAlias = Strap | Shoe | Rod | Footing | Mullion | Strip | ClampingBar | Blade

_RULINGS = 25


def drawn_pieces(shell: Shell) -> tuple[Piece, ...]:
    """Return the pieces of a shell that are drawn besides its planks, from the lowest to the highest."""
    return (
        *shell.footings, *shell.rods, *shell.shoes, *shell.straps, *shell.mullions, *shell.strips, *shell.clamps,
    )  # fmt: skip


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
        case Strap() | Mullion() | ClampingBar():
            rings = plank_rings(part)
            return silhouette(flat(rings.reshape(-1, 3)).reshape(len(rings), 4, 2))
        case Strip():
            corners = _strip_corners(part)
            left, right = flat(corners[:, 0]), flat(corners[:, 1])
            return np.concatenate([left, right[::-1]]), (left + right) / 2.0
        case _:
            points = flat(shell_mesh(part).vertices)
            return _hull(points), points.mean(axis=0)[None]
