"""Where the parts that are not laid go in: joint by joint, on the shortest path over the floor."""

from collections import defaultdict
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import networkx as nx
import numpy as np

from aag_cad.parts.kinds import is_fastener
from aag_cad.parts.model import JointKind
from aag_cad.units import Floats, Vector
from assembly.base.errors import PlanError
from assembly.graph.laying_units import Overlap, Unit, joint_name
from assembly.laying.order import graph_floor, walking_rows
from assembly.laying.walking import Point

# What stands under a shoe comes before what the shoe holds.
_KINDS: tuple[JointKind, ...] = ("AA", "AG", "boundary", "ridge", "footing", "foot", "blade", "cover")
_ORDER: dict[str, int] = {kind: i for i, kind in enumerate(_KINDS)}


@dataclass(frozen=True)
class Joining:
    """A joint at which parts are put in: they, the shell that it belongs to ("" if to several) and its kind."""

    joint: str
    shell: str
    kind: str
    marks: tuple[str, ...]


@dataclass(frozen=True)
class _Joint:
    members: dict[str, None]
    kind: str


def _joints(graph: "nx.MultiGraph[str]") -> dict[str, _Joint]:
    found: dict[str, _Joint] = {}
    for a, b, key, edge in sorted(graph.edges(keys=True, data=True), key=lambda edge: tuple(map(str, edge[:3]))):
        name = joint_name(a, b, key, edge)
        joint = found.setdefault(name, _Joint({}, str(edge.get("joint_kind") or edge.get("kind") or "")))
        joint.members.update(dict.fromkeys(sorted((a, b))))
    return found


def _point_along(unit: Unit, station: float) -> Floats:
    start, end = np.array(unit.start), np.array(unit.end)
    return np.asarray(start + (end - start) * (station / unit.length))


def joint_points(
    graph: "nx.MultiGraph[str]",
    joints: Mapping[str, Collection[str]],
    units: Mapping[str, Unit],
    overlaps: Collection[Overlap],
) -> dict[str, Vector]:
    """Return where joints (their members by mark) are: the mean position of their parts that are not laid.

    Without one, the point of the lower member at which the upper one crosses it, else the mean of the members' middles.
    """
    home = {part: unit for unit in units.values() for part in unit.parts}
    crossed = {at.joint: _point_along(units[at.lower], at.lower_mm) for at in overlaps}
    found = {}
    for joint, members in joints.items():
        places = [graph.nodes[mark].get("position") for mark in members if mark not in home]
        listed = [place for place in places if place is not None]
        if not listed and joint in crossed:
            listed = [crossed[joint]]
        if not listed:
            listed = [np.mean([home[mark].start, home[mark].end], axis=0) for mark in members if mark in home]
        x, y, z = np.mean(listed or [(0.0, 0.0, 0.0)], axis=0).tolist()
        found[joint] = (x, y, z)
    return found


def _walked(
    joints: Mapping[str, _Joint], shells: Mapping[str, str], points: Mapping[str, Vector], units: Mapping[str, Unit]
) -> list[str]:
    """Return joints shell by shell, those of several shells last, kind by kind, each kind along its shortest path."""
    groups: dict[tuple[bool, str, int, str], list[str]] = defaultdict(list)
    for name in sorted(joints):
        kind = joints[name].kind
        groups[not shells[name], shells[name], _ORDER.get(kind, len(_ORDER)), kind].append(name)
    axes: dict[str, Floats] = {}
    order: list[str] = []
    for (_, shell, _, _), names in sorted(groups.items()):
        if shell not in axes:
            axes[shell] = graph_floor([unit for unit in units.values() if not shell or unit.shell == shell])
        flat = np.array([points[name] for name in names]) @ axes[shell].T
        places: dict[str, Point] = {name: (float(x), float(y)) for name, (x, y) in zip(names, flat, strict=True)}
        order += [name for row in walking_rows(places) for name in row]
    return order


def _shell_of(graph: "nx.MultiGraph[str]", members: Collection[str]) -> str:
    shells = {graph.nodes[mark].get("shell", "") for mark in members}
    return str(shells.pop()) if len(shells) == 1 else ""


def joinings(
    graph: "nx.MultiGraph[str]",
    units: Mapping[str, Unit],
    placed: Mapping[str, str],
    left_out: Collection[str],
    overlaps: Collection[Overlap],
) -> tuple[tuple[Joining, ...], tuple[str, ...]]:
    """Return the joints at which parts are put in, in the order of walking, and the parts that cannot be put in.

    ``placed`` gives the unit of each part that is laid, blocks and bolts of beams too. Where a unit is left out, what
    ties it to others cannot be put in. PlanError with the marks of parts that no edge ties to anything.
    """
    # What only holds others together goes in last; all else is set at the first of its joints.
    loose = {mark: is_fastener(graph.nodes[mark]["kind"]) for mark in sorted(graph) if mark not in placed}
    if strays := [mark for mark in loose if not graph.degree(mark)]:
        raise PlanError(
            f"{', '.join(strays[:5])}: {len(strays)} parts that no edge ties to another, so that nobody knows when to "
            "add them; allowed 0: give each an edge to what it is fixed to"
        )
    gone = {part for unit in left_out for part in units[unit].parts} | {
        mark for mark, unit in placed.items() if unit in left_out
    }
    stuck = {mark for mark, fastens in loose.items() if not fastens and any(other in gone for other in graph[mark])}
    joints = {name: joint for name, joint in _joints(graph).items() if any(mark in loose for mark in joint.members)}
    shells = {name: _shell_of(graph, joint.members) for name, joint in joints.items()}
    points = joint_points(graph, {name: joint.members for name, joint in joints.items()}, units, overlaps)
    order = _walked(joints, shells, points, units)
    blocked = {name for name, joint in joints.items() if any(mark in gone or mark in stuck for mark in joint.members)}
    waiting = stuck | {mark for name in blocked for mark in joints[name].members if loose.get(mark)}
    home: dict[str, str] = {}
    for name in order:
        for mark in joints[name].members if name not in blocked else ():
            if mark in loose and mark not in waiting and (loose[mark] or mark not in home):
                home[mark] = name
    found = []
    for name in order:
        marks = sorted((loose[mark], mark) for mark in joints[name].members if home.get(mark) == name)
        if marks:
            found.append(Joining(name, shells[name], joints[name].kind, tuple(mark for _, mark in marks)))
    return tuple(found), tuple(mark for mark in loose if mark not in home)
