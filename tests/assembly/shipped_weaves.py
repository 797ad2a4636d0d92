"""Two weaves to try the planning on, shipped as graphs: one that is laid with slides, one that nobody can lay."""

import math
from collections.abc import Iterable
from itertools import combinations

import networkx as nx
import numpy as np

from aag_cad.units import MM3_PER_M3, Floats, Vector, vector

_WIDTH, _THICKNESS = 100.0, 12.0
_FLAT = {"width_mm": _WIDTH, "depth_mm": _THICKNESS}
_DENSITY = 700.0
_MIN_RADIUS = 1700.0


def _plank(graph: "nx.MultiGraph[str]", mark: str, start: Vector, end: Vector, **more: object) -> None:
    length = math.dist(start, end)
    graph.add_node(
        mark,
        kind="plank",
        mass_kg=length * _WIDTH * _THICKNESS * _DENSITY / MM3_PER_M3,
        length_mm=length,
        start=start,
        end=end,
        min_radius_mm=_MIN_RADIUS,
        **more,
    )


def _meeting_point(one: Floats, other: Floats) -> tuple[float, float] | None:
    """Return how far along two lines (2, 2) on the floor they cross, mm, or None if they do not."""
    runs = one[1] - one[0], other[1] - other[0]
    matrix = np.column_stack([runs[0], -runs[1]])
    if abs(float(np.linalg.det(matrix))) < 1.0:
        return None
    shares = np.linalg.solve(matrix, other[0] - one[0])
    if np.any(shares < 0.0) or np.any(shares > 1.0):
        return None
    return float(shares[0] * np.linalg.norm(runs[0])), float(shares[1] * np.linalg.norm(runs[1]))


def _cross(graph: "nx.MultiGraph[str]", pairs: Iterable[tuple[str, str]]) -> None:
    """Add a crossing for each pair (lower, upper) whose lines cross on the floor."""
    for lower, upper in pairs:
        lines = [np.array([graph.nodes[mark]["start"], graph.nodes[mark]["end"]])[:, :2] for mark in (lower, upper)]
        met = _meeting_point(lines[0], lines[1])
        if met:
            joint = f"J-{graph.number_of_edges() + 1:03d}"
            graph.add_edge(
                lower, upper, key=joint, kind="crossing", joint=joint, above=upper, below_mm=met[0], above_mm=met[1]
            )


def kagome_graph(count: int = 6, mesh: float = 500.0, overhang: float = 80.0) -> "nx.MultiGraph[str]":
    """Return a woven kagome of three families of ``count`` flat planks 100 x 12: 1 over 2, 2 over 3, 3 over 1.

    ``mesh`` is the side of its triangles and hexagons: so far apart are the crossings along a plank. The planks are cut
    along a hexagon, ``overhang`` outside the outermost ones; mm. No plank can be the lowest: each crosses one family
    above and one below, by turns.
    """
    graph: nx.MultiGraph[str] = nx.MultiGraph(name=f"kagome of {3 * count} planks")
    step = math.sqrt(3.0) * mesh
    angles = np.pi / 2.0 + np.arange(3) * 2.0 * np.pi / 3.0
    normals = np.column_stack([np.cos(angles), np.sin(angles)])
    reach = (count - 1) / 2.0 * step + overhang
    for family, normal in enumerate(normals):
        along = np.array([normal[1], -normal[0]])
        others = np.delete(normals, family, axis=0)
        for i in range(count):
            foot = (i - (count - 1) / 2.0) * step * normal
            limits = np.concatenate([(side * reach - others @ foot) / (others @ along) for side in (-1.0, 1.0)])
            places = [foot + x * along for x in (max(limits[limits < 0.0]), min(limits[limits > 0.0]))]
            start, end = (vector(np.round([*place, 0.0], 3) + 0.0) for place in places)
            _plank(graph, f"P{family + 1}-{i + 1:02d}", start, end, family=f"P{family + 1}", **_FLAT)
    marks = [[mark for mark in graph if mark.startswith(f"P{k}")] for k in (1, 2, 3)]
    for upper, lower in ((0, 1), (1, 2), (2, 0)):
        _cross(graph, [(a, b) for b in marks[upper] for a in marks[lower]])
    return graph


def circle_graph() -> "nx.MultiGraph[str]":
    """Return four upright beams, each over the next in a circle, on three flat planks on three lower beams.

    The circle cannot be laid and, being upright, not be threaded; all below it can.
    """
    graph: nx.MultiGraph[str] = nx.MultiGraph(name="four upright planks in a circle")
    upright = {"upright": True, "width_mm": _THICKNESS, "depth_mm": _WIDTH}
    for i, at in enumerate((-900.0, 0.0, 900.0), start=1):
        _plank(graph, f"L-{i}", (-2000.0, at, 0.0), (2000.0, at, 0.0), family="L", layer=-1, **upright)
        _plank(graph, f"G-{i}", (at, -2000.0, 0.0), (at, 2000.0, 0.0), family="G", layer=0, **_FLAT)
    corners = [(-600.0, -600.0), (600.0, -600.0), (600.0, 600.0), (-600.0, 600.0)]
    for i, (x, y) in enumerate(corners):
        dx, dy = (1.0, 0.0) if i % 2 == 0 else (0.0, 1.0)
        sign = 1.0 if i < 2 else -1.0
        start = (x - 300.0 * sign * dx, y - 300.0 * sign * dy, 0.0)
        end = (x + 1500.0 * sign * dx, y + 1500.0 * sign * dy, 0.0)
        _plank(graph, f"B-{i + 1}", start, end, family="B", layer=1, **upright)
    of = {name: [mark for mark in graph if mark.startswith(name)] for name in "LGB"}
    _cross(graph, [(a, b) for low, high in combinations("LGB", 2) for a in of[low] for b in of[high]])
    _cross(graph, [(of["B"][(i + 1) % 4], of["B"][i]) for i in range(4)])
    return graph
