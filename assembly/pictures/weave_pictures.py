"""Pictures of any graph of parts on the floor, seen from above: planks as strips, the upper one over the lower one."""

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import networkx as nx
import numpy as np

from aag_cad.units import Floats
from assembly.base.shell_axes import floor_view
from assembly.base.steps import Step
from assembly.drawing.svg import (
    Label,
    Style,
    circle,
    group,
    label_svg,
    line,
    path,
    placed_labels,
    places_along,
    polylines,
    svg,
)
from assembly.graph.interlacing import Interlacing, Slide
from assembly.graph.laying_units import Unit, is_laid, joint_name, upper_of
from assembly.laying.joining import joint_points
from assembly.pictures.step_pictures import DOT, LABEL_SIZE, LATER, NEW, RING, THERE, slide_arrow, start_triangle

_WIDTH, _HEIGHT, _MARGIN = 1800.0, 2300.0, 80.0
# A plank without a width, or too slender for this scale, is drawn as wide as a heavy line.
_THIN = 11.0
_MOST_NAMES = 40
# On a larger plan the grey of what is laid already would make every step as heavy as the whole.
_MOST_LAID = 400
# A crossing at a sharper angle is drawn no longer than this many times the width of its planks.
_LONGEST = 3.0
_SHARES = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8)
_INK = Style("#000")
_AXIS = Style("none", "#000", 4.0)


@dataclass(frozen=True, eq=False)
class Floor:
    """A graph of parts on a sheet, y down; places on the floor count from its corner, mm.

    ``strips`` (4, 2) are its planks by mark, ``lines`` (2, 2) its units, ``points`` (2,) its joints; ``crossings`` are
    a piece of the upper plank over each crossing: (lower, upper, strip). ``ends`` (2, 2) are the units' ends in mm.
    """

    width: float
    height: float
    origin: Floats
    units: Mapping[str, Unit]
    planks: Mapping[str, str]
    strips: Mapping[str, Floats]
    lines: Mapping[str, Floats]
    points: Mapping[str, Floats]
    ends: Mapping[str, Floats]
    crossings: Sequence[tuple[str, str, Floats]]
    joints: Mapping[str, tuple[str, ...]]
    slides: Mapping[str, Slide]


def _strip(ends: Floats, width: float) -> Floats:
    """Return the outline (4, 2) of a strip along a line (2, 2): its long sides are the first two and the last two."""
    along = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    across = width / 2.0 * np.array([-along[1], along[0]])
    return np.array([ends[0] + across, ends[1] + across, ends[1] - across, ends[0] - across])


def _over(lower: Floats, upper: Floats, widths: tuple[float, float]) -> Floats | None:
    """Return the piece of the upper of two lines (2, 2) over the lower one, as a strip; None if they are apart."""
    runs = lower[1] - lower[0], upper[1] - upper[0]
    lengths = [float(np.linalg.norm(run)) for run in runs]
    turn = float(runs[0][0] * runs[1][1] - runs[0][1] * runs[1][0])
    sine = abs(turn) / (lengths[0] * lengths[1])
    if sine < 0.05:
        return None
    gap = upper[0] - lower[0]
    shares = np.array([gap[0] * runs[1][1] - gap[1] * runs[1][0], gap[0] * runs[0][1] - gap[1] * runs[0][0]]) / turn
    if np.any(shares < -0.05) or np.any(shares > 1.05):
        return None
    cosine = abs(float(runs[0] @ runs[1])) / (lengths[0] * lengths[1])
    half = min((widths[0] + widths[1] * cosine) / (2.0 * sine), _LONGEST * sum(widths)) + 2.0
    low, high = np.clip([shares[1] - half / lengths[1], shares[1] + half / lengths[1]], 0.0, 1.0)
    return _strip(np.array([upper[0] + low * runs[1], upper[0] + high * runs[1]]), widths[1])


def floor_of(graph: "nx.MultiGraph[str]", units: Mapping[str, Unit], woven: Interlacing) -> Floor:
    """Return a graph of parts as it lies on the floor, with its interlacing (``later`` nothing)."""
    laid = {mark: node for mark, node in graph.nodes(data=True) if is_laid(node)}
    joints, tied = defaultdict[str, dict[str, None]](dict), defaultdict[str, dict[str, None]](dict)
    for a, b, key, edge in graph.edges(keys=True, data=True):
        for end in sorted((a, b)):
            joints[joint_name(a, b, key, edge)][end] = tied[end][joint_name(a, b, key, edge)] = None
    at = joint_points(graph, joints, units, woven.overlaps)
    raw = {mark: np.array([node["start"], node["end"]], dtype=np.float64) for mark, node in laid.items()}
    everything = np.concatenate([*raw.values(), np.array(list(at.values())).reshape(-1, 3)])
    view = floor_view(np.concatenate(list(raw.values())) if raw else everything)
    flat = view(everything)[:, :2]
    low, size = flat.min(axis=0), np.ptp(flat, axis=0)
    room = np.array([_WIDTH, _HEIGHT]) - 2.0 * _MARGIN
    scale = float((room / np.maximum(size, 1.0)).min())
    height = float(size[1]) * scale + 2.0 * _MARGIN
    origin = np.array([_MARGIN + (room[0] - size[0] * scale) / 2.0, height - _MARGIN])

    def on_sheet(points: Floats) -> Floats:
        return np.asarray(origin + (view(points)[:, :2] - low) * [scale, -scale])

    lines = {mark: on_sheet(ends) for mark, ends in raw.items()}
    widths = {mark: max(_THIN, scale * float(node.get("width_mm") or 0.0)) for mark, node in laid.items()}
    ends = {mark: np.array([unit.start, unit.end]) for mark, unit in units.items()}
    return Floor(
        width=_WIDTH,
        height=height,
        origin=origin,
        units=units,
        planks={part: mark for mark, unit in units.items() for part in unit.parts},
        strips={mark: _strip(lines[mark], widths[mark]) for mark in sorted(laid)},
        lines={mark: on_sheet(found) for mark, found in ends.items()},
        points={joint: on_sheet(np.array([place]))[0] for joint, place in at.items()},
        ends={mark: view(found)[:, :2] - low for mark, found in ends.items()},
        crossings=tuple(_crossings(graph, laid, lines, widths)),
        joints={
            mark: tuple(dict.fromkeys(joint_name(*e) for e in graph.edges(mark, keys=True, data=True)))
            for mark in graph
        },
        slides={slide.unit: slide for slide in woven.slides},
    )


def _crossings(
    graph: "nx.MultiGraph[str]",
    laid: Mapping[str, dict[str, Any]],
    lines: Mapping[str, Floats],
    widths: Mapping[str, float],
) -> Iterator[tuple[str, str, Floats]]:
    """Yield the lower plank, the upper one and the piece of it that covers the crossing, the lowest layers first."""
    pairs = []
    for a, b, edge in graph.edges(data=True):
        if edge["kind"] == "crossing" and (upper := upper_of(graph, a, b, edge)):
            pairs.append((b if upper == a else a, upper))
    for lower, upper in sorted(pairs, key=lambda pair: (laid[pair[1]].get("layer") or 0, pair[1], pair[0])):
        piece = _over(lines[lower], lines[upper], (widths[lower], widths[upper]))
        if piece is not None:
            yield lower, upper, piece


def _style(unit: Unit, new: bool) -> Style:
    return NEW.get(unit.family, NEW["G"]) if new else THERE


def _planks(floor: Floor, there: Collection[str], new: Collection[str]) -> Iterator[str]:
    """Yield planks of units as strips, the ``new`` ones heavy, and over each crossing the piece of the upper one."""
    shown = {*there, *new}
    for units, fresh in ((there, False), (new, True)):
        for unit in units:
            yield group(
                (path(floor.strips[part]) for part in floor.units[unit].parts), _style(floor.units[unit], fresh)
            )
    for lower, upper, strip in floor.crossings:
        below, above = floor.planks[lower], floor.planks[upper]
        if below in shown and above in shown and below != above:
            style = _style(floor.units[above], above in new)
            yield group([path(strip)], Style(style.fill))
            yield group([polylines([strip[:2], strip[2:]])], Style("none", style.stroke, style.width))


def _names(floor: Floor, units: Sequence[str]) -> str:
    wanted = [(mark, places_along(floor.lines[mark], _SHARES)) for mark in units]
    return label_svg(placed_labels(wanted, LABEL_SIZE, (0.0, 0.0, floor.width, floor.height)))


def cover_svg(floor: Floor) -> str:
    """Return the whole as it lies in the end."""
    return svg(floor.width, floor.height, _planks(floor, (), list(floor.units)))


def map_svg(floor: Floor) -> str:
    """Return the whole with the marks of its units, their start ends, and the corner that coordinates count from."""
    x, y = floor.origin.tolist()
    corner = [line(np.array([(x, y), end]), _AXIS) for end in ((x + 90.0, y), (x, y - 90.0))]
    names = [
        Label("0, 0", x + 30.0, y + 34.0, LABEL_SIZE),
        Label("x", x + 112.0, y, LABEL_SIZE),
        Label("y", x, y - 112.0, LABEL_SIZE),
    ]
    starts = (path(start_triangle(floor.lines[mark])) for mark in floor.units)
    items = [*_planks(floor, list(floor.units), ()), group(starts, _INK), *corner, label_svg(names, framed=False)]
    return svg(floor.width, floor.height, [*items, _names(floor, list(floor.units))])


def joints_of_step(floor: Floor, step: Step) -> tuple[str, ...]:
    """Return the joints at which a step puts parts in, where it lays nothing."""
    if any(mark in floor.planks for mark in step.marks):
        return ()
    return tuple(dict.fromkeys(joint for mark in step.marks for joint in floor.joints[mark]))


def units_of_step(floor: Floor, step: Step) -> tuple[str, ...]:
    """Return the units that a step lays or slides in, in their order."""
    return tuple(dict.fromkeys(floor.planks[mark] for mark in step.marks if mark in floor.planks))


def floor_svg(floor: Floor, step: Step, there: Sequence[str]) -> str:
    """Return the floor with what a step lays, slides in or joins; ``there`` are the units that lie already."""
    own = units_of_step(floor, step)
    slides = [floor.slides[mark] for mark in own if mark in floor.slides]
    laid = there if len(floor.units) <= _MOST_LAID else ()
    items = [
        group([polylines(floor.lines.values())], LATER),
        *_planks(floor, laid, own),
        group((path(start_triangle(floor.lines[mark])) for mark in own), _INK),
        group((circle(floor.points[joint], 11.0) for slide in slides for joint in slide.joints), RING),
        group((circle(floor.points[joint], 10.0) for joint in joints_of_step(floor, step)), DOT),
        *(slide_arrow(floor.lines[slide.unit], slide.end) for slide in slides),
        _names(floor, own[:_MOST_NAMES]),
    ]
    return svg(floor.width, floor.height, items)
