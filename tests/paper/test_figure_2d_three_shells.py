"""Fig. 2d: three individual rotational surfaces, intersected and cropped to a vault with three entryways.

Not asserted: designs a to c of the figure (flipped, half, and rotated copies of one surface).
"""

import math

import numpy as np
import pytest

from aag_cad.geometry.revolution import AsymptoticChart
from aag_cad.network.ridge import ridge_coordinate
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Gridshell
from aag_cad.units import Floats


def ridge_points(chart: AsymptoticChart) -> Floats:
    """Return points of the first shell's surface in its ridge plane on the side y > 0, from entry to crown."""
    theta = np.linspace(math.pi / 6.0, 0.0, 13)
    s = np.array([ridge_coordinate(chart, float(angle), 3, 0.0) for angle in theta])
    return chart.jet(s, theta).point


def in_shell(gridshell: Gridshell, index: int, points: Floats) -> Floats:
    """Return points of the vault in the coordinates of a shell."""
    return points @ frame_matrix(gridshell.shells[index].placement)[:3, :3]


def test_two_shells_meet_in_the_ridge(chart: AsymptoticChart, gridshell: Gridshell) -> None:
    """The ridge of one surface lies on its neighbour's as well: there too the radius from the axis fits the height."""
    points = ridge_points(chart)
    radius = np.hypot(points[:, 0] + 8823.0, points[:, 1])
    neighbours = [in_shell(gridshell, i, points) for i in (1, 2)]
    radii = [np.hypot(local[:, 0] + 8823.0, local[:, 1]) for local in neighbours]
    assert min(float(np.abs(other - radius).max()) for other in radii) < 1e-6


def test_the_third_shell_meets_them_at_the_crown_only(chart: AsymptoticChart, gridshell: Gridshell) -> None:
    points = ridge_points(chart)
    radius = np.hypot(points[:, 0] + 8823.0, points[:, 1])
    far = max(
        (np.hypot(*(in_shell(gridshell, i, points)[:, :2] + [8823.0, 0.0]).T) - radius for i in (1, 2)),
        key=lambda gap: float(np.abs(gap).max()),
    )
    assert abs(far[-1]) < 1e-6
    assert np.all(np.abs(far[:-1]) > 10.0)


def test_the_axes_stand_outside_the_vault_120_degrees_apart(chart: AsymptoticChart, gridshell: Gridshell) -> None:
    """Each shell is a patch around its own vertical axis, 8.823 m from the centre: 3.7 m at least inside the axis."""
    axes = np.array(
        [frame_matrix(shell.placement)[:3, :3] @ [chart.surface.axis_x, 0.0, 0.0] for shell in gridshell.shells]
    )
    np.testing.assert_allclose(np.linalg.norm(axes, axis=1), 8823.0)
    np.testing.assert_allclose(axes.sum(axis=0), 0.0, atol=1e-9)


def test_there_are_three_arched_entries(chart: AsymptoticChart) -> None:
    """Between the feet of two shells 5.1 m are open, under an arch of 2.43 m, lower than the crown of 2.72 m."""
    points = ridge_points(chart)
    neck = chart.jet(np.array([0.0]), np.array([math.pi / 6.0])).point[0]
    to_plane = -math.sqrt(3.0) / 2.0 * neck[0] - neck[1] / 2.0
    assert 2.0 * to_plane == pytest.approx(5081.9, abs=0.5)
    assert points[0, 2] == pytest.approx(2430.0, abs=5.0)
    assert points[-1, 2] == pytest.approx(2720.0, abs=2.0)
    assert np.all(np.diff(points[:, 2]) > 0.0)


def test_the_crown_is_the_centre_of_the_vault(chart: AsymptoticChart) -> None:
    np.testing.assert_allclose(ridge_points(chart)[-1, :2], 0.0, atol=1e-6)


def test_every_shell_leans_in_from_a_vertical_foot(chart: AsymptoticChart) -> None:
    """At the ground the surface is vertical, above it leans towards the visitor and ends with a slope of 11 degrees."""
    s = np.array([0.0, ridge_coordinate(chart, 0.0, 3, 0.0)])
    slope = chart.jet(s, np.zeros(2)).du
    angle = np.degrees(np.arctan2(slope[:, 2], slope[:, 0]))
    assert angle[0] == pytest.approx(90.0, abs=1e-6)
    assert angle[1] == pytest.approx(math.degrees(math.asin((5100.0 / 8823.0) ** 3)), abs=1e-6)
    assert angle[1] == pytest.approx(11.1, abs=0.1)
