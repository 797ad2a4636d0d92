"""What the picture of a step on one shell shows: what is there, what is new or leaves, what is numbered."""

from collections.abc import Mapping, Sequence, Set

from aag_cad.parts.index import index_of
from aag_cad.parts.marks import joint_of, short_mark
from aag_cad.parts.model import Shell
from assembly.base.part_groups import driven_from_outside
from assembly.base.phases import PHASE, is_down
from assembly.base.steps import Step
from assembly.graph.interlacing import Slide
from assembly.pictures.named_marks import feet_of, numbers_of
from assembly.pictures.step_pictures import Scene
from assembly.plan.shape_control import control_figures, sling_points


def _short(marks: Sequence[str]) -> dict[str, str]:
    return {mark: short_mark(mark) for mark in marks}


def _planks_of(shell: Shell, units: Sequence[str]) -> tuple[str, ...]:
    wanted = set(units)
    return tuple(plank.mark for plank in shell.planks if plank.mark in wanted or plank.beam in wanted)


def _joints(step: Step, fasteners: Set[str]) -> tuple[str, ...]:
    """Return the joints of those of a step's parts that are among some fasteners."""
    return tuple(dict.fromkeys(joint_of(mark) for mark in step.marks if mark in fasteners))


def beams_of(shell: Shell, step: Step) -> tuple[str, ...]:
    """Return the beams that a step makes or unmakes; of its studs, the beams that have no other below."""
    made = tuple(beam.mark for beam in shell.beams if set(beam.planks) <= set(step.marks))
    studs, planks = index_of(shell).studs.keys() & step.marks, index_of(shell).planks
    held = [(beam, planks[beam.planks[0]].layer) for beam in shell.beams if studs & {at.joint for at in beam.joints}]
    lowest = min((layer for _, layer in held), default=0)
    return made or tuple(beam.mark for beam, layer in held if layer == lowest)


def _screws(shell: Shell, step: Step, there: frozenset[str]) -> Scene:
    """Return geodesics that are fixed or released: dots at screws that are driven from outside, rings from inside."""
    members = {member for mark in step.marks for member in index_of(shell).joint_of_fastener[mark].members}
    flat = [mark for mark in index_of(shell).geodesics if mark in members]
    dots = _joints(step, driven_from_outside(shell))
    rings = tuple(joint for joint in _joints(step, index_of(shell).screws.keys()) if joint not in dots)
    done = [] if is_down(step.phase) else [joint_of(screw.mark) for screw in shell.screws if screw.mark in there]
    return Scene(there=there, worked_on=flat, names=_short(flat), dots=dots, rings=rings,
                 numbers=numbers_of((*dots, *rings)), done=done, props=step.propped)  # fmt: skip


def _slid(shell: Shell, step: Step, there: frozenset[str], known: Mapping[str, Slide]) -> Scene:
    """Return the planks that are slid in, with the crossings that they pass."""
    units = (*step.assemblies, *step.marks)
    slides = {unit: known[unit] for unit in units if unit in known}
    passed = tuple(dict.fromkeys(joint for slide in slides.values() for joint in slide.joints))
    return Scene(there=there, new=_planks_of(shell, units), names=_short(units), starts=units, rings=passed,
                 numbers=numbers_of(passed), slides={unit: slide.end for unit, slide in slides.items()})  # fmt: skip


def shell_scene(shell: Shell, step: Step, there: frozenset[str], slides: Mapping[str, Slide]) -> Scene:
    """Return what the picture of a step of putting together or of taking down one shell shows.

    ``there`` are the parts in place before it; ``slides`` say how planks are slid in.
    """
    index, slings = index_of(shell), sling_points(shell)
    flat = tuple(mark for mark in step.marks if mark in index.planks and not index.planks[mark].beam)
    units = (*step.assemblies, *flat)
    hung = dict.fromkeys(slings, "H")
    match PHASE[step.phase].scene:
        case "made":
            beams = beams_of(shell, step)
            return Scene(new=_planks_of(shell, beams), names=_short(beams), starts=beams)
        case "laid":
            studs = [joint for joint in _joints(step, index.bolts.keys()) if joint in index.studs]
            return Scene(there=there, new=_planks_of(shell, units), names=_short(units), starts=units, dots=studs)
        case "slid":
            return _slid(shell, step, there, slides)
        case "studs":
            joints = _joints(step, index.bolts.keys())
            done = tuple(stud.mark for stud in shell.studs if stud.mark in there)
            return Scene(there=there, dots=joints, numbers=numbers_of(joints), done=done)
        case "hoisted":
            control = control_figures(shell).studs
            tags = {mark: name for name, mark in control.items()} | hung
            props = tuple(mark for mark in step.propped if mark not in tags)
            return Scene(there=there, dots=slings, rings=tuple(control.values()), tags=tags, props=props,
                         numbers=_short(props))  # fmt: skip
        case "edges":
            straps, screwed = [mark for mark in index.straps if mark in step.marks], _joints(step, index.screws.keys())
            return Scene(there=there, new=(*flat, *straps), names=_short(flat), rings=screwed,
                         numbers=numbers_of(screwed) | _short(straps), props=step.propped)  # fmt: skip
        case "screws":
            return _screws(shell, step, there)
        case "cover":
            plates = [*(strip.mark for strip in shell.strips), *(mullion.mark for mullion in shell.mullions)]
            blocks = [mark for mark in index.blocks if mark in step.marks]
            return Scene(there=there, new=step.marks, names=_short(plates), rings=_joints(step, index.screws.keys()),
                         numbers=_short(blocks))  # fmt: skip
        case "propped":
            edges = list(index.edges)
            return Scene(there=there, worked_on=edges, names=_short(edges), props=step.propped,
                         numbers=_short(step.propped))  # fmt: skip
        case "lifted":
            feet = feet_of(shell)
            return Scene(there=there, rings=feet, dots=slings, numbers=numbers_of(feet), tags=hung)
        case "hung":
            return Scene(there=there, dots=slings, tags=hung, props=step.propped)
        case "lowered":
            return Scene(there=there, dots=list(index.studs), tags=hung)
        case "measured":
            every = tuple(index.units)
            return Scene(new=list(index.planks), names=_short(every), starts=every)
        case "whole" | "site":
            new = tuple(mark for mark in index.straps if mark in there)
            dots = [mark for mark in index.studs if mark not in step.propped]
            rings = [mark for mark in index.blocks if mark in there]
            return Scene(there=there, new=new, dots=dots, rings=rings, props=step.propped)
