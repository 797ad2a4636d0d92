"""The drawings of the blanks, read back by ezdxf and laid on the formed planks."""

import math
import os
import re
import subprocess
import sys
from collections import Counter
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from ezdxf.document import Drawing
from ezdxf.path import make_path
from hypothesis import given
from hypothesis import strategies as st

from aag_cad.export.workshop.blank_drawings import HOLE_LAYERS, LAYERS, blank_drawing, joint_names, spread
from aag_cad.export.workshop.dxf import dxf_bytes, write_blank_dxfs
from aag_cad.parts.forming import formed_points
from aag_cad.parts.index import index_of
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Gridshell, Plank, Shell
from aag_cad.shop.groups import DrillGroup, Laid, drill_groups, drilled_joints, laid_points
from aag_cad.units import Floats


@pytest.fixture(scope="module")
def folder(gridshell: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("blanks")
    write_blank_dxfs(gridshell, folder)
    return folder


@pytest.fixture(scope="module")
def groups(gridshell: Gridshell) -> tuple[DrillGroup, ...]:
    return drill_groups(list(index_of(gridshell).planks.values()))


@pytest.fixture(scope="module")
def documents(folder: Path) -> dict[str, Drawing]:
    return {path.stem: ezdxf.readfile(path) for path in sorted(folder.glob("*.dxf"))}


def texts(document: Drawing, layer: str) -> list[str]:
    return [text.dxf.text for text in document.modelspace().query(f'TEXT[layer=="{layer}"]')]


def hole_centres(document: Drawing) -> Floats:
    circles = [circle.dxf.center for circle in document.modelspace().query("CIRCLE")]
    return np.array([(centre.x, centre.y) for centre in circles])


def redrilled(plank: Plank, **change: object) -> DrillGroup:
    """Return the group of one plank alone whose first hole is changed."""
    first, *others = plank.blank.holes
    holes = (replace(first, **change), *others)  # type: ignore[arg-type]
    (group,) = drill_groups([replace(plank, blank=replace(plank.blank, holes=holes))])
    return group


def reread(group: DrillGroup, gridshell: Gridshell, tmp_path: Path) -> Drawing:
    joints = drilled_joints(group, {group.master.mark: group.master})
    drawing = blank_drawing(group, joints, gridshell.title, gridshell.timber)
    path = tmp_path / f"{group.mark}.dxf"
    path.write_bytes(dxf_bytes(drawing))
    return ezdxf.readfile(path)


def test_there_is_one_drawing_for_each_template(folder: Path, groups: tuple[DrillGroup, ...]) -> None:
    assert sorted(path.name for path in folder.iterdir()) == sorted(f"{group.mark}.dxf" for group in groups)


def test_the_drawings_are_sound_r2010_in_millimetres(documents: dict[str, Drawing]) -> None:
    for document in documents.values():
        assert document.dxfversion == "AC1024"
        assert document.header["$INSUNITS"] == 4
        assert not document.audit().errors
        assert {item.dxf.layer for item in document.modelspace()} <= set(LAYERS)


def test_every_plank_is_named_in_the_drawing_of_its_group_alone(
    documents: dict[str, Drawing], groups: tuple[DrillGroup, ...]
) -> None:
    for group in groups:
        stacks = " ".join(text for text in texts(documents[group.mark], "TITLE") if text.startswith("Stack"))
        named = re.findall(r"S\d-(?:A[12]|G|E)-\d+(?:-[LR])?", stacks)
        assert named == [member.mark for member in group.members]


def test_holes_are_true_circles_on_the_layer_of_their_use(
    documents: dict[str, Drawing], groups: tuple[DrillGroup, ...]
) -> None:
    for group in groups:
        drawn = Counter((c.dxf.layer, 2.0 * c.dxf.radius) for c in documents[group.mark].modelspace().query("CIRCLE"))
        assert drawn == Counter((HOLE_LAYERS[hole.use], hole.diameter) for hole in group.master.blank.holes)


def test_the_outline_is_the_rectangle_of_the_blank(
    documents: dict[str, Drawing], groups: tuple[DrillGroup, ...]
) -> None:
    for group in groups:
        (outline,) = documents[group.mark].modelspace().query('LWPOLYLINE[layer=="OUTLINE"]')
        points = np.array(outline.get_points("xy"))
        assert outline.closed
        size = (group.master.blank.length, group.master.blank.section.width)
        assert np.allclose(np.ptp(points, axis=0), size, atol=1e-9)
        assert np.allclose(points.min(axis=0), (0.0, -size[1] / 2.0), atol=1e-9)


def fastener_axes(gridshell: Gridshell, shell: Shell, plank: Plank) -> tuple[Floats, Floats]:
    """Return points and directions (n, 3), in the shell, of the axes of all fasteners of the joints of a plank."""
    own = {item.mark: (np.array(item.frame.origin), np.array(item.frame.z)) for item in (*shell.bolts, *shell.screws)}
    inverse = np.linalg.inv(frame_matrix(shell.placement))
    for bolt in gridshell.bolts:
        axis = inverse @ np.column_stack([(*bolt.frame.origin, 1.0), (*bolt.frame.z, 0.0)])
        own[bolt.mark] = (axis[:3, 0], axis[:3, 1])
    joints = [joint for joint in (*shell.joints, *gridshell.joints) if plank.mark in joint.members]
    marks = [mark for joint in joints for mark in joint.fasteners if mark in own]
    return np.array([own[mark][0] for mark in marks]), np.array([own[mark][1] for mark in marks])


def test_the_drawn_holes_meet_the_axes_of_bolts_and_screws_on_the_formed_planks(
    gridshell: Gridshell, documents: dict[str, Drawing], groups: tuple[DrillGroup, ...]
) -> None:
    """Every hole of every plank of the vault, turned back from its template and formed, to 0.1 mm."""
    laid: dict[str, tuple[str, Laid]] = {m.mark: (group.mark, m.laid) for group in groups for m in group.members}
    for shell in gridshell.shells:
        for plank in shell.planks:
            template, way = laid[plank.mark]
            points = laid_points(hole_centres(documents[template]), plank.blank.length, way)
            formed = formed_points(plank, np.column_stack([points, np.zeros(len(points))]))
            origins, directions = fastener_axes(gridshell, shell, plank)
            gaps = formed[:, None] - origins[None]
            along = np.einsum("hfk,fk->hf", gaps, directions)
            distances = np.linalg.norm(gaps - along[..., None] * directions[None], axis=2)
            assert distances.min(axis=1).max() < 0.1, plank.mark
            assert len(set(distances.argmin(axis=1))) == len(plank.blank.holes), plank.mark


def test_running_dimensions_are_the_stations_to_a_tenth(
    documents: dict[str, Drawing], groups: tuple[DrillGroup, ...]
) -> None:
    for group in groups:
        written = Counter(text.split()[0] for text in texts(documents[group.mark], "DIMENSIONS") if "%%c" in text)
        assert written == Counter(f"{hole.station:.1f}" for hole in group.master.blank.holes)


def test_the_chain_of_dimensions_adds_up_to_the_length(
    documents: dict[str, Drawing], groups: tuple[DrillGroup, ...]
) -> None:
    for group in groups:
        items = documents[group.mark].modelspace().query('DIMENSION[layer=="DIMENSIONS"]')
        for side in (1.0, -1.0):
            chain = [item for item in items if item.dxf.defpoint.y * side > 0.0]
            written = [float(item.dxf.text) for item in chain]
            assert not chain or math.isclose(sum(written), round(group.master.blank.length, 1), abs_tol=1e-6)
            # Differences of two printed stations.
            assert written == pytest.approx([item.get_measurement() for item in chain], abs=0.1001)


def test_the_check_bar_is_a_hundred_millimetres(documents: dict[str, Drawing]) -> None:
    for document in documents.values():
        lines = document.modelspace().query('LINE[layer=="CHECK_BAR"]')
        assert max((line.dxf.end - line.dxf.start).magnitude for line in lines) == pytest.approx(100.0, abs=1e-9)
        assert texts(document, "CHECK_BAR") == ["check bar 100 mm"]


def test_every_hole_is_marked_with_the_joint_of_the_drawn_plank(
    documents: dict[str, Drawing], groups: tuple[DrillGroup, ...]
) -> None:
    for group in groups:
        marked = Counter(text.split(" ")[0] for text in texts(documents[group.mark], "MARKS"))
        joints = Counter(hole.joint.removeprefix("S1-") for hole in group.master.blank.holes)
        assert joints <= marked
        assert joints.total() + 3 == marked.total(), "and START, END and the mark of the template"


def test_a_hole_that_serves_many_joints_names_the_first_and_how_many_follow() -> None:
    assert joint_names(["S1-K-001", "S2-K-001", "S3-K-001"]) == ("K-001",)
    assert joint_names(["S1-K-001", "S1-K-049", "S2-K-001"]) == ("K-001", "K-049")
    assert joint_names(["R12-01", "R23-01", "R31-01"]) == ("R12-01", "+ 2")


def test_a_slot_is_an_obround_of_its_length(gridshell: Gridshell, shell: Shell, tmp_path: Path) -> None:
    """Its area is that of a circle and a rectangle: pi d^2 / 4 + slot d."""
    group = redrilled(shell.planks[0], slot=6.0)
    document = reread(group, gridshell, tmp_path)
    (slot,) = document.modelspace().query(f'LWPOLYLINE[layer=="{HOLE_LAYERS["bolt"]}"]')
    points = np.array([(p.x, p.y) for p in make_path(slot).flattening(1e-4)])
    x, y = points[:, 0] - points[0, 0], points[:, 1] - points[0, 1]
    area = 0.5 * abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    hole = group.master.blank.holes[0]
    assert area == pytest.approx(math.pi / 4.0 * hole.diameter**2 + 6.0 * hole.diameter, abs=0.05)
    assert np.allclose(np.ptp(points, axis=0), (hole.diameter + 6.0, hole.diameter), atol=1e-3)
    middle = (points.min(axis=0) + points.max(axis=0)) / 2.0
    assert np.allclose(middle, (hole.station, hole.offset), atol=1e-3)
    assert any("slot +6" in text for text in texts(document, "DIMENSIONS"))


def test_a_plank_without_holes_is_drawn_as_well(gridshell: Gridshell, shell: Shell, tmp_path: Path) -> None:
    bare = replace(shell.planks[0], blank=replace(shell.planks[0].blank, holes=()))
    (group,) = drill_groups([bare])
    assert any("holes none" in text for text in texts(reread(group, gridshell, tmp_path), "TITLE"))


def test_the_same_gridshell_gives_the_same_bytes(gridshell: Gridshell, folder: Path, tmp_path: Path) -> None:
    before = ezdxf.options.write_fixed_meta_data_for_testing
    write_blank_dxfs(gridshell, tmp_path)
    for path in sorted(folder.iterdir()):
        assert (tmp_path / path.name).read_bytes() == path.read_bytes()
    assert ezdxf.options.write_fixed_meta_data_for_testing == before


@given(st.lists(st.floats(0.0, 500.0), max_size=30).map(sorted), st.floats(0.5, 20.0))
def test_texts_are_spread_in_order_with_room_between_and_no_drift(wanted: list[float], gap: float) -> None:
    places = spread(wanted, gap)
    assert len(places) == len(wanted)
    assert all(b - a >= gap - 1e-9 for a, b in pairwise(places))
    assert math.isclose(sum(places), sum(wanted), abs_tol=1e-6)
    if all(b - a >= gap for a, b in pairwise(wanted)):
        assert np.allclose(places, wanted, atol=1e-9)


def test_a_drawing_has_the_same_bytes_whatever_the_hash_seed() -> None:
    """The library registers classes in the order of a set, which the seed of the process turns about."""
    code = (
        "import sys; from aag_cad.export.workshop.dxf import dxf_bytes; "
        "from aag_cad.export.workshop.blank_drawings import Dimension, Drawing, Line; "
        "items = (Line('OUTLINE', (0.0, 0.0), (9.0, 5.0)), "
        "Dimension('DIMENSIONS', (0.0, 0.0), (9.0, 0.0), 14.0, '9.0', (4.5, 10.0))); "
        "sys.stdout.buffer.write(dxf_bytes(Drawing('T-01', items, (0.0, 0.0, 9.0, 14.0))))"
    )
    written = {
        subprocess.run(
            [sys.executable, "-c", code], check=True, capture_output=True, env={**os.environ, "PYTHONHASHSEED": seed}
        ).stdout
        for seed in ("0", "1", "2", "3", "4", "5")
    }
    (one,) = written
    assert b"ACDBPLACEHOLDER" in one
