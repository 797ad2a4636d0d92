"""STEP AP242: the vault as an assembly of shells, coupled beams and parts, with exact solids, marks and colours."""

import os
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDF import TDF_Label
from OCP.TDocStd import TDocStd_Document
from OCP.TopoDS import TopoDS_Solid
from OCP.XCAFDoc import XCAFDoc_ColorTool, XCAFDoc_ColorType, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from aag_cad.export.cad.step_text import kernel_settings, named, placement, step_bytes
from aag_cad.files import write_bytes
from aag_cad.parts.forms import Frame
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import colour
from aag_cad.parts.model import Gridshell, Shell, ridge_parts, shell_parts
from aag_cad.parts.products import part_frame, product_name
from aag_cad.solids.products import product_solids


def write_step(gridshell: Gridshell, path: str | os.PathLike[str]) -> None:
    """Write the gridshell as STEP AP242 in mm, vault > shell > coupled beam > part; the same model gives equal bytes.

    Equal products are one product in the file, each placed under its mark. Colours stand in ``COLOUR_RGB`` as sRGB
    numbers, which readers show as they are; the kernel itself reckons with linear ones.
    SolidError names the mark whose solid is invalid; FileError if the file cannot be written.
    """
    solids = product_solids(gridshell)
    with kernel_settings():
        data = step_bytes(_document(gridshell, solids), gridshell.name, "Timber gridshell, formed planks")
    write_bytes(path, data)


@dataclass(frozen=True, eq=False)
class _Tools:
    """The tools of one document for its shapes and for their colours."""

    shapes: XCAFDoc_ShapeTool
    colours: XCAFDoc_ColorTool


def _document(gridshell: Gridshell, solids: Mapping[str, TopoDS_Solid]) -> TDocStd_Document:
    document = TDocStd_Document(TCollection_ExtendedString("XmlOcaf"))
    main = document.Main()
    tools = _Tools(XCAFDoc_DocumentTool.ShapeTool_s(main), XCAFDoc_DocumentTool.ColorTool_s(main))
    vault = _assembly(tools, gridshell.title)
    products = _products(tools, gridshell, solids)
    for shell in gridshell.shells:
        _add(tools, vault, _shell(tools, shell, products), shell.placement, shell.mark)
    for part in ridge_parts(gridshell):
        _add(tools, vault, products[part.mark], part_frame(part), part.mark)
    tools.shapes.UpdateAssemblies()
    return document


def _products(tools: _Tools, gridshell: Gridshell, solids: Mapping[str, TopoDS_Solid]) -> dict[str, TDF_Label]:
    """Return the product's label of each part by its mark; products of one name but different make are numbered."""
    labels: dict[str, TDF_Label] = {}
    taken: Counter[str] = Counter()
    index = index_of(gridshell)
    for mark, key in index.keys.items():
        if key in labels:
            continue
        name = product_name(part := index.parts[mark])
        taken[name] += 1
        labels[key] = tools.shapes.AddShape(solids[key], False, False)
        named(labels[key], name if taken[name] == 1 else f"{name} ({taken[name]})")
        tint = Quantity_Color(*colour(part), Quantity_TypeOfColor.Quantity_TOC_sRGB)
        tools.colours.SetColor(labels[key], tint, XCAFDoc_ColorType.XCAFDoc_ColorSurf)
    return {mark: labels[key] for mark, key in index.keys.items()}


def _shell(tools: _Tools, shell: Shell, products: Mapping[str, TDF_Label]) -> TDF_Label:
    whole = _assembly(tools, f"Shell {shell.mark}")
    beams = {beam.mark: _assembly(tools, f"Coupled beam {beam.mark}") for beam in shell.beams}
    home = index_of(shell).beam_of
    for part in shell_parts(shell):
        parent = beams[home[part.mark]] if part.mark in home else whole
        _add(tools, parent, products[part.mark], part_frame(part), part.mark)
    for mark, beam in beams.items():
        _add(tools, whole, beam, None, mark)
    return whole


def _assembly(tools: _Tools, name: str) -> TDF_Label:
    label = tools.shapes.NewShape()
    named(label, name)
    return label


def _add(tools: _Tools, parent: TDF_Label, child: TDF_Label, frame: Frame | None, mark: str) -> None:
    named(tools.shapes.AddComponent(parent, child, placement(frame)), mark)
