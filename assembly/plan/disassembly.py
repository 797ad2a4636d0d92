"""Taking a gridshell down for reuse: a plan of its own, and not the assembly run backwards."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, groupby

import numpy as np

from aag_cad.geometry.framed import curvatures_at
from aag_cad.language import Figure, Language, say, says
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import is_in_shell, parse_mark, shells_of, short_mark
from aag_cad.parts.model import Bolt, Gridshell, Rod, Shell, Timber
from aag_cad.units import MM_PER_M
from assembly.base.crew import Crew, crew_of, hands_for
from assembly.base.mark_ranges import joined_ranges
from assembly.base.part_groups import Kit, shell_kit
from assembly.base.segments import Segmentation, segments_of
from assembly.base.steps import DownPhase, Plan, Step
from assembly.graph.layers import crossing_levels
from assembly.laying.order import FlatOrder, flat_orders, groups_of
from assembly.plan.assembly_plan import piece_weights
from assembly.plan.parting import splice_extras
from assembly.plan.shape_control import prop_points
from assembly.plan.shell_work import BEAMS_A_STEP, EVERYONE, LAID_A_STEP, PAIR
from assembly.plan.site_work import ridge_pairs
from assembly.plan.wording import Wording, spanners

_PAIRS_A_STEP = 4
_GRAVITY = 9.81
# Shells that these steps work on stay where they are.
_STAYING: tuple[DownPhase, ...] = ("prop", "open ridges")
_EACH_HELD: tuple[DownPhase, ...] = ("prop", "lift off", "hang", "lower")
# A shell stands on props in these: its neighbours or its planks let go. In the first they are set.
_PROPPED: tuple[DownPhase, ...] = (
    "prop", "open ridges", "lift off", "hang", "release geodesics", "pull edge planks", "lower",
)  # fmt: skip
# Their tools lift already.
_LIFTED_BY_GEAR: tuple[DownPhase, ...] = ("lift off", "clear feet", "hang", "lower")


@dataclass(frozen=True)
class _Task:
    """A step without its words and hands; ``title`` is a key of the titles, ``named`` what is filled in."""

    id: str
    phase: DownPhase
    title: str
    named: Mapping[str, Figure]
    shell: str
    after: tuple[str, ...]
    marks: tuple[str, ...] = ()
    assemblies: tuple[str, ...] = ()
    least_crew: int = PAIR


def stored_energy(shell: Shell, timber: Timber) -> float:
    """Return the energy of bending and twisting that a shell's planks hold, J.

    Half of E I kappa^2 + G J tau^2 along each plank (thin rectangles, St. Venant); timber that has crept holds less.
    """
    total = 0.0
    for plank in shell.planks:
        width, thick = plank.blank.section.width, plank.blank.section.thickness
        stations = np.linspace(0.0, plank.curve.length, 2 * len(plank.curve.stations) + 1)
        found = curvatures_at(plank.curve, stations)
        bending = timber.modulus * width * thick**3 / 12.0
        twisting = timber.shear_modulus * width * thick**3 / 3.0 * (1.0 - 0.63 * thick / width)
        weak = found.geodesic if plank.upright else found.normal
        total += float(np.trapezoid(bending * weak**2 + twisting * found.torsion**2, stations)) / 2.0
    return total / MM_PER_M


def _flat(groups: Iterable[Sequence[str]]) -> tuple[str, ...]:
    return tuple(chain.from_iterable(groups))


def _site_tasks(gridshell: Gridshell, kits: Mapping[str, Kit]) -> Iterator[_Task]:
    """Yield the work on the site: cover off, all shells propped, ridges opened, shells lifted off, feet cleared."""
    bare: list[str] = []
    for mark, kit in kits.items():
        if kit.cover:
            bare.append(f"site.down.cover.{mark}")
            yield _Task(bare[-1], "uncover", "uncover", {"shell": mark}, "", (), kit.cover[::-1])
    for mark in kits:
        yield _Task(f"site.down.prop.{mark}", "prop", "prop", {"shell": mark}, "", tuple(bare), (), (mark,))
    before = propped = tuple(f"site.down.prop.{mark}" for mark in kits)
    for a, b in reversed(ridge_pairs(gridshell)):
        blades = [joint for joint in gridshell.joints if set(shells_of(joint.mark)) == {a, b}]
        marks = (*_flat(joint.fasteners for joint in blades), *(joint.mark for joint in blades))
        task_id = f"site.down.ridge.{a}.{b}"
        yield _Task(task_id, "open ridges", "ridge", {"a": a, "b": b}, "", before, marks, (a, b), 2 * PAIR)
        before = (task_id,)
    open_ridges = before
    for mark, kit in kits.items():
        after = tuple(dict.fromkeys((*propped, *open_ridges)))
        task_id, out = f"site.down.lift.{mark}", kit.standing[::-1]
        yield _Task(task_id, "lift off", "lift", {"shell": mark}, "", after, out, (mark,), EVERYONE)
    feet = _flat(kit.feet[::-1] for kit in kits.values())
    if feet:
        lifts = tuple(f"site.down.lift.{mark}" for mark in kits)
        yield _Task("site.down.feet", "clear feet", "feet", {}, "", lifts, feet)


def _unlocking(shell: str, flat: Sequence[str], kit: Kit, hoists: tuple[str, ...]) -> Iterator[_Task]:
    """Yield the release of a hanging shell: screws by pairs from the middle, inside first, edges, loose nuts, down.

    Inside comes first because people stand under the shell for it: all other things still hold then. ``hoists`` is the
    step that sets the hoists free.
    """
    hang = f"{shell}.down.hang"
    named = {"shell": shell}
    yield _Task(hang, "hang", "hang", named, shell, (f"site.down.lift.{shell}", *hoists), (), (shell,), EVERYONE)
    before, i = hang, 0
    for side, screws in (("inside", kit.inside), ("outside", kit.outside)):
        held = [mark for mark in flat if screws[mark]]
        half = (len(held) + 1) // 2
        pairs = [tuple(dict.fromkeys((held[k], held[-1 - k]))) for k in reversed(range(half))]
        for group in groups_of(pairs, _PAIRS_A_STEP):
            i, marks = i + 1, _flat(group)
            told = {"marks": joined_ranges(marks)}
            task_id, out = f"{shell}.down.release.{i}", _flat(screws[mark][::-1] for mark in marks)
            yield _Task(task_id, "release geodesics", f"release_{side}", told, shell, (before,), out)
            before = task_id
    upper = tuple(mark for mark in kit.edges if mark not in kit.lower_edges)
    for name, planks in (("upper", upper), ("lower", kit.lower_edges)):
        if planks:
            title, told = f"{name}_{'edge' if len(planks) == 1 else 'edges'}", {"marks": joined_ranges(planks)}
            task_id, out = f"{shell}.down.edge.{name}", _flat((*kit.edges[mark][::-1], mark) for mark in planks)
            yield _Task(task_id, "pull edge planks", title, told, shell, (before,), out, (), 2 * PAIR)
            before = task_id
    yield _Task(f"{shell}.down.lower", "lower", "lower", named, shell, (before,), (), (shell,), EVERYONE)


@dataclass(frozen=True)
class _Studs:
    """Bolts that leave a stud with an upper beam, by beam; studs by the lowest beam; their last bolts, by stud."""

    upper: dict[str, list[str]]
    lowest: dict[str, list[str]]
    last: dict[str, list[str]]


def _stud_bolts(shell: Shell) -> _Studs:
    """Return whose the bolts of each stud are: of the beam that is nearest along the normal."""
    unit_of = index_of(shell).unit_of
    bolts, levels = index_of(shell).bolts, crossing_levels(shell)
    found = _Studs(defaultdict(list), defaultdict(list), defaultdict(list))
    for joint in (joint for joint in shell.joints if joint.kind == "AA"):
        heights = [(level.height, unit_of[level.mark]) for level in levels[joint.mark] if level.mark in unit_of]
        found.lowest[heights[0][1]].append(joint.mark)
        for mark in joint.fasteners:
            high = float((np.array(bolts[mark].frame.origin) - np.array(joint.point)) @ np.array(joint.normal))
            unit = min(heights, key=lambda level: abs(level[0] - high))[1]
            (found.last[joint.mark] if unit == heights[0][1] else found.upper[unit]).append(mark)
    return found


def _dismantling(shell: Shell, runs: Sequence[Sequence[str]], kit: Kit) -> Iterator[_Task]:
    """Yield the taking apart of the flat shell: layers from the top, then on trestles studs, beams, passports."""
    name, studs = shell.mark, _stud_bolts(shell)
    laid = index_of(shell).units
    before, i, off = f"{name}.down.lower", 0, dict[str, str]()
    split = [tuple(units) for run in reversed(runs) for _, units in groupby(run[::-1], key=lambda u: laid[u].family)]
    for group in (group for run in split for group in groups_of(run, LAID_A_STEP)):
        i, beams = i + 1, tuple(unit for unit in group if unit in kit.beams)
        loose = tuple(unit for unit in group if unit not in kit.beams)
        task_id, bolts = f"{name}.down.off.{i}", _flat(studs.upper.get(beam, ()) for beam in beams)
        what: DownPhase = "take off beams" if beams else "take off geodesics"
        title, told = "beams" if beams else "geodesics", {"marks": joined_ranges(group)}
        yield _Task(task_id, what, title, told, name, (before,), (*bolts, *loose), beams)
        off |= dict.fromkeys(group, task_id)
        before = task_id
    ends = [before]
    groups = chain.from_iterable(groups_of([unit for unit in run if unit in kit.beams], BEAMS_A_STEP) for run in split)
    for k, group in enumerate(groups, start=1):
        taken = tuple(dict.fromkeys(off[beam] for beam in group))
        pulled = [stud for beam in group for stud in studs.lowest.get(beam, ())]
        told = {"marks": joined_ranges(group)}
        if pulled:
            out = _flat((*studs.last[s], s) for s in pulled)
            yield _Task(f"{name}.down.stud.{k}", "pull studs", "studs", told, name, taken, out)
            taken = (f"{name}.down.stud.{k}",)
        out = _flat(kit.beams[beam][::-1] for beam in group)
        yield _Task(f"{name}.down.unbolt.{k}", "unbolt", "unbolt", told, name, taken, out)
        ends.append(f"{name}.down.unbolt.{k}")
    planks = tuple(sorted(plank.mark for plank in shell.planks))
    counted: dict[str, Figure] = {"count": len(planks), "shell": name}
    yield _Task(f"{name}.down.measure", "passports", "passports", counted, name, tuple(ends), (), planks)


def _words(
    gridshell: Gridshell, task: _Task, weights: Mapping[str, tuple[float, float]], language: Language
) -> Wording:
    """Return the words of a task, with sizes of spanners and the energy of a hanging shell."""
    listed: list[Bolt | Rod] = [*gridshell.bolts]
    for shell in gridshell.shells:
        listed += [*shell.bolts, *shell.rods]
    leaving = set(task.marks)
    out = [part for part in listed if part.mark in leaving]
    held = [bolt for shell in gridshell.shells if shell.mark == task.shell for bolt in shell.bolts]
    spring = ""
    if task.phase == "hang":
        shell = index_of(gridshell).shells[task.shell]
        energy, kg = stored_energy(shell, gridshell.timber), weights[shell.mark][0]
        lift = energy / (kg * _GRAVITY) * MM_PER_M
        spring = say(language, "down.words.spring", energy=f"{energy:.0f}", mass=f"{kg:.0f}", lift=f"{lift:.0f}")
    figures = {
        "spanners": spanners(out or held, language),
        "spring": spring,
        "studs": say(language, f"down.words.{'studs_out' if task.marks else 'studs_stay'}"),
    }
    straps = any(parse_mark(mark).family == "R" for mark in task.marks)
    key = f"down.{task.phase}" + " alone" * (task.phase == "pull edge planks" and not straps)
    return Wording(
        tools=says(language, f"{key}.tools", **figures),
        instructions=says(language, f"{key}.instructions", **figures),
        hold=say(language, f"{key}.hold", **figures),
    )


def _step(
    task: _Task,
    number: int,
    words: Wording,
    crew: Crew,
    weights: Mapping[str, tuple[float, float]],
    props: Mapping[str, tuple[str, ...]],
    extras: tuple[str, ...],
    language: Language,
) -> Step:
    """Return the step of a task, with the hands for its heaviest and longest piece; ``props`` by shell."""
    pieces = [weights[mark] for mark in (*task.marks, *(() if task.phase in _STAYING else task.assemblies))]
    hands = hands_for(crew, max((m for m, _ in pieces), default=0.0), max((n for _, n in pieces), default=0.0))
    held = (task.shell,) if task.shell else task.assemblies
    gear = hands.gear and task.least_crew <= crew.people and task.phase not in _LIFTED_BY_GEAR
    return Step(
        number=number,
        id=task.id,
        phase=task.phase,
        title=say(language, f"down.titles.{task.title}", **task.named),
        shell=task.shell,
        marks=task.marks,
        assemblies=task.assemblies,
        tools=(*words.tools, say(language, "down.words.gear")) if gear else words.tools,
        crew=max(hands.people, min(task.least_crew, crew.people)),
        predecessors=task.after,
        instructions=words.instructions,
        hold=words.hold,
        props=_flat(props[mark] for mark in held) if task.phase in _PROPPED else (),
        extras=extras,
    )


def _extras(
    task: _Task, segmentation: Segmentation | None, weights: Mapping[str, tuple[float, float]], language: Language
) -> tuple[str, ...]:
    """Return what a task takes off of the splices of cut shells; these are lifted off whole."""
    own = [s for mark in task.assemblies for s in segments_of(segmentation, mark)] if task.phase == "lift off" else []
    if not own or segmentation is None:
        return tuple(splice_extras(language, segmentation, set(task.marks), "unmade"))
    shell = own[0].shell
    lines = dict.fromkeys(short_mark(s.line) for s in segmentation.splices if is_in_shell(s.line, shell))
    told: dict[str, Figure] = {
        "segments": ", ".join(s.name for s in own),
        "lines": ", ".join(lines),
        "mass": weights[shell][0],
    }
    return (say(language, "site.unmade.whole", **told),)


def disassembly_of(
    gridshell: Gridshell,
    people: int,
    lift_limit: float,
    *,
    orders: Mapping[str, FlatOrder] | None = None,
    segmentation: Segmentation | None = None,
    language: Language = "en",
) -> Plan:
    """Return the plan of taking a gridshell down for reuse, by ``people`` who lift at most ``lift_limit`` kg each.

    ``marks`` are the parts that leave in a step, in the order in which they do. Cover off, all shells propped, ridges
    opened, each shell lifted off, released while it hangs, lowered flat, taken apart and measured (paper, section 5).
    One set of hoists serves all shells, so that one hangs at a time. ``orders`` say how each shell was laid flat, by
    mark (none: ``flat_orders``); what was slid in is pulled out first. Shells that ``segmentation`` cut are lifted off
    whole, as they were joined on site; their splices come apart with their beams and edge planks. The texts are those
    of ``templates/printouts/words/down.toml``.

    PlanError if the layers are woven in a circle, a part belongs to no joint, or the crew is empty.
    """
    crew, weights = crew_of(people, lift_limit), piece_weights(gridshell)
    laid = orders if orders is not None else flat_orders(gridshell)
    kits = {shell.mark: shell_kit(shell) for shell in gridshell.shells}
    props = {shell.mark: prop_points(shell) for shell in gridshell.shells}
    chapters = [list(_site_tasks(gridshell, kits))]
    hoists: tuple[str, ...] = ()
    for shell in gridshell.shells:
        order, kit = laid[shell.mark], kits[shell.mark]
        slid = tuple(slide.unit for slide in order.slides)
        runs = (*order.runs, slid) if slid else order.runs
        flat = [unit for unit in _flat(runs) if unit in kit.inside]
        chapters.append([*_unlocking(shell.mark, flat, kit, hoists), *_dismantling(shell, runs, kit)])
        hoists = (f"{shell.mark}.down.lower",)
    steps: list[Step] = []
    for tasks in chapters:
        for i, task in enumerate(tasks):
            last = task.phase in _EACH_HELD or all(later.phase != task.phase for later in tasks[i + 1 :])
            words = _words(gridshell, task, weights, language)
            words = words if last else replace(words, hold="")
            extras = _extras(task, segmentation, weights, language)
            steps.append(_step(task, len(steps) + 1, words, crew, weights, props, extras, language))
    return Plan(gridshell.name, tuple(steps), language)
