"""Linear statics of frames of 2-node beams with six degrees of freedom a node; mm, N, N/mm2.

Euler-Bernoulli bending and St Venant torsion, small displacements; hinges, rigid arms, pins and springs: see
``aag_cad.mechanics.frame.model``. Checked against closed forms and PyNiteFEA in tests/mechanics/test_frame.py.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from aag_cad.mechanics.frame.elements import even_load_forces
from aag_cad.mechanics.frame.factor import SingularError, factor
from aag_cad.mechanics.frame.model import FrameError, FrameModel, LineLoad, NodalLoad
from aag_cad.mechanics.frame.system import (
    FrameSystem,
    against_unknowns,
    frame_system,
    full_stiffness,
)
from aag_cad.units import Floats


@dataclass(frozen=True, eq=False)
class FrameResult:
    """Displacements and reactions (n, 6) of the nodes in global axes, and the forces on the ends of elements (m, 12).

    The order of the nodes and elements is that of the model; end forces are those that the nodes exert on the ends, in
    local axes: x y z rx ry rz of the start, then of the end. Reactions are those of the supports, not of springs.
    """

    displacements: Floats
    reactions: Floats
    end_forces: Floats


def mechanism_error(system: FrameSystem, unknowns: Floats) -> FrameError:
    """Return the error that names the node and the direction in which a mode (u,) of all unknowns moves most."""
    moved = (system.transform @ unknowns).reshape(-1, 6)
    reach = float(np.linalg.norm(np.ptp(system.points, axis=0))) or 1.0
    shifts, turns = np.linalg.norm(moved[:, :3], axis=1), np.linalg.norm(moved[:, 3:], axis=1)
    turning = not shifts.max() > 1e-3 * turns.max() * min(reach, float(np.min(system.arrays.lengths, initial=reach)))
    place = int(np.argmax(turns if turning else shifts))
    along = moved[place, 3:] / turns[place] if turning else moved[place, :3] / shifts[place]
    along = along * np.sign(along[np.argmax(np.abs(along))])
    way = "turn about" if turning else "move along"
    x, y, z = (f"{value:.3g}" if abs(value) > 1e-3 else "0" for value in along)
    return FrameError(
        f"{system.model.nodes[place].mark}: the frame is a mechanism; this node is free to {way} ({x}, {y}, {z}); "
        "hold it, brace it or take out a hinge"
    )


def _spread(system: FrameSystem, reduced: Floats) -> Floats:
    """Return values (f,) or (f, k) of the free unknowns as those of all unknowns, 0 where held."""
    spread = np.zeros((system.transform.shape[1], *reduced.shape[1:]))
    spread[system.free] = reduced
    return spread


def held_part(system: FrameSystem, matrix: csc_array) -> csc_array:
    """Return the rows and columns of the free unknowns of a matrix (u, u)."""
    return csc_array(matrix[system.free][:, system.free])


def load_vectors(
    system: FrameSystem, nodal: tuple[NodalLoad, ...], line: tuple[LineLoad, ...]
) -> tuple[Floats, Floats]:
    """Return loads on all displacements (6 n,) and what the line loads give to clamped ends (m, 12) in local axes."""
    loads = np.zeros((len(system.points), 6))
    for load in nodal:
        if load.node not in system.index:
            raise FrameError(f"{load.node}: a load names this node, which is not in the model; add it")
        loads[system.index[load.node]] += (*load.force, *load.moment)
    arrays = system.arrays
    ends = np.zeros((len(arrays.lengths), 12))
    places = {element.mark: i for i, element in enumerate(system.model.elements)}
    for item in line:
        if item.element not in places:
            raise FrameError(f"{item.element}: a load names this element, which is not in the model; add it")
        i = places[item.element]
        clamped = even_load_forces(arrays.axes[i], arrays.lengths[i], np.array(item.force))
        ends[i] += arrays.condensed[i] @ clamped
    at_nodes = (ends[:, None, :] @ arrays.to_ends)[:, 0, :].reshape(-1, 2, 6)
    np.add.at(loads, arrays.nodes, at_nodes)
    return loads.ravel(), ends


def static_solution(
    model: FrameModel, nodal: tuple[NodalLoad, ...] = (), line: tuple[LineLoad, ...] = ()
) -> FrameResult:
    """Return displacements, reactions and end forces of a frame under loads.

    FrameError names the node of a mechanism and the direction in which it is free, or what in the model does not fit.
    """
    system = frame_system(model)
    full = full_stiffness(system)
    loads, clamped = load_vectors(system, nodal, line)
    try:
        solved = factor(held_part(system, against_unknowns(system, full))).solve(
            (system.transform.T @ loads)[system.free]
        )
    except SingularError as error:
        raise mechanism_error(system, _spread(system, error.mode)) from error
    moved = system.transform @ _spread(system, solved)
    reactions = _reactions(system, full @ moved - loads)
    nodes = moved.reshape(-1, 6)
    ends = system.arrays.to_ends @ nodes[system.arrays.nodes].reshape(-1, 12, 1)
    forces = (system.arrays.stiffness @ ends)[:, :, 0] - clamped
    return FrameResult(nodes, reactions, forces)


def _reactions(system: FrameSystem, missing: Floats) -> Floats:
    """Return the forces (n, 6) at the supports from what is missing to balance (6 n,), those of slaves at masters."""
    at_unknowns = system.transform.T @ missing
    at_unknowns[system.free] = 0.0
    free_nodes = {link.slave for link in system.model.links}
    reactions = np.zeros((len(system.points), 6))
    for support in system.model.supports:
        if support.node not in free_nodes:
            place = system.index[support.node]
            first = system.transform.indices[system.transform.indptr[6 * place]]
            reactions[place] = at_unknowns[first : first + 6]
    return reactions
