"""The BTLx file, read back by compas_timber and by a plain XML parser, against the blanks that it was written from."""

import re
import sys
import uuid
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from compas_timber.btlx import BTLxReader

from aag_cad.errors import FileError
from aag_cad.export.ifc.frame import project_id
from aag_cad.export.workshop.btlx import write_btlx
from aag_cad.parts.forming import formed_points
from aag_cad.parts.forms import EndCut, Frame
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Bolt, Gridshell, Plank, Screw
from aag_cad.parts.quantities import mass
from aag_cad.units import Floats

BTLX = {"": "https://www.design2machine.com"}
# What the schema of BTLx 2.0.0 demands: the order of the parameters of a processing.
PARAMETERS = {
    "JackRafterCut": "Orientation StartX StartY StartDepth Angle Inclination",
    "Drilling": "StartX StartY Angle Inclination DepthLimited Depth Diameter",
    "Text": "StartX StartY Angle AlignmentVertical AlignmentHorizontal AlignmentMultiline StackedMarking "
    "TextHeightAuto TextHeight Text",
}
PART_ATTRIBUTES = (
    "Count Length Width Height SingleMemberNumber AssemblyNumber OrderNumber Designation Annotation Storey StoreyType "
    "Group Package Material TimberGrade QualityGrade PlaningLength StartOffset EndOffset Weight ProcessingQuality "
    "Recess ElementNumber Layer ModuleNumber Comment"
)
Holes = list[tuple[float, float, float]]


@pytest.fixture(scope="module")
def path(gridshell: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("btlx") / "vault.btlx"
    write_btlx(gridshell, path)
    return path


@pytest.fixture(scope="module")
def planks(gridshell: Gridshell) -> dict[str, Plank]:
    return {plank.mark: plank for shell in gridshell.shells for plank in shell.planks}


def parts_in(path: Path) -> dict[str, ElementTree.Element]:
    found = ElementTree.parse(path).getroot().findall("Project/Parts/Part", BTLX)
    parts = {part.attrib["Designation"]: part for part in found}
    assert len(parts) == len(found)
    return parts


@pytest.fixture(scope="module")
def parts(path: Path) -> dict[str, ElementTree.Element]:
    return parts_in(path)


def value(element: ElementTree.Element, name: str) -> float:
    text = element.findtext(name, namespaces=BTLX)
    assert text is not None
    return float(text)


def corner_and_axes(part: ElementTree.Element) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the reference corner of a part and the directions of its length, height and width, each (3,)."""
    position = part.find("Transformations/Transformation/Position", BTLX)
    assert position is not None
    corner, along, high = (
        np.array([float(axis.attrib[name]) for name in "XYZ"])
        for tag in ("ReferencePoint", "XVector", "YVector")
        for axis in position.findall(tag, BTLX)
    )
    return corner, along, high, np.cross(along, high)


def holes_of(part: ElementTree.Element) -> Holes:
    """Return (station, offset, diameter) of the drillings of a part by the format's own rules, sorted.

    A drilling starts at (StartX, StartY) of its reference side; side 3 lies at the far end of height and width and its
    y runs back along the width. Stations and offsets are from the middle of the start end.
    """
    corner, along, high, wide = corner_and_axes(part)
    width, height = float(part.attrib["Width"]), float(part.attrib["Height"])
    middle = corner + height / 2.0 * high + width / 2.0 * wide
    found = []
    for drilling in part.findall("Processings/Drilling", BTLX):
        assert drilling.attrib["ReferencePlaneID"] == "3"
        assert drilling.findtext("DepthLimited", namespaces=BTLX) == "no"
        assert (value(drilling, "Angle"), value(drilling, "Inclination")) == (0.0, 90.0)
        origin = corner + height * high + width * wide
        start = origin + value(drilling, "StartX") * along - value(drilling, "StartY") * wide - middle
        # A blank lies with its length along x, its width along y and its thickness along z.
        assert start[2] == pytest.approx(height / 2.0)
        found.append((float(start[0]), float(start[1]), value(drilling, "Diameter")))
    return found


def test_the_file_declares_the_schema_that_it_follows(path: Path) -> None:
    root = ElementTree.parse(path).getroot()
    assert root.tag == "{https://www.design2machine.com}BTLx"
    assert root.attrib["Version"] == "2.0.0"
    where = root.attrib["{http://www.w3.org/2001/XMLSchema-instance}schemaLocation"]
    assert where == "https://www.design2machine.com https://www.design2machine.com/btlx/btlx_2_0_0.xsd"
    assert [child.tag.partition("}")[2] for child in root] == ["FileHistory", "Project"]


def test_parts_and_processings_keep_to_the_schema(parts: dict[str, ElementTree.Element]) -> None:
    for part in parts.values():
        assert set(part.attrib) <= set(PART_ATTRIBUTES.split())
        assert all(int(part.attrib[name]) > 0 for name in ("SingleMemberNumber", "OrderNumber"))
        order = [child.tag.partition("}")[2] for child in part]
        assert order == ["Transformations", "GrainDirection", "ReferenceSide", "Processings"]
        for processing in part.findall("Processings/*", BTLX):
            name = processing.tag.partition("}")[2]
            assert processing.attrib["Name"] == name
            assert [child.tag.partition("}")[2] for child in processing] == PARAMETERS[name].split()


def test_there_is_one_part_for_each_plank(parts: dict[str, ElementTree.Element], planks: dict[str, Plank]) -> None:
    assert list(parts) == sorted(planks)
    assert all(part.attrib["Count"] == "1" for part in parts.values())


def test_a_part_is_the_straight_blank_of_its_plank(
    gridshell: Gridshell, parts: dict[str, ElementTree.Element], planks: dict[str, Plank]
) -> None:
    for mark, part in parts.items():
        plank = planks[mark]
        assert float(part.attrib["Length"]) == pytest.approx(plank.blank.length, abs=1e-3)
        assert (float(part.attrib["Width"]), float(part.attrib["Height"])) == (100.0, 12.0)
        assert (part.attrib["Material"], part.attrib["TimberGrade"]) == ("ash", "D50")
        assert float(part.attrib["Weight"]) == pytest.approx(mass(plank, gridshell.timber), abs=0.00051)


def test_a_part_is_named_and_grouped_by_its_mark(parts: dict[str, ElementTree.Element]) -> None:
    names = ("Annotation", "AssemblyNumber", "ElementNumber", "Group", "Package", "Layer")
    beam, geodesic = parts["S2-A1-07-L"].attrib, parts["S3-G-05"].attrib
    assert [beam[name] for name in names] == ["S2-A1-07-L", "S2-A1-07", "S2-A1-07", "S2", "S2-A1", "-1"]
    assert [geodesic[name] for name in names] == ["S3-G-05", "S3-G-05", "S3-G-05", "S3", "S3-G", "0"]


def test_a_part_has_the_guid_of_its_plank_in_ifc(parts: dict[str, ElementTree.Element]) -> None:
    for mark, part in parts.items():
        (transformation,) = part.findall("Transformations/Transformation", BTLX)
        assert re.fullmatch(r"\{[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}\}", transformation.attrib["GUID"])
        assert uuid.UUID(transformation.attrib["GUID"]) == uuid.uuid5(project_id("vault"), mark)


def test_blanks_lie_clear_of_each_other(parts: dict[str, ElementTree.Element]) -> None:
    """As rectangles in plan: two may share their range in x or in y, never both."""
    boxes = []
    for part in parts.values():
        corner, along, _high, wide = corner_and_axes(part)
        far = corner + float(part.attrib["Length"]) * along + float(part.attrib["Width"]) * wide
        boxes.append((np.minimum(corner, far)[:2], np.maximum(corner, far)[:2]))
    low, high = np.array([box[0] for box in boxes]), np.array([box[1] for box in boxes])
    meet = np.all((low[:, None] < high[None]) & (low[None] < high[:, None]), axis=2)
    assert meet.sum() == len(boxes)


def test_both_ends_are_cut_square(parts: dict[str, ElementTree.Element]) -> None:
    for part in parts.values():
        cuts = part.findall("Processings/JackRafterCut", BTLX)
        assert [cut.findtext("Orientation", namespaces=BTLX) for cut in cuts] == ["start", "end"]
        assert [value(cut, "StartX") for cut in cuts] == [0.0, float(part.attrib["Length"])]
        assert {value(cut, name) for cut in cuts for name in ("Angle", "Inclination")} == {90.0}


def test_every_hole_is_a_drilling_through_the_thickness(
    parts: dict[str, ElementTree.Element], planks: dict[str, Plank]
) -> None:
    """Written to 0.001 mm."""
    for mark, part in parts.items():
        holes = planks[mark].blank.holes
        found = holes_of(part)
        assert len(found) == len(holes)
        for (station, offset, diameter), hole in zip(found, holes, strict=True):
            assert station == pytest.approx(hole.station, abs=0.01)
            assert offset == pytest.approx(hole.offset, abs=0.01)
            assert diameter == hole.diameter


def axes_of(gridshell: Gridshell) -> dict[str, list[tuple[Floats, Floats]]]:
    """Return the axes of bolts and screws (point, direction) by joint, in vault coordinates."""
    axes: dict[str, list[tuple[Floats, Floats]]] = {}

    def add(mark: str, frame: Frame, matrix: Floats) -> None:
        origin = matrix[:3, :3] @ np.array(frame.origin) + matrix[:3, 3]
        axes.setdefault(mark.rpartition("-")[0], []).append((origin, matrix[:3, :3] @ np.array(frame.z)))

    for shell in gridshell.shells:
        fasteners: list[Bolt | Screw] = [*shell.bolts, *shell.screws]
        for fastener in fasteners:
            add(fastener.mark, fastener.frame, frame_matrix(shell.placement))
    for bolt in gridshell.bolts:
        add(bolt.mark, bolt.frame, np.eye(4))
    return axes


def test_holes_read_from_the_file_meet_the_fasteners_when_the_plank_is_formed(
    gridshell: Gridshell, parts: dict[str, ElementTree.Element]
) -> None:
    """0.1 mm, the accuracy that the workshop prints."""
    axes = axes_of(gridshell)
    for shell in gridshell.shells:
        matrix = frame_matrix(shell.placement)
        for plank in shell.planks:
            read = np.array([(station, offset, 0.0) for station, offset, _ in holes_of(parts[plank.mark])])
            formed = formed_points(plank, read) @ matrix[:3, :3].T + matrix[:3, 3]
            for centre, hole in zip(formed, plank.blank.holes, strict=True):
                gaps = [np.linalg.norm(np.cross(centre - origin, axis)) for origin, axis in axes[hole.joint]]
                assert min(gaps) < 0.1, (plank.mark, hole)


def test_the_mark_stands_clear_of_the_holes(parts: dict[str, ElementTree.Element], planks: dict[str, Plank]) -> None:
    """Letters are taken as wide as 0.7 of their height, as in most sans-serif capitals."""
    for mark, part in parts.items():
        (text,) = part.findall("Processings/Text", BTLX)
        assert text.findtext("Text", namespaces=BTLX) == mark
        half = 0.7 * value(text, "TextHeight") * len(mark) / 2.0
        start = value(text, "StartX")
        assert half < start < planks[mark].blank.length - half
        assert all(abs(hole.station - start) > half + hole.diameter / 2.0 for hole in planks[mark].blank.holes)


def read_by_compas_timber(path: Path) -> dict[str, Any]:
    reader = BTLxReader()
    model = reader.read(str(path))
    assert not reader.errors
    return {element.name: element for element in model.elements()}


def test_compas_timber_reads_the_same_blanks_and_drillings(path: Path, planks: dict[str, Plank]) -> None:
    elements = read_by_compas_timber(path)
    assert set(elements) == set(planks)
    for mark, plank in planks.items():
        element, section = elements[mark], plank.blank.section
        assert element.length == pytest.approx(plank.blank.length, abs=1e-3)
        assert (element.width, element.height) == (section.width, section.thickness)
        kinds = [feature.PROCESSING_NAME for feature in element.features]
        assert kinds == ["JackRafterCut"] * 2 + ["Drilling"] * len(plank.blank.holes) + ["Text"]
        for feature, hole in zip(element.features[2:-1], plank.blank.holes, strict=True):
            assert (feature.start_x, feature.start_y) == pytest.approx((hole.station, 50.0 + hole.offset), abs=0.01)
            assert (feature.diameter, feature.depth_limited) == (hole.diameter, False)


def test_compas_timber_bores_where_the_holes_of_the_blank_are(path: Path, planks: dict[str, Plank]) -> None:
    """The cylinders that it would cut from its beams; some planks only, because each takes a millisecond."""
    elements = read_by_compas_timber(path)
    for mark in list(planks)[::15]:
        element, blank = elements[mark], planks[mark].blank
        for feature, hole in zip(element.features[2:-1], blank.holes, strict=True):
            cylinder = feature.cylinder_from_params_and_element(element)
            at = cylinder.frame.point - element.frame.point
            assert [at.x, at.y, at.z] == pytest.approx([hole.station, hole.offset, 0.0], abs=0.01)
            assert abs(cylinder.frame.zaxis.z) == pytest.approx(1.0)
            assert cylinder.radius == pytest.approx(hole.diameter / 2.0)
            assert cylinder.height > blank.section.thickness


def test_a_slot_is_a_through_mortise_with_round_ends(gridshell: Gridshell, tmp_path: Path) -> None:
    shell = gridshell.shells[0]
    first = shell.planks[0]
    hole, *others = first.blank.holes
    slotted = replace(first, blank=replace(first.blank, holes=(replace(hole, slot=20.0), *others)))
    write_btlx(replace(gridshell, shells=(replace(shell, planks=(slotted,)),)), tmp_path / "slot.btlx")
    (part,) = parts_in(tmp_path / "slot.btlx").values()
    (mortise,) = part.findall("Processings/Mortise", BTLX)
    assert len(part.findall("Processings/Drilling", BTLX)) == len(others)
    start, end = value(mortise, "StartX"), value(mortise, "StartX") + value(mortise, "Length")
    assert (start + end) / 2.0 == pytest.approx(hole.station, abs=0.001)
    assert end - start == pytest.approx(hole.diameter + 20.0)
    assert value(mortise, "StartY") == pytest.approx(50.0 + hole.offset, abs=0.001)
    assert (value(mortise, "Width"), value(mortise, "Depth")) == (hole.diameter, 12.0)
    assert mortise.findtext("Shape", namespaces=BTLX) == "round"
    (element,) = read_by_compas_timber(tmp_path / "slot.btlx").values()
    frame = next(f for f in element.features if f.PROCESSING_NAME == "Mortise").frame_from_params_and_beam(element)
    # The mortise runs from the point that it is measured from against the y of its frame, here along the blank.
    assert [frame.yaxis.x, frame.yaxis.y, frame.yaxis.z] == pytest.approx([-1.0, 0.0, 0.0])


def test_the_file_holds_no_clock_and_no_chance(gridshell: Gridshell, path: Path, tmp_path: Path) -> None:
    program = ElementTree.parse(path).getroot().find("FileHistory/InitialExportProgram", BTLX)
    assert program is not None
    assert not {"Date", "Time", "ComputerName", "UserName"} & set(program.attrib)
    assert program.attrib["ProgramName"] == "COMPAS_Timber"
    write_btlx(gridshell, tmp_path / "again.btlx")
    assert (tmp_path / "again.btlx").read_bytes() == path.read_bytes()


def test_an_end_that_is_not_square_is_refused_by_mark(gridshell: Gridshell, tmp_path: Path) -> None:
    shell = gridshell.shells[0]
    skew = replace(shell.planks[0], blank=replace(shell.planks[0].blank, end_cut=EndCut(60.0)))
    with pytest.raises(FileError, match=rf"{skew.mark}: an end is cut at 60 degrees"):
        write_btlx(replace(gridshell, shells=(replace(shell, planks=(skew,)),)), tmp_path / "skew.btlx")
    assert list(tmp_path.iterdir()) == []


def test_without_compas_timber_the_error_says_how_to_get_it(
    gridshell: Gridshell, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """None in the table of modules is how Python marks a module that cannot be imported."""
    monkeypatch.setitem(sys.modules, "compas_timber", None)
    with pytest.raises(FileError, match=r"pip install 'aag-toolkit\[btlx\]'"):
        write_btlx(gridshell, tmp_path / "vault.btlx")
    assert list(tmp_path.iterdir()) == []
