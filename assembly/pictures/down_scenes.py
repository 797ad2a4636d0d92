"""Pictures of taking down: what leaves in a step stands out over the grey of what stays."""

from collections.abc import Sequence

from aag_cad.parts.index import index_of
from aag_cad.parts.marks import joint_of, short_mark
from aag_cad.parts.model import Plank, Shell
from assembly.base.steps import Step
from assembly.drawing.bench import beam_strips_svg
from assembly.drawing.steel_sections import strap_section_svg
from assembly.pictures.backgrounds import PAGE_WIDTH, Backgrounds
from assembly.pictures.named_marks import feet_of, middle_of, numbers_of
from assembly.pictures.site_scenes import elevation_svg, foot_sections
from assembly.pictures.step_pictures import Scene, scene_svg
from assembly.plan.shape_control import sling_points

_SHOE_SECTIONS = 1


def _short(marks: Sequence[str]) -> dict[str, str]:
    return {mark: short_mark(mark) for mark in marks}


def _joints(step: Step, marks: Sequence[str]) -> tuple[str, ...]:
    """Return the joints of those of a step's fasteners that are among some marks."""
    known = set(marks)
    return tuple(dict.fromkeys(joint_of(mark) for mark in step.marks if mark in known))


def _beams_of(shell: Shell, step: Step) -> tuple[str, ...]:
    """Return the beams whose planks or studs leave in a step: those of the studs that have no other beam below."""
    if step.phase == "unbolt":
        return tuple(beam.mark for beam in shell.beams if set(beam.planks) <= set(step.marks))
    levels = {plank.beam: plank.layer for plank in shell.planks if plank.beam}
    studs = index_of(shell).studs.keys() & step.marks
    held = [(beam.mark, {place.joint for place in beam.joints} & studs) for beam in shell.beams]
    lowest = min((levels[mark] for mark, found in held if found), default=0)
    return tuple(mark for mark, found in held if found and levels[mark] == lowest)


def _planks_of(shell: Shell, units: Sequence[str]) -> list[str]:
    wanted = set(units)
    return [plank.mark for plank in shell.planks if plank.mark in wanted or plank.beam in wanted]


def _released(shell: Shell, step: Step, there: frozenset[str], outer: set[str]) -> Scene:
    """Return the screws of geodesics that leave: dots from outside, rings from inside, grey where they are out."""
    screws = [screw.mark for screw in shell.screws]
    members = {mark: joint.members for joint in shell.joints for mark in joint.fasteners}
    single: list[Plank] = list(index_of(shell).geodesics.values())
    held = {member for mark in step.marks for member in members.get(mark, ())}
    freed = [plank.mark for plank in single if plank.mark in held]
    dots = _joints(step, [mark for mark in screws if mark in outer])
    rings = tuple(joint for joint in _joints(step, [m for m in screws if m not in outer]) if joint not in dots)
    numbers = numbers_of((*dots, *rings))
    return Scene(there=there, worked_on=freed, names=_short(freed), dots=dots, rings=rings, numbers=numbers,
                 props=step.propped)  # fmt: skip


def _edges(shell: Shell, step: Step, there: frozenset[str]) -> Scene:
    edges = [plank.mark for plank in shell.planks if plank.mark in step.marks]
    straps = [strap.mark for strap in shell.straps if strap.mark in step.marks]
    screwed = _joints(step, [screw.mark for screw in shell.screws])
    return Scene(there=there, new=(*edges, *straps), names=_short(edges), rings=screwed,
                 numbers=numbers_of(screwed) | _short(straps), props=step.propped)  # fmt: skip


def down_scene(shell: Shell, step: Step, there: frozenset[str], outer: set[str]) -> Scene:
    """Return what the picture of a step of taking down one shell shows.

    ``there`` are the parts in place before it, ``outer`` the screws that are driven from outside.
    """
    slings = sling_points(shell)
    studs = [stud.mark for stud in shell.studs]
    match step.phase:
        case "uncover":
            plates = [*(strip.mark for strip in shell.strips), *(mullion.mark for mullion in shell.mullions)]
            rings = _joints(step, [screw.mark for screw in shell.screws])
            return Scene(there=there, new=step.marks, names=_short(plates), rings=rings)
        case "prop":
            edges = list(index_of(shell).edges)
            told = _short(step.propped)
            return Scene(there=there, worked_on=edges, names=_short(edges), props=step.propped, numbers=told)
        case "lift off":
            feet = feet_of(shell)
            return Scene(
                there=there, rings=feet, dots=slings, numbers=numbers_of(feet), tags=dict.fromkeys(slings, "H")
            )
        case "hang":
            return Scene(there=there, dots=slings, tags=dict.fromkeys(slings, "H"), props=step.propped)
        case "release geodesics":
            return _released(shell, step, there, outer)
        case "pull edge planks":
            return _edges(shell, step, there)
        case "lower":
            return Scene(there=there, dots=studs, tags=dict.fromkeys(slings, "H"))
        case "take off beams" | "take off geodesics":
            loose = [plank.mark for plank in shell.planks if plank.mark in step.marks]
            units = (*step.assemblies, *loose)
            unbolted = tuple(joint for joint in _joints(step, [b.mark for b in shell.bolts]) if joint in studs)
            return Scene(there=there, new=_planks_of(shell, units), names=_short(units), starts=units, dots=unbolted)
        case "passports":
            units = tuple(dict.fromkeys(index_of(shell).unit_of.values()))
            return Scene(new=[plank.mark for plank in shell.planks], names=_short(units), starts=units)
        case _:
            beams = _beams_of(shell, step)
            return Scene(there=(), new=_planks_of(shell, beams), names=_short(beams), starts=beams)


def down_pictures(
    backgrounds: Backgrounds, shell: Shell, step: Step, there: frozenset[str], outer: set[str]
) -> tuple[str, ...]:
    """Return the SVG pictures of a step of taking down one shell: the large one first."""
    scene = down_scene(shell, step, there, outer)
    if step.phase in ("unbolt", "pull studs"):
        strips = beam_strips_svg(shell, _beams_of(shell, step), PAGE_WIDTH)
        return strips, scene_svg(backgrounds.outlines.small[shell.mark], scene)
    edges = scene.names if step.phase == "pull edge planks" else ()
    large = scene_svg(backgrounds.outlines.large[shell.mark], scene, [mark for mark in edges if mark in step.marks])
    match step.phase:
        case "hang" | "lower":
            return large, elevation_svg(shell, sling_points(shell), flat=step.phase == "lower")
        case "lift off":
            return (large, *foot_sections(shell, backgrounds.language, _SHOE_SECTIONS))
        case "pull edge planks":
            straps = [strap for strap in shell.straps if strap.mark in step.marks]
            return (
                large,
                *(strap_section_svg(shell, strap, language=backgrounds.language) for strap in middle_of(straps)),
            )
        case _:
            return (large,)
