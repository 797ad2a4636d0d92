"""The words and tables of the step cards, as plain data for the template."""

from collections import defaultdict
from collections.abc import Mapping, Set
from itertools import zip_longest
from typing import Any

import numpy as np

from aag_cad.parts.marks import shell_of
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import (
    Bolt,
    ClampingBar,
    Gridshell,
    JointKind,
    Mullion,
    Part,
    Plank,
    Rod,
    Screw,
    Shell,
    Strap,
    Strip,
    all_parts,
    shell_parts,
)
from aag_cad.parts.products import product_name
from aag_cad.parts.quantities import kind
from assembly.control import control_figures
from assembly.graph import joint_of
from assembly.kit import driven_from_outside
from assembly.plan import lifted
from assembly.ranges import joined_ranges, short_mark
from assembly.steps import PHASES, Plan, Step

Weights = Mapping[str, tuple[float, float]]

_WORTH_SAYING = 1.0
_TIGHTENED: dict[JointKind, str] = {
    "AA": "stud bolts (N)",
    "AG": "block bolts (K)",
    "boundary": "block bolts (K)",
    "ridge": "strap bolts (R)",
}

PHASE_NAMES = {
    "prefabricate": "Make beams",
    "lay A1": "Lay A1",
    "lay G": "Lay G",
    "lay A2": "Lay A2",
    "studs": "Studs",
    "hoist": "Hoist",
    "edge planks": "Edges",
    "fix geodesics": "Fix G",
    "tighten": "Tighten",
    "feet": "Feet",
    "stand": "Stand",
    "ridges": "Ridges",
    "cover": "Cover",
}


def _length(mm: float) -> str:
    return f"{mm:.0f} mm"


def _mass(kg: float) -> str:
    return f"{kg:.1f} kg" if kg < 100.0 else f"{kg:.0f} kg"


def group_name(part: Part) -> str:
    """Return what pieces of one make have in common, whatever their lengths: e.g. ``Plank 100 x 12``, ``Strip 10``."""
    match part:
        case Plank() | Strap() | Mullion() | ClampingBar():
            section = part.blank.section
            return f"{kind(part).capitalize()} {section.width:g} x {section.thickness:g}"
        case Strip():
            return f"{kind(part).capitalize()} {part.thickness:g} thick"
        case _:
            return product_name(part)


def part_rows(parts: Mapping[str, Part], marks: tuple[str, ...], outer: Set[str] = frozenset()) -> list[list[str]]:
    """Return one line for each product among the marks: count, what it is, and which marks or at which joints.

    ``outer`` are the screws that are driven from outside: they get a line of their own.
    """
    groups: dict[str, list[str]] = defaultdict(list)
    for mark in marks:
        part = parts[mark]
        name = group_name(part)
        side = f", from {'outside' if mark in outer else 'inside'}" if isinstance(part, Screw) else ""
        groups[name + side].append(mark)
    rows = []
    for name, listed in groups.items():
        fasteners = isinstance(parts[listed[0]], Bolt | Screw | Rod)
        joints = tuple(dict.fromkeys(joint_of(mark) for mark in listed))
        where = f"at {joined_ranges(joints)}" if fasteners else joined_ranges(listed)
        if fasteners and len(listed) != len(joints) and len(listed) % len(joints) == 0:
            where += f", {len(listed) // len(joints)} each"
        rows.append([str(len(listed)), name, where])
    return rows


def _beam_table(shell: Shell, step: Step, weights: Weights) -> dict[str, Any]:
    lengths = {plank.mark: plank.blank.length for plank in shell.planks}
    beams = [beam for beam in shell.beams if set(beam.planks) <= set(step.marks)]
    rows = []
    for beam in beams:
        left, right = (lengths[mark] for mark in beam.planks)
        blocks = [place.joint for place in beam.joints if "-K-" in place.joint]
        studs = [place.joint for place in beam.joints if "-N-" in place.joint]
        rows.append([
            short_mark(beam.mark), _length(left), _length(right), str(len(blocks)), str(len(studs)),
            _mass(weights[beam.mark][0]),
        ])  # fmt: skip
    return {"head": ["beam", "plank L", "plank R", "blocks K", "open places N", "mass"], "rows": rows}


def _laid_table(step: Step, weights: Weights, plan: Plan) -> dict[str, Any]:
    made = {mark.rsplit("-", 1)[0]: s.number for s in plan.steps if s.phase == "prefabricate" for mark in s.marks}
    rows = []
    for unit in (*step.assemblies, *step.marks):
        mass, length = weights[unit]
        origin = f"beam of step {made[unit]}" if unit in made else "plank, as cut and drilled"
        rows.append([short_mark(unit), _length(length), _mass(mass), origin])
    return {"head": ["mark", "length", "mass", "from"], "rows": rows}


def _control_table(shell: Shell) -> dict[str, Any]:
    control = control_figures(shell)
    rows = [[name, short_mark(control.studs[name]), _length(height)] for name, height in control.heights.items()]
    pairs = [[f"{a} to {b}", _length(mm)] for (a, b), mm in control.distances.items()]
    return {
        "head": ["point", "stud", "height", "from, to", "distance"],
        "rows": [(a or [""] * 3) + (b or [""] * 2) for a, b in zip_longest(rows, pairs)],
    }


def _feet_table(gridshell: Gridshell) -> dict[str, Any]:
    rows = []
    for shell in gridshell.shells:
        matrix = frame_matrix(shell.placement)
        for footing in shell.footings:
            x, y, _z = (matrix[:3, :3] @ np.array(footing.frame.origin) + matrix[:3, 3]).tolist()
            rows.append([footing.mark, f"{x:.0f}", f"{y:.0f}"])
    return {"head": ["block", "x mm", "y mm"], "rows": rows}


def _bolt_table(shell: Shell) -> dict[str, Any]:
    kinds = {joint.mark: joint.kind for joint in shell.joints}
    groups: dict[tuple[str, str], int] = defaultdict(int)
    for bolt in shell.bolts:
        where = _TIGHTENED.get(kinds[joint_of(bolt.mark)])
        if where is not None:
            groups[product_name(bolt), where] += 1
    return {"head": ["bolts", "size", "count"], "rows": [[where, name, str(n)] for (name, where), n in groups.items()]}


def step_table(gridshell: Gridshell, plan: Plan, step: Step, weights: Weights) -> dict[str, Any] | None:
    """Return the table of a step's card as head and rows of text, or None."""
    shells = {shell.mark: shell for shell in gridshell.shells}
    match step.phase:
        case "prefabricate":
            return _beam_table(shells[step.shell], step, weights)
        case "lay A1" | "lay G" | "lay A2":
            return _laid_table(step, weights, plan)
        case "hoist":
            return _control_table(shells[step.shell])
        case "tighten":
            return _bolt_table(shells[step.shell])
        case "feet":
            return _feet_table(gridshell)
        case _:
            return None


def step_card(
    gridshell: Gridshell, plan: Plan, step: Step, parts: Mapping[str, Part], weights: Weights
) -> dict[str, Any]:
    """Return what the card of a step prints, without its pictures."""
    titles = {s.id: f"{s.number}  {s.title}" for s in plan.steps}
    chapter = [s for s in plan.steps if s.shell == step.shell]
    pieces = lifted(step.phase, step.marks, step.assemblies)
    heaviest = max(pieces, key=lambda mark: (weights[mark][0], mark), default="")
    worked_on = {step.shell, *(shell_of(mark) for mark in step.marks)}
    outer = {mark for shell in gridshell.shells if shell.mark in worked_on for mark in driven_from_outside(shell)}
    added = sum(weights[mark][0] for mark in step.marks)
    return {
        "number": step.number,
        "id": step.id,
        "phase": step.phase,
        "phases": [[PHASE_NAMES[p], p == step.phase] for p in PHASES if any(s.phase == p for s in chapter)],
        "title": step.title,
        "shell": step.shell,
        "parts": [] if step.phase.startswith("lay") else part_rows(parts, step.marks, outer),
        "pieces": len(step.marks),
        "added": _mass(added) if step.marks else "",
        "heaviest": f"{heaviest}: {_mass(weights[heaviest][0])}"
        if heaviest and weights[heaviest][0] >= _WORTH_SAYING
        else "",
        "table": step_table(gridshell, plan, step, weights),
        "tools": list(step.tools),
        "crew": step.crew,
        "after": [titles[before] for before in step.predecessors],
        "instructions": list(step.instructions),
        "hold": step.hold,
    }


def totals(gridshell: Gridshell, weights: Weights) -> dict[str, Any]:
    """Return the totals of the cover: parts by product group with counts and masses, for a shell and for the whole."""

    def counted(parts: tuple[Part, ...]) -> dict[str, tuple[int, float]]:
        groups: dict[str, tuple[int, float]] = {}
        for part in parts:
            name = f"planks {part.family}" if isinstance(part, Plank) else group_name(part)
            count, mass = groups.get(name, (0, 0.0))
            groups[name] = count + 1, mass + weights[part.mark][0]
        return groups

    whole, first = counted(all_parts(gridshell)), counted(shell_parts(gridshell.shells[0]))
    rows = [[name, str(first.get(name, (0, 0.0))[0]), str(count), _mass(mass)] for name, (count, mass) in whole.items()]
    rows.append(
        [
            "all parts",
            str(sum(n for n, _ in first.values())),
            str(sum(n for n, _ in whole.values())),
            _mass(sum(m for _, m in whole.values())),
        ]
    )
    beams = [len(shell.beams) for shell in gridshell.shells]
    facts = [
        ["shells", str(len(gridshell.shells))],
        ["coupled beams", str(sum(beams))],
        ["planks", str(sum(len(shell.planks) for shell in gridshell.shells))],
        ["studs", str(sum(len(shell.studs) for shell in gridshell.shells))],
        ["mass of one stiff shell", _mass(weights[gridshell.shells[0].mark][0])],
        ["timber", f"{gridshell.timber.species} {gridshell.timber.strength_class}"],
    ]
    return {"head": ["parts", "first shell", "all shells", "mass"], "rows": rows, "facts": facts}
