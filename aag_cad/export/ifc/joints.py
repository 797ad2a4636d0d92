"""Joints in IFC: which elements meet, and the fasteners, studs and blocks that realise it."""

from collections.abc import Iterable, Mapping

from aag_cad.errors import NetworkError
from aag_cad.export.ifc.frame import Entity, IfcModel, rooted
from aag_cad.parts.kinds import kind_of
from aag_cad.parts.model import Joint, Part


def joint_sides(joint: Joint, parts: Mapping[str, Part]) -> tuple[list[str], list[str]]:
    """Return the marks of what meets at a joint (at least two) and of what realises it, in the order of the joint.

    Siblings meet others as their coupled beam, and only each other where nothing else meets; studs, blocks and steel
    plates realise the joint. NetworkError if fewer than two members meet.
    """
    through = [mark for mark in joint.members if kind_of(parts[mark]).role == "member"]
    as_beams = [getattr(parts[mark], "beam", "") or mark for mark in through]
    for sides in (list(dict.fromkeys(as_beams)), through, list(joint.members)):
        if len(sides) >= 2:
            return sides, [mark for mark in (*joint.members, *joint.fasteners) if mark not in through + sides]
    raise NetworkError(f"{joint.mark}: a joint with {len(joint.members)} members; it takes at least two")


def write_joints(
    model: IfcModel, joints: Iterable[Joint], parts: Mapping[str, Part], elements: Mapping[str, Entity]
) -> None:
    """Write every joint between its first side and each other side; ``elements`` holds parts and assemblies by mark.

    The connection point is given in the coordinates of the first side, which are those of its shell.
    """
    for joint in joints:
        sides, realising = joint_sides(joint, parts)
        point = model.new("IfcCartesianPoint", [round(value, 3) + 0.0 for value in joint.point])
        place = model.new("IfcConnectionPointGeometry", point)
        for other in sides[1:]:
            names = ("joint", joint.mark, other)
            common = (joint.mark, None, place, elements[sides[0]], elements[other])
            if realising:
                fixings = [elements[mark] for mark in realising]
                rooted(model, "IfcRelConnectsWithRealizingElements", names, *common, fixings, joint.kind)
            else:
                rooted(model, "IfcRelConnectsElements", names, *common)
