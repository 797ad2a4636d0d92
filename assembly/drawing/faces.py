"""The faces of a gridshell for pictures: quadrilaterals of timber, steel plates and concrete in vault coordinates."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from aag_cad.colours import LEGEND, srgb
from aag_cad.parts.kinds import kind_of
from aag_cad.parts.mesh import frame_matrix, moved, shell_mesh
from aag_cad.parts.model import Footing, Gridshell, Part, Shell, Stud, ridge_parts, shell_parts
from aag_cad.parts.triangles import regular_polygon
from aag_cad.units import Floats
from assembly.drawing.part_outlines import plank_rings

LEAST_SPACING = 110.0
_MOST_SEGMENTS = 7000.0
_STUD_PIECES = 8


@dataclass(frozen=True, eq=False)
class Faces:
    """Quadrilaterals in space: corners (n, 4, 3), counter-clockwise from outside, and base colours (n, 3)."""

    corners: Floats
    colours: Floats


def placed_points(points: Floats, shell: Shell) -> Floats:
    """Return points (..., 3) of a shell in vault coordinates."""
    return moved(points, frame_matrix(shell.placement))


def tube_faces(rings: Floats) -> Floats:
    """Return the side and end faces (m, 4, 3) of a tube over rings (k, s, 3) of an even section, turned outwards.

    Sides run (low, low, high, high), so that their second and fourth edges run along the tube.
    """
    low, high, count = rings[:-1], rings[1:], rings.shape[1]
    turn = [(j, (j + 1) % count) for j in range(count)]
    sides = [np.stack([low[:, j], low[:, k], high[:, k], high[:, j]], axis=1) for j, k in turn]
    ends = [(0, j + 1, j + 2, j + 3) for j in range(0, count - 2, 2)]
    return np.concatenate([*sides, *(rings[:1, end[::-1]] for end in ends), *(rings[-1:, end] for end in ends)])


def _stud_faces(stud: Stud) -> Floats:
    """Return the faces of a stud in pieces of its length, (m, 4, 3)."""
    ring = np.column_stack([regular_polygon(6, stud.across_flats), np.zeros(6)])
    heights = np.linspace(-stud.length / 2.0, stud.length / 2.0, _STUD_PIECES + 1)
    rings = np.array([ring + np.array([0.0, 0.0, height]) for height in heights])
    return tube_faces(moved(rings, frame_matrix(stud.frame)))


def _top_face(footing: Footing) -> Floats:
    """Return all that is seen of a concrete block over the ground, (1, 4, 3)."""
    x, y = footing.length / 2.0, footing.width / 2.0
    corners = np.array([(-x, -y, 0.0), (x, -y, 0.0), (x, y, 0.0), (-x, y, 0.0)])
    return moved(corners, frame_matrix(footing.frame))[None]


def picture_spacing(gridshell: Gridshell) -> float:
    """Return the length of the pieces that planks are drawn in, mm: so many that the picture stays a small file."""
    total = sum(plank.blank.length for shell in gridshell.shells for plank in shell.planks)
    return max(LEAST_SPACING, total / _MOST_SEGMENTS)


def _steel_faces(parts: Iterable[Part]) -> Iterator[tuple[Floats, str]]:
    for part in parts:
        if kind_of(part).role == "connector" and kind_of(part).material == "steel":
            mesh = shell_mesh(part)
            yield mesh.vertices[mesh.faces[:, [0, 1, 2, 2]]], "steel"


def _shell_faces(shell: Shell, spacing: float) -> Iterator[tuple[Floats, str]]:
    for plank in shell.planks:
        yield placed_points(tube_faces(plank_rings(plank, spacing)), shell), plank.family
    for stud in shell.studs:
        yield placed_points(_stud_faces(stud), shell), "stud"
    yield from ((placed_points(faces, shell), colour) for faces, colour in _steel_faces(shell_parts(shell)))
    for footing in shell.footings:
        yield placed_points(_top_face(footing), shell), "concrete"


def gridshell_faces(gridshell: Gridshell) -> Faces:
    """Return the faces of timber, steel plates and concrete in vault coordinates; the cover would hide them all."""
    spacing = picture_spacing(gridshell)
    listed = [item for shell in gridshell.shells for item in _shell_faces(shell, spacing)]
    listed += _steel_faces(ridge_parts(gridshell))
    colours = [np.tile(255.0 * np.array(srgb(LEGEND[name])), (len(faces), 1)) for faces, name in listed]
    return Faces(np.concatenate([faces for faces, _ in listed]), np.concatenate(colours))
