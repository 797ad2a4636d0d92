"""Any graph of parts as it lies on the floor, seen from above: where its planks, units and joints are, in mm."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import networkx as nx
import numpy as np

from aag_cad.units import Floats
from assembly.base.shell_axes import floor_view
from assembly.base.steps import Step
from assembly.graph.interlacing import Interlacing, Slide
from assembly.graph.laying_units import Unit, is_laid, joint_name, upper_of
from assembly.laying.joining import joint_points


@dataclass(frozen=True, eq=False)
class Floor:
    """A graph of parts on the floor: places count from its corner to the right and up, over ``size`` (2,), mm.

    By mark: ``lines`` (2, 2) and ``widths`` of its planks (0 if unknown), the unit of each in ``planks``, the ``ends``
    (2, 2) of the units, the ``points`` (2,) of the joints, the ``joints`` of each part. ``crossings`` are the lower and
    the upper plank of each, those of the lowest layers first; ``slides`` go by unit.
    """

    size: Floats
    units: Mapping[str, Unit]
    planks: Mapping[str, str]
    lines: Mapping[str, Floats]
    widths: Mapping[str, float]
    ends: Mapping[str, Floats]
    points: Mapping[str, Floats]
    joints: Mapping[str, tuple[str, ...]]
    crossings: Sequence[tuple[str, str]]
    slides: Mapping[str, Slide]


def floor_of(graph: "nx.MultiGraph[str]", units: Mapping[str, Unit], woven: Interlacing) -> Floor:
    """Return a graph of parts as it lies on the floor, with its interlacing (nothing of it comes later)."""
    laid = {mark: node for mark, node in graph.nodes(data=True) if is_laid(node)}
    members, tied = defaultdict[str, dict[str, None]](dict), defaultdict[str, dict[str, None]](dict)
    over = []
    for a, b, key, edge in graph.edges(keys=True, data=True):
        for end in sorted((a, b)):
            members[joint_name(a, b, key, edge)][end] = tied[end][joint_name(a, b, key, edge)] = None
        if edge["kind"] == "crossing" and (upper := upper_of(graph, a, b, edge)):
            over.append((laid[upper].get("layer") or 0, upper, b if upper == a else a))
    at = joint_points(graph, members, units, woven.overlaps)
    lines = {mark: np.array([node["start"], node["end"]], dtype=np.float64) for mark, node in laid.items()}
    everything = np.concatenate([*lines.values(), np.array(list(at.values())).reshape(-1, 3)])
    view = floor_view(np.concatenate(list(lines.values())) if lines else everything)
    flat = view(everything)[:, :2]
    low = flat.min(axis=0)
    return Floor(
        size=np.ptp(flat, axis=0),
        units=units,
        planks={part: mark for mark, unit in units.items() for part in unit.parts},
        lines={mark: view(line)[:, :2] - low for mark, line in lines.items()},
        widths={mark: float(node.get("width_mm") or 0.0) for mark, node in laid.items()},
        ends={mark: view(np.array([unit.start, unit.end]))[:, :2] - low for mark, unit in units.items()},
        points={joint: view(np.array([place]))[0, :2] - low for joint, place in at.items()},
        joints={mark: tuple(tied[mark]) for mark in graph},
        crossings=[(lower, upper) for _, upper, lower in sorted(over)],
        slides={slide.unit: slide for slide in woven.slides},
    )


def units_of_step(floor: Floor, step: Step) -> tuple[str, ...]:
    """Return the units that a step lays or slides in, in their order."""
    return tuple(dict.fromkeys(floor.planks[mark] for mark in step.marks if mark in floor.planks))


def joints_of_step(floor: Floor, step: Step) -> tuple[str, ...]:
    """Return the joints at which a step puts parts in; none if it lays something."""
    if units_of_step(floor, step):
        return ()
    return tuple(dict.fromkeys(joint for mark in step.marks for joint in floor.joints[mark]))
