"""Splices where a cut line crosses beams and edge planks: stations of the cuts, splice blocks and plates, bolts.

A beam is cut at its crossing with the geodesic of the line. A splice block in its gap takes the place of the coupling
block there and its bolt; the geodesic is screwed to the splice block. An edge plank is cut midway in the widest gap
between its holes in the bay beside the line, on the side that the geodesic does not go to, under a steel plate.
Distances are those of EN 1995-1-1, table 8.4, loaded: a3,t from bolts to the cut and to the block's end, a1 along the
grain. That they are kept does not prove the splice: its forces come from the structural model.
"""

from collections.abc import Iterator
from itertools import pairwise

from aag_cad.mechanics.checks.fastener_spacing import bolt_distances
from aag_cad.parts.forms import Hole
from aag_cad.parts.index import index_of
from aag_cad.parts.model import FlatBar, Shell
from assembly.base.segments import PlankCut, Splice
from assembly.graph.cut_lines import CutLines, CutMember, CutPlace

PLAY = 2.0
_ACROSS = 2
_HEXAGON = 3.0**0.5
_PLATE_END = 2.0


def _clear(holes: tuple[Hole, ...], station: float) -> float:
    """Return the distance along a plank from a station to the nearest hole; infinite without holes."""
    return min((abs(hole.station - station) - hole.slot / 2.0 for hole in holes), default=float("inf"))


def _obstacles(shell: Shell) -> dict[str, float]:
    """Return half the length along the beam of each stud and coupling block, mm."""
    halves = {stud.mark: stud.across_flats / _HEXAGON for stud in shell.studs}
    return halves | {block.mark: block.length / 2.0 for block in shell.blocks}


def _beam_splice(shell: Shell, member: CutMember, place: CutPlace, line: str) -> Splice:
    planks, bolts, blocks = index_of(shell).planks, index_of(shell).bolts, index_of(shell).blocks
    joint = index_of(shell).joints[place.joint]
    taken = [mark for mark in joint.fasteners if mark in bolts]
    diameter = max(bolts[mark].diameter for mark in taken)
    limits, halves = bolt_distances(diameter, 0.0), _obstacles(shell)
    cuts, rooms = [], []
    for mark in member.planks:
        at = index_of(shell).stations[mark, place.joint]
        kept = tuple(hole for hole in planks[mark].blank.holes if hole.joint != place.joint)
        cuts.append(PlankCut(mark, at, _clear(kept, at)))
        rooms += [abs(hole.station - at) - halves.get(hole.joint, 0.0) - PLAY for hole in kept]
    clear, room = min(cut.clear for cut in cuts), min(rooms, default=float("inf"))
    columns = max(
        (
            count
            for count in (1, 2)
            if clear >= limits.a3_t + count * limits.a1 and room >= 2.0 * limits.a3_t + (count - 1) * limits.a1
        ),
        default=0,
    )
    half = 2.0 * limits.a3_t + (max(columns, 1) - 1) * limits.a1
    return Splice(
        member.mark,
        line,
        place.joint,
        "block",
        tuple(cuts),
        limits.a3_t + limits.a1,
        2.0 * half,
        max(columns, 1),
        2 * _ACROSS * max(columns, 1),
        diameter,
        tuple(mark for mark in joint.members if mark in blocks) + tuple(taken),
        room,
        half,
    )


def beam_splices(shell: Shell, grid: CutLines) -> dict[tuple[str, str], Splice]:
    """Return the splice of each beam at each crossing where a cut along the line would cut it, by (beam, joint)."""
    return {
        (member.mark, place.joint): _beam_splice(shell, member, place, grid.lines[place.line - 1])
        for member in grid.members
        for place in member.places
        if not member.edge and member.cut_at(place)
    }


def _beside(member: CutMember, stop: int, line: int) -> Iterator[tuple[float, float]]:
    """Yield the stations of the line of a stop and of the next line on the side that its geodesic does not go to."""
    for i, place in enumerate(member.places):
        if place.line == line:
            upper = stop % 2 == 1
            other = i + 1 if upper == (place.direction > 0) else i - 1
            if 0 <= other < len(member.places):
                yield place.station, member.places[other].station


def _edge_splice(plank: FlatBar, line: str, span: tuple[float, float], diameter: float) -> Splice:
    """Return the splice of an edge plank between two of its joints, in the widest gap between holes."""
    low, high = min(span), max(span)
    stations = sorted({low, high, *(hole.station for hole in plank.blank.holes if low < hole.station < high)})
    start, end = max(pairwise(stations), key=lambda pair: (round(pair[1] - pair[0], 3), -pair[0]))
    cut = (start + end) / 2.0
    clear, limits = _clear(plank.blank.holes, cut), bolt_distances(diameter, 0.0)
    required = limits.a3_t + limits.a1
    length = 2.0 * (limits.a3_t + _PLATE_END * diameter)
    cuts = (PlankCut(plank.mark, cut, clear),)
    return Splice(plank.mark, line, "", "plate", cuts, required, length, 1, 2 * _ACROSS, diameter, ())


def edge_splices(shell: Shell, grid: CutLines) -> dict[tuple[str, int], Splice]:
    """Return the splice of each edge plank for each stop that cuts it, by (edge plank, stop).

    An edge plank that ends in the bay beside the line stays whole and stands out.
    """
    planks = index_of(shell).planks
    diameter = max((bolt.diameter for bolt in shell.bolts), default=0.0)
    found = {}
    for member in (member for member in grid.members if member.edge):
        for stop in (stop for stop in grid.stops() if grid.inner(stop)):
            line = grid.line(stop)
            for span in _beside(member, stop, line):
                found[member.mark, stop] = _edge_splice(planks[member.mark], grid.lines[line - 1], span, diameter)
    return found
