"""The work by which one shell is put together (paper section 3.2): beams, flat layout, hoisting, fixing."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, groupby

from aag_cad.language import Figure, Language, say
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import short_mark
from aag_cad.parts.model import Shell
from assembly.base.locking_order import LockingOrder
from assembly.base.mark_ranges import joined_ranges
from assembly.base.part_groups import Kit, shell_kit
from assembly.base.steps import Phase
from assembly.laying.order import FlatOrder, groups_of, row_groups

BEAMS_A_STEP = 4
LAID_A_STEP = 7
STUDS_A_STEP = 24
PAIRS_A_STEP = 2
PAIR = 2
EVERYONE = 1000

_LAYING: dict[str, Phase] = {"A1": "lay A1", "G": "lay G", "A2": "lay A2"}


@dataclass(frozen=True)
class Work:
    """What a step does, before it has its number, its words and its crew: see ``assembly.base.steps.Step``.

    ``notes`` are instructions of its own, after those of its phase.
    """

    id: str
    phase: Phase
    title: str
    after: tuple[str, ...]
    marks: tuple[str, ...] = ()
    assemblies: tuple[str, ...] = ()
    least_crew: int = 1
    below: str = ""
    props: tuple[str, ...] = ()
    extras: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class _Task:
    """What the works of one shell are made from."""

    shell: Shell
    kit: Kit
    order: FlatOrder
    language: Language

    def say(self, key: str, **figures: Figure) -> str:
        """Return a title or a phrase of ``words/steps.toml``."""
        return say(self.language, f"steps.{key}", **figures)


def _all_of(groups: Iterable[Sequence[str]]) -> tuple[str, ...]:
    return tuple(chain.from_iterable(groups))


def _prefabrication(task: _Task) -> Iterator[Work]:
    """Yield the making of beams in the order of laying; no group waits for another."""
    beams = task.kit.beams
    runs = ([unit for unit in run if unit in beams] for run in task.order.runs)
    groups = chain.from_iterable(groups_of(run, BEAMS_A_STEP) for run in runs)
    for i, group in enumerate(groups, start=1):
        yield Work(
            f"{task.shell.mark}.make.{i}",
            "prefabricate",
            task.say("make.title", marks=joined_ranges(group)),
            after=(),
            marks=_all_of(beams[beam] for beam in group),
            least_crew=PAIR,
        )


def _laying(task: _Task, made: Mapping[str, str]) -> Iterator[Work]:
    """Yield the flat layout; each step follows the one before and the making of its beams (``made``: beam -> id)."""
    laid = index_of(task.shell).units
    runs = (tuple(units) for run in task.order.runs for _, units in groupby(run, key=lambda unit: laid[unit].family))
    groups = chain.from_iterable(groups_of(run, LAID_A_STEP) for run in runs)
    before: tuple[str, ...] = ()
    for i, group in enumerate(groups, start=1):
        family = laid[group[0]].family
        beams = tuple(unit for unit in group if unit in task.kit.beams)
        work = Work(
            f"{task.shell.mark}.lay.{i}",
            _LAYING[family],
            task.say("lay.beams" if beams else "lay.geodesics", marks=joined_ranges(group)),
            after=(*dict.fromkeys(made[beam] for beam in beams), *before),
            marks=tuple(unit for unit in group if unit not in task.kit.beams),
            assemblies=beams,
            below=task.say(f"below.{family}"),
        )
        yield work
        before = (work.id,)


def _sliding(task: _Task, laid: str) -> Iterator[Work]:
    """Yield the sliding in of planks that are woven between others, one after the other."""
    lengths = {plank.mark: plank.blank.length for plank in task.shell.planks}
    for i, slide in enumerate(task.order.slides, start=1):
        free = task.say("slide.open") if slide.free == float("inf") else f"{slide.free:.0f} mm"
        way = task.say(
            "slide.way",
            unit=short_mark(slide.unit),
            end=task.say(f"slide.{slide.end}"),
            count=len(slide.crossings),
            joints=", ".join(short_mark(joint) for joint in slide.crossings),
            needed=lengths[slide.unit],
            free=free,
        )
        work = Work(
            f"{task.shell.mark}.slide.{i}",
            "slide",
            task.say("slide.title", marks=joined_ranges((slide.unit,))),
            after=(laid,),
            marks=(slide.unit,),
            least_crew=PAIR,
            notes=(way,),
        )
        yield work
        laid = work.id


def _setting(task: _Task, laid: str) -> Iterator[Work]:
    """Yield the setting of studs, row by row from the foot, with their bolts."""
    first, before = 1, laid
    for i, rows in enumerate(row_groups(task.order.rows, STUDS_A_STEP), start=1):
        last, studs = first + len(rows) - 1, _all_of(rows)
        key = "stud.row" if last == first else "stud.rows"
        work = Work(
            f"{task.shell.mark}.stud.{i}",
            "studs",
            task.say(key, marks=joined_ranges(studs), first=first, last=last),
            after=(before,),
            marks=_all_of((stud, *task.kit.studs[stud]) for stud in studs),
            least_crew=PAIR,
        )
        yield work
        first, before = last + 1, work.id


def _locking_groups(kit: Kit, locking: LockingOrder | None) -> tuple[tuple[str, ...], ...]:
    """Return edge planks and geodesics in the groups in which they are fixed.

    Those of the locking order; without one the lower edge planks, the upper ones, then the geodesics one by one.
    """
    flat = [mark for mark in kit.outside if kit.outside[mark] or kit.inside[mark]]
    upper = tuple(mark for mark in kit.edges if mark not in kit.lower_edges)
    listed = [step.marks for step in locking.steps] if locking else [kit.lower_edges, upper]
    groups = [tuple(mark for mark in marks if mark in kit.edges or mark in flat) for marks in listed]
    done = _all_of(groups)
    return (*(group for group in groups if group), *((mark,) for mark in flat if mark not in done))


def _props_before(locking: LockingOrder | None, fixed: Sequence[str]) -> tuple[str, ...]:
    """Return the props that a shell needs before some planks are fixed: those of the hoists and against its sag."""
    if locking is None:
        return ()
    first = next(i for i, step in enumerate(locking.steps) if set(step.marks) & set(fixed))
    return (*locking.hoists, *(prop.joint for prop in locking.steps[first - 1].props))


def _edging(task: _Task, marks: tuple[str, ...], before: str, props: tuple[str, ...]) -> Work:
    """Return the pushing in of the lower or the upper edge planks, with their screws."""
    name = "lower" if marks[0] in task.kit.lower_edges else "upper"
    return Work(
        f"{task.shell.mark}.edge.{name}",
        "edge planks",
        task.say(f"edge.{name}" if len(marks) == 1 else f"edge.{name}s", marks=joined_ranges(marks)),
        after=(before,),
        marks=_all_of((mark, *task.kit.edges[mark]) for mark in marks),
        least_crew=2 * PAIR,
        props=props,
    )


def _fixing(
    task: _Task, number: int, groups: Sequence[tuple[str, ...]], before: str, locking: LockingOrder | None
) -> Work:
    """Return the driving of the screws of some groups of geodesics."""
    kit, every = task.kit, _all_of(groups)
    turns = task.say("fix.then").join(joined_ranges(group) for group in groups)
    return Work(
        f"{task.shell.mark}.fix.{number}",
        "fix geodesics",
        task.say("fix.title", marks=joined_ranges(every)),
        after=(before,),
        marks=_all_of(screws[mark] for screws in (kit.outside, kit.inside) for mark in every),
        least_crew=PAIR,
        props=_props_before(locking, every),
        notes=(task.say("fix.order", groups=turns),) if locking else (),
    )


def _locking(task: _Task, before: str, locking: LockingOrder | None) -> Iterator[Work]:
    """Yield what stiffens the hoisted shell: edge planks and geodesics in the locking order, then all bolts."""
    number = 0
    for edges, listed in groupby(_locking_groups(task.kit, locking), key=lambda group: group[0] in task.kit.edges):
        groups = list(listed)
        size = 1 if edges else PAIRS_A_STEP
        for some in (groups[i : i + size] for i in range(0, len(groups), size)):
            number += not edges
            if edges:
                work = _edging(task, some[0], before, _props_before(locking, some[0]))
            else:
                work = _fixing(task, number, some, before, locking)
            yield work
            before = work.id
    name, props = task.shell.mark, locking.hoists if locking else ()
    title = task.say("tighten.title", shell=name)
    yield Work(f"{name}.tighten", "tighten", title, after=(before,), least_crew=PAIR, props=props)


def shell_works(
    shell: Shell, order: FlatOrder, locking: LockingOrder | None = None, language: Language = "en"
) -> tuple[Work, ...]:
    """Return the work that makes one stiff shell laid out in a flat order, in an order in which it can be done.

    Edge planks and geodesics are fixed in the order of ``locking``, two groups of geodesics in a step, on the props
    that it proposes; without one, edge planks first, then the geodesics in the order of their marks. PlanError if a
    part belongs to no joint.
    """
    task = _Task(shell, shell_kit(shell), order, language)
    name = shell.mark
    making = list(_prefabrication(task))
    made = {beam: work.id for beam, marks in task.kit.beams.items() for work in making if marks[0] in work.marks}
    laying = list(_laying(task, made))
    sliding = list(_sliding(task, laying[-1].id))
    setting = list(_setting(task, (*laying, *sliding)[-1].id))
    flat = (*making, *laying, *sliding, *setting)
    props = (*locking.hoists, *(prop.joint for prop in locking.steps[0].props)) if locking else ()
    title = task.say("hoist.title", shell=name)
    hoist = Work(f"{name}.hoist", "hoist", title, (flat[-1].id,), assemblies=(name,), least_crew=EVERYONE, props=props)
    return (*flat, hoist, *_locking(task, hoist.id, locking))
