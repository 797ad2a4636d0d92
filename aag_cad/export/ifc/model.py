"""The gridshell as an IFC file: vault > shell > coupled beam > part, with all that joins them and when it is built."""

import os
from collections.abc import Mapping, Sequence

from aag_cad.export.ifc.assembly_sets import write_assembly_sets
from aag_cad.export.ifc.bodies import mapped_shape
from aag_cad.export.ifc.frame import Entity, IfcModel, aggregate, local_placement, rooted, start_file
from aag_cad.export.ifc.joints import write_joints
from aag_cad.export.ifc.materials import associate_materials
from aag_cad.export.ifc.options import IfcOptions, IfcSchema, require_known
from aag_cad.export.ifc.properties import write_fabrication
from aag_cad.export.ifc.schedule import PlannedWork, write_schedule
from aag_cad.export.ifc.schemas import known, type_word
from aag_cad.export.ifc.site import spatial_tree
from aag_cad.export.ifc.standard_sets import write_product_sets, write_serial_numbers
from aag_cad.export.ifc.types import Product, define_types, products
from aag_cad.files import replacing
from aag_cad.parts.forms import Frame
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import kind_of
from aag_cad.parts.model import Gridshell, Part, Shell, all_joints, all_parts, ridge_parts, shell_parts
from aag_cad.parts.products import part_frame
from aag_cad.shop.groups import templates_of

__all__ = ["IfcOptions", "IfcSchema", "ifc_model", "write_ifc"]

# Not the gridshell's name: that could be the word for another entity, such as "site".
_VAULT = "gridshell"


def _assembly(
    model: IfcModel, ident: str, mark: str, title: str, place: str, parent: Entity, frame: Frame | None = None
) -> Entity:
    return rooted(
        model, "IfcElementAssembly", (ident,), mark, None, title, local_placement(model, parent, frame),
        Tag=mark, AssemblyPlace=place, PredefinedType="USERDEFINED",
    )  # fmt: skip


def _occurrence(model: IfcModel, part: Part, product: Product, parent: Entity, unmoved: Entity) -> Entity:
    kind = kind_of(part).ifc
    # Its type says what it is; only footings of IFC2X3 have to say so themselves.
    own = known("IFC2X3", kind.entity, PredefinedType=kind.predefined) if model.schema == "IFC2X3" else {}
    return rooted(
        model, kind.entity, (part.mark,), part.mark, None, type_word(model.schema, kind),
        local_placement(model, parent, part_frame(part)), mapped_shape(model, product.maps, unmoved), part.mark, **own,
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
    home, elements = index_of(shell).beam_of, {}
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
    unmoved = model.new("IfcCartesianTransformationOperator3D", LocalOrigin=origin)
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
    rooted(model, "IfcRelContainedInSpatialStructure", ("contained",), None, None, [vault], storey)
    return elements


def _write_sets(
    model: IfcModel, gridshell: Gridshell, found: Sequence[Product], elements: Mapping[str, Entity]
) -> None:
    """Write the property and quantity sets of all parts."""
    planks, timber = tuple(index_of(gridshell).planks.values()), gridshell.timber
    groups = {member.mark: group.mark for group in templates_of(gridshell) for member in group.members}
    for product in found:
        write_product_sets(model, product.key, product.parts, elements, timber)
    write_fabrication(model, [(product.key, product.parts) for product in found], elements, timber, groups)
    write_serial_numbers(model, planks, elements, groups)


def ifc_model(gridshell: Gridshell, work: PlannedWork | None = None, options: IfcOptions | None = None) -> IfcModel:
    """Return the gridshell as an open IFC file; the steps of a plan become a work schedule.

    IFC2X3 has no task times: there the steps are only named in the set ``AAG_Assembly``. DesignError if the options do
    not go together.
    """
    options = options or IfcOptions()
    require_known(options)
    model = start_file(gridshell, options)
    storey = spatial_tree(model, gridshell)
    parts = all_parts(gridshell)
    found = products(model, gridshell)
    product_of = {part.mark: product for product in found for part in product.parts}
    elements = _write_vault(model, gridshell, storey, product_of)
    define_types(model, found, elements)
    associate_materials(model, found, elements, gridshell.timber)
    _write_sets(model, gridshell, found, elements)
    write_assembly_sets(model, parts, elements, work)
    write_joints(model, all_joints(gridshell), index_of(gridshell).parts, elements)
    if work is not None and options.schema != "IFC2X3":
        write_schedule(model, gridshell.name, work, elements)
    return model


def write_ifc(
    gridshell: Gridshell,
    path: str | os.PathLike[str],
    work: PlannedWork | None = None,
    options: IfcOptions | None = None,
) -> None:
    """Write the gridshell, and the steps of its plan as a work schedule; FileError if the file cannot be written.

    The bodies are planks without holes: hole tables are in the property set ``AAG_Fabrication``. DesignError if the
    options do not go together.
    """
    model = ifc_model(gridshell, work, options)
    with replacing(path) as draft:
        draft.write_text(model.file.to_string(), encoding="utf-8", newline="\n")
