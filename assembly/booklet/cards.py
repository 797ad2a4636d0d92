"""The words and tables of the step cards, as plain data for the template."""

from collections import defaultdict
from collections.abc import Mapping, Sequence, Set
from itertools import zip_longest
from typing import Any

import numpy as np

from aag_cad.families import FAMILIES
from aag_cad.language import Language, figure, say, says, words_table
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import is_driven, kind_of
from aag_cad.parts.marks import joint_of, parse_mark, shell_of, short_mark, whole_of
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Gridshell, Part, Shell, all_parts, shell_parts
from assembly.base.mark_ranges import joined_ranges, mark_ranges
from assembly.base.part_groups import driven_from_outside
from assembly.base.phases import PHASE, PHASES
from assembly.base.steps import Plan, Step, carried
from assembly.booklet.step_words import step_title, step_words
from assembly.drawing.names import part_name, phase_name
from assembly.plan.shape_control import control_figures, sling_points

__all__ = ["part_rows", "phase_name", "qr_text", "step_card", "step_table", "totals"]

Weights = Mapping[str, tuple[float, float]]

_WORTH_SAYING = 1.0
_TIGHTENED = ("AA", "AG", "boundary", "ridge")
# A square code of the size on the card stays readable for a telephone up to here.
_QR_CHARACTERS = 300


def _length(mm: float) -> str:
    return f"{mm:.0f} mm"


def _mass(kg: float, language: Language) -> str:
    return figure(f"{kg:.1f} kg" if kg < 100.0 else f"{kg:.0f} kg", language)


def _table(language: Language, name: str, rows: list[list[str]]) -> dict[str, Any]:
    return {"head": list(says(language, f"cards.{name}.head")), "rows": rows}


def part_rows(
    parts: Mapping[str, Part], marks: tuple[str, ...], outer: Set[str] = frozenset(), language: Language = "en"
) -> list[list[str]]:
    """Return one line for each product among the marks: count, what it is, and which marks or at which joints.

    ``outer`` are the screws that are driven from outside: they get a line of their own.
    """
    groups: dict[str, list[str]] = defaultdict(list)
    for mark in marks:
        name = part_name(parts[mark], language)
        if is_driven(parts[mark]):
            name = say(language, f"cards.where.{'outside' if mark in outer else 'inside'}", name=name)
        groups[name].append(mark)
    rows = []
    for name, listed in groups.items():
        joints = tuple(dict.fromkeys(joint_of(mark) for mark in listed))
        each, left = divmod(len(listed), len(joints))
        if kind_of(parts[listed[0]]).role != "fastener":
            where = joined_ranges(listed)
        elif each > 1 and not left:
            where = say(language, "cards.where.each", joints=joined_ranges(joints), count=each)
        else:
            where = say(language, "cards.where.at", joints=joined_ranges(joints))
        rows.append([str(len(listed)), name, where])
    return rows


def _beam_table(shell: Shell, step: Step, weights: Weights, language: Language) -> dict[str, Any]:
    index = index_of(shell)
    beams = [beam for beam in shell.beams if set(beam.planks) <= set(step.marks)]
    rows = []
    for beam in beams:
        left, right = (index.planks[mark].blank.length for mark in beam.planks)
        blocks = [place.joint for place in beam.joints if place.joint in index.blocks]
        studs = [place.joint for place in beam.joints if place.joint in index.studs]
        rows.append([
            short_mark(beam.mark), _length(left), _length(right), str(len(blocks)), str(len(studs)),
            _mass(weights[beam.mark][0], language),
        ])  # fmt: skip
    return _table(language, "beams", rows)


def _laid_table(step: Step, weights: Weights, plan: Plan, language: Language) -> dict[str, Any]:
    made = {whole_of(mark): s.number for s in plan.steps if s.phase == "prefabricate" for mark in s.marks}
    rows = []
    for unit in (*step.assemblies, *step.marks):
        mass, length = weights[unit]
        origin = "beam" if unit in made else "plank"
        told = say(language, f"cards.laid.{origin}", number=made.get(unit, ""))
        rows.append([short_mark(unit), _length(length), _mass(mass, language), told])
    return _table(language, "laid", rows)


def _taken_table(step: Step, weights: Weights, language: Language) -> dict[str, Any]:
    loose = () if step.assemblies else step.marks
    rows = []
    for unit in (*step.assemblies, *loose):
        mass, length = weights[unit]
        told = say(language, f"cards.taken.{'beam' if step.assemblies else 'plank'}")
        rows.append([short_mark(unit), _length(length), _mass(mass, language), told])
    return _table(language, "taken", rows)


def _control_table(shell: Shell, language: Language) -> dict[str, Any]:
    control = control_figures(shell)
    rows = [[name, short_mark(control.studs[name]), _length(height)] for name, height in control.heights.items()]
    pairs = [[say(language, "cards.control.pair", a=a, b=b), _length(mm)] for (a, b), mm in control.distances.items()]
    return _table(
        language, "control", [(a or [""] * 3) + (b or [""] * 2) for a, b in zip_longest(rows, pairs, fillvalue=None)]
    )


def _feet_table(gridshell: Gridshell, language: Language) -> dict[str, Any]:
    rows = []
    for shell in gridshell.shells:
        matrix = frame_matrix(shell.placement)
        for footing in shell.footings:
            x, y, _z = (matrix[:3, :3] @ np.array(footing.frame.origin) + matrix[:3, 3]).tolist()
            rows.append([footing.mark, f"{round(x)}", f"{round(y)}"])
    return _table(language, "feet", rows)


def _bolt_table(shell: Shell, language: Language) -> dict[str, Any]:
    groups: dict[tuple[str, str], int] = defaultdict(int)
    for bolt in shell.bolts:
        kind = index_of(shell).joint_of_fastener[bolt.mark].kind
        if kind in _TIGHTENED:
            groups[part_name(bolt, language), say(language, f"cards.bolts.{kind}")] += 1
    return _table(language, "bolts", [[where, name, str(n)] for (name, where), n in groups.items()])


def step_table(
    gridshell: Gridshell, plan: Plan, step: Step, weights: Weights, language: Language = "en"
) -> dict[str, Any] | None:
    """Return the table of a step's card as head and rows of text, or None."""
    shells = index_of(gridshell).shells
    match PHASE[step.phase].table:
        case "beams":
            return _beam_table(shells[step.shell], step, weights, language)
        case "laid":
            return _laid_table(step, weights, plan, language)
        case "control":
            return _control_table(shells[step.shell], language)
        case "bolts":
            return _bolt_table(shells[step.shell], language)
        case "feet":
            return _feet_table(gridshell, language)
        case "slings":
            points = sling_points(shells[step.assemblies[0]])
            return _table(language, "slings", [["H", short_mark(mark)] for mark in points])
        case "taken":
            return _taken_table(step, weights, language)
        case "measured":
            parts = index_of(shells[step.shell]).parts
            return _table(language, "measured", part_rows(parts, step.assemblies, language=language))
        case "":
            return None


def qr_text(name: str, step: Step, weights: Weights) -> str:
    """Return what the square code of a card holds: gridshell, step and the ranges of its marks, cut off where long."""
    known = tuple(mark for mark in step.assemblies if mark in weights)
    ranges = (*(mark for mark in step.assemblies if mark not in weights), *mark_ranges((*known, *step.marks)))
    text, head = "", f"{name} {step.id}: "
    for i, part in enumerate(ranges):
        longer = f"{text}, {part}" if text else part
        room = 0 if i == len(ranges) - 1 else len(", …")
        if len(head) + len(longer) + room >= _QR_CHARACTERS:
            return f"{head}{text}, …"
        text = longer
    return head + (text or step.shell)


def gathered(extras: Sequence[str]) -> list[str]:
    """Return extras as they are printed: those alike before their last colon in one line, each after a semicolon."""
    tails: dict[str, list[str]] = defaultdict(list)
    for extra in extras:
        head, colon, tail = extra.rpartition(": ")
        tails[head + colon].append(tail)
    return [head + "; ".join(listed) for head, listed in tails.items()]


def step_card(
    gridshell: Gridshell,
    plan: Plan,
    step: Step,
    parts: Mapping[str, Part],
    weights: Weights,
    language: Language = "en",
) -> dict[str, Any]:
    """Return what the card of a step of putting together or of taking down prints, without its pictures."""
    words = step_words(step, language)
    titles = {s.id: f"{s.number}  {step_title(s, language)}" for s in plan.steps}
    chapter = [s for s in plan.steps if s.shell == step.shell]
    moved = carried(step.phase, step.marks, step.assemblies, step.segments)
    heaviest = max((mark for mark in moved if mark in weights), key=lambda mark: (weights[mark][0], mark), default="")
    told = bool(heaviest) and weights[heaviest][0] >= _WORTH_SAYING
    worked_on = {step.shell, *(shell_of(mark) for mark in step.marks)}
    outer = {mark for shell in gridshell.shells if shell.mark in worked_on for mark in driven_from_outside(shell)}
    added = sum(weights[mark][0] for mark in step.marks)
    return {
        "number": step.number,
        "id": step.id,
        "phase": step.phase,
        "phases": [[phase_name(p, language), p == step.phase] for p in PHASES if any(s.phase == p for s in chapter)],
        "title": words.title,
        "shell": step.shell,
        "parts": [] if PHASE[step.phase].listed else part_rows(parts, step.marks, outer, language),
        "pieces": len(step.marks),
        "added": _mass(added, language) if step.marks else "",
        "heaviest": f"{heaviest}: {_mass(weights[heaviest][0], language)}" if told else "",
        "table": step_table(gridshell, plan, step, weights, language),
        "tools": list(words.tools),
        "crew": step.crew,
        "after": [titles[before] for before in step.predecessors],
        "instructions": list(words.instructions),
        "hold": words.hold,
        "props": [short_mark(mark) if step.shell else mark for mark in step.propped],
        "extras": gathered(words.extras),
        "qr": qr_text(plan.name, step, weights),
    }


def _counted(parts: tuple[Part, ...], weights: Weights, language: Language) -> dict[str, tuple[int, float]]:
    """Return count and mass of the parts by make, planks by their family."""
    groups: dict[str, tuple[int, float]] = {}
    for part in parts:
        name = part_name(part, language)
        if (family := parse_mark(part.mark).family) in FAMILIES:
            name = say(language, "cards.totals.planks", family=family)
        count, mass = groups.get(name, (0, 0.0))
        groups[name] = count + 1, mass + weights[part.mark][0]
    return groups


def totals(gridshell: Gridshell, weights: Weights, language: Language = "en") -> dict[str, Any]:
    """Return the totals of the cover: parts by product group with counts and masses, for a shell and for the whole."""

    def word(key: str) -> str:
        return say(language, f"cards.totals.{key}")

    shells, timber = gridshell.shells, gridshell.timber
    whole = _counted(all_parts(gridshell), weights, language)
    first = _counted(shell_parts(shells[0]), weights, language)
    rows = [
        [name, str(first.get(name, (0, 0.0))[0]), str(count), _mass(mass, language)]
        for name, (count, mass) in whole.items()
    ]
    counts = (str(sum(n for n, _ in found.values())) for found in (first, whole))
    rows.append([word("all"), *counts, _mass(sum(m for _, m in whole.values()), language)])
    known = timber.species in words_table("cards")["species"]
    species = say(language, f"cards.species.{timber.species}") if known else timber.species
    facts = [
        [word("shells"), str(len(shells))],
        [word("beams"), str(sum(len(shell.beams) for shell in shells))],
        [word("wood"), str(sum(len(shell.planks) for shell in shells))],
        [word("studs"), str(sum(len(shell.studs) for shell in shells))],
        [word("mass"), _mass(weights[shells[0].mark][0], language)],
        [word("timber"), f"{species} {timber.strength_class}"],
    ]
    return _table(language, "totals", rows) | {"facts": facts}
