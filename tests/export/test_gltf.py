"""The GLB file, read back with trimesh, against the model that it was written from."""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from aag_cad.colours import LEGEND, linear
from aag_cad.errors import FileError
from aag_cad.export.cad.gltf import write_glb
from aag_cad.parts.kinds import colour_name
from aag_cad.parts.mesh import placed, product_mesh, shell_mesh
from aag_cad.parts.model import Gridshell, all_parts, ridge_parts, shell_parts
from aag_cad.parts.products import product_key


@pytest.fixture(scope="module")
def path(gridshell: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("glb") / "vault.glb"
    write_glb(gridshell, path)
    return path


@pytest.fixture(scope="module")
def scene(path: Path) -> trimesh.Scene:
    return trimesh.load_scene(path)


@pytest.fixture(scope="module")
def tree(path: Path) -> dict[str, Any]:
    """Give the JSON chunk of the file."""
    data = path.read_bytes()
    parsed: dict[str, Any] = json.loads(data[20 : 20 + struct.unpack("<I", data[12:16])[0]])
    return parsed


def test_every_part_is_a_node_under_its_mark(gridshell: Gridshell, scene: trimesh.Scene) -> None:
    assert sorted(scene.graph.nodes_geometry) == sorted(part.mark for part in all_parts(gridshell))


def test_equal_products_share_one_mesh(gridshell: Gridshell, scene: trimesh.Scene) -> None:
    assert len(scene.geometry) == len({product_key(part) for part in all_parts(gridshell)})
    assert len({scene.graph[f"S{shell}-G-07"][1] for shell in (1, 2, 3)}) == 1


def test_shells_stand_under_the_vault_and_parts_under_their_shell(gridshell: Gridshell, tree: dict[str, Any]) -> None:
    nodes = tree["nodes"]
    below = {node["name"]: {nodes[i]["name"] for i in node.get("children", ())} for node in nodes}
    assert below["vault"] == {"S1", "S2", "S3"} | {part.mark for part in ridge_parts(gridshell)}
    for shell in gridshell.shells:
        assert below[shell.mark] == {part.mark for part in shell_parts(shell)}


def test_parts_stand_in_metres_with_y_up(gridshell: Gridshell, scene: trimesh.Scene) -> None:
    """Coordinates are single precision: 1e-6 of 10 m, in mm 0.01."""
    for shell in gridshell.shells:
        for part in shell_parts(shell)[::5]:
            matrix, name = scene.graph[part.mark]
            found = trimesh.transform_points(scene.geometry[name].vertices, matrix) * 1000.0
            x, y, z = placed(shell_mesh(part), shell.placement).vertices.T
            np.testing.assert_allclose(found, np.column_stack([x, z, -y]), rtol=0, atol=0.01)


def test_meshes_are_closed_and_keep_their_volume(gridshell: Gridshell, scene: trimesh.Scene) -> None:
    """Single precision moves corners by some 1e-4 mm: 1e-4 of a plank 12 mm thick."""
    for part in {product_key(part): part for part in all_parts(gridshell)}.values():
        mesh = scene.geometry[scene.graph[part.mark][1]]
        assert mesh.is_watertight
        assert mesh.volume * 1e9 == pytest.approx(product_mesh(part).volume, rel=1e-4)


def test_base_colours_are_the_linear_intensities_of_the_legend(gridshell: Gridshell, tree: dict[str, Any]) -> None:
    """GlTF multiplies light with ``baseColorFactor``: viewers turn it back into the legend's sRGB codes."""
    found = {finish["name"]: finish["pbrMetallicRoughness"]["baseColorFactor"] for finish in tree["materials"]}
    assert found.keys() == {colour_name(part) for part in all_parts(gridshell)}
    for name, (red, green, blue, opaque) in found.items():
        shown = [1.055 * c ** (1.0 / 2.4) - 0.055 if c > 0.0031308 else 12.92 * c for c in (red, green, blue)]
        assert "#" + "".join(f"{round(255.0 * c):02x}" for c in shown) == LEGEND[name]
        assert opaque == 1.0


def test_a_reader_finds_the_colour_of_each_family_and_metal_on_bolts(
    gridshell: Gridshell, scene: trimesh.Scene
) -> None:
    for part in gridshell.shells[0].planks:
        finish = scene.geometry[scene.graph[part.mark][1]].visual.material
        # The reader rounds to 8 bits.
        assert finish.baseColorFactor[:3] / 255.0 == pytest.approx(linear(LEGEND[part.family]), abs=0.003)
        assert (finish.name, finish.metallicFactor) == (part.family, 0.0)
    assert scene.geometry[scene.graph["S1-N-001-B1"][1]].visual.material.metallicFactor == 1.0


def test_meshes_carry_no_normals_so_that_viewers_shade_them_flat(tree: dict[str, Any]) -> None:
    attributes = {name for mesh in tree["meshes"] for each in mesh["primitives"] for name in each["attributes"]}
    assert attributes == {"POSITION"}


def test_the_vault_takes_less_than_2_mb(path: Path) -> None:
    assert path.stat().st_size < 2e6


def test_the_same_gridshell_gives_the_same_bytes(gridshell: Gridshell, path: Path, tmp_path: Path) -> None:
    write_glb(gridshell, tmp_path / "other.glb")
    assert (tmp_path / "other.glb").read_bytes() == path.read_bytes()


def test_a_folder_that_cannot_be_written_is_named(gridshell: Gridshell, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("")
    with pytest.raises(FileError, match=r"vault\.glb"):
        write_glb(gridshell, tmp_path / "out" / "vault.glb")
