"""BTLx: every straight blank with its end cuts, holes and mark for the joinery machine, by compas_timber."""

import importlib
import os
import uuid
from collections.abc import Iterator
from typing import Any
from xml.etree import ElementTree

from aag_cad import __version__
from aag_cad.errors import FileError
from aag_cad.files import write_bytes
from aag_cad.parts.forms import Hole
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import family_mark, shell_of
from aag_cad.parts.model import Gridshell, Plank
from aag_cad.parts.quantities import mass
from aag_cad.shop.passports import clear_stretches

# Reference side 3 is the face z > 0 of the blank: its x runs along the blank, its y across, from -width / 2.
_FACE = 2
_TEXT_HEIGHT = 15.0
_WIDTH_OF_A_LETTER = 0.8
_RACK_GAP = 500.0
_NAMESPACE = uuid.uuid5(uuid.NAMESPACE_DNS, "aag-toolkit")
_ADVICE = "Straight blanks, drilled from reference side 3. Print the marks, do not mill them: the planks will be bent."
_NOT_OURS_TO_TELL = ("ComputerName", "UserName", "Date", "Time")


def write_btlx(gridshell: Gridshell, path: str | os.PathLike[str]) -> None:
    """Write all planks as BTLx parts, mm; equal gridshells give equal bytes.

    A hole is a drilling through the thickness, a slot a through mortise with round ends: BTLx's own slot is cut by a
    saw or chain and has square ones. Each plank has its mark as text in the first place clear of holes, is named by
    it, and has the GUID that it has in the IFC file. Blanks lie side by side, a column for each shell. FileError if
    compas_timber is not installed, an end is not square, or the file cannot be written.
    """
    try:
        importlib.import_module("compas_timber")
    except ImportError as error:
        raise FileError(
            f"{path}: BTLx files need compas_timber, which is not installed; run: pip install 'aag-toolkit[btlx]'"
        ) from error
    write_bytes(path, _finished(_written(gridshell), gridshell))


def _written(gridshell: Gridshell) -> ElementTree.Element:
    """Return the file as compas_timber makes it: with its own names, random GUIDs and the time of day."""
    from compas.geometry import Frame
    from compas.tolerance import Tolerance
    from compas_timber.elements import Beam
    from compas_timber.fabrication import BTLxWriter
    from compas_timber.model import TimberModel

    model = TimberModel(tolerance=Tolerance(unit="MM"))
    longest = max((plank.blank.length for plank in index_of(gridshell).planks.values()), default=0.0)
    for column, shell in enumerate(gridshell.shells):
        for row, plank in enumerate(sorted(shell.planks, key=lambda plank: plank.mark)):
            blank = plank.blank
            place = [column * (longest + _RACK_GAP), -1.5 * row * blank.section.width, 0.0]
            frame = Frame(place, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
            element = Beam(frame, blank.length, blank.section.width, blank.section.thickness)
            element.name = plank.mark
            for processing in _processings(plank):
                element.add_feature(processing)
            model.add_element(element)
    writer = BTLxWriter(gridshell.title, "AAG toolkit", f"{gridshell.name}.btlx", f"AAG toolkit {__version__}")
    # What its ``model_to_xml`` does but for printing by way of a second tree, which takes longer than all else.
    writer._tolerance = model.tolerance
    root = ElementTree.Element("BTLx", writer.FILE_ATTRIBUTES)
    root.extend([writer._create_file_history(), writer._create_project_element(model)])
    if writer.errors:
        raise FileError(
            f"{gridshell.name}.btlx: compas_timber refuses {writer.errors[0]}; check the holes of the plank"
        )
    return root


def _processings(plank: Plank) -> Iterator[Any]:
    """Yield the two end cuts of a plank, its holes from the start, and its mark; numbered like the table of holes."""
    from compas_timber.fabrication import AlignmentType, JackRafterCut, OrientationType, Text

    blank = plank.blank
    for cut in (blank.start_cut, blank.end_cut):
        if cut.angle_deg != 90.0:
            raise FileError(
                f"{plank.mark}: an end is cut at {cut.angle_deg:g} degrees; BTLx is written for square ends only (90)"
            )
    yield JackRafterCut(OrientationType.START, 0.0, ref_side_index=_FACE)
    yield JackRafterCut(OrientationType.END, blank.length, ref_side_index=_FACE)
    for number, hole in enumerate(blank.holes, start=1):
        yield _bored(plank, hole, number)
    yield Text(
        plank.mark,
        _place_of_mark(plank),
        blank.section.width / 2.0,
        alignment_vertical=AlignmentType.CENTER,
        alignment_horizontal=AlignmentType.CENTER,
        text_height_auto=False,
        text_height=_TEXT_HEIGHT,
        ref_side_index=_FACE,
    )


def _bored(plank: Plank, hole: Hole, number: int) -> Any:
    """Return the processing of a hole through the thickness of a plank."""
    from compas_timber.fabrication import Drilling, Mortise, TenonShapeType

    section = plank.blank.section
    across = section.width / 2.0 + hole.offset
    if hole.slot == 0.0:
        return Drilling(
            hole.station,
            across,
            depth_limited=False,
            depth=section.thickness,
            diameter=hole.diameter,
            ref_side_index=_FACE,
            process_id=number,
        )
    # A mortise is measured from the middle of its first end, along the reference side.
    length = hole.diameter + hole.slot
    return Mortise(
        hole.station - length / 2.0,
        across,
        length=length,
        width=hole.diameter,
        depth=section.thickness,
        shape=TenonShapeType.ROUND,
        shape_radius=hole.diameter / 2.0,
        ref_side_index=_FACE,
        process_id=number,
    )


def _place_of_mark(plank: Plank) -> float:
    """Return the middle of the first stretch without holes that the mark fits in, or of the longest."""
    needed = _WIDTH_OF_A_LETTER * _TEXT_HEIGHT * len(plank.mark)
    stretches = clear_stretches(plank.blank)
    roomy = [stretch for stretch in stretches if stretch.length >= needed]
    stretch = min(roomy, key=lambda stretch: stretch.start) if roomy else stretches[0]
    return (stretch.start + stretch.end) / 2.0


def _finished(root: ElementTree.Element, gridshell: Gridshell) -> bytes:
    """Return the file with our names and numbers on its parts, and nothing in it that changes from run to run."""
    project_id = uuid.uuid5(_NAMESPACE, gridshell.name)
    planks = index_of(gridshell).planks
    for program in root.iter("InitialExportProgram"):
        for name in _NOT_OURS_TO_TELL:
            del program.attrib[name]
    for project in root.iter("Project"):
        project.attrib |= {"GUID": f"{{{project_id}}}", "Comment": _ADVICE}
    for number, part in enumerate(root.iter("Part"), start=1):
        plank = planks[part.attrib["Annotation"]]
        part.attrib |= _part_attributes(plank, number, gridshell)
        for transformation in part.iter("Transformation"):
            transformation.set("GUID", f"{{{uuid.uuid5(project_id, plank.mark)}}}")
    ElementTree.indent(root, "   ")
    text: bytes = ElementTree.tostring(root, "utf-8", xml_declaration=True)
    return text + b"\n"


def _part_attributes(plank: Plank, number: int, gridshell: Gridshell) -> dict[str, str]:
    """Return how a part is named, numbered and grouped: by shell and family, and with its sibling in a beam."""
    return {
        "SingleMemberNumber": str(number),
        "OrderNumber": str(number),
        "AssemblyNumber": plank.beam or plank.mark,
        "ElementNumber": plank.beam or plank.mark,
        "Designation": plank.mark,
        "Group": shell_of(plank.mark),
        "Package": family_mark(plank.mark),
        "Layer": str(plank.layer),
        "Material": gridshell.timber.species,
        "TimberGrade": gridshell.timber.strength_class,
        "Weight": f"{mass(plank, gridshell.timber):.3f}",
    }
