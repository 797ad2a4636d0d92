"""Which picture belongs to which step, large and small ones."""

import numpy as np

from aag_cad.parts.index import index_of
from aag_cad.parts.marks import in_other_shell, is_in_shell, shell_of
from aag_cad.parts.model import Shell
from assembly.base.phases import PHASE
from assembly.base.segments import Segmentation
from assembly.base.steps import Plan, Step
from assembly.drawing.bench import beam_strips_svg
from assembly.drawing.outline import shell_outline
from assembly.drawing.steel_sections import strap_section_svg
from assembly.drawing.svg import group, path, svg
from assembly.pictures.backgrounds import MARGIN, PAGE_WIDTH, Backgrounds, twin_step
from assembly.pictures.named_marks import middle_of
from assembly.pictures.segment_scenes import cut_outline, moved_segments, segment_scene
from assembly.pictures.shell_scenes import beams_of, shell_scene
from assembly.pictures.site_scenes import elevation_svg, foot_sections, ridge_pictures, site_svg
from assembly.pictures.step_pictures import NEW, PIECES, THERE, Scene, prop_items, scene_svg
from assembly.plan.shape_control import sling_points

_SHOE_SECTIONS = 1


def home_shell(step: Step) -> str:
    """Return the shell that the picture of a step shows alone, or "" where it shows the whole."""
    if PHASE[step.phase].alone:
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
    scene, outlines = shell_scene(shell, step, there, backgrounds.slides), backgrounds.outlines
    if PHASE[step.phase].scene == "made":
        strips = beam_strips_svg(shell, beams_of(shell, step), PAGE_WIDTH)
        return strips, scene_svg(outlines.small[shell.mark], scene)
    edges = [mark for mark in scene.names if mark in step.marks] if PHASE[step.phase].scene == "edges" else []
    large = scene_svg(outlines.large[shell.mark], scene, edges)
    return (large, *_beside(backgrounds, shell, step))


def _beside(backgrounds: Backgrounds, shell: Shell, step: Step) -> tuple[str, ...]:
    """Return the small pictures beside the large one: the shell from its side, sections through steel."""
    match PHASE[step.phase].scene:
        case "hoisted":
            return (elevation_svg(shell),)
        case "hung" | "lowered" as way:
            return (elevation_svg(shell, sling_points(shell), flat=way == "lowered"),)
        case "lifted":
            return foot_sections(shell, backgrounds.language, _SHOE_SECTIONS)
        case _:
            straps = [strap for strap in shell.straps if strap.mark in step.marks]
            cut = middle_of(straps)
            return tuple(strap_section_svg(shell, strap, language=backgrounds.language) for strap in cut)


def phase_svg(backgrounds: Backgrounds, plan: Plan, step: Step) -> str:
    """Return a small picture without words of the first shell as a step leaves it."""
    shell = index_of(backgrounds.gridshell).shells[step.shell]
    scene = shell_scene(shell, step, backgrounds.before[step.id], backgrounds.slides)
    same = [s for s in plan.steps if s.shell == step.shell and s.phase == step.phase]
    scenes = [shell_scene(shell, s, frozenset(), backgrounds.slides) for s in same]
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
