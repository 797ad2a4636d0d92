"""The schedule as a Gantt chart: one A4 sheet across, lanes by shell, people at work beneath; for any printer."""

from collections.abc import Iterable, Iterator, Sequence
from math import ceil

import numpy as np

from aag_cad.language import Language, figure, say
from assembly.base.phases import PHASE, Look, Phase
from assembly.base.steps import Plan, Step
from assembly.drawing.svg import CHARACTER, Style, group, line, number, polygon, rectangle, svg, text
from assembly.plan.schedule import Schedule, ScheduledStep, people_curve

WIDTH, HEIGHT = 2970.0, 2100.0
_LEFT, _RIGHT, _TOP, _CURVE, _LEGEND = 210.0, 2890.0, 250.0, 300.0, 190.0
_WORDS, _SMALL, _TINY = 30.0, 26.0, 21.0
_INK, _THIN, _GRID = Style("#000"), Style("none", "#000", 1.5), Style("none", "#999", 1.5)
_NIGHT, _LIMIT = Style("none", "#000", 2.5), Style("none", "#000", 3.0, "14 9")
_MOST_DAYS = 40

# How each look of a phase is painted, in the order of the legend.
_PAINTS: dict[Look, str] = {
    "make": "white", "lay": "light", "studs": "rising", "hoist": "black", "edges": "crossed", "fix": "upright",
    "tighten": "dotted", "splices": "netted", "feet": "level", "stand": "dark", "ridges": "falling", "cover": "middle",
    "passports": "squared",
}  # fmt: skip
_SOLID = {"white": "#fff", "light": "#ddd", "middle": "#b0b0b0", "dark": "#666", "black": "#000"}
_HATCHES = {
    "rising": ('<path d="M0 16L16 0M-4 4L4 -4M12 20L20 12"/>', 16),
    "falling": ('<path d="M0 0L16 16M-4 12L4 20M12 -4L20 4"/>', 16),
    "crossed": ('<path d="M0 0L14 14M0 14L14 0"/>', 14),
    "upright": ('<path d="M5 0V10"/>', 10),
    "level": ('<path d="M0 5H10"/>', 10),
    "dotted": ('<path d="M4 5H7M11 12H14"/>', 14),
    "netted": ('<path d="M0 0L8 8L0 16M16 0L8 8L16 16"/>', 16),
    "squared": ('<path d="M8 0V16M0 8H16"/>', 16),
}


def _paint(phase: Phase) -> str:
    return _fill(_PAINTS[PHASE[phase].look])


def _fill(paint: str) -> str:
    return _SOLID.get(paint, f"url(#gantt-{paint})")


def _patterns() -> str:
    """Return the hatches; a white ground keeps grid lines from showing through."""
    items = (
        f'<pattern id="gantt-{name}" width="{size}" height="{size}" patternUnits="userSpaceOnUse">'
        f'<rect width="{size}" height="{size}" fill="#fff"/>'
        f'<g stroke="#000" stroke-width="2" fill="none">{lines}</g></pattern>'
        for name, (lines, size) in _HATCHES.items()
    )
    return f"<defs>{''.join(items)}</defs>"


def _rows(steps: Iterable[ScheduledStep]) -> dict[str, int]:
    """Return the row of each step in its lane: the first one that is free by then."""
    ends: list[int] = []
    rows: dict[str, int] = {}
    for step in sorted(steps, key=lambda step: (step.start_minute, step.end_minute, step.id)):
        row = next((i for i, end in enumerate(ends) if end <= step.start_minute), len(ends))
        ends[row : row + 1] = [step.end_minute]
        rows[step.id] = row
    return rows


def _number_width(step: Step) -> float:
    return CHARACTER * _SMALL * len(str(step.number)) + 16.0


def _lifts(steps: Sequence[tuple[float, float, int, Step]]) -> dict[str, float]:
    """Return how far to lift the number of each step (x, width, row, step): every other one where they stand close."""
    lifts: dict[str, float] = {}
    last: dict[int, tuple[float, float]] = {}
    for x, width, row, step in sorted(steps, key=lambda each: (each[0], each[3].id)):
        middle, (before, lifted) = x + width / 2.0, last.get(row, (-WIDTH, 0.0))
        lifts[step.id] = _TINY * 1.5 if middle - before < 0.9 * _TINY and not lifted else 0.0
        if width <= _number_width(step):
            last[row] = middle, lifts[step.id]
    return lifts


def _bar(x: float, y: float, width: float, high: float, step: Step, critical: bool, lift: float) -> str:
    """Return the bar of a step, its number on a white plate, or above it on end where there is no room for it.

    ``lift`` is how far above, to keep clear of a neighbour's number.
    """
    paint = _paint(step.phase)
    items = [
        group(
            [rectangle(x, y, width, high)], Style(paint, "#000", min(7.0, max(2.5, 0.35 * width)) if critical else 1.5)
        )
    ]
    wide = _number_width(step)
    if width > wide:
        middle = y + high / 2.0
        items.append(group([rectangle(x + (width - wide + 6.0) / 2.0, middle - 16.0, wide - 6.0, 32.0)], Style("#fff")))
        items.append(group([text(str(step.number), x + width / 2.0, middle, _SMALL, bold=critical)], _INK))
    else:
        turned = f'<g transform="translate({number(x + width / 2.0)} {number(y - 10.0 - lift)}) rotate(-90)">'
        items.append(turned + group([text(str(step.number), 0.0, 0.0, _TINY, "start", bold=critical)], _INK) + "</g>")
    return "".join(items)


def _axis(schedule: Schedule, x_of: float, top: float, bottom: float, language: Language) -> Iterator[str]:
    """Yield the days over the lanes with a line at the end of each; fewer days are named where there are many."""
    days = max(1, ceil(schedule.makespan / schedule.day_minutes))
    wide = x_of * schedule.day_minutes
    each = max(1, ceil(60.0 / wide))
    for day in range(0, days + 1, max(1, each if days > _MOST_DAYS else 1)):
        x = _LEFT + day * wide
        yield line(np.array([(x, top - 12.0), (x, bottom)]), _GRID)
    for day in range(0, days, each):
        yield group([text(str(day + 1), _LEFT + (day + 0.5) * wide, top - 28.0, _WORDS)], _INK)
    yield group([text(say(language, "schedule.gantt.day"), _LEFT - 20.0, top - 28.0, _WORDS, "end")], _INK)


def _lanes(plan: Plan, schedule: Schedule, x_of: float, top: float, bottom: float, language: Language) -> Iterator[str]:
    """Yield the lanes of the shells and of the site, their heights by how many steps go on at once."""
    when = {step.id: step for step in schedule.steps}
    shells = sorted({step.shell for step in plan.steps}, key=lambda shell: (shell == "", len(shell), shell))
    rows = {shell: _rows(when[step.id] for step in plan.steps if step.shell == shell) for shell in shells}
    counts = [max(rows[shell].values(), default=0) + 1 for shell in shells]
    high = min(190.0, (bottom - top) / max(1.0, sum(count + 0.5 for count in counts)))
    y = top
    for shell, count in zip(shells, counts, strict=True):
        tall = (count + 0.5) * high
        yield group(
            [
                text(
                    shell or say(language, "schedule.gantt.site"),
                    _LEFT - 20.0,
                    y + tall / 2.0,
                    40.0,
                    "end",
                    bold=True,
                )
            ],
            _INK,
        )
        row = rows[shell]
        bars = [
            (
                _LEFT + when[s.id].start_minute * x_of,
                (when[s.id].end_minute - when[s.id].start_minute) * x_of,
                row[s.id],
                s,
            )
            for s in plan.steps
            if s.shell == shell
        ]
        lifts = _lifts(bars)
        # Thick frames are drawn last, or their neighbours would cover half of them.
        for x, width, place, step in sorted(bars, key=lambda bar: (when[bar[3].id].critical, bar[0])):
            at = y + (0.25 + place + 0.38) * high
            yield _bar(x, at, width, 0.57 * high, step, when[step.id].critical, lifts[step.id])
        y += tall
        yield line(np.array([(60.0, y), (_RIGHT, y)]), _THIN)


def _curve(schedule: Schedule, x_of: float, top: float, bottom: float, language: Language) -> Iterator[str]:
    """Yield the people at work over time, and how many there are."""
    scale = (bottom - top) / (schedule.people + 0.5)
    for people in range(0, schedule.people + 1, max(1, ceil(schedule.people / 8))):
        y = bottom - people * scale
        yield line(np.array([(_LEFT, y), (_RIGHT, y)]), _GRID)
        yield group([text(str(people), _LEFT - 20.0, y, _SMALL, "end")], _INK)
    points = [(_LEFT, bottom)]
    for minute, people in people_curve(schedule):
        x = _LEFT + minute * x_of
        points += [(x, points[-1][1]), (x, bottom - people * scale)]
    yield polygon(np.array([*points, (points[-1][0], bottom)]), Style("#c8c8c8", "#000", 2.0))
    y = bottom - schedule.people * scale
    yield line(np.array([(_LEFT, y), (_RIGHT, y)]), _LIMIT)
    yield group(
        [text(say(language, "schedule.gantt.people"), _LEFT - 20.0, top - 12.0, _WORDS, "end", bold=True)], _INK
    )


def _legend(plan: Plan, top: float, language: Language) -> Iterator[str]:
    """Yield a sample of each look that the plan has, and of the critical steps."""
    used = {PHASE[step.phase].look for step in plan.steps}
    looks = [(f"looks.{look}", _fill(paint), 2.0) for look, paint in _PAINTS.items() if look in used]
    column = (_RIGHT - 60.0) / 7.0
    for i, (name, fill, frame) in enumerate((*looks, ("gantt.critical", _fill("white"), 7.0))):
        x, y = 60.0 + i % 7 * column, top + i // 7 * 60.0
        yield group([rectangle(x, y, 70.0, 40.0)], Style(fill, "#000", frame))
        yield group([text(say(language, f"schedule.{name}"), x + 84.0, y + 20.0, _SMALL, "start")], _INK)


def _heading(title: str, schedule: Schedule, language: Language) -> Iterator[str]:
    hours = schedule.day_minutes / 60.0
    work = sum(step.people * (step.end_minute - step.start_minute) for step in schedule.steps) / 60.0
    length = sum(s.end_minute - s.start_minute for s in schedule.steps if s.id in set(schedule.critical_path)) / 60.0
    facts = say(
        language,
        "schedule.gantt.facts",
        people=schedule.people,
        hours=figure(number(hours), language),
        days=figure(f"{schedule.days:.1f}", language),
        work=f"{work:.0f}",
        chain=f"{length:.0f}",
        ratio=figure(f"{schedule.ratio:.2f}", language),
    )
    yield group([text(title, 60.0, 90.0, 56.0, "start", bold=True)], _INK)
    yield group([text(facts, 60.0, 160.0, _WORDS, "start")], _INK)


def gantt_svg(plan: Plan, schedule: Schedule, title: str, language: Language = "en") -> str:
    """Return the Gantt chart as SVG, A4 across: steps by their numbers in lanes, thick frames where there is no slack.

    Days are working days from 1.
    """
    span = max(1, ceil(schedule.makespan / schedule.day_minutes)) * schedule.day_minutes
    x_of = (_RIGHT - _LEFT) / span
    legend = HEIGHT - _LEGEND
    curve_top, lanes_bottom = legend - _CURVE - 40.0, legend - _CURVE - 95.0
    parts: Sequence[Iterable[str]] = (
        [_patterns(), group([rectangle(0.0, 0.0, WIDTH, HEIGHT)], Style("#fff"))],
        _heading(title, schedule, language),
        _axis(schedule, x_of, _TOP, legend - 40.0, language),
        _lanes(plan, schedule, x_of, _TOP, lanes_bottom, language),
        _curve(schedule, x_of, curve_top, legend - 40.0, language),
        _legend(plan, legend, language),
    )
    return svg(WIDTH, HEIGHT, (item for part in parts for item in part))
