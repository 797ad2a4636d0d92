"""Everything that is planned for a gridshell: assembly with its schedule, locking order, segments, taking down."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from aag_cad.design_making import Crew, Transport
from aag_cad.findings import Finding
from aag_cad.parts.index import index_of
from aag_cad.parts.model import Gridshell
from aag_cad.parts.twins import made_for_each
from assembly.base.locking_order import LockingOrder
from assembly.base.segments import Limits, Segmentation
from assembly.base.steps import Plan
from assembly.laying.flattening import FlatState, flat_findings, flat_state
from assembly.laying.order import FlatOrder, flat_orders
from assembly.locking.order import locking_orders
from assembly.plan.assembly_plan import plan_of
from assembly.plan.disassembly import disassembly_of
from assembly.plan.durations import step_minutes
from assembly.plan.schedule import Schedule, schedule_of
from assembly.transport.segments import segments


@dataclass(frozen=True)
class Planned:
    """What is planned for a gridshell: how it goes up, how its shells are locked and cut, how it comes down, when.

    ``orders`` say in which order each shell is laid flat, ``flat`` where each shell with studs then lies, by mark.
    """

    plan: Plan
    schedule: Schedule
    orders: Mapping[str, FlatOrder]
    flat: Mapping[str, FlatState]
    locking: tuple[LockingOrder, ...]
    segmentation: Segmentation
    down: Plan
    down_schedule: Schedule

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What cannot be put together or taken down so, or not by this crew."""
        return (*self.plan.findings, *self.down.findings)


NO_LIMITS = Limits(*(4 * (float("inf"),)))


def limits_of(transport: Transport) -> Limits:
    """Return what a transport and the crane on site carry; no limits where shells are built in their place."""
    if not transport.shells:
        return NO_LIMITS
    return Limits(transport.length, transport.width, transport.height, transport.mass, transport.crane)


def planned_of(
    gridshell: Gridshell,
    crew: Crew,
    limits: Limits = NO_LIMITS,
    *,
    edges_first: bool = True,
) -> Planned:
    """Return all plans for a gridshell, for a crew and what a transport carries.

    ``edges_first``: edge planks before all geodesics, as in the paper, section 3.2; else they take their turn.
    PlanError if the layers are woven so that no plank can be slid in, a part belongs to no joint, or a shell has no
    geodesics; FrameError if a shell is a mechanism.
    """

    def scheduled(plan: Plan) -> Schedule:
        return schedule_of(plan, step_minutes(plan, gridshell, crew.minutes), crew.people, crew.hours_per_day)

    locking, found = locking_orders(gridshell, edges_first=edges_first), segments(gridshell, limits)
    orders, size = flat_orders(gridshell), (crew.people, crew.lift_limit)
    plan = plan_of(gridshell, *size, orders=orders, locking=locking, segmentation=found)
    laid = made_for_each(gridshell, lambda shell: flat_state(shell) if shell.studs else None)
    flat = {mark: state for mark, state in laid.items() if state is not None}
    shells = index_of(gridshell).shells
    lying = (found for mark in flat for found in flat_findings(shells[mark], flat[mark], gridshell.timber))
    plan = replace(plan, findings=(*plan.findings, *lying))
    down = disassembly_of(gridshell, *size, orders=orders, segmentation=found)
    return Planned(plan, scheduled(plan), orders, flat, locking, found, down, scheduled(down))
