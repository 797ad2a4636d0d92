"""The locking order as a table and as a chart of the lowest frequencies."""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from aag_cad.language import Figure, Language, figure, say, says
from aag_cad.parts.marks import short_mark
from aag_cad.units import Floats
from assembly.base.locking_order import LockingOrder, LockingStep, frequency
from assembly.base.mark_ranges import joined_ranges
from assembly.drawing.svg import CHARACTER, Style, circle, group, line, polygon, rectangle, svg, text

LOCKING_HEADER = (
    "shell", "step", "fixed", "soft_modes", "lowest_eigenvalue_1_s2", "mode_1_hz", "mode_2_hz", "mode_3_hz",
    "displacement_mm", "at", "props", "displacement_with_props_mm",
)  # fmt: skip


def _row(shell: str, name: str, step: LockingStep) -> tuple[str, ...]:
    hertz = [f"{frequency(value):.2f}" for value in step.eigenvalues[:3]]
    props = " ".join(prop.joint for prop in step.props)
    return (
        shell,
        name,
        " ".join(step.marks),
        str(step.soft_modes),
        f"{step.eigenvalues[0]:.1f}",
        *[*hertz, "", ""][:3],
        f"{step.displacement:.1f}",
        step.at,
        props,
        f"{step.propped:.1f}" if props else "",
    )


def locking_rows(order: LockingOrder) -> list[tuple[str, ...]]:
    """Return the order as lines of a table under ``LOCKING_HEADER``: step 0 is the hoisted shell.

    The last line, "released", is the finished shell with tightened bolts and without the props at the hoists.
    """
    rows = [_row(order.shell, str(i), step) for i, step in enumerate(order.steps)]
    return [*rows, _row(order.shell, "released", order.released)]


def locking_table(order: LockingOrder, language: Language = "en") -> dict[str, Any]:
    """Return the order as head and rows of text for print: a line for each step, the last for the finished shell."""
    rows, (first, last) = [], (say(language, f"pictures.locking.{name}") for name in ("start", "released"))
    told = [first, *(joined_ranges(step.marks) for step in order.steps[1:]), last]
    for i, step in enumerate((*order.steps, order.released)):
        hertz = [figure(f"{frequency(value):.2f}", language) for value in step.eigenvalues[:2]]
        props = joined_ranges([prop.joint for prop in step.props])
        head, tail = str(i) if i < len(order.steps) else "", f"{step.propped:.0f}" if props else ""
        modes = [str(step.soft_modes), *hertz, ""][:3]
        rows.append([head, told[i], *modes, f"{step.displacement:.0f}", short_mark(step.at), props, tail])
    return {"head": list(says(language, "pictures.locking.head")), "rows": rows}


_WIDTH, _HEIGHT = 1700.0, 760.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 120.0, 30.0, 60.0, 190.0
_SIZE, _SMALL = 30.0, 24.0
_SHOWN = 4
_LINES = 3
_LETTERS = 5


def _scale(top: float) -> tuple[float, list[float]]:
    """Return the upper end of an axis from 0 and its ticks: a round step, four to ten of them."""
    decade = 10.0 ** math.floor(math.log10(top))
    step = next(decade * share for share in (1.0, 0.5, 0.2) if top / (decade * share) >= 4.0)
    count = math.ceil(top / step - 1e-9)
    return count * step, [i * step for i in range(count + 1)]


def _axes(
    x: Floats, order: LockingOrder, ticks: Sequence[float], y: Callable[[float], float], language: Language
) -> Iterator[str]:
    """Yield grid lines, the band of soft modes, ticks and the planks of each step in at most three lines."""
    right = _WIDTH - _RIGHT
    soft = y(frequency(order.threshold))
    yield group([rectangle(_LEFT, soft, right - _LEFT, y(0.0) - soft)], Style("#ddd"))
    for tick in ticks:
        yield line(np.array([(_LEFT, y(tick)), (right, y(tick))]), Style(stroke="#999", width=1.0))
        yield text(figure(f"{tick:g}", language), _LEFT - 14, y(tick), _SMALL, "end")
    size = min(_SMALL, float(x[1] - x[0]) / (_LETTERS * CHARACTER))
    for place, step, number in zip(x.tolist(), order.steps, range(len(order.steps)), strict=True):
        yield text(str(number), place, y(0.0) + 30, _SIZE, bold=True)
        names = [short_mark(mark) for mark in step.marks]
        names = names if len(names) <= _LINES else [*names[: _LINES - 1], f"+{len(names) - _LINES + 1}"]
        for i, name in enumerate(names):
            yield text(name, place, y(0.0) + 68 + 30 * i, size)


def locking_svg(order: LockingOrder, language: Language = "en") -> str:
    """Return a plot of the lowest frequencies by step as SVG, 170 mm wide: black the softest mode, grey the next ones.

    The grey band below holds the soft modes.
    """

    def said(key: str, **figures: Figure) -> str:
        return say(language, f"pictures.locking.{key}", **figures)

    shown = np.array([[frequency(v) for v in step.eigenvalues[:_SHOWN]] for step in order.steps])
    top, ticks = _scale(float(shown.max()))

    def y(value: float) -> float:
        return _HEIGHT - _BOTTOM - value / top * (_HEIGHT - _TOP - _BOTTOM)

    x = np.linspace(_LEFT + 60.0, _WIDTH - _RIGHT - 60.0, len(order.steps))
    items = list(_axes(x, order, ticks, y, language))
    items.append(text(said("axis"), _LEFT - 14, _TOP - 34, _SMALL, "end"))
    items.append(text(said("lowest", shell=order.shell), _LEFT, _TOP - 34, _SMALL, "start"))
    items.append(text(said("soft"), _WIDTH - _RIGHT - 12, y(frequency(order.threshold)) + 22, _SMALL, "end"))
    items.append(text(said("hoisted"), float(x[0]), y(0.0) + 68, _SMALL))
    for mode in reversed(range(shown.shape[1])):
        points = np.column_stack([x, [y(value) for value in shown[:, mode].tolist()]])
        colour, width = ("#000", 5.0) if mode == 0 else ("#777", 2.0)
        items.append(line(points, Style(stroke=colour, width=width, dash="" if mode == 0 else "8 6")))
        items.append(group((circle(point, 9.0 if mode == 0 else 6.0) for point in points), Style(colour)))
    frame = np.array([(_LEFT, y(top)), (_LEFT, y(0.0)), (_WIDTH - _RIGHT, y(0.0)), (_WIDTH - _RIGHT, y(top))])
    return svg(_WIDTH, _HEIGHT, [*items, polygon(frame, Style(stroke="#000", width=2.0))])
