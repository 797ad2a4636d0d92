"""The same network on other surfaces: the tri-hex does not need sixty degrees, only asymptotic curves."""

import math
from typing import Any

import numpy as np
import pytest

from aag_cad.design import Design
from aag_cad.geometry.framed import curvatures_at, frames_at
from aag_cad.network.build import shell_network
from aag_cad.network.model import CurveNetwork
from aag_cad.pipeline import chart_of


@pytest.fixture(scope="module", params=["catenoid", "hyperboloid"])
def other(request: pytest.FixtureRequest, design: Design) -> tuple[str, CurveNetwork]:
    """A network of eight geodesics on a surface other than the vault's, and the name of the surface."""
    surfaces: dict[str, dict[str, Any]] = {
        "catenoid": {"profile": "catenoid", "neck_radius": 5100.0},
        "hyperboloid": {"profile": "hyperboloid", "neck_radius": 5100.0, "semi_axis": 3500.0},
    }
    data = design.model_dump()
    data["surface"] = surfaces[request.param]
    data["pattern"]["geodesics"] = 8
    data["shells"]["sector_deg"] = 45.0
    changed = Design.model_validate(data)
    return request.param, shell_network(changed, chart_of(changed))


def test_planks_are_bent_about_their_weak_axis_only(other: tuple[str, CurveNetwork]) -> None:
    _, network = other
    for item in network.curves:
        found = curvatures_at(item.curve, np.linspace(item.start, item.end, 100))
        strong = found.normal if item.id.family in ("A1", "A2") else found.geodesic
        assert np.abs(strong).max() < 1e-7


def test_the_node_angles_are_those_of_the_surface(other: tuple[str, CurveNetwork]) -> None:
    """90 degrees everywhere on the catenoid; on the hyperboloid the rulings cross at angles that change by degrees."""
    name, network = other
    curves = {item.id: item.curve for item in network.curves}
    angles = []
    for crossing in (c for c in network.crossings if c.kind == "AA"):
        one, two = (
            frames_at(curves[curve], np.array([station])).tangent[0]
            for curve, station in zip(crossing.curves, crossing.stations, strict=True)
        )
        angles.append(math.degrees(math.acos(abs(float(one @ two)))))
    if name == "catenoid":
        assert angles == pytest.approx([90.0] * len(angles), abs=1e-5)
    else:
        assert max(angles) - min(angles) > 5.0


def test_beams_on_the_hyperboloid_are_straight_and_only_twisted(other: tuple[str, CurveNetwork]) -> None:
    name, network = other
    bends = [
        float(np.abs(curvatures_at(item.curve, np.linspace(item.start, item.end, 100)).geodesic).max())
        for item in network.curves
        if item.id.family in ("A1", "A2")
    ]
    if name == "hyperboloid":
        assert max(bends) < 1e-7
    else:
        assert max(bends) > 1e-5
