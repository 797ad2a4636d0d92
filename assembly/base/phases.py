"""The phases of putting together and of taking down, each described once: what it fastens, how long, how it looks."""

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

from aag_cad.parts.model import JointKind

# "lay", "slide" and "join" are those of planks of any layers; "divide" and "splice" those of shells cut for transport.
UpPhase: TypeAlias = Literal[
    "prefabricate", "lay A1", "lay G", "lay A2", "lay", "slide", "join", "studs", "hoist", "edge planks",
    "fix geodesics", "tighten", "divide", "feet", "stand", "splice", "ridges", "cover",
]  # fmt: skip
DownPhase: TypeAlias = Literal[
    "uncover", "prop", "open ridges", "lift off", "clear feet", "hang", "release geodesics", "pull edge planks",
    "lower", "take off beams", "take off geodesics", "pull studs", "unbolt", "passports",
]  # fmt: skip
Phase: TypeAlias = Literal[UpPhase, DownPhase]

UP_PHASES: tuple[UpPhase, ...] = get_args(UpPhase)
DOWN_PHASES: tuple[DownPhase, ...] = get_args(DownPhase)
PHASES: tuple[Phase, ...] = (*UP_PHASES, *DOWN_PHASES)

Look: TypeAlias = Literal[
    "make", "lay", "studs", "hoist", "edges", "fix", "tighten", "splices", "feet", "stand", "ridges", "cover",
    "passports",
]  # fmt: skip
CardTable: TypeAlias = Literal["", "beams", "laid", "control", "bolts", "feet", "slings", "taken", "measured"]
Shown: TypeAlias = Literal["chapter", "moved shell", "site"]


@dataclass(frozen=True)
class PhaseRow:
    """What there is to know about a phase.

    ``look``: how it is painted in the schedule. ``shown``: whether its pictures show the shell of its chapter, the
    shell that it moves, or the site. ``table``: which table its card has, with the parts in it if ``listed``.
    ``handled``: the joints whose fasteners it puts in, sets or tightens. ``fastens``: these hold planks at their joints
    (not blocks, studs or the cover). ``tightens``: its own bolts are tightened at once. ``gone_over``: the joints of
    the shell whose bolts are gone over, tightening or loosening them. ``once``: the key of ``Minutes`` that counts once
    for it, and ``undone`` the one that is taken back. ``each_held``: every step of it ends with a check, else the
    last. ``unbroken``: a shell in slings is not left for the night. ``stays``: the assemblies that it works on stay
    where they are. ``lifts``: its tools lift already. ``propped``: the shell stands on props in it.
    """

    look: Look
    shown: Shown = "chapter"
    table: CardTable = ""
    listed: bool = False
    handled: tuple[JointKind, ...] = ()
    fastens: bool = False
    tightens: bool = False
    gone_over: tuple[JointKind, ...] = ()
    once: str = ""
    undone: str = ""
    each_held: bool = False
    unbroken: bool = False
    stays: bool = False
    lifts: bool = False
    propped: bool = False


_SHELL: tuple[JointKind, ...] = ("AA", "AG", "boundary", "ridge")

PHASE: dict[Phase, PhaseRow] = {
    "prefabricate": PhaseRow("make", table="beams", handled=("AG", "boundary"), tightens=True),
    "lay A1": PhaseRow("lay", table="laid", listed=True),
    "lay G": PhaseRow("lay", table="laid", listed=True),
    "lay A2": PhaseRow("lay", table="laid", listed=True),
    "lay": PhaseRow("lay", table="laid", listed=True),
    "slide": PhaseRow("lay", table="laid", listed=True, once="slide"),
    "join": PhaseRow("studs"),
    "studs": PhaseRow("studs", handled=("AA",), fastens=True),
    "hoist": PhaseRow("hoist", table="control", once="hoist", each_held=True, unbroken=True, lifts=True),
    "edge planks": PhaseRow("edges", handled=("boundary", "ridge"), fastens=True),
    "fix geodesics": PhaseRow("fix", handled=("AG",), fastens=True),
    "tighten": PhaseRow("tighten", table="bolts", handled=_SHELL, gone_over=_SHELL),
    "divide": PhaseRow("splices", handled=("AG",), unbroken=True, lifts=True),
    "feet": PhaseRow("feet", "site", "feet", handled=("footing",)),
    "stand": PhaseRow(
        "stand", "site", handled=("foot", "footing"), fastens=True, tightens=True, once="stand", each_held=True,
        unbroken=True, lifts=True,
    ),
    "splice": PhaseRow("splices", "site", handled=("AG",), each_held=True, unbroken=True, stays=True),
    "ridges": PhaseRow(
        "ridges", "site", handled=("blade",), fastens=True, tightens=True, once="ridge", unbroken=True, stays=True
    ),
    "cover": PhaseRow("cover", "moved shell", handled=("cover",)),
    "uncover": PhaseRow("cover", "moved shell"),
    "prop": PhaseRow("feet", "moved shell", once="prop", each_held=True, stays=True, propped=True),
    "open ridges": PhaseRow("ridges", "site", fastens=True, undone="ridge", unbroken=True, stays=True, propped=True),
    "lift off": PhaseRow(
        "stand", "moved shell", "slings", fastens=True, once="stand", each_held=True, unbroken=True, lifts=True,
        propped=True,
    ),
    "clear feet": PhaseRow("feet", "site", lifts=True),
    "hang": PhaseRow(
        "hoist", table="slings", undone="hoist", each_held=True, unbroken=True, lifts=True, propped=True
    ),
    "release geodesics": PhaseRow("fix", fastens=True, propped=True),
    "pull edge planks": PhaseRow("edges", fastens=True, propped=True),
    "lower": PhaseRow(
        "hoist", gone_over=("AA",), once="lower", each_held=True, unbroken=True, lifts=True, propped=True
    ),
    "take off beams": PhaseRow("lay", table="taken"),
    "take off geodesics": PhaseRow("lay", table="taken", listed=True),
    "pull studs": PhaseRow("studs"),
    "unbolt": PhaseRow("make"),
    "passports": PhaseRow("passports", table="measured"),
}  # fmt: skip


def is_down(phase: Phase) -> bool:
    """Return whether a phase is one of taking down."""
    return phase in DOWN_PHASES
