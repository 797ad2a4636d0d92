"""The design file: what is right is read, and what is wrong is named by its key, its value and what is allowed."""

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from aag_cad.design import Design, design_text, load_design, parse_design
from aag_cad.errors import AagError, DesignError, FileError
from aag_cad.resources import shipped_names

VAULT = design_text("vault")
FREE_KEYS = (
    "timber.density", "timber.min_bending_radius", "timber.max_twist_deg_per_m", "supports.foot_height",
    "facade.sheet_width", "transport.length", "transport.width", "transport.height", "transport.mass",
    "crew.lift_limit",
)  # fmt: skip


def changed(**values: str) -> str:
    """Return the text of the vault's design with keys, given as table__key, set to TOML values."""
    lines, table, left = [], "", dict(values)
    for line in VAULT.splitlines():
        if heading := re.match(r"\[(\w+)\]", line):
            table = heading[1]
        key = line.split("=")[0].strip()
        if (name := f"{table}__{key}") in left:
            line = f"{key} = {left.pop(name)}"
        lines.append(line)
    assert not left, f"the vault has no {left}"
    return "\n".join(lines)


def with_key(path: str, value: str) -> str:
    return changed(**{path.replace(".", "__"): value})


def refusal(text: str) -> str:
    """Return the message with which a design is refused."""
    with pytest.raises(DesignError) as caught:
        parse_design(text)
    return str(caught.value)


def test_the_vault_is_shipped_and_read(design: Design) -> None:
    assert "vault" in shipped_names("designs", ".toml")
    assert parse_design(VAULT) == design == load_design("vault")


def test_every_shipped_design_is_valid() -> None:
    for name in shipped_names("designs", ".toml"):
        assert load_design(name).project.name == name


def test_a_design_is_read_from_a_path_as_well(tmp_path: Path, design: Design) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(VAULT, encoding="utf-8")
    assert load_design(str(path)) == design


def test_lengths_that_follow_from_the_design(design: Design) -> None:
    """Beams 56 mm off the surface, siblings 18 mm off their beam, geodesics 60/13 degrees apart."""
    assert design.layer_offset == 56.0
    assert design.sibling_offset == 18.0
    assert math.degrees(design.step) == pytest.approx(60.0 / 13.0, rel=1e-14)
    assert math.degrees(design.half_sector) == pytest.approx(30.0, rel=1e-14)


def test_the_timber_has_the_characteristic_values_of_en_338(design: Design) -> None:
    """D50: bending strength 50 N/mm2 and mean modulus 14000 N/mm2, the two figures that the paper prints."""
    assert design.timber.strength.f_m == 50.0
    assert design.timber.strength.E0 == 14000.0


@pytest.mark.parametrize("name", ["D30", "D35", "D40", "D50", "D60"])
def test_every_strength_class_is_in_the_table_and_rises_with_its_number(name: str) -> None:
    strength = parse_design(with_key("timber.strength_class", f'"{name}"')).timber.strength
    assert strength.f_m == float(name[1:])
    assert strength.E05 < strength.E0
    assert strength.rho_k < strength.rho_mean


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("surface.neck_radius", "-5100.0", "greater than 0, found -5100.0"),
        ("surface.neck_radius", "0", "greater than 0, found 0"),
        ("surface.neck_radius", "nan", "finite number, found nan"),
        ("surface.neck_radius", "inf", "finite number, found inf"),
        ("surface.ratio", "0.0", "greater than 0.05, found 0.0"),
        ("surface.ratio", "21", "less than or equal to 20, found 21"),
    ],
)
def test_a_bad_number_of_the_surface_is_named_by_the_key_as_it_stands_in_the_file(
    key: str, value: str, told: str
) -> None:
    """The key is surface.neck_radius; the profile is a value in that table and no part of the path."""
    message = refusal(with_key(key, value))
    assert told in message
    assert f"{key}: " in message


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("shells.count", "2", "greater than or equal to 3, found 2"),
        ("shells.count", "13", "less than or equal to 9, found 13"),
        ("shells.count", "3.5", "valid integer"),
        ("shells.axis_distance", "inf", "finite number, found inf"),
        ("shells.axis_distance", "-1", "greater than 0, found -1"),
        ("shells.sector_deg", "0", "greater than 0, found 0"),
        ("shells.sector_deg", "180", "less than 180, found 180"),
        ("shells.sector_deg", "nan", "found nan"),
        ("pattern.geodesics", "13", "multiple of 2, found 13"),
        ("pattern.geodesics", "2", "greater than or equal to 4, found 2"),
        ("pattern.row_offset", "1.0", "less than 1, found 1.0"),
        ("pattern.row_offset", "-0.1", "greater than or equal to 0, found -0.1"),
        ("pattern.min_nodes", "0", "greater than or equal to 1, found 0"),
        ("pattern.node_clearance_foot", "-1.0", "greater than or equal to 0, found -1.0"),
        ("timber.thickness", "0", "greater than 0, found 0"),
        ("timber.density", "inf", "finite number, found inf"),
        ("timber.strength_class", '"C24"', "'D30', 'D35', 'D40', 'D50' or 'D60', found 'C24'"),
        ("timber.species", '""', "at least 1 character, found ''"),
        ("joints.bolt_diameter", "7", "6, 8, 10 or 12, found 7"),
        ("joints.gap", '"wide"', "found 'wide'"),
        ("joints.gap", "[24.0]", "found [24.0]"),
        ("boundary.end_gap", "-5.0", "greater than or equal to 0, found -5.0"),
        ("supports.block_size", "400.0", "found 400.0"),
        ("supports.block_size", "[400.0, 400.0]", "supports.block_size"),
        ("supports.block_size", "[400.0, 400.0, -1.0]", "greater than 0, found -1.0"),
        ("project.name", '"Timber Vault"', "found 'Timber Vault'"),
        ("project.name", '"../vault"', "found '../vault'"),
        ("project.name", '""', "found ''"),
        ("project.title", '""', "at least 1 character, found ''"),
        ("project.author", "3", "valid string, found 3"),
        ("crew.people", "0", "greater than or equal to 1, found 0"),
        ("crew.people", "41", "less than or equal to 40, found 41"),
    ],
)
def test_a_bad_value_is_named_with_its_key_itself_and_what_is_allowed(key: str, value: str, told: str) -> None:
    message = refusal(with_key(key, value))
    assert key in message
    assert told in message


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("shells.sector_deg", "61", "61 is too wide for 3 shells; at most 60"),
        ("timber.thickness", "24", "24 mm is not thinner than joints.gap 24 mm"),
        ("timber.thickness", "30", "30 mm is not thinner than joints.gap 24 mm"),
        ("joints.stud_across_flats", "20", "20 mm does not fill joints.gap 24 mm; make them equal"),
        ("joints.bolt_hole", "9.5", "9.5 mm for a bolt of 8 mm; EN 1995-1-1"),
        ("joints.bolt_hole", "7.5", "7.5 mm for a bolt of 8 mm"),
        ("joints.screw_hole", "5", "5 mm is narrower than joints.screw_diameter 6 mm"),
        ("joints.bolt_offset", "46", "46 mm puts the holes outside the plank of 100 mm width; at most 45.5"),
        ("joints.bolt_offset", "4", "4 mm lets two holes of 9 mm run into each other"),
        ("joints.screw_length", "112", "112 mm does not end inside the coupling block; allowed 12 to 112"),
        ("joints.screw_length", "12", "12 mm does not end inside the coupling block; allowed 12 to 112"),
        ("boundary.end_overhang", "151", "151 mm is more than boundary.max_overhang 150 mm"),
        ("boundary.ridge_setback", "59", "59 mm leaves no room for half a plank and boundary.ridge_gap; at least 60"),
        ("stock.board_thickness", "24.9", "24.9 mm does not give 2 planks of timber.thickness 12 mm; at least 25"),
        ("stock.lengths", "[4000.0, 20.0]", "nothing is left of 20 mm after stock.trim 10 mm at each end"),
    ],
)
def test_values_that_do_not_fit_together_are_named_with_both_figures(key: str, value: str, told: str) -> None:
    assert f"{key}: {told}" in refusal(with_key(key, value))


def test_a_plank_thicker_than_wide_is_refused() -> None:
    text = changed(timber__thickness="110", joints__gap="120", joints__stud_across_flats="120")
    assert "timber.thickness: 110 mm is not less than timber.width 100 mm; swap the two" in refusal(text)


def test_sectors_may_be_wider_where_more_shells_meet() -> None:
    """At most 180 - 360/count degrees: beyond that the ridge would rise again towards the entry."""
    assert parse_design(changed(shells__count="4", shells__sector_deg="90")).shells.sector_deg == 90.0
    assert "at most 90" in refusal(changed(shells__count="4", shells__sector_deg="90.5"))


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("surface.neck_radius", "true"),
        ("surface.neck_radius", '"5100"'),
        ("pattern.geodesics", '"14"'),
        ("pattern.min_nodes", "true"),
        ("timber.width", "true"),
    ],
)
def test_a_truth_value_or_a_text_is_no_number(key: str, value: str) -> None:
    """A neck radius of "true" must not be built as one millimetre."""
    assert key in refusal(with_key(key, value))


@pytest.mark.parametrize(
    ("key", "value"), [("joints.stud_length", "1.0"), ("joints.stud_length", "140.0"), ("joints.block_length", "5.0")]
)
def test_studs_and_blocks_too_short_for_the_bolts_through_them_are_refused(key: str, value: str) -> None:
    """The bolts cross a stud up to 56 + 18 mm either side of its centre, and a block through its middle."""
    assert key in refusal(with_key(key, value))


def test_geodesics_closer_than_their_width_are_refused() -> None:
    """A sector of 2 degrees holds 178 mm of neck: fourteen planks of 100 mm cannot lie side by side in it."""
    message = refusal(with_key("shells.sector_deg", "2.0"))
    assert "shells.sector_deg" in message or "pattern.geodesics" in message


@pytest.mark.parametrize("key", ["project.title", "timber.species"])
def test_a_text_of_blanks_alone_is_empty(key: str) -> None:
    assert key in refusal(with_key(key, '"   "'))


def test_an_unknown_key_is_named_with_its_path() -> None:
    message = refusal(VAULT.replace("neck_radius = 5100.0", "neck_radius = 5100.0\nneck_raduis = 5000.0"))
    assert re.search(r"surface\S*\.neck_raduis: unknown key; remove it or check its spelling", message)
    assert "timber.colour: unknown key" in refusal(VAULT.replace('species = "ash"', 'species = "ash"\ncolour = "red"'))


def test_a_design_without_a_table_for_the_stock_buys_the_usual_lengths() -> None:
    """Designs written before there was such a table load as they did, whatever their planks are thick."""
    older = VAULT.split("[stock]")[0]
    assert parse_design(older).stock.lengths == (4000.0, 5000.0, 6000.0, 7000.0)
    assert parse_design(older.replace("thickness = 12.0", "thickness = 20.0")).stock.planks_per_board == 2


def test_an_unknown_table_is_named() -> None:
    assert "paint: unknown key" in refusal(VAULT + "\n[paint]\ncoats = 2\n")


@pytest.mark.parametrize("key", ["timber.width", "joints.gap", "shells.count", "boundary.end_gap", "crew.people"])
def test_a_missing_key_is_named(key: str) -> None:
    table, name = key.split(".")
    section = re.search(rf"^\[{table}\][^\[]*", VAULT, flags=re.M)
    assert section is not None
    cut = re.sub(rf"^{name}\s*=.*\n?", "", section[0], count=1, flags=re.M)
    assert f"{key}: missing" in refusal(VAULT.replace(section[0], cut))


def test_a_missing_table_is_named() -> None:
    assert "crew: missing" in refusal(VAULT.split("[crew]")[0])


@pytest.mark.parametrize("profile", ['"torus"', '""', "3"])
def test_a_profile_that_does_not_exist_is_named_with_those_that_do(profile: str) -> None:
    message = refusal(with_key("surface.profile", profile))
    assert "surface.profile" in message
    assert all(name in message for name in ("crpc", "catenoid", "hyperboloid", "spline"))


def test_a_surface_without_profile_says_so() -> None:
    text = re.sub(r"^profile = .*$", "", VAULT, flags=re.M)
    assert "surface.profile: missing" in refusal(text)


def test_all_faults_of_a_file_are_told_at_once() -> None:
    message = refusal(changed(shells__count="1", timber__width="-100", crew__people="0"))
    assert [line.split(":")[0] for line in message.splitlines()[1:]] == ["shells.count", "timber.width", "crew.people"]


@pytest.mark.parametrize("text", ["", "   \n\n", "\t"])
def test_an_empty_file_is_called_empty(text: str) -> None:
    assert "the file is empty" in refusal(text)


@pytest.mark.parametrize("text", ["[project", "a =", "name = vault", "[timber]\nwidth = 1\nwidth = 2", "\x00"])
def test_what_is_not_toml_is_said_to_be_none(text: str) -> None:
    assert "not valid TOML" in refusal(text)


def test_a_file_saved_with_a_byte_order_mark_is_read_like_any_other(tmp_path: Path, design: Design) -> None:
    """Some editors put it before the first sign of a UTF-8 file, where nobody sees it."""
    path = tmp_path / "mine.toml"
    path.write_text(VAULT, encoding="utf-8-sig")
    assert load_design(str(path)) == design


def test_the_message_begins_with_the_file_that_was_read(tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text("[project", encoding="utf-8")
    with pytest.raises(DesignError, match=rf"^{re.escape(str(path))}: not valid TOML"):
        load_design(str(path))


def test_a_file_that_is_no_text_is_refused_with_its_path(tmp_path: Path) -> None:
    path = tmp_path / "photo.toml"
    path.write_bytes(b"\xff\xd8\xff\xe0\x00\x10JFIF")
    with pytest.raises(FileError, match=rf"^{re.escape(str(path))}: cannot be read as a text file"):
        load_design(str(path))


def test_a_folder_is_refused_with_its_path(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=rf"^{re.escape(str(tmp_path))}: cannot be read"):
        load_design(str(tmp_path))


def test_a_missing_file_is_named_with_the_designs_that_are_shipped(tmp_path: Path) -> None:
    missing = tmp_path / "none.toml"
    with pytest.raises(FileError, match=rf"^{re.escape(str(missing))}: no such design file.*vault"):
        load_design(str(missing))


@pytest.mark.parametrize("name", ["", "vault\0", "x" * 5000])
def test_a_name_that_no_file_can_have_is_refused(name: str) -> None:
    with pytest.raises(FileError):
        load_design(name)


def test_errors_of_a_design_are_also_the_builtins_that_they_stand_for() -> None:
    assert issubclass(DesignError, ValueError)
    assert issubclass(FileError, OSError)
    assert all(issubclass(kind, AagError) for kind in (DesignError, FileError))


def test_a_design_never_changes(design: Design) -> None:
    with pytest.raises(ValidationError):
        design.timber.width = 120.0
    with pytest.raises(ValidationError):
        design.timber = design.timber


@given(data=st.data(), key=st.sampled_from(FREE_KEYS))
def test_any_length_that_can_be_built_is_read_back_as_it_was_written(data: st.DataObject, key: str) -> None:
    """Keys without a partner to fit to take any positive number, digit by digit."""
    value = data.draw(st.floats(0.0, 1e6, exclude_min=True))
    found: Any = parse_design(with_key(key, repr(value)))
    for part in key.split("."):
        found = getattr(found, part)
    assert found == value


@given(key=st.sampled_from(FREE_KEYS), value=st.floats(max_value=0.0) | st.sampled_from([math.inf, math.nan]))
def test_no_length_is_zero_negative_or_undefined(key: str, value: float) -> None:
    assert key in refusal(with_key(key, repr(value)))


@given(
    width=st.floats(60.0, 300.0), thickness=st.floats(4.0, 40.0), gap=st.floats(4.0, 80.0), offset=st.floats(5.0, 25.0)
)
def test_a_section_is_accepted_exactly_if_it_can_be_built(
    width: float, thickness: float, gap: float, offset: float
) -> None:
    """Plank thinner than the gap and than its width, both holes inside the plank and clear of each other."""
    text = changed(
        timber__width=repr(width), timber__thickness=repr(thickness), joints__gap=repr(gap),
        joints__stud_across_flats=repr(gap), joints__bolt_offset=repr(offset), joints__screw_length="60.0",
        joints__stud_length="900.0", boundary__ridge_setback="200.0", stock__board_thickness="100.0",
    )  # fmt: skip
    fits = thickness < gap and thickness < width and 2.0 * offset + 9.0 < width and 2.0 * offset > 9.0
    fits = fits and thickness < 60.0 < thickness + width
    try:
        parse_design(text)
        accepted = True
    except DesignError:
        accepted = False
    assert accepted == fits


@given(text=st.text(max_size=200))
def test_no_text_at_all_raises_anything_but_a_design_error(text: str) -> None:
    with pytest.raises(DesignError):
        parse_design(text)


def properties(schema: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield every key of a JSON schema with what it says about it."""
    for table, definition in {"design": schema, **schema["$defs"]}.items():
        for key, value in definition.get("properties", {}).items():
            yield f"{table}.{key}", value


def test_the_json_schema_says_of_every_key_what_it_may_hold() -> None:
    """An editor can complete and check a design from it: each key has a type, a reference, choices or a constant."""
    listed = dict(properties(Design.model_json_schema()))
    assert {"Timber.width", "Joints.gap", "CrpcSurface.neck_radius", "design.shells"} <= set(listed)
    for name, value in listed.items():
        assert {"type", "$ref", "enum", "const", "oneOf", "anyOf"} & set(value), name


def test_the_json_schema_refuses_keys_that_it_does_not_know() -> None:
    schema = Design.model_json_schema()
    assert schema["additionalProperties"] is False
    sections = [value for value in schema["$defs"].values() if value.get("type") == "object"]
    assert sections
    assert all(section["additionalProperties"] is False for section in sections)
