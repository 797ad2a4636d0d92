"""The order in which a shell is laid out flat: run by run of beams and geodesics, then what is slid in, then the studs.

It takes the fewest walked metres (``assembly.laying.walking``) and handles each long piece once, a slid one twice.
"""

from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby, pairwise
from typing import TypeAlias, TypeVar

import networkx as nx
import numpy as np

from aag_cad.families import EDGES
from aag_cad.parts.model import Gridshell, Shell, Stud
from aag_cad.parts.twins import made_for_each
from aag_cad.units import Floats
from assembly.base.errors import PlanError
from assembly.base.shell_axes import best_plane, shell_view, sweep_direction
from assembly.graph.gridshell_graph import assembly_graph
from assembly.graph.interlacing import Interlacing, Slide, interlacing, refuse_left_out
from assembly.graph.laying_units import Unit, units_of
from assembly.laying.footpath import shorter_path
from assembly.laying.walking import (
    Line,
    Point,
    alternated,
    best_stack,
    on_floor,
    path_length,
    serpentine,
    stack_places,
    stepped_over,
    sweep_order,
)

_T = TypeVar("_T")
# Shell, layer, family: what lies on one stack, and is laid in one run where nothing of it waits for something else.
_Sort: TypeAlias = tuple[str, int, str]

# A path that saves less than this share keeps to whole rows, which a crew finds without a map.
_WORTH_LEAVING_ROWS = 0.01


@dataclass(frozen=True)
class FlatOrder:
    """Runs of beams or geodesics that are laid one after the other, each from side to side; then rows of studs.

    ``slides`` come after the runs, in their order. Edge planks are left out: they are pushed in between the layers when
    the shell has its shape. ``stacks`` say where each is carried from, by shell and family, mm on the floor.
    """

    runs: tuple[tuple[str, ...], ...]
    rows: tuple[tuple[str, ...], ...]
    slides: tuple[Slide, ...] = ()
    stacks: Mapping[tuple[str, str], Point] = field(default_factory=dict)


def groups_of(items: Sequence[_T], most: int) -> tuple[tuple[_T, ...], ...]:
    """Return items in their order in as few groups of at most ``most`` as will do, the groups as even as can be."""
    count = -(-len(items) // most)
    cuts = [round(i * len(items) / count) for i in range(count + 1)] if count else [0]
    return tuple(tuple(items[a:b]) for a, b in pairwise(cuts))


def row_groups(rows: Sequence[tuple[str, ...]], most: int) -> tuple[tuple[tuple[str, ...], ...], ...]:
    """Return whole rows in groups of about ``most`` studs, as even as can be; a longer row is split first."""
    pieces = [piece for row in rows for piece in groups_of(row, most)]
    total = sum(len(piece) for piece in pieces)
    count = max(1, -(-total // most))
    groups: list[list[tuple[str, ...]]] = [[] for _ in range(count)]
    before = 0
    for piece in pieces:
        groups[int((before + len(piece) / 2.0) / total * count)].append(piece)
        before += len(piece)
    return tuple(tuple(group) for group in groups if group)


def stud_rows(shell: Shell) -> tuple[tuple[str, ...], ...]:
    """Return the studs in level rows, from the foot up, each row along the sweep.

    A new row begins where the next higher stud stands more than the width of a stud above the last one.
    """
    direction = sweep_direction(shell)
    rows: list[list[Stud]] = []
    for stud in sorted(shell.studs, key=lambda stud: (stud.frame.origin[2], stud.mark)):
        if rows and stud.frame.origin[2] - rows[-1][-1].frame.origin[2] <= stud.across_flats:
            rows[-1].append(stud)
        else:
            rows.append([stud])
    along = {stud.mark: float(np.array(stud.frame.origin) @ direction) for stud in shell.studs}
    return tuple(tuple(sorted((stud.mark for stud in row), key=lambda mark: (along[mark], mark))) for row in rows)


def courses(rows: Sequence[Sequence[str]], places: Mapping[str, Point]) -> tuple[tuple[str, ...], ...]:
    """Return level rows as they are walked to and fro: one by one, or two by two in zigzag where that is shorter.

    The rows of a rhombic grid lie so close that two of them are reached from one way between them.
    """
    marks = [mark for row in rows for mark in row]
    number = {mark: i for i, mark in enumerate(marks)}
    points = np.array([places[mark] for mark in marks]).reshape(-1, 2)
    if len(rows) < 2:
        return tuple(tuple(row) for row in rows)
    across = points[number[rows[0][-1]]] - points[number[rows[0][0]]]
    if not across.any():
        across = np.array([1.0, 0.0])
    along = points @ across
    found = []
    for count in (1, 2):
        merged = [[number[mark] for row in rows[i : i + count] for mark in row] for i in range(0, len(rows), count)]
        ways = alternated([sorted(row, key=lambda i: (along[i], i)) for row in merged], points)
        found.append((round(path_length(points[[i for row in ways for i in row]])), ways))
    return tuple(tuple(marks[i] for i in row) for row in min(found, key=lambda each: each[0])[1])


def walking_rows(places: Mapping[str, Point]) -> tuple[tuple[str, ...], ...]:
    """Return places on the floor in the rows in which they are walked along: to and fro, or where shorter, freely.

    The rows of a free path are its pieces in one row. A path less than 1 % shorter than whole rows is not worth it.
    """
    marks = sorted(places)
    points = on_floor(np.array([places[mark] for mark in marks], dtype=np.float64).reshape(-1, 2))
    rows = serpentine(points)
    whole = [i for row in rows for i in row]
    free = shorter_path(points, whole)
    if path_length(points[list(free)]) < (1.0 - _WORTH_LEAVING_ROWS) * path_length(points[whole]):
        row_of = {i: k for k, row in enumerate(rows) for i in row}
        rows = tuple(tuple(piece) for _, piece in groupby(free, key=lambda i: row_of[i]))
    return tuple(tuple(marks[i] for i in row) for row in rows)


def _runs(precedence: "nx.DiGraph[str]", sorts: Mapping[str, _Sort]) -> tuple[tuple[str, ...], ...]:
    """Return runs of units of one sort that wait for nothing but earlier runs: the first sort that can be laid, whole.

    PlanError with the units that wait for each other in a circle.
    """
    waiting = {unit: sum(before in sorts for before in precedence.predecessors(unit)) for unit in sorts}
    free: dict[_Sort, list[str]] = defaultdict(list)
    for unit in (unit for unit in sorts if not waiting[unit]):
        free[sorts[unit]].append(unit)
    runs: list[tuple[str, ...]] = []
    while free:
        units = tuple(sorted(free.pop(min(free))))
        runs.append(units)
        for after in (after for unit in units for after in precedence.successors(unit) if after in sorts):
            waiting[after] -= 1
            if not waiting[after]:
                free[sorts[after]].append(after)
    if left := sorted(unit for unit, count in waiting.items() if count):
        raise PlanError(
            f"{', '.join(left[:5])}: {len(left)} pieces lie on each other in a circle, allowed 0: none of them can be "
            "laid first; give the interlacing, which says what is slid in and what is left out"
        )
    return tuple(runs)


def _stack_of(sort: _Sort) -> tuple[str, str]:
    shell, _, family = sort
    return shell, family


def _stacks(
    lines: Mapping[str, Line], sorts: Mapping[str, _Sort], slides: Sequence[Slide]
) -> dict[tuple[str, str], Point]:
    """Return the best place of each stack: the shortest ways from all of them to the lines and back."""
    calls: dict[tuple[str, str], list[Point]] = defaultdict(list)
    slid = {slide.unit: slide for slide in slides}
    for unit, line in sorted(lines.items()):
        first = line.before(slid[unit].end) if unit in slid else line.middle
        calls[_stack_of(sorts[unit])] += [first, line.middle]
    points = np.array([end for line in lines.values() for end in (line.start, line.end)]).reshape(-1, 2)
    places = stack_places(points) if len(points) else points
    return {stack: _point(places[best_stack(places, np.array(listed))]) for stack, listed in sorted(calls.items())}


def _floor_order(
    lines: Mapping[str, Line],
    sorts: Mapping[str, _Sort],
    precedence: "nx.DiGraph[str]",
    slides: Sequence[Slide],
    rows: tuple[tuple[str, ...], ...],
) -> FlatOrder:
    """Return the order on one floor."""
    slid = {slide.unit for slide in slides}
    runs = _runs(precedence, {unit: sort for unit, sort in sorts.items() if unit not in slid})
    stacks, laid = _stacks(lines, sorts, slides), []
    for run in runs:
        order = sweep_order({unit: lines[unit] for unit in run})
        forward, backward = stepped_over([lines[unit] for unit in order], stacks[_stack_of(sorts[run[0]])])
        falling = order[0] > order[-1]
        laid.append(order if (forward, falling) <= (backward, not falling) else order[::-1])
    return FlatOrder(tuple(laid), rows, tuple(slides), stacks)


def flat_order(shell: Shell, woven: Interlacing) -> FlatOrder:
    """Return the order of laying a shell flat (paper section 3.2), its studs in whole ``courses`` from the foot up.

    The floor is the shell seen square on; ``woven`` is the interlacing of the graph of its gridshell.
    """
    axes = shell_view(shell).axes[:2]
    ends: dict[str, list[Floats]] = defaultdict(list)
    sorts: dict[str, _Sort] = {}
    lengths: dict[str, float] = defaultdict(float)
    for plank in (plank for plank in shell.planks if plank.family not in EDGES):
        unit, long = plank.beam or plank.mark, plank.curve.length
        ends[unit].append(plank.curve.point_spline(np.array([0.0, long])) @ axes.T)
        sorts[unit] = (shell.mark, plank.layer, plank.family)
        lengths[unit] = max(lengths[unit], long)
    lines = {unit: _line(on_floor(np.mean(found, axis=0)), lengths[unit]) for unit, found in ends.items()}
    studs = {stud.mark: _point(on_floor(np.array(stud.frame.origin) @ axes.T)) for stud in shell.studs}
    slides = [slide for slide in woven.slides if slide.unit in lines]
    return _floor_order(lines, sorts, woven.precedence, slides, courses(stud_rows(shell), studs))


def flat_orders(gridshell: Gridshell) -> dict[str, FlatOrder]:
    """Return the order of laying each shell flat, by mark, with what is slid in.

    PlanError that names every circle of members of which none can be slid in.
    """
    woven = interlacing(assembly_graph(gridshell))
    refuse_left_out(woven)
    return made_for_each(gridshell, lambda shell: flat_order(shell, woven))


def graph_floor(units: Iterable[Unit]) -> Floats:
    """Return the axes of the floor on which units lie: the plane nearest to their ends, (2, 3) with one axis a row."""
    return best_plane(np.array([(unit.start, unit.end) for unit in units], dtype=np.float64).reshape(-1, 3))[:2]


def flat_order_of(
    graph: "nx.MultiGraph[str]", interlacing: Interlacing, later: Collection[str] | None = None
) -> FlatOrder:
    """Return the order of laying the shells of a graph (``assembly.graph.gridshell_graph``) flat, one after the other.

    Without rows of studs: what is not laid is joined (``assembly.laying.joining``). The floor of each shell is the
    plane nearest to it. ``later`` are units that are not laid: edge planks (family E) if it is None; neither are those
    that the interlacing leaves out. PlanError if its precedence runs in a circle.
    """
    units = units_of(graph)
    shells: dict[str, list[Unit]] = defaultdict(list)
    for unit in units.values():
        gone = unit.family in EDGES if later is None else unit.mark in later
        if not gone and unit.mark not in interlacing.left_out:
            shells[unit.shell].append(unit)
    orders = []
    for shell, own in sorted(shells.items()):
        axes = graph_floor(own)
        lines = {unit.mark: _line(on_floor(np.array([unit.start, unit.end]) @ axes.T), unit.length) for unit in own}
        sorts: dict[str, _Sort] = {unit.mark: (shell, unit.layer or 0, unit.family) for unit in own}
        slides = [slide for slide in interlacing.slides if slide.unit in lines]
        orders.append(_floor_order(lines, sorts, interlacing.precedence, slides, ()))
    return FlatOrder(
        runs=tuple(run for order in orders for run in order.runs),
        rows=(),
        slides=tuple(slide for order in orders for slide in order.slides),
        stacks={stack: place for order in orders for stack, place in order.stacks.items()},
    )


def _point(found: Floats) -> Point:
    return float(found[0]), float(found[1])


def _line(ends: Floats, length: float) -> Line:
    return Line(_point(ends[0]), _point(ends[1]), length)
