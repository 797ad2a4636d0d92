"""What the card of a step tells the crew: tools, instructions and what to check before going on."""

import tomllib
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, TypeAlias

from aag_cad.parts.model import Bolt, Gridshell, JointKind, Rod, Screw, Shell
from aag_cad.parts.products import product_name
from aag_cad.resources import template
from assembly.steps import Phase

Fastener: TypeAlias = Bolt | Screw | Rod

_PRE_DRILL = 0.7

# The joints whose fasteners a phase puts in, or sets and tightens.
_HANDLED: dict[Phase, tuple[JointKind, ...]] = {
    "prefabricate": ("AG", "boundary"),
    "studs": ("AA",),
    "edge planks": ("boundary", "ridge"),
    "fix geodesics": ("AG",),
    "tighten": ("AA", "AG", "boundary", "ridge"),
    "feet": ("footing",),
    "stand": ("foot", "footing"),
    "ridges": ("blade",),
    "cover": ("cover",),
}


@dataclass(frozen=True)
class Wording:
    """The words of a step's card; ``hold`` is what to check when the phase is done."""

    tools: tuple[str, ...]
    instructions: tuple[str, ...]
    hold: str


@cache
def _process() -> dict[str, Any]:
    with template("printouts", "process.toml").open("rb") as file:
        return tomllib.load(file)


def _list_of(words: Sequence[str], otherwise: str) -> str:
    return " and ".join(words) or otherwise


def fasteners_by_kind(gridshell: Gridshell, shells: Sequence[Shell]) -> dict[JointKind, list[Fastener]]:
    """Return bolts, screws and threaded rods of some shells and of all ridges by the kind of their joint."""
    listed: list[Fastener] = [*gridshell.bolts]
    for shell in shells:
        listed += [*shell.bolts, *shell.screws, *shell.rods]
    parts = {part.mark: part for part in listed}
    found: dict[JointKind, list[Fastener]] = defaultdict(list)
    for joint in (*(joint for shell in shells for joint in shell.joints), *gridshell.joints):
        found[joint.kind] += [parts[mark] for mark in joint.fasteners if mark in parts]
    return dict(found)


def wording(
    phase: Phase, fasteners: Mapping[JointKind, Sequence[Fastener]], below: str = "the layer beneath"
) -> Wording:
    """Return the words for a phase of work on joints with some fasteners; ``below``: what a laid layer rests on.

    The texts are those of ``templates/printouts/process.toml``; a screw's hole is pre-drilled to 0.7 of its diameter.
    """
    handled = [part for kind in _HANDLED.get(phase, ()) for part in fasteners.get(kind, ())]
    flats = sorted({part.across_flats for part in handled if isinstance(part, Bolt | Rod)})
    screws = sorted({part.diameter for part in handled if isinstance(part, Screw)})
    bits = [f"{_PRE_DRILL * diameter:.1f} mm bit" for diameter in screws]
    bolts = sorted({product_name(part) for part in handled if isinstance(part, Bolt)})
    figures = {
        "spanners": _list_of([f"two {size:g} mm spanners" for size in flats], "two spanners"),
        "drill": f"cordless drill, {_list_of(bits, 'drill bit')}, screw bit",
        "bolts": _list_of(bolts, "bolts"),
        "below": below,
    }
    texts = _process()[phase]
    return Wording(
        tools=tuple(text.format_map(figures) for text in texts["tools"]),
        instructions=tuple(text.format_map(figures) for text in texts["instructions"]),
        hold=texts["hold"].format_map(figures),
    )
