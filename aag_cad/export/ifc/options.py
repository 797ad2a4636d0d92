"""What can be asked of an IFC file: schema and bodies; no IFC library."""

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

from aag_cad.design_tables import Site
from aag_cad.errors import DesignError

IfcSchema: TypeAlias = Literal["IFC4", "IFC4X3_ADD2", "IFC2X3"]
IfcGeometry: TypeAlias = Literal["mesh", "brep"]
IFC_SCHEMAS: tuple[IfcSchema, ...] = get_args(IfcSchema)
IFC_GEOMETRIES: tuple[IfcGeometry, ...] = get_args(IfcGeometry)

# The Reference View leaves out bodies of B-spline surfaces: with them a file can only follow the Design Transfer View.
_VIEWS: dict[tuple[IfcSchema, IfcGeometry], str] = {
    ("IFC2X3", "mesh"): "CoordinationView_V2.0",
    ("IFC4", "mesh"): "ReferenceView_V1.2",
    ("IFC4", "brep"): "DesignTransferView_V1.0",
    ("IFC4X3_ADD2", "mesh"): "ReferenceView",
    ("IFC4X3_ADD2", "brep"): "DesignTransferView",
}


@dataclass(frozen=True)
class IfcOptions:
    """How an IFC file is written: schema, bodies of planks, where it stands, who made it.

    ``geometry`` "brep" gives planks and bars B-spline faces in place of triangles.
    """

    schema: IfcSchema = "IFC4"
    geometry: IfcGeometry = "mesh"
    site: Site | None = None
    author: str = ""
    organisation: str = ""


def require_known(options: IfcOptions) -> None:
    """Raise DesignError if no file can be written with these options."""
    if options.schema not in IFC_SCHEMAS:
        raise DesignError(f"--ifc-schema: {options.schema!r} is not written; choose {', '.join(IFC_SCHEMAS)}")
    if options.geometry not in IFC_GEOMETRIES:
        raise DesignError(f"--ifc-geometry: {options.geometry!r} is not written; choose {', '.join(IFC_GEOMETRIES)}")
    if (options.schema, options.geometry) not in _VIEWS:
        raise DesignError(
            f"--ifc-geometry: {options.schema} has no B-spline faces; choose mesh, or --ifc-schema IFC4 or IFC4X3_ADD2"
        )


def view_definition(options: IfcOptions) -> str:
    """Return the view definition as it stands in the header of the file."""
    return f"ViewDefinition [{_VIEWS[options.schema, options.geometry]}]"
