"""Pieces of work, and the steps that they become: with numbers, people and what ends with a check."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain

from aag_cad.language import Text
from assembly.base.lifters import Lifters, hands_for
from assembly.base.phases import PHASE, Phase
from assembly.base.steps import Extra, Step, StepProp, carried

PAIR = 2
EVERYONE = 1000
LAID_A_STEP = 7


@dataclass(frozen=True)
class Work:
    """What a step does, before it has its number and its crew: see ``assembly.base.steps.Step``.

    ``after`` are the ids of the works that come before it, ``least_crew`` the fewest people who can do it.
    """

    id: str
    phase: Phase
    title: Text
    card: Text
    shell: str = ""
    after: tuple[str, ...] = ()
    marks: tuple[str, ...] = ()
    assemblies: tuple[str, ...] = ()
    segments: tuple[str, ...] = ()
    least_crew: int = 1
    props: tuple[StepProp, ...] = ()
    extras: tuple[Extra, ...] = ()
    notes: tuple[Text, ...] = ()


def all_of(groups: Iterable[Sequence[str]]) -> tuple[str, ...]:
    """Return the marks of all groups, in their order."""
    return tuple(chain.from_iterable(groups))


def props_under(joints: Iterable[str], holds: str) -> tuple[StepProp, ...]:
    """Return a prop under each joint, once each, for the shell or segment that bears on it."""
    return tuple(StepProp(joint, holds) for joint in dict.fromkeys(joints))


def steps_from(works: Sequence[Work], weights: Mapping[str, tuple[float, float]], lifters: Lifters) -> Iterator[Step]:
    """Yield works as steps, numbered, with the hands for their heaviest and longest piece.

    ``weights`` are (kg, mm) of parts, beams, shells and segments. The last step of each phase in a chapter ends with a
    check, and so does every step of some phases.
    """
    last = {(work.shell, work.phase): work.id for work in works}
    for number, work in enumerate(works, start=1):
        row = PHASE[work.phase]
        pieces = [weights[mark] for mark in carried(work.phase, work.marks, work.assemblies, work.segments)]
        hands = hands_for(lifters, max((m for m, _ in pieces), default=0.0), max((n for _, n in pieces), default=0.0))
        yield Step(
            number=number,
            id=work.id,
            phase=work.phase,
            title=work.title,
            shell=work.shell,
            marks=work.marks,
            assemblies=work.assemblies,
            segments=work.segments,
            crew=max(hands.people, min(work.least_crew, lifters.people)),
            gear=hands.gear and not row.lifts,
            predecessors=work.after,
            card=work.card,
            notes=work.notes,
            held=row.each_held or last[work.shell, work.phase] == work.id,
            props=work.props,
            extras=work.extras,
        )
