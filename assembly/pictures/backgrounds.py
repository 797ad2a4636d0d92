"""What the pictures of a plan are drawn on: outlines of shells alike only once, and what is in place at each step."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from aag_cad.language import Language
from aag_cad.once import once
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import in_other_shell
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Gridshell
from aag_cad.units import Floats
from assembly.base.part_groups import shell_kit
from assembly.base.phases import is_down
from assembly.base.segments import Segmentation
from assembly.base.steps import Plan, Step, StepProp
from assembly.drawing.outline import Outline, ridge_outline, shell_outline, vault_outline
from assembly.graph.interlacing import Slide
from assembly.pictures.segment_scenes import stood_segments
from assembly.plan.site_work import ridge_pairs

PAGE_WIDTH = 1800.0
SMALL_WIDTH = 880.0
MARGIN = 50.0


@dataclass(frozen=True, eq=False)
class Outlines:
    """What the pictures of a gridshell are drawn on: its kinds of shells on a page and smaller, its plan, its ridges.

    ``large`` and ``small`` are of the first shell of twins; ``ridges`` go by the shells on either side.
    """

    large: dict[str, Outline]
    small: dict[str, Outline]
    plan: Outline
    ridges: dict[tuple[str, ...], Outline]


@dataclass(frozen=True, eq=False)
class Backgrounds:
    """The outlines that the pictures of a gridshell are drawn from, and what is in place before each step.

    ``standing`` are the planks of the whole shells, ``stood`` the segments of cut ones, that stand on the site before
    each step; ``slides`` say how planks are slid in, by mark.
    """

    gridshell: Gridshell
    outlines: Outlines
    before: dict[str, frozenset[str]]
    standing: dict[str, frozenset[str]]
    stood: dict[str, tuple[str, ...]]
    segmentation: Segmentation | None
    slides: Mapping[str, Slide]
    language: Language


def twin_step(step: Step, shell: str, twin: str) -> Step:
    """Return a step as its twin's shell would have it: with that shell's number in all marks."""
    if shell == twin:
        return step

    def moved(marks: Sequence[str]) -> tuple[str, ...]:
        return tuple(in_other_shell(mark, shell, twin) for mark in marks)

    props = tuple(StepProp(joint, twin) for joint in moved(step.propped))
    return replace(step, shell=twin, marks=moved(step.marks), assemblies=moved(step.assemblies), props=props)


def _in_place(plan: Plan, gridshell: Gridshell) -> dict[str, frozenset[str]]:
    """Return for each step id the parts that are in their places before it; those of a beam when it is laid."""
    parts_of = {mark: marks for shell in gridshell.shells for mark, marks in shell_kit(shell).beams.items()}
    in_beams = {mark for marks in parts_of.values() for mark in marks}
    placed: set[str] = set()
    found = {}
    for step in plan.steps:
        found[step.id] = frozenset(placed)
        placed.update(mark for mark in step.marks if mark not in in_beams)
        placed.update(mark for beam in step.assemblies for mark in parts_of.get(beam, ()))
    return found


def _still_there(plan: Plan, gridshell: Gridshell) -> dict[str, frozenset[str]]:
    """Return for each step id of taking down the parts that are still in their places before it."""
    parts_of = {mark: marks for shell in gridshell.shells for mark, marks in shell_kit(shell).beams.items()}
    there = set(index_of(gridshell).parts)
    found = {}
    for step in plan.steps:
        found[step.id] = frozenset(there)
        there.difference_update(step.marks)
        there.difference_update(mark for beam in step.assemblies for mark in parts_of.get(beam, ()))
    return found


def _standing(plan: Plan, gridshell: Gridshell, down: bool) -> dict[str, frozenset[str]]:
    """Return for each step id the planks of the shells that stand on the site before it, in whole or in part."""
    planks = {shell.mark: index_of(shell).planks.keys() for shell in gridshell.shells}
    standing = set[str]().union(*planks.values()) if down else set[str]()
    found = {}
    for step in plan.steps:
        found[step.id] = frozenset(standing)
        moved = {mark for assembly in step.assemblies for mark in planks.get(assembly, ())}
        if step.phase == "stand":
            standing |= moved
        if step.phase == "lift off":
            standing -= moved
    return found


def ridge_planks(gridshell: Gridshell, pair: Sequence[str]) -> tuple[str, ...]:
    """Return the edge planks of two shells that face each other, none where either has none."""
    shells = index_of(gridshell).shells

    def middles(mark: str) -> dict[str, Floats]:
        matrix = frame_matrix(shells[mark].placement)
        edges = index_of(shells[mark]).edges.values()
        points = {plank.mark: plank.curve.point_spline(plank.curve.length / 2.0) for plank in edges}
        return {edge: matrix[:3, :3] @ point + matrix[:3, 3] for edge, point in points.items()}

    ours, theirs = middles(pair[0]), middles(pair[1])
    gaps = {(a, b): float(np.linalg.norm(ours[a] - theirs[b])) for a in sorted(ours) for b in sorted(theirs)}
    return min((gap, ends) for ends, gap in gaps.items())[1] if gaps else ()


@once
def outlines_of(gridshell: Gridshell) -> Outlines:
    """Return the outlines of a gridshell: they take a second, and all booklets draw on them."""
    shells = index_of(gridshell).shells
    firsts = [shells[mark] for mark in dict.fromkeys(index_of(gridshell).twins.values())]
    facing = {pair: ridge_planks(gridshell, pair) for pair in ridge_pairs(gridshell)}
    return Outlines(
        large={shell.mark: shell_outline(shell, PAGE_WIDTH, MARGIN, ("shell", "cover")) for shell in firsts},
        small={shell.mark: shell_outline(shell, SMALL_WIDTH, MARGIN) for shell in firsts},
        plan=vault_outline(gridshell, PAGE_WIDTH * 0.8, MARGIN, ("ground",)),
        ridges={
            pair: ridge_outline(gridshell, planks, PAGE_WIDTH, MARGIN) for pair, planks in facing.items() if planks
        },
    )


def backgrounds_of(
    plan: Plan,
    gridshell: Gridshell,
    segmentation: Segmentation | None = None,
    slides: Iterable[Slide] = (),
    language: Language = "en",
) -> Backgrounds:
    """Return what the steps of a plan of putting together or of taking down are drawn on.

    ``segmentation`` is needed where shells stand in segments, ``slides`` where planks are slid in.
    """
    down = any(is_down(step.phase) for step in plan.steps)
    return Backgrounds(
        gridshell=gridshell,
        outlines=outlines_of(gridshell),
        before=_still_there(plan, gridshell) if down else _in_place(plan, gridshell),
        standing=_standing(plan, gridshell, down),
        stood=stood_segments(plan, segmentation),
        segmentation=segmentation,
        slides={slide.unit: slide for slide in slides},
        language=language,
    )
