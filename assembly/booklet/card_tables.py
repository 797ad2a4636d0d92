"""The tables of a gridshell's step cards and of the cover of its booklets, and what its cards know of its parts."""

from collections import defaultdict
from itertools import zip_longest
from typing import Any

import numpy as np

from aag_cad.families import FAMILIES
from aag_cad.language import Language, say, words_table
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import is_driven, kind_of
from aag_cad.parts.marks import joint_of, parse_mark, short_mark, whole_of
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Gridshell, Part, Shell, all_parts, shell_parts
from assembly.base.part_groups import driven_from_outside
from assembly.base.phases import PHASE
from assembly.base.steps import Plan, Step
from assembly.booklet.cards import Known, card_table, length_words, mass_words, part_rows
from assembly.drawing.names import part_name
from assembly.plan.piece_weights import piece_weights
from assembly.plan.shape_control import control_figures, sling_points

_TIGHTENED = ("AA", "AG", "boundary", "ridge")


def gridshell_known(gridshell: Gridshell, language: Language = "en") -> Known:
    """Return what cards know of the parts of a gridshell; screws are called by the side that they are driven from."""
    outer = {mark for shell in gridshell.shells for mark in driven_from_outside(shell)}
    names, joints = dict[str, str](), dict[str, str]()
    for mark, part in index_of(gridshell).parts.items():
        names[mark] = part_name(part, language)
        if is_driven(part):
            names[mark] = say(language, f"cards.where.{'outside' if mark in outer else 'inside'}", name=names[mark])
        if kind_of(part).role == "fastener":
            joints[mark] = joint_of(mark)
    return Known(names, joints, piece_weights(gridshell), language)


def _beam_table(shell: Shell, step: Step, known: Known) -> dict[str, Any]:
    index = index_of(shell)
    beams = [beam for beam in shell.beams if set(beam.planks) <= set(step.marks)]
    rows = []
    for beam in beams:
        left, right = (index.planks[mark].blank.length for mark in beam.planks)
        blocks = [place.joint for place in beam.joints if place.joint in index.blocks]
        studs = [place.joint for place in beam.joints if place.joint in index.studs]
        rows.append([
            short_mark(beam.mark), length_words(left), length_words(right), str(len(blocks)), str(len(studs)),
            mass_words(known.weights[beam.mark][0], known.language),
        ])  # fmt: skip
    return card_table(known.language, "beams", rows)


def _laid_table(plan: Plan, step: Step, known: Known) -> dict[str, Any]:
    made = {whole_of(mark): s.number for s in plan.steps if s.phase == "prefabricate" for mark in s.marks}
    rows = []
    for unit in (*step.assemblies, *step.marks):
        mass, length = known.weights[unit]
        origin = "beam" if unit in made else "plank"
        told = say(known.language, f"cards.laid.{origin}", number=made.get(unit, ""))
        rows.append([short_mark(unit), length_words(length), mass_words(mass, known.language), told])
    return card_table(known.language, "laid", rows)


def _taken_table(step: Step, known: Known) -> dict[str, Any]:
    loose = () if step.assemblies else step.marks
    rows = []
    for unit in (*step.assemblies, *loose):
        mass, length = known.weights[unit]
        told = say(known.language, f"cards.taken.{'beam' if step.assemblies else 'plank'}")
        rows.append([short_mark(unit), length_words(length), mass_words(mass, known.language), told])
    return card_table(known.language, "taken", rows)


def _control_table(shell: Shell, language: Language) -> dict[str, Any]:
    control = control_figures(shell)
    rows = [[name, short_mark(control.studs[name]), length_words(height)] for name, height in control.heights.items()]
    told = {say(language, "cards.control.pair", a=a, b=b): mm for (a, b), mm in control.distances.items()}
    pairs = [[pair, length_words(mm)] for pair, mm in told.items()]
    return card_table(
        language, "control", [(a or [""] * 3) + (b or [""] * 2) for a, b in zip_longest(rows, pairs, fillvalue=None)]
    )


def _feet_table(gridshell: Gridshell, language: Language) -> dict[str, Any]:
    rows = []
    for shell in gridshell.shells:
        matrix = frame_matrix(shell.placement)
        for footing in shell.footings:
            x, y, _z = (matrix[:3, :3] @ np.array(footing.frame.origin) + matrix[:3, 3]).tolist()
            rows.append([footing.mark, f"{round(x)}", f"{round(y)}"])
    return card_table(language, "feet", rows)


def _bolt_table(shell: Shell, language: Language) -> dict[str, Any]:
    groups: dict[tuple[str, str], int] = defaultdict(int)
    for bolt in shell.bolts:
        kind = index_of(shell).joint_of_fastener[bolt.mark].kind
        if kind in _TIGHTENED:
            groups[part_name(bolt, language), say(language, f"cards.bolts.{kind}")] += 1
    return card_table(language, "bolts", [[where, name, str(n)] for (name, where), n in groups.items()])


def step_table(gridshell: Gridshell, plan: Plan, step: Step, known: Known) -> dict[str, Any] | None:
    """Return the table of a step's card as head and rows of text, or None."""
    shells, language = index_of(gridshell).shells, known.language
    match PHASE[step.phase].table:
        case "beams":
            return _beam_table(shells[step.shell], step, known)
        case "laid":
            return _laid_table(plan, step, known)
        case "control":
            return _control_table(shells[step.shell], language)
        case "bolts":
            return _bolt_table(shells[step.shell], language)
        case "feet":
            return _feet_table(gridshell, language)
        case "slings":
            points = sling_points(shells[step.assemblies[0]])
            return card_table(language, "slings", [["H", short_mark(mark)] for mark in points])
        case "taken":
            return _taken_table(step, known)
        case "measured":
            return card_table(language, "measured", part_rows(known, step.assemblies))
        case "":
            return None


def _counted(parts: tuple[Part, ...], known: Known) -> dict[str, tuple[int, float]]:
    """Return count and mass of the parts by make, planks by their family."""
    groups: dict[str, tuple[int, float]] = {}
    for part in parts:
        name = part_name(part, known.language)
        if (family := parse_mark(part.mark).family) in FAMILIES:
            name = say(known.language, "cards.totals.planks", family=family)
        count, mass = groups.get(name, (0, 0.0))
        groups[name] = count + 1, mass + known.weights[part.mark][0]
    return groups


def totals(gridshell: Gridshell, known: Known) -> dict[str, Any]:
    """Return the totals of the cover: parts by product group with counts and masses, for a shell and for the whole."""

    def word(key: str) -> str:
        return say(language, f"cards.totals.{key}")

    shells, timber, language = gridshell.shells, gridshell.timber, known.language
    whole, first = _counted(all_parts(gridshell), known), _counted(shell_parts(shells[0]), known)
    rows = [
        [name, str(first.get(name, (0, 0.0))[0]), str(count), mass_words(mass, language)]
        for name, (count, mass) in whole.items()
    ]
    counts = (str(sum(n for n, _ in found.values())) for found in (first, whole))
    rows.append([word("all"), *counts, mass_words(sum(m for _, m in whole.values()), language)])
    told = timber.species in words_table("cards")["species"]
    species = say(language, f"cards.species.{timber.species}") if told else timber.species
    facts = [
        [word("shells"), str(len(shells))],
        [word("beams"), str(sum(len(shell.beams) for shell in shells))],
        [word("wood"), str(sum(len(shell.planks) for shell in shells))],
        [word("studs"), str(sum(len(shell.studs) for shell in shells))],
        [word("mass"), mass_words(known.weights[shells[0].mark][0], language)],
        [word("timber"), f"{species} {timber.strength_class}"],
    ]
    return card_table(language, "totals", rows) | {"facts": facts}
