"""Minimum spacings and distances of fasteners in timber after EN 1995-1-1, and where a gridshell misses them.

The audit turns what ``shortfalls`` yields into findings. Which force acts on a fastener, and at what angle to the
grain, is not known from the shape: a distance below the least that the table asks at any angle is an error, one below
the most that it asks a warning.
"""

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

from aag_cad.findings import Finding
from aag_cad.language import printed
from aag_cad.parts.forms import Hole, HoleUse
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import parse_mark
from aag_cad.parts.model import CouplingBlock, FlatBar, Gridshell, Screw, all_joints
from aag_cad.units import Floats

ROUNDING = 0.05
HOLE_PLAY = 1.0
WASHER_WIDTH, WASHER_THICKNESS = 3.0, 0.3
_SCREW_AS_NAIL = 6.0
_ALONG = 0.9
_LENGTHEN = "lengthen the end, move the joint or prove the reduced distance"

_JOINTS = {"N": "a stud", "K": "a block", "F": "a shoe", "R": "a strap", "V": "a cover"}

Diameters: TypeAlias = dict[tuple[str, HoleUse], float]


@dataclass(frozen=True)
class FastenerDistances:
    """Spacings along (a1) and across the grain (a2), distances from loaded (t) and unloaded (c) ends and edges; mm."""

    a1: float
    a2: float
    a3_t: float
    a3_c: float
    a4_t: float
    a4_c: float


def bolt_distances(diameter: float, angle: float) -> FastenerDistances:
    """Return the distances for bolts, EN 1995-1-1, table 8.4; ``angle`` between force and grain, radians.

    a3,t holds for forces towards the end, a3,c away from it, a4,t towards the edge, a4,c away from it.
    """
    cosine, sine = abs(math.cos(angle)), abs(math.sin(angle))
    return FastenerDistances(
        a1=(4.0 + cosine) * diameter,
        a2=4.0 * diameter,
        a3_t=max(7.0 * diameter, 80.0),
        a3_c=max((1.0 + 6.0 * sine) * diameter, 4.0 * diameter),
        a4_t=max((2.0 + 2.0 * sine) * diameter, 3.0 * diameter),
        a4_c=3.0 * diameter,
    )


def screw_distances(diameter: float, angle: float) -> FastenerDistances:
    """Return the distances for screws in pre-drilled holes; ``angle`` between force and grain, radians.

    Up to 6 mm those of nails, EN 1995-1-1, table 8.2 (8.7.1(5)); thicker ones those of bolts (8.7.1(4)). Hardwood is
    always pre-drilled (10.4.5).
    """
    if diameter > _SCREW_AS_NAIL:
        return bolt_distances(diameter, angle)
    cosine, sine = abs(math.cos(angle)), abs(math.sin(angle))
    return FastenerDistances(
        a1=(4.0 + cosine) * diameter,
        a2=(3.0 + sine) * diameter,
        a3_t=(7.0 + 5.0 * cosine) * diameter,
        a3_c=7.0 * diameter,
        a4_t=(3.0 + (2.0 if diameter < 5.0 else 4.0) * sine) * diameter,
        a4_c=3.0 * diameter,
    )


def distances(use: HoleUse, diameter: float, angle: float) -> FastenerDistances:
    """Return the distances for a bolt or a screw, by what its hole is for."""
    return bolt_distances(diameter, angle) if use == "bolt" else screw_distances(diameter, angle)


def table_of(use: HoleUse, diameter: float) -> str:
    """Return the table of EN 1995-1-1 that holds for a bolt or a screw."""
    return f"EN 1995-1-1, table {'8.4' if use == 'bolt' or diameter > _SCREW_AS_NAIL else '8.2'}"


def _diameters(gridshell: Gridshell) -> Diameters:
    """Return the largest diameter of the bolts and of the screws of each joint."""
    bolts, screws = index_of(gridshell).bolts, index_of(gridshell).screws
    found: Diameters = {}
    for joint in all_joints(gridshell):
        for mark in (mark for mark in joint.fasteners if mark in bolts or mark in screws):
            use: HoleUse = "bolt" if mark in bolts else "screw"
            diameter = bolts[mark].diameter if mark in bolts else screws[mark].diameter
            found[joint.mark, use] = max(diameter, found.get((joint.mark, use), 0.0))
    return found


def _joint_word(hole: Hole) -> str:
    """Return what a hole belongs to, for a carpenter."""
    return _JOINTS.get(parse_mark(hole.joint).family, "a blade")


def _diameter(hole: Hole, diameters: Diameters) -> float:
    """Return the diameter of a hole's fastener, that of the hole if its joint has none."""
    return diameters.get((hole.joint, hole.use), hole.diameter)


def _two_limits(
    code: str, mark: str, what: str, found: float, table: str, least: tuple[str, float], loaded: tuple[str, float],
    remedy: str,
) -> Iterator[Finding]:  # fmt: skip
    """Yield the shortfall below the least (clause, mm) as an error, below the loaded one as a warning."""
    if found < least[1] - ROUNDING:
        yield Finding(code, "error", mark, f"{what} ({table}, {least[0]})", found, least[1], "mm", remedy)
    elif found < loaded[1] - ROUNDING:
        what = f"{what}, loaded ({table}, {loaded[0]})"
        yield Finding(code, "warning", mark, what, found, loaded[1], "mm", remedy)


def _worst(missed: list[Finding]) -> list[Finding]:
    """Return the one that misses by most, errors before warnings; nothing if there is none."""
    return sorted(missed, key=lambda item: (item.severity != "error", item.found - item.allowed))[:1]


def _plank_borders(plank: FlatBar, diameters: Diameters) -> Iterator[Finding]:
    """Yield AAG201 and AAG202: the holes too near to an end and to an edge, one each for bolts and for screws.

    A slot counts from its end.
    """
    for use in ("bolt", "screw"):
        ends: list[Finding] = []
        edges: list[Finding] = []
        for hole in (hole for hole in plank.blank.holes if hole.use == use):
            d = _diameter(hole, diameters)
            end = min(hole.station, plank.blank.length - hole.station) - hole.slot / 2.0
            edge = plank.blank.section.width / 2.0 - abs(hole.offset)
            along, across = distances(hole.use, d, 0.0), distances(hole.use, d, math.pi / 2.0)
            what, table = f"{use} hole of {_joint_word(hole)} from the", table_of(hole.use, d)
            limits = ("a3,c", along.a3_c), ("a3,t", along.a3_t)
            ends += _two_limits("AAG201", plank.mark, f"{what} end", end, table, *limits, _LENGTHEN)
            limits = ("a4,c", across.a4_c), ("a4,t", across.a4_t)
            edges += _two_limits("AAG202", plank.mark, f"{what} edge", edge, table, *limits, "move the hole inwards")
        yield from _worst(ends)
        yield from _worst(edges)


def _plank_spacing(plank: FlatBar, diameters: Diameters) -> Iterator[Finding]:
    """Yield AAG203: the two holes too near to each other; two are far enough apart if along or across the grain.

    Of unlike fasteners the smaller distances are the least and the larger ones the most.
    """
    holes = plank.blank.holes
    missed: list[Finding] = []
    for i, first in enumerate(holes):
        for second in holes[i + 1 :]:
            along = second.station - first.station - (first.slot + second.slot) / 2.0
            kinds = [(hole.use, _diameter(hole, diameters)) for hole in (first, second)]
            if along > max(5.0 * d for _, d in kinds):
                break
            missed += _spacing(plank.mark, first, second, along, kinds)
    yield from _worst(missed)


def _spacing(
    mark: str, first: Hole, second: Hole, along: float, kinds: list[tuple[HoleUse, float]]
) -> Iterator[Finding]:
    across = abs(second.offset - first.offset)
    with_grain, against = ([distances(*kind, angle) for kind in kinds] for angle in (0.0, math.pi / 2.0))
    least = (min(one.a1 for one in against), min(one.a2 for one in with_grain))
    most = (max(one.a1 for one in with_grain), max(one.a2 for one in against))
    where = " and ".join(dict.fromkeys(_joint_word(hole) for hole in (first, second)))
    table = table_of(*max(kinds, key=lambda kind: (kind[0] == "bolt", kind[1])))
    # The direction in which less is missing: there the pattern is mended most easily.
    name, found, i = ("a1", along, 0) if along / most[0] >= across / most[1] else ("a2", across, 1)
    if along >= least[0] - ROUNDING or across >= least[1] - ROUNDING:
        if along >= most[0] - ROUNDING or across >= most[1] - ROUNDING:
            return
        least = (0.0, 0.0)
    direction = "along" if i == 0 else "across"
    what = f"holes of {where} from each other {direction} the grain"
    remedy = "move the holes apart"
    yield from _two_limits("AAG203", mark, what, found, table, (name, least[i]), (name, most[i]), remedy)


def _hole_sizes(gridshell: Gridshell, diameters: Diameters) -> Iterator[Finding]:
    """Yield AAG204: bolt holes wider than the bolt + 1 mm (10.4.3), screw holes than the shank (10.4.5), and slots."""
    for plank in (plank for shell in gridshell.shells for plank in shell.planks):
        for hole in plank.blank.holes:
            d, width = _diameter(hole, diameters), hole.diameter
            if hole.use == "bolt" and width > d + HOLE_PLAY + ROUNDING:
                what, remedy = "bolt hole wider than the bolt + 1 mm (EN 1995-1-1, 10.4.3)", "drill it narrower"
                yield Finding("AAG204", "error", plank.mark, what, width, d + HOLE_PLAY, "mm", remedy)
            if hole.use == "screw" and width > d + ROUNDING:
                what = "screw hole wider than the shank (EN 1995-1-1, 10.4.5)"
                remedy = "drill the shank's diameter, or count on the screws for withdrawal only"
                yield Finding("AAG204", "note", plank.mark, what, width, d, "mm", remedy)
            if hole.slot > 0.0:
                what, found = "slot longer than the bolt + 1 mm (EN 1995-1-1, 10.4.3)", width + hole.slot
                remedy = "count on the friction of tightened bolts, or fix the nodes by fitted bolts when formed"
                yield Finding("AAG204", "note", plank.mark, what, found, d + HOLE_PLAY, "mm", remedy)


def _alike(found: Iterable[Finding], noun: str, by_figure: bool = False) -> Iterator[Finding]:
    """Yield of findings that say the same the first that misses by most to 0.1 mm, with how many there are.

    ``by_figure``: only those count as the same that miss by the same 0.1 mm.
    """
    groups: dict[tuple[str, float], list[Finding]] = defaultdict(list)
    for item in found:
        groups[printed(item.what, "en"), round(item.found, 1) if by_figure else 0.0].append(item)
    for (what, _), items in groups.items():
        worst = max(items, key=lambda item: round(abs(item.found - item.allowed), 1))
        yield replace(worst, what=f"one of {len(items)} {noun} alike: {what}" if len(items) > 1 else what)


def _screws_in(gridshell: Gridshell) -> dict[str, list[Screw]]:
    """Return the screws of the joints of each coupling block."""
    index = index_of(gridshell)
    found: dict[str, list[Screw]] = defaultdict(list)
    for joint in all_joints(gridshell):
        for member in index.blocks.keys() & joint.members:
            found[member] += [index.screws[mark] for mark in joint.fasteners if mark in index.screws]
    return found


def _in_block(block: CouplingBlock, point: Floats) -> Floats:
    axes = np.array([block.frame.x, block.frame.y, block.frame.z])
    return np.asarray(axes @ (point - np.array(block.frame.origin)))


def _block_screw_rules(block: CouplingBlock, screw: Screw, bolt: float) -> Iterator[Finding]:
    """Yield what a screw driven into a block from its narrow face misses: end, face, and its point from the bolt."""
    head = np.array(screw.frame.origin)
    start, point = _in_block(block, head), _in_block(block, head + screw.length * np.array(screw.frame.z))
    if abs(start[1] - point[1]) < _ALONG * screw.length:
        return
    d, table = screw.diameter, table_of("screw", screw.diameter)
    along, across = screw_distances(d, 0.0), screw_distances(d, math.pi / 2.0)
    name = f"{d:g} mm screw in a {block.thickness:g} mm coupling block,"
    end, face = block.length / 2.0 - abs(start[0]), block.thickness / 2.0 - abs(start[2])
    limits = ("a3,c", along.a3_c), ("a3,t", along.a3_t)
    yield from _two_limits("AAG205", block.mark, f"{name} from its end", end, table, *limits, "take longer blocks")
    limits = ("a4,c", across.a4_c), ("a4,t", across.a4_t)
    thinner = f"take screws of at most {block.thickness / 6.0:g} mm or prove it by test"
    yield from _two_limits("AAG205", block.mark, f"{name} from the block's face", face, table, *limits, thinner)
    into = np.sign(point[1] - start[1])
    for hole in block.holes:
        ahead, beside = (hole.offset - point[1]) * into, abs(hole.station - point[0])
        clear = math.hypot(beside, ahead) if ahead > 0.0 else beside
        if clear < 4.0 * bolt - ROUNDING:
            what = f"{name} its point from the bolt across it (as a2 of {table_of('bolt', bolt)})"
            yield Finding("AAG205", "note", block.mark, what, float(clear), 4.0 * bolt, "mm", "take shorter screws")


def _blocks(gridshell: Gridshell, diameters: Diameters) -> Iterator[Finding]:
    """Yield AAG205: distances of bolts and screws in the coupling blocks, grain along the beam.

    Never an error: the gap between the planks gives the block's thickness, and the planks bolted to both its faces keep
    it from splitting; what the tables ask is to be replaced by a test.
    """
    screws = _screws_in(gridshell)
    for block in (block for shell in gridshell.shells for block in shell.blocks):
        found: list[Finding] = []
        for hole in block.holes:
            d = _diameter(hole, diameters)
            along, across, table = bolt_distances(d, 0.0), bolt_distances(d, math.pi / 2.0), table_of("bolt", d)
            end, edge = block.length / 2.0 - abs(hole.station), block.width / 2.0 - abs(hole.offset)
            limits = ("a3,c", along.a3_c), ("a3,t", along.a3_t)
            what = f"M{d:g} bolt in a coupling block of {block.length:g} mm, from its end"
            found += _two_limits("AAG205", block.mark, what, end, table, *limits, "take longer blocks")
            limits = ("a4,c", along.a4_c), ("a4,t", across.a4_t)
            what = f"M{d:g} bolt in a coupling block, from its edge"
            found += _two_limits("AAG205", block.mark, what, edge, table, *limits, "move it inwards")
        bolt = max((_diameter(hole, diameters) for hole in block.holes), default=0.0)
        for screw in screws[block.mark]:
            found += _block_screw_rules(block, screw, bolt)
        yield from (replace(item, severity="note" if item.severity == "note" else "warning") for item in found)


def _studs(gridshell: Gridshell, diameters: Diameters) -> Iterator[Finding]:
    """Yield AAG206: bolts in the studs, grain along the stud, forces across it; never an error.

    The nearest edge is that of the hexagon's flat through which the bolt passes: half its width.
    """
    for stud in (stud for shell in gridshell.shells for stud in shell.studs if stud.holes):
        d = diameters.get((stud.mark, "bolt"), stud.holes[0].diameter)
        rules = bolt_distances(d, math.pi / 2.0)
        end = stud.length / 2.0 - max(abs(hole.height) for hole in stud.holes)
        edge = stud.across_flats / (2.0 * math.sqrt(3.0))
        for found, clause, required, what in (
            (end, "a3,c", rules.a3_c, "from its end"),
            (edge, "a4,c", rules.a4_c, "from the edge of its flat"),
        ):
            if found < required - ROUNDING:
                text = f"M{d:g} bolt in a stud of {stud.across_flats:g} mm, {what} (EN 1995-1-1, table 8.4, {clause})"
                remedy = "prove the studs by test, or make them of plywood or steel"
                yield Finding("AAG206", "warning", stud.mark, text, found, required, "mm", remedy)


def _washers(gridshell: Gridshell) -> Iterator[Finding]:
    """Yield AAG207: washers narrower than 3 d or thinner than 0.3 d (EN 1995-1-1, 10.4.3)."""
    for bolt in index_of(gridshell).bolts.values():
        for name, found, share in (
            ("width", bolt.washer_diameter, WASHER_WIDTH),
            ("thickness", bolt.washer_thickness, WASHER_THICKNESS),
        ):
            required = share * bolt.diameter
            if found < required - ROUNDING:
                what = f"washer of M{bolt.diameter:g}, {name} ({share:g} d: EN 1995-1-1, 10.4.3)"
                remedy = "take washers for timber (ISO 7094)"
                yield Finding("AAG207", "warning", bolt.mark, what, found, required, "mm", remedy)


def shortfalls(gridshell: Gridshell) -> Iterator[Finding]:
    """Yield AAG201 to AAG207: where holes, fasteners and washers miss EN 1995-1-1, tables 8.2 and 8.4, and 10.4.3.

    AAG201 from the end, AAG202 from the edge, AAG203 from each other: the worst hole of each plank. AAG204 size of the
    hole, AAG205 in a coupling block, AAG206 in a stud, AAG207 washers. Like ones stand together under the first mark
    that misses by most; planks, if they miss by the same 0.1 mm.
    """
    diameters = _diameters(gridshell)
    for rule in (_plank_borders, _plank_spacing):
        planks = (plank for shell in gridshell.shells for plank in shell.planks)
        found = (item for plank in planks for item in rule(plank, diameters))
        yield from _alike(found, "planks", by_figure=True)
    yield from _alike(_hole_sizes(gridshell, diameters), "holes")
    yield from _alike(_blocks(gridshell, diameters), "blocks")
    yield from _alike(_studs(gridshell, diameters), "studs")
    yield from _alike(_washers(gridshell), "bolts")
