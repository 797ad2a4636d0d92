"""The gridshell as binary glTF: metres, y up, one mesh for each product, one node named by mark for each part."""

import os
from typing import Any

import numpy as np
import trimesh
from trimesh.visual.material import PBRMaterial

from aag_cad.colours import LEGEND, linear
from aag_cad.files import write_bytes
from aag_cad.parts.forms import Frame
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import colour_name, kind_of
from aag_cad.parts.mesh import frame_matrix, product_mesh
from aag_cad.parts.model import Gridshell, Part, ridge_parts, shell_parts
from aag_cad.parts.products import part_frame, product_name
from aag_cad.parts.triangles import Mesh
from aag_cad.units import MM_PER_M, Floats

_ROOT = "world"
# Rotates z up to y up, as glTF asks for.
_Y_UP = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])


def matrix_in_metres(frame: Frame) -> Floats:
    """Return the (4, 4) matrix of a frame with its origin in metres."""
    matrix = frame_matrix(frame)
    matrix[:3, 3] /= MM_PER_M
    return matrix


def _material(part: Part) -> PBRMaterial:
    metal = kind_of(part).material in ("steel", "aluminium")
    return PBRMaterial(
        name=colour_name(part),
        metallicFactor=1.0 if metal else 0.0,
        roughnessFactor=0.4 if metal else 0.8,
    )


def _mesh_in_metres(mesh: Mesh, finish: PBRMaterial) -> trimesh.Trimesh:
    visual = trimesh.visual.TextureVisuals(material=finish)
    return trimesh.Trimesh(mesh.vertices / MM_PER_M, mesh.faces, visual=visual, process=False)


def glb_scene(gridshell: Gridshell) -> trimesh.Scene:
    """Return the scene: vault > shell > part, each node named by its mark."""
    scene = trimesh.Scene(base_frame=_ROOT)
    graph: Any = scene.graph
    graph.update(gridshell.name, _ROOT, matrix=_Y_UP)
    finishes: dict[str, PBRMaterial] = {}
    keys = index_of(gridshell).keys

    def add(part: Part, parent: str) -> None:
        name, frame = f"{product_name(part)} ({keys[part.mark]})", part_frame(part)
        if name not in scene.geometry:
            finish = finishes.setdefault(colour_name(part), _material(part))
            scene.geometry[name] = _mesh_in_metres(product_mesh(part), finish)
        graph.update(part.mark, parent, matrix=np.eye(4) if frame is None else matrix_in_metres(frame), geometry=name)

    for shell in gridshell.shells:
        graph.update(shell.mark, gridshell.name, matrix=matrix_in_metres(shell.placement))
        for part in shell_parts(shell):
            add(part, shell.mark)
    for part in ridge_parts(gridshell):
        add(part, gridshell.name)
    return scene


def _colour_materials(tree: dict[str, Any]) -> None:
    """Give each material of a glTF tree its colour: linear numbers, which trimesh itself would round to 8 bits."""
    for finish in tree["materials"]:
        factor = [round(value, 6) for value in (*linear(LEGEND[finish["name"]]), 1.0)]
        finish["pbrMetallicRoughness"]["baseColorFactor"] = factor


def write_glb(gridshell: Gridshell, path: str | os.PathLike[str]) -> None:
    """Write the gridshell for viewers and slides; FileError if the file cannot be written.

    The meshes carry no normals: glTF asks viewers to shade such faces flat, which is what planks are. Its colours are
    linear intensities, which viewers turn into the sRGB codes of the legend.
    """
    scene = glb_scene(gridshell)
    data = scene.export(file_type="glb", include_normals=False, tree_postprocessor=_colour_materials)
    write_bytes(path, data)
