"""What the card of a step is filled in with: spanners, drill bits and bolts of the joints that the step handles."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeAlias

from aag_cad.language import Figure, Text, printed, text
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import is_driven, shaped
from aag_cad.parts.model import Gridshell, JointKind, Part, Shell
from aag_cad.parts.shapes.threaded import THREADED, Threaded
from assembly.base.names import part_text
from assembly.base.phases import PHASE, Phase

Fasteners: TypeAlias = Mapping[JointKind, Sequence[Part]]

_PRE_DRILL = 0.7


def _forms(parts: Iterable[Part]) -> list[Threaded]:
    return [form for shape, form in map(shaped, parts) if shape is THREADED]


def spanners(parts: Iterable[Part]) -> Figure:
    """Return the spanners for the bolts and threaded rods among some parts, two of each size."""
    sizes = sorted({piece.size for form in _forms(parts) for piece in form.pieces if piece.hexagonal})
    return tuple(text("phases.words.spanner", size=size) for size in sizes) or text("phases.words.spanners")


def _drill(parts: Iterable[Part]) -> Text:
    screws = sorted({form.diameter for form in _forms(part for part in parts if is_driven(part))})
    bits = tuple(text("phases.words.bit", size=_PRE_DRILL * diameter) for diameter in screws)
    return text("phases.words.drill", bits=bits or text("phases.words.bits"))


def _bolts(parts: Iterable[Part]) -> Figure:
    headed = (part for part in parts if any(piece.name == "head" for form in _forms([part]) for piece in form.pieces))
    named = {printed(name, "en"): name for name in map(part_text, headed)}
    return tuple(named[name] for name in sorted(named)) or text("phases.words.bolts")


def fasteners_by_kind(gridshell: Gridshell, shells: Sequence[Shell]) -> dict[JointKind, list[Part]]:
    """Return the fasteners of some shells and of all ridges by the kind of their joint."""
    parts = index_of(gridshell).parts
    found: dict[JointKind, list[Part]] = defaultdict(list)
    for joint in (*(joint for shell in shells for joint in shell.joints), *gridshell.joints):
        found[joint.kind] += [parts[mark] for mark in joint.fasteners if mark in parts]
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
