"""Closed triangle meshes of the parts, for exchange, pictures and clash tests."""

import math
from functools import lru_cache

import numpy as np

from aag_cad.parts.fasteners import BoltPiece, bolt_pieces, rod_pieces
from aag_cad.parts.forming import formed_points, section_corners
from aag_cad.parts.model import (
    Blade,
    Bolt,
    ClampingBar,
    CouplingBlock,
    FlatBar,
    Footing,
    Frame,
    Mullion,
    Part,
    Plank,
    Rod,
    Screw,
    Shoe,
    Strap,
    Strip,
    Stud,
)
from aag_cad.parts.plates import plate_rings
from aag_cad.parts.products import part_frame
from aag_cad.parts.strips import strip_mesh
from aag_cad.parts.triangles import Mesh, joined, prism, regular_polygon, round_polygon, tube
from aag_cad.units import Floats

MESH_SPACING = 120.0
# Bolts and rods come in a few sizes, thousands of times.
_SIZES = 64


def plank_mesh(plank: FlatBar, spacing: float = MESH_SPACING) -> Mesh:
    """Return the formed plank or bar without its holes, with a ring of four corners about every ``spacing`` mm."""
    count = max(2, math.ceil(plank.blank.length / spacing) + 1)
    corners = section_corners(plank)
    stations = np.repeat(np.linspace(0.0, plank.blank.length, count), 4)
    return tube(formed_points(plank, np.column_stack([stations, np.tile(corners, (count, 1))])).reshape(count, 4, 3))


@lru_cache(maxsize=_SIZES)
def _threaded_mesh(pieces: tuple[BoltPiece, ...]) -> Mesh:
    return joined(
        [prism(regular_polygon(6, p.size) if p.hexagonal else round_polygon(p.size), p.low, p.high) for p in pieces]
    )


def _rectangle(length: float, width: float) -> Floats:
    x, y = length / 2.0, width / 2.0
    return np.array([(-x, -y), (x, -y), (x, y), (-x, y)])


def product_mesh(part: Part) -> Mesh:
    """Return a part's mesh in product coordinates: those of its frame, or of its shell where it has none."""
    match part:
        case Plank() | Mullion() | ClampingBar() | Strap():
            return plank_mesh(part)
        case Stud():
            return prism(regular_polygon(6, part.across_flats), -part.length / 2.0, part.length / 2.0)
        case CouplingBlock():
            return prism(_rectangle(part.length, part.width), -part.thickness / 2.0, part.thickness / 2.0)
        case Footing():
            return prism(_rectangle(part.length, part.width), -part.height, 0.0)
        case Bolt():
            return _threaded_mesh(bolt_pieces(part))
        case Rod():
            return _threaded_mesh(rod_pieces(part))
        case Screw():
            return prism(round_polygon(part.diameter), 0.0, part.length)
        case Shoe() | Blade():
            return tube(plate_rings(part.plate))
        case Strip():
            return strip_mesh(part)


def frame_matrix(frame: Frame) -> Floats:
    """Return the (4, 4) matrix that takes local coordinates of a frame to those that the frame is given in."""
    matrix = np.eye(4)
    matrix[:3] = np.column_stack([frame.x, frame.y, frame.z, frame.origin])
    return matrix


def placed(mesh: Mesh, frame: Frame) -> Mesh:
    """Return a mesh moved from a frame's local coordinates to those that the frame is given in."""
    matrix = frame_matrix(frame)
    return Mesh(mesh.vertices @ matrix[:3, :3].T + matrix[:3, 3], mesh.faces)


def shell_mesh(part: Part) -> Mesh:
    """Return a part's mesh in the coordinates of its shell."""
    mesh, frame = product_mesh(part), part_frame(part)
    return mesh if frame is None else placed(mesh, frame)
