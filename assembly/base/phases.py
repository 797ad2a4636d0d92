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
SceneKind: TypeAlias = Literal[
    "made", "laid", "slid", "studs", "hoisted", "edges", "screws", "whole", "cover", "propped", "lifted", "hung",
    "lowered", "measured", "site",
]  # fmt: skip


@dataclass(frozen=True)
class PhaseRow:
    """What there is to know about a phase.

    ``look``: how it is painted in the schedule; ``scene``: what its large picture shows; ``alone``: it shows alone the
    shell that the step moves. ``table``: which table its card has, with the parts in it if ``listed``. ``handled``: the
    joints whose fasteners it puts in, sets or tightens. ``fastens``: these hold planks at their joints (not blocks,
    studs or the cover). ``tightens``: its own bolts are tightened at once. ``gone_over``: the joints of the shell whose
    bolts are gone over, tightening or loosening them. ``once``: the key of ``Minutes`` that counts once for it, and
    ``undone`` the one that is taken back. ``each_held``: every step of it ends with a check, else the last.
    ``unbroken``: a shell in slings is not left for the night. ``stays``: the assemblies that it works on stay where
    they are. ``lifts``: its tools lift already. ``propped``: the shell stands on props in it.
    """

    look: Look
    scene: SceneKind
    table: CardTable = ""
    alone: bool = False
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
    "prefabricate": PhaseRow("make", "made", table="beams", handled=("AG", "boundary"), tightens=True),
    "lay A1": PhaseRow("lay", "laid", table="laid", listed=True),
    "lay G": PhaseRow("lay", "laid", table="laid", listed=True),
    "lay A2": PhaseRow("lay", "laid", table="laid", listed=True),
    "lay": PhaseRow("lay", "laid", table="laid", listed=True),
    "slide": PhaseRow("lay", "slid", table="laid", listed=True, once="slide"),
    "join": PhaseRow("studs", "whole"),
    "studs": PhaseRow("studs", "studs", handled=("AA",), fastens=True),
    "hoist": PhaseRow("hoist", "hoisted", table="control", once="hoist", each_held=True, unbroken=True, lifts=True),
    "edge planks": PhaseRow("edges", "edges", handled=("boundary", "ridge"), fastens=True),
    "fix geodesics": PhaseRow("fix", "screws", handled=("AG",), fastens=True),
    "tighten": PhaseRow("tighten", "whole", table="bolts", handled=_SHELL, gone_over=_SHELL),
    "divide": PhaseRow("splices", "whole", handled=("AG",), unbroken=True, lifts=True),
    "feet": PhaseRow("feet", "site", "feet", handled=("footing",)),
    "stand": PhaseRow(
        "stand", "site", handled=("foot", "footing"), fastens=True, tightens=True, once="stand", each_held=True,
        unbroken=True, lifts=True,
    ),
    "splice": PhaseRow("splices", "site", handled=("AG",), each_held=True, unbroken=True, stays=True),
    "ridges": PhaseRow(
        "ridges", "site", handled=("blade",), fastens=True, tightens=True, once="ridge", unbroken=True, stays=True
    ),
    "cover": PhaseRow("cover", "cover", alone=True, handled=("cover",)),
    "uncover": PhaseRow("cover", "cover", alone=True),
    "prop": PhaseRow("feet", "propped", alone=True, once="prop", each_held=True, stays=True, propped=True),
    "open ridges": PhaseRow("ridges", "site", fastens=True, undone="ridge", unbroken=True, stays=True, propped=True),
    "lift off": PhaseRow(
        "stand", "lifted", "slings", alone=True, fastens=True, once="stand", each_held=True, unbroken=True, lifts=True,
        propped=True,
    ),
    "clear feet": PhaseRow("feet", "site", lifts=True),
    "hang": PhaseRow(
        "hoist", "hung", table="slings", undone="hoist", each_held=True, unbroken=True, lifts=True, propped=True
    ),
    "release geodesics": PhaseRow("fix", "screws", fastens=True, propped=True),
    "pull edge planks": PhaseRow("edges", "edges", fastens=True, propped=True),
    "lower": PhaseRow(
        "hoist", "lowered", gone_over=("AA",), once="lower", each_held=True, unbroken=True, lifts=True, propped=True
    ),
    "take off beams": PhaseRow("lay", "laid", table="taken"),
    "take off geodesics": PhaseRow("lay", "laid", table="taken", listed=True),
    "pull studs": PhaseRow("studs", "made"),
    "unbolt": PhaseRow("make", "made"),
    "passports": PhaseRow("passports", "measured", table="measured"),
}  # fmt: skip


def is_down(phase: Phase) -> bool:
    """Return whether a phase is one of taking down."""
    return phase in DOWN_PHASES
