"""Shells as they lie on a sheet: outlines of their planks and places of their joints, y down."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from aag_cad.geometry.surface import unit
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import Kind, Place, kind_of, parts_at
from aag_cad.parts.marks import shell_of
from aag_cad.parts.mesh import frame_matrix, moved
from aag_cad.parts.model import Gridshell, Joint, Part, Shell, ridge_parts, shell_parts
from aag_cad.units import Floats, Vector
from assembly.base.shell_axes import View, elevation_view, shell_view, vault_view
from assembly.drawing.part_outlines import Flat, piece_outline


@dataclass(frozen=True, eq=False)
class Outline:
    """What is drawn of some shells, in units of the sheet: outlines and lines (n, 2), points (2,).

    ``planks`` run from the lowest layer to the highest, ``pieces`` are the other parts that are drawn, ``kinds`` the
    rows of these; ``lines`` are
    centre lines of planks, beams and pieces from their start, ``points`` those of the joints. ``scale`` is sheet units
    a mm, ``origin`` the place of the coordinates' origin.
    """

    width: float
    height: float
    scale: float
    origin: Floats
    planks: dict[str, Floats]
    lines: dict[str, Floats]
    points: dict[str, Floats]
    pieces: dict[str, Floats]
    kinds: dict[str, Kind[Any, Any]]


@dataclass(frozen=True, eq=False)
class _Group:
    """Parts and joints that are moved together by a (4, 4) matrix; ``shell`` is None for those of the ridges."""

    shell: Shell | None
    matrix: Floats
    parts: tuple[Part, ...]
    joints: tuple[Joint, ...]


def _group(shell: Shell, matrix: Floats, drawn: tuple[Place, ...]) -> _Group:
    planks = sorted(shell.planks, key=lambda plank: (plank.layer, plank.mark))
    pieces = [part for part in parts_at(shell_parts(shell), *drawn) if kind_of(part).outlined]
    return _Group(shell, matrix, (*planks, *pieces), shell.joints)


def _outline(
    groups: Sequence[_Group],
    view: View,
    width: float,
    margin: float,
    around: Sequence[Vector] = (),
    only: Collection[str] = (),
) -> Outline:
    """Return groups in a view on a sheet of a given width, with a margin all round.

    The sheet holds all parts and the points ``around``; or only the parts ``only``, by their marks.
    """

    def on_sheet(matrix: Floats) -> Flat:
        def flat(points: Floats) -> Floats:
            seen = view(moved(points, matrix))
            return np.column_stack([seen[:, 0], -seen[:, 1]])

        return flat

    seen = {part.mark: piece_outline(part, on_sheet(group.matrix)) for group in groups for part in group.parts}
    joints = {j.mark: on_sheet(group.matrix)(np.array([j.point]))[0] for group in groups for j in group.joints}
    held = [outline for mark, (outline, _) in seen.items() if not only or mark in only]
    corners = np.concatenate([*held, *(on_sheet(np.eye(4))(np.array([point])) for point in around)])
    low, high = corners.min(axis=0), corners.max(axis=0)
    scale = (width - 2.0 * margin) / float(high[0] - low[0])
    drawn = {mark: [(points - low) * scale + margin for points in pair] for mark, pair in seen.items()}
    lines = {mark: line for mark, (_, line) in drawn.items()}
    shells = [group.shell for group in groups if group.shell is not None]
    for beam in (beam for shell in shells for beam in shell.beams):
        lines[beam.mark] = (lines[beam.planks[0]] + lines[beam.planks[1]]) / 2.0
    layers = {plank.mark: plank.layer for shell in shells for plank in shell.planks}
    return Outline(
        width=width,
        height=float(high[1] - low[1]) * scale + 2.0 * margin,
        scale=scale,
        origin=margin - low * scale,
        planks={mark: drawn[mark][0] for mark in sorted(layers, key=lambda mark: (layers[mark], mark))},
        lines=lines,
        points={mark: (point - low) * scale + margin for mark, point in joints.items()},
        pieces={mark: outline for mark, (outline, _) in drawn.items() if mark not in layers},
        kinds={part.mark: kind_of(part) for group in groups for part in group.parts if part.mark not in layers},
    )


def clipped(points: Floats, start: float, end: float) -> Floats:
    """Return the part of an outline (2 k, 2) of a plank between two shares of its length."""
    count = len(points) // 2
    even = np.linspace(0.0, 1.0, count)
    at = np.unique([start, end, *even[(even > start) & (even < end)]])
    sides = [
        np.column_stack([np.interp(at, even, side[:, i]) for i in (0, 1)])
        for side in (points[:count], points[: count - 1 : -1])
    ]
    return np.concatenate([sides[0], sides[1][::-1]])


def shell_outline(shell: Shell, width: float, margin: float, drawn: tuple[Place, ...] = ()) -> Outline:
    """Return a shell square on from outside, its foot at the bottom; ``drawn`` are places of pieces besides planks."""
    return _outline([_group(shell, np.eye(4), drawn)], shell_view(shell), width, margin)


def elevation_outline(shell: Shell, width: float, margin: float) -> Outline:
    """Return a shell from its side, standing as it will stand."""
    return _outline([_group(shell, np.eye(4), ())], elevation_view(shell), width, margin)


def _placed(gridshell: Gridshell, drawn: tuple[Place, ...]) -> list[_Group]:
    placed = [_group(shell, frame_matrix(shell.placement), drawn) for shell in gridshell.shells]
    pieces = tuple(part for part in parts_at(ridge_parts(gridshell), *drawn) if kind_of(part).outlined)
    return [*placed, _Group(None, np.eye(4), pieces, gridshell.joints)]


def vault_outline(gridshell: Gridshell, width: float, margin: float, drawn: tuple[Place, ...] = ()) -> Outline:
    """Return all shells in plan, the centre on the sheet; ``drawn`` are the places of pieces besides planks."""
    return _outline(_placed(gridshell, drawn), vault_view(), width, margin, around=((0.0, 0.0, 0.0),))


def ridge_outline(gridshell: Gridshell, pair: Sequence[str], width: float, margin: float) -> Outline:
    """Return the ridge between two shells from above with its blades, the crown to the left, cut off beside it.

    ``pair`` are the marks of the two ridge planks.
    """
    index, ends = index_of(gridshell), []
    for mark in pair:
        placement = frame_matrix(index.shells[shell_of(mark)].placement)
        points = moved(index.planks[mark].curve.points[[0, -1]], placement)
        ends.append(points[np.argsort(-points[:, 2])])
    crown, side = np.mean(ends, axis=0)
    along = unit((side - crown) * [1.0, 1.0, 0.0])
    up = np.array([0.0, 0.0, 1.0])
    view = View(np.array([along, np.cross(up, along), up]))
    return _outline(_placed(gridshell, ("ridge",)), view, width, margin, only=pair)
