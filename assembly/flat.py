"""The order in which a shell is laid out flat: beams and geodesics layer by layer, then the studs row by row."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise
from typing import TypeVar

import numpy as np

from aag_cad.parts.model import Shell, Stud
from assembly.layers import layer_precedence, laying_order, lying_unit
from assembly.view import sweep_direction

_T = TypeVar("_T")


@dataclass(frozen=True)
class FlatOrder:
    """Runs of beams or geodesics that are laid one after the other, each run in one layer; rows of studs, foot first.

    Edge planks are left out: they are pushed in between the layers when the shell has its shape.
    """

    runs: tuple[tuple[str, ...], ...]
    rows: tuple[tuple[str, ...], ...]


def groups_of(items: Sequence[_T], most: int) -> tuple[tuple[_T, ...], ...]:
    """Return items in their order in as few groups of at most ``most`` as will do, the groups as even as can be."""
    count = -(-len(items) // most)
    cuts = [round(i * len(items) / count) for i in range(count + 1)] if count else [0]
    return tuple(tuple(items[a:b]) for a, b in pairwise(cuts))


def stud_rows(shell: Shell) -> tuple[tuple[str, ...], ...]:
    """Return the studs in rows of like height, from the foot up, each row along the sweep.

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


def flat_order(shell: Shell) -> FlatOrder:
    """Return the order of laying a shell flat (paper section 3.2): by layer, and in each layer across the shell.

    PlanError if the layers are woven so that no order exists.
    """
    direction = sweep_direction(shell)
    layer: dict[str, int] = {}
    along: dict[str, float] = {}
    edge: set[str] = set()
    for plank in shell.planks:
        unit = lying_unit(plank)
        layer[unit] = plank.layer
        along.setdefault(unit, float(plank.curve.point_spline(plank.curve.length / 2.0) @ direction))
        if plank.family == "E":
            edge.add(unit)
    precedence = layer_precedence(shell)
    order = laying_order(precedence.subgraph(set(layer) - edge), {unit: (layer[unit], along[unit]) for unit in layer})
    return FlatOrder(tuple(tuple(run) for _, run in groupby(order, key=lambda unit: layer[unit])), stud_rows(shell))


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
