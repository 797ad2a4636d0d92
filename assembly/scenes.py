"""Which picture belongs to which step: what is there before it, what is new, what is numbered."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from aag_cad.parts.marks import parse_mark, shell_of
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import (
    ClampingBar,
    Footing,
    Gridshell,
    Mullion,
    Rod,
    Shell,
    Shoe,
    Strap,
    Strip,
    shell_parts,
)
from aag_cad.units import Floats
from assembly.control import control_figures, sling_points
from assembly.details import beam_strips_svg
from assembly.drawing import Label, Style, circle, group, label_svg, line, path, svg, text
from assembly.graph import joint_of
from assembly.kit import shell_kit
from assembly.outline import Outline, elevation_outline, ridge_outline, shell_outline, vault_outline
from assembly.pictures import NEW, PIECES, STEEL, THERE, Scene, scene_items, scene_svg
from assembly.ranges import short_mark
from assembly.steel import blade_section_svg, foot_section_svg, strap_section_svg
from assembly.steps import Plan, Step

_T = TypeVar("_T")

PAGE_WIDTH = 1800.0
SMALL_WIDTH = 880.0
_MARGIN = 50.0
_KEY_WIDTH = 170.0
_NAME_SIZE = 48.0
_ON_SHELLS = (Strap, Mullion, Strip, ClampingBar)
_ON_GROUND = (Footing, Rod, Shoe)
INK = Style("#000")


@dataclass(frozen=True, eq=False)
class Sheets:
    """The outlines that the pictures of a gridshell are drawn from, and what was placed before each step."""

    gridshell: Gridshell
    large: dict[str, Outline]
    small: dict[str, Outline]
    plan: Outline
    ridges: dict[tuple[str, ...], Outline]
    before: dict[str, frozenset[str]]


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


def sheets_of(plan: Plan, gridshell: Gridshell) -> Sheets:
    """Return all outlines, drawn once for all steps."""
    return Sheets(
        gridshell=gridshell,
        large={shell.mark: shell_outline(shell, PAGE_WIDTH, _MARGIN, _ON_SHELLS) for shell in gridshell.shells},
        small={shell.mark: shell_outline(shell, SMALL_WIDTH, _MARGIN) for shell in gridshell.shells},
        plan=vault_outline(gridshell, PAGE_WIDTH * 0.8, _MARGIN, _ON_GROUND),
        ridges={
            step.assemblies: ridge_outline(gridshell, pair, PAGE_WIDTH, _MARGIN)
            for step in plan.steps
            if step.phase == "ridges" and (pair := _ridge_planks(gridshell, step.assemblies))
        },
        before=_in_place(plan, gridshell),
    )


def _short(marks: Sequence[str]) -> dict[str, str]:
    return {mark: short_mark(mark) for mark in marks}


def _numbers(marks: Sequence[str]) -> dict[str, str]:
    return {mark: mark.rpartition("-")[2] for mark in marks}


def _planks_of(shell: Shell, units: Sequence[str]) -> tuple[str, ...]:
    wanted = set(units)
    return tuple(plank.mark for plank in shell.planks if plank.mark in wanted or plank.beam in wanted)


def _made_beams(shell: Shell, step: Step) -> tuple[str, ...]:
    return tuple(beam.mark for beam in shell.beams if set(beam.planks) <= set(step.marks))


def _joints_of(step: Step, letters: str = "BW") -> tuple[str, ...]:
    """Return the joints that a step's bolts (B) and screws (W) belong to."""
    fasteners = (mark for mark in step.marks if parse_mark(mark).part[:1] in tuple(letters))
    return tuple(dict.fromkeys(joint_of(mark) for mark in fasteners))


def _shell_scene(shell: Shell, step: Step, there: frozenset[str]) -> Scene:
    """Return what the picture of a step of one shell shows."""
    joints, numbers = _joints_of(step), _numbers(_joints_of(step))
    single = [plank.mark for plank in shell.planks if not plank.beam]
    flat = tuple(mark for mark in step.marks if mark in single)
    units = (*step.assemblies, *flat)
    match step.phase:
        case "prefabricate":
            beams = _made_beams(shell, step)
            return Scene(new=_planks_of(shell, beams), names=_short(beams), starts=beams)
        case "lay A1" | "lay G" | "lay A2":
            return Scene(there=there, new=_planks_of(shell, units), names=_short(units), starts=units)
        case "studs":
            done = tuple(stud.mark for stud in shell.studs if stud.mark in there)
            return Scene(there=there, dots=joints, numbers=numbers, done=done)
        case "hoist":
            control, slings = control_figures(shell).studs, sling_points(shell)
            tags = {mark: name for name, mark in control.items()} | dict.fromkeys(slings, "H")
            return Scene(there=there, dots=slings, rings=tuple(control.values()), tags=tags)
        case "edge planks":
            straps = tuple(strap.mark for strap in shell.straps if strap.mark in step.marks)
            screwed = _joints_of(step, "W")
            told = _numbers(screwed) | _short(straps)
            return Scene(there=there, new=(*flat, *straps), names=_short(flat), rings=screwed, numbers=told)
        case "fix geodesics":
            fixed = _fixed(shell, step, single)
            done = tuple(joint_of(screw.mark) for screw in shell.screws if screw.mark in there)
            return Scene(there=there, worked_on=fixed, names=_short(fixed), dots=joints, numbers=numbers, done=done)
        case _:
            studs = [stud.mark for stud in shell.studs]
            blocks = [block.mark for block in shell.blocks if block.mark in there]
            straps = tuple(strap.mark for strap in shell.straps if strap.mark in there)
            return Scene(there=there, new=straps, dots=studs, rings=blocks)


def _fixed(shell: Shell, step: Step, single: Sequence[str]) -> tuple[str, ...]:
    """Return the flat planks that the screws of a step fix."""
    members = {mark: joint.members for joint in shell.joints for mark in joint.fasteners}
    held = {member for mark in step.marks for member in members[mark]}
    return tuple(mark for mark in single if mark in held)


def _cover_scene(shell: Shell, step: Step, there: frozenset[str]) -> Scene:
    """Return what the picture of the covering of one shell shows: strips with their marks, bars, places of screws."""
    strips, mullions = [strip.mark for strip in shell.strips], [mullion.mark for mullion in shell.mullions]
    return Scene(there=there, new=step.marks, names=_short([*strips, *mullions]), rings=_joints_of(step, "W"))


def _elevation_svg(shell: Shell) -> str:
    """Return the shell from its side: as it lies flat on the floor (dashed) and in its shape."""
    outline, control = elevation_outline(shell, SMALL_WIDTH, _MARGIN), control_figures(shell).studs
    points = np.concatenate(list(outline.planks.values()))
    floor, foot = float(points[:, 1].max()), float(points[:, 0].min())
    longest = max((plank.blank.length for plank in shell.planks if not plank.beam), default=0.0)
    flat = np.array([(foot, floor - 6.0), (foot + longest * outline.scale, floor - 6.0)])
    scene = Scene(there=tuple(outline.planks), rings=tuple(control.values()), tags={m: n for n, m in control.items()})
    reach = max(outline.width, float(flat[1, 0]) + 10.0)
    items = [
        *scene_items(outline, scene),
        line(np.array([(0.0, floor + 3.0), (reach, floor + 3.0)]), Style("none", "#000", 3.0)),
        line(flat, Style("none", "#000", 6.0, "16 10")),
    ]
    return svg(reach, outline.height, items)


def _ridge_planks(gridshell: Gridshell, pair: Sequence[str]) -> tuple[str, ...]:
    """Return the edge planks of two shells that face each other."""
    shells = {shell.mark: shell for shell in gridshell.shells}

    def middles(mark: str) -> dict[str, Floats]:
        matrix = frame_matrix(shells[mark].placement)
        edges = [plank for plank in shells[mark].planks if plank.family == "E"]
        points = {plank.mark: plank.curve.point_spline(plank.curve.length / 2.0) for plank in edges}
        return {edge: matrix[:3, :3] @ point + matrix[:3, 3] for edge, point in points.items()}

    ours, theirs = middles(pair[0]), middles(pair[1])
    gaps = {(a, b): float(np.linalg.norm(ours[a] - theirs[b])) for a in sorted(ours) for b in sorted(theirs)}
    return min((gap, ends) for ends, gap in gaps.items())[1] if gaps else ()


def _site_scene(gridshell: Gridshell, step: Step, stood: Sequence[str]) -> Scene:
    """Return what the plan of the whole shows in a step on site; ``stood`` are the shells that stand already."""
    planks = {shell.mark: [plank.mark for plank in shell.planks] for shell in gridshell.shells}
    feet = {
        shell.mark: tuple(joint.mark for joint in shell.joints if joint.kind == "foot") for shell in gridshell.shells
    }
    grounded = {part.mark for shell in gridshell.shells for part in shell_parts(shell) if isinstance(part, _ON_GROUND)}
    match step.phase:
        case "feet":
            blocks = tuple(footing.mark for shell in gridshell.shells for footing in shell.footings)
            return Scene(new=grounded, numbers=_numbers(blocks))
        case "stand":
            shell = step.assemblies[0]
            there = {mark for other in stood for mark in planks[other]} | grounded
            return Scene(there=there, worked_on=planks[shell], dots=feet[shell], numbers=_numbers(feet[shell]))
        case _:
            return Scene(there={mark for listed in planks.values() for mark in listed} | grounded)


def _ridge_svg(sheets: Sheets, step: Step) -> str:
    """Return a ridge from above, all shells there, with the blades of a step."""
    outline, planks = sheets.ridges[step.assemblies], _ridge_planks(sheets.gridshell, step.assemblies)
    blades = [blade.mark for blade in sheets.gridshell.blades if blade.mark in step.marks]
    scene = Scene(
        there={plank.mark for shell in sheets.gridshell.shells for plank in shell.planks},
        worked_on=planks,
        new=blades,
        names={mark: mark for mark in planks},
        numbers={mark: mark for mark in blades},
    )
    return svg(outline.width, outline.height, scene_items(outline, scene))


def _site_svg(sheets: Sheets, step: Step, stood: Sequence[str]) -> str:
    """Return the plan of the whole with the name of each shell, the centre and the axes of the setting-out."""
    sheet = sheets.plan
    names = []
    for shell in sheets.gridshell.shells:
        place = np.mean([sheet.lines[plank.mark].mean(axis=0) for plank in shell.planks], axis=0)
        names.append(Label(shell.mark, float(place[0]), float(place[1]), _NAME_SIZE))
    items = [*scene_items(sheet, _site_scene(sheets.gridshell, step, stood)), label_svg(names)]
    if step.phase == "feet":
        x, y = sheet.origin.tolist()
        arms = (np.array([(x, y), (x + 90.0, y)]), np.array([(x, y), (x, y - 90.0)]))
        items.append(group((path(arm, closed=False) for arm in arms), Style("none", "#000", 4.0)))
        items.append(group([text("x", x + 105.0, y, 30.0), text("y", x, y - 108.0, 30.0), circle((x, y), 8.0)], INK))
    return svg(sheet.width, sheet.height, items)


def _middle(pieces: Sequence[_T]) -> Sequence[_T]:
    """Return the middle one of pieces as a list, an empty list without any."""
    return pieces[len(pieces) // 2 : len(pieces) // 2 + 1]


def _foot_sections(gridshell: Gridshell, step: Step) -> tuple[str, ...]:
    """Return sections through the first two feet of a shell: their shoes lie on either side of the planks."""
    if step.phase not in ("feet", "stand"):
        return ()
    shell = next((shell for shell in gridshell.shells if shell.mark in step.assemblies), gridshell.shells[0])
    shoes = shell.shoes[:2]
    return tuple(foot_section_svg(shell, shoe, named=shoe is shoes[-1]) for shoe in shoes)


def step_pictures(sheets: Sheets, step: Step, stood: Sequence[str] = ()) -> tuple[str, ...]:
    """Return the SVG pictures of a step: the large one first; ``stood`` are the shells that stand on site already."""
    if step.phase == "cover":
        covered = next(shell for shell in sheets.gridshell.shells if shell.mark == shell_of(step.marks[0]))
        return (scene_svg(sheets.large[covered.mark], _cover_scene(covered, step, sheets.before[step.id])),)
    if step.phase == "ridges" and step.assemblies in sheets.ridges:
        blades = [blade for blade in sheets.gridshell.blades if blade.mark in step.marks]
        return (_ridge_svg(sheets, step), *(blade_section_svg(sheets.gridshell, b) for b in _middle(blades)))
    if not step.shell:
        return (_site_svg(sheets, step, stood), *_foot_sections(sheets.gridshell, step))
    shell = next(shell for shell in sheets.gridshell.shells if shell.mark == step.shell)
    scene = _shell_scene(shell, step, sheets.before[step.id])
    if step.phase == "prefabricate":
        strips = beam_strips_svg(shell, _made_beams(shell, step), PAGE_WIDTH)
        return strips, scene_svg(sheets.small[shell.mark], scene)
    if step.phase == "hoist":
        return scene_svg(sheets.large[shell.mark], scene), _elevation_svg(shell)
    straps = [strap for strap in shell.straps if strap.mark in step.marks]
    return (scene_svg(sheets.large[shell.mark], scene), *(strap_section_svg(shell, s) for s in _middle(straps)))


def phase_svg(sheets: Sheets, plan: Plan, step: Step) -> str:
    """Return a small picture without words of the first shell as a step leaves it."""
    shell = next(shell for shell in sheets.gridshell.shells if shell.mark == step.shell)
    scene = _shell_scene(shell, step, sheets.before[step.id])
    same = {s.id for s in plan.steps if s.shell == step.shell and s.phase == step.phase}
    new = {m for s in plan.steps if s.id in same for m in _shell_scene(shell, s, frozenset()).new}
    dots = [m for s in plan.steps if s.id in same for m in _shell_scene(shell, s, frozenset()).dots]
    there = {plank for plank in scene.there if plank not in new}
    return scene_svg(sheets.small[shell.mark], Scene(there=there, new=new, dots=dots))


def key_svg(gridshell: Gridshell, shell: str) -> str:
    """Return a tiny plan of the whole with one shell black."""
    outline = vault_outline(gridshell, _KEY_WIDTH, 4.0)
    marked = {plank.mark for s in gridshell.shells if s.mark == shell for plank in s.planks}
    flat = {plank.mark for s in gridshell.shells for plank in s.planks if not plank.beam}
    drawn = {mark: outline.lines[mark] for mark in outline.planks if mark in flat}
    pale = (path(points, closed=False) for mark, points in drawn.items() if mark not in marked)
    black = (path(points, closed=False) for mark, points in drawn.items() if mark in marked)
    items = [group(pale, Style("none", "#b5b5b5", 2.0)), group(black, Style("none", "#000", 4.0))]
    return svg(outline.width, outline.height, items)


def legend_svgs() -> dict[str, str]:
    """Return the swatches of the legend by name."""
    box = np.array([(2.0, 6.0), (88.0, 6.0), (88.0, 34.0), (2.0, 34.0)])
    styles = {"there": THERE, "steel": STEEL, **NEW, **PIECES}
    return {name: svg(90.0, 40.0, [group([path(box)], style)]) for name, style in styles.items()}
