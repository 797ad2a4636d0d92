"""Networks of shells that end level, close about their axis, or lean on their mirror image; and what is refused."""

import math
from typing import Any

import numpy as np
import pytest

from aag_cad.design import Design, design_text, load_design, parse_design
from aag_cad.errors import DesignError, NetworkError
from aag_cad.geometry.framed import curvatures_at, frames_at
from aag_cad.network.build import shell_network
from aag_cad.network.model import Crossing, CurveId, CurveNetwork, NetworkCurve
from aag_cad.network.ridge import ridge_distance
from aag_cad.pipeline import chart_of
from aag_cad.units import Floats

NAMES = ("column", "half-roof", "triple-arch")


@pytest.fixture(scope="module")
def networks() -> dict[str, tuple[Design, CurveNetwork]]:
    """The designs and their networks by name."""
    designs = {name: load_design(name) for name in NAMES}
    return {name: (design, shell_network(design, chart_of(design))) for name, design in designs.items()}


def planks(network: CurveNetwork, family: str) -> list[NetworkCurve]:
    return [item for item in network.curves if item.id.family == family]


def line(item: NetworkCurve) -> Floats:
    """Return points (200, 3) along a plank's centre line."""
    return frames_at(item.curve, np.linspace(item.start, item.end, 200)).point


def joints_on(network: CurveNetwork, curve: CurveId, *kinds: str) -> list[Crossing]:
    return [c for c in network.crossings if curve in c.curves and c.kind in kinds]


def refusal(design: Design, **tables: dict[str, Any]) -> str:
    data = design.model_dump()
    for table, values in tables.items():
        data[table] = {**data[table], **values}
    changed = Design.model_validate(data)
    with pytest.raises(NetworkError) as caught:
        shell_network(changed, chart_of(changed))
    return str(caught.value)


@pytest.mark.parametrize("name", NAMES)
def test_beams_and_geodesics_are_bent_about_their_weak_axis_only(
    networks: dict[str, tuple[Design, CurveNetwork]], name: str
) -> None:
    for item in networks[name][1].curves:
        if item.id.family != "E":
            found = curvatures_at(item.curve, np.linspace(item.start, item.end, 100))
            strong = found.geodesic if item.id.family == "G" else found.normal
            assert np.abs(strong).max() < 1e-7, item.id


@pytest.mark.parametrize("name", NAMES)
def test_every_beam_has_enough_nodes_and_every_geodesic_a_foot_and_a_head(
    networks: dict[str, tuple[Design, CurveNetwork]], name: str
) -> None:
    design, network = networks[name]
    for family in ("A1", "A2"):
        for item in planks(network, family):
            assert len(joints_on(network, item.id, "AA")) >= design.pattern.min_nodes
    assert len(planks(network, "G")) == design.pattern.geodesics
    for item in planks(network, "G"):
        assert [len(joints_on(network, item.id, kind)) for kind in ("foot", "ridge")] == [1, 1]


def test_the_column_repeats_every_two_geodesics(networks: dict[str, tuple[Design, CurveNetwork]]) -> None:
    """24 geodesics close the kagome: 12 beams of each family, and the nodes fall on themselves after 30 degrees."""
    network = networks["column"][1]
    assert [len(planks(network, family)) for family in ("A1", "A2", "G")] == [12, 12, 24]
    nodes = np.array([c.point for c in network.crossings if c.kind == "AA"])
    turn = math.radians(30.0)
    x, y = nodes[:, 0], nodes[:, 1]
    turned = np.column_stack([x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn)])
    gaps = np.linalg.norm(turned[:, None] - nodes[None, :, :2], axis=2) + np.abs(nodes[:, None, 2] - nodes[None, :, 2])
    assert len(nodes) % 12 == 0
    assert gaps.min(axis=1).max() < 1e-6
    assert gaps.min(axis=0).max() < 1e-6


def test_the_rings_of_the_column_close_but_for_their_gaps(networks: dict[str, tuple[Design, CurveNetwork]]) -> None:
    """Catenoid r = r0 cosh(z / r0): two full circles at the stated heights, less ``end_gap`` at each cut."""
    design, network = networks["column"]
    for height in (-1600.0, 3250.0):
        ring = [item for item in planks(network, "E") if abs(line(item)[0, 2] - height) < 1.0]
        radius = 1800.0 * math.cosh(height / 1800.0)
        length = sum(item.end - item.start for item in ring)
        assert length == pytest.approx(2.0 * math.pi * radius - len(ring) * design.boundary.end_gap, abs=0.01)
        np.testing.assert_allclose(np.concatenate([line(item) for item in ring])[:, 2], height, atol=1e-6)


def test_every_ring_plank_hangs_on_two_beams_and_ends_near_them(
    networks: dict[str, tuple[Design, CurveNetwork]],
) -> None:
    design, network = networks["column"]
    for item in planks(network, "E"):
        stations = [c.stations[1] for c in joints_on(network, item.id, "boundary")]
        assert len(stations) >= 2
        assert min(stations) - item.start <= design.boundary.max_overhang
        assert item.end - max(stations) <= design.boundary.max_overhang


def test_the_ridge_planks_of_a_half_keep_their_distance_from_the_mirror_plane(
    networks: dict[str, tuple[Design, CurveNetwork]],
) -> None:
    design, network = networks["half-roof"]
    nearest = min(float(-line(item)[:, 0].max()) for item in planks(network, "E"))
    assert nearest == pytest.approx(design.boundary.ridge_setback, abs=0.1)
    x = np.array([[-250.0, 900.0, 5.0], [-250.0, -900.0, 5.0]])
    np.testing.assert_allclose(ridge_distance(x, 2), 250.0)


def test_a_single_shell_has_no_ridge_plane() -> None:
    assert np.all(np.isinf(ridge_distance(np.zeros((3, 3)), 1)))


def test_the_level_edges_of_the_triple_arch_almost_touch_above_the_arches(
    networks: dict[str, tuple[Design, CurveNetwork]],
) -> None:
    """The circle comes nearest to the plane between two shells at 30 degrees from the middle, then turns away."""
    design, network = networks["triple-arch"]
    top = next(item for item in planks(network, "E") if item.id.number == 2)
    points = line(top)
    np.testing.assert_allclose(points[:, 2], 2500.0, atol=1e-6)
    gap = ridge_distance(points, 3)
    assert design.boundary.ridge_setback <= gap.min() < design.boundary.ridge_setback + 20.0
    nearest = points[int(np.argmin(gap))]
    angle = math.degrees(math.atan2(abs(nearest[1]), nearest[0] + 7612.0))
    assert angle == pytest.approx(30.0, abs=0.5)


def test_a_top_edge_that_runs_into_its_neighbour_is_refused(
    networks: dict[str, tuple[Design, CurveNetwork]],
) -> None:
    message = refusal(networks["triple-arch"][0], shells={"top_height": 2700.0})
    assert message.startswith("shells.top_height: the top edge comes")
    assert "boundary.ridge_setback asks for 90" in message


def test_a_height_that_the_meridian_never_reaches_is_refused(
    networks: dict[str, tuple[Design, CurveNetwork]],
) -> None:
    """A CRPC surface of ratio 2 stays under a height of about 0.93 r0."""
    message = refusal(networks["triple-arch"][0], shells={"top_height": 9000.0})
    assert message.startswith("shells.top_height: the meridian runs from -")
    assert "never reaches 9000 mm" in message


@pytest.mark.parametrize(
    ("tables", "key"),
    [
        ({"shells": {"top_height": 3000.0}}, "shells.top_height"),
        ({"pattern": {"row_offset": 0.5}}, "pattern.row_offset"),
    ],
)
def test_a_ring_without_a_place_for_a_cut_names_the_key_that_moves_the_joints(
    networks: dict[str, tuple[Design, CurveNetwork]], tables: dict[str, dict[str, Any]], key: str
) -> None:
    message = refusal(networks["column"][0], **tables)
    assert message.startswith(f"{key}: the ring of ")
    assert "and 0 places are so" in message


@pytest.mark.parametrize(
    ("name", "old", "new", "told"),
    [
        ("column", 'top = "level"', 'top = "flat"', "shells.top: 'flat' is none of ridge, mirror, level"),
        ("column", "top_height = 3250.0", "# none", "shells.top_height: missing"),
        ("column", "top_height = 3250.0", "top_height = -5.0", "shells.top_height: Input should be greater than 0"),
        ("column", "bottom_height = -1600.0", "bottom_height = 1.0", "shells.bottom_height: Input should be less than"),
        ("column", "count = 1", "count = 3", "shells.sector_deg: 360 for 3 shells that stand apart; at most 180"),
        ("column", "count = 1", "count = 3", "shells.axis_distance: 0 puts all 3 shells in one place"),
        ("column", "sector_deg = 360.0", "sector_deg = 361.0", "shells.sector_deg: Input should be less than"),
        ("half-roof", 'top = "mirror"', 'top = "mirror"\ncount = 3', "shells.count: Input should be 2, found 3"),
        ("half-roof", "sector_deg = 50.0", "sector_deg = 150.0", "shells.sector_deg: Input should be less than"),
        ("half-roof", 'top = "mirror"', 'top = "mirror"\ntop_height = 3.0', "shells.top_height: unknown key"),
        ("vault", "[shells]", "[shells]\ntop_height = 3.0", "shells.top_height: unknown key"),
        ("column", "stud_across_flats = 21.0", "stud_across_flats = 20.0", "20 mm does not fill joints.gap 24 mm"),
    ],
)
def test_keys_that_do_not_fit_the_kind_of_top_are_named(name: str, old: str, new: str, told: str) -> None:
    text = design_text(name)
    assert old in text
    with pytest.raises(DesignError) as caught:
        parse_design(text.replace(old, new))
    assert told in str(caught.value)


def test_a_design_without_a_kind_of_top_ends_at_ridges(design: Design) -> None:
    assert design.shells.top == "ridge"
    assert not design.closed
    assert design.bottom_height == 0.0
