"""The assembly plan of a gridshell: every part in exactly one step, no step before what it rests on."""

from collections.abc import Mapping, Sequence

from aag_cad.parts.model import Gridshell
from assembly.base.lifters import lifters_of, lifting_findings
from assembly.base.locking_order import LockingOrder
from assembly.base.segments import Segmentation
from assembly.base.steps import Plan
from assembly.laying.order import FlatOrder, flat_orders
from assembly.plan.parting import divide_works, made_with_splices
from assembly.plan.piece_weights import piece_weights, segment_weights
from assembly.plan.shell_work import shell_works
from assembly.plan.site_work import site_works
from assembly.plan.work import Work, steps_from
from assembly.transport.segments import segment_findings
from assembly.transport.stiffness import stiffness_findings


def plan_of(
    gridshell: Gridshell,
    people: int,
    lift_limit: float,
    *,
    orders: Mapping[str, FlatOrder] | None = None,
    locking: Sequence[LockingOrder] = (),
    segmentation: Segmentation | None = None,
) -> Plan:
    """Return the assembly plan for a crew of ``people`` who lift at most ``lift_limit`` kg each (paper section 3.2).

    ``orders`` say how each shell is laid flat, by mark (none: ``flat_orders``). The geodesics are fixed in the order of
    ``locking``, one for each shell; without it by their marks. Shells that ``segmentation`` cuts are parted for the
    journey and joined again on site. PlanError if the layers are woven so that no plank can be slid in, a part belongs
    to no joint, or the crew is empty.
    """
    lifters, weights = lifters_of(people, lift_limit), piece_weights(gridshell, segmentation)
    locked = {order.shell: order for order in locking}
    laid = orders if orders is not None else flat_orders(gridshell)
    works: list[Work] = []
    stiff: dict[str, str] = {}
    for shell in gridshell.shells:
        made = shell_works(gridshell, shell, laid[shell.mark], locked.get(shell.mark))
        parted = divide_works(gridshell, shell, segmentation, made[-1].id)
        works += [*made_with_splices(made, segmentation), *parted]
        stiff[shell.mark] = works[-1].id
    works += site_works(gridshell, stiff, segmentation, locking)
    craned = {*stiff, *segment_weights(gridshell, segmentation)}
    by_hand = {mark: weight for mark, weight in weights.items() if mark not in craned}
    findings = (
        *lifting_findings(by_hand, lifters),
        *(segment_findings(segmentation) if segmentation else ()),
        *(stiffness_findings(gridshell, segmentation) if segmentation else ()),
    )
    return Plan(gridshell.name, tuple(steps_from(works, weights, lifters)), findings)
