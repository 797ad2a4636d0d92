"""Pictures of an optimised web: its energies over the iterations, and a measure as a map of the web unrolled."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from aag_cad.units import Floats
from aag_cad.web.goals import Iteration
from aag_cad.web.web import Web
from assembly.drawing.svg import Style, circle, group, line, path, polylines, rectangle, svg, text

# Luminance falls evenly from light to dark, so that a map reads in black and white as well.
_RAMP = np.array([[255, 251, 220], [222, 231, 165], [143, 203, 160], [62, 152, 170], [42, 92, 150], [34, 24, 84]])
_LEVELS = 40
_CELLS = 64
_CELL_LINE = 0.4
_SHADES = 24
_DASHES = ("", "7 3", "2 2", "9 3 2 3", "4 4", "12 3", "1 3", "7 2 2 2 2 2")
_COLOURS = ("#1b3a6b", "#a33b1f", "#2c6e49", "#6d3b8e", "#8a6d00", "#006d77", "#444444", "#b0306a")
# Below this part of its unit a figure is rounding error; a map scaled to it would show noise.
NOISE = 1e-9
_SIZE = 11.0
_INK, _GRID, _STAGE = Style("#111"), Style("none", "#bbb", 0.5), Style("none", "#111", 0.8)
# Black on a wider white line shows on light and on dark cells.
_BELOW, _RING = Style("none", "#fff", 3.0), Style("none", "#111", 1.4)
_BOTTOM_BELOW, _BOTTOM = Style("none", "#fff", 2.0), Style("none", "#111", 1.2, "5 4")
_FRAME = Style("none", "#111")
_LEFT, _TOP, _WIDE, _TALL = 38.0, 16.0, 314.0, 200.0
_MAP_WIDTH, _MAP_LEFT, _MAP_WIDE, _MAP_TALL = 300.0, 6.0, 288.0, 320.0


@dataclass(frozen=True, eq=False)
class Map:
    """A measure over the inner vertices: what it is, its values (larger is worse), and how a value is printed."""

    title: str
    note: str
    values: Floats
    label: Callable[[float], str]

    @property
    def worst(self) -> tuple[int, int]:
        """Row and column of the worst vertex, counted in the whole web."""
        row, column = np.unravel_index(int(self.values.argmax()), self.values.shape)
        return int(row) + 1, int(column) + 1


def energy_chart(iterations: Sequence[Iteration]) -> str:
    """Return the energies over the iterations on a logarithmic scale, told apart by dash and colour; "" without any."""
    names = list(dict.fromkeys(name for item in iterations for name in item.energies))
    values = [v for item in iterations for v in item.energies.values() if math.isfinite(v) and v > 0.0]
    if not values:
        return ""
    low = math.floor(max(math.log10(min(values)), -34.0))
    high = max(math.ceil(math.log10(max(values))), low + 1)
    bottom, last = _TOP + _TALL, max(len(iterations) - 1, 1)

    def at(place: float, value: float) -> tuple[float, float]:
        up = (max(math.log10(value), low) - low) / (high - low)
        return _LEFT + _WIDE * place / last, bottom - _TALL * up

    decades = [(d, at(0, 10.0**d)[1]) for d in range(low, high + 1, max(1, math.ceil((high - low) / 8)))]
    places = [(p, at(p, 1.0)[0]) for p in range(0, len(iterations), max(1, math.ceil(len(iterations) / 8)))]
    stages = [
        (item.stage, at(place, 1.0)[0])
        for place, item in enumerate(iterations)
        if place == 0 or item.stage != iterations[place - 1].stage
    ]
    items = [
        group([polylines(np.array([(_LEFT, y), (_LEFT + _WIDE, y)]) for _, y in decades)], _GRID),
        group([polylines(np.array([(x, _TOP), (x, bottom)]) for _, x in stages)], _STAGE),
        group((text(f"1e{decade}", _LEFT - 4.0, y, _SIZE, "end") for decade, y in decades), _INK),
        group((text(str(place), x, bottom + 10.0, _SIZE) for place, x in places), _INK),
        group((text(stage, x + 3.0, _TOP - 8.0, _SIZE, "start") for stage, x in stages), _INK),
    ]
    for k, name in enumerate(names):
        x, y = _LEFT + 105.0 * (k % 3), bottom + 34.0 + 16.0 * (k // 3)
        found = [(place, item.energies.get(name, 0.0)) for place, item in enumerate(iterations)]
        points = [at(place, value) for place, value in found if math.isfinite(value) and value > 0.0]
        lines = [np.array(points), np.array([(x, y), (x + 26.0, y)])]
        pen = Style("none", _COLOURS[k % len(_COLOURS)], 1.5, _DASHES[k % len(_DASHES)])
        items.append(group((path(points, closed=False) for points in lines if len(points)), pen))
        items.append(group([text(name if points else f"{name} (zero)", x + 30.0, y, _SIZE, "start")], _INK))
    return svg(360.0, bottom + 34.0 + 16.0 * math.ceil(len(names) / 3), items)


def _unrolled(web: Web) -> Floats:
    """Return (rows, columns, 2): along the row from its middle, and up the mean column, by lengths of arc, mm."""
    v = web.vertices
    across = np.cumsum(np.linalg.norm(np.diff(v, axis=1), axis=-1), axis=1)
    across = np.concatenate([np.zeros((len(v), 1)), across], axis=1)
    last = v.shape[1] - 1
    across = across - 0.5 * (across[:, [last // 2]] + across[:, [(last + 1) // 2]])
    up = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(v, axis=0), axis=-1).mean(axis=1))])
    return np.stack([across, np.repeat(up[:, None], v.shape[1], axis=1)], axis=-1)


def _colour(level: float) -> str:
    place = level * (len(_RAMP) - 1)
    red, green, blue = (round(float(np.interp(place, np.arange(len(_RAMP)), _RAMP[:, k]))) for k in range(3))
    return f"#{red:02x}{green:02x}{blue:02x}"


def _cells(field: Map, corners: Floats) -> Iterator[str]:
    """Yield the coloured cells of a map, one shape a colour; ``corners`` (m + 1, n + 1, 2) bound its values (m, n)."""
    step = max(1, math.ceil(max(field.values.shape) / _CELLS))
    starts = [np.arange(0, size, step) for size in field.values.shape]
    # A block shows its worst vertex: a mean would hide it.
    values = np.maximum.reduceat(np.maximum.reduceat(field.values, starts[0], axis=0), starts[1], axis=1)
    ends = [np.append(start, size) for start, size in zip(starts, field.values.shape, strict=True)]
    grid = corners[np.ix_(ends[0], ends[1])]
    quads = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=2)
    low, high = float(values.min()), float(values.max())
    level = np.round((values - low) / max(high - low, NOISE) * (_LEVELS - 1)).astype(int)
    for shade in np.unique(level).tolist():
        ink = _colour(shade / (_LEVELS - 1))
        yield group([polylines(quads[level == shade], closed=True)], Style(ink, ink, _CELL_LINE))


def _scale(field: Map, top: float) -> Iterator[str]:
    """Yield the scale of a map from its least to its largest value."""
    wide = _MAP_WIDE / _SHADES
    for k in range(_SHADES):
        # A little wider than its share, so that no gap shows.
        yield group([rectangle(_MAP_LEFT + wide * k, top, wide + 0.2, 12.0)], Style(_colour(k / (_SHADES - 1))))
    yield group([rectangle(_MAP_LEFT, top, _MAP_WIDE + 0.2, 12.0)], _FRAME)
    least, most = float(field.values.min()), float(field.values.max())
    yield group(
        [
            text(field.label(least), _MAP_LEFT, top + 22.0, _SIZE, "start"),
            text(field.label(max(most, least + NOISE)), _MAP_LEFT + _MAP_WIDE, top + 22.0, _SIZE, "end"),
        ],
        _INK,
    )


def web_map(field: Map, web: Web, bottom_row: int | None) -> str:
    """Return a map as SVG: cells, the bottom curve, a ring at the worst vertex, and the scale below."""
    plan = _unrolled(web)
    low, high = plan.reshape(-1, 2).min(axis=0), plan.reshape(-1, 2).max(axis=0)
    scale = min(_MAP_WIDE / float(high[0] - low[0]), _MAP_TALL / float(high[1] - low[1]))
    tall = scale * float(high[1] - low[1])
    middle = np.array([0.5 * (low[0] + high[0]), high[1]])
    plan = (plan - middle) * [scale, -scale] + [_MAP_WIDTH / 2.0, 6.0]
    corners = 0.25 * (plan[1:, 1:] + plan[:-1, 1:] + plan[1:, :-1] + plan[:-1, :-1])
    rim = np.concatenate([corners[0], corners[1:, -1], corners[-1, ::-1][1:], corners[::-1, 0][1:]])
    items = [*_cells(field, corners), group([path(rim)], _STAGE)]
    if bottom_row is not None:
        ends = np.array([plan[bottom_row, 0], [plan[bottom_row, -1, 0], plan[bottom_row, 0, 1]]])
        items += [line(ends, _BOTTOM_BELOW), line(ends, _BOTTOM)]
    items += [group([circle(plan[field.worst], 5.0)], style) for style in (_BELOW, _RING)]
    return svg(_MAP_WIDTH, tall + 50.0, [*items, *_scale(field, tall + 18.0)])
