"""What is found when a gridshell is cut for transport: what would spare a cut, what cannot be cut, slung or spliced."""

import math
from collections.abc import Sequence

from aag_cad.findings import Finding, Severity
from aag_cad.language import Figure, Text, text
from aag_cad.parts.marks import short_mark
from assembly.base.segments import Lifting, Limits, Pose, Segment, Splice
from assembly.transport.cut_pieces import (
    Divisible,
    Stretch,
    stop_splices,
    stretch_between,
)
from assembly.transport.lifting import LEAST_MARGIN
from assembly.transport.search import least_widths, pose_in, segment_ends, smallest_runs

_ROUNDING = 1e-9
_UP_TO = 10.0
# Without three feet or props there is no plumb line inside them.
_FAR = 1e4
_AXES = ("length", "width", "height", "mass")


def _words(key: str, **figures: Figure) -> Text:
    return text(f"segments.finding.{key}", **figures)


def _limits(limits: Limits) -> Text:
    room = {"length": limits.length, "width": limits.width, "height": limits.height, "load": limits.load}
    return _words("limits" if math.isfinite(limits.load) else "limits_room", **room)


def _up(size: float) -> float:
    return _UP_TO * math.ceil(size / _UP_TO)


def _sizes(sizes: Sequence[float]) -> str:
    return " x ".join(f"{size:.0f}" for size in sizes)


def _worst(pose: Pose, mass: float, limits: Limits) -> tuple[str, float, float, str]:
    """Return in what a stretch exceeds a transport most: length, width, height or mass, with found, allowed, unit."""
    found, allowed = (*pose.size, mass), (*limits.room, limits.load)
    i = max(range(len(_AXES)), key=lambda i: found[i] / allowed[i])
    return _AXES[i], found[i], allowed[i], "kg" if _AXES[i] == "mass" else "mm"


def _finding(
    code: str, severity: Severity, mark: str, worst: tuple[str, float, float, str], what: Text, remedy: Text
) -> Finding:
    _, found, allowed, unit = worst
    return Finding(code, severity, mark, what, found, allowed, unit, remedy)


def whole_stretch(item: Divisible) -> Stretch:
    """Return a shell as it travels whole."""
    return stretch_between(item, *segment_ends(item, ())[0])


def wish(item: Divisible, limits: Limits) -> Text:
    """Return what would let a shell travel whole: a width or a height, a larger transport, a load."""
    stretch = whole_stretch(item)
    load = _words("load", mass=math.ceil(stretch.mass))
    if pose_in(stretch, limits, 1.0).filling <= 1.0 + _ROUNDING:
        return load
    sizes = [
        _words("axis", side=key, size=f"{_up(size):.0f}")
        for key, size in zip(("width", "height"), least_widths(stretch, limits), strict=True)
        if size is not None
    ]
    if not sizes:
        sizes = [_words("room", sizes=_sizes([_up(size) for size in pose_in(stretch, limits).size]))]
    room = _words("either", sizes=tuple(sizes))
    return _words("both", room=room, load=load) if stretch.mass > limits.load else room


def cut_finding(item: Divisible, stops: tuple[int, ...], limits: Limits, wished: Text) -> Finding:
    """Return which cuts a shell needs, and what would spare them (AAG961)."""
    beams = sum(splice.kind == "block" for stop in stops for splice in stop_splices(item, stop))
    lines = ", ".join(short_mark(item.grid.lines[item.grid.line(stop) - 1]) for stop in stops)
    stretch = whole_stretch(item)
    worst = _worst(pose_in(stretch, limits), stretch.mass, limits)
    remedy = _words(
        "cut",
        limits=_limits(limits),
        count=len(segment_ends(item, stops)),
        lines=lines,
        beams=beams,
        wish=wished,
    )
    return _finding("AAG961", "warning", item.shell.mark, worst, _words(worst[0]), remedy)


def hopeless_finding(item: Divisible, limits: Limits, wished: Text) -> Finding:
    """Return why no cuts along geodesics will do (AAG962): the geodesic that alone, cut as well as can be, is worst."""
    best_of: dict[str, tuple[float, Stretch, Pose]] = {}
    for ends in smallest_runs(item):
        stretch = stretch_between(item, *ends)
        pose = pose_in(stretch, limits, 1.0)
        filling = max(pose.filling, stretch.mass / limits.load)
        if filling < best_of.get(stretch.geodesics[0], (math.inf,))[0]:
            best_of[stretch.geodesics[0]] = filling, stretch, pose
    _, stretch, pose = max(best_of.values(), key=lambda best: best[0])
    box = _words("box", sizes=_sizes(pose.size))
    told = _words("worst", mass=f"{stretch.mass:.0f}", geodesic=short_mark(stretch.geodesics[0]), box=box)
    remedy = _words("hopeless", limits=_limits(limits), worst=told, wish=wished)
    worst = _worst(pose, stretch.mass, limits)
    return _finding("AAG962", "error", item.shell.mark, worst, _words(worst[0]), remedy)


def lifting_finding(segment: str, lifting: Lifting) -> Finding | None:
    """Return that a segment cannot be slung by three joints (AAG963, a warning: a spreader helps), None if it can."""
    if lifting.studs:
        return None
    found = max(lifting.margin, 0.0)
    what, remedy = _words("sling"), _words("sling_remedy")
    return Finding("AAG963", "warning", segment, what, found, LEAST_MARGIN, "mm", remedy)


def splice_finding(splice: Splice) -> Finding | None:
    """Return that a splice does not keep its distances (AAG964), None if it does."""
    if splice.fits:
        return None
    near = splice.clear < splice.required
    found, allowed = (splice.clear, splice.required) if near else (splice.room, splice.reach)
    kind = "edge" if splice.kind == "plate" else "hole" if near else "part"
    joint = short_mark(splice.joint) if splice.joint else ""
    what = _words(f"next_{kind}", joint=joint, line=short_mark(splice.line))
    remedy = _words("edge_remedy" if splice.kind == "plate" else "beam_remedy")
    return Finding("AAG964", "error", splice.member, what, found, allowed, "mm", remedy)


def standing_finding(segment: Segment) -> Finding | None:
    """Return that a segment of a cut shell tips on its feet and props (AAG966, an error), None if these hold it."""
    if segment.standing_margin > 0.0:
        return None
    found = max(segment.standing_margin, -_FAR)
    what, remedy = _words("tips"), _words("tips_remedy", x=segment.centre[0], y=segment.centre[1])
    return Finding("AAG966", "error", segment.name, what, found, 0.0, "mm", remedy)
