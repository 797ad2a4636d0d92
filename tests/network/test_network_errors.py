"""Designs that parse but cannot be built: the error names the key to change."""

import math
from typing import Any

import pytest

from aag_cad.design import Design
from aag_cad.errors import NetworkError, SurfaceError
from aag_cad.network.build import shell_network
from aag_cad.pipeline import chart_of


def altered(design: Design, **tables: dict[str, Any]) -> Design:
    """Return a validated copy of a design with some keys of some tables exchanged."""
    data = design.model_dump()
    for table, values in tables.items():
        data[table] = {**data[table], **values} if table != "surface" else values
    return Design.model_validate(data)


def refusal(design: Design) -> str:
    with pytest.raises((NetworkError, SurfaceError)) as caught:
        shell_network(design, chart_of(design))
    return str(caught.value)


@pytest.mark.parametrize("distance", [1000.0, 5100.0, 5888.0])
def test_an_axis_too_near_to_the_centre_puts_the_neck_across_the_ridge(design: Design, distance: float) -> None:
    """At the side the neck is (sqrt(3)/2) D - r0 from the ridge plane: nothing is left below D = 5889 mm."""
    message = refusal(altered(design, shells={"axis_distance": distance}))
    assert message.startswith("shells.axis_distance: the neck of the shell already crosses the ridge plane at 30.0")
    assert "enlarge axis_distance or narrow sector_deg" in message


def test_an_axis_too_far_from_the_centre_leaves_the_shells_apart(design: Design) -> None:
    message = refusal(altered(design, shells={"axis_distance": 200_000.0}))
    assert message.startswith("shells.axis_distance: the surface ends before it reaches the ridge plane")
    assert "reduce axis_distance" in message


def test_beams_that_all_have_too_few_nodes(design: Design) -> None:
    message = refusal(altered(design, pattern={"min_nodes": 50}))
    assert message.startswith("pattern.min_nodes: no beam has 50 AA nodes")


def test_a_ridge_set_back_past_the_whole_shell_is_named(design: Design) -> None:
    """3 m from the ridge plane there is no shell left at the side; not the axis but the set-back is absurd."""
    assert "boundary.ridge_setback" in refusal(altered(design, boundary={"ridge_setback": 3000.0}))


def test_a_clearance_that_leaves_no_node_is_named(design: Design) -> None:
    assert "pattern.node_clearance_ridge" in refusal(altered(design, pattern={"node_clearance_ridge": 1e6}))


def test_an_end_gap_longer_than_the_geodesics_is_named(design: Design) -> None:
    assert "boundary.end_gap" in refusal(altered(design, boundary={"end_gap": 5000.0}))


def test_coupling_blocks_longer_than_the_mesh_are_refused(design: Design) -> None:
    """Between two studs of the vault, 476 to 727 mm apart, there is no room for a block of 5 m: G would lie loose."""
    assert "joints.block_length" in refusal(altered(design, joints={"block_length": 5000.0}))


def test_a_meridian_without_asymptotic_curves_is_named_with_its_height(design: Design) -> None:
    """A dome instead of a saddle: K > 0."""
    angles = [-0.2 + 0.1 * i for i in range(9)]
    points = [(5100.0 * math.cos(t), 5100.0 * math.sin(t)) for t in angles]
    message = refusal(altered(design, surface={"profile": "spline", "points": points}))
    assert "K >= 0 at height z = " in message


def test_a_meridian_that_ends_below_the_ridge_is_named(design: Design) -> None:
    """A hyperbola up to 1 m only: the shell cannot close."""
    heights = [-300.0 + 100.0 * i for i in range(14)]
    points = [(math.sqrt(5100.0**2 + 2.0 * z**2), z) for z in heights]
    message = refusal(altered(design, surface={"profile": "spline", "points": points}))
    assert "the surface ends before it reaches the ridge plane" in message
    assert "lengthen the meridian" in message
