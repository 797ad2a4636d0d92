"""Random weaves: each unit laid once, nothing under what lies, no slide that cannot be done or is not needed."""

from itertools import combinations

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st
from weaving import Graph, Weave, ambiguous, can_slide, free_beyond, graph_of, is_acyclic, radius_of, weaves

from assembly.graph.interlacing import interlacing


@given(weaves())
def test_every_unit_is_laid_once_or_left_out(weave: Weave) -> None:
    found = interlacing(graph_of(weave))
    laid = list(nx.topological_sort(found.precedence))
    assert sorted([*laid, *found.left_out]) == sorted(member.mark for member in weave.members)
    assert bool(found.left_out) == bool(found.findings)


@given(weaves())
def test_the_crossings_of_two_beams_at_a_joint_are_one(weave: Weave) -> None:
    found = {(at.joint, at.lower, at.upper): (at.lower_mm, at.upper_mm) for at in interlacing(graph_of(weave)).overlaps}
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
        assert slide.joints in (ordered, ordered[::-1])
        assert len(ordered) < 2 or (slide.joints == ordered) == (slide.end == "start")


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
    assert (one.overlaps, one.slides, one.findings) == (two.overlaps, two.slides, two.findings)
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
    assert all(layers[at.lower] < layers[at.upper] for at in found.overlaps)
    assert len(found.overlaps) == len(weave.crossings)
