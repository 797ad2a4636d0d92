"""Taking a gridshell down for reuse: a plan of its own, and not the assembly run backwards."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, groupby

import numpy as np

from aag_cad.geometry.framed import curvatures_at
from aag_cad.parts.model import Bolt, Gridshell, Rod, Shell, Timber
from aag_cad.units import MM_PER_M
from assembly.crew import crew_of, hands_for
from assembly.flat import flat_order, groups_of
from assembly.kit import Kit, shell_kit
from assembly.layers import crossing_levels, lying_unit
from assembly.plan import piece_weights
from assembly.process import BEAMS_A_STEP, EVERYONE, LAID_A_STEP, PAIR
from assembly.ranges import joined_ranges
from assembly.site import ridge_pairs
from assembly.steps import DownPhase, Plan, Step

_PAIRS_A_STEP = 4
_GRAVITY = 9.81
# Shells that these steps work on stay where they are.
_STAYING: tuple[DownPhase, ...] = ("prop", "open ridges")
_EACH_HELD: tuple[DownPhase, ...] = ("prop", "lift off", "hang", "lower")

# Tools, instructions and what to check after each phase.
_WORDS: dict[DownPhase, tuple[tuple[str, ...], tuple[str, ...], str]] = {
    "uncover": (
        ("cordless driver", "roof ladder", "slings"),
        (
            "Drive out the screws at the V marks; hold the clamping bar (D) until the last one is out.",
            "Take off clamping bars, strips (P), mullions (M) and the blocks on the geodesics, in this order.",
            "Strips and bars spring straight as they come free: two people, one at each end.",
        ),
        "Nothing but timber and steel is left on the shell.",
    ),
    "prop": (
        ("props with forked heads", "base plates", "tape measure", "level"),
        (
            "Stand a prop under every second node along each ridge plank and one row under the middle of the shell.",
            "Turn the props up until each one bears and no further: they take over, they do not lift.",
        ),
        "Every prop bears and stands on its plate. No ridge is opened before all shells are propped.",
    ),
    "open ridges": (
        ("working platform", "clamps", "{spanners}"),
        (
            "Hold the two ridge planks together with clamps beside each blade.",
            "Take the blades out from the entry up to the crown, the crown last; then ease the clamps off evenly.",
        ),
        "Nobody under the crown. The gap opens by no more than 20 mm; if it opens farther, turn up the props.",
    ),
    "lift off": (
        ("lorry with crane", "soft slings", "tag lines", "{spanners}"),
        (
            "Sling the shell at the four nodes marked H until the slings bear its weight.",
            "Take out the bolts between the shoes (F) and the shell, from the sides to the middle.",
            "Lift the shell off its shoes and its props and set it down on the levelled floor, foot line on chocks.",
        ),
        "The shells that still stand bear on their props. This one stands on its foot line and is tied.",
    ),
    "clear feet": (
        ("{spanners}", "spade", "lifting gear"),
        ("Take the shoes off their rods, the rods out of the blocks and the blocks (C) out of the ground.",),
        "All feet are counted; the ground is filled.",
    ),
    "hang": (
        ("crane or four chain hoists", "soft slings", "props", "tag lines", "tape measure"),
        (
            "Hang the shell at the four nodes marked H, round the crossing and never round a single plank.",
            "Take up the slings until they bear half the weight; prop the middle and chock the foot line sideways.",
            "{spring}",
        ),
        "Four slings bear, the chocks hold the foot line. From here on the slings hold the shape.",
    ),
    "release geodesics": (
        ("cordless driver", "clamps"),
        (
            "Drive out the screws at the K marks of these geodesics, in pairs from the middle to the sides.",
            "Leave the stud bolts tight: they keep the beams from turning while the screws come out.",
            "A screw that binds bears load: take up the nearest sling first.",
        ),
        "Each geodesic slides by hand. The slings have not slackened.",
    ),
    "pull edge planks": (
        ("cordless driver", "clamps", "{spanners}"),
        (
            "Clamp the edge plank, take off the straps (R) with their bolts, then drive out its screws from both ends.",
            "Ease the clamps off and pull the plank out lengthwise; it springs straight.",
        ),
        "No edge plank is left between the beams.",
    ),
    "lower": (
        ("crane or four chain hoists", "{spanners}", "tag lines", "chocks"),
        (
            "Loosen the nuts of all studs by two turns, from outside, row by row from the top down, none of them off.",
            "The beams turn about the studs and the sides move out: wait until they rest before the next row.",
            "Take away the props, nobody under the shell, then let all slings down evenly and let the sides move out.",
            "Watch the geodesics: each slides between the beams. Free one that binds before going on.",
            "Do not leave the shell loosened in its slings: it lies flat before the end of the day.",
        ),
        "The shell lies flat on its lower beams; the slings are off.",
    ),
    "take off beams": (
        ("{spanners}", "mallet", "trestles"),
        (
            "{studs}",
            "Lift each beam straight off and carry it to its trestles, in the order of the marks above.",
        ),
        "Marks are legible on every beam.",
    ),
    "take off geodesics": (
        ("trestles",),
        ("Lift the geodesic planks off and carry them to their stack, flat.",),
        "The stack lies flat and dry; marks are legible.",
    ),
    "pull studs": (
        ("{spanners}", "drift pin", "mallet"),
        ("On the trestles take out the bolts of each stud and push the stud out of the gap.",),
        "Studs, bolts and washers are counted into their boxes.",
    ),
    "unbolt": (
        ("{spanners}", "clamps"),
        (
            "Clamp the two planks, take out the block bolts, then ease the clamps off.",
            "Lay planks L and R to their marks; blocks and bolts into their boxes.",
        ),
        "No plank without its mark.",
    ),
    "passports": (
        ("tape measure", "straight edge", "moisture meter"),
        (
            "Lay each plank on the straight edge: measure what is left of bend and twist, its length and its moisture.",
            "Look for splits at the holes. Write all into the plank's reuse passport, or mark the plank as waste.",
        ),
        "Every plank has its passport.",
    ),
}


@dataclass(frozen=True)
class _Task:
    id: str
    phase: DownPhase
    title: str
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
            yield _Task(bare[-1], "uncover", f"Take the cover off shell {mark}", "", (), kit.cover[::-1])
    for mark in kits:
        yield _Task(f"site.down.prop.{mark}", "prop", f"Prop shell {mark}", "", tuple(bare), (), (mark,))
    before = propped = tuple(f"site.down.prop.{mark}" for mark in kits)
    for a, b in reversed(ridge_pairs(gridshell)):
        blades = [joint for joint in gridshell.joints if {f"S{digit}" for digit in joint.mark[1:3]} == {a, b}]
        marks = (*_flat(joint.fasteners for joint in blades), *(joint.mark for joint in blades))
        task_id, title = f"site.down.ridge.{a}.{b}", f"Open the ridge between shells {a} and {b}"
        yield _Task(task_id, "open ridges", title, "", before, marks, (a, b), 2 * PAIR)
        before = (task_id,)
    open_ridges = before
    for mark, kit in kits.items():
        after = tuple(dict.fromkeys((*propped, *open_ridges)))
        title = f"Lift shell {mark} off its shoes"
        yield _Task(f"site.down.lift.{mark}", "lift off", title, "", after, kit.standing[::-1], (mark,), EVERYONE)
    feet = _flat(kit.feet[::-1] for kit in kits.values())
    if feet:
        lifts = tuple(f"site.down.lift.{mark}" for mark in kits)
        yield _Task("site.down.feet", "clear feet", "Clear the feet of the vault", "", lifts, feet)


def _unlocking(shell: str, flat: Sequence[str], kit: Kit, hoists: tuple[str, ...]) -> Iterator[_Task]:
    """Yield the release of a hanging shell: screws by pairs from the middle, inside first, edges, loose nuts, down.

    Inside comes first because people stand under the shell for it: all other things still hold then. ``hoists`` is the
    step that sets the hoists free.
    """
    hang = f"{shell}.down.hang"
    yield _Task(hang, "hang", f"Hang shell {shell} at its hoist points", shell, (f"site.down.lift.{shell}", *hoists),
                (), (shell,), EVERYONE)  # fmt: skip
    before, i = hang, 0
    for side, screws in (("inside", kit.inside), ("outside", kit.outside)):
        held = [mark for mark in flat if screws[mark]]
        half = (len(held) + 1) // 2
        pairs = [tuple(dict.fromkeys((held[k], held[-1 - k]))) for k in reversed(range(half))]
        for group in groups_of(pairs, _PAIRS_A_STEP):
            i, marks = i + 1, _flat(group)
            title = f"Release geodesics {joined_ranges(marks)} from {side}"
            task_id, out = f"{shell}.down.release.{i}", _flat(screws[mark][::-1] for mark in marks)
            yield _Task(task_id, "release geodesics", title, shell, (before,), out)
            before = task_id
    upper = tuple(mark for mark in kit.edges if mark not in kit.lower_edges)
    for name, planks in (("upper", upper), ("lower", kit.lower_edges)):
        if planks:
            title = f"Pull the {name} edge {'plank' if len(planks) == 1 else 'planks'} {joined_ranges(planks)}"
            task_id, out = f"{shell}.down.edge.{name}", _flat((*kit.edges[mark][::-1], mark) for mark in planks)
            yield _Task(task_id, "pull edge planks", title, shell, (before,), out, (), 2 * PAIR)
            before = task_id
    title = f"Loosen the studs and lower shell {shell} flat"
    yield _Task(f"{shell}.down.lower", "lower", title, shell, (before,), (), (shell,), EVERYONE)


@dataclass(frozen=True)
class _Studs:
    """Bolts that leave a stud with an upper beam, by beam; studs by the lowest beam; their last bolts, by stud."""

    upper: dict[str, list[str]]
    lowest: dict[str, list[str]]
    last: dict[str, list[str]]


def _stud_bolts(shell: Shell) -> _Studs:
    """Return whose the bolts of each stud are: of the beam that is nearest along the normal."""
    unit_of = {plank.mark: lying_unit(plank) for plank in shell.planks}
    bolts, levels = {bolt.mark: bolt for bolt in shell.bolts}, crossing_levels(shell)
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
    families = {lying_unit(plank): plank.family for plank in shell.planks}
    before, i, off = f"{name}.down.lower", 0, dict[str, str]()
    split = [tuple(units) for run in reversed(runs) for _, units in groupby(run[::-1], key=lambda u: families[u])]
    for group in (group for run in split for group in groups_of(run, LAID_A_STEP)):
        i, beams = i + 1, tuple(unit for unit in group if unit in kit.beams)
        loose = tuple(unit for unit in group if unit not in kit.beams)
        task_id, bolts = f"{name}.down.off.{i}", _flat(studs.upper.get(beam, ()) for beam in beams)
        what: DownPhase = "take off beams" if beams else "take off geodesics"
        title = f"Take off {'beams' if beams else 'geodesics'} {joined_ranges(group)}"
        yield _Task(task_id, what, title, name, (before,), (*bolts, *loose), beams)
        off |= dict.fromkeys(group, task_id)
        before = task_id
    ends = [before]
    groups = chain.from_iterable(groups_of([unit for unit in run if unit in kit.beams], BEAMS_A_STEP) for run in split)
    for k, group in enumerate(groups, start=1):
        taken = tuple(dict.fromkeys(off[beam] for beam in group))
        pulled = [stud for beam in group for stud in studs.lowest.get(beam, ())]
        if pulled:
            title, out = f"Pull the studs of beams {joined_ranges(group)}", _flat((*studs.last[s], s) for s in pulled)
            yield _Task(f"{name}.down.stud.{k}", "pull studs", title, name, taken, out)
            taken = (f"{name}.down.stud.{k}",)
        out = _flat(kit.beams[beam][::-1] for beam in group)
        yield _Task(f"{name}.down.unbolt.{k}", "unbolt", f"Unbolt beams {joined_ranges(group)}", name, taken, out)
        ends.append(f"{name}.down.unbolt.{k}")
    planks = tuple(sorted(plank.mark for plank in shell.planks))
    title = f"Measure the {len(planks)} planks of shell {name} into their passports"
    yield _Task(f"{name}.down.measure", "passports", title, name, tuple(ends), (), planks)


def _words(
    gridshell: Gridshell, task: _Task, weights: Mapping[str, tuple[float, float]]
) -> tuple[tuple[str, ...], ...]:
    """Return tools, instructions and (hold,) of a task, with sizes of spanners and the energy of a hanging shell."""
    listed: list[Bolt | Rod] = [*gridshell.bolts]
    for shell in gridshell.shells:
        listed += [*shell.bolts, *shell.rods]
    leaving = set(task.marks)
    out = [part for part in listed if part.mark in leaving]
    held = [bolt for shell in gridshell.shells if shell.mark == task.shell for bolt in shell.bolts]
    sizes = sorted({part.across_flats for part in (out or held) if isinstance(part, Bolt | Rod)})
    spring = ""
    if task.phase == "hang":
        shell = next(shell for shell in gridshell.shells if shell.mark == task.shell)
        energy, kg = stored_energy(shell, gridshell.timber), weights[shell.mark][0]
        spring = (
            f"It will spring back towards flat: its planks hold up to {energy:.0f} J of bending and twisting, as much "
            f"as its {kg:.0f} kg lifted by {energy / (kg * _GRAVITY) * MM_PER_M:.0f} mm."
        )
    figures = {
        "spanners": " and ".join(f"two {size:g} mm spanners" for size in sizes) or "two spanners",
        "spring": spring,
        "studs": "Take out the bolts that join these beams to the studs; do not touch the other bolts."
        if task.marks
        else "The studs stay in these beams until they lie on trestles.",
    }
    tools, instructions, hold = _WORDS[task.phase]
    return tuple(t.format_map(figures) for t in tools), tuple(t.format_map(figures) for t in instructions), (hold,)


def disassembly_of(gridshell: Gridshell, people: int, lift_limit: float) -> Plan:
    """Return the plan of taking a gridshell down for reuse, by ``people`` who lift at most ``lift_limit`` kg each.

    ``marks`` are the parts that leave in a step, in the order in which they do. Cover off, all shells propped, ridges
    opened, each shell lifted off, released while it hangs, lowered flat, taken apart and measured (paper, section 5).
    One set of hoists serves all shells, so that one hangs at a time.

    PlanError if the layers are woven in a circle, a part belongs to no joint, or the crew is empty.
    """
    crew, weights = crew_of(people, lift_limit), piece_weights(gridshell)
    kits = {shell.mark: shell_kit(shell) for shell in gridshell.shells}
    chapters = [list(_site_tasks(gridshell, kits))]
    hoists: tuple[str, ...] = ()
    for shell in gridshell.shells:
        runs, kit = flat_order(shell).runs, kits[shell.mark]
        flat = [unit for unit in _flat(runs) if unit in kit.inside]
        chapters.append([*_unlocking(shell.mark, flat, kit, hoists), *_dismantling(shell, runs, kit)])
        hoists = (f"{shell.mark}.down.lower",)
    steps: list[Step] = []
    for tasks in chapters:
        for i, task in enumerate(tasks):
            pieces = [weights[mark] for mark in (*task.marks, *(() if task.phase in _STAYING else task.assemblies))]
            hands = hands_for(crew, max((m for m, _ in pieces), default=0.0), max((n for _, n in pieces), default=0.0))
            tools, instructions, (hold,) = _words(gridshell, task, weights)
            last = task.phase in _EACH_HELD or all(later.phase != task.phase for later in tasks[i + 1 :])
            gear = hands.gear and task.least_crew <= people and not any("crane" in t or "gear" in t for t in tools)
            steps.append(Step(
                number=len(steps) + 1,
                id=task.id,
                phase=task.phase,
                title=task.title,
                shell=task.shell,
                marks=task.marks,
                assemblies=task.assemblies,
                tools=(*tools, "lifting gear") if gear else tools,
                crew=max(hands.people, min(task.least_crew, people)),
                predecessors=task.after,
                instructions=instructions,
                hold=hold if last else "",
            ))  # fmt: skip
    return Plan(gridshell.name, tuple(steps))
