"""Cuts of abstract chains and rings, poses of boxes and groups of graphs: against brute force and closed forms."""

import itertools
import math
from collections.abc import Callable

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from aag_cad.units import Floats
from assembly.base.errors import PlanError
from assembly.base.segments import Limits
from assembly.transport.graph_groups import partition_graph
from assembly.transport.loading import best_pose, turned_rectangle
from assembly.transport.partition import Cuts, best_chain, best_ring
from assembly.transport.search import furthest

Weigh = Callable[[int, int], int | None]


def by_mass(load: float) -> Limits:
    """A transport of any size that carries so much."""
    return Limits(50000.0, 50000.0, 50000.0, load)


def brute_chain(stops: int, cost: list[int], weigh: Weigh) -> Cuts | None:
    """The best of all sets of cuts of a chain, by trying every one."""
    found = []
    for count in range(stops - 1):
        for inner in itertools.combinations(range(1, stops - 1), count):
            ends = (0, *inner, stops - 1)
            masses = [weigh(a, b) for a, b in itertools.pairwise(ends)]
            if all(m is not None for m in masses):
                squares = sum(m**2 for m in masses if m is not None)
                found.append(Cuts(len(masses), sum(cost[i] for i in inner), squares, inner))
    return min(found, default=None)


def brute_ring(stops: int, cost: list[int], weigh: Weigh, whole: int | None) -> Cuts | None:
    """The best of all sets of cuts of a ring: none, or two and more."""
    found = [] if whole is None else [Cuts(1, 0, whole**2, ())]
    for count in range(2, stops + 1):
        for cuts in itertools.combinations(range(stops), count):
            masses = [weigh(a, b) for a, b in itertools.pairwise((*cuts, cuts[0] + stops))]
            if all(m is not None for m in masses):
                squares = sum(m**2 for m in masses if m is not None)
                found.append(Cuts(count, sum(cost[i] for i in cuts), squares, cuts))
    return min(found, default=None)


def weigher(masses: list[int], widths: list[int], load: int, room: int) -> Weigh:
    """The mass of a stretch of bays, which come round again, or None if it is too heavy or too wide."""
    n = len(masses)

    def weigh(a: int, b: int) -> int | None:
        heavy, wide = (sum(values[i % n] for i in range(a, b)) for values in (masses, widths))
        return heavy if heavy <= load and wide <= room else None

    return weigh


def asked(weigh: Weigh) -> tuple[Callable[[int, int], bool], Callable[[int, int], int]]:
    """Whether there may be a stretch, and its mass: which is asked only of a stretch that may be."""

    def mass_of(a: int, b: int) -> int:
        found = weigh(a, b)
        assert found is not None
        return found

    return lambda a, b: weigh(a, b) is not None, mass_of


def test_every_small_chain_is_cut_as_by_brute_force() -> None:
    for bays in range(1, 6):
        for masses in itertools.product((1, 2, 3), repeat=bays):
            for inner in itertools.product((0, 1), repeat=bays - 1):
                cost, weigh = [0, *inner, 0], weigher(list(masses), [0] * bays, 4, 0)
                assert best_chain(range(bays + 1), cost.__getitem__, *asked(weigh)) == brute_chain(
                    bays + 1, cost, weigh
                )


bays = st.lists(st.tuples(st.integers(0, 40), st.integers(0, 9), st.integers(0, 5)), min_size=1, max_size=9)


@given(bays, st.integers(10, 120), st.integers(5, 25))
def test_chains_of_random_masses_and_sizes_are_cut_as_by_brute_force(
    chain: list[tuple[int, int, int]], load: int, room: int
) -> None:
    masses, widths, costs = (list(values) for values in zip(*chain, strict=True))
    cost, weigh = [*costs, 0], weigher(masses, widths, load, room)
    assert best_chain(range(len(cost)), cost.__getitem__, *asked(weigh)) == brute_chain(len(cost), cost, weigh)


@settings(max_examples=60)
@given(bays.filter(lambda ring: 3 <= len(ring) <= 8), st.integers(10, 160), st.integers(5, 40))
def test_rings_of_random_masses_and_sizes_are_cut_as_by_brute_force(
    ring: list[tuple[int, int, int]], load: int, room: int
) -> None:
    masses, widths, cost = (list(values) for values in zip(*ring, strict=True))
    n, weigh = len(ring), weigher(masses, widths, load, room)
    whole = weigh(0, n)
    assert best_ring(range(n), n, lambda stop: cost[stop % n], *asked(weigh)) == brute_ring(n, cost, weigh, whole)


@given(bays, st.integers(0, 120))
def test_the_furthest_fitting_stop_is_found_without_trying_all(chain: list[tuple[int, int, int]], load: int) -> None:
    weigh = weigher([m for m, _, _ in chain], [0] * len(chain), load, 0)
    n = len(chain)
    found = furthest(range(n + 1), n + 1, lambda a, b: weigh(a, b) is not None)
    assert found == {a: max(b for b in range(a, n + 1) if weigh(a, b) is not None) for a in range(n + 1)}


def test_a_rectangle_is_turned_so_that_it_fills_its_room_least() -> None:
    rectangle = np.array([(0, 0), (8, 0), (8, 3), (0, 3)]) @ np.array([(0.8, 0.6), (-0.6, 0.8)])
    assert turned_rectangle(rectangle, 10.0, 4.0)[0] == pytest.approx(0.8, abs=1e-12)
    # A bar of length 5 lies best on the diagonal of a square of 3.6: sin 45 degrees of it on each side.
    bar = np.array([(0.0, 0.0), (5.0, 0.0)])
    assert turned_rectangle(bar, 3.6, 3.6)[0] == pytest.approx(5.0 * math.sqrt(0.5) / 3.6, abs=1e-12)


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.floats(0.3, 3.0))
def test_no_turn_in_the_plane_fills_a_rectangle_less(seed: int, width: float) -> None:
    points = np.random.default_rng(seed).normal(size=(9, 2)) * (3.0, 1.0)
    filling, angle = turned_rectangle(points, 5.0, width)
    turns = np.linspace(0.0, math.pi, 2001)

    def filled(turn: Floats) -> Floats:
        c, s = np.cos(turn), np.sin(turn)
        return np.asarray(np.maximum(np.ptp(points @ [c, s], axis=0) / 5.0, np.ptp(points @ [-s, c], axis=0) / width))

    assert filled(np.array([angle]))[0] == pytest.approx(filling, rel=1e-9)
    assert filling <= filled(turns).min() + 1e-9


def test_a_turned_box_fits_the_room_of_its_own_size() -> None:
    corners = np.array(list(itertools.product((0.0, 9.0), (0.0, 2.0), (0.0, 3.0))))
    for seed in range(3):
        turned = corners @ Rotation.random(random_state=seed).as_matrix().T
        assert best_pose(turned, (9.0, 3.0, 2.0)).filling == pytest.approx(1.0, abs=1e-9)


def named(numbers: "nx.Graph[int]") -> "nx.Graph[str]":
    """A graph with the nodes 01, 02 and so on in place of 0, 1..."""
    graph: nx.Graph[str] = nx.Graph()
    graph.add_nodes_from(f"{i + 1:02d}" for i in numbers)
    graph.add_edges_from((f"{a + 1:02d}", f"{b + 1:02d}") for a, b in numbers.edges())
    return graph


def placed(graph: "nx.Graph[str]") -> "nx.Graph[str]":
    """A graph with a part of 1 kg every metre along x, in the order of its nodes."""
    for i, node in enumerate(sorted(graph)):
        graph.nodes[node].update(mass_kg=1.0, position=(1000.0 * i, 0.0, 0.0))
    return graph


def test_a_row_of_parts_is_parted_where_it_is_thinnest() -> None:
    row = placed(named(nx.barbell_graph(5, 0)))
    groups = partition_graph(row, by_mass(5.0))
    assert groups == (frozenset(["01", "02", "03", "04", "05"]), frozenset(["06", "07", "08", "09", "10"]))


@settings(max_examples=5)
@given(st.integers(1, 20), st.integers(0, 1000), st.integers(2, 9))
def test_every_part_of_a_graph_is_in_one_group_that_fits(count: int, seed: int, load: int) -> None:
    graph = placed(named(nx.gnp_random_graph(count, 0.2, seed=seed)))
    limits = Limits(8000.0, 1000.0, 1000.0, float(load))
    groups = partition_graph(graph, limits)
    assert sorted(itertools.chain(*groups)) == sorted(graph)
    for group in groups:
        assert len(group) <= load
        assert np.ptp([graph.nodes[node]["position"][0] for node in group]) <= math.hypot(8000.0, 1000.0, 1000.0)
    assert groups == partition_graph(graph, limits)


def test_a_graph_without_masses_or_with_too_heavy_a_part_is_an_error() -> None:
    graph: nx.Graph[str] = nx.Graph()
    graph.add_node("a", position=(0.0, 0.0, 0.0))
    with pytest.raises(PlanError, match="a: no mass_kg"):
        partition_graph(graph, by_mass(5.0))
    graph.nodes["a"]["mass_kg"] = 6.0
    with pytest.raises(PlanError, match="a: 6 kg, at most 5 kg"):
        partition_graph(graph, by_mass(5.0))
