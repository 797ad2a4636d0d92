"""Meshes of the parts, points on and depths in them for the clash test, and frames as matrices."""

import numpy as np

from aag_cad.parts.forms import Frame
from aag_cad.parts.kinds import shaped
from aag_cad.parts.model import Part
from aag_cad.parts.products import part_frame
from aag_cad.parts.triangles import Mesh
from aag_cad.units import Floats


def product_mesh(part: Part) -> Mesh:
    """Return a part's mesh in product coordinates: those of its frame, or of its shell where it has none."""
    shape, form = shaped(part)
    return shape.mesh(form)


def surface_points(part: Part) -> Floats:
    """Return points on the surface of a part in product coordinates, (n, 3)."""
    shape, form = shaped(part)
    return shape.points(form)


def depths_in(part: Part, points: Floats) -> Floats:
    """Return how deep points (n, 3) in product coordinates lie inside a part, mm, (n,); negative outside."""
    shape, form = shaped(part)
    return shape.depths(form, points)


def frame_matrix(frame: Frame) -> Floats:
    """Return the (4, 4) matrix that takes local coordinates of a frame to those that the frame is given in."""
    matrix = np.eye(4)
    matrix[:3] = np.column_stack([frame.x, frame.y, frame.z, frame.origin])
    return matrix


def part_matrix(part: Part) -> Floats:
    """Return the (4, 4) matrix from product coordinates to those that a part's frame is given in, if it has one."""
    frame = part_frame(part)
    return np.eye(4) if frame is None else frame_matrix(frame)


def moved(points: Floats, matrix: Floats) -> Floats:
    """Return points (..., 3) moved by a matrix (4, 4)."""
    return np.asarray(points @ matrix[:3, :3].T + matrix[:3, 3])


def placed(mesh: Mesh, frame: Frame) -> Mesh:
    """Return a mesh moved from a frame's local coordinates to those that the frame is given in."""
    return Mesh(moved(mesh.vertices, frame_matrix(frame)), mesh.faces)


def shell_mesh(part: Part) -> Mesh:
    """Return a part's mesh in the coordinates of its shell."""
    mesh, frame = product_mesh(part), part_frame(part)
    return mesh if frame is None else placed(mesh, frame)
