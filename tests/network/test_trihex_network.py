"""The tri-hex network of one shell: which curves it has, where they cross, and what its triangles are."""

import math
from collections import Counter
from itertools import pairwise

import numpy as np
import pytest

from aag_cad.design import Design
from aag_cad.geometry.framed import curvatures_at, frames_at
from aag_cad.geometry.revolution import AsymptoticChart
from aag_cad.network.build import shell_network
from aag_cad.network.model import Crossing, CrossingKind, CurveId, CurveNetwork, NetworkCurve
from aag_cad.units import Floats

SQRT3 = math.sqrt(3.0)
# The curves are quintic splines through samples 150 mm apart: their curvatures are good to 1e-7 1/mm.
SPLINE_CURVATURE = 1e-7


def of_kind(network: CurveNetwork, *kinds: CrossingKind) -> list[Crossing]:
    return [crossing for crossing in network.crossings if crossing.kind in kinds]


def along(network: CurveNetwork, curve: CurveId) -> list[Crossing]:
    """Return the crossings on a curve in the order of their stations."""
    found = [crossing for crossing in network.crossings if curve in crossing.curves]
    return sorted(found, key=lambda crossing: crossing.stations[crossing.curves.index(curve)])


def beams(network: CurveNetwork) -> list[NetworkCurve]:
    return [item for item in network.curves if item.id.family in ("A1", "A2")]


def chart_places(design: Design, points: Floats) -> Floats:
    """Return (s, theta) of points (n, 3) of the vault in closed form: cosh(s sqrt 3) = (r / r0)^3."""
    x, y = points[:, 0] + design.shells.axis_distance, points[:, 1]
    cosh = np.maximum((np.hypot(x, y) / 5100.0) ** 3, 1.0)
    return np.column_stack([np.arccosh(cosh) / SQRT3, np.arctan2(y, x)])


def lattice(design: Design, chart: AsymptoticChart) -> set[tuple[int, int]]:
    """Return the AA nodes (k, j) at theta = k delta, s = (j + 1/2) delta, k + j even, clear of foot and ridge."""
    nodes = set()
    for k in range(-6, 7):
        for j in range(20):
            if (k + j) % 2 == 0:
                point = chart.jet(np.array([(j + 0.5) * design.step]), np.array([k * design.step])).point[0]
                ridge = -SQRT3 / 2.0 * point[0] - abs(point[1]) / 2.0
                if ridge >= 150.0 and point[2] >= 100.0:
                    nodes.add((k, j))
    return nodes


def without_short_beams(nodes: set[tuple[int, int]], least: int) -> set[tuple[int, int]]:
    """Return the nodes that stay when beams with fewer nodes than ``least`` are left out, one round after another."""
    while True:
        count = Counter(line for k, j in nodes for line in (("A1", k - j), ("A2", k + j)))
        kept = {(k, j) for k, j in nodes if min(count["A1", k - j], count["A2", k + j]) >= least}
        if kept == nodes:
            return kept
        nodes = kept


def test_a_shell_has_eleven_beams_of_either_family_fourteen_geodesics_and_three_edges(network: CurveNetwork) -> None:
    assert Counter(item.id.family for item in network.curves) == {"A1": 11, "A2": 11, "G": 14, "E": 3}


def test_curves_are_numbered_without_gaps(network: CurveNetwork) -> None:
    for family, count in (("A1", 11), ("A2", 11), ("G", 14), ("E", 3)):
        assert [item.id.number for item in network.curves if item.id.family == family] == list(range(1, count + 1))


def test_there_are_92_places_for_aa_nodes_and_88_nodes_on_beams_of_three(
    design: Design, chart: AsymptoticChart, network: CurveNetwork
) -> None:
    """An independent enumeration of the lattice; beams with one or two nodes are left out."""
    places = lattice(design, chart)
    assert len(places) == 92
    kept = without_short_beams(places, 3)
    assert len(kept) == 88
    nodes = chart_places(design, np.array([node.point for node in of_kind(network, "AA")]))
    expected = np.array(sorted(((j + 0.5) * design.step, k * design.step) for k, j in kept))
    np.testing.assert_allclose(nodes[np.lexsort((nodes[:, 1], nodes[:, 0].round(6)))], expected, atol=1e-9)


def test_leaving_out_short_beams_shortens_others(design: Design, chart: AsymptoticChart) -> None:
    """With at least six nodes a beam, the nodes of a beam left out are gone from its partners too: 88 become fewer."""
    expected = without_short_beams(lattice(design, chart), 6)
    six = design.model_copy(update={"pattern": design.pattern.model_copy(update={"min_nodes": 6})})
    found = shell_network(six, chart)
    count = Counter(curve for node in of_kind(found, "AA") for curve in node.curves)
    assert len(of_kind(found, "AA")) == len(expected) < 88
    assert min(count.values()) >= 6
    assert set(count) == {beam.id for beam in beams(found)}


def test_every_beam_has_at_least_three_aa_nodes(network: CurveNetwork) -> None:
    count = Counter(curve for node in of_kind(network, "AA") for curve in node.curves)
    assert set(count) == {beam.id for beam in beams(network)}
    assert min(count.values()) >= 3


def test_every_aa_node_joins_one_beam_of_either_family(network: CurveNetwork) -> None:
    assert all([curve.family for curve in node.curves] == ["A1", "A2"] for node in of_kind(network, "AA"))


def test_geodesics_pass_the_midpoints_of_the_asymptotic_segments(design: Design, network: CurveNetwork) -> None:
    """Kagome: in the chart, each AG crossing between two AA nodes of a beam halves their distance (section 3.1)."""
    halved = 0
    for beam in beams(network):
        inner = [crossing for crossing in along(network, beam.id) if crossing.kind in ("AA", "AG")]
        for before, middle, after in zip(inner, inner[1:], inner[2:], strict=False):
            if [c.kind for c in (before, middle, after)] == ["AA", "AG", "AA"]:
                s = chart_places(design, np.array([before.point, middle.point, after.point]))
                np.testing.assert_allclose(s[1], (s[0] + s[2]) / 2.0, atol=1e-9)
                halved += 1
    assert halved == 2 * 88 - 22


def test_nodes_and_geodesics_alternate_along_every_beam(network: CurveNetwork) -> None:
    """So a geodesic supports every segment between two nodes: half the buckling length (section 3.1)."""
    for beam in beams(network):
        kinds = [crossing.kind for crossing in along(network, beam.id) if crossing.kind in ("AA", "AG")]
        assert all(one != other for one, other in pairwise(kinds))


def test_no_three_curves_meet_in_one_point(network: CurveNetwork) -> None:
    """Triangles and hexagons, not stars: the closest two crossings inside the net are half a mesh apart."""
    points = np.array([crossing.point for crossing in of_kind(network, "AA", "AG")])
    distance = np.linalg.norm(points[:, None] - points[None], axis=2) + 1e9 * np.eye(len(points))
    assert distance.min() > 150.0


def test_the_three_families_cross_at_sixty_degrees_everywhere(network: CurveNetwork) -> None:
    """Tangents of the splines at every AA and AG crossing, constant angle of the surface with ratio 3."""
    curves = {item.id: item.curve for item in network.curves}
    for crossing in of_kind(network, "AA", "AG"):
        one, other = (
            frames_at(curves[curve], np.array([station])).tangent[0]
            for curve, station in zip(crossing.curves, crossing.stations, strict=True)
        )
        assert math.degrees(math.acos(abs(float(one @ other)))) == pytest.approx(60.0, abs=1e-5)


def test_the_curve_pieces_between_crossings_in_the_chart_are_equal(design: Design, network: CurveNetwork) -> None:
    """Equilateral tri-hex: along a beam successive AA nodes lie exactly one step of s and one of theta apart."""
    for beam in beams(network):
        nodes = np.array([crossing.point for crossing in along(network, beam.id) if crossing.kind == "AA"])
        steps = np.abs(np.diff(chart_places(design, nodes), axis=0))
        np.testing.assert_allclose(steps, design.step, atol=1e-9)


def test_asymptotic_curves_have_no_normal_curvature(network: CurveNetwork) -> None:
    """So an upright plank is bent about its weak axis only."""
    for beam in beams(network):
        found = curvatures_at(beam.curve, np.linspace(beam.start, beam.end, 300))
        assert np.abs(found.normal).max() < SPLINE_CURVATURE


def test_geodesics_and_edges_have_no_geodesic_curvature(network: CurveNetwork) -> None:
    """So a flat plank is bent about its weak axis only: grid geodesics, bottom, and both ridge planks."""
    for item in network.curves:
        if item.id.family in ("G", "E"):
            found = curvatures_at(item.curve, np.linspace(item.start, item.end, 300))
            assert np.abs(found.geodesic).max() < SPLINE_CURVATURE


def test_curvature_and_twist_of_the_curves_agree_with_the_closed_forms(design: Design, network: CurveNetwork) -> None:
    """kappa_g = +-sin 60 tanh(y) / r on A1 and A2, tau_g = +-sqrt(3) r0^3 / r^4; along increasing s."""
    for beam in beams(network):
        sign = 1.0 if beam.id.family == "A1" else -1.0
        stations = np.linspace(beam.start + 200.0, beam.end, 100)
        s = chart_places(design, beam.curve.point_spline(stations))[:, 0]
        radius = 5100.0 * np.cosh(SQRT3 * s) ** (1.0 / 3.0)
        found = curvatures_at(beam.curve, stations)
        expected = sign * SQRT3 / 2.0 * np.tanh(SQRT3 * s) / radius
        np.testing.assert_allclose(found.geodesic, expected, atol=SPLINE_CURVATURE)
        np.testing.assert_allclose(found.torsion, sign * SQRT3 * 5100.0**3 / radius**4, atol=SPLINE_CURVATURE)


def test_crossings_lie_on_both_their_curves(network: CurveNetwork) -> None:
    """To a thousandth of a millimetre, with the normal of the curve there."""
    curves = {item.id: item.curve for item in network.curves}
    for crossing in network.crossings:
        for curve, station in zip(crossing.curves, crossing.stations, strict=True):
            frames = frames_at(curves[curve], np.array([station]))
            np.testing.assert_allclose(frames.point[0], crossing.point, atol=1e-3)
            np.testing.assert_allclose(frames.normal[0], crossing.normal, atol=1e-6)


def test_normals_point_out_of_the_vault(design: Design, network: CurveNetwork) -> None:
    """Away from the visitor: towards the axis outside and, above the ground line, upwards."""
    for crossing in network.crossings:
        x, y, _z = crossing.point
        assert crossing.normal[0] * (x + design.shells.axis_distance) + crossing.normal[1] * y < 0.0
        assert crossing.normal[2] > -1e-9


def test_no_beam_ends_past_the_overhang_from_its_last_joint(design: Design, network: CurveNetwork) -> None:
    limit = design.boundary.max_overhang
    for beam in beams(network):
        crossings = along(network, beam.id)
        first, last = (c.stations[c.curves.index(beam.id)] for c in (crossings[0], crossings[-1]))
        assert 0.0 < first - beam.start <= limit
        assert 0.0 < beam.end - last <= limit
        assert 0.0 <= beam.start < beam.end <= beam.curve.length


def test_joints_on_a_beam_leave_room_for_their_studs_and_blocks(design: Design, network: CurveNetwork) -> None:
    """A stud is 24 / sqrt 3 mm from its axis to its corner, a block 120 mm long; they must not touch in the gap."""
    reach = {"AA": 24.0 / SQRT3, "AG": 60.0, "boundary": 60.0}
    for beam in beams(network):
        for one, other in pairwise(along(network, beam.id)):
            distance = other.stations[other.curves.index(beam.id)] - one.stations[one.curves.index(beam.id)]
            assert distance >= reach[one.kind] + reach[other.kind]


def test_every_geodesic_stands_on_the_bottom_plank_and_ends_at_a_ridge_plank(network: CurveNetwork) -> None:
    geodesics = [item.id for item in network.curves if item.id.family == "G"]
    feet = {crossing.curves[0]: crossing.curves[1] for crossing in of_kind(network, "foot")}
    tops = {c.curves[0]: c.curves[1] for c in of_kind(network, "ridge") if c.curves[0].family == "G"}
    assert feet == {curve: CurveId("E", 1) for curve in geodesics}
    assert tops == {curve: CurveId("E", 2 if curve.number <= 7 else 3) for curve in geodesics}
    assert all(abs(crossing.point[2]) < 1e-6 for crossing in of_kind(network, "foot"))


def test_geodesics_end_square_before_the_edge_planks_with_the_gap_between(
    design: Design, network: CurveNetwork
) -> None:
    """The nearest corner of the square end keeps end_gap to the edge of the plank that it stops at.

    Measured along the surface, which is all but flat over a plank's width: a tenth of a millimetre.
    """
    curves = {item.id: item for item in network.curves}
    half = design.timber.width / 2.0
    for stop in of_kind(network, "foot", "ridge"):
        if stop.curves[0].family != "G":
            continue
        geodesic, edge = (curves[curve] for curve in stop.curves)
        end = geodesic.start if stop.kind == "foot" else geodesic.end
        tip = frames_at(geodesic.curve, np.array([end]))
        across = frames_at(edge.curve, np.array([stop.stations[1]])).binormal[0]
        corners = tip.point[0] + half * np.array([[-1.0], [1.0]]) * tip.binormal[0]
        gap = np.abs((corners - np.array(stop.point)) @ across).min() - half
        assert gap == pytest.approx(design.boundary.end_gap, abs=1.5)


def test_the_network_mirrors_itself_in_the_plane_of_symmetry(network: CurveNetwork) -> None:
    """Left and right change places, and with them both families of beams: A1-03 is the image of A2-09."""
    count = {"A1": 11, "A2": 11, "G": 14}
    swap = {"A1": "A2", "A2": "A1", "G": "G"}
    edges = {1: 1, 2: 3, 3: 2}

    def image(curve: CurveId) -> tuple[str, int]:
        if curve.family == "E":
            return "E", edges[curve.number]
        return swap[curve.family], count[curve.family] + 1 - curve.number

    def key(crossing: Crossing, mirrored: bool) -> tuple[object, ...]:
        names = [image(curve) if mirrored else tuple(curve) for curve in crossing.curves]
        x, y, z = crossing.point
        place = (round(x, 3), round(-y if mirrored else y, 3) + 0.0, round(z, 3) + 0.0)
        return (crossing.kind, *sorted(map(str, names)), place)

    # the crossing of both ridge planks lies on the plane itself
    assert {key(c, False) for c in network.crossings} == {key(c, True) for c in network.crossings}


def test_geodesics_and_edges_are_as_long_left_as_right(network: CurveNetwork) -> None:
    """Beams are not: A1 lies inside and A2 outside of the surface, so the ridge cuts their ends differently."""
    length = {tuple(item.id): item.end - item.start for item in network.curves}
    for number in range(1, 8):
        assert length["G", number] == pytest.approx(length["G", 15 - number], abs=1e-6)
    assert length["E", 2] == pytest.approx(length["E", 3], abs=1e-3)


def test_the_bottom_reaches_past_both_side_geodesics(design: Design, network: CurveNetwork) -> None:
    """The neck circle over 60 degrees, and an overhang at each end: r0 pi / 3 + 2 x 100 mm."""
    bottom = next(item for item in network.curves if item.id == CurveId("E", 1))
    expected = 5100.0 * math.pi / 3.0 + 2.0 * design.boundary.end_overhang
    assert bottom.end - bottom.start == pytest.approx(expected, abs=1e-3)
    np.testing.assert_allclose(bottom.curve.points[:, 2], 0.0, atol=1e-9)
