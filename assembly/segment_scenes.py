"""Pictures of shells that are cut for the journey: where they are parted, what stands, where they are joined again."""

from collections.abc import Iterable, Sequence

from aag_cad.parts.model import Shell
from assembly.pictures import Scene
from assembly.ranges import short_mark
from assembly.segments import Segment, Segmentation
from assembly.site_scenes import feet_of, numbers_of
from assembly.splices import Splice
from assembly.steps import Step


def _own(shell: Shell, segmentation: Segmentation) -> tuple[Segment, ...]:
    return tuple(segment for segment in segmentation.segments if segment.shell == shell.mark)


def stood_segments(step: Step, segmentation: Segmentation) -> tuple[Segment, ...]:
    """Return the segments that a step sets down or joins; none where the shell is whole."""
    names = {segment.name: segment for segment in segmentation.segments if segment.name != segment.shell}
    if step.phase == "stand":
        return tuple(segment for name, segment in names.items() if step.id == f"site.stand.{name}")
    pairs = ((a, b) for a in names.values() for b in names.values() if a is not b)
    return next(((a, b) for a, b in pairs if step.id == f"site.splice.{a.name}.{b.name}"), ())


def segment_planks(shell: Shell, segments: Iterable[Segment]) -> tuple[str, ...]:
    """Return the planks of which segments have the whole or a piece."""
    held = {mark for each in segments for mark in (*each.parts, *(piece.plank for piece in each.pieces))}
    return tuple(plank.mark for plank in shell.planks if plank.mark in held)


def _between(splices: Sequence[Splice], segments: Sequence[Segment]) -> list[Splice]:
    """Return the splices whose planks have pieces in each of some segments."""
    pieces = [{(p.plank, s) for p in segment.pieces for s in (p.start, p.end)} for segment in segments]
    return [s for s in splices if all(any((c.plank, c.station) in held for c in s.cuts) for held in pieces)]


def segment_scene(shell: Shell, step: Step, segmentation: Segmentation, standing: frozenset[str]) -> Scene:
    """Return what the picture of parting a shell, standing a segment or joining two of them shows.

    ``standing`` are the planks that stand on site before the step.
    """
    own = _own(shell, segmentation)
    splices = [
        splice for splice in segmentation.splices if any(c.plank.startswith(f"{shell.mark}-") for c in splice.cuts)
    ]
    if step.phase == "stand":
        moved = stood_segments(step, segmentation)
        new = [mark for mark in segment_planks(shell, moved) if mark not in standing]
        feet = tuple(foot for foot in feet_of(shell) if _foot_of(shell, foot) in {*new})
        names = {line: short_mark(line) for segment in moved for line in segment.geodesics}
        return Scene(there=standing, new=new, names=names, rings=feet, numbers=numbers_of(feet), props=step.props)
    if step.phase == "splice":
        splices = _between(splices, stood_segments(step, segmentation))
    lines = dict.fromkeys(splice.line for splice in splices)
    dots = tuple(dict.fromkeys(splice.joint for splice in splices if splice.joint))
    cut = {cut.plank for splice in splices for cut in splice.cuts}
    there = standing if step.phase == "splice" else segment_planks(shell, own)
    return Scene(there=there, worked_on=sorted({*cut, *lines}), names={mark: short_mark(mark) for mark in lines},
                 dots=dots, numbers=numbers_of(dots), props=step.props)  # fmt: skip


def _foot_of(shell: Shell, foot: str) -> str:
    """Return the geodesic that stands on a foot."""
    families = {plank.mark: plank.family for plank in shell.planks}
    members = next(joint.members for joint in shell.joints if joint.mark == foot)
    return next((mark for mark in members if families.get(mark) == "G"), "")
