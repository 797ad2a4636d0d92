"""gridshell.json: what is written is read back equal, and what is not a gridshell is refused with its place."""

import json
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aag_cad.errors import FileError
from aag_cad.parts.model import SCHEMA_VERSION, Gridshell, Shell, all_parts
from aag_cad.parts.store import gridshell_json, read_gridshell


def small(gridshell: Gridshell) -> Gridshell:
    """Return a gridshell of one shell with two planks, a beam and one part of each other kind, and a blade."""
    shell = gridshell.shells[0]
    few: Shell = replace(
        shell,
        planks=(shell.planks[0], shell.planks[-1]),
        beams=shell.beams[:1],
        studs=shell.studs[:1],
        blocks=shell.blocks[:1],
        bolts=shell.bolts[:1],
        screws=shell.screws[:1],
        joints=shell.joints[:2],
        straps=shell.straps[:1],
        shoes=shell.shoes[:1],
        rods=shell.rods[:1],
        footings=shell.footings[:1],
        mullions=shell.mullions[:1],
        strips=shell.strips[:1],
        clamps=shell.clamps[:1],
    )
    blades, bolts, joints = gridshell.blades[:1], gridshell.bolts[:1], gridshell.joints[:1]
    return replace(gridshell, shells=(few,), blades=blades, bolts=bolts, joints=joints)


@pytest.fixture(scope="module")
def text(gridshell: Gridshell) -> str:
    """The small gridshell as JSON."""
    return gridshell_json(small(gridshell))


def places(data: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    """Yield the path of every value in JSON data."""
    if path:
        yield path
    if isinstance(data, dict):
        for key in data:
            yield from places(data[key], (*path, key))
    elif isinstance(data, list):
        for i in range(min(len(data), 3)):
            yield from places(data[i], (*path, i))


def exchanged(text: str, path: tuple[str | int, ...], value: Any) -> str:
    data: Any = json.loads(text)
    inner = data
    for step in path[:-1]:
        inner = inner[step]
    inner[path[-1]] = value
    return json.dumps(data)


def test_the_whole_vault_is_read_back_equal(gridshell: Gridshell) -> None:
    """Every number with all its digits, curves included."""
    assert read_gridshell(gridshell_json(gridshell)) == gridshell


def test_the_same_gridshell_is_written_in_the_same_bytes(gridshell: Gridshell) -> None:
    written = gridshell_json(gridshell)
    assert gridshell_json(read_gridshell(written)) == written
    assert written.endswith("\n")


def test_the_file_is_plain_json_with_its_version(text: str) -> None:
    data = json.loads(text, parse_constant=lambda name: pytest.fail(f"{name} is no JSON number"))
    assert data["schema_version"] == SCHEMA_VERSION == 2
    assert data["name"] == "vault"
    assert data["shells"][0]["planks"][0]["mark"] == "S1-A1-01-L"


@pytest.mark.parametrize("version", [0, 1, 3, "2", 2.5, None])
def test_another_version_is_refused_with_both_versions_and_a_remedy(text: str, version: Any) -> None:
    wrong = exchanged(text, ("schema_version",), version)
    with pytest.raises(FileError, match=rf"schema_version {version!r}, this program reads 2; build the design again"):
        read_gridshell(wrong)


@pytest.mark.parametrize("broken", ["", "{", "[1, 2", '{"schema_version": 1,}', "not json", "{'schema_version': 1}"])
def test_broken_json_is_called_so(broken: str) -> None:
    with pytest.raises(FileError, match=r"gridshell\.json: not valid JSON"):
        read_gridshell(broken)


@pytest.mark.parametrize("other", ["[]", "null", "3", '"vault"', "{}"])
def test_json_that_is_no_gridshell_is_refused(other: str) -> None:
    with pytest.raises(FileError, match=r"gridshell\.json: schema_version None"):
        read_gridshell(other)


def test_the_small_gridshell_holds_a_part_of_every_kind(gridshell: Gridshell) -> None:
    """So that every kind is tried with exchanged values."""
    kinds = {type(part) for part in all_parts(gridshell)}
    assert {type(part) for part in all_parts(small(gridshell))} == kinds


def test_a_file_cut_short_is_refused(text: str) -> None:
    with pytest.raises(FileError):
        read_gridshell(text[: len(text) // 2])


@pytest.mark.parametrize(
    ("path", "value", "told"),
    [
        (("name",), 3, r"gridshell\.name: expected str, found 3"),
        (("ground",), "low", r"gridshell\.ground: expected float, found 'low'"),
        (("ground",), True, r"gridshell\.ground: expected float, found True"),
        (("shells",), {}, r"gridshell\.shells: expected a list, found dict"),
        (("shells", 0, "placement"), [], r"gridshell\.shells\[0\]\.placement: expected an object, found list"),
        (("shells", 0, "studs", 0, "frame", "x"), [1.0, 0.0], r"frame\.x: expected 3 values, found 2"),
        (("shells", 0, "planks", 0, "family"), "A3", r"planks\[0\]\.family: 'A3' is none of 'A1', 'A2', 'G', 'E'"),
        (("shells", 0, "planks", 1, "layer"), 0.5, r"planks\[1\]\.layer: expected int, found 0\.5"),
        (("shells", 0, "planks", 0, "upright"), 1, r"planks\[0\]\.upright: expected bool, found 1"),
        (("shells", 0, "planks", 0, "curve", "stations"), [0.0], r"curve: 1 stations need as many points"),
        (("shells", 0, "planks", 0, "curve"), {"stations": []}, r"planks\[0\]\.curve: not a curve"),
    ],
)
def test_a_value_that_does_not_fit_is_named_by_its_place(
    text: str, path: tuple[str | int, ...], value: Any, told: str
) -> None:
    with pytest.raises(FileError, match=told):
        read_gridshell(exchanged(text, path, value))


def test_unknown_and_missing_keys_are_named(text: str) -> None:
    data = json.loads(text)
    data["shells"][0]["planks"][0]["colour"] = "red"
    del data["shells"][0]["planks"][0]["blank"]
    with pytest.raises(FileError, match=r"planks\[0\]: unknown keys \['colour'\], missing keys \['blank'\]"):
        read_gridshell(json.dumps(data))


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity"])
def test_what_is_no_number_is_no_length(text: str, number: str) -> None:
    """JSON has no NaN; a plank of that length must not come back from a file."""
    data = json.loads(text)
    data["shells"][0]["planks"][0]["blank"]["length"] = float(number.replace("Infinity", "inf"))
    with pytest.raises(FileError):
        read_gridshell(json.dumps(data))


@pytest.mark.parametrize("wrong", ["0.0", None, True])
def test_a_curve_holds_numbers_and_nothing_like_them(text: str, wrong: object) -> None:
    """Neither text nor null nor a truth value: they would come back as a station of 0, 1 or no number at all."""
    curve = ("shells", 0, "planks", 0, "curve", "stations", 0)
    with pytest.raises(FileError, match=r"planks\[0\]\.curve"):
        read_gridshell(exchanged(text, curve, wrong))


def test_brackets_without_end_are_refused_like_other_broken_json() -> None:
    with pytest.raises(FileError):
        read_gridshell("[" * 100_000)


VALUES = st.one_of(
    st.none(), st.booleans(), st.integers(-5, 5), st.floats(-1e3, 1e3), st.text(max_size=3), st.just([]), st.just({})
)


@given(data=st.data(), value=VALUES)
def test_no_exchanged_value_makes_reading_fail_otherwise_than_by_saying_so(
    text: str, data: st.DataObject, value: Any
) -> None:
    """Any value in any place: a gridshell that is written back the same, or a FileError."""
    path = data.draw(st.sampled_from(list(places(json.loads(text)))))
    try:
        found = read_gridshell(exchanged(text, path, value))
    except FileError:
        return
    assert read_gridshell(gridshell_json(found)) == found
