"""Where the segments of a cut shell meet, in which order they stand on site, and what props each of them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Shell
from aag_cad.units import Floats
from assembly.graph import joint_of
from assembly.segments import Segment, Segmentation
from assembly.splices import Splice
from assembly.tracks import tracks

_HIGHEST = 16
_PLAY = 50.0


@dataclass(frozen=True)
class Seam:
    """Where two neighbouring segments meet: the geodesic of the cut line stays on one, the other has bare beam ends.

    ``fasteners`` are the parts of the shell that join the two segments and that neither carries.
    """

    keeper: str
    bare: str
    line: str
    splices: tuple[Splice, ...]
    fasteners: tuple[str, ...]

    @property
    def gap(self) -> float:
        """How far one segment is kept from the other before it is drawn in, mm: half a splice block and some play."""
        return max((splice.length for splice in self.splices), default=0.0) / 2.0 + _PLAY


def segments_of(segmentation: Segmentation | None, shell: str) -> tuple[Segment, ...]:
    """Return the segments of a shell from the first geodesic to the last; none if it travels whole."""
    own = tuple(segment for segment in segmentation.segments if segment.shell == shell) if segmentation else ()
    return own if len(own) > 1 else ()


def _neighbours(shell: Shell, own: Sequence[Segment]) -> list[tuple[Segment, Segment]]:
    pairs = list(zip(own, own[1:], strict=False))
    return [*pairs, (own[-1], own[0])] if tracks(shell).ring else pairs


def _meets(segment: Segment, joint: str, members: Sequence[str], stations: dict[tuple[str, str], float]) -> bool:
    """Return whether a segment has a member of a joint, whole or the piece on which the joint is."""
    pieces = [piece for piece in segment.pieces if piece.plank in members and (piece.plank, joint) in stations]
    on_piece = any(piece.start <= stations[piece.plank, joint] <= piece.end for piece in pieces)
    return on_piece or bool(set(members) & set(segment.parts))


def seams(shell: Shell, segmentation: Segmentation | None) -> tuple[Seam, ...]:
    """Return where the segments of a shell meet, from the first cut to the last; none if it travels whole."""
    own = segments_of(segmentation, shell.mark)
    if not own or segmentation is None:
        return ()
    joints = {joint.mark: joint for joint in shell.joints}
    stations = {(plank.mark, place.joint): place.station for plank in shell.planks for place in plank.joints}
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
        keeper, bare = (lower, upper) if line in lower.geodesics else (upper, lower)
        found.append(Seam(keeper.name, bare.name, line, cut, fasteners))
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
    """Return when a segment stands that is some places away from the first one: nearer ones before, upper ones first."""
    around = (away + count // 2) % count - count // 2 if ring else away
    return abs(around), -around


def margin_inside(plan: Floats, point: Floats) -> float:
    """Return how far inside the convex hull of points (n, 2) a point (2,) is, mm; negative outside."""
    try:
        sides = ConvexHull(plan).equations
    except QhullError:
        return -np.inf
    return float(-(sides[:, :2] @ point + sides[:, 2]).max())


def foot_joints(shell: Shell, segment: Segment) -> tuple[str, ...]:
    """Return the foot joints of the geodesics of a segment."""
    own = set(segment.geodesics)
    return tuple(joint.mark for joint in shell.joints if joint.kind == "foot" and own & set(joint.members))


def segment_props(shell: Shell, segment: Segment) -> tuple[str, ...]:
    """Return two studs under which props hold a segment on its feet, best of its sixteen highest.

    Its plumb line runs inside feet and props in plan, with most margin. A segment without feet stands on props at
    the studs that it is slung by.
    """
    matrix = frame_matrix(shell.placement)

    def placed(point: Sequence[float]) -> Floats:
        return np.asarray(matrix[:3, :3] @ np.array(point) + matrix[:3, 3])

    points = {joint.mark: placed(joint.point) for joint in shell.joints}
    feet = [points[mark][:2] for mark in foot_joints(shell, segment)]
    own = set(segment.parts)
    studs = {stud.mark: placed(stud.frame.origin) for stud in shell.studs if stud.mark in own}
    highest = sorted(studs, key=lambda mark: (-round(float(studs[mark][2])), mark))[:_HIGHEST]
    if not feet or len(highest) < 2:
        return segment.lifting.studs
    centre = np.array(segment.centre[:2])

    def worth(pair: tuple[str, ...]) -> tuple[float, float]:
        plan = np.array([*feet, *(studs[mark][:2] for mark in pair)])
        return round(margin_inside(plan, centre)), sum(float(studs[mark][2]) for mark in pair)

    return max(combinations(highest, 2), key=worth)
