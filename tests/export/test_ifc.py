"""The IFC file, read back with IfcOpenShell: valid, closed, complete, and the same every time.

Every check is a function that lists what is wrong, and is shown to find the fault in a damaged file.
"""

from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.util.placement
import ifcopenshell.util.shape
import ifcopenshell.validate
import numpy as np
import pytest

from aag_cad.design import Design
from aag_cad.errors import FileError, NetworkError
from aag_cad.export.ifc import write_ifc
from aag_cad.export.ifc_base import TIMESTAMP
from aag_cad.export.ifc_joints import joint_sides
from aag_cad.export.ifc_kinds import IFC_KINDS, colour
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Gridshell, Joint, Part, all_parts, shell_parts
from aag_cad.parts.products import part_frame, product_key
from aag_cad.parts.quantities import gross_volume
from aag_cad.pipeline import gridshell_of
from assembly.plan import plan_of

File: TypeAlias = ifcopenshell.file


@pytest.fixture(scope="module")
def vault(design: Design) -> Gridshell:
    return gridshell_of(design)


@pytest.fixture(scope="module")
def small(design: Design) -> Gridshell:
    """Give a vault of six geodesics a shell: every kind of part, a tenth of the number."""
    pattern = design.pattern.model_copy(update={"geodesics": 6, "min_nodes": 2})
    return gridshell_of(design.model_copy(update={"pattern": pattern}))


@pytest.fixture(scope="module")
def path(small: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("ifc") / "vault.ifc"
    write_ifc(small, path)
    return path


@pytest.fixture(scope="module")
def ifc(path: Path) -> File:
    return ifcopenshell.open(str(path))


@pytest.fixture
def damaged(path: Path) -> File:
    """Give a second copy of the file that a test may damage."""
    return ifcopenshell.open(str(path))


@pytest.fixture(scope="module")
def parts(small: Gridshell) -> dict[str, Part]:
    return {part.mark: part for part in all_parts(small)}


def faults(file: File) -> list[str]:
    """Return what the schema and its express rules find wrong."""
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(file, logger, express_rules=True)
    return [str(statement) for statement in logger.statements]


def open_or_inverted(file: File) -> list[int]:
    """Return the face sets that are not closed (each edge once in each direction) or whose faces turn inwards."""
    wrong = []
    for body in file.by_type("IfcTriangulatedFaceSet"):
        faces = np.array(body.CoordIndex) - 1
        edges = Counter((a, b) for face in faces.tolist() for a, b in zip(face, face[1:] + face[:1], strict=True))
        closed = all(count == 1 and edges[b, a] == 1 for (a, b), count in list(edges.items()))
        a, b, c = (np.array(body.Coordinates.CoordList)[faces[:, i]] for i in range(3))
        if not closed or not body.Closed or np.einsum("ij,ij->", a, np.cross(b, c)) <= 0.0:
            wrong.append(body.id())
    return wrong


def badly_contained(file: File) -> list[str]:
    """Return elements that hang in no or in two wholes, or are placed relative to something else than their whole."""
    wrong = []
    for element in file.by_type("IfcElement"):
        wholes = [relation.RelatingObject for relation in element.Decomposes]
        wholes += [relation.RelatingStructure for relation in element.ContainedInStructure]
        if len(wholes) != 1 or element.ObjectPlacement.PlacementRelTo != wholes[0].ObjectPlacement:
            wrong.append(element.Name)
    contained = [relation.RelatedElements for relation in file.by_type("IfcRelContainedInSpatialStructure")]
    if [[element.is_a() for element in elements] for elements in contained] != [["IfcElementAssembly"]]:
        wrong.append("the storey")
    return wrong


def badly_typed(file: File) -> list[str]:
    """Return parts without one type that says what they are, or that say it themselves; assemblies have no type."""
    wrong = []
    for element in file.by_type("IfcElement"):
        if element.is_a("IfcElementAssembly"):
            good = not element.IsTypedBy and element.PredefinedType == "USERDEFINED" and element.ObjectType
        else:
            kinds = [relation.RelatingType for relation in element.IsTypedBy]
            good = (
                len(kinds) == 1
                and kinds[0].is_a(f"{element.is_a()}Type")
                and kinds[0].PredefinedType != "NOTDEFINED"
                and element.PredefinedType is None
                and element.ObjectType == kinds[0].ElementType
                and (kinds[0].PredefinedType == "USERDEFINED") == bool(kinds[0].ElementType)
            )
        if not good:
            wrong.append(element.Name)
    return wrong


def repeated_guids(file: File) -> list[str]:
    counts = Counter(root.GlobalId for root in file.by_type("IfcRoot"))
    return [ident for ident, count in counts.items() if count > 1]


def unstyled(file: File) -> list[int]:
    """Return the body items that carry no colour themselves."""
    items = (*file.by_type("IfcTriangulatedFaceSet"), *file.by_type("IfcExtrudedAreaSolid"))
    return [item.id() for item in items if not item.StyledByItem]


CHECKS = (faults, open_or_inverted, badly_contained, badly_typed, repeated_guids, unstyled)


@pytest.mark.parametrize("check", CHECKS)
def test_nothing_is_wrong_with_the_file(ifc: File, check: Callable[[File], list[object]]) -> None:
    assert check(ifc) == []


def _claim_own_type(file: File) -> None:
    file.by_type("IfcMember")[0].PredefinedType = "USERDEFINED"


def _remove_title_of_assembly(file: File) -> None:
    file.by_type("IfcElementAssembly")[0].ObjectType = None


def _turn_one_face(file: File) -> None:
    body = file.by_type("IfcTriangulatedFaceSet")[0]
    first, *rest = body.CoordIndex
    body.CoordIndex = [first[::-1], *rest]


def _turn_inside_out(file: File) -> None:
    body = file.by_type("IfcTriangulatedFaceSet")[0]
    body.CoordIndex = [face[::-1] for face in body.CoordIndex]


def _contain_a_plank_as_well(file: File) -> None:
    relation = file.by_type("IfcRelContainedInSpatialStructure")[0]
    relation.RelatedElements = [*relation.RelatedElements, file.by_type("IfcMember")[0]]


def _place_a_plank_in_the_world(file: File) -> None:
    file.by_type("IfcMember")[0].ObjectPlacement.PlacementRelTo = None


def _repeat_a_guid(file: File) -> None:
    first, second, *_ = file.by_type("IfcMember")
    second.GlobalId = first.GlobalId


def _remove_a_colour(file: File) -> None:
    file.remove(file.by_type("IfcStyledItem")[0])


@pytest.mark.parametrize(
    ("damage", "check"),
    [
        (_remove_title_of_assembly, faults),
        (_turn_one_face, open_or_inverted),
        (_turn_inside_out, open_or_inverted),
        (_contain_a_plank_as_well, badly_contained),
        (_place_a_plank_in_the_world, badly_contained),
        (_claim_own_type, badly_typed),
        (_repeat_a_guid, repeated_guids),
        (_remove_a_colour, unstyled),
    ],
)
def test_each_check_finds_its_fault_in_a_damaged_file(
    damaged: File, damage: Callable[[File], None], check: Callable[[File], list[object]]
) -> None:
    damage(damaged)
    assert check(damaged) != []


def test_the_whole_vault_is_valid_and_no_larger_than_8_mb(vault: Gridshell, tmp_path: Path) -> None:
    write_ifc(vault, tmp_path / "vault.ifc")
    assert (tmp_path / "vault.ifc").stat().st_size < 8e6
    file = ifcopenshell.open(str(tmp_path / "vault.ifc"))
    assert [fault for check in CHECKS for fault in check(file)] == []


def test_the_header_declares_the_reference_view_and_no_date(path: Path) -> None:
    head = path.read_text(encoding="utf-8").splitlines()[:6]
    assert head[2] == "FILE_DESCRIPTION(('ViewDefinition [ReferenceView_V1.2]'),'2;1');"
    assert head[3].startswith(f"FILE_NAME('vault.ifc','{TIMESTAMP}',('AAG toolkit')")
    assert head[4] == "FILE_SCHEMA(('IFC4'));"


def test_the_same_gridshell_gives_the_same_bytes_anywhere(small: Gridshell, path: Path, tmp_path: Path) -> None:
    write_ifc(small, tmp_path / "other.ifc")
    assert (tmp_path / "other.ifc").read_bytes() == path.read_bytes()


def test_guids_stay_with_the_mark_and_differ_between_projects(small: Gridshell, ifc: File, tmp_path: Path) -> None:
    write_ifc(replace(small, name="site", shells=small.shells[:1]), tmp_path / "a.ifc")
    write_ifc(replace(small, shells=small.shells[:1]), tmp_path / "b.ifc")
    renamed, alone = (ifcopenshell.open(str(tmp_path / name)) for name in ("a.ifc", "b.ifc"))
    assert repeated_guids(renamed) == []
    ours, others, same = (
        {element.Name: element.GlobalId for element in file.by_type("IfcMember")} for file in (ifc, renamed, alone)
    )
    assert ours.items() >= same.items()
    assert set(ours.values()).isdisjoint(others.values())


def test_every_part_and_assembly_is_there_under_its_mark(small: Gridshell, ifc: File, parts: dict[str, Part]) -> None:
    entities = Counter(IFC_KINDS[type(part)].entity for part in parts.values())
    for entity, count in entities.items():
        assert len(ifc.by_type(entity)) == count
    assemblies = [small.name, *(shell.mark for shell in small.shells)]
    assemblies += [beam.mark for shell in small.shells for beam in shell.beams]
    names = [element.Name for element in ifc.by_type("IfcElement")]
    assert sorted(names) == sorted([*parts, *assemblies])
    assert all(element.Tag == element.Name for element in ifc.by_type("IfcElement"))


def test_equal_products_share_one_type_in_all_shells(ifc: File, parts: dict[str, Part]) -> None:
    assert len(ifc.by_type("IfcElementType")) == len({product_key(part) for part in parts.values()})
    siblings = [kind for kind in ifc.by_type("IfcMemberType") if kind.Name == "Plank G-03"]
    assert [sorted(part.Name for part in kind.Types[0].RelatedObjects) for kind in siblings] == [
        ["S1-G-03", "S2-G-03", "S3-G-03"]
    ]


def test_a_beam_is_made_of_its_planks_and_blocks(small: Gridshell, ifc: File) -> None:
    whole = {
        part.Name: relation.RelatingObject.Name
        for relation in ifc.by_type("IfcRelAggregates")
        for part in relation.RelatedObjects
    }
    for shell in small.shells:
        assert whole[shell.mark] == small.name
        for beam in shell.beams:
            assert whole[beam.mark] == shell.mark
            assert {whole[plank] for plank in beam.planks} == {beam.mark}
        for joint in shell.joints:
            beams = {plank.beam for plank in shell.planks if plank.mark in joint.members and plank.beam}
            if joint.mark in whole:
                assert whole[joint.mark] == (shell.mark if joint.kind == "AA" else beams.pop())


def test_bodies_have_the_volumes_of_the_parts(ifc: File, parts: dict[str, Part]) -> None:
    """By the OCC kernel; 1e-3: planks are chords every 120 mm, circles are read as chords of at most 0.02 radians."""
    settings = ifcopenshell.geom.settings()
    settings.set("mesher-angular-deflection", 0.02)
    for kind in ifc.by_type("IfcElementType"):
        shape = ifcopenshell.geom.create_shape(settings, kind.RepresentationMaps[0].MappedRepresentation)
        exact = gross_volume(parts[kind.Types[0].RelatedObjects[0].Name])
        assert ifcopenshell.util.shape.get_volume(shape) * 1e9 == pytest.approx(exact, rel=1e-3)


def test_every_part_stands_where_the_model_puts_it(small: Gridshell, ifc: File) -> None:
    """Origins are written to 1e-4 mm, directions to 1e-9: 1e-3 mm over the 9 m of a shell."""
    elements = {element.Name: element for element in ifc.by_type("IfcElement")}
    for shell in small.shells:
        for part in shell_parts(shell):
            frame = part_frame(part)
            expected = frame_matrix(shell.placement) @ (np.eye(4) if frame is None else frame_matrix(frame))
            found = ifcopenshell.util.placement.get_local_placement(elements[part.mark].ObjectPlacement)
            np.testing.assert_allclose(found[:3, 3], expected[:3, 3], rtol=0, atol=1e-3)
            np.testing.assert_allclose(found[:3, :3], expected[:3, :3], rtol=0, atol=1e-8)


def test_bodies_have_the_colour_of_their_family(ifc: File, parts: dict[str, Part]) -> None:
    for kind in ifc.by_type("IfcElementType"):
        for item in kind.RepresentationMaps[0].MappedRepresentation.Items:
            shade = item.StyledByItem[0].Styles[0].Styles[0].SurfaceColour
            expected = colour(parts[kind.Types[0].RelatedObjects[0].Name])
            assert (shade.Red, shade.Green, shade.Blue) == pytest.approx(expected, abs=1e-4)


def test_every_joint_is_realised_by_its_fasteners(small: Gridshell, ifc: File) -> None:
    joints = {joint.mark: joint for shell in small.shells for joint in shell.joints}
    relations = ifc.by_type("IfcRelConnectsElements")
    assert {relation.Name for relation in relations} == set(joints)
    for relation in relations:
        joint = joints[relation.Name]
        assert relation.is_a("IfcRelConnectsWithRealizingElements") == bool(joint.fasteners)
        if joint.fasteners:
            realising = {element.Name for element in relation.RealizingElements}
            assert realising >= set(joint.fasteners)
            assert relation.ConnectionType == joint.kind


def test_crossing_beams_meet_as_beams_on_their_stud(small: Gridshell, ifc: File) -> None:
    relation = next(each for each in ifc.by_type("IfcRelConnectsElements") if each.Name == "S1-N-001")
    meeting = [relation.RelatingElement.Name, relation.RelatedElement.Name]
    joint = next(joint for joint in small.shells[0].joints if joint.mark == "S1-N-001")
    assert meeting == sorted({mark.removesuffix("-L") for mark in joint.members if mark.endswith("-L")})
    assert "S1-N-001" in {element.Name for element in relation.RealizingElements}


def test_siblings_that_meet_nothing_else_meet_each_other(parts: dict[str, Part]) -> None:
    joint = Joint("S1-K-001", "AG", (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("S1-A1-01-L", "S1-A1-01-R", "S1-K-001"), ())
    assert joint_sides(joint, parts) == (["S1-A1-01-L", "S1-A1-01-R"], ["S1-K-001"])
    with pytest.raises(NetworkError, match="S1-K-001: a joint with 1 members"):
        joint_sides(replace(joint, members=("S1-K-001",)), parts)


def test_steps_become_tasks_that_follow_each_other_and_build_every_part(
    small: Gridshell, parts: dict[str, Part], tmp_path: Path
) -> None:
    steps = plan_of(small, 4, 25.0).steps
    write_ifc(small, tmp_path / "steps.ifc", steps)
    file = ifcopenshell.open(str(tmp_path / "steps.ifc"))
    assert faults(file) == []
    assert repeated_guids(file) == []
    assert [(task.Identification, task.Name) for task in file.by_type("IfcTask")] == [
        (step.id, step.title) for step in steps
    ]
    order = {
        (each.RelatingProcess.Identification, each.RelatedProcess.Identification)
        for each in file.by_type("IfcRelSequence")
    }
    assert order == {(before, step.id) for step in steps for before in step.predecessors}
    built = [each.RelatingProduct.Name for each in file.by_type("IfcRelAssignsToProduct")]
    assert set(built) >= set(parts)


def test_a_file_without_steps_has_no_schedule(ifc: File) -> None:
    assert not ifc.by_type("IfcWorkSchedule")


def test_a_folder_that_cannot_be_written_is_named(small: Gridshell, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("")
    with pytest.raises(FileError, match=r"vault\.ifc"):
        write_ifc(replace(small, shells=()), tmp_path / "out" / "vault.ifc")
