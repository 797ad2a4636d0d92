"""What is laid as one piece on the floor, the coupled beam or the single plank, and which of them lies on which."""

from collections import defaultdict
from dataclasses import dataclass
from typing import Any

import networkx as nx
import numpy as np

from aag_cad.units import Floats, Vector

# Lines whose directions differ by less are taken for parallel.
PARALLEL = 1e-9

# Edge planks are pushed in when the shell has its shape; until then they do not lie on the floor.


@dataclass(frozen=True)
class Unit:
    """A coupled beam or a single plank; lengths and points in mm, as in ``assembly.graph.gridshell_graph.PartNode``.

    ``slides`` says whether it may be slid in at all. ``layer``, ``depth`` and ``min_radius`` are None if unknown.
    """

    mark: str
    parts: tuple[str, ...]
    family: str
    shell: str
    layer: int | None
    upright: bool
    slides: bool
    length: float
    depth: float | None
    min_radius: float | None
    start: Vector
    end: Vector


@dataclass(frozen=True)
class Overlap:
    """A joint at which a unit lies on another; ``lower_mm`` and ``upper_mm`` are its stations along them."""

    joint: str
    lower: str
    upper: str
    lower_mm: float
    upper_mm: float


@dataclass(frozen=True)
class Meeting:
    """A joint at which two units meet end to end; the stations of the joint along them, mm."""

    joint: str
    units: tuple[str, str]
    stations: tuple[float, float]


def is_laid(node: dict[str, Any]) -> bool:
    """Return whether a node of the graph is laid on the floor: a plank, or anything else with two ends."""
    return node.get("kind") == "plank" or "start" in node or "end" in node


def unit_marks(graph: "nx.MultiGraph[str]") -> dict[str, str]:
    """Return for each node that is laid the mark of its unit: its coupled beam, or itself."""
    return {mark: node.get("beam") or mark for mark, node in graph.nodes(data=True) if is_laid(node)}


def _line(node: dict[str, Any]) -> Floats:
    return np.array([node["start"], node["end"]], dtype=np.float64)


def _opposed(first: dict[str, Any], other: dict[str, Any]) -> bool:
    """Return whether a plank runs against the first one of its beam."""
    a, b = _line(first), _line(other)
    return float((a[1] - a[0]) @ (b[1] - b[0])) < 0.0


def _unit(mark: str, parts: list[str], nodes: list[dict[str, Any]]) -> Unit:
    lines = [_line(node)[::-1] if _opposed(nodes[0], node) else _line(node) for node in nodes]
    middle = np.mean(lines, axis=0).tolist()
    depths = [node["depth_mm"] for node in nodes if node.get("depth_mm") is not None]
    radii = [node["min_radius_mm"] for node in nodes if node.get("min_radius_mm") is not None]
    layers = [node["layer"] for node in nodes if node.get("layer") is not None]
    return Unit(
        mark=mark,
        parts=tuple(parts),
        family=str(nodes[0].get("family", "")),
        shell=str(nodes[0].get("shell", "")),
        layer=layers[0] if layers else None,
        upright=any(node.get("upright", False) for node in nodes),
        slides=all(node.get("slides", not node.get("upright", False)) for node in nodes),
        length=max(float(node["length_mm"]) for node in nodes),
        depth=max(depths) if len(depths) == len(nodes) else None,
        min_radius=max(radii) if len(radii) == len(nodes) else None,
        start=tuple(middle[0]),
        end=tuple(middle[1]),
    )


def units_of(graph: "nx.MultiGraph[str]") -> dict[str, Unit]:
    """Return the units of a graph by their marks, sorted."""
    parts: dict[str, list[str]] = defaultdict(list)
    for part, unit in sorted(unit_marks(graph).items()):
        parts[unit].append(part)
    return {mark: _unit(mark, listed, [graph.nodes[p] for p in listed]) for mark, listed in sorted(parts.items())}


def joint_name(a: str, b: str, key: object, edge: dict[str, Any]) -> str:
    """Return the mark of an edge's joint; without one its key, or the two marks and a number from the second one on."""
    if edge.get("joint"):
        return str(edge["joint"])
    if isinstance(key, str):
        return key
    return "/".join(sorted((a, b))) + (f"/{key}" if key else "")


def upper_of(graph: "nx.MultiGraph[str]", a: str, b: str, edge: dict[str, Any]) -> str | None:
    """Return which end of a crossing edge lies on the other, "" where they meet, None if the graph does not say.

    ``above`` of the edge decides, without it the layers of the two.
    """
    if edge.get("above") is not None:
        return str(edge["above"])
    layers = graph.nodes[a].get("layer"), graph.nodes[b].get("layer")
    if layers[0] is None or layers[1] is None or layers[0] == layers[1]:
        return None
    return a if layers[0] > layers[1] else b


def _met(first: dict[str, Any], second: dict[str, Any]) -> tuple[float, float]:
    """Return the stations at which two straight lines come nearest; the middles of parallel ones."""
    lines = np.array([_line(first), _line(second)])
    run = lines[:, 1] - lines[:, 0]
    lengths = float(first["length_mm"]), float(second["length_mm"])
    cosine, squares = float(run[0] @ run[1]), np.sum(run**2, axis=1)
    determinant = float(squares[0] * squares[1] - cosine**2)
    if determinant <= PARALLEL * float(squares[0] * squares[1]):
        return lengths[0] / 2.0, lengths[1] / 2.0
    gap = lines[1, 0] - lines[0, 0]
    along = run @ gap
    shares = np.array([squares[1] * along[0] - cosine * along[1], cosine * along[0] - squares[0] * along[1]])
    return tuple(np.clip(shares / determinant, 0.0, 1.0) * lengths)


def _stations(graph: "nx.MultiGraph[str]", lower: str, upper: str, edge: dict[str, Any]) -> tuple[float, float]:
    if edge.get("below_mm") is None or edge.get("above_mm") is None:
        return _met(graph.nodes[lower], graph.nodes[upper])
    return float(edge["below_mm"]), float(edge["above_mm"])


def overlaps_of(graph: "nx.MultiGraph[str]") -> tuple[tuple[Overlap, ...], tuple[Meeting, ...]]:
    """Return where units of a graph lie on one another and where they meet, sorted by joint and marks.

    The crossings of the planks of two beams at one joint are one; its stations are their means.
    """
    home = unit_marks(graph)
    first: dict[str, str] = {}
    for part in sorted(home):
        first.setdefault(home[part], part)
    turned = {part for part, unit in home.items() if _opposed(graph.nodes[first[unit]], graph.nodes[part])}
    found: dict[tuple[bool, str, str, str], list[tuple[float, float]]] = defaultdict(list)
    for a, b, key, edge in graph.edges(keys=True, data=True):
        if edge.get("kind") != "crossing" or home[a] == home[b]:
            continue
        upper = upper_of(graph, a, b, edge)
        low, high = (b, a) if upper == a or (not upper and b < a) else (a, b)
        stations = _stations(graph, low, high, edge)
        at = [
            float(graph.nodes[part]["length_mm"]) - s if part in turned else s
            for part, s in zip((low, high), stations, strict=True)
        ]
        pair = (home[low], home[high])
        if not upper and pair[1] < pair[0]:
            pair, at = pair[::-1], at[::-1]
        found[bool(upper), joint_name(a, b, key, edge), *pair].append((at[0], at[1]))
    overlaps, meetings = [], []
    for (lies, joint, one, other), listed in sorted(found.items()):
        x, y = np.mean(listed, axis=0).tolist()
        if lies:
            overlaps.append(Overlap(joint, one, other, x, y))
        else:
            meetings.append(Meeting(joint, (one, other), (x, y)))
    return tuple(overlaps), tuple(meetings)
