"""The segments in which a gridshell travels: its shells, cut along geodesics if they must be (paper section 3.2)."""

import math
from collections.abc import Iterable, Mapping

import numpy as np

from aag_cad.findings import Finding
from aag_cad.language import Text
from aag_cad.parts.forms import Frame
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import kind_of
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Gridshell
from aag_cad.units import Floats, vector
from assembly.base.segments import Limits, Pose, Segment, Segmentation, Splice
from assembly.transport.cut_pieces import Divisible, Stretch, cut_stops, divisible, stop_splices, stretch_between
from assembly.transport.findings import (
    cut_finding,
    hopeless_finding,
    lifting_finding,
    splice_finding,
    standing_finding,
    wish,
)
from assembly.transport.lifting import STIFF_GEODESICS, braces, lifting_points, standing_margin, standing_props
from assembly.transport.search import best_stops, pose_in, segment_ends


def _vault_pose(pose: Pose, placement: Frame) -> Pose:
    """Return a pose with its axes in vault coordinates; the up axis upwards, by turning it half about its length."""
    axes = np.array(pose.axes) @ frame_matrix(placement)[:3, :3].T
    if axes[2, 2] < 0.0:
        axes[1:] = -axes[1:]
    return Pose((vector(axes[0]), vector(axes[1]), vector(axes[2])), pose.size, pose.filling)


def _points(item: Divisible, stretch: Stretch, matrix: Floats) -> tuple[dict[str, Floats], dict[str, Floats]]:
    """Return the places (3,) of the studs of a stretch and of its coupling blocks, in vault coordinates."""
    own, shell = set(stretch.parts), item.shell
    studs = {stud.mark: np.array(stud.frame.origin) for stud in shell.studs if stud.mark in own}
    held = index_of(shell).blocks.keys() & own
    blocks = {joint.mark: np.array(joint.point) for joint in shell.joints if joint.mark in held and joint.kind == "AG"}
    turn, move = matrix[:3, :3], matrix[:3, 3]
    return ({m: turn @ p + move for m, p in studs.items()}, {m: turn @ p + move for m, p in blocks.items()})


def _feet(item: Divisible, stretch: Stretch, matrix: Floats) -> list[Floats]:
    """Return the feet of the geodesics of a stretch, (3,) each."""
    own = set(stretch.geodesics)
    joints = (joint for joint in item.shell.joints if joint.kind == "foot" and own & set(joint.members))
    return [matrix[:3, :3] @ np.array(joint.point) + matrix[:3, 3] for joint in joints]


def _rising(marks: Iterable[str], points: Mapping[str, Floats]) -> list[str]:
    return sorted(set(marks), key=lambda mark: (round(float(points[mark][2]), 3), mark))


def _columns(item: Divisible, start: int, end: int, studs: dict[str, Floats]) -> dict[int, list[str]]:
    """Return the studs of each bay of a stretch, from the lowest to the highest; bays from the first to the last."""
    grid, bays = item.grid, item.grid.bays(start, end)
    order = [grid.bay(bay) for bay in range(start // 2 - 1, end // 2 + 1)]
    found: dict[int, list[str]] = {bay: [] for bay in dict.fromkeys(order) if bay in bays}
    for member in grid.members:
        for place in index_of(item.shell).beams[member.mark].joints if not member.edge else ():
            if place.joint in studs:
                found[grid.bay(member.bay(place.station))].append(place.joint)
    return {bay: _rising(marks, studs) for bay, marks in found.items()}


def _outermost(
    item: Divisible, start: int, end: int, columns: Mapping[int, list[str]], blocks: dict[str, Floats]
) -> tuple[list[str], list[str]]:
    """Return the first and the last column of a stretch, each from the lowest to the highest joint.

    A column is the studs of a bay or the coupling blocks on a geodesic.
    """
    grid = item.grid
    placed = {2 * bay + 1: columns.get(grid.bay(bay), []) for bay in range(start // 2 - 1, end // 2 + 1)}
    for line in range((start + 1) // 2, (end + 1) // 2):
        geodesic = item.index.planks[grid.lines[grid.line(2 * line) - 1]]
        placed[2 * line] = _rising((place.joint for place in geodesic.joints if place.joint in blocks), blocks)
    filled = [placed[at] for at in sorted(placed) if len(placed[at]) > 1]
    return (filled[0], filled[-1]) if len(filled) > 1 else ([], [])


def _over(pose: Pose, stretch: Stretch, limits: Limits) -> tuple[float, float, float, float]:
    length, width, height = (size - room for size, room in zip(pose.size, limits.room, strict=True))
    return length, width, height, stretch.mass - limits.load


def _segment(
    item: Divisible, name: str, stops: tuple[int, int], stretch: Stretch, shell_pose: Pose, limits: Limits
) -> Segment:
    """Return the segment of a stretch between two stops, lying in a pose given in the coordinates of its shell."""
    shell, grid, (start, end) = item.shell, item.grid, stops
    matrix = frame_matrix(shell.placement)
    centre = matrix[:3, :3] @ stretch.centre + matrix[:3, 3]
    pose = _vault_pose(shell_pose, shell.placement)
    studs, blocks = _points(item, stretch, matrix)
    cuts = cut_stops(grid, start, end)
    sides = {grid.bay(start // 2): start % 2 == 0} if start in cuts else {}
    sides |= {grid.bay(end // 2 - 1): end % 2 == 1} if end in cuts else {}
    lifting = lifting_points(studs, centre)
    if not lifting.studs:
        lifting = lifting_points(studs | blocks, centre)
    feet = _feet(item, stretch, matrix)
    props = (standing_props(feet, studs, blocks, centre) or lifting.studs) if cuts else ()
    propped = [(studs | blocks)[mark] for mark in props]
    columns = _columns(item, start, end, studs)
    few = len(stretch.geodesics) < STIFF_GEODESICS
    ends = _outermost(item, start, end, columns, blocks) if few else ([], [])
    small = (mark for mark in stretch.parts if mark in item.small)
    steel = sum(item.masses[mark] for mark in small if kind_of(item.small[mark]).material == "steel")
    return Segment(
        name,
        shell.mark,
        stretch.geodesics,
        stretch.parts,
        stretch.pieces,
        stretch.mass,
        stretch.mass - steel,
        vector(centre),
        pose,
        _over(pose, stretch, limits),
        lifting,
        braces(studs | blocks, columns, sides, ends),
        props,
        standing_margin(feet, propped, centre) if cuts else math.inf,
    )


def _on_site(item: Divisible, segments: list[Segment], splices: list[Splice]) -> list[str]:
    """Return the fasteners, blocks and straps of a cut shell that belong to no segment, less what splices replace."""
    if len(segments) == 1:
        return []
    carried = {mark for segment in segments for mark in segment.parts}
    gone = carried | {mark for splice in splices for mark in splice.left_out} | item.fixed_on_site
    return [mark for mark in item.small if mark not in gone]


def segments(gridshell: Gridshell, limits: Limits) -> Segmentation:
    """Return the fewest segments that fit the transport, with fewest cut beams, then most even masses.

    Shells are divided along the ridges already; each is cut further along its geodesics if it must be. The choice of
    cuts is exact (``assembly.transport.partition``) for what was found to fit; size is that of the best pose found
    (``assembly.transport.loading``). Twins are searched once. PlanError for a shell without three
    geodesics.
    """
    made: list[Segment] = []
    splices: list[Splice] = []
    site: list[str] = []
    changes: list[Finding] = []
    problems: list[Finding] = []
    known: dict[str, tuple[tuple[int, ...] | None, Text | None]] = {}
    poses: dict[str, list[Pose]] = {}
    for shell in gridshell.shells:
        item, key = divisible(shell, gridshell.timber), index_of(gridshell).twins[shell.mark]
        if key not in known:
            stops = best_stops(item, limits)
            known[key] = stops, None if stops == () else wish(item, limits)
        stops, wished = known[key]
        ends = segment_ends(item, stops or ())
        stretches = [stretch_between(item, *pair) for pair in ends]
        if key not in poses:
            poses[key] = [pose_in(stretch, limits) for stretch in stretches]
        names = [shell.mark] if len(ends) == 1 else [f"{shell.mark}.{i}" for i in range(1, len(ends) + 1)]
        own = [_segment(item, *told, limits) for told in zip(names, ends, stretches, poses[key], strict=True)]
        cut = [splice for stop in stops or () for splice in stop_splices(item, stop)]
        made += own
        splices += cut
        site += _on_site(item, own, cut)
        if wished and stops is None:
            problems.append(hopeless_finding(item, limits, wished))
        elif wished and stops:
            changes.append(cut_finding(item, stops, limits, wished))
        found = (
            *(splice_finding(s) for s in cut),
            *(lifting_finding(s.name, s.lifting) for s in own),
            *(standing_finding(s) for s in own),
        )
        problems += [finding for finding in found if finding is not None]
    return Segmentation(limits, tuple(made), tuple(splices), tuple(site), tuple(changes), tuple(problems))


def segment_findings(segmentation: Segmentation) -> tuple[Finding, ...]:
    """Return what is found about segments: AAG961 shells that must be cut; what must change, AAG962 to 964 and 966."""
    return (*segmentation.changes, *segmentation.problems)
