"""Pictures of any graph of parts on the floor, seen from above: planks as strips, the upper one over the lower one."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from aag_cad.parts.marks import short_in
from aag_cad.units import Floats
from assembly.base.steps import Step
from assembly.drawing.svg import (
    Box,
    Style,
    circle,
    group,
    label_box,
    label_svg,
    path,
    placed_labels,
    places_along,
    places_round,
    polylines,
    svg,
    text,
)
from assembly.graph.laying_units import Unit
from assembly.pictures.floor import Floor, joints_of_step, units_of_step
from assembly.pictures.step_pictures import DOT, DOT_LABEL_SIZE, LABEL_SIZE, NEW, THERE, slide_arrow, start_triangle

# As large as it is printed on a card, so that its marks are.
_WIDTH, _HEIGHT, _MARGIN = 1800.0, 1250.0, 80.0
_KEY_WIDTH = 170.0
# A plank without a width, or too slender for the scale, is drawn as wide as a heavy line.
_THIN = 11.0
_MOST_NAMES = 40
# With more planks or crossings the grey of what is laid already would make every step as heavy as the whole.
_MOST_LAID = 400
# What a step handles is drawn larger where it takes less than this share of the floor, with so much around it.
_SMALL, _AROUND = 0.45, 0.4
# Planks that cross at a smaller sine are drawn as if they did not; what covers a crossing is no longer than so many
# widths of its two planks.
_FLATTEST, _LONGEST = 0.05, 3.0
_SHARES = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8)
_RING = 26.0
_INK, _HOLLOW, _LATER = Style("#000"), Style("none", "#000", 3.0), Style("none", "#b0b0b0", 3.0, "5 6")
_FRAME = Style("none", "#000", 2.0, "14 8")


@dataclass(frozen=True, eq=False)
class _Sheet:
    """A part of a floor on paper, y down: from ``low`` (2,) over ``size`` (2,), mm, in the middle of the sheet."""

    low: Floats
    size: Floats

    @property
    def scale(self) -> float:
        """Units of the sheet a mm."""
        room = np.array([_WIDTH, _HEIGHT]) - 2.0 * _MARGIN
        return float((room / np.maximum(self.size, 1.0)).min())

    @property
    def height(self) -> float:
        """The height of the sheet."""
        return float(self.size[1]) * self.scale + 2.0 * _MARGIN

    def __call__(self, points: Floats) -> Floats:
        """Return points (n, 2) of the floor on the sheet."""
        left = (_WIDTH - float(self.size[0]) * self.scale) / 2.0
        return np.asarray([left, self.height - _MARGIN] + (points - self.low) * [self.scale, -self.scale])

    def shows(self, ends: Floats) -> bool:
        """Return whether something of a line (2, 2) may be seen."""
        return bool(np.all(ends.max(axis=0) >= self.low) and np.all(ends.min(axis=0) <= self.low + self.size))


def _strip(ends: Floats, width: float) -> Floats:
    """Return the outline (4, 2) of a strip along a line (2, 2): its long sides are the first two and the last two."""
    along = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    across = width / 2.0 * np.array([-along[1], along[0]])
    return np.array([ends[0] + across, ends[1] + across, ends[1] - across, ends[0] - across])


def _covered(lower: Floats, upper: Floats, widths: tuple[float, float]) -> tuple[float, float] | None:
    """Return between which shares the upper of two lines (2, 2) covers the lower one; None if they do not cross."""
    runs = lower[1] - lower[0], upper[1] - upper[0]
    lengths = [float(np.linalg.norm(run)) for run in runs]
    turn = float(runs[0][0] * runs[1][1] - runs[0][1] * runs[1][0])
    sine = abs(turn) / (lengths[0] * lengths[1])
    if sine < _FLATTEST:
        return None
    gap = upper[0] - lower[0]
    shares = np.array([gap[0] * runs[1][1] - gap[1] * runs[1][0], gap[0] * runs[0][1] - gap[1] * runs[0][0]]) / turn
    if np.any(np.abs(shares - 0.5) > 0.55):
        return None
    cosine = abs(float(runs[0] @ runs[1])) / (lengths[0] * lengths[1])
    half = min((widths[0] + widths[1] * cosine) / (2.0 * sine), _LONGEST * sum(widths)) + 2.0
    return max(0.0, float(shares[1]) - half / lengths[1]), min(1.0, float(shares[1]) + half / lengths[1])


def _style(unit: Unit, new: bool) -> Style:
    return NEW.get(unit.family, NEW["G"]) if new else THERE


def _planks(floor: Floor, sheet: _Sheet, there: Collection[str], new: Collection[str]) -> Iterator[str]:
    """Yield planks of units as strips, the ``new`` ones heavy, and over each crossing the piece of the upper one."""

    def wide(part: str) -> float:
        return max(_THIN, floor.widths[part] * sheet.scale)

    shown = {mark for mark in (*there, *new) if sheet.shows(floor.ends[mark])}
    for units, fresh in ((there, False), (new, True)):
        for unit in (floor.units[mark] for mark in units if mark in shown):
            strips = (path(_strip(sheet(floor.lines[part]), wide(part))) for part in unit.parts)
            yield group(strips, _style(unit, fresh))
    seen = [
        (lower, upper, floor.planks[upper])
        for lower, upper in floor.crossings
        if floor.planks[lower] in shown and floor.planks[upper] in shown
    ]
    few = len(seen) <= _MOST_LAID
    for lower, upper, above in seen:
        if not few and above not in new and floor.planks[lower] not in new:
            continue
        line = sheet(floor.lines[upper])
        shares = _covered(sheet(floor.lines[lower]), line, (wide(lower), wide(upper)))
        if shares is not None:
            strip, style = _strip(places_along(line, shares), wide(upper)), _style(floor.units[above], above in new)
            # The edges along it, and its end where it ends there.
            ends = [side for side, at in ((strip[[3, 0]], shares[0] == 0.0), (strip[1:3], shares[1] == 1.0)) if at]
            yield group([path(strip)], Style(style.fill))
            yield group([polylines([strip[:2], strip[2:], *ends])], Style("none", style.stroke, style.width))


def _names(floor: Floor, sheet: _Sheet, units: Sequence[str], joints: Sequence[str] = (), shell: str = "") -> str:
    """Return the marks of units (framed) and of joints (plain), without that of their shell, clear of each other."""
    whole: Box = (0.0, 0.0, _WIDTH, sheet.height)
    named = [(short_in(mark, shell), places_along(sheet(floor.ends[mark]), _SHARES)) for mark in units]
    names = placed_labels(named, LABEL_SIZE, whole)
    round_them = [(short_in(joint, shell), places_round(sheet(floor.points[joint]), 1.5 * _RING)) for joint in joints]
    numbers = placed_labels(round_them, DOT_LABEL_SIZE, whole, [label_box(label) for label in names])
    return label_svg(numbers, framed=False) + label_svg(names)


def _starts(floor: Floor, sheet: _Sheet, units: Sequence[str]) -> str:
    return group((path(start_triangle(sheet(floor.ends[mark]))) for mark in units), _INK)


def _whole(floor: Floor) -> _Sheet:
    return _Sheet(np.zeros(2), floor.size)


def cover_svg(floor: Floor) -> str:
    """Return the whole as it lies in the end."""
    sheet = _whole(floor)
    return svg(_WIDTH, sheet.height, _planks(floor, sheet, (), list(floor.units)))


def map_svg(floor: Floor) -> str:
    """Return the whole with the marks of its units, their start ends, and the frame that coordinates count in, mm."""
    sheet, units = _whole(floor), list(floor.units)
    wide, high = floor.size.tolist()
    frame = sheet(np.array([(0.0, 0.0), (wide, 0.0), (wide, high), (0.0, high)]))
    corners = zip(("0, 0", f"x {wide:.0f}, 0", "", f"0, y {high:.0f}"), frame, (56.0, 56.0, 0.0, -56.0), strict=True)
    words = (text(word, x, y + aside, LABEL_SIZE) for word, (x, y), aside in corners)
    items = (group([path(frame)], _FRAME), *_planks(floor, sheet, units, ()), group(words, _INK))
    return svg(_WIDTH, sheet.height, [*items, _starts(floor, sheet, units), _names(floor, sheet, units)])


def _around(floor: Floor, step: Step) -> _Sheet:
    """Return the part of the floor to draw for a step: all of it, or what it handles and what is around that."""
    places = [floor.ends[mark] for mark in units_of_step(floor, step)]
    places += [floor.points[joint].reshape(1, 2) for joint in joints_of_step(floor, step)]
    if not places:
        return _whole(floor)
    points = np.concatenate(places)
    size = np.ptp(points, axis=0)
    if float(size.max()) >= _SMALL * float(floor.size.max()):
        return _whole(floor)
    # Nothing is drawn very large, and what is long is not drawn as a stripe.
    longest = max(float(size.max()), 0.1 * float(floor.size.max()))
    half = np.maximum(size, 0.5 * longest) / 2.0 + _AROUND * longest
    middle = (points.min(axis=0) + points.max(axis=0)) / 2.0
    low, high = np.maximum(middle - half, 0.0), np.minimum(middle + half, floor.size)
    return _Sheet(low, high - low)


def floor_svg(floor: Floor, step: Step, there: Sequence[str]) -> str:
    """Return the floor with what a step lays, slides in or joins; ``there`` are the units that lie already."""
    sheet, own, joined = _around(floor, step), units_of_step(floor, step), joints_of_step(floor, step)
    seen = [mark for mark, ends in floor.ends.items() if sheet.shows(ends)]
    slides = [floor.slides[mark] for mark in own if mark in floor.slides]
    passed = [joint for slide in slides for joint in slide.joints]
    items = [
        group([polylines(sheet(floor.ends[mark]) for mark in seen)], _LATER),
        *_planks(floor, sheet, there if len(seen) <= _MOST_LAID else (), own),
        _starts(floor, sheet, own),
        group((circle(sheet(floor.points[joint]), _RING) for joint in passed), _HOLLOW),
        group((circle(sheet(floor.points[joint]), 10.0) for joint in joined), DOT),
        *(slide_arrow(sheet(floor.ends[slide.unit]), slide.end) for slide in slides),
        _names(floor, sheet, own[:_MOST_NAMES], [*passed, *joined][:_MOST_NAMES], step.shell),
    ]
    return svg(_WIDTH, sheet.height, items)


def key_svg(floor: Floor, step: Step) -> str:
    """Return the floor in small with the part of it that the picture of a step shows, or "" if it shows all."""
    sheet = _around(floor, step)
    if np.array_equal(sheet.size, floor.size):
        return ""
    scale = _KEY_WIDTH / float(floor.size.max())
    corners = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    wide, high = (floor.size * scale).tolist()
    shown = (sheet.low + corners * sheet.size) * [scale, -scale] + [5.0, high + 5.0]
    lines = (ends * [scale, -scale] + [5.0, high + 5.0] for ends in floor.ends.values())
    items = (group([polylines(lines)], Style("none", "#999", 1.0)), group([path(shown)], Style("none", "#000", 6.0)))
    return svg(wide + 10.0, high + 10.0, items)
