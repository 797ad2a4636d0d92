"""The gridshell as a graph: every part a node, every joint the edges between the parts that meet in it."""

from collections.abc import Iterator
from itertools import combinations
from typing import TypedDict

import networkx as nx
import numpy as np

from aag_cad.parts.assemblies import beam_of_parts
from aag_cad.parts.marks import parse_mark, shell_of
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import (
    ClampingBar,
    Frame,
    Gridshell,
    Joint,
    Mullion,
    Part,
    Plank,
    Strap,
    Strip,
    all_joints,
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


def part_point(part: Part) -> Floats:
    """Return a point (3,) in the middle of a part, in the coordinates that the part is given in.

    Of a bar and a plank it lies on the centre line, of a strip midway between its edges; else it is the frame's origin.
    """
    match part:
        case Plank() | Mullion() | ClampingBar() | Strap():
            return np.asarray(part.curve.point_spline(part.curve.length / 2.0), dtype=np.float64)
        case Strip():
            ends = [edge.point_spline(edge.length / 2.0) for edge in (part.left, part.right)]
            return np.asarray(np.mean(ends, axis=0), dtype=np.float64)
        case _:
            frame = part_frame(part)
            assert frame is not None
            return np.array(frame.origin)


def joint_of(mark: str) -> str:
    """Return the mark of the joint that a bolt, screw or threaded rod belongs to."""
    return mark.rpartition("-")[0]


def joint_edges(joint: Joint) -> Iterator[tuple[str, str]]:
    """Yield the pairs of parts that a joint ties together.

    A stud, coupling block, strap, shoe, concrete block or blade is the hub that the others are tied to: the member that
    bears the joint's mark, or else its coupling block. Without one, all members are tied pairwise and the fasteners to
    the first of them.
    """
    hubs = [mark for mark in joint.members if mark == joint.mark]
    hubs = hubs or [mark for mark in joint.members if parse_mark(mark).family == "K"]
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
    for joint in all_joints(gridshell):
        for a, b in joint_edges(joint):
            graph.add_edge(a, b, key=joint.mark, kind=joint.kind)
    return graph
