"""What a shell or a gridshell holds, by mark: made at the first question and kept, so that nobody builds it again."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, TypeVar

from aag_cad.families import EDGES, GEODESICS
from aag_cad.once import once
from aag_cad.parts.model import (
    Beam,
    Bolt,
    CouplingBlock,
    Gridshell,
    Joint,
    Member,
    Part,
    Plank,
    Screw,
    Shell,
    Strap,
    Stud,
    all_joints,
    all_parts,
    shell_parts,
)
from aag_cad.parts.products import product_key


class _Marked(Protocol):
    @property
    def mark(self) -> str: ...


_T = TypeVar("_T", bound=_Marked)


def _by_mark(items: Iterable[_T]) -> dict[str, _T]:
    return {item.mark: item for item in items}


@dataclass(frozen=True, eq=False)
class Index:
    """Parts, beams and joints by mark, each in the order of the model; made by ``index_of``.

    ``geodesics`` are the planks that lie flat, from side to side, ``edges`` those along the edges. ``twins`` gives for
    each of the ``shells`` of a gridshell the first one of its twins, often itself; a shell's own index has neither.
    Bolts and joints of a gridshell are those of its ridges too.
    """

    shells: dict[str, Shell]
    twins: dict[str, str]
    parts: dict[str, Part]
    planks: dict[str, Plank]
    geodesics: dict[str, Plank]
    edges: dict[str, Plank]
    studs: dict[str, Stud]
    blocks: dict[str, CouplingBlock]
    bolts: dict[str, Bolt]
    screws: dict[str, Screw]
    straps: dict[str, Strap]
    beams: dict[str, Beam]
    joints: dict[str, Joint]

    @cached_property
    def keys(self) -> dict[str, str]:
        """The key of the product of each part (``aag_cad.parts.products.product_key``)."""
        return {mark: product_key(part) for mark, part in self.parts.items()}

    @cached_property
    def joint_of_fastener(self) -> dict[str, Joint]:
        """The joint that a fastener belongs to, by the fastener's mark."""
        return {fastener: joint for joint in self.joints.values() for fastener in joint.fasteners}

    @cached_property
    def stations(self) -> dict[tuple[str, str], float]:
        """The station of a joint on a plank or a beam, by the marks of both, mm."""
        members: tuple[Member, ...] = (*self.planks.values(), *self.beams.values())
        return {(member.mark, place.joint): place.station for member in members for place in member.joints}

    @cached_property
    def unit_of(self) -> dict[str, str]:
        """What a plank is laid as, by its mark: its coupled beam, or itself."""
        return {plank.mark: plank.beam or plank.mark for plank in self.planks.values()}

    @cached_property
    def units(self) -> dict[str, Member]:
        """What is laid in one piece: the coupled beams, and the planks of no beam."""
        return {**self.beams, **{mark: plank for mark, plank in self.planks.items() if not plank.beam}}

    @cached_property
    def beam_of(self) -> dict[str, str]:
        """The coupled beam of each part that is put together with it: planks, blocks and their bolts, by mark.

        What a joint of one single beam holds belongs to that beam; what ties two beams, and every screw, to the shell.
        """
        home = {plank.mark: plank.beam for plank in self.planks.values() if plank.beam}
        with_beam, found = self.blocks.keys() | self.bolts.keys(), dict(home)
        for joint in self.joints.values():
            beams = {home[mark] for mark in joint.members if mark in home}
            if len(beams) == 1:
                held = {*joint.members, *joint.fasteners} & with_beam
                found |= dict.fromkeys(sorted(held), beams.pop())
        return found


@once
def index_of(whole: Shell | Gridshell) -> Index:
    """Return what a shell, or a whole gridshell, holds by mark: the same index at every call for the same object."""
    shells: tuple[Shell, ...] = ()
    if isinstance(whole, Shell):
        beams, parts, joints = whole.beams, shell_parts(whole), whole.joints
    else:
        shells, parts, joints = whole.shells, all_parts(whole), all_joints(whole)
        beams = tuple(beam for shell in shells for beam in shell.beams)

    def of(kind: type[_T]) -> dict[str, _T]:
        return _by_mark(part for part in parts if isinstance(part, kind))

    firsts: dict[str, str] = {}
    return Index(
        shells=_by_mark(shells),
        twins={shell.mark: firsts.setdefault(shell.twin_of or shell.mark, shell.mark) for shell in shells},
        parts=_by_mark(parts),
        planks=of(Plank),
        geodesics={mark: plank for mark, plank in of(Plank).items() if plank.family in GEODESICS},
        edges={mark: plank for mark, plank in of(Plank).items() if plank.family in EDGES},
        studs=of(Stud),
        blocks=of(CouplingBlock),
        bolts=of(Bolt),
        screws=of(Screw),
        straps=of(Strap),
        beams=_by_mark(beams),
        joints=_by_mark(joints),
    )


def sorted_planks(gridshell: Gridshell) -> list[Plank]:
    """Return the planks of all shells sorted by mark, the order of tables and files."""
    return [plank for _, plank in sorted(index_of(gridshell).planks.items())]
