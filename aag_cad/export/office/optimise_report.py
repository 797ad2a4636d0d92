"""The report of an optimised web as one HTML file that needs no other: verdict, goals, quality, history and maps."""

import math
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from aag_cad.files import write_text
from aag_cad.units import MM_PER_M, Floats, deg_per_m
from aag_cad.web.energies import constant_angle, symmetry
from aag_cad.web.goals import Goals, Iteration, Optimised
from aag_cad.web.nets import LINES, geodesic_curvature, largest_bending, largest_twist, normal_curvature
from aag_cad.web.quality import WebQuality, quality
from aag_cad.web.web import Web

# Luminance falls evenly from light to dark, so that a map reads in black and white as well.
_RAMP = np.array([[255, 251, 220], [222, 231, 165], [143, 203, 160], [62, 152, 170], [42, 92, 150], [34, 24, 84]])
_LEVELS = 40
_CELLS = 64
_DASHES = ("", "7 3", "2 2", "9 3 2 3", "4 4", "12 3", "1 3", "7 2 2 2 2 2")
_INKS = ("#1b3a6b", "#a33b1f", "#2c6e49", "#6d3b8e", "#8a6d00", "#006d77", "#444444", "#b0306a")
# Below this part of its unit a figure is rounding error; a map scaled to it would show noise.
_NOISE = 1e-9

_STYLE = """
body{font:16px/1.45 system-ui,sans-serif;color:#111;background:#fff;margin:0 auto;padding:1rem;max-width:62rem}
h1{font-size:1.5rem;margin:.2em 0}h2{font-size:1.15rem;margin:1.6em 0 .4em}
.verdict{border:3px solid #111;padding:.6rem .8rem;margin:.8rem 0}.failed{border-style:dashed}
.scroll{overflow-x:auto}table{border-collapse:collapse;min-width:60%}
th,td{border-bottom:1px solid #999;padding:.25rem .6rem;text-align:right;white-space:nowrap}
th:first-child{text-align:left;white-space:normal;font-weight:normal}
thead th,thead th:first-child{border-bottom:2px solid #111;font-weight:600}
svg{width:100%;height:auto;display:block}svg text{font:11px system-ui,sans-serif;fill:#111}
.chart{max-width:36rem}.maps{display:grid;grid-template-columns:repeat(auto-fit,minmax(17rem,1fr));gap:1.2rem}
figure{margin:0;break-inside:avoid}figcaption{font-size:.92rem;margin-bottom:.3rem}
h2{break-after:avoid}
@media print{body{max-width:none;padding:0;font-size:10pt}th,td{padding:.1rem .5rem}svg{print-color-adjust:exact}}
"""


@dataclass(frozen=True, eq=False)
class _Map:
    """A measure over the inner vertices: what it is, its values (larger is worse), and how a value is printed."""

    title: str
    note: str
    values: Floats
    label: Callable[[float], str]


def _number(value: float) -> str:
    """Return a figure as text: to 3 decimals or fewer, or as a power of ten; one without a bound is a dash."""
    if not math.isfinite(value):
        return "&ndash;"
    if value == 0.0 or 1e-3 <= abs(value) < 1e5:
        return f"{value:.3f}" if abs(value) < 10.0 else f"{value:.2f}" if abs(value) < 1000.0 else f"{value:.0f}"
    return f"{value:.1e}"


def _radius(curvature: float) -> float:
    """Return the radius in m of a curvature in 1/m, without a bound where the line is straight."""
    return 1.0 / curvature if curvature > _NOISE else math.inf


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table whose first column names its rows; texts are HTML."""
    top = "".join(f"<th>{cell}</th>" for cell in head)
    body = "".join(f"<tr><th>{row[0]}</th>{''.join(f'<td>{cell}</td>' for cell in row[1:])}</tr>" for row in rows)
    return f'<div class="scroll"><table><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table></div>'


def _quality_rows(before: WebQuality, after: WebQuality) -> list[tuple[str, ...]]:
    def both(name: str, value: Callable[[WebQuality], str]) -> tuple[str, ...]:
        return name, value(before), value(after)

    return [
        both("Vertices", lambda q: str(q.vertices)),
        both("Planarity of the A stars, per edge, largest", lambda q: _number(q.planarity_per_edge)),
        both("Turn of a G line in the tangent plane, largest, deg", lambda q: _number(q.geodesic_deviation_deg)),
        both("Acute angle A to A, smallest, deg", lambda q: _number(q.angle_aa_deg.min)),
        both("Acute angle A to A, largest, deg", lambda q: _number(q.angle_aa_deg.max)),
        both("Acute angle A to G, smallest, deg", lambda q: _number(q.angle_ag_deg.min)),
        both("Acute angle A to G, largest, deg", lambda q: _number(q.angle_ag_deg.max)),
        both("Checkerboard, per edge, largest", lambda q: _number(q.parity_per_edge)),
        both("Turning of the normals along G, largest, deg", lambda q: _number(q.normal_turning_deg)),
        both("Extent x, m", lambda q: _number(q.extent[0] / MM_PER_M)),
        both("Extent y, m", lambda q: _number(q.extent[1] / MM_PER_M)),
        both("Extent z, m", lambda q: _number(q.extent[2] / MM_PER_M)),
        both("Radius of A lines, smallest, m", lambda q: _number(q.smallest_radius_a / MM_PER_M)),
        both("Radius of G lines, smallest, m", lambda q: _number(q.smallest_radius_g / MM_PER_M)),
        both("Twist, largest, deg/m", lambda q: _number(q.largest_twist_deg_per_m)),
    ]


def _angle_deg(web: Web) -> Floats:
    """Return the angle between the A lines upwards at the inner vertices, (rows - 2, columns - 2) degrees."""
    cosine = np.clip(constant_angle(web, math.pi / 2.0).residuals, -1.0, 1.0)
    return np.degrees(np.arccos(cosine)).reshape(web.vertices.shape[0] - 2, web.vertices.shape[1] - 2)


def _goal_rows(web: Web, start: Web, goals: Goals) -> list[tuple[str, ...]]:
    """Return each wish with what was asked for and what was reached."""
    v, row, middle = web.vertices, goals.bottom_row or 0, web.vertices.shape[1] // 2
    rows: list[tuple[str, ...]] = []
    if goals.angle is not None:
        angle = _angle_deg(web)
        reached = f"{_number(float(angle.min()))} to {_number(float(angle.max()))}"
        rows.append(("Angle between the A lines, deg", _number(math.degrees(goals.angle)), reached))
    if goals.bottom_row is not None:
        lift = float(np.abs(v[row, :, 2]).max())
        rows.append((f"Bottom curve, row {row}: largest |z|, mm", _number(0.0), _number(lift)))
    if goals.height is not None:
        rows.append(("Height, mm", _number(goals.height), _number(float(v[-1, middle, 2] - v[row, middle, 2]))))
    if goals.span is not None:
        rows.append(("Span, mm", _number(goals.span), _number(float(np.linalg.norm(v[row, -1] - v[row, 0])))))
    for goal in goals.points:
        off = float(np.linalg.norm(v[goal.row, goal.column] - np.array(goal.point)))
        rows.append((f"Vertex {goal.row}, {goal.column}: distance from its point, mm", _number(0.0), _number(off)))
    if goals.closeness > 0.0:
        off = float(np.linalg.norm(v - start.vertices, axis=-1).max())
        rows.append((f"Close to the start (weight {goals.closeness:g}): largest move, mm", "&ndash;", _number(off)))
    if goals.min_radius is not None:
        reached = _number(_radius(float(largest_bending(web).max()) * MM_PER_M) * MM_PER_M)
        rows.append(("Smallest bending radius, mm, at least", _number(goals.min_radius), reached))
    if goals.max_twist is not None:
        reached = _number(deg_per_m(float(largest_twist(web).max())))
        rows.append(("Largest twist, deg/m, at most", _number(deg_per_m(goals.max_twist)), reached))
    if goals.symmetric:
        off = float(np.abs(symmetry(web).residuals).max())
        rows.append(("Mirror symmetry: largest difference, mm", _number(0.0), _number(off)))
    return rows


def _chart(iterations: Sequence[Iteration]) -> str:
    """Return the energies over the iterations on a logarithmic scale, one line each, told apart by dash and colour."""
    names = list(dict.fromkeys(name for item in iterations for name in item.energies))
    values = [v for item in iterations for v in item.energies.values() if math.isfinite(v) and v > 0.0]
    if not values:
        return "<p>No iteration with an energy above zero.</p>"
    low, high = math.floor(max(math.log10(min(values)), -34.0)), math.ceil(math.log10(max(values)))
    high = max(high, low + 1)
    left, top, width, tall = 38.0, 16.0, 314.0, 200.0
    last = max(len(iterations) - 1, 1)

    def x_of(place: float) -> float:
        return left + width * place / last

    def y_of(value: float) -> float:
        return top + tall * (high - max(math.log10(value), low)) / (high - low)

    parts = []
    for decade in range(low, high + 1, max(1, math.ceil((high - low) / 8))):
        y = y_of(10.0**decade)
        parts.append(f'<path d="M{left:.1f} {y:.1f}h{width:.1f}" stroke="#bbb" stroke-width=".5"/>')
        parts.append(f'<text x="{left - 4:.1f}" y="{y + 4:.1f}" text-anchor="end">1e{decade}</text>')
    for place in range(0, len(iterations), max(1, math.ceil(len(iterations) / 8))):
        parts.append(f'<text x="{x_of(place):.1f}" y="{top + tall + 14:.1f}" text-anchor="middle">{place}</text>')
    for place, item in enumerate(iterations):
        if place == 0 or item.stage != iterations[place - 1].stage:
            x = x_of(place)
            parts.append(f'<path d="M{x:.1f} {top:.1f}v{tall:.1f}" stroke="#111" stroke-width=".8"/>')
            parts.append(f'<text x="{x + 3:.1f}" y="{top - 4:.1f}">{escape(item.stage)}</text>')
    foot = top + tall + 34.0
    for k, name in enumerate(names):
        ink, dash = _INKS[k % len(_INKS)], _DASHES[k % len(_DASHES)]
        pen = f'fill="none" stroke="{ink}" stroke-width="1.5" stroke-dasharray="{dash}"'
        points = " ".join(
            f"{x_of(place):.1f},{y_of(item.energies[name]):.1f}"
            for place, item in enumerate(iterations)
            if math.isfinite(item.energies.get(name, 0.0)) and item.energies.get(name, 0.0) > 0.0
        )
        x, y = left + 105.0 * (k % 3), foot + 16.0 * (k // 3)
        parts.append(f'<polyline points="{points}" {pen}/><path d="M{x:.1f} {y:.1f}h26" {pen}/>')
        parts.append(f'<text x="{x + 30:.1f}" y="{y + 4:.1f}">{escape(name)}{"" if points else " (zero)"}</text>')
    height = foot + 16.0 * math.ceil(len(names) / 3)
    label = "Energies over the iterations, logarithmic"
    return f'<svg class="chart" viewBox="0 0 360 {height:.0f}" role="img" aria-label="{label}">{"".join(parts)}</svg>'


def _maps(web: Web, goals: Goals) -> list[_Map]:
    shape = (web.vertices.shape[0] - 2, web.vertices.shape[1] - 2)
    per_m, angle = MM_PER_M, _angle_deg(web)
    on_a = [np.abs(normal_curvature(web, line).residuals) for line in LINES[:2]]
    asked = float(angle.mean()) if goals.angle is None else math.degrees(goals.angle)
    named = f"from the mean, {asked:.2f} deg" if goals.angle is None else f"from {asked:.2f} deg"
    return [
        _Map(
            "Normal curvature of A lines, 1/m",
            "|kappa_n|, larger of both families; zero on asymptotic lines",
            np.maximum(*on_a).reshape(shape) * per_m,
            _number,
        ),
        _Map(
            "Geodesic curvature of G lines, 1/m",
            "|kappa_g|; zero on geodesics",
            np.abs(geodesic_curvature(web, "G").residuals).reshape(shape) * per_m,
            _number,
        ),
        _Map(
            "Twist, deg/m",
            "|tau_g|, largest of A and G planks at the vertex",
            np.degrees(largest_twist(web)) * per_m,
            _number,
        ),
        _Map(
            "Bending radius, m",
            "smallest of A (on edge) and G (flat); dark is tight",
            largest_bending(web) * per_m,
            lambda curvature: _number(_radius(curvature)),
        ),
        _Map("Angle error, deg", f"angle between the A lines, {named}", np.abs(angle - asked), _number),
    ]


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


def _cells(field: _Map, corners: Floats) -> str:
    """Return the coloured cells of a map, one path a colour; ``corners`` (m + 1, n + 1, 2) bound its values (m, n)."""
    step = max(1, math.ceil(max(field.values.shape) / _CELLS))
    starts = [np.arange(0, size, step) for size in field.values.shape]
    # A block shows its worst vertex: a mean would hide it.
    values = np.maximum.reduceat(np.maximum.reduceat(field.values, starts[0], axis=0), starts[1], axis=1)
    ends = [np.append(start, size) for start, size in zip(starts, field.values.shape, strict=True)]
    grid = corners[np.ix_(ends[0], ends[1])]
    low, high = float(values.min()), float(values.max())
    level = np.round((values - low) / max(high - low, _NOISE) * (_LEVELS - 1)).astype(int)
    text = [[f"{x:.1f} {y:.1f}" for x, y in row] for row in grid.tolist()]
    paths = []
    for shade in np.unique(level).tolist():
        quads = "".join(
            f"M{text[i][j]}L{text[i][j + 1]}L{text[i + 1][j + 1]}L{text[i + 1][j]}z"
            for i, j in np.argwhere(level == shade).tolist()
        )
        ink = _colour(shade / (_LEVELS - 1))
        paths.append(f'<path d="{quads}" fill="{ink}" stroke="{ink}" stroke-width=".4"/>')
    return "".join(paths)


def _picture(field: _Map, web: Web, bottom_row: int | None) -> str:
    """Return a map as a figure: cells, the bottom curve, a ring at the worst vertex, and the scale below."""
    plan = _unrolled(web)
    low, high = plan.reshape(-1, 2).min(axis=0), plan.reshape(-1, 2).max(axis=0)
    scale = min(288.0 / float(high[0] - low[0]), 320.0 / float(high[1] - low[1]))
    tall = scale * float(high[1] - low[1])
    middle = 0.5 * (low[0] + high[0])
    plan = np.stack([150.0 + scale * (plan[..., 0] - middle), 6.0 + scale * (high[1] - plan[..., 1])], axis=-1)
    corners = 0.25 * (plan[1:, 1:] + plan[:-1, 1:] + plan[1:, :-1] + plan[:-1, :-1])
    row, column = (int(k) + 1 for k in np.unravel_index(int(field.values.argmax()), field.values.shape))
    rim = [*corners[0], *corners[1:, -1], *corners[-1, ::-1][1:], *corners[::-1, 0][1:]]
    outline = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in rim) + "z"
    parts = [_cells(field, corners), f'<path d="{outline}" fill="none" stroke="#111" stroke-width=".8"/>']
    if bottom_row is not None:
        (x0, y0), (x1, _) = plan[bottom_row, 0], plan[bottom_row, -1]
        # Black dashes on a white line show on light and on dark cells.
        across = f"M{x0:.1f} {y0:.1f}H{x1:.1f}"
        parts.append(f'<path d="{across}" stroke="#fff" stroke-width="2"/>')
        parts.append(f'<path d="{across}" stroke="#111" stroke-width="1.2" stroke-dasharray="5 4"/>')
    x, y = plan[row, column]
    parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5" fill="none" stroke="#fff" stroke-width="3"/>')
    parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5" fill="none" stroke="#111" stroke-width="1.4"/>')
    base = tall + 18.0
    shades = "".join(
        f'<rect x="{6 + 288 * k / 24:.1f}" y="{base:.1f}" width="12.2" height="12" fill="{_colour(k / 23)}"/>'
        for k in range(24)
    )
    least, most = float(field.values.min()), float(field.values.max())
    worst, dark = field.label(most), field.label(max(most, least + _NOISE))
    parts.append(f'{shades}<rect x="6" y="{base:.1f}" width="288.2" height="12" fill="none" stroke="#111"/>')
    parts.append(f'<text x="6" y="{base + 26:.1f}">{field.label(least)}</text>')
    parts.append(f'<text x="294" y="{base + 26:.1f}" text-anchor="end">{dark}</text>')
    box = f'viewBox="0 0 300 {base + 32:.0f}" role="img" aria-label="{escape(field.title)}"'
    caption = f"<b>{escape(field.title)}</b><br>{escape(field.note)}; ring: {worst} at row {row}, column {column}"
    return f"<figure><figcaption>{caption}</figcaption><svg {box}>{''.join(parts)}</svg></figure>"


def report_html(optimised: Optimised, goals: Goals) -> str:
    """Return the report of an optimised web as HTML, the same text for the same web and history."""
    web, start = optimised.web, Web(optimised.start)
    kind, word = ("verdict", "Success") if optimised.success else ("verdict failed", "No success")
    last = f"{len(optimised.iterations)} iterations"
    if optimised.iterations:
        last += f", the last moved a vertex by {_number(optimised.iterations[-1].step)} edges"
    wishes = _goal_rows(web, start, goals)
    asked = _table(("Goal", "asked", "reached"), wishes) if wishes else "<p>No goals beyond the web itself.</p>"
    maps = "".join(_picture(field, web, goals.bottom_row) for field in _maps(web, goals))
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>Optimised web: {escape(optimised.reason)}</title><style>{_STYLE}</style></head>\n<body>"
        f'<h1>Optimised web</h1><p class="{kind}"><b>{word}: {escape(optimised.reason)}.</b> '
        f"{escape(optimised.explanation)}.<br>{last}.</p>\n"
        f"<h2>Goals</h2>{asked}\n"
        f"<h2>Quality</h2>{_table(('Measure', 'start', 'end'), _quality_rows(quality(start), quality(web)))}\n"
        f"<h2>Energies</h2><p>Weighted sums of squares before each iteration, scaled to a mean edge of 1.</p>"
        f"{_chart(optimised.iterations)}\n"
        "<h2>Maps</h2><p>The web unrolled: each row by its length from the middle, each column upwards by the mean "
        "length of the columns. A cell is a vertex, on fine webs the worst of a block. Dark is the larger curvature, "
        "twist or error; the dashed line is the bottom curve.</p>"
        f'<div class="maps">{maps}</div>\n</body></html>\n'
    )


def write_report(optimised: Optimised, goals: Goals, path: str | os.PathLike[str]) -> None:
    """Write the report as one HTML file; FileError if it cannot be written."""
    write_text(path, report_html(optimised, goals))
