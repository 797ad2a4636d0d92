"""Patches: crop, flip, copy, rotate, intersect and join leave the surface as it is and keep what they should."""

import math
from dataclasses import replace

import numpy as np
import pytest
from patches import (
    Patch,
    border,
    copied,
    cropped,
    cropped_by_plane,
    distance_outside,
    flipped,
    intersected,
    joined,
    kept,
    patch_normals,
    patch_points,
    polar_array,
    reflection,
    shift,
)

from aag_cad.errors import SurfaceError
from aag_cad.geometry.profiles import CrpcProfile, HyperboloidProfile
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface, turn
from aag_cad.geometry.surface import Jet
from aag_cad.units import Floats

R0 = 5100.0
HALF = math.radians(30.0)


@pytest.fixture(scope="module")
def patch() -> Patch:
    """A sector of the vault's surface, its axis 8.823 m from the origin on -x."""
    chart = AsymptoticChart(RevolutionSurface(CrpcProfile(R0, 3.0), -8823.0))
    return Patch(chart, (0.0, 0.8), (-HALF, HALF))


def grid(patch: Patch, count: int = 25) -> tuple[Floats, Floats]:
    """Return parameters (count^2,) over the ranges of a patch."""
    u, v = np.meshgrid(np.linspace(*patch.u, count), np.linspace(*patch.v, count))
    return u.ravel(), v.ravel()


def test_a_crop_by_ranges_keeps_what_both_allow(patch: Patch) -> None:
    smaller = cropped(cropped(patch, u=(0.2, 2.0)), v=(-9.0, 0.1))
    assert smaller.u == (0.2, 0.8)
    assert smaller.v == (-HALF, 0.1)
    assert list(kept(smaller, np.array([0.1, 0.3, 0.3]), np.array([0.0, 0.0, 0.2]))) == [False, True, False]


def test_a_crop_to_nothing_is_refused_with_both_ranges(patch: Patch) -> None:
    with pytest.raises(SurfaceError, match=r"nothing is left of u in \[0, 0\.8\] after the crop to \[1, 2\]"):
        cropped(patch, u=(1.0, 2.0))


def test_a_plane_keeps_the_side_that_its_normal_points_to(patch: Patch) -> None:
    half = cropped_by_plane(patch, (0.0, 500.0, 0.0), (0.0, -2.0, 0.0))
    u, v = grid(half)
    np.testing.assert_array_equal(kept(half, u, v), patch_points(half, u, v)[:, 1] <= 500.0)


def test_the_border_of_a_crop_lies_in_its_plane_or_on_the_ranges(patch: Patch) -> None:
    """A slanted plane cuts the sector: along every meridian that it crosses, the border point is in it to 1e-6 mm."""
    normal = np.array([-1.0, 0.0, -1.0]) / math.sqrt(2.0)
    cut = cropped_by_plane(patch, (-2500.0, 0.0, 1200.0), (-1.0, 0.0, -1.0))
    signed = (border(cut, 41) - np.array([-2500.0, 0.0, 1200.0])) @ normal
    assert np.count_nonzero(np.abs(signed) < 1e-6) >= 41
    assert signed.min() > -1e-6


def test_a_copy_takes_its_crops_along(patch: Patch) -> None:
    half = cropped_by_plane(patch, (0.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    away = copied(half, shift(np.array([0.0, 7000.0, 0.0])) @ turn(math.pi))
    u, v = grid(half)
    np.testing.assert_array_equal(kept(away, u, v), kept(half, u, v))
    before, after = patch_points(half, u, v), patch_points(away, u, v)
    np.testing.assert_allclose(after, before * [-1.0, -1.0, 1.0] + [0.0, 7000.0, 0.0], atol=1e-9)


def test_a_plane_set_after_a_move_stands_where_it_is_given(patch: Patch) -> None:
    moved = cropped_by_plane(copied(patch, shift(np.array([1000.0, 0.0, 0.0]))), (0.0, 0.0, 400.0), (0.0, 0.0, 1.0))
    u, v = grid(moved)
    np.testing.assert_array_equal(kept(moved, u, v), patch_points(moved, u, v)[:, 2] >= 400.0)


def test_flipping_turns_a_patch_upside_down_and_keeps_its_outside(patch: Patch) -> None:
    """The neck stays, heights change sign, and the normals, towards the axis above, look to the axis below as well."""
    u, v = grid(patch)
    down = flipped(patch)
    np.testing.assert_allclose(patch_points(down, u, v), patch_points(patch, u, v) * [1.0, 1.0, -1.0], atol=1e-9)
    inward = np.array([-8823.0, 0.0, 0.0]) - patch_points(down, u, v)
    assert np.all(np.sum(patch_normals(down, u, v)[:, :2] * inward[:, :2], axis=1) > 0.0)


def test_flipping_twice_gives_the_patch_again(patch: Patch) -> None:
    np.testing.assert_allclose(flipped(flipped(patch)).motion, np.eye(4), atol=1e-15)
    skew = reflection((10.0, -4.0, 7.0), (1.0, 2.0, 3.0))
    np.testing.assert_allclose(skew @ skew, np.eye(4), atol=1e-12)
    assert np.linalg.det(skew) == pytest.approx(-1.0)


def test_the_flipped_crpc_surface_is_its_own_continuation_under_the_neck(patch: Patch) -> None:
    u, v = grid(patch)
    np.testing.assert_allclose(patch_points(flipped(patch), u, v), patch.surface.jet(-u, v).point, atol=1e-8)


def test_a_polar_array_closes_after_a_full_turn(patch: Patch) -> None:
    copies = polar_array(patch, 5)
    u, v = grid(patch)
    assert len(copies) == 5
    centre = np.mean([patch_points(copy, u, v).mean(axis=0) for copy in copies], axis=0)
    np.testing.assert_allclose(centre[:2], 0.0, atol=1e-8)
    np.testing.assert_allclose(turn(2.0 * math.pi / 5.0) @ copies[4].motion, np.eye(4), atol=1e-12)


def test_equal_surfaces_about_a_centre_are_cropped_in_the_planes_between_them(patch: Patch) -> None:
    """Three congruent surfaces, 120 degrees apart, meet where y = -x tan 60 degrees (and its mirror image)."""
    first = intersected(polar_array(replace(patch, u=(0.0, 1.2)), 3))[0]
    u, v = grid(first)
    points = patch_points(first, u, v)
    inside = -math.sin(math.pi / 3.0) * points[:, 0] - math.cos(math.pi / 3.0) * np.abs(points[:, 1])
    clear = np.abs(inside) > 1e-3
    np.testing.assert_array_equal(kept(first, u, v)[clear], inside[clear] > 0.0)
    assert 0.2 < kept(first, u, v).mean() < 1.0


def test_the_border_of_an_intersection_lies_on_both_surfaces() -> None:
    """A hyperboloid and a CRPC surface of other sizes: the crop is their curve of intersection, to 1e-6 mm."""
    one = Patch(AsymptoticChart(RevolutionSurface(CrpcProfile(4000.0, 2.0), -6000.0)), (0.0, 1.0), (-0.6, 0.6))
    two = Patch(RevolutionSurface(HyperboloidProfile(3500.0, 3000.0), 3500.0), (0.0, 1.2), (2.5, 3.8))
    first, second = intersected((one, two))
    for mine, other in ((first, second), (second, first)):
        off = distance_outside(other, border(mine, 31))
        assert np.count_nonzero(np.abs(off) < 1e-6) > 10
        assert off.min() > -1e-6


def test_surfaces_without_axis_cannot_be_intersected(patch: Patch) -> None:
    class Plane:
        """The plane z = 0."""

        def jet(self, u: Floats, v: Floats) -> Jet:
            """Return the 2-jet."""
            o = np.zeros_like(u)
            point, du, dv = np.column_stack([u, v, o]), np.column_stack([o + 1, o, o]), np.column_stack([o, o + 1, o])
            return Jet(point, du, dv, 0 * du, 0 * du, 0 * du)

    with pytest.raises(SurfaceError, match="a Plane has no axis"):
        kept(intersected((patch, Patch(Plane(), (0.0, 1.0), (0.0, 1.0))))[0], *grid(patch))


def test_patches_are_joined_along_a_common_border_only(patch: Patch) -> None:
    """Column and roof share the neck; moved apart by 50 mm they no longer hang together."""
    pair = (patch, flipped(patch))
    assert joined(pair, gap=1e-6) == pair
    apart = copied(flipped(patch), shift(np.array([0.0, 0.0, -50.0])))
    with pytest.raises(SurfaceError, match=r"patch 2: stands 50\.0 mm off the others, allowed 1 mm"):
        joined((patch, apart), gap=1.0)


def test_neighbours_hang_together_through_others(patch: Patch) -> None:
    """Four sectors side by side: the fourth touches the third, not the first."""
    about = [
        shift(np.array([-8823.0, 0.0, 0.0])) @ turn(2 * HALF * i) @ shift(np.array([8823.0, 0.0, 0.0]))
        for i in range(4)
    ]
    ring = tuple(copied(patch, motion) for motion in about)
    assert joined(ring, gap=1e-6) == ring
