"""Polylines with normals become the network that they were taken from; what makes no network is refused by name."""

import json
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from aag_cad.design import Design
from aag_cad.errors import AagError, FileError, NetworkError
from aag_cad.geometry.profiles import CrpcProfile
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface
from aag_cad.geometry.surface import unit_normals
from aag_cad.network.model import Crossing, CurveId, CurveNetwork
from aag_cad.network.polylines import polylines_json, read_polylines
from aag_cad.parts.build import gridshell_from
from aag_cad.units import Floats

CHART = AsymptoticChart(RevolutionSurface(CrpcProfile(5100.0, 3.0), -8823.0))


def by_curves(network: CurveNetwork) -> dict[tuple[str, tuple[CurveId, CurveId]], Crossing]:
    return {(crossing.kind, crossing.curves): crossing for crossing in network.crossings}


def line(s: Floats, theta: Floats) -> dict[str, Any]:
    """Return a polyline on the CRPC surface."""
    jet = CHART.jet(s, theta)
    return {"points": jet.point.tolist(), "normals": unit_normals(jet).tolist()}


def small(count: int = 12) -> dict[str, Any]:
    """Return two A1, two A2 and one G line that cross on the CRPC surface, as another program might give them."""
    s = np.linspace(0.05, 0.5, count)
    families = {
        "A1": [line(s, s - 0.35), line(s, s - 0.25)],
        "A2": [line(s, 0.35 - s), line(s, 0.25 - s)],
        "G": [line(s, np.full(count, 0.02))],
    }
    return {"schema": 1, "unit": "mm", "families": families}


@pytest.fixture(scope="module")
def returned(network: CurveNetwork) -> CurveNetwork:
    """Give the network of the vault, written and read again."""
    return read_polylines(polylines_json(network), "vault.json")


def test_the_network_of_the_vault_comes_back_with_all_its_crossings(
    network: CurveNetwork, returned: CurveNetwork
) -> None:
    """The crossings are found again in space alone, to 0.1 mm."""
    before, after = by_curves(network), by_curves(returned)
    assert set(after) == set(before)
    assert len(returned.crossings) == len(network.crossings)
    for key, crossing in before.items():
        np.testing.assert_allclose(after[key].point, crossing.point, rtol=0.0, atol=0.1)
        np.testing.assert_allclose(after[key].stations, crossing.stations, rtol=0.0, atol=0.1)
        np.testing.assert_allclose(after[key].normal, crossing.normal, rtol=0.0, atol=1e-4)


def test_the_planks_begin_and_end_where_they_did(network: CurveNetwork, returned: CurveNetwork) -> None:
    assert [item.id for item in returned.curves] == [item.id for item in network.curves]
    for before, after in zip(network.curves, returned.curves, strict=True):
        assert (after.start, after.end) == pytest.approx((before.start, before.end), abs=1e-3)
        assert after.curve.length == pytest.approx(before.curve.length, abs=1e-3)


def test_planks_of_the_returned_network_have_the_same_blanks(
    design: Design, network: CurveNetwork, returned: CurveNetwork
) -> None:
    """A carpenter who works to 0.1 mm drills the same holes."""
    shells = (gridshell_from(design, way).shells[0] for way in (network, returned))
    for before, after in zip(*(shell.planks for shell in shells), strict=True):
        assert after.mark == before.mark
        assert after.blank.length == pytest.approx(before.blank.length, abs=0.1)
        assert [h.joint for h in after.blank.holes] == [h.joint for h in before.blank.holes]
        np.testing.assert_allclose(
            [h.station for h in after.blank.holes], [h.station for h in before.blank.holes], rtol=0.0, atol=0.1
        )


def test_equal_networks_give_equal_text(network: CurveNetwork, returned: CurveNetwork) -> None:
    assert polylines_json(network) == polylines_json(network)
    assert set(json.loads(polylines_json(returned))["families"]) == {"A1", "A2", "G", "E"}


def test_polylines_of_another_program_cross_where_the_closed_form_says() -> None:
    """A1: theta = s - a and A2: theta = b - s meet at s = (a + b) / 2; edge planks are not needed."""
    found = by_curves(read_polylines(json.dumps(small()), "small.json"))
    intercepts = (0.35, 0.25)
    expected = set()
    for i, a in enumerate(intercepts, start=1):
        for j, b in enumerate(intercepts, start=1):
            key = ("AA", (CurveId("A1", i), CurveId("A2", j)))
            expected.add(key)
            s, theta = np.array([(a + b) / 2.0]), np.array([(b - a) / 2.0])
            np.testing.assert_allclose(found[key].point, CHART.jet(s, theta).point[0], rtol=0.0, atol=0.05)
            np.testing.assert_allclose(found[key].normal, unit_normals(CHART.jet(s, theta))[0], rtol=0.0, atol=1e-4)
        expected |= {("AG", (CurveId(family, i), CurveId("G", 1))) for family in ("A1", "A2")}
    assert set(found) == expected


def test_stations_cut_the_crossings_beyond_the_plank_off() -> None:
    data = small()
    data["families"]["A1"][0] |= {"start": 0.0, "end": 1700.0}
    whole = by_curves(read_polylines(json.dumps(small()), "small.json"))
    cut = by_curves(read_polylines(json.dumps(data), "small.json"))
    gone = {key for key, crossing in whole.items() if CurveId("A1", 1) in key[1] and crossing.stations[0] > 1701.0}
    assert gone
    assert set(cut) == set(whole) - gone


def _set(family: str, number: int, key: str, value: object) -> dict[str, Any]:
    data = small()
    data["families"][family][number - 1][key] = value
    return data


def _at(family: str, number: int, key: str, index: int, value: object) -> dict[str, Any]:
    data = small()
    data["families"][family][number - 1][key][index - 1] = value
    return data


def _families(**families: object) -> dict[str, Any]:
    data = small()
    data["families"] |= families
    return data


def _lifted(height: float) -> dict[str, Any]:
    """Lift G off the surface along its normals."""
    data = small()
    g = data["families"]["G"][0]
    g["points"] = (np.array(g["points"]) + height * np.array(g["normals"])).tolist()
    return data


def _turned() -> dict[str, Any]:
    data = small()
    data["families"]["G"][0]["normals"] = (-np.array(data["families"]["G"][0]["normals"])).tolist()
    return data


def _stray() -> dict[str, Any]:
    s = np.linspace(0.05, 0.2, 8)
    return _families(G=[small()["families"]["G"][0], line(s, np.full(8, 1.2))])


def _mixed() -> dict[str, Any]:
    data = small()
    data["families"]["A1"].append(data["families"]["A2"].pop())
    return data


def _zigzag() -> list[list[float]]:
    return [[200.0 * k, 400.0 * (k % 2), 0.0] for k in range(12)]


def _scaled(factor: float) -> list[list[float]]:
    return (factor * np.array(small()["families"]["G"][0]["points"])).tolist()


ALONG = (np.gradient(np.array(small()["families"]["A2"][1]["points"]), axis=0)).tolist()
BROKEN: dict[str, tuple[Callable[[], object], type[AagError], str]] = {
    "a list": (list, FileError, 'expected an object with "schema", "unit" and "families"'),
    "old": (lambda: small() | {"schema": 0}, FileError, "schema 0, this program reads 1"),
    "metres": (lambda: small() | {"unit": "m"}, FileError, "unit 'm'; scale the polylines to mm"),
    "unknown family": (lambda: _families(B=[]), FileError, "no family called B; there are A1, A2, G, E"),
    "no G": (lambda: _families(G=[]), FileError, "family G has no polylines"),
    "too many": (lambda: _families(A2=[{}] * 501), FileError, "family A2 has 501 polylines, at most 500"),
    "no normals": (lambda: _families(G=[{"points": []}]), FileError, 'G polyline 1: expected an object with "points"'),
    "one point": (lambda: _families(G=[{"points": [[0, 0, 0]], "normals": [[0, 0, 1]]}]), FileError, "1 points"),
    "normals short": (
        lambda: _set("A1", 2, "normals", [[0, 0, 1]]),
        FileError,
        "A1 polyline 2: 12 points and 1 n",
    ),
    "a word": (
        lambda: _at("A2", 1, "points", 3, [1, 2, "3"]),
        FileError,
        "A2 polyline 1, point 3: expected three",
    ),
    "plane": (lambda: _at("A2", 1, "points", 3, [1, 2]), FileError, "A2 polyline 1, point 3: expected three"),
    "NaN": (lambda: _at("A2", 1, "points", 3, [1, 2, math.nan]), FileError, "A2 polyline 1, point 3: .* is not finite"),
    "far": (lambda: _at("A2", 1, "points", 3, [1, 2, 1e9]), FileError, "A2 polyline 1, point 3: .* more than 1000 m"),
    "twice": (
        lambda: _at("A1", 1, "points", 3, small()["families"]["A1"][0]["points"][1]),
        FileError,
        "A1 polyline 1: points 2 and 3 are one",
    ),
    "tiny": (lambda: _set("G", 1, "points", _scaled(0.001)), FileError, r"G polyline 1: it is 1\.\d+ mm long; scale"),
    "kink": (lambda: _set("G", 1, "points", _zigzag()), FileError, "G polyline 1: it kinks by 127 degrees at point 2"),
    "no length": (lambda: _at("G", 1, "normals", 4, [0, 0, 0]), FileError, "G polyline 1: normal 4 has no length"),
    "flipped": (
        lambda: _at("A1", 2, "normals", 5, (-np.array(small()["families"]["A1"][1]["normals"][4])).tolist()),
        FileError,
        "A1 polyline 2: normal 5 points to the other side",
    ),
    "tangents": (lambda: _set("A2", 2, "normals", ALONG), FileError, r"A2 polyline 2: normal \d+ leans \d\d degrees"),
    "start": (lambda: _set("A1", 1, "start", 9000.0), FileError, r"A1 polyline 1: start 9000\.0 and end .* 0 to \d+"),
    "end": (lambda: _set("A1", 1, "end", "all"), FileError, "A1 polyline 1: start .* and end 'all' must rise"),
    "off the surface": (
        lambda: _lifted(40.0),
        NetworkError,
        r"A1 polyline 1 and G polyline 1 pass each other at (39|40)\.\d mm near .*, at most 5 mm are a crossing",
    ),
    "inside out": (_turned, NetworkError, "A1 polyline 1 and G polyline 1: their normals differ by 180 degrees"),
    "stray": (_stray, NetworkError, "G polyline 2 comes within 5 mm of no curve of another family"),
    "mixed": (_mixed, NetworkError, "A1 polyline 1 and A1 polyline 3 cross near .* sort them into A1, A2 and G"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_polylines_are_refused_by_family_and_number(name: str) -> None:
    data, kind, reason = BROKEN[name]
    with pytest.raises(kind, match=reason) as caught:
        read_polylines(json.dumps(data()), "broken.json")
    assert str(caught.value).startswith("broken.json: ")


def test_what_is_no_json_is_refused() -> None:
    with pytest.raises(FileError, match=r"broken\.json: not valid JSON: .*line 1"):
        read_polylines("{", "broken.json")
    with pytest.raises(FileError, match="not valid JSON"):
        read_polylines("[" * 100_000, "broken.json")


def test_coarse_polylines_cross_within_5_mm() -> None:
    """Curves that miss each other by 4 mm cross half way between them, those that miss by 8 mm do not cross."""
    with pytest.raises(NetworkError, match="pass each other"):
        read_polylines(json.dumps(_lifted(8.0)), "coarse.json")
    found = by_curves(read_polylines(json.dumps(_lifted(4.0)), "coarse.json"))
    true = by_curves(read_polylines(json.dumps(small()), ""))
    key = ("AG", (CurveId("A1", 1), CurveId("G", 1)))
    lift = np.subtract(found[key].point, true[key].point) @ np.array(true[key].normal)
    assert lift == pytest.approx(2.0, abs=0.05)
