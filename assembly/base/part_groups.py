"""Which part goes with what: the pieces of every beam, stud, edge plank and geodesic of a shell, by mark."""

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from aag_cad.families import EDGES
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import Place, kind_of, parts_at
from aag_cad.parts.model import Joint, JointKind, Shell, shell_parts
from assembly.base.errors import PlanError

Group: TypeAlias = Literal["beams", "studs", "edges", "outside", "inside", "feet", "standing", "cover"]


# What is fixed on the site, when the shell is stiff.
_LATER: dict[JointKind, Group] = {"footing": "feet", "foot": "standing", "cover": "cover"}


@dataclass(frozen=True)
class Kit:
    """Marks of parts by what they are added with.

    ``beams``: planks, blocks and block bolts by beam. ``studs``: bolts by stud. ``edges``: screws, straps and the bolts
    of straps by edge plank. ``outside`` and ``inside``: screws by geodesic, by the side that they are driven from.
    ``feet``: what stands on the ground, as footings, threaded rods and shoes. ``standing``: bolts of the shoes.
    ``cover``: blocks on geodesics, mullions, strips, clamping bars and the screws of all these.
    """

    beams: dict[str, tuple[str, ...]]
    studs: dict[str, tuple[str, ...]]
    edges: dict[str, tuple[str, ...]]
    lower_edges: tuple[str, ...]
    outside: dict[str, tuple[str, ...]]
    inside: dict[str, tuple[str, ...]]
    feet: tuple[str, ...]
    standing: tuple[str, ...]
    cover: tuple[str, ...]


def _refuse_strays(shell: Shell, kit: Kit) -> None:
    groups = (*kit.beams.values(), *kit.studs.values(), *kit.edges.values(), *kit.outside.values())
    placed = {mark for group in (*groups, *kit.inside.values()) for mark in group}
    placed |= {*kit.studs, *kit.edges, *kit.outside, *kit.feet, *kit.standing, *kit.cover}
    strays = sorted(index_of(shell).parts.keys() - placed)
    if strays:
        raise PlanError(
            f"{', '.join(strays[:5])}{' and more' if len(strays) > 5 else ''}: {len(strays)} parts that no joint of "
            f"{shell.mark} names, so that nobody knows when to add them; allowed 0: name them in a joint"
        )


def driven_from_outside(shell: Shell) -> set[str]:
    """Return the screws whose heads lie on the outer side."""
    joints = index_of(shell).joint_of_fastener
    held = ((screw, joints[screw.mark]) for screw in shell.screws if screw.mark in joints)
    return {screw.mark for screw, joint in held if float(np.array(screw.frame.z) @ np.array(joint.normal)) < 0.0}


def _homes(shell: Shell, block_beam: dict[str, str]) -> dict[tuple[Group, str], list[str]]:
    """Return the fasteners by what they are added with: a group of the kit and the mark of a piece in it.

    Steel that connects, but for studs and blocks, goes with the fasteners of the first joint that names it.
    """
    index, outer = index_of(shell), driven_from_outside(shell)

    def home(joint: Joint, fastener: str) -> tuple[Group, str] | None:
        if joint.kind in _LATER:
            return _LATER[joint.kind], ""
        hub = next((mark for mark in joint.members if mark in index.studs or mark in block_beam), "")
        if hub in index.studs:
            return "studs", hub
        if hub and fastener in index.bolts:
            return "beams", block_beam[hub]
        planks = (index.planks[mark] for mark in joint.members if mark in index.planks)
        flat = sorted((plank.family, plank.mark) for plank in planks if not plank.upright)
        if not flat:
            return None
        family, mark = flat[0]
        return ("edges" if family in EDGES else "outside" if fastener in outer else "inside"), mark

    fittings = {part.mark for part in parts_at(shell_parts(shell), "shell") if kind_of(part).role == "connector"}
    fittings -= index.studs.keys() | index.blocks.keys()
    homes: dict[tuple[Group, str], list[str]] = defaultdict(list)
    for joint in shell.joints:
        for mark in (*(member for member in joint.members if member in fittings), *joint.fasteners):
            found = home(joint, mark)
            if found is not None:
                homes[found].append(mark)
        fittings.difference_update(joint.members)
    return homes


def _placed(shell: Shell, place: Place) -> tuple[str, ...]:
    return tuple(part.mark for part in parts_at(shell_parts(shell), place))


def shell_kit(shell: Shell) -> Kit:
    """Return what goes with what in a shell; PlanError with the marks of parts that no joint names."""
    home = index_of(shell).beam_of
    block_beam = {block.mark: home[block.mark] for block in shell.blocks if block.mark in home}
    homes = _homes(shell, block_beam)

    def group(name: Group, marks: Iterable[str]) -> dict[str, tuple[str, ...]]:
        return {mark: tuple(homes.get((name, mark), ())) for mark in marks}

    covering = {mark for joint in shell.joints if joint.kind == "cover" for mark in joint.members}
    blocks: dict[str, list[str]] = defaultdict(list)
    for block in shell.blocks:
        blocks[block_beam.get(block.mark, "")].append(block.mark)
    bolts = group("beams", (beam.mark for beam in shell.beams))
    edges = list(index_of(shell).edges)
    flat = list(index_of(shell).geodesics)
    footed = {mark for joint in shell.joints if joint.kind == "foot" for mark in joint.members}
    kit = Kit(
        beams={beam.mark: (*beam.planks, *blocks[beam.mark], *bolts[beam.mark]) for beam in shell.beams},
        studs=group("studs", (stud.mark for stud in shell.studs)),
        edges=group("edges", edges),
        lower_edges=tuple(mark for mark in edges if mark in footed),
        outside=group("outside", flat),
        inside=group("inside", flat),
        feet=tuple(dict.fromkeys((*_placed(shell, "ground"), *homes.get(("feet", ""), ())))),
        standing=tuple(homes.get(("standing", ""), ())),
        cover=(
            *(mark for mark in blocks[""] if mark in covering),
            *_placed(shell, "cover"),
            *homes.get(("cover", ""), ()),
        ),
    )
    _refuse_strays(shell, kit)
    return kit
