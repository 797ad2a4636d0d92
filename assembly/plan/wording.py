"""What the card of a step tells the crew: tools, instructions and what to check before going on."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from aag_cad.language import Language, figure, say, says
from aag_cad.parts.model import Bolt, Gridshell, JointKind, Rod, Screw, Shell
from assembly.base.names import part_name
from assembly.base.steps import Phase

Fastener: TypeAlias = Bolt | Screw | Rod

_PRE_DRILL = 0.7

# The joints whose fasteners a phase puts in, or sets and tightens.
_HANDLED: dict[Phase, tuple[JointKind, ...]] = {
    "prefabricate": ("AG", "boundary"),
    "studs": ("AA",),
    "edge planks": ("boundary", "ridge"),
    "fix geodesics": ("AG",),
    "tighten": ("AA", "AG", "boundary", "ridge"),
    "divide": ("AG",),
    "feet": ("footing",),
    "stand": ("foot", "footing"),
    "splice": ("AG",),
    "ridges": ("blade",),
    "cover": ("cover",),
}


@dataclass(frozen=True)
class Wording:
    """The words of a step's card; ``hold`` is what to check when the phase is done."""

    tools: tuple[str, ...]
    instructions: tuple[str, ...]
    hold: str


def _list_of(words: Sequence[str], otherwise: str, language: Language) -> str:
    return say(language, "phases.words.and").join(words) or otherwise


def spanners(parts: Iterable[object], language: Language = "en") -> str:
    """Return the spanners for the bolts and threaded rods among some parts, two of each size."""
    sizes = sorted({part.across_flats for part in parts if isinstance(part, Bolt | Rod)})
    listed = [say(language, "phases.words.spanner", size=figure(f"{size:g}", language)) for size in sizes]
    return _list_of(listed, say(language, "phases.words.spanners"), language)


def _drill(parts: Iterable[Fastener], language: Language) -> str:
    screws = sorted({part.diameter for part in parts if isinstance(part, Screw)})
    drilled = [figure(f"{_PRE_DRILL * diameter:.1f}", language) for diameter in screws]
    bits = [say(language, "phases.words.bit", size=size) for size in drilled]
    listed = _list_of(bits, say(language, "phases.words.bits"), language)
    return say(language, "phases.words.drill", bits=listed)


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
    phase: Phase,
    fasteners: Mapping[JointKind, Sequence[Fastener]],
    below: str = "",
    language: Language = "en",
    *,
    told: str = "",
) -> Wording:
    """Return the words for a phase of work on joints with some fasteners.

    ``told`` is the key of its texts, where a phase has several. ``below`` is what a laid layer rests on, in the
    language of the card; "" stands for the layer beneath. The texts are those of
    ``templates/printouts/words/phases.toml``; a screw's hole is pre-drilled to 0.7 of its diameter.
    """
    handled = [part for kind in _HANDLED.get(phase, ()) for part in fasteners.get(kind, ())]
    bolts = sorted({part_name(part, language) for part in handled if isinstance(part, Bolt)})
    figures = {
        "spanners": spanners(handled, language),
        "drill": _drill(handled, language),
        "bolts": _list_of(bolts, say(language, "phases.words.bolts"), language),
        "below": below or say(language, "phases.words.below"),
    }
    key = f"phases.{told or phase}"
    return Wording(
        tools=says(language, f"{key}.tools", **figures),
        instructions=says(language, f"{key}.instructions", **figures),
        hold=say(language, f"{key}.hold", **figures),
    )
