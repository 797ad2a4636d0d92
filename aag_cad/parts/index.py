"""What a shell or a gridshell holds, by mark: made at the first question and kept, so that nobody builds it again."""

from collections import defaultdict
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
    """Parts, beams and joints by mark, each in the order of the model; made by ``index_of``."""

    listed_shells: tuple[Shell, ...]
    listed_beams: tuple[Beam, ...]
    listed_parts: tuple[Part, ...]
    listed_joints: tuple[Joint, ...]

    def _of(self, kind: type[_T]) -> dict[str, _T]:
        return _by_mark(part for part in self.listed_parts if isinstance(part, kind))

    @cached_property
    def shells(self) -> dict[str, Shell]:
        """The shells of a gridshell."""
        return _by_mark(self.listed_shells)

    @cached_property
    def twins(self) -> dict[str, str]:
        """The first shell of those that are twins of each other, for each shell; often it is the shell itself."""
        firsts: dict[str, str] = {}
        return {mark: firsts.setdefault(shell.twin_of or mark, mark) for mark, shell in self.shells.items()}

    @cached_property
    def parts(self) -> dict[str, Part]:
        """Every part."""
        return _by_mark(self.listed_parts)

    @cached_property
    def keys(self) -> dict[str, str]:
        """The key of the product of each part (``aag_cad.parts.products.product_key``)."""
        return {part.mark: product_key(part) for part in self.listed_parts}

    @cached_property
    def planks(self) -> dict[str, Plank]:
        """The planks."""
        return self._of(Plank)

    @cached_property
    def geodesics(self) -> dict[str, Plank]:
        """The planks that lie flat along geodesics, from side to side."""
        return {mark: plank for mark, plank in self.planks.items() if plank.family in GEODESICS}

    @cached_property
    def edges(self) -> dict[str, Plank]:
        """The planks along the edges."""
        return {mark: plank for mark, plank in self.planks.items() if plank.family in EDGES}

    @cached_property
    def studs(self) -> dict[str, Stud]:
        """The studs."""
        return self._of(Stud)

    @cached_property
    def blocks(self) -> dict[str, CouplingBlock]:
        """The coupling blocks."""
        return self._of(CouplingBlock)

    @cached_property
    def bolts(self) -> dict[str, Bolt]:
        """The bolts, of a gridshell those of its ridges too."""
        return self._of(Bolt)

    @cached_property
    def screws(self) -> dict[str, Screw]:
        """The screws."""
        return self._of(Screw)

    @cached_property
    def straps(self) -> dict[str, Strap]:
        """The straps."""
        return self._of(Strap)

    @cached_property
    def beams(self) -> dict[str, Beam]:
        """The coupled beams."""
        return _by_mark(self.listed_beams)

    @cached_property
    def joints(self) -> dict[str, Joint]:
        """The joints, of a gridshell those of its ridges too."""
        return _by_mark(self.listed_joints)

    @cached_property
    def joints_of(self) -> dict[str, tuple[Joint, ...]]:
        """The joints at which a part is a member, in the order of the model."""
        found: dict[str, list[Joint]] = defaultdict(list)
        for joint in self.listed_joints:
            for member in joint.members:
                found[member].append(joint)
        return {mark: tuple(joints) for mark, joints in found.items()}

    @cached_property
    def joint_of_fastener(self) -> dict[str, Joint]:
        """The joint that a fastener belongs to, by the fastener's mark."""
        return {fastener: joint for joint in self.listed_joints for fastener in joint.fasteners}

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
    if isinstance(whole, Shell):
        return Index((), whole.beams, shell_parts(whole), whole.joints)
    beams = tuple(beam for shell in whole.shells for beam in shell.beams)
    return Index(whole.shells, beams, all_parts(whole), all_joints(whole))


def sorted_planks(gridshell: Gridshell) -> list[Plank]:
    """Return the planks of all shells sorted by mark, the order of tables and files."""
    return [plank for _, plank in sorted(index_of(gridshell).planks.items())]
