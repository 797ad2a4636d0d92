"""Pictures of shells that are cut for the journey: where they are parted, what stands, where they are joined again."""

from collections.abc import Sequence
from dataclasses import replace

from aag_cad.parts.index import index_of
from aag_cad.parts.marks import is_in_shell, piece_mark, short_mark
from aag_cad.parts.model import Shell
from assembly.base.segments import Segment, Segmentation, Splice
from assembly.base.steps import Plan, Step
from assembly.drawing.outline import Outline, clipped
from assembly.pictures.named_marks import feet_of, numbers_of
from assembly.pictures.step_pictures import Scene


def moved_segments(step: Step, segmentation: Segmentation | None) -> tuple[Segment, ...]:
    """Return the segments that a step sets down or joins; none where the shell is whole."""
    named = {segment.name: segment for segment in segmentation.segments} if segmentation else {}
    return tuple(named[name] for name in step.segments) if step.phase in ("stand", "splice") else ()


def stood_segments(plan: Plan, segmentation: Segmentation | None) -> dict[str, tuple[str, ...]]:
    """Return for each step id the names of the segments that stand on the site before it."""
    stood: tuple[str, ...] = ()
    found = {}
    for step in plan.steps:
        found[step.id] = stood
        if step.phase == "stand":
            stood = (*stood, *(segment.name for segment in moved_segments(step, segmentation)))
    return found


def _own_planks(shell: Shell, segment: Segment) -> dict[str, tuple[str, float, float]]:
    """Return what a segment has of the planks of a shell, by a key: plank, start and end as shares of its length."""
    planks = index_of(shell).planks
    whole = {mark: (mark, 0.0, 1.0) for mark in segment.parts if mark in planks}
    cut = {
        piece_mark(piece.plank, segment.name): (
            piece.plank,
            piece.start / planks[piece.plank].blank.length,
            piece.end / planks[piece.plank].blank.length,
        )
        for piece in segment.pieces
    }
    return whole | cut


def cut_outline(outline: Outline, shell: Shell, segmentation: Segmentation) -> Outline:
    """Return the outline of a shell with its cut planks as pieces, each by the mark of its plank, @ and its segment."""
    own = [segment for segment in segmentation.segments if segment.shell == shell.mark]
    pieces = {key: piece for segment in own for key, piece in _own_planks(shell, segment).items()}
    planks = index_of(shell).planks
    order = sorted(pieces, key=lambda key: (planks[pieces[key][0]].layer, key))
    drawn = {key: clipped(outline.planks[pieces[key][0]], *pieces[key][1:]) for key in order}
    return replace(outline, planks=drawn)


def _between(splices: Sequence[Splice], segments: Sequence[Segment]) -> list[Splice]:
    """Return the splices whose planks have pieces in each of some segments."""
    ends = [{(p.plank, end) for p in segment.pieces for end in (p.start, p.end)} for segment in segments]
    return [s for s in splices if all(any((c.plank, c.station) in held for c in s.cuts) for held in ends)]


def _geodesic_of(shell: Shell, foot: str) -> str:
    index = index_of(shell)
    return next((mark for mark in index.joints[foot].members if mark in index.geodesics), "")


def segment_scene(shell: Shell, step: Step, segmentation: Segmentation, stood: Sequence[str]) -> Scene:
    """Return what the picture of parting a shell, standing a segment or joining two of them shows.

    ``stood`` are the segments that stand on site before the step; planks are those of ``cut_outline``.
    """
    own = {s.name: _own_planks(shell, s) for s in segmentation.segments if s.shell == shell.mark}
    moved = moved_segments(step, segmentation)
    there = [key for name in stood for key in own.get(name, ())]
    if step.phase == "stand":
        new = [key for segment in moved for key in own[segment.name]]
        feet = tuple(foot for foot in feet_of(shell) if _geodesic_of(shell, foot) in new)
        names = {line: short_mark(line) for segment in moved for line in segment.geodesics}
        numbers = numbers_of(feet) | {mark: short_mark(mark) for mark in step.propped}
        return Scene(there=there, new=new, names=names, rings=feet, numbers=numbers, props=step.propped)
    splices = [splice for splice in segmentation.splices if is_in_shell(splice.line, shell.mark)]
    splices = _between(splices, moved) if moved else splices
    lines = dict.fromkeys(splice.line for splice in splices)
    dots = tuple(dict.fromkeys(splice.joint for splice in splices if splice.joint))
    cut = {station.plank for splice in splices for station in splice.cuts}
    held = {segment.name for segment in moved} or set(own)
    worked_on = [key for name in sorted(held) for key, (plank, _, _) in own[name].items() if plank in cut]
    return Scene(
        there=there or [key for listed in own.values() for key in listed],
        worked_on=[*worked_on, *lines],
        names={mark: short_mark(mark) for mark in lines},
        dots=dots,
        numbers=numbers_of(dots),
        props=step.propped,
    )
