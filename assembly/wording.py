"""What the card of a step tells the crew: tools, instructions and what to check before going on."""

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from aag_cad.parts.model import Shell
from aag_cad.parts.products import product_name
from aag_cad.resources import template
from assembly.steps import Phase

_PRE_DRILL = 0.7


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


def wording(phase: Phase, shells: Sequence[Shell], below: str = "the layer beneath") -> Wording:
    """Return the words for a phase of work on some shells; ``below`` names what a laid layer rests on.

    The texts are those of ``templates/printouts/process.toml``; a screw's hole is pre-drilled to 0.7 of its diameter.
    """
    flats = sorted({bolt.across_flats for shell in shells for bolt in shell.bolts})
    screws = sorted({screw.diameter for shell in shells for screw in shell.screws})
    bits = [f"{_PRE_DRILL * diameter:.1f} mm bit" for diameter in screws]
    figures = {
        "spanners": _list_of([f"two {size:g} mm spanners" for size in flats], "two spanners"),
        "drill": f"cordless drill, {_list_of(bits, 'drill bit')}, screw bit",
        "bolts": _list_of(sorted({product_name(bolt) for shell in shells for bolt in shell.bolts}), "bolts"),
        "below": below,
    }
    texts = _process()[phase]
    return Wording(
        tools=tuple(text.format_map(figures) for text in texts["tools"]),
        instructions=tuple(text.format_map(figures) for text in texts["instructions"]),
        hold=texts["hold"].format_map(figures),
    )
