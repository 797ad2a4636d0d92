"""The work on the building site: feet, standing shells, ridges, cover (paper section 3.2)."""

from collections.abc import Iterator

from aag_cad.parts.marks import parse_mark, shell_of
from aag_cad.parts.model import Gridshell
from assembly.kit import shell_kit
from assembly.process import EVERYONE, PAIR, Work


def ridge_pairs(gridshell: Gridshell) -> tuple[tuple[str, str], ...]:
    """Return the pairs of shells that meet along a ridge: those that blades or joints join, else neighbours."""
    joined = {frozenset(f"S{digit}" for digit in parse_mark(blade.mark).family[1:]) for blade in gridshell.blades}
    joined |= {frozenset(shell_of(mark) for mark in joint.members) - {""} for joint in gridshell.joints}
    pairs = {(min(pair), max(pair)) for pair in joined if len(pair) == PAIR}
    if not pairs:
        marks = [shell.mark for shell in gridshell.shells]
        ring = zip(marks, (*marks[1:], marks[0]), strict=True)
        pairs = {(min(a, b), max(a, b)) for a, b in ring if a != b}
    return tuple(sorted(pairs))


def _ridges(gridshell: Gridshell) -> Iterator[Work]:
    """Yield the joining of each pair of shells, with their blades and the fasteners of these."""
    before: tuple[str, ...] = ()
    for a, b in ridge_pairs(gridshell):
        blades = [blade.mark for blade in gridshell.blades if set(parse_mark(blade.mark).family[1:]) == {a[1:], b[1:]}]
        fasteners = [
            mark
            for joint in gridshell.joints
            if {shell_of(member) for member in joint.members} - {""} == {a, b}
            for mark in joint.fasteners
        ]
        work = Work(
            f"site.ridge.{a}.{b}",
            "ridges",
            f"Join shells {a} and {b} along their ridge",
            after=(f"site.stand.{a}", f"site.stand.{b}", *before),
            marks=(*blades, *fasteners),
            assemblies=(a, b),
            least_crew=2 * PAIR,
        )
        yield work
        before = (work.id,)


def site_works(gridshell: Gridshell) -> tuple[Work, ...]:
    """Return the work that makes the gridshell of stiff shells, in an order in which it can be done."""
    kits = {shell.mark: shell_kit(shell) for shell in gridshell.shells}
    feet = Work(
        "site.feet",
        "feet",
        "Set out the feet of the vault",
        after=(),
        marks=tuple(mark for kit in kits.values() for mark in kit.feet),
        least_crew=PAIR,
    )
    standing = tuple(
        Work(
            f"site.stand.{mark}",
            "stand",
            f"Stand shell {mark} on its feet",
            after=(feet.id, f"{mark}.tighten"),
            marks=kit.standing,
            assemblies=(mark,),
            least_crew=EVERYONE,
        )
        for mark, kit in kits.items()
    )
    ridges = tuple(_ridges(gridshell))
    last = tuple(work.id for work in ridges[-1:] or standing)
    covering = tuple(
        Work(f"site.cover.{mark}", "cover", f"Cover shell {mark}", after=last, marks=kit.cover, least_crew=PAIR)
        for mark, kit in kits.items()
        if kit.cover
    )
    return (feet, *standing, *ridges, *covering)
