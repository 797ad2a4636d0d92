"""Patches of surfaces: crop, flip, copy, rotate, intersect and join (paper section 2, Fig. 2)."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.spatial import cKDTree

from aag_cad.errors import SurfaceError
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface, turn
from aag_cad.geometry.surface import Surface, unit, unit_normals
from aag_cad.units import Floats, Vector

_HALVINGS = 50
_TABLE = 400
_NEWTON_STEPS = 8


@dataclass(frozen=True, eq=False)
class Patch:
    """A piece of a surface: ranges of u and v, sides that crop it, and the motion (4, 4) to where it stands.

    A side gives for points (n, 3) in the surface's own coordinates a number (n,), positive where the patch is kept.
    """

    surface: Surface
    u: tuple[float, float]
    v: tuple[float, float]
    sides: tuple[Callable[[Floats], Floats], ...] = ()
    motion: Floats = field(default_factory=lambda: np.eye(4))


def shift(by: Floats) -> Floats:
    """Return the motion (4, 4) by a vector (3,), mm."""
    motion: Floats = np.eye(4)
    motion[:3, 3] = by
    return motion


def reflection(origin: Vector, normal: Vector) -> Floats:
    """Return the mirror image (4, 4) in the plane through origin with a normal of any length."""
    direction = unit(np.array(normal))
    mirror = np.eye(4)
    mirror[:3, :3] -= 2.0 * np.outer(direction, direction)
    return np.asarray(shift(np.array(origin)) @ mirror @ shift(-np.array(origin)))


def _applied(motion: Floats, points: Floats) -> Floats:
    return np.asarray(points @ motion[:3, :3].T + motion[:3, 3])


def patch_points(patch: Patch, u: Floats, v: Floats) -> Floats:
    """Return the points (n, 3) of a patch at parameters u, v, each (n,), where it stands."""
    return _applied(patch.motion, patch.surface.jet(u, v).point)


def patch_normals(patch: Patch, u: Floats, v: Floats) -> Floats:
    """Return the unit normals (n, 3) at parameters u, v; a mirror image keeps its outside outside."""
    return np.asarray(unit_normals(patch.surface.jet(u, v)) @ patch.motion[:3, :3].T)


def _margins(patch: Patch, u: Floats, v: Floats) -> Floats:
    points = patch.surface.jet(u, v).point
    return np.asarray(np.minimum.reduce([np.full(len(u), np.inf), *(side(points) for side in patch.sides)]))


def kept(patch: Patch, u: Floats, v: Floats) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return whether parameters u, v, each (n,), lie in the ranges and on the kept side of every crop, (n,)."""
    inside = (u >= patch.u[0]) & (u <= patch.u[1]) & (v >= patch.v[0]) & (v <= patch.v[1])
    return np.asarray(inside & (_margins(patch, u, v) >= 0.0))


def _overlap(name: str, old: tuple[float, float], new: tuple[float, float] | None) -> tuple[float, float]:
    if new is None:
        return old
    low, high = max(old[0], new[0]), min(old[1], new[1])
    if low >= high:
        raise SurfaceError(
            f"patch: nothing is left of {name} in [{old[0]:g}, {old[1]:g}] after the crop to [{new[0]:g}, {new[1]:g}]; "
            "choose ranges that overlap"
        )
    return low, high


def cropped(patch: Patch, u: tuple[float, float] | None = None, v: tuple[float, float] | None = None) -> Patch:
    """Return the patch cropped to ranges of its parameters; SurfaceError if nothing is left."""
    return replace(patch, u=_overlap("u", patch.u, u), v=_overlap("v", patch.v, v))


def cropped_by_plane(patch: Patch, origin: Vector, normal: Vector) -> Patch:
    """Return the patch cropped by the plane through origin, as both stand; kept is where the normal points to."""
    motion, direction = patch.motion, unit(np.array(normal))

    def side(points: Floats) -> Floats:
        return np.asarray((_applied(motion, points) - np.array(origin)) @ direction)

    return replace(patch, sides=(*patch.sides, side))


def copied(patch: Patch, motion: Floats) -> Patch:
    """Return a copy of the patch, with its crops, moved by a motion (4, 4)."""
    return replace(patch, motion=motion @ patch.motion)


def flipped(patch: Patch, origin: Vector = (0.0, 0.0, 0.0), normal: Vector = (0.0, 0.0, 1.0)) -> Patch:
    """Return the mirror image of the patch in a plane, upside down unless a plane is given."""
    return copied(patch, reflection(origin, normal))


def polar_array(patch: Patch, count: int) -> tuple[Patch, ...]:
    """Return copies of the patch at equal angles about the vertical axis through the origin, the patch first."""
    return tuple(copied(patch, turn(2.0 * math.pi * i / count)) for i in range(count))


def _axis_x(surface: Surface) -> float:
    if isinstance(surface, AsymptoticChart):
        return surface.surface.axis_x
    if isinstance(surface, RevolutionSurface):
        return surface.axis_x
    raise SurfaceError(f"patch: a {type(surface).__name__} has no axis; intersect surfaces of revolution only")


def _meridian_radii(patch: Patch, heights: Floats) -> Floats:
    """Return the radius (n,) of a patch's surface of revolution at heights (n,), of its ends beyond them."""
    axis = _axis_x(patch.surface)

    def meridian(u: Floats) -> tuple[Floats, Floats, Floats]:
        jet = patch.surface.jet(u, np.zeros_like(u))
        return jet.point[:, 0] - axis, jet.point[:, 2], jet.du[:, 2]

    table = np.linspace(*patch.u, _TABLE)
    z = meridian(table)[1]
    wanted = np.clip(heights, z[0], z[-1])
    u = np.interp(wanted, z, table)
    for _ in range(_NEWTON_STEPS):
        _radius, height, rise = meridian(u)
        u = np.clip(u - (height - wanted) / rise, *patch.u)
    return meridian(u)[0]


def distance_outside(patch: Patch, points: Floats) -> Floats:
    """Return how far points (n, 3) lie off a patch's surface of revolution, along the radius, mm, (n,).

    Positive away from its axis; SurfaceError if the surface is not one of revolution.
    """
    local = _applied(np.asarray(np.linalg.inv(patch.motion), dtype=np.float64), points)
    return np.asarray(np.hypot(local[:, 0] - _axis_x(patch.surface), local[:, 1]) - _meridian_radii(patch, local[:, 2]))


def intersected(patches: Sequence[Patch]) -> tuple[Patch, ...]:
    """Return patches of surfaces of revolution, each cropped where it would pass through another to its axis.

    Kept is what lies outside all other surfaces, seen from their axes: the shells under the ridges (paper, Fig. 2d).
    Axes are vertical, meridians rise with u. SurfaceError if a surface is not one of revolution.
    """

    def beyond(patch: Patch, other: Patch) -> Callable[[Floats], Floats]:
        return lambda points: distance_outside(other, _applied(patch.motion, points))

    return tuple(
        replace(patch, sides=(*patch.sides, *(beyond(patch, other) for other in patches if other is not patch)))
        for patch in patches
    )


def border(patch: Patch, count: int) -> Floats:
    """Return points (n, 3) on the border: ends of the ranges, and crops met along ``count`` lines v = const."""
    u, v = np.linspace(*patch.u, count), np.linspace(*patch.v, count)
    grid_u, grid_v = np.meshgrid(u, v, indexing="ij")
    keeps = _margins(patch, grid_u.ravel(), grid_v.ravel()).reshape(count, count) >= 0.0
    outer = np.zeros_like(keeps)
    outer[[0, -1], :] = outer[:, [0, -1]] = True
    rows, columns = np.nonzero(keeps[1:] != keeps[:-1])
    low, high, there = u[rows], u[rows + 1], v[columns]
    for _ in range(_HALVINGS):
        middle = (low + high) / 2.0
        as_low = (_margins(patch, middle, there) >= 0.0) == keeps[rows, columns]
        low, high = np.where(as_low, middle, low), np.where(as_low, high, middle)
    ends = patch_points(patch, grid_u[outer & keeps], grid_v[outer & keeps])
    return np.concatenate([ends, patch_points(patch, low, there)])


def joined(patches: Iterable[Patch], gap: float, count: int = 121) -> tuple[Patch, ...]:
    """Return the patches as one shell; SurfaceError if not all hang together by borders at most ``gap`` mm apart."""
    listed = tuple(patches)
    borders = [border(patch, count) for patch in listed]

    def apart(i: int, j: int) -> float:
        return float(np.min(cKDTree(borders[i]).query(borders[j])[0]))

    reached, waiting = {0}, set(range(1, len(listed)))
    while waiting:
        distances = {i: min(apart(i, j) for j in sorted(reached)) for i in sorted(waiting)}
        near = {i for i, distance in distances.items() if distance <= gap}
        if not near:
            i = min(waiting)
            raise SurfaceError(
                f"patch {i + 1}: stands {distances[i]:.1f} mm off the others, allowed {gap:g} mm; move it there"
            )
        reached, waiting = reached | near, waiting - near
    return listed
