"""Which picture belongs to which step: what is there before it, what is new, what is numbered."""

from collections.abc import Mapping, Sequence

import numpy as np

from aag_cad.parts.index import index_of
from aag_cad.parts.marks import in_other_shell, is_in_shell, joint_of, parse_mark, shell_of, short_mark
from aag_cad.parts.model import Shell
from assembly.base.part_groups import driven_from_outside
from assembly.base.phases import PHASE, is_down
from assembly.base.segments import Segmentation
from assembly.base.steps import Plan, Step
from assembly.drawing.bench import beam_strips_svg
from assembly.drawing.outline import shell_outline
from assembly.drawing.steel_sections import strap_section_svg
from assembly.drawing.svg import group, path, svg
from assembly.graph.interlacing import Slide
from assembly.pictures.backgrounds import MARGIN, PAGE_WIDTH, Backgrounds, backgrounds_of, twin_step
from assembly.pictures.down_scenes import down_pictures
from assembly.pictures.named_marks import middle_of, numbers_of
from assembly.pictures.segment_scenes import cut_outline, moved_segments, segment_scene
from assembly.pictures.site_scenes import elevation_svg, foot_sections, ridge_pictures, site_svg
from assembly.pictures.step_pictures import NEW, PIECES, THERE, Scene, prop_items, scene_svg
from assembly.plan.shape_control import control_figures, sling_points

__all__ = [
    "PAGE_WIDTH",
    "Backgrounds",
    "backgrounds_of",
    "home_shell",
    "legend_svgs",
    "phase_svg",
    "picture_key",
    "step_pictures",
]


def _short(marks: Sequence[str]) -> dict[str, str]:
    return {mark: short_mark(mark) for mark in marks}


def _planks_of(shell: Shell, units: Sequence[str]) -> tuple[str, ...]:
    wanted = set(units)
    return tuple(plank.mark for plank in shell.planks if plank.mark in wanted or plank.beam in wanted)


def _made_beams(shell: Shell, step: Step) -> tuple[str, ...]:
    return tuple(beam.mark for beam in shell.beams if set(beam.planks) <= set(step.marks))


def _joints_of(step: Step, letters: str = "BW") -> tuple[str, ...]:
    """Return the joints that a step's bolts (B) and screws (W) belong to."""
    fasteners = (mark for mark in step.marks if parse_mark(mark).letter in tuple(letters))
    return tuple(dict.fromkeys(joint_of(mark) for mark in fasteners))


def _fixing_scene(shell: Shell, step: Step, there: frozenset[str], single: Sequence[str]) -> Scene:
    """Return the screws of the geodesics of a step: dots where they are driven from outside, rings from inside."""
    held = {member for mark in step.marks for member in index_of(shell).joint_of_fastener[mark].members}
    fixed = [mark for mark in single if mark in held]
    outer = driven_from_outside(shell)
    dots = tuple(dict.fromkeys(joint_of(mark) for mark in step.marks if mark in outer))
    rings = tuple(joint for joint in _joints_of(step, "W") if joint not in dots)
    done = tuple(joint_of(screw.mark) for screw in shell.screws if screw.mark in there)
    return Scene(there=there, worked_on=fixed, names=_short(fixed), dots=dots, rings=rings,
                 numbers=numbers_of((*dots, *rings)), done=done, props=step.propped)  # fmt: skip


def _sliding_scene(shell: Shell, step: Step, there: frozenset[str], known: Mapping[str, Slide]) -> Scene:
    """Return the planks that are slid in, with the crossings that they pass."""
    units = (*step.assemblies, *step.marks)
    slides = {unit: known[unit] for unit in units if unit in known}
    passed = tuple(dict.fromkeys(joint for slide in slides.values() for joint in slide.joints))
    return Scene(there=there, new=_planks_of(shell, units), names=_short(units), starts=units, rings=passed,
                 numbers=numbers_of(passed), slides={unit: slide.end for unit, slide in slides.items()})  # fmt: skip


def _edge_scene(shell: Shell, step: Step, there: frozenset[str], flat: Sequence[str]) -> Scene:
    """Return edge planks with their straps and screws."""
    straps = tuple(strap.mark for strap in shell.straps if strap.mark in step.marks)
    screwed = _joints_of(step, "W")
    told = numbers_of(screwed) | _short(straps)
    return Scene(there=there, new=(*flat, *straps), names=_short(flat), rings=screwed, numbers=told, props=step.propped)


def _shell_scene(shell: Shell, step: Step, there: frozenset[str], slides: Mapping[str, Slide]) -> Scene:
    """Return what the picture of a step of one shell shows."""
    single = [plank.mark for plank in shell.planks if not plank.beam]
    flat = tuple(mark for mark in step.marks if mark in single)
    units = (*step.assemblies, *flat)
    match step.phase:
        case "prefabricate":
            beams = _made_beams(shell, step)
            return Scene(new=_planks_of(shell, beams), names=_short(beams), starts=beams)
        case "lay A1" | "lay G" | "lay A2" | "lay":
            return Scene(there=there, new=_planks_of(shell, units), names=_short(units), starts=units)
        case "slide":
            return _sliding_scene(shell, step, there, slides)
        case "studs":
            joints = _joints_of(step)
            done = tuple(stud.mark for stud in shell.studs if stud.mark in there)
            return Scene(there=there, dots=joints, numbers=numbers_of(joints), done=done)
        case "hoist":
            control, slings = control_figures(shell).studs, sling_points(shell)
            tags = {mark: name for name, mark in control.items()} | dict.fromkeys(slings, "H")
            props = tuple(mark for mark in step.propped if mark not in tags)
            return Scene(there=there, dots=slings, rings=tuple(control.values()), tags=tags, props=props,
                         numbers=_short(props))  # fmt: skip
        case "edge planks":
            return _edge_scene(shell, step, there, flat)
        case "fix geodesics":
            return _fixing_scene(shell, step, there, single)
        case _:
            blocks = [block.mark for block in shell.blocks if block.mark in there]
            straps = tuple(strap.mark for strap in shell.straps if strap.mark in there)
            studs = [stud.mark for stud in shell.studs if stud.mark not in step.propped]
            return Scene(there=there, new=straps, dots=studs, rings=blocks, props=step.propped)


def _cover_scene(shell: Shell, step: Step, there: frozenset[str]) -> Scene:
    """Return what the picture of the covering of one shell shows: strips with their marks, bars, places of screws."""
    strips, mullions = [strip.mark for strip in shell.strips], [mullion.mark for mullion in shell.mullions]
    blocks = _short([block.mark for block in shell.blocks if block.mark in step.marks])
    return Scene(there=there, new=step.marks, names=_short([*strips, *mullions]), rings=_joints_of(step, "W"),
                 numbers=blocks)  # fmt: skip


def home_shell(step: Step) -> str:
    """Return the shell that the picture of a step shows alone, or "" where it shows the whole."""
    if PHASE[step.phase].shown == "moved shell":
        return shell_of(step.marks[0]) if step.marks else step.assemblies[0]
    return step.shell


def _twinned(backgrounds: Backgrounds, step: Step) -> tuple[Shell, Step, frozenset[str]]:
    """Return the shell whose picture serves for a step, the step with its marks, and what is there before it."""
    home = home_shell(step)
    index = index_of(backgrounds.gridshell)
    twin = index.twins[home]
    shell = index.shells[twin]
    there = {in_other_shell(mark, home, twin) for mark in backgrounds.before[step.id] if is_in_shell(mark, home)}
    return shell, twin_step(step, home, twin), frozenset(there)


def _segment_pictures(backgrounds: Backgrounds, step: Step, segmentation: Segmentation) -> tuple[str, ...]:
    """Return the pictures of a step with segments of a shell: the shell square on, and its plan where it stands."""
    shell = index_of(backgrounds.gridshell).shells[step.assemblies[0]]
    outline = cut_outline(shell_outline(shell, PAGE_WIDTH, MARGIN), shell, segmentation)
    picture = scene_svg(outline, segment_scene(shell, step, segmentation, backgrounds.stood[step.id]))
    return (picture, *(foot_sections(shell, backgrounds.language) if step.phase == "stand" and step.marks else ()))


def picture_key(backgrounds: Backgrounds, step: Step) -> tuple[object, ...]:
    """Return what the pictures of a step depend on: steps of shells alike have the same, and the same pictures."""
    if not home_shell(step) or step.phase == "divide":
        return (step.id,)
    shell, twin, there = _twinned(backgrounds, step)
    return shell.mark, twin.phase, twin.marks, twin.assemblies, twin.propped, there


def step_pictures(backgrounds: Backgrounds, step: Step) -> tuple[str, ...]:
    """Return the SVG pictures of a step of putting together or of taking down: the large one first."""
    if step.phase in ("ridges", "open ridges") and step.assemblies in backgrounds.outlines.ridges:
        return ridge_pictures(backgrounds, step)
    if backgrounds.segmentation and (step.phase == "divide" or moved_segments(step, backgrounds.segmentation)):
        return _segment_pictures(backgrounds, step, backgrounds.segmentation)
    if not home_shell(step):
        sections = (
            foot_sections(backgrounds.gridshell.shells[0], backgrounds.language)
            if step.phase in ("feet", "clear feet", "stand")
            else ()
        )
        return (site_svg(backgrounds, step), *sections)
    shell, step, there = _twinned(backgrounds, step)
    if is_down(step.phase):
        return down_pictures(backgrounds, shell, step, there, driven_from_outside(shell))
    if step.phase == "cover":
        return (scene_svg(backgrounds.outlines.large[shell.mark], _cover_scene(shell, step, there)),)
    scene = _shell_scene(shell, step, there, backgrounds.slides)
    if step.phase == "prefabricate":
        strips = beam_strips_svg(shell, _made_beams(shell, step), PAGE_WIDTH)
        return strips, scene_svg(backgrounds.outlines.small[shell.mark], scene)
    edges = scene.names if step.phase == "edge planks" else ()
    large = scene_svg(backgrounds.outlines.large[shell.mark], scene, [mark for mark in edges if mark in step.marks])
    if step.phase == "hoist":
        return large, elevation_svg(shell)
    straps = [strap for strap in shell.straps if strap.mark in step.marks]
    return (large, *(strap_section_svg(shell, strap, language=backgrounds.language) for strap in middle_of(straps)))


def phase_svg(backgrounds: Backgrounds, plan: Plan, step: Step) -> str:
    """Return a small picture without words of the first shell as a step leaves it."""
    shell = index_of(backgrounds.gridshell).shells[step.shell]
    scene = _shell_scene(shell, step, backgrounds.before[step.id], backgrounds.slides)
    same = [s for s in plan.steps if s.shell == step.shell and s.phase == step.phase]
    scenes = [_shell_scene(shell, s, frozenset(), backgrounds.slides) for s in same]
    new = {mark for each in scenes for mark in each.new}
    dots = [mark for each in scenes for mark in (*each.dots, *(each.rings if step.phase == "fix geodesics" else ()))]
    there = {plank for plank in scene.there if plank not in new}
    return scene_svg(backgrounds.outlines.small[shell.mark], Scene(there=there, new=new, dots=dots))


def legend_svgs() -> dict[str, str]:
    """Return the swatches of the legend by name."""
    box = np.array([(2.0, 6.0), (88.0, 6.0), (88.0, 34.0), (2.0, 34.0)])
    styles = {"there": THERE, **NEW, **PIECES}
    swatches = {name: svg(90.0, 40.0, [group([path(box)], style)]) for name, style in styles.items()}
    return swatches | {"prop": svg(40.0, 40.0, [prop_items([np.array((20.0, 20.0))])])}
