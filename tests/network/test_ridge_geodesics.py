"""The ridge: where two shells meet, and the geodesic planks that follow it at a set-back."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aag_cad.design import Design
from aag_cad.errors import NetworkError
from aag_cad.geometry.profiles import CrpcProfile
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface
from aag_cad.network.model import CurveId, CurveNetwork, NetworkCurve
from aag_cad.network.ridge import ridge_coordinate, ridge_distance
from aag_cad.units import Floats


def vault_chart() -> AsymptoticChart:
    return AsymptoticChart(RevolutionSurface(CrpcProfile(5100.0, 3.0), -8823.0))


def ridge_planks(network: CurveNetwork) -> list[NetworkCurve]:
    return [item for item in network.curves if item.id in (CurveId("E", 2), CurveId("E", 3))]


def points_of(item: NetworkCurve) -> Floats:
    return np.asarray(item.curve.point_spline(np.linspace(item.start, item.end, 300)))


@given(
    count=st.integers(3, 12), height=st.floats(0.0, 5000.0), out=st.floats(0.0, 5000.0), off=st.floats(-500.0, 500.0)
)
def test_ridge_planes_stand_through_the_centre_halfway_between_two_shells(
    count: int, height: float, out: float, off: float
) -> None:
    """A point of the plane at 180/count degrees from -x has no distance; to its inner side it is positive."""
    half = math.pi / count
    plane, inward = np.array([-math.cos(half), math.sin(half)]), np.array([-math.sin(half), -math.cos(half)])
    x, y = out * plane + off * inward
    if y >= 0.0:
        assert ridge_distance(np.array([[x, y, height]]), count)[0] == pytest.approx(off, abs=1e-9)


@pytest.mark.parametrize("theta_deg", [0.0, 3.0, 11.0, 20.0, 30.0])
def test_the_ridge_of_the_vault_in_plan(theta_deg: float) -> None:
    """About the shell's own axis r = (sqrt(3)/2) D / sin(theta + 60 degrees)."""
    chart, theta = vault_chart(), math.radians(theta_deg)
    s = ridge_coordinate(chart, theta, 3, 0.0)
    radius = 5100.0 * math.cosh(math.sqrt(3.0) * s) ** (1.0 / 3.0)
    expected = math.sqrt(3.0) / 2.0 * 8823.0 / math.sin(theta + math.pi / 3.0)
    assert radius == pytest.approx(expected, rel=1e-9)


def test_at_the_side_the_meridian_meets_the_ridge_plane_at_right_angles_in_plan() -> None:
    """There the shell is lowest along its ridge: the arch of the entry."""
    theta = np.radians([28.0, 29.0, 30.0])
    chart = vault_chart()
    heights = [
        float(chart.jet(np.array([ridge_coordinate(chart, float(t), 3, 0.0)]), np.array([t])).point[0, 2])
        for t in theta
    ]
    assert heights[0] > heights[1] > heights[2]
    assert (heights[0] - heights[1]) / (heights[1] - heights[2]) == pytest.approx(3.0, rel=0.02)


def test_the_ridge_planks_keep_the_set_back_and_are_as_close_as_a_geodesic_can_be(
    design: Design, network: CurveNetwork
) -> None:
    """Nowhere nearer than 90 mm (the solver stops within 0.1 mm), nearest at 90 mm, and nowhere far from it."""
    for item in ridge_planks(network):
        distance = ridge_distance(points_of(item), 3)
        assert distance.min() == pytest.approx(design.boundary.ridge_setback, abs=0.1)
        assert distance.max() < design.boundary.ridge_setback + 25.0


def test_the_ridge_planks_do_not_follow_the_grid(design: Design, network: CurveNetwork) -> None:
    """They are misaligned (section 2.2): neither s - theta nor s + theta nor theta stays constant along them."""
    item = ridge_planks(network)[1]
    points = points_of(item)
    x, y = points[:, 0] + design.shells.axis_distance, points[:, 1]
    theta = np.arctan2(y, x)
    s = np.arccosh((np.hypot(x, y) / 5100.0) ** 3) / math.sqrt(3.0)
    for constant in (theta, theta - s, theta + s):
        assert np.ptp(constant) > 2.0 * design.step


def test_clairaut_holds_along_the_ridge_planks(design: Design, network: CurveNetwork) -> None:
    """Radius times the sine of the angle to the meridian: constant to a tenth of a millimetre."""
    for item in ridge_planks(network):
        points, tangent = points_of(item), item.curve.point_spline(np.linspace(item.start, item.end, 300), nu=1)
        x, y = points[:, 0] + design.shells.axis_distance, points[:, 1]
        constant = (x * tangent[:, 1] - y * tangent[:, 0]) / np.linalg.norm(tangent, axis=1)
        assert np.ptp(constant) < 0.1


def test_the_ridge_planks_end_at_the_crown_beside_the_plane_of_symmetry(design: Design, network: CurveNetwork) -> None:
    """Square ends: the nearer corner keeps half of the end gap to the plane y = 0, so both planks keep the gap."""
    for item, side in zip(ridge_planks(network), (-1.0, 1.0), strict=True):
        tip = item.curve.point_spline(np.array([item.end]))[0]
        tangent = item.curve.point_spline(np.array([item.end]), nu=1)[0]
        across = np.cross(item.curve.normal_spline(np.array([item.end]))[0], tangent)
        half = design.timber.width / 2.0 * across / np.linalg.norm(across)
        nearest = min(side * (tip + half)[1], side * (tip - half)[1])
        assert nearest == pytest.approx(design.boundary.end_gap / 2.0, abs=0.3)


def test_nothing_of_the_network_crosses_the_ridge_plane(network: CurveNetwork) -> None:
    for item in network.curves:
        assert ridge_distance(points_of(item), 3).min() > 0.0


def test_a_surface_that_never_reaches_the_ridge_is_refused() -> None:
    chart = AsymptoticChart(RevolutionSurface(CrpcProfile(5100.0, 3.0), -200_000.0))
    with pytest.raises(NetworkError, match=r"shells\.axis_distance: the surface ends .* at 10\.0 degrees; reduce"):
        ridge_coordinate(chart, math.radians(10.0), 3, 0.0)


def test_a_neck_beyond_the_ridge_is_refused() -> None:
    chart = AsymptoticChart(RevolutionSurface(CrpcProfile(5100.0, 3.0), -5000.0))
    with pytest.raises(NetworkError, match=r"shells\.axis_distance: the neck .* at 10\.0 degrees; enlarge"):
        ridge_coordinate(chart, math.radians(10.0), 3, 0.0)
