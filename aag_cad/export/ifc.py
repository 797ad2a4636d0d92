"""The gridshell as an IFC4 Reference View file: vault > shell > coupled beam > plank, with all that joins them."""

import os
from collections.abc import Mapping, Sequence

from aag_cad.export.ifc_base import Entity, IfcModel, aggregate, guid, local_placement, spatial_tree, start_file
from aag_cad.export.ifc_bodies import mapped_shape
from aag_cad.export.ifc_joints import write_joints
from aag_cad.export.ifc_kinds import IFC_KINDS
from aag_cad.export.ifc_properties import write_piece_sets, write_product_sets
from aag_cad.export.ifc_schedule import write_schedule
from aag_cad.export.ifc_types import Product, associate_materials, define_types, products
from aag_cad.files import replacing
from aag_cad.parts.assemblies import beam_of_parts
from aag_cad.parts.model import Frame, Gridshell, Part, Shell, all_joints, all_parts, ridge_parts, shell_parts
from aag_cad.parts.products import part_frame
from assembly.steps import Step

# Not the gridshell's name: that could be the word for another entity, such as "site".
_VAULT = "gridshell"


def _assembly(
    model: IfcModel, ident: str, mark: str, title: str, place: str, parent: Entity, frame: Frame | None = None
) -> Entity:
    return model.file.create_entity(
        "IfcElementAssembly", guid(model.project_id, ident), None, mark, None, title,
        local_placement(model, parent, frame), Tag=mark, AssemblyPlace=place, PredefinedType="USERDEFINED",
    )  # fmt: skip


def _occurrence(model: IfcModel, part: Part, product: Product, parent: Entity, unmoved: Entity) -> Entity:
    kind = IFC_KINDS[type(part)]
    return model.file.create_entity(
        kind.entity, guid(model.project_id, part.mark), None, part.mark, None, kind.element_type,
        local_placement(model, parent, part_frame(part)), mapped_shape(model, product.maps, unmoved), part.mark,
    )  # fmt: skip


def _write_shell(
    model: IfcModel, shell: Shell, vault: Entity, product_of: Mapping[str, Product], unmoved: Entity
) -> dict[str, Entity]:
    """Write a shell with its beams and parts and return all of them by mark, the shell first."""
    whole = _assembly(model, shell.mark, shell.mark, "Shell", "FACTORY", vault.ObjectPlacement, shell.placement)
    assemblies = {shell.mark: whole}
    children: dict[str, list[Entity]] = {shell.mark: []}
    for beam in shell.beams:
        assemblies[beam.mark] = _assembly(model, beam.mark, beam.mark, "Coupled beam", "FACTORY", whole.ObjectPlacement)
        children[beam.mark] = []
        children[shell.mark].append(assemblies[beam.mark])
    placements = {mark: assembly.ObjectPlacement for mark, assembly in assemblies.items()}
    home, elements = beam_of_parts(shell), {}
    for part in shell_parts(shell):
        mark = home.get(part.mark, shell.mark)
        elements[part.mark] = _occurrence(model, part, product_of[part.mark], placements[mark], unmoved)
        children[mark].append(elements[part.mark])
    for mark, parts in children.items():
        aggregate(model, mark, assemblies[mark], parts)
    return assemblies | elements


def _write_vault(
    model: IfcModel, gridshell: Gridshell, storey: Entity, product_of: Mapping[str, Product]
) -> dict[str, Entity]:
    """Write the vault, its shells and what joins them; return all elements by mark. Only the vault is in the storey."""
    origin = model.identity.Location
    unmoved = model.file.create_entity("IfcCartesianTransformationOperator3D", LocalOrigin=origin)
    vault = _assembly(model, _VAULT, gridshell.name, "Gridshell", "SITE", storey.ObjectPlacement)
    elements: dict[str, Entity] = {}
    for shell in gridshell.shells:
        elements |= _write_shell(model, shell, vault, product_of, unmoved)
    between = {
        part.mark: _occurrence(model, part, product_of[part.mark], vault.ObjectPlacement, unmoved)
        for part in ridge_parts(gridshell)
    }
    elements |= between
    aggregate(model, _VAULT, vault, [*(elements[shell.mark] for shell in gridshell.shells), *between.values()])
    model.file.create_entity(
        "IfcRelContainedInSpatialStructure", guid(model.project_id, "contained"), None, None, None, [vault], storey
    )
    return elements


def ifc_model(gridshell: Gridshell, steps: Sequence[Step] | None = None) -> IfcModel:
    """Return the gridshell as an open IFC file; the steps of a plan become a work schedule."""
    model = start_file(gridshell)
    storey = spatial_tree(model, gridshell)
    parts = all_parts(gridshell)
    found = products(model, parts)
    product_of = {part.mark: product for product in found for part in product.parts}
    elements = _write_vault(model, gridshell, storey, product_of)
    define_types(model, found, elements)
    associate_materials(model, found, elements, gridshell.timber)
    for product in found:
        write_product_sets(model, product.key, product.parts, elements, gridshell.timber)
    write_piece_sets(model, parts, elements)
    write_joints(model, all_joints(gridshell), {part.mark: part for part in parts}, elements)
    if steps is not None:
        write_schedule(model, gridshell.name, steps, elements)
    return model


def write_ifc(gridshell: Gridshell, path: str | os.PathLike[str], steps: Sequence[Step] | None = None) -> None:
    """Write the gridshell, and the steps of its plan as a work schedule; FileError if the file cannot be written.

    The bodies are planks without holes: hole tables are in the property set ``AAG_Fabrication``.
    """
    model = ifc_model(gridshell, steps)
    with replacing(path) as draft:
        draft.write_text(model.file.to_string(), encoding="utf-8", newline="\n")
