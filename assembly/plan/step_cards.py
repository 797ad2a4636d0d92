"""What the card of a step is filled in with: spanners, drill bits and bolts of the joints that the step handles."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeAlias

from aag_cad.language import Figure, Text, printed, text
from aag_cad.parts.index import index_of
from aag_cad.parts.model import Bolt, Gridshell, JointKind, Rod, Screw, Shell
from assembly.base.names import part_text
from assembly.base.phases import PHASE, Phase

Fastener: TypeAlias = Bolt | Screw | Rod
Fasteners: TypeAlias = Mapping[JointKind, Sequence[Fastener]]

_PRE_DRILL = 0.7


def spanners(parts: Iterable[object]) -> Figure:
    """Return the spanners for the bolts and threaded rods among some parts, two of each size."""
    sizes = sorted({part.across_flats for part in parts if isinstance(part, Bolt | Rod)})
    return tuple(text("phases.words.spanner", size=size) for size in sizes) or text("phases.words.spanners")


def _drill(parts: Iterable[Fastener]) -> Text:
    screws = sorted({part.diameter for part in parts if isinstance(part, Screw)})
    bits = tuple(text("phases.words.bit", size=_PRE_DRILL * diameter) for diameter in screws)
    return text("phases.words.drill", bits=bits or text("phases.words.bits"))


def _bolts(parts: Iterable[Fastener]) -> Figure:
    named = {printed(name, "en"): name for name in (part_text(part) for part in parts if isinstance(part, Bolt))}
    return tuple(named[name] for name in sorted(named)) or text("phases.words.bolts")


def fasteners_by_kind(gridshell: Gridshell, shells: Sequence[Shell]) -> dict[JointKind, list[Fastener]]:
    """Return bolts, screws and threaded rods of some shells and of all ridges by the kind of their joint."""
    parts = index_of(gridshell).parts
    found: dict[JointKind, list[Fastener]] = defaultdict(list)
    for joint in (*(joint for shell in shells for joint in shell.joints), *gridshell.joints):
        listed = (parts[mark] for mark in joint.fasteners if mark in parts)
        found[joint.kind] += [part for part in listed if isinstance(part, Bolt | Screw | Rod)]
    return dict(found)


def card(phase: Phase, fasteners: Fasteners, *, told: str = "", below: Text | None = None) -> Text:
    """Return the key of what the card of a step says, with the figures of the fasteners that its phase handles.

    ``told`` is the key in ``templates/printouts/words/phases.toml`` where a phase has several, ``below`` what a laid
    layer rests on. A screw's hole is pre-drilled to 0.7 of its diameter.
    """
    handled = [part for kind in PHASE[phase].handled for part in fasteners.get(kind, ())]
    return text(
        f"phases.{told or phase}",
        spanners=spanners(handled),
        drill=_drill(handled),
        bolts=_bolts(handled),
        below=below or text("phases.words.below"),
    )
