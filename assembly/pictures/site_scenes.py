"""Pictures of the whole gridshell on its site, of its ridges, and of a shell from its side."""

from collections.abc import Iterator, Sequence

import numpy as np

from aag_cad.language import Language
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import parts_at
from aag_cad.parts.marks import shell_of
from aag_cad.parts.model import Gridshell, Shell, shell_parts
from assembly.base.steps import Step
from assembly.drawing.outline import Outline, elevation_outline, vault_outline
from assembly.drawing.steel_sections import blade_section_svg, foot_section_svg
from assembly.drawing.svg import Label, Style, circle, group, label_svg, line, path, svg, text
from assembly.pictures.backgrounds import MARGIN, SMALL_WIDTH, Backgrounds, ridge_planks
from assembly.pictures.named_marks import feet_of, middle_of, numbers_of
from assembly.pictures.step_pictures import Scene, scene_items
from assembly.plan.shape_control import control_figures

_KEY_WIDTH = 170.0
_NAME_SIZE = 48.0
_INK = Style("#000")


def _site_scene(gridshell: Gridshell, step: Step, there: frozenset[str]) -> Scene:
    """Return what the plan of the whole shows in a step on site; ``there`` are the planks that stand before it."""
    planks = {shell.mark: [plank.mark for plank in shell.planks] for shell in gridshell.shells}
    feet = {shell.mark: feet_of(shell) for shell in gridshell.shells}
    grounded = {part.mark for shell in gridshell.shells for part in parts_at(shell_parts(shell), "ground")}
    moved = [mark for mark in step.assemblies if mark in planks]
    match step.phase:
        case "feet" | "clear feet":
            blocks = tuple(footing.mark for shell in gridshell.shells for footing in shell.footings)
            return Scene(new=grounded, numbers=numbers_of(blocks))
        case "stand":
            dots = tuple(foot for mark in moved for foot in feet[mark])
            worked_on = [plank for mark in moved for plank in planks[mark]]
            return Scene(there=there | grounded, worked_on=worked_on, dots=dots, numbers=numbers_of(dots),
                         props=step.propped)  # fmt: skip
        case "ridges" | "open ridges":
            facing = ridge_planks(gridshell, step.assemblies)
            return Scene(there=there | grounded, worked_on=facing, new=step.marks, props=step.propped)
        case _:
            return Scene(there={mark for listed in planks.values() for mark in listed} | grounded)


def site_svg(backgrounds: Backgrounds, step: Step) -> str:
    """Return the plan of the whole with the name of each shell; with the axes where the feet are set out."""
    sheet = backgrounds.outlines.plan
    names = []
    for shell in backgrounds.gridshell.shells:
        place = np.mean([sheet.lines[plank.mark].mean(axis=0) for plank in shell.planks], axis=0)
        names.append(Label(shell.mark, float(place[0]), float(place[1]), _NAME_SIZE))
    items = [
        *scene_items(sheet, _site_scene(backgrounds.gridshell, step, backgrounds.standing[step.id])),
        label_svg(names),
    ]
    if step.phase in ("feet", "clear feet"):
        x, y = sheet.origin.tolist()
        arms = (np.array([(x, y), (x + 90.0, y)]), np.array([(x, y), (x, y - 90.0)]))
        items.append(group((path(arm, closed=False) for arm in arms), Style("none", "#000", 4.0)))
        items.append(group([text("x", x + 105.0, y, 30.0), text("y", x, y - 108.0, 30.0), circle((x, y), 8.0)], _INK))
    return svg(sheet.width, sheet.height, items)


def foot_sections(shell: Shell, language: Language, count: int = 2) -> tuple[str, ...]:
    """Return sections through the first feet of a shell: their shoes lie on either side of the planks."""
    shoes = shell.shoes[:count]
    return tuple(foot_section_svg(shell, shoe, named=shoe is shoes[-1], language=language) for shoe in shoes)


def ridge_pictures(backgrounds: Backgrounds, step: Step) -> tuple[str, ...]:
    """Return a ridge from above with the blades of a step, a section through a blade, and where the ridge is."""
    gridshell = backgrounds.gridshell
    outline, planks = backgrounds.outlines.ridges[step.assemblies], ridge_planks(gridshell, step.assemblies)
    blades = [blade for blade in gridshell.blades if blade.mark in step.marks]
    scene = Scene(
        there=index_of(gridshell).planks.keys(),
        worked_on=planks,
        new=[blade.mark for blade in blades],
        names={mark: mark for mark in planks},
        numbers={blade.mark: blade.mark for blade in blades},
    )
    picture = svg(outline.width, outline.height, scene_items(outline, scene))
    cut = (blade_section_svg(gridshell, blade, language=backgrounds.language) for blade in middle_of(blades))
    return (picture, *cut, site_svg(backgrounds, step))


def _flat_line(shell: Shell, outline: Outline) -> tuple[np.ndarray, float]:
    """Return the shell's length flat on the floor as a line (2, 2), and the height of the floor on the sheet."""
    points = np.concatenate(list(outline.planks.values()))
    floor, foot = float(points[:, 1].max()), float(points[:, 0].min())
    longest = max((plank.blank.length for plank in shell.planks if not plank.beam), default=0.0)
    return np.array([(foot, floor - 6.0), (foot + longest * outline.scale, floor - 6.0)]), floor


def elevation_svg(shell: Shell, slings: Sequence[str] = (), flat: bool = True) -> str:
    """Return the shell from its side in its shape, with control points or ``slings``; dashed as it lies ``flat``."""
    outline, control = elevation_outline(shell, SMALL_WIDTH, MARGIN), control_figures(shell).studs
    laid, floor = _flat_line(shell, outline)
    # Two slings that are seen at one place get one label.
    seen = {tuple(np.round(outline.points[mark] / 40.0).tolist()): mark for mark in slings}
    tags = dict.fromkeys(seen.values(), "H") or {mark: name for name, mark in control.items()}
    scene = Scene(there=tuple(outline.planks), rings=tuple(tags), tags=tags)
    reach = max(outline.width, float(laid[1, 0]) + 10.0) if flat else outline.width

    def items() -> Iterator[str]:
        yield from scene_items(outline, scene)
        yield line(np.array([(0.0, floor + 3.0), (reach, floor + 3.0)]), Style("none", "#000", 3.0))
        if flat:
            yield line(laid, Style("none", "#000", 6.0, "16 10"))

    return svg(reach, outline.height, items())


def key_svg(gridshell: Gridshell, shell: str) -> str:
    """Return a tiny plan of the whole with one shell black."""
    outline = vault_outline(gridshell, _KEY_WIDTH, 4.0)
    planks = index_of(gridshell).planks
    drawn = {mark: outline.lines[mark] for mark in outline.planks if not planks[mark].beam}
    pale = (path(points, closed=False) for mark, points in drawn.items() if shell_of(mark) != shell)
    black = (path(points, closed=False) for mark, points in drawn.items() if shell_of(mark) == shell)
    items = [group(pale, Style("none", "#b5b5b5", 2.0)), group(black, Style("none", "#000", 4.0))]
    return svg(outline.width, outline.height, items)
