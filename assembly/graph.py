"""The gridshell as a graph: every part a node, every joint the edges between the parts that meet in it."""

from collections.abc import Iterator
from itertools import combinations
from typing import TypedDict

import networkx as nx
import numpy as np

from aag_cad.geometry.framed import FramedCurve
from aag_cad.parts.assemblies import beam_of_parts
from aag_cad.parts.marks import parse_mark, shell_of
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import (
    Frame,
    Gridshell,
    Joint,
    Mullion,
    Part,
    Plank,
    Strip,
    all_parts,
    shell_parts,
)
from aag_cad.parts.products import part_frame
from aag_cad.parts.quantities import kind, mass, sizes
from aag_cad.units import Floats, Vector, vector


class PartNode(TypedDict):
    """What a node of the graph carries; ``position`` is in vault coordinates, mm; ``layer`` is None between layers.

    ``kind`` is the word of the part lists (``aag_cad.parts.quantities.kind``).
    """

    kind: str
    family: str
    shell: str
    beam: str
    layer: int | None
    mass_kg: float
    length_mm: float
    position: Vector


def _curve(part: Part) -> FramedCurve | None:
    match part:
        case Plank() | Mullion():
            return part.curve
        case Strip():
            return part.left
        case _:
            return None


def part_point(part: Part) -> Floats:
    """Return a point (3,) in the middle of a part, in the coordinates that the part is given in."""
    curve, frame = _curve(part), part_frame(part)
    if curve is not None:
        return np.asarray(curve.point_spline(curve.length / 2.0), dtype=np.float64)
    assert frame is not None
    return np.array(frame.origin)


def joint_of(mark: str) -> str:
    """Return the mark of the joint that a bolt or screw belongs to."""
    return mark.rpartition("-")[0]


def joint_edges(joint: Joint) -> Iterator[tuple[str, str]]:
    """Yield the pairs of parts that a joint ties together.

    A stud or block is the hub that the planks and fasteners are tied to; without one, all members are tied pairwise
    and the fasteners to the first of them.
    """
    hubs = [mark for mark in joint.members if mark == joint.mark]
    if not hubs:
        yield from combinations(joint.members, 2)
        hubs = list(joint.members[:1])
    else:
        yield from ((hubs[0], mark) for mark in joint.members if mark != hubs[0])
    yield from ((hubs[0], fastener) for fastener in joint.fasteners)


def _placed_point(part: Part, placement: Frame | None) -> Vector:
    point = part_point(part)
    if placement is None:
        return vector(point)
    matrix = frame_matrix(placement)
    return vector(matrix[:3, :3] @ point + matrix[:3, 3])


def assembly_graph(gridshell: Gridshell) -> "nx.MultiGraph[str]":
    """Return the graph of all parts (nodes by mark, see ``PartNode``) and joints (edges keyed by joint mark).

    An edge carries the ``kind`` of its joint. Masses in kg, lengths and positions in mm, any number of shells.
    """
    graph: nx.MultiGraph[str] = nx.MultiGraph(name=gridshell.name)
    placements: dict[str, Frame | None] = {}
    beams: dict[str, str] = {}
    layers: dict[str, int] = {}
    for shell in gridshell.shells:
        placements |= {part.mark: shell.placement for part in shell_parts(shell)}
        home, of_beam = beam_of_parts(shell), {beam.mark: beam.layer for beam in shell.beams}
        beams |= home
        layers |= {plank.mark: plank.layer for plank in shell.planks}
        layers |= {block.mark: of_beam[home[block.mark]] for block in shell.blocks if block.mark in home}
    for part in all_parts(gridshell):
        graph.add_node(
            part.mark,
            **PartNode(
                kind=kind(part),
                family=parse_mark(part.mark).family,
                shell=shell_of(part.mark),
                beam=beams.get(part.mark, ""),
                layer=layers.get(part.mark),
                mass_kg=mass(part, gridshell.timber),
                length_mm=sizes(part)[0],
                position=_placed_point(part, placements.get(part.mark)),
            ),
        )
    for joint in (*(joint for shell in gridshell.shells for joint in shell.joints), *gridshell.joints):
        for a, b in joint_edges(joint):
            graph.add_edge(a, b, key=joint.mark, kind=joint.kind)
    return graph
