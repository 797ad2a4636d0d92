"""The stiffness of a frame against its unknowns: rigid links and pins are eliminated, not made of stiff springs."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse import coo_array, csc_array, csr_array

from aag_cad.mechanics.frame.elements import ElementArrays, cross_matrices, element_arrays, global_stiffness
from aag_cad.mechanics.frame.model import DOFS, FrameError, FrameModel, RigidLink, Spring
from aag_cad.units import Floats, Ints, Vector


@dataclass(frozen=True, eq=False)
class FrameSystem:
    """A frame ready to be solved, with n nodes and u unknowns.

    The unknowns are the six displacements of every node that is no slave, and the relative rotation of every pin.
    ``transform`` (6 n, u) takes them to the displacements of all nodes, node by node; ``free`` (u,) says which are not
    held; ``pieces`` (m, 12, 12) are the stiffnesses of the elements against the displacements of their nodes.
    """

    model: FrameModel
    index: dict[str, int]
    points: Floats
    arrays: ElementArrays
    pieces: Floats
    transform: csr_array
    free: Ints


def _unit(direction: Vector, what: str) -> Floats:
    length = float(np.linalg.norm(direction))
    if not length > 0.0:
        raise FrameError(f"{what}: direction {direction} has no length; give one that has")
    return np.asarray(direction, dtype=np.float64) / length


def _node_index(model: FrameModel) -> dict[str, int]:
    index = {node.mark: i for i, node in enumerate(model.nodes)}
    if len(index) < len(model.nodes):
        marks = sorted(node.mark for node in model.nodes)
        twice = next(a for a, b in pairwise(marks) if a == b)
        raise FrameError(f"{twice}: two nodes have this mark; marks of nodes are unique")
    places = [(link.master, link.slave) for link in model.links]
    named = [mark for pair in places for mark in pair]
    named += [support.node for support in model.supports] + [spring.node for spring in model.springs]
    for mark in named:
        if mark not in index:
            raise FrameError(f"{mark}: a link, support or spring names this node, which is not in the model; add it")
    return index


def _in_order(model: FrameModel, index: dict[str, int]) -> list[tuple[str, RigidLink | None]]:
    """Return the nodes with the links that hold them, each after its master."""
    link_of: dict[str, RigidLink] = {}
    for link in model.links:
        if link.slave in link_of:
            raise FrameError(
                f"{link.slave}: it is the slave of {link_of[link.slave].master} and of {link.master}; a node has one "
                "master: make one of these a slave of the other"
            )
        link_of[link.slave] = link
    ordered: dict[str, RigidLink | None] = {}
    for mark in index:
        chain: list[str] = []
        while mark not in ordered and mark not in chain:
            chain.append(mark)
            if mark in link_of:
                mark = link_of[mark].master
        if mark in chain and mark in link_of:
            raise FrameError(f"{mark}: it is its own master through rigid links; open the circle")
        ordered.update((item, link_of.get(item)) for item in reversed(chain))
    return list(ordered.items())


def _transform(model: FrameModel, index: dict[str, int], points: Floats) -> tuple[csr_array, dict[str, int]]:
    """Return the transform (6 n, u) and the first unknown of every node that is no slave."""
    rows: dict[str, tuple[Floats, Ints]] = {}
    first: dict[str, int] = {}
    count = 0
    for mark, link in _in_order(model, index):
        if link is None:
            rows[mark] = np.eye(6), np.arange(count, count + 6)
            first[mark], count = count, count + 6
            continue
        carried, unknowns = rows[link.master]
        arm = np.eye(6)
        arm[:3, 3:] = cross_matrices((points[index[mark]] - points[index[link.master]])[None])[0]
        block = arm @ carried
        if link.pin is not None:
            turn = np.concatenate([np.zeros(3), _unit(link.pin, mark)])
            block, unknowns = np.column_stack([block, turn]), np.append(unknowns, count)
            count += 1
        rows[mark] = block, unknowns
    placed = [(6 * index[mark], block, unknowns) for mark, (block, unknowns) in rows.items()]
    lines = np.concatenate([np.repeat(at + np.arange(6), len(unknowns)) for at, _, unknowns in placed])
    columns = np.concatenate([np.tile(unknowns, 6) for _, _, unknowns in placed])
    values = np.concatenate([block.ravel() for _, block, _ in placed])
    return csr_array((values, (lines, columns)), shape=(6 * len(index), count)), first


def _free(model: FrameModel, first: dict[str, int], count: int) -> Ints:
    held = np.zeros(count, dtype=bool)
    for support in model.supports:
        if support.node not in first:
            raise FrameError(f"{support.node}: a slave of a rigid link cannot be held; hold its master")
        held[[first[support.node] + DOFS.index(dof) for dof in support.held]] = True
    return np.flatnonzero(~held)


def frame_system(model: FrameModel) -> FrameSystem:
    """Return a frame ready to be solved; FrameError that names the node or element that does not fit."""
    index = _node_index(model)
    points = np.array([node.point for node in model.nodes], dtype=np.float64).reshape(-1, 3)
    arrays = element_arrays(model.elements, index, points)
    transform, first = _transform(model, index, points)
    free = _free(model, first, transform.shape[1])
    return FrameSystem(model, index, points, arrays, global_stiffness(arrays), transform, free)


def _assembled(pieces: Floats, dofs: Ints, nodes: int) -> csr_array:
    """Return the sum (6 n, 6 n) of matrices (m, k, k) against the displacements ``dofs`` (m, k) of n nodes."""
    k = dofs.shape[1]
    rows, columns = np.repeat(dofs, k, axis=1).ravel(), np.tile(dofs, (1, k)).ravel()
    return csr_array(coo_array((pieces.ravel(), (rows, columns)), shape=(6 * nodes, 6 * nodes)))


def scattered(system: FrameSystem, chosen: Ints) -> csr_array:
    """Return the stiffness (6 n, 6 n) of the elements at places ``chosen`` (k,) against all displacements."""
    dofs = (6 * system.arrays.nodes[chosen][:, :, None] + np.arange(6)).reshape(-1, 12)
    return _assembled(system.pieces[chosen], dofs, len(system.points))


def _spring_stiffness(springs: tuple[Spring, ...], index: dict[str, int]) -> csr_array:
    along = np.array([_unit(spring.direction, spring.node) for spring in springs]).reshape(-1, 3)
    stiffness = np.array([spring.stiffness for spring in springs])
    first = np.array([6 * index[spring.node] + 3 * int(spring.turning) for spring in springs], dtype=np.int64)
    pieces = stiffness[:, None, None] * (along[:, :, None] * along[:, None, :])
    return _assembled(pieces, first[:, None] + np.arange(3), len(index))


def against_unknowns(system: FrameSystem, matrix: csr_array) -> csc_array:
    """Return a matrix (6 n, 6 n) of all displacements as one (u, u) of the unknowns."""
    return csc_array(system.transform.T @ matrix @ system.transform)


def part_stiffness(system: FrameSystem, chosen: Ints) -> csc_array:
    """Return the stiffness (u, u) that the elements at places ``chosen`` (k,) give to the unknowns."""
    return against_unknowns(system, scattered(system, chosen))


def full_stiffness(system: FrameSystem) -> csr_array:
    """Return the stiffness (6 n, 6 n) of all elements and springs against all displacements."""
    everything = np.arange(len(system.model.elements))
    return csr_array(scattered(system, everything) + _spring_stiffness(system.model.springs, system.index))


def mass_matrix(system: FrameSystem, masses: Floats) -> csc_array:
    """Return the mass matrix (u, u) of lumped masses (n,) at the nodes; what turns about a node has none."""
    lumped = np.repeat(masses, 6) * np.tile([1.0, 1.0, 1.0, 0.0, 0.0, 0.0], len(masses))
    size = len(lumped)
    return against_unknowns(system, csr_array((lumped, (np.arange(size), np.arange(size))), shape=(size, size)))
