"""Taking a gridshell down for reuse: a plan of its own, and not the assembly run backwards."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, groupby

import numpy as np

from aag_cad.geometry.framed import curvatures_at
from aag_cad.language import Figure, Text, text
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import is_driven, kind_of
from aag_cad.parts.marks import is_in_shell, shells_of
from aag_cad.parts.model import Gridshell, Shell, Timber
from aag_cad.units import MM_PER_M
from assembly.base.lifters import lifters_of
from assembly.base.mark_ranges import joined_ranges
from assembly.base.part_groups import Kit, shell_kit
from assembly.base.phases import PHASE, DownPhase
from assembly.base.segments import Segmentation, segments_of
from assembly.base.steps import Extra, Plan, StepProp, WholeShell
from assembly.graph.layers import crossing_levels
from assembly.laying.order import FlatOrder, flat_orders, groups_of
from assembly.plan.parting import splice_extras
from assembly.plan.piece_weights import piece_weights
from assembly.plan.shape_control import prop_points
from assembly.plan.shell_work import BEAMS_A_STEP
from assembly.plan.site_work import ridge_pairs
from assembly.plan.step_cards import spanners
from assembly.plan.work import EVERYONE, LAID_A_STEP, PAIR, Work, all_of, props_under, steps_from

_PAIRS_A_STEP = 4
_GRAVITY = 9.81


@dataclass(frozen=True)
class _Down:
    """What the works of taking down are made from: the parts of each shell by what they leave with, and its props."""

    gridshell: Gridshell
    kits: Mapping[str, Kit]
    props: Mapping[str, tuple[StepProp, ...]]
    weights: Mapping[str, tuple[float, float]]
    segmentation: Segmentation | None

    def work(
        self,
        name: str,
        phase: DownPhase,
        title: Text,
        shell: str = "",
        after: tuple[str, ...] = (),
        marks: tuple[str, ...] = (),
        assemblies: tuple[str, ...] = (),
        least_crew: int = PAIR,
    ) -> Work:
        """Return a piece of work with its card, its props, and what it takes off of the splices of cut shells."""
        held = (shell,) if shell else assemblies
        return Work(
            id=name,
            phase=phase,
            title=title,
            card=self._card(phase, shell, marks),
            shell=shell,
            after=after,
            marks=marks,
            assemblies=assemblies,
            least_crew=least_crew,
            props=tuple(prop for mark in held for prop in self.props[mark]) if PHASE[phase].propped else (),
            extras=self._extras(phase, marks, assemblies),
        )

    def _card(self, phase: DownPhase, shell: str, marks: tuple[str, ...]) -> Text:
        """Return the key of a card, with the spanners for what leaves and the energy of a hanging shell."""
        index = index_of(self.gridshell)
        leaving = [index.parts[mark] for mark in marks]
        out = [part for part in leaving if kind_of(part).role == "fastener" and not is_driven(part)]
        held = index.shells[shell].bolts if shell else ()
        straps = not index.straps.keys().isdisjoint(marks)
        return text(
            f"down.{phase}{' alone' if phase == 'pull edge planks' and not straps else ''}",
            spanners=spanners(out or held),
            spring=self._spring(shell) if phase == "hang" else "",
            studs=text(f"down.words.{'studs_out' if marks else 'studs_stay'}"),
        )

    def _spring(self, shell: str) -> Text:
        energy = stored_energy(index_of(self.gridshell).shells[shell], self.gridshell.timber)
        kg = self.weights[shell][0]
        lift = energy / (kg * _GRAVITY) * MM_PER_M
        return text("down.words.spring", energy=energy, mass=kg, lift=lift)

    def _extras(self, phase: DownPhase, marks: tuple[str, ...], assemblies: tuple[str, ...]) -> tuple[Extra, ...]:
        """Return what is taken off of the splices of cut shells; these are lifted off whole."""
        cut = [s for mark in assemblies for s in segments_of(self.segmentation, mark)] if phase == "lift off" else []
        if not cut or self.segmentation is None:
            return tuple(splice_extras(self.segmentation, set(marks), "unmade"))
        shell = cut[0].shell
        lines = dict.fromkeys(s.line for s in self.segmentation.splices if is_in_shell(s.line, shell))
        return (WholeShell(tuple(s.name for s in cut), tuple(lines), self.weights[shell][0]),)


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


def _title(name: str, **figures: Figure) -> Text:
    return text(f"down.titles.{name}", **figures)


def _site_works(down: _Down) -> Iterator[Work]:
    """Yield the work on the site: cover off, all shells propped, ridges opened, shells lifted off, feet cleared."""
    kits, bare = down.kits, list[str]()
    for mark, kit in kits.items():
        if kit.cover:
            bare.append(f"site.down.cover.{mark}")
            yield down.work(bare[-1], "uncover", _title("uncover", shell=mark), marks=kit.cover[::-1])
    propped = tuple(f"site.down.prop.{mark}" for mark in kits)
    for name, mark in zip(propped, kits, strict=True):
        yield down.work(name, "prop", _title("prop", shell=mark), after=tuple(bare), assemblies=(mark,))
    before = propped
    for a, b in reversed(ridge_pairs(down.gridshell)):
        blades = [joint for joint in down.gridshell.joints if set(shells_of(joint.mark)) == {a, b}]
        marks = (*all_of(joint.fasteners for joint in blades), *(joint.mark for joint in blades))
        name, title = f"site.down.ridge.{a}.{b}", _title("ridge", a=a, b=b)
        yield down.work(name, "open ridges", title, "", before, marks, (a, b), 2 * PAIR)
        before = (name,)
    after = tuple(dict.fromkeys((*propped, *before)))
    lifts = tuple(f"site.down.lift.{mark}" for mark in kits)
    for name, (mark, kit) in zip(lifts, kits.items(), strict=True):
        yield down.work(name, "lift off", _title("lift", shell=mark), "", after, kit.standing[::-1], (mark,), EVERYONE)
    if feet := all_of(kit.feet[::-1] for kit in kits.values()):
        yield down.work("site.down.feet", "clear feet", _title("feet"), "", lifts, feet)


def _unlocking(down: _Down, shell: str, flat: Sequence[str], after: tuple[str, ...]) -> Iterator[Work]:
    """Yield the release of a hanging shell: screws by pairs from the middle, inside first, edges, loose nuts, down.

    Inside comes first because people stand under the shell for it: all other things still hold then. ``after`` are the
    works that lift the shell off its feet and set the hoists free.
    """
    kit, before, i = down.kits[shell], f"{shell}.down.hang", 0
    yield down.work(before, "hang", _title("hang", shell=shell), shell, after, (), (shell,), EVERYONE)
    for side, screws in (("inside", kit.inside), ("outside", kit.outside)):
        held = [mark for mark in flat if screws[mark]]
        half = (len(held) + 1) // 2
        pairs = [tuple(dict.fromkeys((held[k], held[-1 - k]))) for k in reversed(range(half))]
        for group in groups_of(pairs, _PAIRS_A_STEP):
            i, marks = i + 1, all_of(group)
            name, out = f"{shell}.down.release.{i}", all_of(screws[mark][::-1] for mark in marks)
            title = _title(f"release_{side}", marks=joined_ranges(marks))
            yield down.work(name, "release geodesics", title, shell, (before,), out)
            before = name
    upper = tuple(mark for mark in kit.edges if mark not in kit.lower_edges)
    for place, planks in (("upper", upper), ("lower", kit.lower_edges)):
        if planks:
            title = _title(f"{place}_{'edge' if len(planks) == 1 else 'edges'}", marks=joined_ranges(planks))
            name, out = f"{shell}.down.edge.{place}", all_of((*kit.edges[mark][::-1], mark) for mark in planks)
            yield down.work(name, "pull edge planks", title, shell, (before,), out, (), 2 * PAIR)
            before = name
    name, title = f"{shell}.down.lower", _title("lower", shell=shell)
    yield down.work(name, "lower", title, shell, (before,), (), (shell,), EVERYONE)


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


def _dismantling(down: _Down, shell: Shell, runs: Sequence[Sequence[str]], lowered: str) -> Iterator[Work]:
    """Yield the taking apart of the flat shell: layers from the top, then on trestles studs, beams, passports."""
    name, kit, studs, laid = shell.mark, down.kits[shell.mark], _stud_bolts(shell), index_of(shell).units
    before, off = lowered, dict[str, str]()
    split = [tuple(units) for run in reversed(runs) for _, units in groupby(run[::-1], key=lambda u: laid[u].family)]
    for i, group in enumerate((group for run in split for group in groups_of(run, LAID_A_STEP)), start=1):
        beams = tuple(unit for unit in group if unit in kit.beams)
        loose = tuple(unit for unit in group if unit not in kit.beams)
        bolts = all_of(studs.upper.get(beam, ()) for beam in beams)
        phase: DownPhase = "take off beams" if beams else "take off geodesics"
        title = _title("beams" if beams else "geodesics", marks=joined_ranges(group))
        work = down.work(f"{name}.down.off.{i}", phase, title, name, (before,), (*bolts, *loose), beams)
        yield work
        off |= dict.fromkeys(group, work.id)
        before = work.id
    ends = [before]
    groups = chain.from_iterable(groups_of([unit for unit in run if unit in kit.beams], BEAMS_A_STEP) for run in split)
    for k, group in enumerate(groups, start=1):
        taken, marks = tuple(dict.fromkeys(off[beam] for beam in group)), joined_ranges(group)
        if pulled := [stud for beam in group for stud in studs.lowest.get(beam, ())]:
            out = all_of((*studs.last[s], s) for s in pulled)
            yield down.work(f"{name}.down.stud.{k}", "pull studs", _title("studs", marks=marks), name, taken, out)
            taken = (f"{name}.down.stud.{k}",)
        ends.append(f"{name}.down.unbolt.{k}")
        out = all_of(kit.beams[beam][::-1] for beam in group)
        yield down.work(ends[-1], "unbolt", _title("unbolt", marks=marks), name, taken, out)
    planks = tuple(sorted(plank.mark for plank in shell.planks))
    title = _title("passports", count=len(planks), shell=name)
    yield down.work(f"{name}.down.measure", "passports", title, name, tuple(ends), (), planks)


def disassembly_of(
    gridshell: Gridshell,
    people: int,
    lift_limit: float,
    *,
    orders: Mapping[str, FlatOrder] | None = None,
    segmentation: Segmentation | None = None,
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
    lifters, weights = lifters_of(people, lift_limit), piece_weights(gridshell)
    laid = orders if orders is not None else flat_orders(gridshell)
    kits = {shell.mark: shell_kit(shell) for shell in gridshell.shells}
    props = {shell.mark: props_under(prop_points(shell), shell.mark) for shell in gridshell.shells}
    down = _Down(gridshell, kits, props, weights, segmentation)
    site = list(_site_works(down))
    lifts = {mark: work.id for work in site if work.phase == "lift off" for mark in work.assemblies}
    works, hoists = site, tuple[str, ...]()
    for shell in gridshell.shells:
        order, kit = laid[shell.mark], kits[shell.mark]
        slid = tuple(slide.unit for slide in order.slides)
        runs = (*order.runs, slid) if slid else order.runs
        flat = [unit for unit in all_of(runs) if unit in kit.inside]
        hung = list(_unlocking(down, shell.mark, flat, (lifts[shell.mark], *hoists)))
        hoists = (hung[-1].id,)
        works += [*hung, *_dismantling(down, shell, runs, hung[-1].id)]
    return Plan(gridshell.name, tuple(steps_from(works, weights, lifters)))
