"""The optimiser: from rotational surfaces that are not CRPC to AAG webs of a constant angle, and how it fails."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from aag_cad.errors import DesignError
from aag_cad.geometry.profiles import CrpcProfile, HyperboloidProfile, Profile, SplineProfile
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface
from aag_cad.web.energies import a_net, bottom_curve, constant_angle, geodesic
from aag_cad.web.goals import Goals, Optimised, PointGoal
from aag_cad.web.optimise import Method, mean_edge, optimise
from aag_cad.web.quality import quality
from aag_cad.web.unknowns import control_map, mirrored
from aag_cad.web.web import Web, crpc_web, sampled_web

ANGLE = math.radians(120.0)
HALF = math.radians(30.0)


def circular_arc() -> SplineProfile:
    """A meridian of one radius, 3 m, at a neck of 5.1 m: A lines at 105 to 131 degrees."""
    angles = np.linspace(-0.45, 1.25, 60)
    return SplineProfile(tuple((5100.0 + 3000.0 * (1 - math.cos(a)), 3000.0 * math.sin(a)) for a in angles))


def start_web(profile: Profile, density: int, rows: int = 19) -> Web:
    """A web of 20 x ``rows`` coarse cells, each cut ``density`` times, and one ghost row under the ground line."""
    step = HALF / 10.0 / density
    chart = AsymptoticChart(RevolutionSurface(profile, -8823.0))
    s = np.arange(-1, rows * density + 1) * step
    return sampled_web(chart, s, np.linspace(-HALF, HALF, 20 * density + 1))


def goals_for(web: Web) -> Goals:
    middle = web.vertices.shape[1] // 2
    return Goals(angle=ANGLE, bottom_row=1, height=float(web.vertices[-1, middle, 2]))


@cache
def from_arc(density: int) -> tuple[Web, Optimised]:
    web = start_web(circular_arc(), density)
    return web, optimise(web, goals_for(web))


@pytest.mark.parametrize("density", [1, 2, 4])
def test_a_circular_arc_becomes_a_web_of_60_degree_nodes(density: int) -> None:
    """About 400, 1 600 and 6 300 vertices; angles of 105 to 131 degrees at the start."""
    web, found = from_arc(density)
    before, after = quality(web), quality(found.web)
    assert before.angle_aa_deg.max - before.angle_aa_deg.min > 20.0
    assert found.success, found.explanation
    assert after.planarity_per_edge <= 1e-7
    assert after.geodesic_deviation_deg <= 1e-3
    assert max(60.0 - after.angle_aa_deg.min, after.angle_aa_deg.max - 60.0) <= 1e-5


def test_the_bottom_is_flat_the_height_held_and_the_symmetry_exact() -> None:
    web, found = from_arc(2)
    v, middle = found.web.vertices, web.vertices.shape[1] // 2
    assert np.abs(v[1, :, 2]).max() <= 1e-4, "1e-7 m"
    assert v[-1, middle, 2] == pytest.approx(web.vertices[-1, middle, 2], rel=0.01)
    mirror = v[:, ::-1] * np.array([1.0, -1.0, 1.0])
    # Both halves come from the same unknowns; what is left is the rounding of coordinates of some metres.
    np.testing.assert_allclose(v, mirror, atol=1e-10)


def test_the_web_is_another_surface_than_the_start_but_of_its_size() -> None:
    web, found = from_arc(1)
    moved = np.linalg.norm(found.web.vertices - web.vertices, axis=-1)
    assert 50.0 < moved.max() < 1500.0
    assert quality(found.web).normal_turning_deg > 0.7 * quality(web).normal_turning_deg


@pytest.mark.parametrize(
    ("profile", "rows"), [(CrpcProfile(5100.0, 1.0), 19), (HyperboloidProfile(5100.0, 4000.0), 12)], ids=str
)
def test_catenoid_and_hyperboloid_converge_with_their_height_held(profile: Profile, rows: int) -> None:
    web = start_web(profile, 1, rows)
    found = optimise(web, goals_for(web))
    assert found.success, found.explanation
    assert found.web.vertices[-1, 10, 2] == pytest.approx(web.vertices[-1, 10, 2], rel=0.01)


def test_a_shaken_exact_web_comes_back() -> None:
    """2 % of the mean edge of noise on the exact discrete CRPC web: residuals of 1e-12 again."""
    theta = np.linspace(-HALF, HALF, 21)
    exact = crpc_web(5100.0, 3.0, -8823.0, theta, 1, 19)
    edge = mean_edge(exact.vertices)
    noise = 0.02 * edge * np.random.default_rng(7).normal(size=exact.vertices.shape)
    noise = (noise + noise[:, ::-1] * np.array([1.0, -1.0, 1.0])) / 2.0
    found = optimise(Web(exact.vertices + noise), Goals(angle=ANGLE, bottom_row=1))
    scaled = Web(found.web.vertices / edge)
    terms = (a_net(scaled), geodesic(scaled), constant_angle(scaled, ANGLE), bottom_curve(scaled, 1))
    assert sum(term.energy for term in terms) <= 1e-12
    assert found.success, found.explanation


def test_an_exact_web_comes_back_untouched() -> None:
    exact = crpc_web(5100.0, 3.0, -8823.0, np.linspace(-HALF, HALF, 21), 1, 19)
    found = optimise(exact, Goals(angle=ANGLE, bottom_row=1))
    assert found.success
    assert found.iterations == ()
    assert found.web is exact


def test_fairness_on_positions_flattens_the_web_and_is_caught() -> None:
    """Eq. (6) read literally: a flat lattice is a perfect zero of every other energy."""
    web = start_web(circular_arc(), 1)
    free = Goals(angle=ANGLE, bottom_row=1)
    found = optimise(web, free, method=Method(fair_positions=True))
    assert not found.success
    assert found.reason in ("collapsed", "left the design's range")
    assert optimise(web, free).success, "on displacements the same start converges"


def test_weights_replace_those_of_the_paper_by_name() -> None:
    web = start_web(circular_arc(), 1)
    first = optimise(web, goals_for(web)).iterations[0].energies
    heavier = optimise(web, replace(goals_for(web), weights={"angle": 4.0, "bottom": 1.0})).iterations[0].energies
    assert heavier["angle"] == pytest.approx(4.0 * first["angle"])
    assert heavier["bottom"] == pytest.approx(first["bottom"] / 10.0), "Eq. (7) weighs the bottom curve by 10"
    assert heavier["A-net"] == first["A-net"]


def test_levenberg_marquardt_reaches_the_same_goals() -> None:
    web = start_web(circular_arc(), 1)
    found = optimise(web, goals_for(web), method=Method(levenberg_marquardt=True))
    assert found.success, found.explanation


def test_every_iteration_is_reported_with_every_energy() -> None:
    web = start_web(circular_arc(), 1)
    seen = []
    found = optimise(web, goals_for(web), seen.append)
    assert tuple(seen) == found.iterations
    assert {item.stage for item in seen} == {"spline", "mesh"}
    assert all(set(item.energies) == {"A-net", "geodesic", "angle", "bottom", "height"} for item in seen)
    last = seen[-1].energies
    assert sum(last.values()) < 1e-10 * sum(seen[0].energies.values())


def test_goals_that_contradict_each_other_are_no_success() -> None:
    """Held at the start everywhere the arc cannot have a constant angle."""
    web = start_web(circular_arc(), 1)
    found = optimise(web, Goals(angle=ANGLE, bottom_row=1, closeness=1.0))
    assert not found.success
    assert found.reason == "stalled"
    assert "allowed" in found.explanation


def test_a_point_is_held_where_it_is_asked() -> None:
    web = start_web(circular_arc(), 1)
    x, _, z = web.vertices[-1, 10]
    goal = PointGoal(20, 10, (float(x) + 100.0, 0.0, float(z) + 50.0))
    found = optimise(web, Goals(angle=ANGLE, bottom_row=1, points=(goal,)))
    assert found.success, found.explanation
    np.testing.assert_allclose(found.web.vertices[20, 10], goal.point, atol=0.01)


def test_one_sided_terms_keep_planks_from_bending_too_sharply() -> None:
    web = start_web(circular_arc(), 1)
    free = optimise(web, goals_for(web))
    before = quality(free.web).smallest_radius_g
    wish = Goals(angle=ANGLE, bottom_row=1, min_radius=before * 1.15)
    held = optimise(web, wish)
    assert held.success, held.explanation
    assert quality(held.web).smallest_radius_g >= 0.99 * wish.min_radius  # type: ignore[operator]


def test_a_web_that_is_too_small_or_has_no_ghost_row_is_refused() -> None:
    web = start_web(circular_arc(), 1)
    with pytest.raises(DesignError, match="at least 8 x 8"):
        optimise(Web(web.vertices[:5]), Goals(angle=ANGLE))
    with pytest.raises(DesignError, match=r"optimise\.bottom_row: 0"):
        optimise(web, Goals(angle=ANGLE, bottom_row=0))


@pytest.mark.parametrize("columns", [6, 7])
def test_the_symmetry_map_mirrors_every_free_point(columns: int) -> None:
    unknowns = mirrored(4, columns, True)
    rng = np.random.default_rng(1)
    grid = (unknowns @ rng.normal(size=unknowns.shape[1])).reshape(4, columns, 3)
    np.testing.assert_array_equal(grid, grid[:, ::-1] * np.array([1.0, -1.0, 1.0]))
    assert unknowns.shape[1] == 4 * (3 * columns // 2 if columns % 2 == 0 else 3 * (columns // 2) + 2)
    assert mirrored(4, columns, False).shape == (12 * columns, 12 * columns)


def test_a_control_net_on_a_plane_gives_points_on_that_plane() -> None:
    """B-splines reproduce linear functions at the Greville points; equal knots give x = u at equal controls inside."""
    rows, columns = np.linspace(0.0, 4.0, 9), np.linspace(0.0, 6.0, 13)
    to_points = control_map(rows, columns, ((0.0, 4.0), (0.0, 6.0)), (8, 9))
    controls = np.zeros((8, 9, 3))
    controls[..., 2] = 5.0
    points = (to_points @ controls.ravel()).reshape(9, 13, 3)
    np.testing.assert_allclose(points[..., 2], 5.0, atol=1e-12)
