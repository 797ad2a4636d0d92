"""Where the segments of a cut shell meet, and in which order they stand on site."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from aag_cad.parts.index import index_of
from aag_cad.parts.marks import joint_of
from aag_cad.parts.model import FlatBar, Shell
from assembly.base.segments import Segment, Segmentation, Splice, segments_of
from assembly.graph.cut_lines import cut_lines

_PLAY = 50.0
_STEP = 50.0
_SAMPLES = 65


@dataclass(frozen=True)
class Seam:
    """Where two neighbouring segments meet: the geodesic of the cut line stays on one, the other has bare beam ends.

    ``fasteners`` are the parts of the shell that join the two segments and that neither carries. ``reach`` is how far
    one segment goes past the line into the other, mm: half of the geodesic, edge planks, and beam ends that stay whole.
    """

    keeper: str
    bare: str
    line: str
    splices: tuple[Splice, ...]
    fasteners: tuple[str, ...]
    reach: float

    @property
    def gap(self) -> float:
        """How far from the other one segment is let down before it is drawn in, mm, in round figures."""
        return _STEP * math.ceil((self.reach + _PLAY) / _STEP)


def _neighbours(shell: Shell, own: Sequence[Segment]) -> list[tuple[Segment, Segment]]:
    pairs = list(pairwise(own))
    return [*pairs, (own[-1], own[0])] if cut_lines(shell).ring else pairs


def _meets(segment: Segment, joint: str, members: Sequence[str], stations: dict[tuple[str, str], float]) -> bool:
    """Return whether a segment has a member of a joint, whole or the piece on which the joint is."""
    pieces = [piece for piece in segment.pieces if piece.plank in members and (piece.plank, joint) in stations]
    on_piece = any(piece.start <= stations[piece.plank, joint] <= piece.end for piece in pieces)
    return on_piece or bool(set(members) & set(segment.parts))


def _reach(
    shell: Shell, line: str, cut: Sequence[Splice], fasteners: Sequence[str], stations: dict[tuple[str, str], float]
) -> float:
    """Return how far the two sides of a cut go past its line, mm."""
    planks = index_of(shell).planks
    geodesic = planks[line]
    middle = geodesic.curve.point_spline(np.linspace(0.0, geodesic.curve.length, _SAMPLES))
    found = [geodesic.blank.section.width / 2.0]
    for splice in (splice for splice in cut if splice.kind == "plate"):
        end = planks[splice.member].curve.point_spline(splice.cuts[0].station)
        found.append(float(np.linalg.norm(middle - end, axis=1).min()))
    spliced, joints = {splice.joint for splice in cut}, index_of(shell).joints
    for joint in (joints[mark] for mark in dict.fromkeys(map(joint_of, fasteners)) if mark not in spliced):
        ends: list[FlatBar] = [planks[mark] for mark in joint.members if mark in planks and planks[mark].upright]
        at = [(stations[plank.mark, joint.mark], plank.blank.length) for plank in ends]
        found += [min(station, length - station) for station, length in at]
    return max(found)


def seams(shell: Shell, segmentation: Segmentation | None) -> tuple[Seam, ...]:
    """Return where the segments of a shell meet, from the first cut to the last; none if it travels whole."""
    own = segments_of(segmentation, shell.mark)
    if not own or segmentation is None:
        return ()
    joints = index_of(shell).joints
    stations = index_of(shell).stations
    left = [mark for mark in segmentation.site if joint_of(mark) in joints]
    found = []
    for lower, upper in _neighbours(shell, own):
        lines = (lower.geodesics[-1], upper.geodesics[0])
        cut = tuple(splice for splice in segmentation.splices if splice.line in lines)
        line = cut[0].line if cut else lines[0]
        fasteners = tuple(
            mark
            for mark in left
            if all(_meets(s, joint_of(mark), joints[joint_of(mark)].members, stations) for s in (lower, upper))
        )
        left = [mark for mark in left if mark not in fasteners]
        reach = _reach(shell, line, cut, fasteners, stations)
        keeper, bare = (lower, upper) if line in lower.geodesics else (upper, lower)
        found.append(Seam(keeper.name, bare.name, line, cut, fasteners, reach))
    return tuple(found)


def standing_order(shell: Shell, segmentation: Segmentation | None) -> Iterator[tuple[Segment, tuple[Seam, ...]]]:
    """Yield the segments of a cut shell as they stand on site, each with its seams to those that stand already.

    First the one with the highest centre of gravity, under the crown: its props hold the height that all others follow,
    and what is out of true is shared by both sides. Then its neighbours, in turn on either side, so that each segment
    is drawn in beside one that stands.
    """
    own, joined = list(segments_of(segmentation, shell.mark)), seams(shell, segmentation)
    if not own:
        return
    start = max(range(len(own)), key=lambda i: (round(own[i].centre[2]), -i))
    ring = len(joined) == len(own)
    stood: set[str] = set()
    for i in sorted(range(len(own)), key=lambda i: _turn(i - start, len(own), ring)):
        segment = own[i]
        with_ = tuple(seam for seam in joined if segment.name in (seam.keeper, seam.bare))
        yield segment, tuple(seam for seam in with_ if {seam.keeper, seam.bare} - {segment.name} <= stood)
        stood.add(segment.name)


def _turn(away: int, count: int, ring: bool) -> tuple[int, int]:
    """Return when a segment stands that is some places from the first one: nearer ones before, upper ones first."""
    around = (away + count // 2) % count - count // 2 if ring else away
    return abs(around), -around


def foot_joints(shell: Shell, segment: Segment) -> tuple[str, ...]:
    """Return the foot joints of the geodesics of a segment."""
    own = set(segment.geodesics)
    return tuple(joint.mark for joint in shell.joints if joint.kind == "foot" and own & set(joint.members))
