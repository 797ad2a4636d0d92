"""The segments in which a gridshell travels: its shells, cut along geodesics if they must be (paper section 3.2)."""

import math
from dataclasses import dataclass

import numpy as np

from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Frame, Gridshell, Shell
from aag_cad.parts.products import product_key
from aag_cad.parts.quantities import material
from aag_cad.units import Floats, Vector, vector
from assembly.boxes import Pose
from assembly.lifting import LEAST_MARGIN, Brace, Lifting, braces, lifting_points
from assembly.runs import Divisible, PlankPiece, Run, cut_stops, divisible, run_between, run_splices
from assembly.segment_search import Limits, best_stops, least_widths, pose_in, segment_ends, smallest_runs
from assembly.splices import Splice

_ROUNDING = 1e-9
_UP_TO = 10.0


@dataclass(frozen=True)
class Segment:
    """What travels in one piece, without shoes, rods, blocks, cover and blades: those are fixed on site.

    ``parts`` are the marks of whole parts, ``pieces`` what it has of cut planks, ``splices`` the beams and joints whose
    splice blocks stay on it. ``mass`` in kg, without bracing; ``timber`` of it is timber; ``centre`` of gravity and the
    axes of ``pose`` are in vault coordinates, mm. ``over`` is what length, width, height (mm) and mass (kg) exceed the
    transport by, negative where there is room.
    """

    name: str
    shell: str
    geodesics: tuple[str, ...]
    parts: tuple[str, ...]
    pieces: tuple[PlankPiece, ...]
    splices: tuple[tuple[str, str], ...]
    mass: float
    timber: float
    centre: Vector
    pose: Pose
    over: tuple[float, float, float, float]
    lifting: Lifting
    braces: tuple[Brace, ...]

    @property
    def fits(self) -> bool:
        """Whether the segment fits the transport."""
        return self.pose.filling <= 1.0 + _ROUNDING and self.over[3] <= 0.0

    @property
    def tilt(self) -> float:
        """The angle by which the segment is turned over for transport, from standing as in the vault, radians."""
        return math.acos(min(1.0, max(-1.0, self.pose.axes[2][2])))


@dataclass(frozen=True)
class Segmentation:
    """How a gridshell is divided: segments, splices, and the fasteners put in on site because they join segments.

    ``changes`` say what a shell that is cut would need to travel whole, ``problems`` what must change because it cannot
    be cut, slung or spliced so.
    """

    limits: Limits
    segments: tuple[Segment, ...]
    splices: tuple[Splice, ...]
    site: tuple[str, ...]
    changes: tuple[str, ...]
    problems: tuple[str, ...]


def _numbers(limits: Limits) -> str:
    return f"{limits.length:g} x {limits.width:g} x {limits.height:g} mm and {limits.load:g} kg"


def _box(pose: Pose) -> str:
    return " x ".join(f"{size:.0f}" for size in pose.size) + " mm"


def _vault_pose(pose: Pose, placement: Frame) -> Pose:
    """Return a pose with its axes in vault coordinates; the up axis upwards, by turning it half about its length."""
    axes = np.array(pose.axes) @ frame_matrix(placement)[:3, :3].T
    if axes[2, 2] < 0.0:
        axes[1:] = -axes[1:]
    return Pose((vector(axes[0]), vector(axes[1]), vector(axes[2])), pose.size, pose.filling)


def _stud_points(item: Divisible, run: Run, matrix: Floats) -> dict[str, Floats]:
    own = set(run.parts)
    return {
        stud.mark: matrix[:3, :3] @ np.array(stud.frame.origin) + matrix[:3, 3]
        for stud in item.shell.studs
        if stud.mark in own
    }


def _columns(item: Divisible, start: int, end: int, studs: dict[str, Floats]) -> dict[int, list[str]]:
    """Return the studs of each bay of a run, from the lowest to the highest; bays from the first to the last."""
    grid, bays = item.tracks, item.tracks.bays(start, end)
    order = [grid.bay(bay) for bay in range(start // 2 - 1, end // 2 + 1)]
    found: dict[int, list[str]] = {bay: [] for bay in dict.fromkeys(order) if bay in bays}
    for track in grid.members:
        for place in item.beams[track.mark].joints if not track.edge else ():
            if place.joint in studs:
                found[grid.bay(track.bay(place.station))].append(place.joint)
    return {bay: sorted(set(marks), key=lambda m: (round(float(studs[m][2]), 3), m)) for bay, marks in found.items()}


def _over(pose: Pose, run: Run, limits: Limits) -> tuple[float, float, float, float]:
    length, width, height = (size - room for size, room in zip(pose.size, limits.room, strict=True))
    return length, width, height, run.mass - limits.load


def _segment(item: Divisible, name: str, start: int, end: int, limits: Limits) -> Segment:
    shell, grid, run = item.shell, item.tracks, run_between(item, start, end)
    matrix = frame_matrix(shell.placement)
    centre = matrix[:3, :3] @ run.centre + matrix[:3, 3]
    pose = _vault_pose(pose_in(run, limits), shell.placement)
    studs = _stud_points(item, run, matrix)
    cuts = cut_stops(grid, start, end)
    sides = {grid.bay(start // 2): start % 2 == 0} if start in cuts else {}
    sides |= {grid.bay(end // 2 - 1): end % 2 == 1} if end in cuts else {}
    steel = sum(item.masses[mark] for mark in run.parts if mark in item.small and material(item.small[mark]) == "steel")
    return Segment(
        name,
        shell.mark,
        run.geodesics,
        run.parts,
        run.pieces,
        run.splices,
        run.mass,
        run.mass - steel,
        vector(centre),
        pose,
        _over(pose, run, limits),
        lifting_points(studs, centre),
        braces(studs, _columns(item, start, end, studs), sides, len(run.geodesics)),
    )


def _whole_run(item: Divisible) -> Run:
    return run_between(item, *segment_ends(item, ())[0])


def _up(size: float) -> float:
    return _UP_TO * math.ceil(size / _UP_TO)


def _wish(item: Divisible, limits: Limits) -> str:
    """Return what would let a shell travel whole."""
    run = _whole_run(item)
    load = f"a load of {math.ceil(run.mass)} kg"
    if pose_in(run, limits, 1.0).filling <= 1.0 + _ROUNDING:
        return load
    words = [
        f"transport.{key} = {_up(size):.0f}"
        for key, size in zip(("width", "height"), least_widths(run, limits), strict=True)
        if size is not None
    ]
    if not words:
        pose = pose_in(run, limits)
        words = [f"a transport of {' x '.join(f'{_up(size):.0f}' for size in pose.size)} mm"]
    wish = " or ".join(words)
    return f"{wish} and {load}" if run.mass > limits.load else wish


def _cut_words(item: Divisible, stops: tuple[int, ...], limits: Limits, wish: str) -> str:
    """Return which cuts a shell needs, and what would spare them."""
    beams = sum(splice.kind == "block" for stop in stops for splice in run_splices(item, stop))
    along = ", ".join(item.tracks.lines[item.tracks.line(stop) - 1] for stop in stops)
    return (
        f"{item.shell.mark}: does not fit {_numbers(limits)} whole; it is cut into "
        f"{len(segment_ends(item, stops))} along {along}, {beams} beams spliced; it travels whole with {wish}"
    )


def _hopeless(item: Divisible, limits: Limits, wish: str) -> str:
    """Return why no cuts along geodesics will do, by the best of all runs of a single geodesic that do not fit."""
    best_of: dict[str, tuple[float, str]] = {}
    for ends in smallest_runs(item):
        run = run_between(item, *ends)
        pose = pose_in(run, limits, 1.0)
        words = f"{run.geodesics[0]} alone with the beams beside it takes {_box(pose)} and {run.mass:.0f} kg"
        filling = max(pose.filling, run.mass / limits.load)
        best_of[run.geodesics[0]] = min(best_of.get(run.geodesics[0], (math.inf, "")), (filling, words))
    worst = max(best_of.values())
    return (
        f"{item.shell.mark}: no cuts along its geodesics make it fit {_numbers(limits)}: {worst[1]}; it travels "
        f"whole with {wish}, or as single beams and planks"
    )


def _segment_problems(segment: Segment) -> list[str]:
    found = []
    if not segment.lifting.studs:
        found.append(
            f"{segment.name}: no three studs stand {LEAST_MARGIN:.0f} mm or more around its centre of gravity; "
            "sling it by its beams under a spreader"
        )
    return found


def _shape_key(shell: Shell) -> tuple[str, ...]:
    """Return what shells that are cut alike have in common: equal planks at equal joints."""
    return (*(product_key(plank) for plank in shell.planks), *(f"{joint.kind}{joint.point}" for joint in shell.joints))


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
    cuts is exact (``assembly.partition``) for what was found to fit; size is that of the best pose found
    (``assembly.boxes``). Shells of equal shape are searched once. PlanError for a shell without three geodesics.
    """
    made: list[Segment] = []
    splices: list[Splice] = []
    site: list[str] = []
    changes: list[str] = []
    problems: list[str] = []
    known: dict[tuple[str, ...], tuple[tuple[int, ...] | None, str]] = {}
    for shell in gridshell.shells:
        item, key = divisible(shell, gridshell.timber), _shape_key(shell)
        if key not in known:
            stops = best_stops(item, limits)
            known[key] = stops, "" if stops == () else _wish(item, limits)
        stops, wish = known[key]
        ends = segment_ends(item, stops or ())
        names = [shell.mark] if len(ends) == 1 else [f"{shell.mark}.{i}" for i in range(1, len(ends) + 1)]
        own = [_segment(item, name, *pair, limits) for name, pair in zip(names, ends, strict=True)]
        cut = [splice for stop in stops or () for splice in run_splices(item, stop)]
        made += own
        splices += cut
        site += _on_site(item, own, cut)
        if stops is None:
            problems.append(_hopeless(item, limits, wish))
        elif stops:
            changes.append(_cut_words(item, stops, limits, wish))
        problems += [splice.problem for splice in cut if splice.problem]
        problems += [problem for segment in own for problem in _segment_problems(segment)]
    return Segmentation(limits, tuple(made), tuple(splices), tuple(site), tuple(changes), tuple(problems))
