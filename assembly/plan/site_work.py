"""The work on site: feet, standing shells, segments joined again, ridges, cover (paper section 3.2)."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from aag_cad.language import Text, text
from aag_cad.parts.marks import joint_of, shell_of, shells_of, short_mark
from aag_cad.parts.model import Gridshell, Shell
from assembly.base.locking_order import LockingOrder
from assembly.base.part_groups import Kit, shell_kit
from assembly.base.phases import Phase
from assembly.base.segments import Segment, Segmentation, segments_of
from assembly.base.steps import PropsAway
from assembly.plan.parting import brace_extras, seam_extras
from assembly.plan.step_cards import Fasteners, card, fasteners_by_kind
from assembly.plan.work import EVERYONE, PAIR, Work, props_under
from assembly.transport.seams import Seam, foot_joints, standing_order


@dataclass(frozen=True)
class _Site:
    """What the work on site is made from; ``stiff`` are the ids of the works after which each shell can travel."""

    gridshell: Gridshell
    stiff: Mapping[str, str]
    segmentation: Segmentation | None
    locking: Mapping[str, LockingOrder]
    fasteners: Fasteners

    def work(self, name: str, phase: Phase, title: Text, told: str = "") -> Work:
        """Return a piece of work on site that as yet adds nothing and waits for nothing."""
        return Work(f"site.{name}", phase, title, card(phase, self.fasteners, told=told))


def ridge_pairs(gridshell: Gridshell) -> tuple[tuple[str, str], ...]:
    """Return the pairs of shells that meet along a ridge: those that blades or joints join, else neighbours."""
    joined = {frozenset(shells_of(blade.mark)) for blade in gridshell.blades}
    joined |= {frozenset(shell_of(mark) for mark in joint.members) - {""} for joint in gridshell.joints}
    pairs = {(min(pair), max(pair)) for pair in joined if len(pair) == PAIR}
    if not pairs:
        marks = [shell.mark for shell in gridshell.shells]
        ring = zip(marks, (*marks[1:], marks[0]), strict=True)
        pairs = {(min(a, b), max(a, b)) for a, b in ring if a != b}
    return tuple(sorted(pairs))


def _crown_props(site: _Site, shell: Shell) -> tuple[str, ...]:
    """Return the joints of the props that a stiff shell needs until it leans on its neighbours, by locking order."""
    order = site.locking.get(shell.mark)
    return tuple(prop.joint for prop in order.released.props) if order else ()


def _prop_notes(site: _Site, shell: Shell) -> tuple[Text, ...]:
    order = site.locking.get(shell.mark)
    if order is None or not order.released.props:
        return ()
    at = short_mark(order.released.at)
    return (text("site.stand.props", sag=order.released.displacement, joint=at),)


def _standing_notes(segment: Segment, beside: Sequence[Seam], others: Sequence[str]) -> tuple[Text, ...]:
    """Return how a segment is set down beside those that stand."""
    if not beside:
        after = text("site.stand.first", segment=segment.name, others=tuple(others))
        return after, text("site.stand.alone", segment=segment.name)
    names = [next(iter({seam.keeper, seam.bare} - {segment.name})) for seam in beside]
    gaps = [round(seam.gap) for seam in beside]
    if len(beside) > 1:
        return (text("site.stand.closing", b=names[0], c=names[1], gap=sum(gaps)),)
    return (text("site.stand.beside", b=names[0], gap=gaps[0], line=short_mark(beside[0].line)),)


def _split_standing(shell: Shell, kit: Kit, own: Sequence[Segment]) -> dict[str, tuple[str, ...]]:
    """Return the bolts of the shoes by segment: those of its geodesics' feet."""
    homes = {joint: segment.name for segment in own for joint in foot_joints(shell, segment)}
    groups: dict[str, list[str]] = {segment.name: [] for segment in own}
    for mark in kit.standing:
        groups[homes.get(joint_of(mark), own[0].name)].append(mark)
    return {name: tuple(marks) for name, marks in groups.items()}


def _segment_works(site: _Site, shell: Shell, kit: Kit, feet: str) -> Iterator[Work]:
    """Yield the standing of the segments of a cut shell, each joined to its neighbour before the next one comes."""
    order = list(standing_order(shell, site.segmentation))
    own = [segment for segment, _ in order]
    bolts, crown = _split_standing(shell, kit, own), _crown_props(site, shell)
    under = {joint: next((s.name for s in own if joint in s.parts), own[0].name) for joint in crown}
    open_seams = Counter(name for _, beside in order for seam in beside for name in (seam.keeper, seam.bare))
    named = {segment.name: segment for segment in own}
    before: tuple[str, ...] = (feet, site.stiff[shell.mark])
    for i, (segment, beside) in enumerate(order):
        standing = bolts[segment.name]
        notes = _standing_notes(segment, beside, [other.name for other in own[i + 1 :]])
        held = tuple(joint for joint in crown if under[joint] == segment.name)
        title = text("site.stand.segment" if standing else "site.stand.raised", segment=segment.name)
        stand = replace(
            site.work(f"stand.{segment.name}", "stand", title, "stand segment" if standing else "raise segment"),
            after=before,
            marks=standing,
            assemblies=(shell.mark,),
            segments=(segment.name,),
            least_crew=EVERYONE,
            props=props_under((*segment.props, *held), segment.name),
            notes=(*notes, *(_prop_notes(site, shell) if held else ())),
        )
        yield stand
        before = (stand.id,)
        for seam in beside:
            open_seams.subtract((seam.keeper, seam.bare))
            whole = [named[name] for name in (seam.keeper, seam.bare) if not open_seams[name]]
            bare = (extra for other in whole for extra in brace_extras(other, "splice"))
            title = text("site.splice.title", a=seam.keeper, b=seam.bare, line=short_mark(seam.line))
            splice = replace(
                site.work(f"splice.{seam.keeper}.{seam.bare}", "splice", title),
                after=before,
                assemblies=(shell.mark,),
                segments=(seam.keeper, seam.bare),
                least_crew=2 * PAIR,
                extras=(*seam_extras(seam, "splice"), *bare),
            )
            yield splice
            before = (splice.id,)


def _standing(site: _Site, shell: Shell, feet: str) -> tuple[Work, ...]:
    """Return the work by which a shell, whole or in segments, comes to stand on its feet."""
    kit = shell_kit(shell)
    if segments_of(site.segmentation, shell.mark):
        return tuple(_segment_works(site, shell, kit, feet))
    props, title = props_under(_crown_props(site, shell), shell.mark), text("site.stand.shell", shell=shell.mark)
    work = replace(
        site.work(f"stand.{shell.mark}", "stand", title, "" if props else "stand free"),
        after=(feet, site.stiff[shell.mark]),
        marks=kit.standing,
        assemblies=(shell.mark,),
        least_crew=EVERYONE,
        props=props,
        notes=_prop_notes(site, shell),
    )
    return (work,)


def _props_off(site: _Site, works: tuple[Work, ...]) -> tuple[Work, ...]:
    """Return the standing of a cut shell that meets no other: its segments' props go once all are joined.

    Props that the finished shell needs by its locking order stay.
    """
    crown = {prop.joint for order in site.locking.values() for prop in order.released.props}
    joints = tuple(dict.fromkeys(p.joint for work in works for p in work.props if p.joint not in crown))
    if len(works) == 1 or not joints:
        return works
    return (*works[:-1], replace(works[-1], extras=(*works[-1].extras, PropsAway(joints))))


def _ridges(site: _Site, stood: dict[str, tuple[Work, ...]]) -> Iterator[Work]:
    """Yield the joining of each pair of shells, with their blades and the fasteners of these; props off at the end."""
    gridshell = site.gridshell
    before: tuple[str, ...] = ()
    pairs = ridge_pairs(gridshell)
    props = {mark: tuple(prop for work in works for prop in work.props) for mark, works in stood.items()}
    every = tuple(dict.fromkeys(prop.joint for listed in props.values() for prop in listed))
    for i, (a, b) in enumerate(pairs):
        blades = [blade.mark for blade in gridshell.blades if set(shells_of(blade.mark)) == {a, b}]
        fasteners = [
            mark
            for joint in gridshell.joints
            if {shell_of(member) for member in joint.members} - {""} == {a, b}
            for mark in joint.fasteners
        ]
        last = i == len(pairs) - 1
        work = replace(
            site.work(f"ridge.{a}.{b}", "ridges", text("site.ridge.title", a=a, b=b)),
            after=(*(work.id for mark in (a, b) for work in stood[mark][-1:]), *before),
            marks=(*blades, *fasteners),
            assemblies=(a, b),
            least_crew=2 * PAIR,
            props=tuple(dict.fromkeys((*props[a], *props[b]))),
            extras=(PropsAway(every),) if last and every else (),
        )
        yield work
        before = (work.id,)


def site_works(
    gridshell: Gridshell,
    stiff: Mapping[str, str],
    segmentation: Segmentation | None = None,
    locking: Sequence[LockingOrder] = (),
) -> tuple[Work, ...]:
    """Return the work that makes the gridshell of stiff shells, in an order in which it can be done.

    ``stiff`` are the ids of the works after which each shell, or what it is parted into, can travel.

    A shell that ``segmentation`` cuts stands segment by segment, each joined to its neighbours (``standing_order``).
    Props of ``locking`` under the finished shells (``LockingOrder.released``) stand before a shell leaves its slings,
    and stay until the last ridge is joined.
    """
    fasteners = fasteners_by_kind(gridshell, gridshell.shells)
    site = _Site(gridshell, stiff, segmentation, {order.shell: order for order in locking}, fasteners)
    feet = replace(
        site.work("feet", "feet", text("site.feet.title")),
        marks=tuple(mark for shell in gridshell.shells for mark in shell_kit(shell).feet),
        least_crew=PAIR,
    )
    stood = {shell.mark: _standing(site, shell, feet.id) for shell in gridshell.shells}
    ridges = tuple(_ridges(site, stood))
    standing = tuple(work for works in stood.values() for work in (works if ridges else _props_off(site, works)))
    last = tuple(work.id for work in ridges[-1:] or (works[-1] for works in stood.values()))
    covering = tuple(
        replace(
            site.work(f"cover.{mark}", "cover", text("site.cover.title", shell=mark)),
            after=last,
            marks=kit.cover,
            least_crew=PAIR,
        )
        for mark, kit in ((shell.mark, shell_kit(shell)) for shell in gridshell.shells)
        if kit.cover
    )
    return (feet, *standing, *ridges, *covering)
