"""Shells as they lie on a sheet: outlines of their planks and places of their joints, y down."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from aag_cad.parts.forming import formed_points
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import FlatBar, Gridshell, Shell
from aag_cad.units import Floats
from assembly.view import View, elevation_view, shell_view, vault_view

_SPACING = 300.0
_LEAST_RINGS = 7


@dataclass(frozen=True, eq=False)
class Outline:
    """What is drawn of some shells, in units of the sheet: outlines and lines (n, 2), points (2,).

    ``planks`` run from the lowest layer to the highest; ``lines`` are centre lines of planks and beams from their
    start, ``points`` those of the joints. ``scale`` is sheet units a mm, ``origin`` the place of the
    coordinates' origin.
    """

    width: float
    height: float
    scale: float
    origin: Floats
    planks: dict[str, Floats]
    lines: dict[str, Floats]
    points: dict[str, Floats]


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


def _outline(
    shells: Sequence[tuple[Shell, Floats]], view: View, width: float, margin: float, with_origin: bool = False
) -> Outline:
    """Return shells, each moved by a (4, 4) matrix, in a view on a sheet of a given width, with a margin all round."""

    def flat(points: Floats, matrix: Floats) -> Floats:
        seen = view(points @ matrix[:3, :3].T + matrix[:3, 3])
        return np.column_stack([seen[:, 0], -seen[:, 1]])

    planks = sorted(
        ((plank, m) for shell, m in shells for plank in shell.planks), key=lambda p: (p[0].layer, p[0].mark)
    )
    rings = {plank.mark: (plank_rings(plank), matrix) for plank, matrix in planks}
    seen = {mark: flat(r.reshape(-1, 3), m).reshape(len(r), 4, 2) for mark, (r, m) in rings.items()}
    joints = {joint.mark: flat(np.array([joint.point]), m)[0] for shell, m in shells for joint in shell.joints}
    corners = np.concatenate([*(points.reshape(-1, 2) for points in seen.values()), np.zeros((int(with_origin), 2))])
    low, high = corners.min(axis=0), corners.max(axis=0)
    scale = (width - 2.0 * margin) / float(high[0] - low[0])
    drawn = {mark: silhouette((points - low) * scale + margin) for mark, points in seen.items()}
    lines = {mark: line for mark, (_, line) in drawn.items()}
    for beam in (beam for shell, _ in shells for beam in shell.beams):
        lines[beam.mark] = (lines[beam.planks[0]] + lines[beam.planks[1]]) / 2.0
    return Outline(
        width=width,
        height=float(high[1] - low[1]) * scale + 2.0 * margin,
        scale=scale,
        origin=margin - low * scale,
        planks={mark: outline for mark, (outline, _) in drawn.items()},
        lines=lines,
        points={mark: (point - low) * scale + margin for mark, point in joints.items()},
    )


def shell_outline(shell: Shell, width: float, margin: float) -> Outline:
    """Return a shell square on from outside, its foot at the bottom."""
    return _outline([(shell, np.eye(4))], shell_view(shell), width, margin)


def elevation_outline(shell: Shell, width: float, margin: float) -> Outline:
    """Return a shell from its side, standing as it will stand."""
    return _outline([(shell, np.eye(4))], elevation_view(shell), width, margin)


def vault_outline(gridshell: Gridshell, width: float, margin: float) -> Outline:
    """Return all shells in plan, the centre on the sheet."""
    placed = [(shell, frame_matrix(shell.placement)) for shell in gridshell.shells]
    return _outline(placed, vault_view(), width, margin, with_origin=True)
