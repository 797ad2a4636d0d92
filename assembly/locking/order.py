"""The order in which a hoisted shell's flat planks are fixed: the softest mode is to stiffen fastest.

After hoisting, the beams turn on their studs like scissors and the geodesics lie loose between them. Each plank that is
screwed on takes freedom away (paper, section 3.1: the geodesics lock the kinetic erection). Method and assumptions:
docs/locking.md.
"""

from collections.abc import Callable, Sequence
from itertools import chain
from typing import TypeAlias

from aag_cad.parts.model import Gridshell, Shell, Timber
from aag_cad.parts.twins import made_for_each
from aag_cad.units import Floats
from assembly.base.errors import PlanError
from assembly.base.locking_order import Group, LockingOrder, LockingStep
from assembly.locking.model import (
    LockingModel,
    Sag,
    locking_model,
    modes_of,
    released_frame,
    sag_of,
    softest_of,
    state_modes,
    state_sag,
)

Value: TypeAlias = Callable[[frozenset[Group]], float]

SOFT = 0.5
SAG_LIMIT = 20.0
MODES = 6
MOST_PROPS = 4
_DIGITS = 6


def soft_mode_count(eigenvalues: Sequence[float], threshold: float) -> int:
    """Return how many eigenvalues are below a threshold."""
    return sum(value < threshold for value in eigenvalues)


def greedy_order(groups: Sequence[Group], value: Value, first: Sequence[Group] = ()) -> tuple[Group, ...]:
    """Return the groups in an order: those of ``first``, then each time the one that gives the greatest value.

    Values that agree to six digits count as equal: then the earlier group comes first.
    """
    order, left = list(first), [item for item in groups if item not in first]
    while left:
        done = frozenset(order)
        order.append(max(left, key=lambda item: float(f"{value(done | {item}):.{_DIGITS}g}")))
        left.remove(order[-1])
    return tuple(order)


def area_under(order: Sequence[Group], value: Value) -> float:
    """Return the sum of the values after each step of an order."""
    return sum(value(frozenset(order[: i + 1])) for i in range(len(order)))


def lowest_eigenvalue(model: LockingModel) -> Value:
    """Return the function that gives the lowest eigenvalue, 1/s2, by the groups of planks that are fixed.

    It remembers what it has worked out, and starts each search from the softest modes of the state before.
    """
    known: dict[frozenset[Group], float] = {}
    guess: list[Floats] = []

    def value(groups: frozenset[Group]) -> float:
        if groups not in known:
            fixed = tuple(chain.from_iterable(sorted(groups)))
            known[groups], modes = softest_of(model, fixed, guess[-1] if guess else None)
            guess[:] = [modes]
        return known[groups]

    return value


def edge_groups(model: LockingModel) -> tuple[Group, ...]:
    """Return the edge planks in groups: the lower ones, then the upper ones."""
    return tuple(edges for edges in (model.lower, model.upper) if edges)


def _step(marks: Group, values: Floats, threshold: float, sag: Sag) -> LockingStep:
    eigenvalues = tuple(values.tolist())
    soft = soft_mode_count(eigenvalues, threshold)
    props, propped = (sag.props, sag.propped) if soft else ((), sag.displacement)
    return LockingStep(marks, eigenvalues, soft, sag.displacement, sag.joint, props, propped)


def _all_soft_modes(model: LockingModel, fixed: Group, threshold: float) -> Floats:
    """Return the lowest eigenvalues: ``MODES``, or all soft ones if these are more."""
    count = MODES
    while True:
        values, _ = modes_of(model, fixed, count)
        if values[-1] >= threshold or len(values) < count:
            return values[: max(MODES, soft_mode_count(values.tolist(), threshold))]
        count *= 2


def locking_order(
    shell: Shell,
    timber: Timber,
    *,
    edges_first: bool = True,
    pairs: bool = True,
    hoists: Sequence[str] | None = None,
    soft: float = SOFT,
    limit: float = SAG_LIMIT,
) -> LockingOrder:
    """Return the order in which the flat planks of a hoisted shell are fixed, found greedily.

    ``edges_first``: edge planks at the lower, then at the upper edge before all geodesics, as in the paper, section
    3.2; without it they take their turn. ``pairs``: G-k together with G-(n + 1 - k). ``hoists`` are the studs on props,
    by default four. ``soft`` is the share of the lowest eigenvalue of the finished shell under which a mode is soft;
    ``limit`` (mm) the displacement under self-weight beyond which props are proposed. PlanError if the shell has no
    feet or geodesics, or if ``soft`` or ``limit`` is out of range; FrameError if the shell is a mechanism.
    """
    if not (0.0 < soft <= 1.0 and limit > 0.0):
        raise PlanError(
            f"{shell.mark}: soft = {soft:g}, limit = {limit:g} mm; soft is a share above 0 and at most 1, limit "
            "more than 0 mm: mend them"
        )
    model = locking_model(shell, timber, hoists=hoists, pairs=pairs)
    edges, groups = edge_groups(model), (*edge_groups(model), *model.geodesics)
    value = lowest_eigenvalue(model)
    order = greedy_order(groups, value, edges if edges_first else ())
    free_order = greedy_order(groups, value) if edges_first else order
    threshold = soft * value(frozenset(groups))
    steps = []
    for i in range(len(order) + 1):
        fixed = tuple(chain.from_iterable(order[:i]))
        values = _all_soft_modes(model, fixed, threshold)
        steps.append(_step(order[i - 1] if i else (), values, threshold, sag_of(model, fixed, limit, MOST_PROPS)))
    every = tuple(chain.from_iterable(order))
    released = released_frame(shell, timber, model)
    values, _ = state_modes(released, every, MODES)
    return LockingOrder(
        shell=shell.mark,
        feet=model.feet,
        hoists=model.hoists,
        edges_first=edges_first,
        threshold=threshold,
        limit=limit,
        steps=tuple(steps),
        released=_step((), values, threshold, state_sag(released, every, limit, MOST_PROPS)),
        area=area_under(order, value),
        free_area=area_under(free_order, value),
    )


def locking_orders(
    gridshell: Gridshell, *, edges_first: bool = True, pairs: bool = True, soft: float = SOFT, limit: float = SAG_LIMIT
) -> tuple[LockingOrder, ...]:
    """Return the locking order of every shell; twins are worked out once. See ``locking_order``."""

    def order_of(shell: Shell) -> LockingOrder:
        return locking_order(shell, gridshell.timber, edges_first=edges_first, pairs=pairs, soft=soft, limit=limit)

    return tuple(made_for_each(gridshell, order_of).values())
