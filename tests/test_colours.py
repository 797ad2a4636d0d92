"""The legend of colours: one for every file and picture, told apart in colour and in grey print."""

import re
from itertools import combinations

import numpy as np
import pytest

from aag_cad.colours import LEGEND, linear, mixed, srgb
from aag_cad.families import BEAMS, EDGES, FAMILIES, GEODESICS, LAYERS
from aag_cad.language import LANGUAGES
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import colour_name
from aag_cad.parts.model import Gridshell, all_joints, all_parts
from assembly.drawing.names import family_name
from assembly.pictures.step_pictures import NEW, PIECES, THERE

# What a reader tells apart side by side in grey: about a seventh of the way from black to white.
APART = 15.0


def lightness(code: str) -> float:
    """Return the lightness L* of a code in CIELAB, 0 (black) to 100 (white): what grey print keeps of it."""
    red, green, blue = linear(code)
    luminance = 0.2126 * red + 0.7152 * green + 0.0722 * blue
    return 116.0 * luminance ** (1.0 / 3.0) - 16.0 if luminance > 216.0 / 24389.0 else luminance * 24389.0 / 27.0


def test_every_part_has_a_colour_and_every_colour_a_part(gridshell: Gridshell) -> None:
    assert {colour_name(part) for part in all_parts(gridshell)} == set(LEGEND)
    assert len(set(LEGEND.values())) == len(LEGEND)


def test_parts_that_meet_differ_in_lightness_so_that_grey_print_shows_them(gridshell: Gridshell) -> None:
    parts = index_of(gridshell).parts
    meeting = {
        tuple(sorted((colour_name(parts[a]), colour_name(parts[b]))))
        for joint in all_joints(gridshell)
        for a, b in combinations((mark for mark in joint.members if mark in parts), 2)
    }
    assert {("A1", "A2"), ("A1", "G"), ("A2", "G"), ("E", "G"), ("A1", "E"), ("A2", "E"), ("E", "steel")} <= meeting
    # Sheets lie on the mullions, which keep them off the blocks.
    pairs = {pair for pair in meeting - {("block", "sheet")} if pair[0] != pair[1]}
    gaps = {pair: abs(lightness(LEGEND[pair[0]]) - lightness(LEGEND[pair[1]])) for pair in pairs}
    assert min(gaps.values()) >= APART, min(gaps, key=lambda pair: gaps[pair])


def test_what_is_new_in_a_step_is_darker_than_what_is_there_already() -> None:
    there = lightness(THERE.fill)
    for style in (*NEW.values(), PIECES["steel"]):
        assert lightness(style.fill) <= there - APART
    assert {style.fill for style in (*NEW.values(), *PIECES.values())} <= set(LEGEND.values())


def test_lightness_runs_from_black_to_white_and_is_that_of_known_greys() -> None:
    """CIELAB: 18 % grey, sRGB 119 of 255, has the lightness 50."""
    assert (lightness("#000000"), lightness("#ffffff")) == (0.0, pytest.approx(100.0))
    assert lightness("#777777") == pytest.approx(50.0, abs=0.1)


def test_linear_numbers_are_the_intensities_of_srgb_numbers() -> None:
    """IEC 61966-2-1: half intensity is sRGB 188 of 255; black, white and dark colours near the line through zero."""
    assert linear("#000000") == (0.0, 0.0, 0.0)
    assert linear("#ffffff") == pytest.approx((1.0, 1.0, 1.0))
    assert linear("#bc0a00") == pytest.approx((0.503, 10 / 255 / 12.92, 0.0), abs=1e-3)
    assert srgb("#3366cc") == (0.2, 0.4, 0.8)


def test_a_mixture_lies_between_its_colours() -> None:
    assert (mixed("#204060", "#ffffff", 0.0), mixed("#204060", "#ffffff", 1.0)) == ("#204060", "#ffffff")
    assert mixed("#000000", "#646464", 0.5) == "#323232"


def test_families_lie_in_three_layers_and_only_beams_stand_upright(gridshell: Gridshell) -> None:
    assert [FAMILIES[family].layer for family in LAYERS.values()] == [-1, 0, 1] == list(LAYERS)
    assert {*BEAMS, *GEODESICS, *EDGES} == set(FAMILIES)
    for plank in index_of(gridshell).planks.values():
        row = FAMILIES[plank.family]
        assert (plank.layer, plank.upright) == (row.layer, row.upright)


def test_every_family_has_a_name_in_every_language() -> None:
    names = [family_name(family, language) for family in FAMILIES for language in LANGUAGES]
    assert len(set(names)) == len(names)
    assert all(re.fullmatch(r"[A-Z]\d? \S.*", name) for name in names)
    assert np.all([name.split()[0] in FAMILIES for name in names])
