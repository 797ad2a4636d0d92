"""The order in which a hoisted shell's flat planks are fixed: the softest mode is to stiffen fastest.

After hoisting, the beams turn on their studs like scissors and the geodesics lie loose between them. Each plank that is
screwed on takes freedom away (paper, section 3.1: the geodesics lock the kinetic erection). Method and assumptions:
docs/locking.md.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain, combinations
from typing import Any, TypeAlias

import numpy as np

from aag_cad.language import Language, figure, say, says, words_table
from aag_cad.parts.marks import in_other_shell, short_mark
from aag_cad.parts.model import Gridshell, Shell, Timber
from aag_cad.units import Floats
from assembly.base.errors import PlanError
from assembly.base.mark_ranges import joined_ranges
from assembly.drawing.svg import CHARACTER, Style, circle, group, line, polygon, rectangle, svg, text
from assembly.locking.model import (
    LockingModel,
    Prop,
    Sag,
    locking_model,
    modes_of,
    released_frame,
    sag_of,
    softest_of,
    state_modes,
    state_sag,
)

Group: TypeAlias = tuple[str, ...]
Value: TypeAlias = Callable[[frozenset[Group]], float]

SOFT = 0.5
SAG_LIMIT = 20.0
MODES = 6
MOST_PROPS = 4
_DIGITS = 6

LOCKING_HEADER = (
    "shell", "step", "fixed", "soft_modes", "lowest_eigenvalue_1_s2", "mode_1_hz", "mode_2_hz", "mode_3_hz",
    "displacement_mm", "at", "props", "displacement_with_props_mm",
)  # fmt: skip


@dataclass(frozen=True)
class LockingStep:
    """A shell after a step: the planks fixed in it (none: just hoisted), and what that leaves.

    ``eigenvalues`` are the lowest ones of K v = lambda M v, 1/s2; ``soft_modes`` how many are below the threshold of
    the order; ``displacement`` the largest under self-weight, mm, at joint ``at``. ``props`` are proposed where a soft
    mode is left and the displacement exceeds the limit; ``propped`` is the displacement with them, mm.
    """

    marks: Group
    eigenvalues: tuple[float, ...]
    soft_modes: int
    displacement: float
    at: str
    props: tuple[Prop, ...]
    propped: float


@dataclass(frozen=True)
class LockingOrder:
    """The order of fixing of a shell: first the state after hoisting, then a step for each group of planks.

    ``feet`` are held in x, y and z, the studs ``hoists`` in z. A mode is soft if its eigenvalue is below ``threshold``,
    1/s2. ``released`` is the shell with all planks fixed, all bolts tightened and the props at the hoists away.
    ``area`` is the sum of the lowest eigenvalue over the steps, ``free_area`` that of the order found without the rule
    that edge planks come first: ``rule_price`` is the share that the rule costs.
    """

    shell: str
    feet: tuple[str, ...]
    hoists: tuple[str, ...]
    edges_first: bool
    threshold: float
    limit: float
    steps: tuple[LockingStep, ...]
    released: LockingStep
    area: float
    free_area: float

    @property
    def rule_price(self) -> float:
        """The share of the area under the lowest eigenvalue that is lost by fixing the edge planks first."""
        return 1.0 - self.area / self.free_area


def frequency(eigenvalue: float) -> float:
    """Return the frequency in Hz of an eigenvalue in 1/s2; 0 for one that rounding left below 0."""
    return math.sqrt(max(0.0, eigenvalue)) / (2.0 * math.pi)


def soft_mode_count(eigenvalues: Sequence[float], threshold: float) -> int:
    """Return how many eigenvalues are below a threshold."""
    return sum(value < threshold for value in eigenvalues)


def greedy_order(groups: Sequence[Group], value: Value, first: Sequence[Group] = ()) -> tuple[Group, ...]:
    """Return the groups in an order: those of ``first``, then each time the one that gives the greatest value.

    Values that agree to six digits count as equal: then the earlier group comes first.
    """
    order, left = list(first), [item for item in groups if item not in first]
    while left:
        done = frozenset(order)
        order.append(max(left, key=lambda item: float(f"{value(done | {item}):.{_DIGITS}g}")))
        left.remove(order[-1])
    return tuple(order)


def area_under(order: Sequence[Group], value: Value) -> float:
    """Return the sum of the values after each step of an order."""
    return sum(value(frozenset(order[: i + 1])) for i in range(len(order)))


def best_order(groups: Sequence[Group], value: Value, first: Sequence[Group] = ()) -> tuple[Group, ...]:
    """Return the best of all orders that begin with ``first`` by its area; 2^n values for n groups left.

    Dynamic programming: the best order of a set ends with some group, and is the best order of the others before it.
    """
    left = [item for item in groups if item not in first]
    start = frozenset(first)
    best: dict[frozenset[Group], tuple[float, tuple[Group, ...]]] = {frozenset(): (0.0, ())}
    for size in range(1, len(left) + 1):
        for chosen in map(frozenset, combinations(left, size)):
            before = [(*best[chosen - {last}], last) for last in left if last in chosen]
            area, order, last = max(before, key=lambda item: item[0])
            best[chosen] = area + value(start | chosen), (*order, last)
    return (*first, *best[frozenset(left)][1])


def lowest_eigenvalue(model: LockingModel) -> Value:
    """Return the function that gives the lowest eigenvalue, 1/s2, by the groups of planks that are fixed.

    It remembers what it has worked out, and starts each search from the softest modes of the state before.
    """
    known: dict[frozenset[Group], float] = {}
    guess: list[Floats] = []

    def value(groups: frozenset[Group]) -> float:
        if groups not in known:
            fixed = tuple(chain.from_iterable(sorted(groups)))
            known[groups], modes = softest_of(model, fixed, guess[-1] if guess else None)
            guess[:] = [modes]
        return known[groups]

    return value


def edge_groups(model: LockingModel) -> tuple[Group, ...]:
    """Return the edge planks in groups: the lower ones, then the upper ones."""
    return tuple(edges for edges in (model.lower, model.upper) if edges)


def _step(marks: Group, values: Floats, threshold: float, sag: Sag) -> LockingStep:
    eigenvalues = tuple(values.tolist())
    soft = soft_mode_count(eigenvalues, threshold)
    props, propped = (sag.props, sag.propped) if soft else ((), sag.displacement)
    return LockingStep(marks, eigenvalues, soft, sag.displacement, sag.joint, props, propped)


def _all_soft_modes(model: LockingModel, fixed: Group, threshold: float) -> Floats:
    """Return the lowest eigenvalues: ``MODES``, or all soft ones if these are more."""
    count = MODES
    while True:
        values, _ = modes_of(model, fixed, count)
        if values[-1] >= threshold or len(values) < count:
            return values[: max(MODES, soft_mode_count(values.tolist(), threshold))]
        count *= 2


def locking_order(
    shell: Shell,
    timber: Timber,
    *,
    edges_first: bool = True,
    pairs: bool = True,
    hoists: Sequence[str] | None = None,
    soft: float = SOFT,
    limit: float = SAG_LIMIT,
) -> LockingOrder:
    """Return the order in which the flat planks of a hoisted shell are fixed, found greedily.

    ``edges_first``: edge planks at the lower, then at the upper edge before all geodesics, as in the paper, section
    3.2; without it they take their turn. ``pairs``: G-k together with G-(n + 1 - k). ``hoists`` are the studs on props,
    by default four. ``soft`` is the share of the lowest eigenvalue of the finished shell under which a mode is soft;
    ``limit`` (mm) the displacement under self-weight beyond which props are proposed. PlanError if the shell has no
    feet or geodesics, or if ``soft`` or ``limit`` is out of range; FrameError if the shell is a mechanism.
    """
    if not (0.0 < soft <= 1.0 and limit > 0.0):
        raise PlanError(
            f"{shell.mark}: soft = {soft:g}, limit = {limit:g} mm; soft is a share above 0 and at most 1, limit "
            "more than 0 mm: mend them"
        )
    model = locking_model(shell, timber, hoists=hoists, pairs=pairs)
    edges, groups = edge_groups(model), (*edge_groups(model), *model.geodesics)
    value = lowest_eigenvalue(model)
    order = greedy_order(groups, value, edges if edges_first else ())
    free_order = greedy_order(groups, value) if edges_first else order
    threshold = soft * value(frozenset(groups))
    steps = []
    for i in range(len(order) + 1):
        fixed = tuple(chain.from_iterable(order[:i]))
        values = _all_soft_modes(model, fixed, threshold)
        steps.append(_step(order[i - 1] if i else (), values, threshold, sag_of(model, fixed, limit, MOST_PROPS)))
    every = tuple(chain.from_iterable(order))
    released = released_frame(shell, timber, model)
    values, _ = state_modes(released, every, MODES)
    return LockingOrder(
        shell=shell.mark,
        feet=model.feet,
        hoists=model.hoists,
        edges_first=edges_first,
        threshold=threshold,
        limit=limit,
        steps=tuple(steps),
        released=_step((), values, threshold, state_sag(released, every, limit, MOST_PROPS)),
        area=area_under(order, value),
        free_area=area_under(free_order, value),
    )


def _alike(one: Shell, other: Shell) -> bool:
    """Return whether two shells have the same planks and joints but for the shell's number in their marks."""

    def marks(shell: Shell) -> list[str]:
        return [short_mark(plank.mark) for plank in shell.planks] + [short_mark(joint.mark) for joint in shell.joints]

    return (
        marks(one) == marks(other)
        and all(a.blank.section == b.blank.section for a, b in zip(one.planks, other.planks, strict=True))
        and all(a.curve == b.curve for a, b in zip(one.planks, other.planks, strict=True))
        and all(a.normal == b.normal for a, b in zip(one.joints, other.joints, strict=True))
    )


def _renumbered(order: LockingOrder, shell: str) -> LockingOrder:
    """Return the order for another shell: the same with that shell's number in all marks."""

    def moved(marks: Sequence[str]) -> Group:
        return tuple(in_other_shell(mark, order.shell, shell) for mark in marks)

    def at_other(step: LockingStep) -> LockingStep:
        props = tuple(replace(prop, joint=moved([prop.joint])[0]) for prop in step.props)
        return replace(step, marks=moved(step.marks), at=moved([step.at])[0], props=props)

    return replace(
        order,
        shell=shell,
        feet=moved(order.feet),
        hoists=moved(order.hoists),
        steps=tuple(at_other(step) for step in order.steps),
        released=at_other(order.released),
    )


def locking_orders(
    gridshell: Gridshell, *, edges_first: bool = True, pairs: bool = True, soft: float = SOFT, limit: float = SAG_LIMIT
) -> tuple[LockingOrder, ...]:
    """Return the locking order of every shell; shells alike are worked out once. See ``locking_order``."""
    found: list[tuple[Shell, LockingOrder]] = []
    for shell in gridshell.shells:
        twin = next((order for other, order in found if _alike(other, shell)), None)
        order = twin or locking_order(
            shell, gridshell.timber, edges_first=edges_first, pairs=pairs, soft=soft, limit=limit
        )
        found.append((shell, _renumbered(order, shell.mark)))
    return tuple(order for _, order in found)


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


@dataclass(frozen=True)
class PlotWords:
    """The words of the plot; ``lowest`` has a place for the mark of the shell."""

    language: Language
    hoisted: str
    axis: str
    soft: str
    lowest: str


def plot_words(language: Language = "en") -> PlotWords:
    """Return the words of the plot in a language."""
    words = words_table("pictures")["locking"]
    return PlotWords(language, *(words[key][language] for key in ("hoisted", "axis", "soft", "lowest")))


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


def locking_svg(order: LockingOrder, words: PlotWords | None = None) -> str:
    """Return a plot of the lowest frequencies by step as SVG, 170 mm wide: black the softest mode, grey the next ones.

    The grey band below holds the soft modes.
    """
    said = words or plot_words()
    shown = np.array([[frequency(v) for v in step.eigenvalues[:_SHOWN]] for step in order.steps])
    top, ticks = _scale(float(shown.max()))

    def y(value: float) -> float:
        return _HEIGHT - _BOTTOM - value / top * (_HEIGHT - _TOP - _BOTTOM)

    x = np.linspace(_LEFT + 60.0, _WIDTH - _RIGHT - 60.0, len(order.steps))
    items = list(_axes(x, order, ticks, y, said.language))
    items.append(text(said.axis, _LEFT - 14, _TOP - 34, _SMALL, "end"))
    items.append(text(said.lowest.format(shell=order.shell), _LEFT, _TOP - 34, _SMALL, "start"))
    items.append(text(said.soft, _WIDTH - _RIGHT - 12, y(frequency(order.threshold)) + 22, _SMALL, "end"))
    items.append(text(said.hoisted, float(x[0]), y(0.0) + 68, _SMALL))
    for mode in reversed(range(shown.shape[1])):
        points = np.column_stack([x, [y(value) for value in shown[:, mode].tolist()]])
        colour, width = ("#000", 5.0) if mode == 0 else ("#777", 2.0)
        items.append(line(points, Style(stroke=colour, width=width, dash="" if mode == 0 else "8 6")))
        items.append(group((circle(point, 9.0 if mode == 0 else 6.0) for point in points), Style(colour)))
    frame = np.array([(_LEFT, y(top)), (_LEFT, y(0.0)), (_WIDTH - _RIGHT, y(0.0)), (_WIDTH - _RIGHT, y(top))])
    return svg(_WIDTH, _HEIGHT, [*items, polygon(frame, Style(stroke="#000", width=2.0))])
