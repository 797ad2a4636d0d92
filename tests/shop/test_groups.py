"""Drilling groups: planks that are equal, as they are or turned, share one template."""

import random
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aag_cad.design import Design
from aag_cad.network.model import CurveNetwork
from aag_cad.parts.build import gridshell_from
from aag_cad.parts.forms import Blank, CrossSection, EndCut, Hole
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import parse_mark
from aag_cad.parts.model import Gridshell, Plank
from aag_cad.shop.groups import (
    HOW_TO_LAY,
    LAID,
    DrillGroup,
    Laid,
    cut_slope,
    drill_groups,
    drilled_joints,
    laid_points,
    member_of,
    template_mark,
)
from aag_cad.units import Floats

LENGTH = 4000.0


@pytest.fixture(scope="module")
def plank(gridshell: Gridshell) -> Plank:
    return next(plank for plank in gridshell.shells[0].planks if plank.family == "G")


def with_blank(plank: Plank, mark: str, blank: Blank) -> Plank:
    return replace(plank, mark=mark, blank=blank)


def laid_blank(blank: Blank, laid: Laid) -> Blank:
    """Return the blank of a plank that, laid so, looks like the given one."""
    points = laid_points(np.array([(h.station, h.offset) for h in blank.holes]), blank.length, laid)
    holes = [replace(h, station=float(x), offset=float(y)) for h, (x, y) in zip(blank.holes, points, strict=True)]
    return replace(blank, holes=tuple(sorted(holes, key=lambda hole: (hole.station, hole.offset))))


# Whole millimetres: no turning can bring a hole that was moved by 0.2 mm onto another.
places = st.sets(st.tuples(st.integers(20, 3980), st.integers(-40, 40)), min_size=1, max_size=14)


def blank_of(found: set[tuple[int, int]]) -> Blank:
    holes = tuple(Hole(float(x), float(y), 9.0, "bolt", "S1-N-001") for x, y in sorted(found))
    return Blank(LENGTH, CrossSection(100.0, 12.0), holes)


@pytest.fixture(scope="module")
def uncovered(design: Design, network: CurveNetwork) -> Gridshell:
    """The vault without its cover, whose blocks on the geodesics are no mirror images."""
    bare = design.facade.model_copy(update={"cover": False})
    return gridshell_from(design.model_copy(update={"facade": bare}), network)


def sizes(groups: Sequence[DrillGroup]) -> dict[int, int]:
    """Return how many groups there are of each number of planks."""
    return Counter(len(group.members) for group in groups)


def test_the_bare_vault_needs_fifty_three_templates(uncovered: Gridshell) -> None:
    """44 asymptotic planks and the bottom plank recur in three shells; geodesics and ridge planks mirror as well."""
    groups = drill_groups(list(index_of(uncovered).planks.values()))
    assert sizes(groups) == {3: 45, 6: 8}
    assert [group.mark for group in groups] == [template_mark(i) for i in range(1, 54)]


def test_the_covered_vault_needs_a_template_for_each_geodesic(gridshell: Gridshell) -> None:
    """What carries the mullions stands where no outer beam crosses, and these cross mirrored geodesics elsewhere."""
    assert sizes(drill_groups(list(index_of(gridshell).planks.values()))) == {3: 59, 6: 1}


def test_every_plank_lies_in_one_group_and_the_master_lies_as_drawn(gridshell: Gridshell) -> None:
    planks = list(index_of(gridshell).planks.values())
    groups = drill_groups(planks)
    marks = [member.mark for group in groups for member in group.members]
    assert sorted(marks) == sorted(plank.mark for plank in planks)
    assert len(marks) == len(set(marks)) == 183
    assert all(group.members[0].mark == group.master.mark for group in groups)
    assert all(group.members[0].laid == "as is" for group in groups)


def test_the_same_plank_of_three_shells_is_one_stack(gridshell: Gridshell) -> None:
    """The paper, section 3.2: groups of three identical planks, for three shells, are clamped and drilled together."""
    for group in drill_groups(list(index_of(gridshell).planks.values())):
        for stack in group.stacks:
            marks = [parse_mark(member.mark) for member in stack]
            assert [mark.shell for mark in marks] == [1, 2, 3]
            assert len({(mark.family, mark.index, mark.part) for mark in marks}) == 1


def test_mirrored_geodesics_share_a_template(uncovered: Gridshell) -> None:
    groups = drill_groups(list(index_of(uncovered).planks.values()))
    found = {parse_mark(m.mark).index: group.mark for group in groups for m in group.members if "-G-" in m.mark}
    assert all(found[index] == found[15 - index] for index in range(1, 15))
    assert len(set(found.values())) == 7


def test_left_and_right_siblings_never_share_a_template(gridshell: Gridshell) -> None:
    """The paper, section 3.2: siblings are drilled individually, with slight differences from node to node."""
    for group in drill_groups(list(index_of(gridshell).planks.values())):
        assert len({parse_mark(member.mark).part for member in group.members}) == 1


def test_the_order_of_the_planks_does_not_matter(gridshell: Gridshell) -> None:
    planks = list(index_of(gridshell).planks.values())
    groups = drill_groups(planks)
    random.Random(4).shuffle(planks)
    again = drill_groups(planks)
    assert [(g.mark, g.members) for g in again] == [(g.mark, g.members) for g in groups]


def test_a_stack_holds_at_most_as_many_planks_as_are_clamped(gridshell: Gridshell) -> None:
    groups = drill_groups(index_of(gridshell).planks.values())
    assert {len(stack) for group in groups for stack in group.stacks} == {3}
    assert all(sum(group.stacks, ()) == group.members for group in groups)


@pytest.mark.parametrize("laid", LAID)
def test_each_way_of_laying_undoes_itself(laid: Laid) -> None:
    points = np.array([(10.0, 18.0), (3000.0, -7.5)])
    assert np.allclose(laid_points(laid_points(points, LENGTH, laid), LENGTH, laid), points, atol=0.0)


def test_the_four_ways_are_the_symmetries_of_a_rectangle() -> None:
    """Turning and turning over commute, and both together are the fourth way."""
    point = np.array([(10.0, 18.0)])
    images = {laid: tuple(laid_points(point, LENGTH, laid)[0]) for laid in LAID}
    assert set(images.values()) == {(10.0, 18.0), (3990.0, -18.0), (10.0, -18.0), (3990.0, 18.0)}
    for a, b in product(LAID, LAID):
        assert tuple(laid_points(laid_points(point, LENGTH, a), LENGTH, b)[0]) in images.values()
    assert images["turned end for end"] == (3990.0, -18.0)
    assert images["turned over"] == (10.0, -18.0)
    assert set(HOW_TO_LAY) == set(LAID)


@given(found=places, laid=st.sampled_from(LAID), noise=st.floats(-0.02, 0.02))
def test_a_turned_copy_joins_the_group_of_its_plank(
    plank: Plank, found: set[tuple[int, int]], laid: Laid, noise: float
) -> None:
    blank = blank_of(found)
    turned = laid_blank(blank, laid)
    # Both ends of the noise stay within 0.05 mm of the master, and so must share its template.
    turned = replace(turned, holes=tuple(replace(hole, station=hole.station + noise) for hole in turned.holes))
    planks = [with_blank(plank, "S1-G-01", blank), with_blank(plank, "S1-G-02", turned)]
    (group,) = drill_groups(planks)
    master, member = group.members
    assert (master.mark, member.mark) == ("S1-G-01", "S1-G-02")
    assert sorted(member.holes) == list(range(len(blank.holes)))
    own = np.array([(turned.holes[i].station, turned.holes[i].offset) for i in member.holes])
    wanted = np.array([(hole.station, hole.offset) for hole in blank.holes])
    assert np.abs(laid_points(own, LENGTH, member.laid) - wanted).max() <= 0.05


@given(found=places, laid=st.sampled_from(LAID), which=st.integers(0, 13), along=st.booleans())
def test_a_plank_with_one_hole_0_2_mm_off_needs_its_own_template(
    plank: Plank, found: set[tuple[int, int]], laid: Laid, which: int, along: bool
) -> None:
    blank = blank_of(found)
    holes = list(laid_blank(blank, laid).holes)
    hole = holes[which % len(holes)]
    moved = replace(hole, station=hole.station + 0.2) if along else replace(hole, offset=hole.offset + 0.2)
    holes[which % len(holes)] = moved
    other = replace(blank, holes=tuple(holes))
    assert len(drill_groups([with_blank(plank, "S1-G-01", blank), with_blank(plank, "S1-G-02", other)])) == 2


def test_agreement_ends_at_a_twentieth_of_a_millimetre(plank: Plank) -> None:
    blank = blank_of({(500, 18), (900, -18)})
    for gap, together in ((0.049, True), (0.051, False)):
        first = replace(blank.holes[0], station=blank.holes[0].station + gap)
        drilled_off = replace(blank, holes=(first, blank.holes[1]))
        longer = replace(blank, length=LENGTH + gap)
        thicker = replace(blank, section=CrossSection(100.0, 12.0 + gap))
        for other in (drilled_off, longer, thicker):
            found = member_of(with_blank(plank, "S1-G-01", blank), with_blank(plank, "S1-G-02", other))
            assert (found is not None) == together


@pytest.mark.parametrize("change", [{"diameter": 6.5}, {"use": "screw"}, {"slot": 6.0}])
def test_holes_of_another_kind_need_another_template(plank: Plank, change: dict[str, object]) -> None:
    blank = blank_of({(500, 18), (900, -18)})
    other = replace(blank, holes=(replace(blank.holes[0], **change), blank.holes[1]))  # type: ignore[arg-type]
    assert len(drill_groups([with_blank(plank, "S1-G-01", blank), with_blank(plank, "S1-G-02", other)])) == 2


def corners(blank: Blank) -> Floats:
    half, start, end = blank.section.width / 2.0, cut_slope(blank.start_cut), cut_slope(blank.end_cut)
    return np.array([(s * half * slope + at, s * half) for at, slope in ((0.0, start), (LENGTH, end)) for s in (-1, 1)])


@pytest.mark.parametrize(
    ("laid", "start", "end"),
    [
        ("as is", 60.0, 75.0),
        ("turned end for end", 75.0, 60.0),
        ("turned over", 120.0, 105.0),
        ("turned end for end and over", 105.0, 120.0),
    ],
)
def test_skew_ends_are_part_of_the_shape(plank: Plank, laid: Laid, start: float, end: float) -> None:
    blank = replace(blank_of({(500, 18), (900, -18)}), start_cut=EndCut(60.0), end_cut=EndCut(75.0))
    other = replace(laid_blank(blank, laid), start_cut=EndCut(start), end_cut=EndCut(end))
    assert {tuple(p) for p in laid_points(corners(other), LENGTH, laid).round(6)} == {
        tuple(p) for p in corners(blank).round(6)
    }
    (group,) = drill_groups([with_blank(plank, "S1-G-01", blank), with_blank(plank, "S1-G-02", other)])
    assert group.members[1].laid == laid
    square = replace(other, start_cut=EndCut(), end_cut=EndCut())
    assert member_of(group.master, with_blank(plank, "S1-G-02", square)) is None


def test_the_joints_of_a_template_hole_are_those_of_the_planks_that_it_drills(gridshell: Gridshell) -> None:
    planks = index_of(gridshell).planks
    for group in drill_groups(planks.values()):
        joints = drilled_joints(group, planks)
        for column, member in enumerate(group.members):
            drilled = Counter(row[column] for row in joints)
            assert drilled == Counter(hole.joint for hole in planks[member.mark].blank.holes)
