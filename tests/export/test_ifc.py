"""The IFC file, read back with IfcOpenShell: complete, in its place, and the same every time."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

import ifcopenshell
import ifcopenshell.util.placement
import numpy as np
import pytest
from test_ifc_sample import sampled

from aag_cad.errors import DesignError, FileError, NetworkError
from aag_cad.export.ifc.frame import TIMESTAMP
from aag_cad.export.ifc.joints import joint_sides
from aag_cad.export.ifc.model import write_ifc
from aag_cad.export.ifc.options import IfcGeometry, IfcOptions, IfcSchema, view_definition
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import KINDS, colour
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Footing, Gridshell, Joint, Part, Shell, all_joints, all_parts, shell_parts
from aag_cad.parts.products import part_frame, product_key

File: TypeAlias = ifcopenshell.file


@pytest.fixture(scope="module")
def sample(gridshell: Gridshell) -> Gridshell:
    return sampled(gridshell)


@pytest.fixture(scope="module")
def path(sample: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("ifc") / "vault.ifc"
    write_ifc(sample, path)
    return path


@pytest.fixture(scope="module")
def ifc(path: Path) -> File:
    return ifcopenshell.open(str(path))


@pytest.fixture(scope="module")
def parts(sample: Gridshell) -> Mapping[str, Part]:
    return {part.mark: part for part in all_parts(sample)}


def test_the_header_declares_the_reference_view_and_no_date(path: Path) -> None:
    head = path.read_text(encoding="utf-8").splitlines()[:6]
    assert head[2] == "FILE_DESCRIPTION(('ViewDefinition [ReferenceView_V1.2]'),'2;1');"
    assert head[3].startswith(f"FILE_NAME('vault.ifc','{TIMESTAMP}',('AAG toolkit')")
    assert head[4] == "FILE_SCHEMA(('IFC4'));"


def test_author_and_organisation_stand_in_the_header(sample: Gridshell, tmp_path: Path) -> None:
    empty = replace(sample, shells=(), blades=(), bolts=(), joints=())
    write_ifc(empty, tmp_path / "a.ifc", options=IfcOptions(author="A. Carpenter", organisation="Gridshells"))
    assert f"FILE_NAME('vault.ifc','{TIMESTAMP}',('A. Carpenter'),('Gridshells')" in (tmp_path / "a.ifc").read_text()


@pytest.mark.parametrize(
    ("schema", "geometry", "view"),
    [
        ("IFC2X3", "mesh", "CoordinationView_V2.0"),
        ("IFC4X3_ADD2", "mesh", "ReferenceView"),
        ("IFC4", "brep", "DesignTransferView_V1.0"),
    ],
)
def test_each_schema_has_its_view_and_b_splines_are_no_reference_view(
    schema: IfcSchema, geometry: IfcGeometry, view: str
) -> None:
    assert view_definition(IfcOptions(schema=schema, geometry=geometry)) == f"ViewDefinition [{view}]"


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (IfcOptions(schema="IFC2X3", geometry="brep"), "--ifc-geometry: IFC2X3 has no B-spline faces"),
        (IfcOptions(schema="IFC5"), "--ifc-schema: 'IFC5' is not written; choose IFC4, IFC4X3_ADD2, IFC2X3"),  # type: ignore[arg-type]
        (IfcOptions(geometry="voxel"), "--ifc-geometry: 'voxel' is not written; choose mesh, brep"),  # type: ignore[arg-type]
    ],
)
def test_options_that_make_no_file_are_named(sample: Gridshell, tmp_path: Path, options: IfcOptions, text: str) -> None:
    with pytest.raises(DesignError, match=text):
        write_ifc(sample, tmp_path / "vault.ifc", options=options)
    assert not list(tmp_path.iterdir())


def test_the_same_gridshell_gives_the_same_bytes_anywhere(sample: Gridshell, path: Path, tmp_path: Path) -> None:
    write_ifc(sample, tmp_path / "other.ifc")
    assert (tmp_path / "other.ifc").read_bytes() == path.read_bytes()


def test_guids_stay_with_the_mark_and_differ_between_projects(sample: Gridshell, ifc: File, tmp_path: Path) -> None:
    first = replace(sample, shells=sample.shells[:1], blades=(), bolts=(), joints=())
    write_ifc(replace(first, name="site"), tmp_path / "a.ifc")
    write_ifc(first, tmp_path / "b.ifc", options=IfcOptions(schema="IFC2X3"))
    renamed, alone = (ifcopenshell.open(str(tmp_path / name)) for name in ("a.ifc", "b.ifc"))
    guids = [root.GlobalId for root in renamed.by_type("IfcRoot")]
    assert len(set(guids)) == len(guids)
    ours, others, same = (
        {element.Name: element.GlobalId for element in file.by_type("IfcMember")} for file in (ifc, renamed, alone)
    )
    assert ours.items() >= same.items()
    assert set(ours.values()).isdisjoint(others.values())


def test_every_part_and_assembly_is_there_under_its_mark(
    sample: Gridshell, ifc: File, parts: Mapping[str, Part]
) -> None:
    entities = Counter(KINDS[type(part)].ifc.entity for part in parts.values())
    for entity, count in entities.items():
        assert len(ifc.by_type(entity)) == count
    assemblies = [sample.name, *(shell.mark for shell in sample.shells)]
    assemblies += [beam.mark for shell in sample.shells for beam in shell.beams]
    names = [element.Name for element in ifc.by_type("IfcElement")]
    assert sorted(names) == sorted([*parts, *assemblies])
    assert all(element.Tag == element.Name for element in ifc.by_type("IfcElement"))


def test_equal_products_share_one_type_in_all_shells(ifc: File, parts: Mapping[str, Part]) -> None:
    assert len(ifc.by_type("IfcElementType")) == len({product_key(part) for part in parts.values()})
    siblings = [kind for kind in ifc.by_type("IfcMemberType") if kind.Name == "Plank G-01"]
    assert [sorted(part.Name for part in kind.Types[0].RelatedObjects) for kind in siblings] == [
        ["S1-G-01", "S2-G-01", "S3-G-01"]
    ]


def test_a_beam_is_made_of_its_planks_blocks_and_their_bolts(sample: Gridshell, ifc: File) -> None:
    whole = {
        part.Name: relation.RelatingObject.Name
        for relation in ifc.by_type("IfcRelAggregates")
        for part in relation.RelatedObjects
    }
    for shell in sample.shells:
        assert whole[shell.mark] == sample.name
        assert all(whole[beam.mark] == shell.mark for beam in shell.beams)
        home = index_of(shell).beam_of
        assert all(whole[part.mark] == home.get(part.mark, shell.mark) for part in shell_parts(shell))
    assert all(whole[part.mark] == sample.name for part in (*sample.blades, *sample.bolts))


def test_every_part_stands_where_the_model_puts_it(sample: Gridshell, ifc: File) -> None:
    """Origins are written to 1e-4 mm, directions to 1e-9: 1e-3 mm over the 9 m of a shell."""
    elements = {element.Name: element for element in ifc.by_type("IfcElement")}
    placed: list[tuple[Part, Shell | None]] = [(part, s) for s in sample.shells for part in shell_parts(s)]
    placed += [(part, None) for part in (*sample.blades, *sample.bolts)]
    for part, shell in placed:
        frame = part_frame(part)
        expected = np.eye(4) if shell is None else frame_matrix(shell.placement)
        expected = expected if frame is None else expected @ frame_matrix(frame)
        found = ifcopenshell.util.placement.get_local_placement(elements[part.mark].ObjectPlacement)
        np.testing.assert_allclose(found[:3, 3], expected[:3, 3], rtol=0, atol=1e-3)
        np.testing.assert_allclose(found[:3, :3], expected[:3, :3], rtol=0, atol=1e-8)


def test_bodies_have_the_colour_of_their_family(ifc: File, parts: Mapping[str, Part]) -> None:
    for kind in ifc.by_type("IfcElementType"):
        for item in kind.RepresentationMaps[0].MappedRepresentation.Items:
            shade = item.StyledByItem[0].Styles[0].Styles[0].SurfaceColour
            expected = colour(parts[kind.Types[0].RelatedObjects[0].Name])
            assert (shade.Red, shade.Green, shade.Blue) == pytest.approx(expected, abs=1e-4)


def test_every_joint_is_realised_by_its_fasteners(sample: Gridshell, ifc: File) -> None:
    joints = {joint.mark: joint for joint in all_joints(sample)}
    relations = ifc.by_type("IfcRelConnectsElements")
    assert {relation.Name for relation in relations} == set(joints)
    for relation in relations:
        joint = joints[relation.Name]
        assert relation.is_a("IfcRelConnectsWithRealizingElements") == bool(joint.fasteners)
        if joint.fasteners:
            realising = {element.Name for element in relation.RealizingElements}
            assert realising >= set(joint.fasteners)
            assert relation.ConnectionType == joint.kind


def test_crossing_beams_meet_as_beams_on_their_stud(sample: Gridshell, ifc: File) -> None:
    joint = next(joint for joint in sample.shells[0].joints if joint.kind == "AA")
    relation = next(each for each in ifc.by_type("IfcRelConnectsElements") if each.Name == joint.mark)
    meeting = [relation.RelatingElement.Name, relation.RelatedElement.Name]
    assert meeting == sorted({mark.removesuffix("-L") for mark in joint.members if mark.endswith("-L")})
    assert joint.mark in {element.Name for element in relation.RealizingElements}


def test_a_shoe_stands_on_its_concrete_block_by_its_rod(
    sample: Gridshell, ifc: File, parts: Mapping[str, Part]
) -> None:
    feet = {joint.mark: joint for joint in sample.shells[0].joints if joint.kind == "footing"}
    assert feet
    for relation in ifc.by_type("IfcRelConnectsElements"):
        if relation.Name in feet:
            meeting = {relation.RelatingElement.Name, relation.RelatedElement.Name}
            assert meeting == set(feet[relation.Name].members)
            assert any(isinstance(parts[mark], Footing) for mark in meeting)
            assert [each.Name for each in relation.RealizingElements] == list(feet[relation.Name].fasteners)


def test_siblings_that_meet_nothing_else_meet_each_other(gridshell: Gridshell) -> None:
    parts = index_of(gridshell).parts
    joint = Joint("S1-K-001", "AG", (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ("S1-A1-01-L", "S1-A1-01-R", "S1-K-001"), ())
    assert joint_sides(joint, parts) == (["S1-A1-01-L", "S1-A1-01-R"], ["S1-K-001"])
    with pytest.raises(NetworkError, match="S1-K-001: a joint with 1 members"):
        joint_sides(replace(joint, members=("S1-K-001",)), parts)


def test_a_folder_that_cannot_be_written_is_named(sample: Gridshell, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("")
    empty = replace(sample, shells=(), blades=(), bolts=(), joints=())
    with pytest.raises(FileError, match=r"vault\.ifc"):
        write_ifc(empty, tmp_path / "out" / "vault.ifc")
