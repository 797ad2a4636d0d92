"""A hoisted shell as a frame whose flat planks are screwed on one after the other, made once for all orders.

The stiffness of a state is the sum of that of the beams and of each plank that is fixed, against the same unknowns: a
candidate costs a sparse factor and a few solutions. Masses do not change from state to state: loose planks lie on the
beams. So no eigenvalue ever falls when a plank is fixed (Courant's minimax principle).
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain

import numpy as np
from scipy.sparse import csc_array

from aag_cad.mechanics.frame.factor import SingularError, factor, lowest_pairs, softest_pair
from aag_cad.mechanics.frame.model import DOFS, Support
from aag_cad.mechanics.frame.shell import ShellFrame, shell_frame
from aag_cad.mechanics.frame.statics import held_part, mechanism_error
from aag_cad.mechanics.frame.system import FrameSystem, frame_system, mass_matrix, part_stiffness
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import parse_mark
from aag_cad.parts.model import Shell, Timber
from aag_cad.units import Floats, Ints
from assembly.base.errors import PlanError
from assembly.base.locking_order import Prop
from assembly.base.part_groups import shell_kit
from assembly.base.shell_axes import sweep_direction

GRAVITY = 9.81
_KG_PER_TONNE = 1000.0
_GRID = ""
_QUARTERS = (0.25, 0.75)
_GUESSED = 4


@dataclass(frozen=True, eq=False)
class GridFrame:
    """A shell's frame with some edge planks: the stiffness (f, f) of the beams (key "") and of every flat plank.

    All against the same f free unknowns; ``mass`` (f, f) in t, ``weight`` (f,) is the self-weight in N.
    """

    frame: ShellFrame
    system: FrameSystem
    parts: dict[str, csc_array]
    mass: csc_array
    weight: Floats

    @cached_property
    def pattern(self) -> csc_array:
        """Where any part has an entry (f, f): a sum over parts is then one of plain vectors."""
        pattern = csc_array(sum((_filled(part) for part in self.parts.values()), csc_array(self.mass.shape)))
        pattern.sort_indices()
        return pattern

    @cached_property
    def places(self) -> dict[str, Ints]:
        """Where the entries of each part stand among those of the pattern."""
        all_keys = _entry_keys(self.pattern)
        return {mark: np.searchsorted(all_keys, _entry_keys(part)) for mark, part in self.parts.items()}


def _filled(matrix: csc_array) -> csc_array:
    """Return a matrix with 1 at every entry, zero or not."""
    return csc_array((np.ones_like(matrix.data), matrix.indices, matrix.indptr), shape=matrix.shape)


def _entry_keys(matrix: csc_array) -> Ints:
    """Return a number for the column and row of every entry, in the order of the entries."""
    columns = np.repeat(np.arange(matrix.shape[1]), np.diff(matrix.indptr))
    return np.asarray(columns * matrix.shape[0] + matrix.indices, dtype=np.int64)


@dataclass(frozen=True, eq=False)
class LockingModel:
    """What a hoisted shell stands on and what is to be fixed.

    ``feet`` are the joints of beams on the lower edge planks, held in x, y and z; ``hoists`` the studs on props, held
    in z. ``lower`` and ``upper`` are edge planks, ``geodesics`` the groups of geodesics that are fixed together.
    ``grids`` has a frame for every set of edge planks that is fixed.
    """

    shell: str
    feet: tuple[str, ...]
    hoists: tuple[str, ...]
    lower: tuple[str, ...]
    upper: tuple[str, ...]
    geodesics: tuple[tuple[str, ...], ...]
    grids: dict[frozenset[str], GridFrame]


@dataclass(frozen=True)
class Sag:
    """The largest displacement under self-weight, mm, at which joint, and the props that keep it within a limit.

    ``propped`` is the largest displacement with these props, mm.
    """

    displacement: float
    joint: str
    props: tuple[Prop, ...]
    propped: float


def hoist_points(shell: Shell) -> tuple[str, ...]:
    """Return four studs: those nearest to the quarter points of the studs' extent across the shell and in height."""
    points = np.array([stud.frame.origin for stud in shell.studs])
    if len(points) < 4:
        raise PlanError(f"{shell.mark}: {len(points)} studs, at least 4 to hoist it by; name the studs to hoist by")
    places = np.column_stack([points @ sweep_direction(shell), points[:, 2]])
    low, high = places.min(axis=0), places.max(axis=0)
    chosen: list[int] = []
    for x in _QUARTERS:
        for y in _QUARTERS:
            gaps = np.linalg.norm(places - (low + np.array([x, y]) * (high - low)), axis=1)
            gaps[chosen] = np.inf
            chosen.append(int(np.argmin(np.round(gaps, 3))))
    return tuple(sorted(shell.studs[i].mark for i in chosen))


def geodesic_groups(shell: Shell, pairs: bool) -> tuple[tuple[str, ...], ...]:
    """Return the geodesics of a shell in groups: G-k with G-(n + 1 - k), or each alone."""
    marks = sorted(index_of(shell).geodesics, key=lambda mark: parse_mark(mark).index)
    if not pairs:
        return tuple((mark,) for mark in marks)
    half = (len(marks) + 1) // 2
    return tuple(tuple(dict.fromkeys((marks[i], marks[-1 - i]))) for i in range(half))


def _grid_frame(
    shell: Shell, timber: Timber, flat: Collection[str], supports: Sequence[tuple[str, bool]], tight: bool = False
) -> GridFrame:
    """Return the frame with the flat planks; ``supports`` are joints, held in all directions or only in z."""
    frame = shell_frame(shell, timber, fixed=flat, tight=tight)
    slaves = {link.slave for link in frame.model.links}
    held = [
        Support(node, DOFS[:3] if everywhere else DOFS[2:3])
        for joint, everywhere in supports
        for node in frame.beam_nodes.get(joint, ())
        if node not in slaves
    ]
    system = frame_system(replace(frame.model, supports=tuple(held)))
    beams = index_of(shell).beams.keys()
    places: dict[str, list[int]] = {_GRID: []}
    for i, member in enumerate(frame.members):
        places.setdefault(_GRID if member in beams else member, []).append(i)
    parts = {
        mark: held_part(system, part_stiffness(system, np.array(chosen))) for mark, chosen in places.items() if chosen
    }
    loads = np.zeros((len(frame.masses), 6))
    loads[:, 2] = -GRAVITY * frame.masses
    weight = np.asarray(system.transform.T @ loads.ravel())[system.free]
    return GridFrame(frame, system, parts, held_part(system, mass_matrix(system, frame.masses / _KG_PER_TONNE)), weight)


def locking_model(
    shell: Shell, timber: Timber, *, hoists: Sequence[str] | None = None, pairs: bool = True
) -> LockingModel:
    """Return a hoisted shell on its feet and on props under the studs ``hoists`` (None: ``hoist_points``).

    PlanError if it has no feet or geodesics, or if a hoist is no stud of it.
    """
    kit, groups = shell_kit(shell), geodesic_groups(shell, pairs)
    lower = kit.lower_edges
    upper = tuple(mark for mark in kit.edges if mark not in lower)
    studs = index_of(shell).studs.keys()
    feet = tuple(joint.mark for joint in shell.joints if joint.kind == "boundary" and set(joint.members) & set(lower))
    if not feet or not groups:
        what = "joint of a beam on a lower edge plank" if groups else "geodesic"
        raise PlanError(f"{shell.mark}: it has no {what}, at least one is needed for a locking order; add one")
    props = hoist_points(shell) if hoists is None else tuple(hoists)
    for mark in props:
        if mark not in studs:
            raise PlanError(f"{mark}: it is no stud of {shell.mark}; hoist by studs such as {min(studs)}")
    supports = [*((mark, True) for mark in feet), *((mark, False) for mark in props)]
    flat = tuple(chain.from_iterable(groups))
    choices = ((), lower, upper, (*lower, *upper))
    grids = {frozenset(edges): _grid_frame(shell, timber, (*edges, *flat), supports) for edges in choices}
    return LockingModel(shell.mark, feet, props, lower, upper, groups, grids)


def released_frame(shell: Shell, timber: Timber, model: LockingModel) -> GridFrame:
    """Return the frame with all flat planks, bolts tightened and props taken away: it stands on its feet alone."""
    flat = (*model.lower, *model.upper, *chain.from_iterable(model.geodesics))
    return _grid_frame(shell, timber, flat, [(mark, True) for mark in model.feet], tight=True)


def _state(grid: GridFrame, fixed: Collection[str]) -> tuple[csc_array, Ints]:
    """Return the stiffness (a, a) of beams and fixed planks and the places (a,) of the unknowns that it holds."""
    values = np.zeros(grid.pattern.nnz)
    for mark in (_GRID, *sorted(mark for mark in fixed if mark in grid.parts)):
        values[grid.places[mark]] += grid.parts[mark].data
    total = csc_array((values, grid.pattern.indices, grid.pattern.indptr), shape=grid.pattern.shape, copy=True)
    total.eliminate_zeros()
    active = np.flatnonzero(total.diagonal())
    return csc_array(total[active][:, active]), active


def _grid_of(model: LockingModel, fixed: Collection[str]) -> GridFrame:
    return model.grids[frozenset((*model.lower, *model.upper)) & frozenset(fixed)]


def state_modes(grid: GridFrame, fixed: Collection[str], count: int) -> tuple[Floats, Floats]:
    """Return the lowest eigenvalues (k,), 1/s2, and modes (f, k) of a grid with planks fixed.

    FrameError that names the node if something moves that has no mass.
    """
    stiffness, active = _state(grid, fixed)
    mass = csc_array(grid.mass[active][:, active])
    try:
        values, modes = lowest_pairs(stiffness, mass, min(count, len(active)))
    except SingularError as error:
        raise mechanism_error(grid.system, _spread(grid, active, error.mode)) from error
    return values, _of_all(grid, active, modes)


def _of_all(grid: GridFrame, active: Ints, modes: Floats) -> Floats:
    """Return modes (a, k) of the active unknowns as those of all free ones (f, k)."""
    whole = np.zeros((len(grid.weight), modes.shape[1]))
    whole[active] = modes
    return whole


def _spread(grid: GridFrame, active: Ints, values: Floats) -> Floats:
    """Return values (a,) or (a, k) as those of all unknowns of the system."""
    whole = np.zeros((grid.system.transform.shape[1], *values.shape[1:]))
    whole[grid.system.free[active]] = values
    return whole


def modes_of(model: LockingModel, fixed: Collection[str], count: int) -> tuple[Floats, Floats]:
    """Return ``state_modes`` of a model with these planks fixed."""
    return state_modes(_grid_of(model, fixed), fixed, count)


def softest_of(model: LockingModel, fixed: Collection[str], guess: Floats | None) -> tuple[float, Floats]:
    """Return the lowest eigenvalue, 1/s2, and the softest modes (f, k), from a guess of these if one fits.

    A guess fits the state of another set of planks, as long as the edge planks are the same.
    """
    grid = _grid_of(model, fixed)
    stiffness, active = _state(grid, fixed)
    if guess is None or len(guess) != len(grid.weight):
        values, modes = state_modes(grid, fixed, _GUESSED)
        return float(values[0]), modes
    try:
        value, modes = softest_pair(stiffness, csc_array(grid.mass[active][:, active]), guess[active])
    except SingularError as error:
        raise mechanism_error(grid.system, _spread(grid, active, error.mode)) from error
    return value, _of_all(grid, active, modes)


def sag_of(model: LockingModel, fixed: Collection[str], limit: float, most: int) -> Sag:
    """Return the sag with these planks fixed, and at most ``most`` props that bring it to ``limit`` (mm)."""
    return state_sag(_grid_of(model, fixed), fixed, limit, most)


def state_sag(grid: GridFrame, fixed: Collection[str], limit: float, most: int) -> Sag:
    """Return the sag of a grid with planks fixed; each prop goes under the joint that then sinks most.

    Linear, from the shape without stress. A prop holds its joint in z; the props are found from the factor of the frame
    without them (the force method), so that none costs a new factor. FrameError if the frame is a mechanism.
    """
    stiffness, active = _state(grid, fixed)
    try:
        solved = factor(stiffness)
        free = solved.solve(grid.weight[active])
    except SingularError as error:
        raise mechanism_error(grid.system, _spread(grid, active, error.mode)) from error
    nodes = [(joint, grid.system.index[name]) for joint, names in grid.frame.beam_nodes.items() for name in names]
    places = np.array([place for _, place in nodes])
    rows = grid.system.transform[:, grid.system.free[active]]

    def shifts(unknowns: Floats) -> Floats:
        return np.asarray((rows @ unknowns).reshape(-1, 6)[places, :3])

    first = moved = shifts(free)
    props: list[tuple[str, float]] = []
    lifts = np.zeros((len(active), 0))
    bent = lifts
    forces: Floats = np.asarray([], dtype=np.float64)
    while float(np.linalg.norm(moved, axis=1).max()) > limit and len(props) < most and moved[:, 2].min() < 0.0:
        lowest = int(np.argmin(moved[:, 2]))
        props.append((nodes[lowest][0], -float(moved[lowest, 2])))
        lift = rows[[6 * places[lowest] + 2]].toarray()[0]
        lifts, bent = np.column_stack([lifts, lift]), np.column_stack([bent, solved.solve(lift)])
        forces = np.asarray(np.linalg.solve(lifts.T @ bent, -(lifts.T @ free)), dtype=np.float64)
        moved = shifts(free + bent @ forces)
    most_moved = int(np.argmax(np.round(np.linalg.norm(first, axis=1), 6)))
    return Sag(
        displacement=float(np.linalg.norm(first[most_moved])),
        joint=nodes[most_moved][0],
        props=tuple(Prop(joint, sinking, float(force)) for (joint, sinking), force in zip(props, forces, strict=True)),
        propped=float(np.linalg.norm(moved, axis=1).max()),
    )
