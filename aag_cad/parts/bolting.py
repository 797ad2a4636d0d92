"""Bolts and the holes that they pass, in vault coordinates."""

from collections import defaultdict
from collections.abc import Iterator
from typing import TypeAlias

import numpy as np

from aag_cad.parts.forming import formed_points
from aag_cad.parts.forms import UNMOVED, Frame
from aag_cad.parts.marks import joint_of
from aag_cad.parts.mesh import frame_matrix, moved
from aag_cad.parts.model import Blade, Bolt, Gridshell, Plank, Shell, Shoe, Strap
from aag_cad.parts.shapes.folded_plate import hole_axes
from aag_cad.units import Floats

# Point and direction, each (3,).
Axis: TypeAlias = tuple[Floats, Floats]


def axis_distance(axis: Axis, point: Floats) -> float:
    """Return the distance of a point (3,) from an axis, mm."""
    return float(np.linalg.norm(np.cross(point - axis[0], axis[1])))


def bolts_by_joint(gridshell: Gridshell) -> dict[str, dict[str, Axis]]:
    """Return the axes of all bolts by joint and by mark."""
    found: dict[str, dict[str, Axis]] = defaultdict(dict)
    groups: list[tuple[Frame, tuple[Bolt, ...]]] = [(shell.placement, shell.bolts) for shell in gridshell.shells]
    for placement, bolts in [*groups, (UNMOVED, gridshell.bolts)]:
        matrix = frame_matrix(placement)
        for bolt in bolts:
            point = matrix[:3, :3] @ np.array(bolt.frame.origin) + matrix[:3, 3]
            joint = joint_of(bolt.mark)
            found[joint][bolt.mark] = point, matrix[:3, :3] @ np.array(bolt.frame.z)
    return found


def _flat_holes(bar: Plank | Strap, placement: Frame) -> Iterator[tuple[str, str, float, Floats]]:
    holes = [hole for hole in bar.blank.holes if hole.use == "bolt"]
    if not holes:
        return
    centres = formed_points(bar, np.array([[hole.station, hole.offset, 0.0] for hole in holes]))
    placed = moved(centres, frame_matrix(placement))
    yield from ((bar.mark, hole.joint, hole.station, centre) for hole, centre in zip(holes, placed, strict=True))


def _plate_holes(part: Shoe | Blade, placement: Frame, bolts: int) -> Iterator[tuple[str, str, float, Floats]]:
    matrix = frame_matrix(placement) @ frame_matrix(part.frame)
    centres, _axes = hole_axes(part.plate)
    for hole, centre in zip(part.plate.holes[:bolts], centres[:bolts], strict=True):
        yield part.mark, part.mark, hole.station, matrix[:3, :3] @ centre + matrix[:3, 3]


def bolt_holes(gridshell: Gridshell) -> Iterator[tuple[str, str, float, Floats]]:
    """Yield (part, joint, station, centre (3,)) of every bolt hole in planks, straps, shoes and blades.

    The last hole of a shoe is that of its threaded rod.
    """
    for shell in gridshell.shells:
        yield from _shell_holes(shell)
    for blade in gridshell.blades:
        yield from _plate_holes(blade, UNMOVED, len(blade.plate.holes))


def _shell_holes(shell: Shell) -> Iterator[tuple[str, str, float, Floats]]:
    bars: tuple[Plank | Strap, ...] = (*shell.planks, *shell.straps)
    for bar in bars:
        yield from _flat_holes(bar, shell.placement)
    for shoe in shell.shoes:
        yield from _plate_holes(shoe, shell.placement, len(shoe.plate.holes) - 1)
