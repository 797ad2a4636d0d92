"""The work by which one shell is put together (paper section 3.2): beams, flat layout, hoisting, fixing."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, groupby

from aag_cad.language import Text, text
from aag_cad.parts.index import index_of
from aag_cad.parts.model import Gridshell, Shell
from assembly.base.locking_order import LockingOrder, LockingStep
from assembly.base.mark_ranges import joined_ranges
from assembly.base.part_groups import Kit, shell_kit
from assembly.base.phases import Phase
from assembly.base.steps import StepProp
from assembly.laying.order import FlatOrder, groups_of, row_groups
from assembly.plan.slide_work import slide_title, told_slide
from assembly.plan.step_cards import Fasteners, card, fasteners_by_kind
from assembly.plan.work import EVERYONE, LAID_A_STEP, PAIR, Work, all_of, props_under

BEAMS_A_STEP = 4
STUDS_A_STEP = 24
PAIRS_A_STEP = 2

_LAYING: dict[str, Phase] = {"A1": "lay A1", "G": "lay G", "A2": "lay A2"}


@dataclass(frozen=True)
class _Basis:
    """What the works of one shell are made from."""

    shell: Shell
    kit: Kit
    order: FlatOrder
    fasteners: Fasteners

    def work(self, name: str, phase: Phase, title: Text, *, told: str = "", below: Text | None = None) -> Work:
        """Return a piece of work on the shell that as yet adds nothing and waits for nothing."""
        mark = self.shell.mark
        return Work(f"{mark}.{name}", phase, title, card(phase, self.fasteners, told=told, below=below), mark)


def _prefabrication(basis: _Basis) -> Iterator[Work]:
    """Yield the making of beams in the order of laying; no group waits for another."""
    beams = basis.kit.beams
    runs = ([unit for unit in run if unit in beams] for run in basis.order.runs)
    groups = chain.from_iterable(groups_of(run, BEAMS_A_STEP) for run in runs)
    for i, group in enumerate(groups, start=1):
        work = basis.work(f"make.{i}", "prefabricate", text("steps.make.title", marks=joined_ranges(group)))
        yield replace(work, marks=all_of(beams[beam] for beam in group), least_crew=PAIR)


def _laying(basis: _Basis, made: Mapping[str, str]) -> Iterator[Work]:
    """Yield the flat layout; each step follows the one before and the making of its beams (``made``: beam -> id)."""
    laid = index_of(basis.shell).units
    runs = (tuple(units) for run in basis.order.runs for _, units in groupby(run, key=lambda unit: laid[unit].family))
    groups = chain.from_iterable(groups_of(run, LAID_A_STEP) for run in runs)
    before: tuple[str, ...] = ()
    for i, group in enumerate(groups, start=1):
        family = laid[group[0]].family
        beams = tuple(unit for unit in group if unit in basis.kit.beams)
        title = text("steps.lay.beams" if beams else "steps.lay.geodesics", marks=joined_ranges(group))
        work = basis.work(f"lay.{i}", _LAYING[family], title, below=text(f"steps.below.{family}"))
        yield replace(
            work,
            after=(*dict.fromkeys(made[beam] for beam in beams), *before),
            marks=tuple(unit for unit in group if unit not in basis.kit.beams),
            assemblies=beams,
        )
        before = (work.id,)


def _sliding(basis: _Basis, laid: str) -> Iterator[Work]:
    """Yield the sliding in of planks that are woven between others, one after the other."""
    planks = index_of(basis.shell).planks
    for i, slide in enumerate(basis.order.slides, start=1):
        work = told_slide(
            basis.work(f"slide.{i}", "slide", slide_title(slide, basis.shell.mark)),
            slide,
            planks[slide.unit].blank.length,
        )
        yield replace(work, after=(laid,), marks=(slide.unit,))
        laid = work.id


def _setting(basis: _Basis, laid: str) -> Iterator[Work]:
    """Yield the setting of studs, row by row from the foot, with their bolts."""
    first, before = 1, laid
    for i, rows in enumerate(row_groups(basis.order.rows, STUDS_A_STEP), start=1):
        last, studs = first + len(rows) - 1, all_of(rows)
        key = "steps.stud.row" if last == first else "steps.stud.rows"
        work = basis.work(f"stud.{i}", "studs", text(key, marks=joined_ranges(studs), first=first, last=last))
        marks = all_of((stud, *basis.kit.studs[stud]) for stud in studs)
        yield replace(work, after=(before,), marks=marks, least_crew=PAIR)
        first, before = last + 1, work.id


def _locking_groups(kit: Kit, locking: LockingOrder | None) -> tuple[tuple[str, ...], ...]:
    """Return edge planks and geodesics in the groups in which they are fixed.

    Those of the locking order; without one the lower edge planks, the upper ones, then the geodesics one by one.
    """
    flat = [mark for mark in kit.outside if kit.outside[mark] or kit.inside[mark]]
    upper = tuple(mark for mark in kit.edges if mark not in kit.lower_edges)
    listed = [step.marks for step in locking.steps] if locking else [kit.lower_edges, upper]
    groups = [tuple(mark for mark in marks if mark in kit.edges or mark in flat) for marks in listed]
    done = all_of(groups)
    return (*(group for group in groups if group), *((mark,) for mark in flat if mark not in done))


def _props_before(locking: LockingOrder | None, fixed: Sequence[str]) -> tuple[StepProp, ...]:
    """Return the props that a shell needs before some planks are fixed: those of the hoists and against its sag."""
    if locking is None:
        return ()
    first = next(i for i, step in enumerate(locking.steps) if set(step.marks) & set(fixed))
    return _props_after(locking, locking.steps[first - 1])


def _props_after(locking: LockingOrder, state: LockingStep) -> tuple[StepProp, ...]:
    return props_under((*locking.hoists, *(prop.joint for prop in state.props)), locking.shell)


def _edging(basis: _Basis, edges: tuple[str, ...], before: str, locking: LockingOrder | None) -> Work:
    """Return the pushing in of the lower or the upper edge planks, with their screws."""
    name = "lower" if edges[0] in basis.kit.lower_edges else "upper"
    title = text(f"steps.edge.{name}" if len(edges) == 1 else f"steps.edge.{name}s", marks=joined_ranges(edges))
    marks = all_of((mark, *basis.kit.edges[mark]) for mark in edges)
    told = "" if index_of(basis.shell).straps.keys() & set(marks) else "edge planks alone"
    work = basis.work(f"edge.{name}", "edge planks", title, told=told)
    props = _props_before(locking, edges)
    return replace(work, after=(before,), marks=marks, least_crew=2 * PAIR, props=props)


def _fixing(
    basis: _Basis, number: int, groups: Sequence[tuple[str, ...]], before: str, locking: LockingOrder | None
) -> Work:
    """Return the driving of the screws of some groups of geodesics."""
    kit, every = basis.kit, all_of(groups)
    turns = tuple(joined_ranges(group) for group in groups)
    return replace(
        basis.work(f"fix.{number}", "fix geodesics", text("steps.fix.title", marks=joined_ranges(every))),
        after=(before,),
        marks=all_of(screws[mark] for screws in (kit.outside, kit.inside) for mark in every),
        least_crew=PAIR,
        props=_props_before(locking, every),
        notes=(text("steps.fix.order", groups=turns),) if locking else (),
    )


def _locking(basis: _Basis, before: str, locking: LockingOrder | None) -> Iterator[Work]:
    """Yield what stiffens the hoisted shell: edge planks and geodesics in the locking order, then all bolts."""
    number = 0
    for edges, listed in groupby(_locking_groups(basis.kit, locking), key=lambda group: group[0] in basis.kit.edges):
        groups = list(listed)
        size = 1 if edges else PAIRS_A_STEP
        for some in (groups[i : i + size] for i in range(0, len(groups), size)):
            number += not edges
            work = _edging(basis, some[0], before, locking) if edges else _fixing(basis, number, some, before, locking)
            yield work
            before = work.id
    name, props = basis.shell.mark, props_under(locking.hoists, locking.shell) if locking else ()
    told = "" if basis.fasteners.get("ridge") else "tighten alone"
    work = basis.work("tighten", "tighten", text("steps.tighten.title", shell=name), told=told)
    yield replace(work, after=(before,), least_crew=PAIR, props=props)


def shell_works(
    gridshell: Gridshell, shell: Shell, order: FlatOrder, locking: LockingOrder | None = None
) -> tuple[Work, ...]:
    """Return the work that makes one stiff shell laid out in a flat order, in an order in which it can be done.

    Edge planks and geodesics are fixed in the order of ``locking``, two groups of geodesics in a step, on the props
    that it proposes; without one, edge planks first, then the geodesics in the order of their marks. PlanError if a
    part belongs to no joint.
    """
    basis, name = _Basis(shell, shell_kit(shell), order, fasteners_by_kind(gridshell, (shell,))), shell.mark
    making = list(_prefabrication(basis))
    made = {beam: work.id for beam, marks in basis.kit.beams.items() for work in making if marks[0] in work.marks}
    laying = list(_laying(basis, made))
    sliding = list(_sliding(basis, laying[-1].id))
    setting = list(_setting(basis, (*laying, *sliding)[-1].id))
    flat = (*making, *laying, *sliding, *setting)
    props = _props_after(locking, locking.steps[0]) if locking else ()
    hoist = basis.work("hoist", "hoist", text("steps.hoist.title", shell=name))
    hoist = replace(hoist, after=(flat[-1].id,), assemblies=(name,), least_crew=EVERYONE, props=props)
    return (*flat, hoist, *_locking(basis, hoist.id, locking))
