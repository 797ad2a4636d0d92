"""Weaves: what is laid first, what is slid in afterwards, and what nobody can put together."""

import math
from dataclasses import dataclass
from itertools import combinations, pairwise

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aag_cad.parts.model import Gridshell
from assembly.errors import PlanError
from assembly.graph import assembly_graph
from assembly.graph_file import graph_text, read_graph
from assembly.interlacing import Interlacing, Slide, interlacing, refuse_left_out
from assembly.sliding import bend_radius, free_way
from assembly.weaves import circle_graph, kagome_graph

Point = tuple[float, float]
Graph = nx.MultiGraph


@dataclass(frozen=True)
class Member:
    """A unit of a random weave: one plank, or two siblings 36 mm apart."""

    mark: str
    start: Point
    end: Point
    upright: bool
    coupled: bool
    radius: float

    @property
    def depth(self) -> float:
        """Its size along the surface normal, mm."""
        return 100.0 if self.upright else 12.0

    @property
    def length(self) -> float:
        """Its length, mm."""
        return math.dist(self.start, self.end)


@dataclass(frozen=True)
class Weave:
    """Members and for each crossing the lower, the upper, and how far along them it lies."""

    members: tuple[Member, ...]
    crossings: tuple[tuple[str, str, float, float], ...]

    def of(self, mark: str) -> Member:
        """Return the member of a mark."""
        return next(member for member in self.members if member.mark == mark)


def met(a: tuple[Point, Point], b: tuple[Point, Point]) -> tuple[float, float] | None:
    """Cramer's rule: the shares of two lines at which they cross, or None if they are parallel."""
    (ax, ay), (bx, by) = (np.subtract(line[1], line[0]) for line in (a, b))
    gx, gy = np.subtract(b[0], a[0])
    turn = ax * by - ay * bx
    if abs(turn) < 1e-6 * math.hypot(ax, ay) * math.hypot(bx, by):
        return None
    return float((gx * by - gy * bx) / turn), float((gx * ay - gy * ax) / turn)


@st.composite
def weaves(draw: st.DrawFn, most: int = 9) -> Weave:
    place = st.integers(0, 40).map(lambda i: 100.0 * i)
    anywhere = st.tuples(st.tuples(place, place), st.tuples(place, place))
    # From side to side of the floor, so that most lines cross.
    across = st.tuples(place, place).map(lambda y: ((0.0, y[0]), (4000.0, y[1])))
    along = st.tuples(place, place).map(lambda x: ((x[0], 0.0), (x[1], 4000.0)))
    members = []
    for i, line in enumerate(draw(st.lists(st.one_of(across, along, anywhere), min_size=3, max_size=most))):
        start, end = line
        if math.dist(start, end) > 500.0:
            upright = draw(st.sampled_from([False, False, True]))
            kind = (upright, upright and draw(st.booleans()), draw(st.sampled_from([100.0, 900.0, 4000.0])))
            # Odd shifts keep lines from meeting in their ends, where touching is a matter of rounding.
            shift = 7.0 * i + 3.0
            moved = [(x + shift, y - 0.7 * shift) for x, y in (start, end)]
            members.append(Member(f"U{i}", moved[0], moved[1], *kind))
    crossings = []
    for a, b in combinations(members, 2):
        shares = met((a.start, a.end), (b.start, b.end))
        if shares and all(0.02 < share < 0.98 for share in shares):
            at = ((a, shares[0]), (b, shares[1]))
            (low, x), (high, y) = at if draw(st.booleans()) else at[::-1]
            crossings.append((low.mark, high.mark, x * low.length, y * high.length))
    return Weave(tuple(members), tuple(crossings))


def planks_of(member: Member) -> dict[str, float]:
    """Return the planks of a member and how far each lies left of its line, mm."""
    return {f"{member.mark}-L": 18.0, f"{member.mark}-R": -18.0} if member.coupled else {member.mark: 0.0}


def graph_of(weave: Weave) -> "Graph[str]":
    graph: Graph[str] = Graph(name="weave")
    for member in weave.members:
        across = np.array([member.start[1] - member.end[1], member.end[0] - member.start[0]]) / member.length
        for plank, aside in planks_of(member).items():
            start, end = ((*np.add(point, aside * across).tolist(), 0.0) for point in (member.start, member.end))
            graph.add_node(
                plank, kind="plank", mass_kg=1.0, length_mm=member.length, start=start, end=end, upright=member.upright,
                depth_mm=member.depth, min_radius_mm=member.radius, beam=member.mark if member.coupled else "",
            )  # fmt: skip
    for i, (low, high, x, y) in enumerate(weave.crossings):
        for a in planks_of(weave.of(low)):
            for b in planks_of(weave.of(high)):
                graph.add_edge(a, b, key=f"J{i}", kind="crossing", joint=f"J{i}", above=b, below_mm=x, above_mm=y)
    return graph


def radius_of(weave: Weave, mark: str) -> float:
    """The smallest radius of a member: two equal arcs wherever it changes sides, the others lie in one level."""
    places = sorted(
        (x if mark == low else y, mark == high, weave.of(high if mark == low else low).depth)
        for low, high, x, y in weave.crossings
        if mark in (low, high)
    )
    own = weave.of(mark).depth
    radii = [
        (y - x) ** 2 / (4.0 * (one / 2.0 + own + other / 2.0))
        for (x, over, one), (y, next_over, other) in pairwise(places)
        if over != next_over
    ]
    return min(radii, default=math.inf)


def free_beyond(weave: Weave, mark: str) -> dict[str, float]:
    """The way to the nearest line beyond each end of a member, those that it crosses at a joint left aside."""
    member = weave.of(mark)
    partners = {end for low, high, _, _ in weave.crossings if mark in (low, high) for end in (low, high)}
    free = {"start": math.inf, "end": math.inf}
    for other in weave.members:
        if other.mark in partners | {mark}:
            continue
        shares = met((member.start, member.end), (other.start, other.end))
        if shares is None:
            continue
        if -1.0 / other.length <= shares[1] <= 1.0 + 1.0 / other.length:
            if shares[0] <= 0.0:
                free["start"] = min(free["start"], -shares[0] * member.length)
            if shares[0] >= 1.0:
                free["end"] = min(free["end"], (shares[0] - 1.0) * member.length)
    return free


def can_slide(weave: Weave, mark: str) -> bool:
    member = weave.of(mark)
    return (
        not member.upright
        and radius_of(weave, mark) >= member.radius
        and max(free_beyond(weave, mark).values()) >= member.length
    )


def is_acyclic(weave: Weave, marks: set[str]) -> bool:
    edges = [(low, high) for low, high, _, _ in weave.crossings if low in marks and high in marks]
    return nx.is_directed_acyclic_graph(nx.DiGraph(edges))


def ambiguous(weave: Weave) -> bool:
    """Whether a line runs just past the end of another one, or lies along it: then rounding decides what is free."""
    for a, b in combinations(weave.members, 2):
        shares = met((a.start, a.end), (b.start, b.end))
        if shares is None:
            (x, y), (gx, gy) = np.subtract(a.end, a.start) / a.length, np.subtract(b.start, a.start)
            if abs(gx * y - gy * x) < 5.0:
                return True
            continue
        for share, member in zip(shares, (a, b), strict=True):
            if min(abs(share), abs(share - 1.0)) * member.length < 5.0:
                return True
    return False


@given(weaves())
def test_every_unit_is_laid_once_or_left_out(weave: Weave) -> None:
    found = interlacing(graph_of(weave))
    laid = list(nx.topological_sort(found.precedence))
    assert sorted([*laid, *found.left_out]) == sorted(member.mark for member in weave.members)
    assert bool(found.left_out) == bool(found.findings)


@given(weaves())
def test_the_crossings_of_two_beams_at_a_joint_are_one(weave: Weave) -> None:
    found = {
        (at.joint, at.lower, at.upper): (at.lower_mm, at.upper_mm) for at in interlacing(graph_of(weave)).crossings
    }
    assert found == {(f"J{i}", low, high): (x, y) for i, (low, high, x, y) in enumerate(weave.crossings)}


@given(weaves())
def test_nothing_is_laid_under_what_lies_already_unless_it_is_slid_in(weave: Weave) -> None:
    found = interlacing(graph_of(weave))
    slid = {slide.unit for slide in found.slides}
    lying: set[str] = set()
    for unit in nx.topological_sort(found.precedence):
        over = {high for low, high, _, _ in weave.crossings if low == unit and high in lying}
        assert not over or unit in slid
        if unit not in slid:
            under = {low for low, high, _, _ in weave.crossings if high == unit} - set(found.left_out)
            assert under - slid <= lying
        lying.add(unit)


@given(weaves())
def test_a_slid_unit_comes_after_all_that_it_passes_and_passes_it_in_order(weave: Weave) -> None:
    found = interlacing(graph_of(weave))
    turns = {slide.unit: i for i, slide in enumerate(found.slides)}
    for turn, slide in enumerate(found.slides):
        passed = []
        for i, (low, high, x, y) in enumerate(weave.crossings):
            other = {low: high, high: low}.get(slide.unit)
            if other and other not in found.left_out and turns.get(other, -1) < turn:
                assert found.precedence.has_edge(other, slide.unit)
                passed.append((x if slide.unit == low else y, f"J{i}"))
        ordered = tuple(joint for _, joint in sorted(passed))
        assert slide.crossings in (ordered, ordered[::-1])
        assert len(ordered) < 2 or (slide.crossings == ordered) == (slide.end == "start")


@given(weaves())
def test_whatever_is_slid_in_bends_far_enough_and_has_its_own_length_of_free_floor(weave: Weave) -> None:
    for slide in interlacing(graph_of(weave)).slides:
        member = weave.of(slide.unit)
        assert not member.upright
        assert slide.radius == pytest.approx(radius_of(weave, slide.unit))
        assert slide.radius >= member.radius
        assert slide.free >= member.length
        if not ambiguous(weave):
            free = free_beyond(weave, slide.unit)
            # Free ways are given to a thousandth of a millimetre.
            assert slide.free == pytest.approx(free[slide.end], abs=2e-3)
            assert slide.free >= max(free.values()) - 1.01


@given(weaves())
def test_no_slide_is_needless(weave: Weave) -> None:
    found = interlacing(graph_of(weave))
    laid = {member.mark for member in weave.members} - set(found.left_out) - {slide.unit for slide in found.slides}
    assert is_acyclic(weave, laid)
    for slide in found.slides:
        assert not is_acyclic(weave, laid | {slide.unit})


@given(weaves(most=6))
def test_no_choice_of_slides_resolves_what_is_called_impossible(weave: Weave) -> None:
    """Brute force: all subsets of the units that can be slid in; what is left out stays in a circle under each."""
    found = interlacing(graph_of(weave))
    if ambiguous(weave):
        return
    able = [member.mark for member in weave.members if can_slide(weave, member.mark)]
    marks = {member.mark for member in weave.members}
    ways = [set(out) for count in range(len(able) + 1) for out in combinations(able, count)]
    resolved = [out for out in ways if is_acyclic(weave, marks - out)]
    assert bool(resolved) == (not found.findings)
    for finding in found.findings:
        circle = set(finding.mark.split(", "))
        assert circle <= set(found.left_out)
        assert not any(is_acyclic(weave, circle - out) for out in ways)


@given(weaves())
def test_the_same_weave_gives_the_same_order_however_its_graph_was_built(weave: Weave) -> None:
    graph = graph_of(weave)
    other: Graph[str] = Graph(name="weave")
    other.add_nodes_from(reversed(list(graph.nodes(data=True))))
    for a, b, key, edge in reversed(list(graph.edges(keys=True, data=True))):
        other.add_edge(b, a, key=key, **edge)
    one, two = interlacing(graph), interlacing(other)
    assert (one.crossings, one.slides, one.findings) == (two.crossings, two.slides, two.findings)
    assert list(one.precedence.edges(data=True)) == list(two.precedence.edges(data=True))


@given(weaves(), st.data())
def test_units_of_different_layers_need_no_slides(weave: Weave, data: st.DataObject) -> None:
    graph = graph_of(weave)
    layers = {member.mark: data.draw(st.integers(-9, 9)) + 20 * i for i, member in enumerate(weave.members)}
    for mark, node in graph.nodes(data=True):
        node["layer"] = layers[node["beam"] or mark]
    for _, _, edge in graph.edges(data=True):
        del edge["above"], edge["below_mm"], edge["above_mm"]
    found = interlacing(graph)
    assert not found.slides
    assert not found.findings
    assert all(layers[at.lower] < layers[at.upper] for at in found.crossings)
    assert len(found.crossings) == len(weave.crossings)


def test_what_is_said_of_a_crossing_counts_more_than_the_layers() -> None:
    weave = Weave((flat("A", (0.0, 0.0), (2000.0, 0.0)), flat("B", (900.0, -900.0), (900.0, 900.0))), ())
    graph = graph_of(weave)
    graph.nodes["A"]["layer"], graph.nodes["B"]["layer"] = 0, 1
    graph.add_edge("A", "B", kind="crossing", above="A")
    found = interlacing(graph)
    assert list(found.precedence.edges) == [("B", "A")]
    # Stations that the graph does not give are those where the lines cross.
    assert (found.crossings[0].lower_mm, found.crossings[0].upper_mm) == pytest.approx((900.0, 900.0))


def flat(mark: str, start: Point, end: Point, radius: float = 1700.0) -> Member:
    return Member(mark, start, end, upright=False, coupled=False, radius=radius)


def square(radius: float, *strays: Member) -> Weave:
    """Four planks round a square of 1 m, each over the next, all of them 1.4 m long."""
    lines = [((-200.0, 0.0), (1200.0, 0.0)), ((1000.0, -200.0), (1000.0, 1200.0))]
    lines += [((1200.0, 1000.0), (-200.0, 1000.0)), ((0.0, 1200.0), (0.0, -200.0))]
    members = [flat(f"Q{i + 1}", start, end, radius) for i, (start, end) in enumerate(lines)]
    crossings = [(f"Q{(i + 1) % 4 + 1}", f"Q{i + 1}", 200.0, 1200.0) for i in range(4)]
    return Weave((*members, *strays), tuple(crossings))


def test_one_plank_of_four_round_a_square_is_slid_in() -> None:
    found = interlacing(graph_of(square(1700.0)))
    # R = 1000^2 / (4 x 24) = 10.4 m; both ends are free, so it comes in at its start, past its lower crossing first.
    expected = Slide("Q1", "start", math.inf, ("J3", "J0"), 1000.0**2 / 96.0)
    assert found.slides == (expected,)
    assert not found.findings


def test_too_stiff_a_square_is_a_finding_with_its_radius() -> None:
    found = interlacing(graph_of(square(12000.0)))
    assert found.left_out == ("Q1", "Q2", "Q3", "Q4")
    (finding,) = found.findings
    assert (finding.code, finding.severity, finding.mark) == ("AAG951", "error", "Q1, Q2, Q3, Q4")
    for name in ("J0", "J1", "J2", "J3", "10417 mm", "12000 mm"):
        assert name in finding.text


def walls(gap: float) -> list[Member]:
    """Two long planks on each side of the square, the gap beyond the ends of its planks."""
    low, high = -200.0 - gap, 1200.0 + gap
    lines = [
        ((low, -3e3), (low, 4e3)),
        ((high, -3e3), (high, 4e3)),
        ((-3e3, low), (4e3, low)),
        ((-3e3, high), (4e3, high)),
    ]
    return [flat(f"W{i}", start, end) for i, (start, end) in enumerate(lines)]


def test_a_plank_needs_its_own_length_of_free_floor() -> None:
    """Each wall has 1.4 m and 1 mm of room before it, then 1 mm less than that."""
    roomy = interlacing(graph_of(square(1700.0, *walls(1401.0))))
    assert [(slide.unit, slide.free) for slide in roomy.slides] == [("Q1", 1401.0)]
    tight = interlacing(graph_of(square(1700.0, *walls(1399.0))))
    assert tight.left_out == ("Q1", "Q2", "Q3", "Q4")
    assert "1399 mm of free floor beyond either end, 1400 mm needed" in tight.findings[0].text


def test_the_end_with_more_free_floor_is_taken() -> None:
    wall = walls(3000.0)[0]
    assert interlacing(graph_of(square(1700.0, wall))).slides[0].end == "end"


def test_what_lies_later_is_in_nobodys_way() -> None:
    graph = graph_of(square(1700.0, *walls(100.0)))
    assert interlacing(graph).findings
    assert not interlacing(graph, later=[f"W{i}" for i in range(4)]).findings
    for i in range(4):
        graph.nodes[f"W{i}"]["family"] = "E"
    assert not interlacing(graph).findings


def test_an_end_that_meets_another_plank_is_not_free() -> None:
    graph = graph_of(square(1700.0, flat("W", (-201.0, -500.0), (-201.0, 500.0))))
    graph.add_edge("Q1", "W", kind="crossing", joint="M", above="", below_mm=0.0, above_mm=500.0)
    found = interlacing(graph)
    assert (found.slides[0].unit, found.slides[0].end) == ("Q1", "end")
    assert not found.precedence.has_edge("Q1", "W")
    assert not found.precedence.has_edge("W", "Q1")


@pytest.mark.parametrize(("attribute", "said"), [("upright", "upright"), ("slides", "not to be slid in")])
def test_a_plank_that_may_not_be_slid_in_stays_where_it_is(attribute: str, said: str) -> None:
    graph = graph_of(square(1700.0))
    for mark in ("Q1", "Q2", "Q4"):
        graph.nodes[mark][attribute] = attribute == "upright"
    assert [slide.unit for slide in interlacing(graph).slides] == ["Q3"]
    graph.nodes["Q3"][attribute] = attribute == "upright"
    assert f"Q1, Q2, Q3, Q4: {'marked as ' * (said != 'upright')}{said}" in interlacing(graph).findings[0].text


def test_an_upright_plank_may_be_slid_in_if_its_graph_says_so() -> None:
    graph = graph_of(square(1.0))
    for mark in graph:
        graph.nodes[mark]["upright"] = True
    assert interlacing(graph).findings
    graph.nodes["Q3"]["slides"] = True
    assert [slide.unit for slide in interlacing(graph).slides] == ["Q3"]


@pytest.mark.parametrize("unknown", ["depth_mm", "min_radius_mm"])
def test_a_bend_that_cannot_be_checked_is_not_made(unknown: str) -> None:
    graph = graph_of(square(1700.0))
    for mark in graph:
        del graph.nodes[mark][unknown]
    assert "the bend cannot be checked" in interlacing(graph).findings[0].text


def test_between_the_layers_of_a_vault_a_plank_stays_straight() -> None:
    """Under beams of the upper layer and over those of the lower one, a geodesic has its own layer, 12 mm deep."""
    graph = graph_of(square(1e9))
    for mark, layer in (("Q1", 0), ("Q2", -1), ("Q3", 0), ("Q4", 1)):
        graph.nodes[mark]["layer"] = layer
    found = interlacing(graph)
    assert [(slide.unit, slide.radius) for slide in found.slides] == [("Q1", math.inf)]


def test_two_arcs_of_the_radius_lead_over_the_height() -> None:
    """Two arcs of angle p: 2 R sin p = a and 2 R (1 - cos p) = h; for a small p that makes R = a^2 / 4h."""
    spacing, height = 500.0, 24.0
    radius = bend_radius(spacing, height)
    angle = math.asin(spacing / (2.0 * radius))
    # What the formula leaves out is (h / a)^2 = 0.23 %, and the square of that.
    assert 2.0 * radius * (1.0 - math.cos(angle)) == pytest.approx(height, rel=1.01 * (height / spacing) ** 2)
    assert bend_radius(spacing, 0.0) == math.inf


def test_a_line_along_the_way_blocks_it_where_it_begins() -> None:
    origin, direction = np.array([0.0, 0.0]), np.array([1.0, 0.0])
    ahead = np.array([[[700.0, 0.0], [900.0, 0.0]]])
    assert free_way(origin, direction, ahead) == 700.0
    assert free_way(origin, -direction, ahead) == math.inf
    assert free_way(origin, direction, ahead + np.array([0.0, 5.0])) == math.inf
    assert free_way(origin, direction, np.zeros((0, 2, 2))) == math.inf


def test_the_vault_is_laid_in_three_layers_without_slides(gridshell: Gridshell) -> None:
    graph = assembly_graph(gridshell)
    found = interlacing(graph)
    assert (found.slides, found.findings, found.left_out) == ((), (), ())
    family = {node["beam"] or mark: node["family"] for mark, node in graph.nodes(data=True) if node["kind"] == "plank"}
    assert set(found.precedence) == set(family)
    pairs = {(family[lower], family[upper]) for lower, upper in found.precedence.edges}
    assert pairs == {("A1", "A2"), ("A1", "G"), ("G", "A2"), ("A1", "E"), ("E", "A2")}
    joints = [at.joint for at in found.crossings]
    kinds = {"AA", "AG", "boundary"}
    assert sorted(joints) == sorted(j.mark for shell in gridshell.shells for j in shell.joints if j.kind in kinds)


@pytest.fixture(scope="module")
def kagome() -> Interlacing:
    return interlacing(read_graph(graph_text("kagome")))


def test_in_the_kagome_no_plank_is_above_or_below_all_others(kagome: Interlacing) -> None:
    lower, upper = {at.lower for at in kagome.crossings}, {at.upper for at in kagome.crossings}
    assert len(lower) == len(upper) == 18
    over = {(at.upper[:2], at.lower[:2]) for at in kagome.crossings}
    assert over == {("P1", "P2"), ("P2", "P3"), ("P3", "P1")}


def test_along_every_plank_of_the_kagome_over_and_under_take_turns_every_500_mm(kagome: Interlacing) -> None:
    for unit in {at.lower for at in kagome.crossings}:
        places = sorted([(at.lower_mm, "under") for at in kagome.crossings if at.lower == unit] +
                        [(at.upper_mm, "over") for at in kagome.crossings if at.upper == unit])  # fmt: skip
        assert all(one != other for (_, one), (_, other) in pairwise(places))
        # The ends of the planks are given to a thousandth of a millimetre.
        np.testing.assert_allclose(np.diff([x for x, _ in places]), 500.0, atol=2e-3)


def test_one_family_of_the_kagome_is_slid_in(kagome: Interlacing) -> None:
    assert [slide.unit for slide in kagome.slides] == [f"P1-0{i}" for i in range(1, 7)]
    assert not kagome.findings
    for slide in kagome.slides:
        # a^2 / (4 x 24 mm), a = 500 mm to a hundredth of a millimetre.
        assert slide.radius == pytest.approx(500.0**2 / 96.0, rel=2e-5)
        assert slide.free == math.inf
    laid = kagome.precedence.subgraph(mark for mark in kagome.precedence if not mark.startswith("P1"))
    assert {(first[:2], then[:2]) for first, then in laid.edges} == {("P3", "P2")}


def test_a_kagome_of_narrower_mesh_cannot_be_woven_of_these_planks() -> None:
    """R = 400^2 / 96 = 1667 mm is less than 1700 mm, 405^2 / 96 = 1709 mm is more."""
    assert not interlacing(kagome_graph(mesh=405.0)).findings
    found = interlacing(kagome_graph(mesh=400.0))
    assert len(found.left_out) == 18
    assert "1667 mm, at least 1700 mm" in found.findings[0].text


def test_four_upright_planks_in_a_circle_are_left_out_and_all_else_is_laid() -> None:
    found = interlacing(read_graph(graph_text("impossible")))
    assert found.left_out == ("B-1", "B-2", "B-3", "B-4")
    assert sorted(found.precedence) == ["G-1", "G-2", "G-3", "L-1", "L-2", "L-3"]
    assert not found.slides
    (finding,) = found.findings
    circle = [at.joint for at in found.crossings if at.lower[0] == at.upper[0] == "B"]
    assert len(circle) == 4
    for name in (*circle, *found.left_out, "upright"):
        assert name in finding.text


def test_every_circle_is_named_when_a_weave_is_refused() -> None:
    graph: Graph[str] = Graph(nx.union(circle_graph(), circle_graph(), rename=("X", "Y")))
    for _, _, edge in graph.edges(data=True):
        del edge["above"], edge["joint"]
    for tower in "XY":
        for i in range(4):
            lower, upper = f"{tower}B-{(i + 1) % 4 + 1}", f"{tower}B-{i + 1}"
            for edge in graph[lower][upper].values():
                edge["above"] = upper
    found = interlacing(graph)
    assert len(found.findings) == 2
    with pytest.raises(PlanError, match=r"(?s)XB-1, XB-2, XB-3, XB-4.*YB-1, YB-2, YB-3, YB-4"):
        refuse_left_out(found)


def test_a_finding_speaks_german_with_the_same_figures() -> None:
    (english,), (german,) = (interlacing(circle_graph(), language=language).findings for language in ("en", "de"))
    assert (english.code, english.mark, english.found) == (german.code, german.mark, german.found)
    assert "hochkant" in german.what
    for name in ("B-4", "J-025", "1700 mm"):
        assert name in german.what
