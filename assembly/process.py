"""The work by which one shell is put together (paper section 3.2): beams, flat layout, hoisting, fixing."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain, groupby

from aag_cad.parts.model import Shell
from assembly.flat import FlatOrder, flat_order, groups_of, row_groups
from assembly.kit import Kit, shell_kit
from assembly.ranges import joined_ranges
from assembly.steps import Phase

BEAMS_A_STEP = 4
LAID_A_STEP = 7
STUDS_A_STEP = 24
GEODESICS_A_STEP = 7
PAIR = 2
EVERYONE = 1000

_LAYING: dict[str, Phase] = {"A1": "lay A1", "G": "lay G", "A2": "lay A2"}
_ONTO = {"A1": "the floor", "G": "the lower beams (A1)", "A2": "the geodesics (G)"}


@dataclass(frozen=True)
class Work:
    """What a step does, before it has its number, its words and its crew: see ``assembly.steps.Step``."""

    id: str
    phase: Phase
    title: str
    after: tuple[str, ...]
    marks: tuple[str, ...] = ()
    assemblies: tuple[str, ...] = ()
    least_crew: int = 1
    below: str = ""


def _all_of(groups: Iterable[Sequence[str]]) -> tuple[str, ...]:
    return tuple(chain.from_iterable(groups))


def _prefabrication(shell: str, order: FlatOrder, kit: Kit) -> Iterator[Work]:
    """Yield the making of beams in the order of laying; no group waits for another."""
    runs = ([unit for unit in run if unit in kit.beams] for run in order.runs)
    groups = chain.from_iterable(groups_of(run, BEAMS_A_STEP) for run in runs)
    for i, group in enumerate(groups, start=1):
        yield Work(
            f"{shell}.make.{i}",
            "prefabricate",
            f"Make beams {joined_ranges(group)}",
            after=(),
            marks=_all_of(kit.beams[beam] for beam in group),
            least_crew=PAIR,
        )


def _laying(shell: Shell, order: FlatOrder, kit: Kit, made: dict[str, str]) -> Iterator[Work]:
    """Yield the flat layout; each step follows the one before and the making of its beams (``made``: beam -> id)."""
    families = {plank.beam or plank.mark: plank.family for plank in shell.planks}
    runs = (tuple(units) for run in order.runs for _, units in groupby(run, key=lambda unit: families[unit]))
    groups = chain.from_iterable(groups_of(run, LAID_A_STEP) for run in runs)
    before: tuple[str, ...] = ()
    for i, group in enumerate(groups, start=1):
        family = families[group[0]]
        beams = tuple(unit for unit in group if unit in kit.beams)
        work = Work(
            f"{shell.mark}.lay.{i}",
            _LAYING[family],
            f"Lay {'beams' if beams else 'geodesics'} {joined_ranges(group)}",
            after=(*dict.fromkeys(made[beam] for beam in beams), *before),
            marks=tuple(unit for unit in group if unit not in kit.beams),
            assemblies=beams,
            below=_ONTO[family],
        )
        yield work
        before = (work.id,)


def _setting(shell: str, order: FlatOrder, kit: Kit, laid: str) -> Iterator[Work]:
    """Yield the setting of studs, row by row from the foot, with their bolts."""
    first, before = 1, laid
    for i, rows in enumerate(row_groups(order.rows, STUDS_A_STEP), start=1):
        last, studs = first + len(rows) - 1, _all_of(rows)
        span = f"row {first}" if last == first else f"rows {first} to {last}"
        work = Work(
            f"{shell}.stud.{i}",
            "studs",
            f"Set studs {joined_ranges(studs)}, {span}",
            after=(before,),
            marks=_all_of((stud, *kit.studs[stud]) for stud in studs),
            least_crew=PAIR,
        )
        yield work
        first, before = last + 1, work.id


def _edging(shell: str, kit: Kit) -> Iterator[Work]:
    """Yield the edge planks, lower and upper, with their screws."""
    upper = tuple(mark for mark in kit.edges if mark not in kit.lower_edges)
    for name, marks in (("lower", kit.lower_edges), ("upper", upper)):
        if marks:
            yield Work(
                f"{shell}.edge.{name}",
                "edge planks",
                f"Push in the {name} edge {'plank' if len(marks) == 1 else 'planks'} {joined_ranges(marks)}",
                after=(f"{shell}.hoist",),
                marks=_all_of((mark, *kit.edges[mark]) for mark in marks),
                least_crew=2 * PAIR,
            )


def _fixing(shell: str, order: FlatOrder, kit: Kit, before: tuple[str, ...]) -> Iterator[Work]:
    """Yield the screws of the geodesics, first those driven from outside, and the tightening of all bolts."""
    flat = [unit for unit in _all_of(order.runs) if unit in kit.outside]
    sides = (("outside", kit.outside), ("inside", kit.inside))
    groups = [
        (side, screws, group)
        for side, screws in sides
        for group in groups_of([mark for mark in flat if screws[mark]], GEODESICS_A_STEP)
    ]
    for i, (side, screws, group) in enumerate(groups, start=1):
        work = Work(
            f"{shell}.fix.{i}",
            "fix geodesics",
            f"Fix geodesics {joined_ranges(group)} from {side}",
            after=before,
            marks=_all_of(screws[mark] for mark in group),
            least_crew=PAIR,
        )
        yield work
        before = (work.id,)
    yield Work(f"{shell}.tighten", "tighten", f"Tighten all bolts of shell {shell}", after=before, least_crew=PAIR)


def shell_works(shell: Shell) -> tuple[Work, ...]:
    """Return the work that makes one stiff shell, in an order in which it can be done.

    PlanError if layers are woven in a circle or a part belongs to no joint.
    """
    kit, order, name = shell_kit(shell), flat_order(shell), shell.mark
    making = list(_prefabrication(name, order, kit))
    made = {beam: work.id for beam, marks in kit.beams.items() for work in making if marks[0] in work.marks}
    laying = list(_laying(shell, order, kit, made))
    setting = list(_setting(name, order, kit, laying[-1].id))
    flat = (*making, *laying, *setting)
    hoist = Work(
        f"{name}.hoist",
        "hoist",
        f"Hoist and shape shell {name}",
        after=(flat[-1].id,),
        assemblies=(name,),
        least_crew=EVERYONE,
    )
    edging = list(_edging(name, kit))
    fixing = _fixing(name, order, kit, tuple(work.id for work in edging) or (hoist.id,))
    return (*flat, hoist, *edging, *fixing)
