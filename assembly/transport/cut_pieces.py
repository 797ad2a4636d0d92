"""What a stretch of a shell between two cuts holds: whole parts, pieces of planks, mass, centre and corners."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from aag_cad.parts.forming import formed_points
from aag_cad.parts.index import Index, index_of
from aag_cad.parts.kinds import is_driven, parts_at
from aag_cad.parts.mesh import shell_mesh
from aag_cad.parts.model import FlatBar, Joint, Part, Shell, Timber, shell_parts
from aag_cad.parts.quantities import mass
from aag_cad.units import Floats
from assembly.base.segments import PlankPiece, Splice
from assembly.graph.cut_lines import CutLines, CutMember, cut_lines
from assembly.graph.gridshell_graph import part_point
from assembly.transport.splices import beam_splices, edge_splices

CORNER_SPACING = 60.0
_CENTRE_SAMPLES = 33
_CARRIED_JOINTS = ("AA", "AG", "boundary", "ridge")


@dataclass(frozen=True)
class Stretch:
    """What lies between two stops: marks of whole parts and pieces of planks.

    ``mass`` in kg, ``centre`` (3,) and ``corners`` (n, 3) in the coordinates of the shell.
    """

    geodesics: tuple[str, ...]
    parts: tuple[str, ...]
    pieces: tuple[PlankPiece, ...]
    mass: float
    centre: Floats
    corners: Floats


@dataclass(frozen=True, eq=False)
class Divisible:
    """A shell with all that a cut needs to know of it; made by ``divisible``."""

    shell: Shell
    timber: Timber
    grid: CutLines
    beam_splices: dict[tuple[str, str], Splice]
    edge_splices: dict[tuple[str, int], Splice]

    @cached_property
    def index(self) -> Index:
        """What the shell holds, by mark."""
        return index_of(self.shell)

    @cached_property
    def small(self) -> dict[str, Part]:
        """Studs, coupling blocks, bolts, screws and straps by mark."""
        parts = parts_at(shell_parts(self.shell), "shell")
        return {part.mark: part for part in parts if part.mark not in self.index.planks}

    @cached_property
    def masses(self) -> dict[str, float]:
        """Masses of the small parts by mark, kg."""
        return {mark: mass(part, self.timber) for mark, part in self.small.items()}

    @cached_property
    def centres(self) -> dict[str, Floats]:
        """A point (3,) in the middle of each small part, by mark."""
        return {mark: part_point(part) for mark, part in self.small.items()}

    @cached_property
    def fixed_on_site(self) -> frozenset[str]:
        """Small parts of the feet, the cover and the footings: fixed on site, cut or not."""
        return frozenset(
            mark
            for joint in self.shell.joints
            if joint.kind not in _CARRIED_JOINTS
            for mark in (joint.mark, *joint.fasteners)
        )

    @cached_property
    def small_corners(self) -> dict[str, Floats]:
        """Corners of small parts; blocks lie in the gaps of beams and screws in the timber."""
        return {
            mark: shell_mesh(part).vertices
            for mark, part in self.small.items()
            if mark not in self.index.blocks and not is_driven(part)
        }

    @cached_property
    def rings(self) -> dict[str, tuple[Floats, Floats]]:
        """Stations (n,) and corners (n, 4, 3) of each plank, with a ring at every possible cut."""
        cuts: dict[str, set[float]] = {mark: set() for mark in self.index.planks}
        for splice in (*self.beam_splices.values(), *self.edge_splices.values()):
            for cut in splice.cuts:
                cuts[cut.plank].add(cut.station)
        return {mark: _rings(plank, cuts[mark]) for mark, plank in self.index.planks.items()}


def _rings(plank: FlatBar, cuts: set[float]) -> tuple[Floats, Floats]:
    length, section = plank.blank.length, plank.blank.section
    even = np.linspace(0.0, length, max(2, int(np.ceil(length / CORNER_SPACING)) + 1))
    stations = np.array(sorted({*even.tolist(), *cuts}))
    y, z = section.width / 2.0, section.thickness / 2.0
    corners = np.array([(-y, -z), (y, -z), (y, z), (-y, z)])
    points = np.column_stack([np.repeat(stations, 4), np.tile(corners, (len(stations), 1))])
    return stations, formed_points(plank, points).reshape(-1, 4, 3)


def divisible(shell: Shell, timber: Timber) -> Divisible:
    """Return a shell with its lines, crossings and possible splices; PlanError if it has no order of geodesics."""
    grid = cut_lines(shell)
    return Divisible(shell, timber, grid, beam_splices(shell, grid), edge_splices(shell, grid))


def cut_stops(grid: CutLines, start: int, end: int) -> tuple[int, ...]:
    """Return those of two stops at which a stretch is cut: none of a chain's ends, and none if it is the whole ring."""
    if grid.ring and end - start == 2 * len(grid.lines):
        return ()
    return tuple(stop for stop in (start, end) if grid.inner(stop))


def _same_stop(grid: CutLines, stop: int) -> int:
    """Return a stop counted once around a ring."""
    return (stop - 2) % (2 * len(grid.lines)) + 2 if grid.ring else stop


def stop_splices(item: Divisible, stop: int) -> tuple[Splice, ...]:
    """Return the splices that a cut at a stop needs, beams before edge planks."""
    grid, line = item.grid, item.grid.line(stop)
    beams = [
        item.beam_splices[member.mark, place.joint]
        for member in grid.members
        for place in member.places
        if place.line == line and (member.mark, place.joint) in item.beam_splices
    ]
    stop = _same_stop(grid, stop)
    edges = [item.edge_splices[t.mark, stop] for t in grid.members if (t.mark, stop) in item.edge_splices]
    return (*beams, *edges)


def _intervals(
    item: Divisible, member: CutMember, start: int, end: int, splices: dict[float, Splice]
) -> Iterator[tuple[PlankPiece, ...]]:
    """Yield the pieces of a beam or edge plank, one for each of its planks, that lie in the stretch.

    ``splices`` are those of the cuts at the ends of the stretch, by station on the beam or edge plank.
    """
    grid, unit = item.grid, index_of(item.shell).units[member.mark]
    cuts = [splices[station].cuts for station in sorted(splices)]
    bounds = [0.0, *sorted(splices), unit.curve.length]
    bays, owned = grid.bays(start, end), grid.owned(start, end)
    for i, (low, high) in enumerate(pairwise(bounds)):
        if member.edge:
            inside = any(c.line in owned for c in member.places if low < c.station < high)
        else:
            # Studs decide; a piece between two cuts that has none lies where its middle lies.
            studs = [s for s in member.studs if low < s < high] or [(low + high) / 2.0]
            inside = grid.bay(member.bay(studs[0])) in bays
        if inside:
            yield tuple(
                PlankPiece(
                    mark,
                    cuts[i - 1][k].station if i else 0.0,
                    cuts[i][k].station if i < len(cuts) else item.index.planks[mark].blank.length,
                )
                for k, mark in enumerate(member.planks)
            )


def _held(item: Divisible, spans: dict[str, list[PlankPiece]], joint: Joint) -> list[str]:
    """Return the planks of a joint that are in the stretch where the joint is."""
    held = []
    for mark in (mark for mark in joint.members if mark in spans):
        at = index_of(item.shell).stations.get((mark, joint.mark))
        if at is not None and any(p.start < at < p.end or _past_end(item, p, at) for p in spans[mark]):
            held.append(mark)
    return held


def _past_end(item: Divisible, piece: PlankPiece, at: float) -> bool:
    """Return whether a joint sits just past an end of the whole plank that the piece holds."""
    length = item.index.planks[piece.plank].blank.length
    return (at <= 0.0 and piece.start == 0.0) or (at >= length and piece.end == length)


def _joint_parts(item: Divisible, spans: dict[str, list[PlankPiece]]) -> Iterator[str]:
    """Yield what the joints of a stretch hold: all if all planks are there, of a beam alone its block and bolts."""
    for joint in (joint for joint in item.shell.joints if joint.kind in _CARRIED_JOINTS):
        planks = [mark for mark in joint.members if mark in item.index.planks]
        held = _held(item, spans, joint)
        small = [mark for mark in (*joint.members, *joint.fasteners) if mark in item.small]
        if len(held) == len(planks):
            yield from small
        elif joint.kind in ("AG", "boundary") and any(item.index.planks[mark].beam for mark in held):
            yield from (mark for mark in small if not is_driven(item.small[mark]))


def _piece_plank(plank: FlatBar, piece: PlankPiece, left_out: frozenset[str]) -> FlatBar:
    kept = frozenset[str]() if not plank.upright else left_out
    holes = tuple(h for h in plank.blank.holes if piece.start < h.station < piece.end and h.joint not in kept)
    return replace(plank, blank=replace(plank.blank, length=piece.end - piece.start, holes=holes))


def _station(item: Divisible, splice: Splice) -> float:
    """Return where a splice is along its beam or edge plank; a beam's planks have stations of their own."""
    if splice.kind == "plate":
        return splice.cuts[0].station
    return index_of(item.shell).stations[splice.member, splice.joint]


def _spans(item: Divisible, start: int, end: int) -> dict[str, list[PlankPiece]]:
    geodesics = [item.grid.lines[line - 1] for line in item.grid.owned(start, end)]
    spans = {mark: [PlankPiece(mark, 0.0, item.index.planks[mark].blank.length)] for mark in geodesics}
    cut: dict[str, dict[float, Splice]] = {}
    for splice in (splice for stop in cut_stops(item.grid, start, end) for splice in stop_splices(item, stop)):
        cut.setdefault(splice.member, {})[_station(item, splice)] = splice
    for member in item.grid.members:
        for pieces in _intervals(item, member, start, end, cut.get(member.mark, {})):
            for piece in pieces:
                spans.setdefault(piece.plank, []).append(piece)
    return spans


def stretch_between(item: Divisible, start: int, end: int) -> Stretch:
    """Return what lies between two stops of a shell; shoes, rods, cover, splices and what they replace stay out.

    Fasteners that would join two segments are put in on site and belong to none, and so are splice blocks and plates.
    """
    spans = _spans(item, start, end)
    left_out = frozenset(s.joint for stop in cut_stops(item.grid, start, end) for s in stop_splices(item, stop))
    small = tuple(dict.fromkeys(_joint_parts(item, spans)))
    masses, centres, corners, whole, pieces = [], [], [], [], []
    for mark, held in spans.items():
        stations, rings = item.rings[mark]
        for piece in held:
            masses.append(mass(_piece_plank(item.index.planks[mark], piece, left_out), item.timber))
            samples = np.linspace(piece.start, piece.end, _CENTRE_SAMPLES)
            line = item.index.planks[mark].curve.point_spline(samples)
            centres.append((line[:-1] + line[1:]).mean(axis=0) / 2.0)
            corners.append(rings[(stations >= piece.start) & (stations <= piece.end)].reshape(-1, 3))
            if piece.start == 0.0 and piece.end == item.index.planks[mark].blank.length:
                whole.append(mark)
            else:
                pieces.append(piece)
    for mark in small:
        masses.append(item.masses[mark])
        centres.append(item.centres[mark])
        corners += [item.small_corners[mark]] if mark in item.small_corners else []
    return Stretch(
        tuple(mark for mark in spans if mark in index_of(item.shell).geodesics),
        (*whole, *small),
        tuple(pieces),
        float(sum(masses)),
        np.asarray(np.average(centres, axis=0, weights=masses)),
        np.concatenate(corners),
    )
