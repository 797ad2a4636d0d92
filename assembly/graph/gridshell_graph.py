"""The gridshell as a graph: every part a node, every joint the edges between the parts that meet in it."""

from collections.abc import Iterator
from itertools import combinations, product
from typing import NotRequired, TypedDict

import networkx as nx
import numpy as np

from aag_cad.parts.forms import UNMOVED, Frame
from aag_cad.parts.index import Index, index_of
from aag_cad.parts.kinds import kind_of, shaped
from aag_cad.parts.marks import parse_mark, shell_of
from aag_cad.parts.mesh import frame_matrix, moved
from aag_cad.parts.model import Gridshell, Joint, Part, Shell, all_parts, ridge_parts, shell_parts
from aag_cad.parts.products import part_frame
from aag_cad.parts.quantities import mass, sizes
from aag_cad.units import Floats, Vector, vector
from assembly.graph.faults import EdgeKind
from assembly.graph.layers import stacked_planks

_BY_JOINT: dict[str, EdgeKind] = {
    "AA": "bolted", "AG": "screwed", "boundary": "screwed", "foot": "bolted", "footing": "seated", "ridge": "bolted",
    "blade": "bladed", "cover": "screwed",
}  # fmt: skip


class PartNode(TypedDict):
    """What a node of the graph carries; ``position`` is in vault coordinates, mm; ``layer`` is None between layers.

    ``kind`` is the word of the part lists (``aag_cad.parts.kinds.Kind.name``), ``beam`` the mark of the coupled beam
    that the part is put together with, or "". What is laid on the floor, a plank, has in addition: ``start`` and
    ``end`` of its centre line (vault coordinates, mm); whether it stands ``upright`` on the surface; its section, from
    which the booklet calls and draws it: ``width_mm`` across it in the surface, as it is seen from above, and
    ``depth_mm`` along the surface normal, the thickness of a flat plank; ``min_radius_mm``, to which it can be bent
    flat-ways; and, only in graphs from elsewhere, ``slides``: whether it may be slid in, which else all do that do not
    stand upright.
    """

    kind: str
    family: str
    shell: str
    beam: str
    layer: int | None
    mass_kg: float
    length_mm: float
    position: Vector
    start: NotRequired[Vector]
    end: NotRequired[Vector]
    upright: NotRequired[bool]
    width_mm: NotRequired[float]
    depth_mm: NotRequired[float]
    min_radius_mm: NotRequired[float]
    slides: NotRequired[bool]


class JointEdge(TypedDict):
    """What an edge carries: how its two parts are joined, and the mark and kind of the joint.

    ``crossing``: one plank lies over another, ``above`` is the mark of the upper one ("" where they meet end to end),
    ``below_mm`` and ``above_mm`` the stations of the joint along the lower and the upper one (end to end: along the
    first and the second mark). ``coupled``: plank of a beam and block in its gap. ``bolted``, ``screwed``: by or to
    the hub of the joint. ``seated``: shoe and rod on their concrete block. ``bladed``: ridge plank and blade.
    """

    kind: EdgeKind
    joint: str
    joint_kind: str
    above: NotRequired[str]
    below_mm: NotRequired[float]
    above_mm: NotRequired[float]


def part_point(part: Part) -> Floats:
    """Return a point (3,) in the middle of a part, in the coordinates that the part is given in.

    Of a bar and a plank it lies on the centre line, of a strip midway between its edges; else it is the frame's origin.
    """
    shape, form = shaped(part)
    if lines := shape.lines(form):
        return np.asarray(np.mean([line.point_spline(line.length / 2.0) for line in lines], axis=0), dtype=np.float64)
    frame = part_frame(part)
    assert frame is not None
    return np.array(frame.origin)


def _hub(joint: Joint) -> str:
    """Return the member that the others are tied to: the one with the joint's mark, else its coupling block, or ""."""
    if joint.mark in joint.members:
        return joint.mark
    return next((mark for mark in joint.members if parse_mark(mark).family == "K"), "")


def _held(fastener: Part) -> EdgeKind:
    """Return how a fastener holds: what stands on the ground is seated, what has a nut bolted, all else screwed."""
    row = kind_of(fastener)
    nuts = any(piece.name == "nut" for piece in row.form(fastener).pieces)
    return "seated" if row.place == "ground" else "bolted" if nuts else "screwed"


def _ties(joint: Joint, index: Index) -> Iterator[tuple[str, str, EdgeKind]]:
    """Yield the pairs of parts that a joint ties together, and how.

    A stud, coupling block, strap, shoe, concrete block or blade is the hub that the others are tied to. Without one all
    members are tied pairwise, but for planks, whose crossings are edges of their own, and the fasteners to the first.
    """
    usual, hub, planks = _BY_JOINT[joint.kind], _hub(joint), index.planks
    for mark in joint.members:
        if hub and mark != hub:
            on_block = joint.kind in ("AG", "boundary") and mark in planks and planks[mark].beam
            yield hub, mark, "coupled" if on_block else usual
    if not hub:
        for a, b in combinations(joint.members, 2):
            if a not in planks or b not in planks:
                yield a, b, usual
    for fastener in joint.fasteners:
        yield hub or joint.members[0], fastener, _held(index.parts[fastener])


def _crossings(shell: Shell) -> Iterator[tuple[str, str, JointEdge]]:
    """Yield the planks that lie on one another, each pair of neighbours in height once, and those that meet."""
    stations = index_of(shell).stations
    for joint, lower, upper, lies in stacked_planks(shell):
        for pair in product(lower, upper):
            low, high = pair if lies else sorted(pair)
            yield (
                low,
                high,
                JointEdge(
                    kind="crossing",
                    joint=joint.mark,
                    joint_kind=joint.kind,
                    above=high if lies else "",
                    below_mm=stations[low, joint.mark],
                    above_mm=stations[high, joint.mark],
                ),
            )


def _placed(points: Floats, placement: Frame) -> list[Vector]:
    return [vector(point) for point in moved(points, frame_matrix(placement))]


def _add_planks(graph: "nx.MultiGraph[str]", shell: Shell, min_radius: float) -> None:
    """Give the planks of a shell what the laying needs to know of them, and add their crossings."""
    starts = _placed(np.array([plank.curve.points[0] for plank in shell.planks]).reshape(-1, 3), shell.placement)
    ends = _placed(np.array([plank.curve.points[-1] for plank in shell.planks]).reshape(-1, 3), shell.placement)
    for plank, start, end in zip(shell.planks, starts, ends, strict=True):
        section = plank.blank.section
        depth, width = (section.width, section.thickness)[:: 1 if plank.upright else -1]
        graph.add_node(
            plank.mark,
            start=start,
            end=end,
            upright=plank.upright,
            width_mm=width,
            depth_mm=depth,
            min_radius_mm=min_radius,
        )
    for a, b, edge in _crossings(shell):
        graph.add_edge(a, b, key=edge["joint"], **edge)


def _add_ties(graph: "nx.MultiGraph[str]", joints: tuple[Joint, ...], index: Index) -> None:
    for joint in joints:
        for a, b, how in _ties(joint, index):
            graph.add_edge(a, b, key=joint.mark, **JointEdge(kind=how, joint=joint.mark, joint_kind=joint.kind))


def _add_parts(graph: "nx.MultiGraph[str]", gridshell: Gridshell, parts: tuple[Part, ...], shell: Shell | None) -> None:
    index = index_of(gridshell)
    layers = {mark: index.beams[beam].layer for mark, beam in index.beam_of.items() if mark in index.blocks}
    layers |= {mark: plank.layer for mark, plank in index.planks.items()}
    points = np.array([part_point(part) for part in parts]).reshape(-1, 3)
    for part, position in zip(parts, _placed(points, shell.placement if shell else UNMOVED), strict=True):
        graph.add_node(
            part.mark,
            **PartNode(
                kind=kind_of(part).name,
                family=parse_mark(part.mark).family,
                shell=shell_of(part.mark),
                beam=index.beam_of.get(part.mark, ""),
                layer=layers.get(part.mark),
                mass_kg=mass(part, gridshell.timber),
                length_mm=sizes(part)[0],
                position=position,
            ),
        )


def assembly_graph(gridshell: Gridshell) -> "nx.MultiGraph[str]":
    """Return the graph of all parts (nodes by mark, ``PartNode``) and joints (edges by joint mark, ``JointEdge``).

    Masses in kg, lengths, stations and positions in mm, any number of shells.
    """
    graph: nx.MultiGraph[str] = nx.MultiGraph(name=gridshell.name)
    for shell in gridshell.shells:
        _add_parts(graph, gridshell, shell_parts(shell), shell)
    _add_parts(graph, gridshell, ridge_parts(gridshell), None)
    for shell in gridshell.shells:
        _add_planks(graph, shell, gridshell.timber.min_bending_radius)
        _add_ties(graph, shell.joints, index_of(shell))
    _add_ties(graph, gridshell.joints, index_of(gridshell))
    assert len(graph) == len(all_parts(gridshell))
    return graph
