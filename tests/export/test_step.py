"""The STEP file holds every part once under its mark, in mm, coloured, with the volumes of the model."""

import os
import re
import subprocess
import sys
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Interface import Interface_Static
from OCP.STEPControl import STEPControl_Reader, STEPControl_StepModelType, STEPControl_Writer
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS_Shape
from OCP.XCAFDoc import XCAFDoc_ShapeTool
from solid_figures import signed_volume

from aag_cad.errors import FileError, SolidError
from aag_cad.export.cad.step import write_step
from aag_cad.parts.forms import Hole
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import colour
from aag_cad.parts.mesh import placed, shell_mesh
from aag_cad.parts.model import Gridshell, Plank, Shell, all_parts, ridge_parts, shell_parts
from aag_cad.parts.products import part_frame, product_key, product_name
from aag_cad.parts.store import gridshell_json
from aag_cad.parts.triangles import Mesh
from aag_cad.solids.products import product_solids
from aag_cad.units import Floats

WRITE_AGAIN = """
import sys
from pathlib import Path
from aag_cad.export.cad.step import write_step
from aag_cad.parts.store import read_gridshell
write_step(read_gridshell(Path(sys.argv[1]).read_text("utf-8")), Path(sys.argv[2]))
"""


def excerpt(shell: Shell) -> Shell:
    """Return two crossing beams, a geodesic, a boundary plank and what joins just these: parts of every kind."""
    beam_of = {plank.mark: plank.beam for plank in shell.planks}
    nodes = [joint for joint in shell.joints if joint.kind == "AA"]
    beams = {beam_of[mark] for mark in nodes[len(nodes) // 2].members if mark in beam_of}
    flat: set[str] = set()
    for kind in ("AG", "boundary"):
        met = next(j for j in shell.joints if j.kind == kind and beams & {beam_of.get(mark) for mark in j.members})
        flat.update(mark for mark in met.members if beam_of.get(mark) == "")
    planks = tuple(plank for plank in shell.planks if plank.beam in beams or plank.mark in flat)
    held = {plank.mark for plank in planks}
    joints = tuple(joint for joint in shell.joints if sum(mark in held for mark in joint.members) >= 3)
    marks = {mark for joint in joints for mark in (*joint.members, *joint.fasteners)}
    return replace(
        shell,
        planks=planks,
        beams=tuple(beam for beam in shell.beams if beam.mark in beams),
        studs=tuple(part for part in shell.studs if part.mark in marks),
        blocks=tuple(part for part in shell.blocks if part.mark in marks),
        bolts=tuple(part for part in shell.bolts if part.mark in marks),
        screws=tuple(part for part in shell.screws if part.mark in marks),
        joints=joints,
    )


def excerpt_of(gridshell: Gridshell) -> Gridshell:
    return replace(gridshell, shells=tuple(excerpt(shell) for shell in gridshell.shells), joints=())


@pytest.fixture(scope="module")
def few(gridshell: Gridshell) -> Gridshell:
    return excerpt_of(gridshell)


@pytest.fixture(scope="module")
def path(few: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("step") / "vault.step"
    write_step(few, made)
    return made


@dataclass(frozen=True)
class Text:
    """A STEP file read as plain text: the header, and the records by number without line breaks."""

    header: str
    records: dict[int, str]

    def of(self, entity: str) -> dict[int, str]:
        """Return the records of an entity by number."""
        return {number: body for number, body in self.records.items() if body.startswith(entity + "(")}


def read_text(path: Path) -> Text:
    header, data = path.read_text(encoding="ascii").split("DATA;\n")
    found = re.findall(r"^#(\d+) = (.*?);\n(?=#|ENDSEC)", data, re.MULTILINE | re.DOTALL)
    return Text(header, {int(number): re.sub(r"\n\s*", "", body) for number, body in found})


@pytest.fixture(scope="module")
def text(path: Path) -> Text:
    return read_text(path)


def links(body: str) -> list[int]:
    return [int(number) for number in re.findall(r"#(\d+)", body)]


def first_string(body: str) -> str:
    found = re.search(r"\('((?:[^']|'')*)'", body)
    assert found is not None
    return found[1]


def product_of(text: Text, definition: int) -> str:
    """Return the name of the product of a PRODUCT_DEFINITION."""
    formation = links(text.records[definition])[0]
    return first_string(text.records[links(text.records[formation])[0]])


@dataclass(frozen=True)
class Occurrence:
    """One line of the assembly by product definitions: the one that it sits in, and its own."""

    parent: int
    child: int


def occurrences(text: Text) -> dict[str, Occurrence]:
    """Return the lines of the assembly by mark; no mark may be there twice."""
    found: dict[str, Occurrence] = {}
    for body in text.of("NEXT_ASSEMBLY_USAGE_OCCURRENCE").values():
        mark = re.findall(r"'((?:[^']|'')*)'", body)[1]
        assert mark not in found
        found[mark] = Occurrence(*links(body)[:2])
    return found


def parents_in_the_model(gridshell: Gridshell) -> dict[str, str]:
    """Return the mark of the assembly that each part and assembly sits in; "" is the vault."""
    parents = {shell.mark: "" for shell in gridshell.shells}
    for shell in gridshell.shells:
        home = index_of(shell).beam_of
        parents |= {beam.mark: shell.mark for beam in shell.beams}
        parents |= {part.mark: home.get(part.mark, shell.mark) for part in shell_parts(shell)}
    return parents | {part.mark: "" for part in ridge_parts(gridshell)}


def solids_in(shape: TopoDS_Shape) -> list[TopoDS_Shape]:
    explorer, found = TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_SOLID), []
    while explorer.More():
        found.append(explorer.Current())
        explorer.Next()
    return found


@pytest.fixture(scope="module")
def solids(path: Path) -> list[TopoDS_Shape]:
    """The solids of the file as another reader finds them, in its order."""
    reader = STEPControl_Reader()
    assert reader.ReadFile(str(path)) == IFSelect_ReturnStatus.IFSelect_RetDone
    reader.TransferRoots()
    return solids_in(reader.OneShape())


def mass(shape: TopoDS_Shape) -> tuple[float, Floats]:
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties)
    centre = properties.CentreOfMass()
    return properties.Mass(), np.array([centre.X(), centre.Y(), centre.Z()])


def centroid(mesh: Mesh) -> Floats:
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    sixfold = np.einsum("ij,ij->i", a, np.cross(b, c))
    return np.asarray(((a + b + c) / 4.0 * sixfold[:, None]).sum(axis=0) / sixfold.sum())


def test_the_file_is_ap242_in_millimetres(text: Text) -> None:
    assert "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF" in text.header
    units = [body for body in text.records.values() if "LENGTH_UNIT()" in body]
    assert units
    assert all("SI_UNIT(.MILLI.,.METRE.)" in body for body in units)


def test_beams_hold_their_planks_blocks_and_block_bolts_and_the_shell_the_rest(few: Gridshell) -> None:
    shell = few.shells[0]
    home = index_of(shell).beam_of
    assert {mark for mark in home if home[mark] == shell.beams[0].mark} >= set(shell.beams[0].planks)
    for joint in shell.joints:
        beams = {plank.beam for plank in shell.planks if plank.mark in joint.members and plank.beam}
        homes = {mark: home.get(mark) for mark in (*joint.fasteners, joint.mark)}
        for mark, found in homes.items():
            tied_to_one_beam = joint.kind != "AA" and "-W" not in mark
            assert found == (next(iter(beams)) if tied_to_one_beam else None)
    assert {joint.kind for joint in shell.joints} == {"AA", "AG", "boundary"}


def test_every_mark_hangs_once_in_the_tree_of_vault_shell_beam_and_part(few: Gridshell, text: Text) -> None:
    found = occurrences(text)
    expected = parents_in_the_model(few)
    assert set(found) == set(expected)
    assemblies = {mark: found[mark].child for mark in expected.values() if mark}
    for mark, parent in expected.items():
        if parent:
            assert found[mark].parent == assemblies[parent]
        else:
            assert product_of(text, found[mark].parent) == few.title


def test_leaf_parts_are_solids_right_under_their_assembly_and_equal_parts_share_a_product(
    few: Gridshell, text: Text
) -> None:
    found = occurrences(text)
    shapes = {}
    for body in text.of("SHAPE_DEFINITION_REPRESENTATION").values():
        shape, representation = links(body)
        shapes[links(text.records[shape])[0]] = text.records[representation]
    by_key: dict[str, set[int]] = {}
    for part in all_parts(few):
        child = found[part.mark].child
        assert shapes[child].startswith("ADVANCED_BREP_SHAPE_REPRESENTATION(")
        assert product_of(text, child).startswith(product_name(part))
        by_key.setdefault(product_key(part), set()).add(child)
    assert all(len(children) == 1 for children in by_key.values())
    assert len(set.union(*by_key.values())) == len(by_key) == len(text.of("MANIFOLD_SOLID_BREP"))
    names = [product_of(text, definition) for definition in text.of("PRODUCT_DEFINITION")]
    assert len(names) == len(set(names))


def placement(text: Text, number: int) -> tuple[Floats, Floats, Floats]:
    """Return origin, z and x of an AXIS2_PLACEMENT_3D."""
    origin, z, x = (
        np.array([float(value) for value in re.findall(r"[-\d.E+]+", text.records[link].split("',")[1])])
        for link in links(text.records[number])
    )
    return origin, z, x


def test_each_mark_stands_where_its_frame_does(few: Gridshell, text: Text) -> None:
    frames = {part.mark: part_frame(part) for part in all_parts(few)}
    frames |= {shell.mark: shell.placement for shell in few.shells}
    frames |= {beam.mark: None for shell in few.shells for beam in shell.beams}
    marks = {
        number: re.findall(r"'((?:[^']|'')*)'", body)[1]
        for number, body in text.of("NEXT_ASSEMBLY_USAGE_OCCURRENCE").items()
    }
    for body in text.of("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION").values():
        relation, shape = links(body)
        mark = marks[links(text.records[shape])[0]]
        transformation = next(
            link for link in links(text.records[relation]) if text.records[link].startswith("ITEM_DEFINED")
        )
        _home, there = links(text.records[transformation])
        origin, z, x = placement(text, there)
        frame = frames.pop(mark)
        expected = (frame.origin, frame.z, frame.x) if frame else ((0, 0, 0), (0, 0, 1), (1, 0, 0))
        # Twelve decimals of directions and coordinates are written; millimetres of some metres keep 1e-8.
        assert origin == pytest.approx(np.array(expected[0]), abs=1e-8)
        assert z == pytest.approx(np.array(expected[1]), abs=1e-11)
        assert x == pytest.approx(np.array(expected[2]), abs=1e-11)
    assert not frames


def test_each_solid_has_the_colour_of_its_kind(few: Gridshell, text: Text) -> None:
    styled = {}
    for body in text.of("STYLED_ITEM").values():
        chain, target = links(body)
        while not text.records[chain].startswith("COLOUR_RGB("):
            chain = links(text.records[chain])[-1]
        assert target not in styled
        styled[target] = [float(value) for value in text.records[chain].split("',")[1].rstrip(")").split(",")]
    brep_of, breps = {}, text.of("MANIFOLD_SOLID_BREP")
    for body in text.of("SHAPE_DEFINITION_REPRESENTATION").values():
        shape, representation = links(body)
        for link in links(text.records[representation]):
            if link in breps:
                brep_of[links(text.records[shape])[0]] = link
    found = occurrences(text)
    for part in shell_parts(few.shells[0]):
        # Half a step of 8-bit colour.
        assert styled[brep_of[found[part.mark].child]] == pytest.approx(colour(part), abs=0.002)
    assert len({tuple(rgb) for rgb in styled.values()}) == len({colour(part) for part in all_parts(few)}) >= 7


def test_a_second_reading_finds_every_solid_valid_and_in_its_place(few: Gridshell, solids: list[TopoDS_Shape]) -> None:
    read = [(solid, *mass(solid)) for solid in solids]
    assert len(read) == len(all_parts(few))
    assert all(BRepCheck_Analyzer(solid).IsValid() for solid, _volume, _centre in read)
    centres = np.array([centre for _solid, _volume, centre in read])
    taken = set()
    meshes = [placed(shell_mesh(part), shell.placement) for shell in few.shells for part in shell_parts(shell)]
    for mesh in (*meshes, *(shell_mesh(part) for part in ridge_parts(few))):
        away = np.linalg.norm(centres - centroid(mesh), axis=1)
        near = int(np.argmin(away))
        taken.add(near)
        # The meshes have chords of 120 mm and no holes or countersinks: their centres are a millimetre or two off.
        assert away[near] < 2.5
    assert len(taken) == len(read)


def test_a_second_reading_finds_the_volume_of_each_product(few: Gridshell, solids: list[TopoDS_Shape]) -> None:
    # The excerpt repeats the same products in three shells, which stand in the file in order.
    first = solids[: len(shell_parts(few.shells[0]))]
    made = product_solids(few)
    own = {product_key(part): made[product_key(part)] for part in shell_parts(few.shells[0])}
    kinds: list[TopoDS_Shape] = []
    for solid in first:
        if not any(solid.IsPartner(kind) for kind in kinds):
            kinds.append(solid)
    expected = sorted(signed_volume(solid, 1e-7) for solid in own.values())
    assert sorted(signed_volume(solid, 1e-7) for solid in kinds) == pytest.approx(expected, rel=1e-6)


def test_the_same_model_gives_the_same_bytes_whatever_was_written_before(few: Gridshell, path: Path) -> None:
    Interface_Static.SetIVal_s("write.surfacecurve.mode", 1)
    other = STEPControl_Writer()
    other.Transfer(BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape(), STEPControl_StepModelType.STEPControl_AsIs)
    again = path.with_name("again.step")
    write_step(few, again)
    assert again.read_bytes() == path.read_bytes()


def test_another_process_writes_the_same_bytes(few: Gridshell, path: Path) -> None:
    again, held = path.with_name("elsewhere.step"), path.with_name("few.json")
    held.write_text(gridshell_json(few), "utf-8")
    subprocess.run(
        [sys.executable, "-c", WRITE_AGAIN, str(held), str(again)],
        check=True,
        env={**os.environ, "PYTHONHASHSEED": "271"},
    )
    assert again.read_bytes() == path.read_bytes()


def test_the_settings_of_the_kernel_stay_as_they_were(few: Gridshell, tmp_path: Path) -> None:
    Interface_Static.SetCVal_s("write.step.schema", "AP203")
    Interface_Static.SetIVal_s("write.surfacecurve.mode", 1)
    XCAFDoc_ShapeTool.SetAutoNaming_s(True)
    write_step(replace(few, shells=()), tmp_path / "empty.step")
    assert Interface_Static.CVal_s("write.step.schema") == "AP203"
    assert Interface_Static.IVal_s("write.surfacecurve.mode") == 1
    assert XCAFDoc_ShapeTool.AutoNaming_s()


def test_the_kernel_says_nothing_on_the_terminal(
    few: Gridshell, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    write_step(replace(few, shells=()), tmp_path / "empty.step")
    assert capfd.readouterr() == ("", "")


def test_the_header_names_the_maker_and_no_clock_is_read(text: Text) -> None:
    told = " ".join(text.header.split())
    assert "FILE_NAME('vault.step','2000-01-01T00:00:00',('AAG toolkit'),( 'AAG toolkit')" in told


def test_a_title_beyond_ascii_is_spelt_as_the_standard_asks(few: Gridshell, tmp_path: Path) -> None:
    titled = replace(few, title="Gewölbe 'Eschenholz' 木 \N{DECIDUOUS TREE}", shells=(), blades=(), bolts=())
    write_step(titled, tmp_path / "titled.step")
    names = [first_string(body) for body in read_text(tmp_path / "titled.step").of("PRODUCT").values()]
    assert names == [r"Gew\X2\00F6\X0\lbe ''Eschenholz'' \X2\6728\X0\ \X4\0001F333\X0\\"[:-1]]


def test_an_invalid_plank_leaves_the_older_file_untouched(few: Gridshell, tmp_path: Path) -> None:
    shell = few.shells[0]
    overlapping = (Hole(500.0, 0.0, 9.0, "bolt", "S1-N-001"), Hole(505.0, 0.0, 9.0, "bolt", "S1-N-002"))
    spoilt: Plank = replace(shell.planks[0], blank=replace(shell.planks[0].blank, holes=overlapping))
    target = tmp_path / "vault.step"
    target.write_text("older")
    with pytest.raises(SolidError, match=f"{spoilt.mark}: the solid is invalid"):
        write_step(replace(few, shells=(replace(shell, planks=(spoilt,)),)), target)
    assert target.read_text() == "older"
    assert list(tmp_path.iterdir()) == [target]


def test_a_folder_that_cannot_be_written_is_named(few: Gridshell, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("")
    with pytest.raises(FileError, match=r"out/vault\.step: cannot be written"):
        write_step(replace(few, shells=()), tmp_path / "out" / "vault.step")


def test_the_whole_vault_holds_every_plank_hole_stud_bolt_and_screw_in_15_megabytes(
    gridshell: Gridshell, tmp_path: Path
) -> None:
    write_step(gridshell, tmp_path / "vault.step")
    assert (tmp_path / "vault.step").stat().st_size < 15e6
    text = read_text(tmp_path / "vault.step")
    assert set(occurrences(text)) == set(parents_in_the_model(gridshell))
    products = {product_key(part): part for part in all_parts(gridshell)}
    assert len(text.of("MANIFOLD_SOLID_BREP")) == len(text.of("STYLED_ITEM")) == len(products)
    radii = Counter(float(body.rstrip(")").split(",")[-1]) for body in text.of("CYLINDRICAL_SURFACE").values())
    holes = Counter(
        hole.diameter / 2.0 for part in products.values() if isinstance(part, Plank) for hole in part.blank.holes
    )
    for radius, count in holes.items():
        assert radii[radius] >= count
