"""How long large gridshells take to plan: graph, interlacing and flat order, with their memory and how they grow."""

import gc
import math
import resource
import time
from collections.abc import Iterator
from contextlib import contextmanager

import networkx as nx
import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from aag_cad.design import design_text, load_design, parse_design
from aag_cad.pipeline import gridshell_of
from aag_cad.units import Vector
from assembly.checks.graph_plan import check_graph_plan
from assembly.graph.gridshell_graph import assembly_graph
from assembly.graph.interlacing import interlacing
from assembly.laying.order import FlatOrder, flat_order_of
from assembly.locking.order import locking_orders
from assembly.plan.graph_plan import graph_plan
from assembly.plan.planned import limits_of, planned_of

SPACING = 500.0


def _point(u: float, v: float) -> Vector:
    """Return the point at u spacings along A1 and v along A2, mm."""
    return SPACING * (u + v / 2.0), SPACING * v * math.sqrt(0.75), 0.0


def _mark(family: str, number: int) -> str:
    width = 3 if family in "NK" else 2
    return f"S1-{family}-{number:0{width}d}"


def _add_plank(graph: "nx.MultiGraph[str]", mark: str, beam: str, layer: int, a: Vector, b: Vector) -> None:
    upright, long = bool(beam), math.dist(a, b)
    middle = tuple((np.array(a) + b) / 2.0)
    graph.add_node(
        mark, kind="plank", family=mark.split("-")[1], shell="S1", beam=beam, layer=layer, mass_kg=long * 8e-4,
        length_mm=long, position=middle, start=a, end=b, upright=upright, depth_mm=80.0 if upright else 10.0,
        min_radius_mm=1700.0,
    )  # fmt: skip


def _add_part(graph: "nx.MultiGraph[str]", mark: str, kind: str, at: Vector, beam: str = "") -> None:
    family = mark.split("-")[1]
    graph.add_node(
        mark, kind=kind, family=family, shell="S1", beam=beam, layer=None, mass_kg=0.1, length_mm=220.0, position=at
    )


def _tie(graph: "nx.MultiGraph[str]", joint: str, kind: str, how: str, a: str, b: str) -> None:
    graph.add_edge(a, b, key=joint, kind=how, joint=joint, joint_kind=kind)


def _cross(graph: "nx.MultiGraph[str]", joint: str, kind: str, lower: str, upper: str) -> None:
    """Add a crossing with its stations: the distances of the joint from the starts of both planks."""
    below, above = (math.dist(graph.nodes[mark]["start"], graph.nodes[joint]["position"]) for mark in (lower, upper))
    graph.add_edge(
        lower, upper, key=joint, kind="crossing", joint=joint, joint_kind=kind, above=upper, below_mm=below,
        above_mm=above,
    )  # fmt: skip


def _add_stud(graph: "nx.MultiGraph[str]", number: int, at: Vector, lower: str, upper: str) -> None:
    stud = _mark("N", number)
    _add_part(graph, stud, "stud", at)
    _add_part(graph, f"{stud}-B1", "bolt", at)
    _tie(graph, stud, "AA", "bolted", stud, f"{stud}-B1")
    for a in "LR":
        for beam in (lower, upper):
            _tie(graph, stud, "AA", "bolted", stud, f"{beam}-{a}")
        for b in "LR":
            _cross(graph, stud, "AA", f"{lower}-{a}", f"{upper}-{b}")


def _add_block(graph: "nx.MultiGraph[str]", number: int, at: Vector, beam: str, flat: str) -> None:
    block = _mark("K", number)
    _add_part(graph, block, "coupling block", at, beam)
    _tie(graph, block, "AG", "screwed", block, flat)
    for side in "LR":
        plank = f"{beam}-{side}"
        _tie(graph, block, "AG", "coupled", block, plank)
        _cross(graph, block, "AG", *((flat, plank) if "-A2-" in plank else (plank, flat)))


def trihex_graph(n: int) -> "nx.MultiGraph[str]":
    """Return a flat tri-hex shell with n x n studs: n lower and n upper coupled beams, geodesics between them.

    A geodesic crosses every second of the triangles' sides in the middle, so that beams and geodesics meet in 2 n (n-1)
    coupling blocks.
    """
    graph: nx.MultiGraph[str] = nx.MultiGraph(name=f"tri-hex of {n} x {n} nodes")
    last = n - 1
    for i in range(n):
        for family, layer, a, b in (
            ("A1", -1, _point(-0.3, i), _point(last + 0.3, i)),
            ("A2", 1, _point(i, -0.3), _point(i, last + 0.3)),
        ):
            beam = _mark(family, i + 1)
            for side in "LR":
                _add_plank(graph, f"{beam}-{side}", beam, layer, a, b)
    for k in range(2 * last):
        low, high = max(0.0, k + 0.5 - last) - 0.3, min(float(last), k + 0.5) + 0.3
        _add_plank(graph, _mark("G", k + 1), "", 0, _point(k + 0.5 - low, low), _point(k + 0.5 - high, high))
    number = 0
    for j in range(n):
        for i in range(n):
            _add_stud(graph, j * n + i + 1, _point(i, j), _mark("A1", j + 1), _mark("A2", i + 1))
            if i < last:
                number += 1
                _add_block(graph, number, _point(i + 0.5, j), _mark("A1", j + 1), _mark("G", i + j + 1))
            if j < last:
                number += 1
                _add_block(graph, number, _point(i, j + 0.5), _mark("A2", i + 1), _mark("G", i + j + 1))
    return graph


def planned_in(graph: "nx.MultiGraph[str]") -> tuple[FlatOrder, float]:
    """Return the flat order of a graph, and the seconds of this process that interlacing and order took."""
    start = time.process_time()
    order = flat_order_of(graph, interlacing(graph))
    return order, time.process_time() - start


@contextmanager
def own_garbage() -> Iterator[None]:
    """Leave what the process held before out of the garbage collector's rounds: they would count against one size."""
    gc.collect()
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()


def growth(sizes: list[int], seconds: list[float]) -> float:
    """Return the exponent of growth: the slope of the seconds over the sizes, both as logarithms."""
    return float(np.polyfit(np.log(sizes), np.log(seconds), 1)[0])


def test_ten_thousand_nodes_within_seconds_and_two_gigabytes(benchmark: BenchmarkFixture) -> None:
    """10 000 AA nodes are some 40 000 parts."""
    graph = trihex_graph(100)
    assert sum(node["kind"] == "stud" for _, node in graph.nodes(data=True)) == 10_000
    assert 40_000 <= len(graph) <= 41_000
    order, seconds = benchmark.pedantic(planned_in, (graph,), rounds=1)
    assert seconds < 20.0
    assert [len(run) for run in order.runs] == [100, 198, 100]
    peak_mb = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    benchmark.extra_info["peak_mb"] = round(peak_mb)
    assert peak_mb < 2000


def test_time_grows_hardly_faster_than_the_number_of_parts(benchmark: BenchmarkFixture) -> None:
    graphs = [trihex_graph(n) for n in (30, 50, 100)]
    with own_garbage():
        seconds = [min(planned_in(graph)[1] for _ in range(2)) for graph in graphs]
    exponent = growth([len(graph) for graph in graphs], seconds)
    benchmark.extra_info |= {"seconds": [round(each, 2) for each in seconds], "exponent": round(exponent, 2)}
    benchmark.pedantic(planned_in, (graphs[0],), rounds=1)
    assert exponent <= 1.2


def test_the_vault_with_twice_the_geodesics(benchmark: BenchmarkFixture) -> None:
    """Four times the parts: graph, interlacing and order of a real gridshell, with every screw."""
    text = design_text("vault")
    gridshells = [gridshell_of(parse_design(text.replace("geodesics = 14", f"geodesics = {n}"))) for n in (14, 28)]
    sizes, seconds = [], []
    for gridshell in gridshells:
        spans = []
        for _ in range(3):
            with own_garbage():
                start = time.process_time()
                graph = assembly_graph(gridshell)
                planned_in(graph)
                spans.append(time.process_time() - start)
        sizes.append(len(graph))
        seconds.append(min(spans))
    benchmark.extra_info |= {"parts": sizes, "seconds": [round(each, 2) for each in seconds]}
    benchmark.pedantic(assembly_graph, (gridshells[1],), rounds=1)
    assert growth(sizes, seconds) <= 1.2


@pytest.mark.parametrize("n", [10, 50])
def test_plan_and_check_of_a_whole_graph(benchmark: BenchmarkFixture, n: int) -> None:
    graph = trihex_graph(n)
    plan = benchmark.pedantic(graph_plan, (graph, 6, 25.0), rounds=1)
    assert check_graph_plan(plan, graph, 6) == []


def test_all_plans_of_the_vault(benchmark: BenchmarkFixture) -> None:
    """Flat order, locking, segments, plans up and down with their schedules: what ``aag plan vault`` works out."""
    design = load_design("vault")
    gridshell, limits = gridshell_of(design), limits_of(design.transport)
    planned = benchmark.pedantic(planned_of, args=(gridshell, design.crew, limits), rounds=1)
    assert len(planned.segmentation.segments) == 3


def test_the_locking_order_of_the_vault(benchmark: BenchmarkFixture) -> None:
    """Nine groups of planks, each state an eigenvalue problem; shells alike are worked out once."""
    orders = benchmark.pedantic(locking_orders, args=(gridshell_of(load_design("vault")),), rounds=1)
    assert len(orders) == 3
