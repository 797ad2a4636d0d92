"""Old planks as stock: read from a table, and what can be cut from them around their old holes."""

import csv
import math
import os
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeAlias

import numpy as np
from scipy.optimize import LinearConstraint

from aag_cad.design_making import Stock, Timber
from aag_cad.errors import FileError
from aag_cad.findings import Finding
from aag_cad.parts.forms import Blank, CrossSection, Hole
from aag_cad.parts.model import FlatBar
from aag_cad.shop.passports import REUSE_HEADER
from aag_cad.shop.stock import times_cut

SAME_SIZE = 0.5
_SEQUENCES = 20_000

Interval: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class OldPlank:
    """A plank that was used before: its blank with the old holes, species and strength class."""

    mark: str
    blank: Blank
    species: str
    strength_class: str


@dataclass(frozen=True)
class Reused:
    """A plank cut from an old one: where it starts on the old plank, mm, and how the old plank is laid for it.

    ``turned``: end for end, so that the start of the old plank is the end of the new one; ``face_down``: on its other
    face, so that the offsets of its holes change their sign.
    """

    old: str
    mark: str
    start: float
    length: float
    turned: bool
    face_down: bool


@dataclass(frozen=True)
class _Cut:
    kind: int
    start: float
    turned: bool
    face_down: bool


def _number(text: str, where: str, key: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < value < math.inf:
        raise FileError(f"{where}: {key}: {text!r} is not allowed; give a number of mm above 0, e.g. 4200.5")
    return value


def _hole(text: str, length: float, width: float, where: str) -> Hole:
    try:
        station, offset, diameter = (float(item) for item in text.split(":"))
    except ValueError as error:
        raise FileError(
            f"{where}: holes: {text!r} is not station:offset:diameter in mm, e.g. 812.5:-18.0:9; join holes by ;"
        ) from error
    if not (0.0 <= station <= length and abs(offset) <= width / 2.0 and 0.0 < diameter < math.inf):
        raise FileError(
            f"{where}: holes: {text!r} does not lie in the plank; stations go from 0 to {length:g}, offsets from "
            f"{-width / 2.0:g} to {width / 2.0:g}, diameters are above 0"
        )
    return Hole(station, offset, diameter, "bolt", "")


def _old_plank(row: dict[str, str], where: str) -> OldPlank:
    for key in ("mark", "species", "strength_class"):
        if not row[key].strip():
            raise FileError(f"{where}: {key}: empty; every plank needs one")
    length, width, thickness = (_number(row[key], where, key) for key in ("length_mm", "width_mm", "thickness_mm"))
    holes = [_hole(item, length, width, where) for item in row["holes"].split(";") if item.strip()]
    ordered = tuple(sorted(holes, key=lambda hole: (hole.station, hole.offset)))
    blank = Blank(length, CrossSection(width, thickness), ordered)
    return OldPlank(row["mark"].strip(), blank, row["species"].strip(), row["strength_class"].strip())


def read_offcuts(path: str | os.PathLike[str]) -> tuple[OldPlank, ...]:
    """Return the old planks in a CSV table with the columns of ``REUSE_HEADER``, in its order.

    FileError with the number of the line and the column where the table cannot be read.
    """
    try:
        with Path(path).open(encoding="utf-8-sig", newline="") as file:
            rows = list(csv.reader(file, strict=True))
    except (OSError, ValueError, csv.Error) as error:
        raise FileError(f"{path}: cannot be read as a table of old planks: {error}") from error
    if not rows or tuple(name.strip() for name in rows[0]) != REUSE_HEADER:
        raise FileError(f"{path}, line 1: the header must be {','.join(REUSE_HEADER)}")
    planks: dict[str, OldPlank] = {}
    for number, row in enumerate(rows[1:], start=2):
        where = f"{path}, line {number}"
        if not any(item.strip() for item in row):
            continue
        if len(row) != len(REUSE_HEADER):
            raise FileError(f"{where}: {len(row)} columns, but the header has {len(REUSE_HEADER)}")
        plank = _old_plank(dict(zip(REUSE_HEADER, row, strict=True)), where)
        if plank.mark in planks:
            raise FileError(f"{where}: mark: {plank.mark!r} stands there twice; each plank needs its own")
        planks[plank.mark] = plank
    return tuple(planks.values())


def fitting_planks(offcuts: Iterable[OldPlank], timber: Timber) -> tuple[tuple[OldPlank, ...], tuple[Finding, ...]]:
    """Return the old planks that a design can be cut from, and those that it cannot (AAG902).

    Width and thickness must be those of the design within 0.5 mm, the species the same, the strength class not lower.
    """
    fitting, refused = [], []
    for old in offcuts:
        section = old.blank.section
        checks = (
            ("species", old.species.casefold() == timber.species.casefold(), 0.0, 0.0, ""),
            ("width", abs(section.width - timber.width) <= SAME_SIZE, section.width, timber.width, "mm"),
            ("thickness", abs(section.thickness - timber.thickness) <= SAME_SIZE, section.thickness, timber.thickness,
             "mm"),
            ("strength class D", _class_number(old.strength_class) >= _class_number(timber.strength_class),
             _class_number(old.strength_class), _class_number(timber.strength_class), ""),
        )  # fmt: skip
        failed = [check for check in checks if not check[1]]
        if not failed:
            fitting.append(old)
            continue
        name, _, found, allowed, unit = failed[0]
        told = f"old plank of {old.species}, not {timber.species}:" if name == "species" else f"old plank, {name}"
        refused.append(Finding("AAG902", "note", old.mark, told, found, allowed, unit, "leave it out of stock.offcuts"))
    return tuple(fitting), tuple(refused)


def _class_number(name: str) -> float:
    """Return the bending strength in the name of a hardwood class of EN 338, e.g. 50 for D50; 0 for another name."""
    return float(name[1:]) if name[:1].upper() == "D" and name[1:].isdigit() else 0.0


def _merged(intervals: Iterable[Interval]) -> list[Interval]:
    """Return open intervals as few as possible, sorted."""
    merged: list[Interval] = []
    for low, high in sorted(intervals):
        if merged and low < merged[-1][1]:
            merged[-1] = (merged[-1][0], max(merged[-1][1], high))
        else:
            merged.append((low, high))
    return merged


def _without(intervals: Iterable[Interval], windows: Sequence[Interval]) -> list[Interval]:
    """Return open intervals less closed windows."""
    left = list(intervals)
    for low, high in windows:
        parts = [part for a, b in left for part in ((a, min(b, low)), (max(a, high), b))]
        left = [part for part in parts if part[0] < part[1]]
    return left


def barred_starts(old: Blank, new: Blank, stock: Stock, turned: bool, face_down: bool) -> list[Interval]:
    """Return the open intervals of starts on an old plank at which a new one cannot begin because of old holes.

    As a rule no old hole may lie in the new plank. With ``accept_old_holes`` it may if it is not cut by an end, and its
    rim keeps ``old_hole_clearance`` from that of every new hole, or if it lies within ``old_hole_tolerance`` of a new
    hole, lengthwise and across, that is no smaller: then it is used again.
    """
    barred: list[Interval] = []
    last = old.length - new.length
    across = -1.0 if turned != face_down else 1.0
    for hole in old.holes:
        half = (hole.diameter + hole.slot) / 2.0
        if not stock.accept_old_holes:
            barred.append((hole.station - half - new.length, hole.station + half))
            continue
        barred += [(hole.station - half, hole.station + half)]
        barred += [(hole.station - half - new.length, hole.station + half - new.length)]
        near, same = [], []
        for other in new.holes:
            start = hole.station - (new.length - other.station if turned else other.station)
            gap = abs(hole.offset - across * other.offset)
            size = (other.diameter + other.slot) / 2.0
            reach = half + size + stock.old_hole_clearance
            if gap >= reach or not -reach < start < last + reach:
                continue
            along = math.sqrt(reach**2 - gap**2)
            near.append((start - along, start + along))
            if gap <= stock.old_hole_tolerance and half <= size:
                same.append((start - stock.old_hole_tolerance, start + stock.old_hole_tolerance))
        barred += _without(_merged(near), same) if same else near
    return _merged(barred)


def _lays(stock: Stock) -> tuple[tuple[bool, bool], ...]:
    """Return the ways to lay an old plank that matter: (turned, face_down)."""
    return ((False, False), (False, True), (True, False), (True, True)) if stock.accept_old_holes else ((False, False),)


def _earliest(barred: Sequence[Interval], start: float) -> float:
    for low, high in barred:
        if low < start < high:
            start = high
    return start


def _cuttings(old: Blank, kinds: Sequence[Blank], most: Sequence[int], stock: Stock) -> list[tuple[_Cut, ...]]:
    """Return every set of new planks that an old one gives, each plank as near to its start as it can lie."""
    lays = {
        (i, lay): barred_starts(old, kind, stock, *lay)
        for i, kind in enumerate(kinds)
        if kind.length <= old.length
        for lay in _lays(stock)
    }
    found: dict[tuple[int, ...], tuple[_Cut, ...]] = {}

    def search(cuts: tuple[_Cut, ...], start: float) -> None:
        counts = Counter(cut.kind for cut in cuts)
        for i in sorted({i for i, _ in lays}):
            if counts[i] >= most[i] or len(found) >= _SEQUENCES:
                continue
            options = [(_earliest(lays[i, lay], start), lay) for lay in _lays(stock)]
            at, lay = min(options)
            if at + kinds[i].length > old.length + 1e-6:
                continue
            longer = (*cuts, _Cut(i, round(at, 3), *lay))
            found.setdefault(tuple(sorted(cut.kind for cut in longer)), longer)
            search(longer, at + kinds[i].length + stock.kerf)

    search((), 0.0)
    return list(found.values())


def _rounded(blank: Blank) -> Blank:
    """Return a blank to 0.1 mm, as it is listed and cut; the joints of its holes do not matter."""
    holes = (
        replace(hole, station=round(hole.station, 1), offset=round(hole.offset, 1) + 0.0, use="bolt", joint="")
        for hole in blank.holes
    )
    return replace(blank, length=round(blank.length, 1), holes=tuple(holes))


def _chosen(columns: Sequence[tuple[int, tuple[_Cut, ...]]], supply: Sequence[int], demand: Sequence[int],
            lengths: Sequence[float]) -> list[int]:  # fmt: skip
    """Return how often each cutting is done so that most length of new planks comes from old ones."""
    rows = np.zeros((len(supply) + len(demand), len(columns)))
    for j, (i, cuts) in enumerate(columns):
        rows[i, j] = 1.0
        for cut in cuts:
            rows[len(supply) + cut.kind, j] += 1.0
    worth = np.array([sum(lengths[cut.kind] for cut in cuts) for _, cuts in columns])
    return times_cut(-worth / 1000.0, LinearConstraint(rows, -np.inf, np.array([*supply, *demand])))[0]


def reused_planks(planks: Iterable[FlatBar], offcuts: Iterable[OldPlank], stock: Stock) -> tuple[Reused, ...]:
    """Return what is cut from old planks, as much length of new planks as can be, sorted by old mark and start.

    Old and new planks that are equal count as kinds; each kind of old plank is cut in the ways of ``_cuttings``.
    """
    waiting: dict[Blank, list[str]] = defaultdict(list)
    stacks: dict[Blank, list[str]] = defaultdict(list)
    for plank in sorted(planks, key=lambda plank: plank.mark):
        waiting[_rounded(plank.blank)].append(plank.mark)
    for old in sorted(offcuts, key=lambda old: old.mark):
        stacks[_rounded(old.blank)].append(old.mark)
    kinds = sorted(waiting, key=lambda blank: (-blank.length, waiting[blank][0]))
    olds = sorted(stacks, key=lambda blank: stacks[blank][0])
    demand = [len(waiting[kind]) for kind in kinds]
    columns = [(i, cuts) for i, old in enumerate(olds) for cuts in _cuttings(old, kinds, demand, stock)]
    if not columns:
        return ()
    times = _chosen(columns, [len(stacks[old]) for old in olds], demand, [kind.length for kind in kinds])
    reused = []
    for (i, cuts), count in zip(columns, times, strict=True):
        for _ in range(count):
            mark = stacks[olds[i]].pop(0)
            for cut in cuts:
                new = waiting[kinds[cut.kind]].pop(0)
                length = kinds[cut.kind].length
                reused.append(Reused(mark, new, cut.start, length, cut.turned, cut.face_down))
    return tuple(sorted(reused, key=lambda item: (item.old, item.start)))
