"""The frame of an IFC4 Reference View file: header, units, contexts, spatial tree and GUIDs."""

import uuid
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeAlias

import ifcopenshell
import ifcopenshell.guid

from aag_cad import __version__
from aag_cad.parts.model import Frame, Gridshell
from aag_cad.units import Vector

Entity: TypeAlias = ifcopenshell.entity_instance

# A file must not change when nothing but the day has changed.
TIMESTAMP = "2000-01-01T00:00:00"
_NAMESPACE = uuid.uuid5(uuid.NAMESPACE_DNS, "aag-toolkit")
_ORIGIN = (0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class IfcModel:
    """An open file with what every entity needs: the project's id, the contexts, the shared identity placement."""

    file: ifcopenshell.file
    project_id: uuid.UUID
    project: Entity
    body: Entity
    axis: Entity
    identity: Entity


def project_id(name: str) -> uuid.UUID:
    """Return the id that all GUIDs of a project's files derive from."""
    return uuid.uuid5(_NAMESPACE, name)


def guid(project: uuid.UUID, *names: str) -> str:
    """Return the compressed GUID of what the names say, e.g. a mark, or ("type", product key)."""
    return str(ifcopenshell.guid.compress(uuid.uuid5(project, "/".join(names)).hex))


def _fill_header(file: ifcopenshell.file, gridshell: Gridshell) -> None:
    file.header.file_description.description = ("ViewDefinition [ReferenceView_V1.2]",)
    name = file.header.file_name
    name.name = f"{gridshell.name}.ifc"
    name.time_stamp = TIMESTAMP
    name.author = ("AAG toolkit",)
    name.organization = ("AAG toolkit",)
    name.preprocessor_version = f"IfcOpenShell {ifcopenshell.version}"
    name.originating_system = f"AAG toolkit - aag-toolkit - {__version__}"
    name.authorization = "none"


def _units(file: ifcopenshell.file) -> Entity:
    """Return the unit assignment: mm, m2, m3, radians, kg, N/mm2, kg/m3."""
    metre = file.create_entity("IfcSIUnit", None, "LENGTHUNIT", None, "METRE")
    kilogram = file.create_entity("IfcSIUnit", None, "MASSUNIT", "KILO", "GRAM")
    elements = [(kilogram, 1), (metre, -3)]
    return file.create_entity(
        "IfcUnitAssignment",
        [
            file.create_entity("IfcSIUnit", None, "LENGTHUNIT", "MILLI", "METRE"),
            file.create_entity("IfcSIUnit", None, "AREAUNIT", None, "SQUARE_METRE"),
            file.create_entity("IfcSIUnit", None, "VOLUMEUNIT", None, "CUBIC_METRE"),
            file.create_entity("IfcSIUnit", None, "PLANEANGLEUNIT", None, "RADIAN"),
            kilogram,
            file.create_entity("IfcSIUnit", None, "PRESSUREUNIT", "MEGA", "PASCAL"),
            file.create_entity(
                "IfcDerivedUnit",
                [file.create_entity("IfcDerivedUnitElement", unit, exponent) for unit, exponent in elements],
                "MASSDENSITYUNIT",
            ),
        ],
    )


def start_file(gridshell: Gridshell) -> IfcModel:
    """Return a new file with header, project, units and contexts."""
    file = ifcopenshell.file(schema="IFC4")
    _fill_header(file, gridshell)
    ident = project_id(gridshell.name)
    identity = file.create_entity("IfcAxis2Placement3D", file.create_entity("IfcCartesianPoint", _ORIGIN))
    context = file.create_entity("IfcGeometricRepresentationContext", None, "Model", 3, 1e-3, identity)
    body, axis = (
        file.create_entity(
            "IfcGeometricRepresentationSubContext", name, "Model",
            ParentContext=context, TargetView=view,
        )
        for name, view in (("Body", "MODEL_VIEW"), ("Axis", "GRAPH_VIEW"))
    )  # fmt: skip
    project = file.create_entity(
        "IfcProject", guid(ident, "project"), None, gridshell.name, LongName=gridshell.title,
        RepresentationContexts=[context], UnitsInContext=_units(file),
    )  # fmt: skip
    return IfcModel(file, ident, project, body, axis, identity)


def _rounded(values: Vector, digits: int) -> Vector:
    x, y, z = (round(value, digits) + 0.0 for value in values)
    return x, y, z


def local_placement(model: IfcModel, parent: Entity | None, frame: Frame | None = None) -> Entity:
    """Return a placement relative to the parent's; the parent's own origin and axes if no frame is given.

    Origins are rounded to 1e-4 mm and directions to 1e-9.
    """
    place = model.identity
    if frame is not None:
        place = model.file.create_entity(
            "IfcAxis2Placement3D",
            model.file.create_entity("IfcCartesianPoint", _rounded(frame.origin, 4)),
            model.file.create_entity("IfcDirection", _rounded(frame.z, 9)),
            model.file.create_entity("IfcDirection", _rounded(frame.x, 9)),
        )
    return model.file.create_entity("IfcLocalPlacement", parent, place)


def aggregate(model: IfcModel, name: str, whole: Entity, parts: Iterable[Entity]) -> None:
    """Write that a whole consists of its parts, if it has any."""
    if related := list(parts):
        model.file.create_entity(
            "IfcRelAggregates", guid(model.project_id, "aggregates", name), None, None, None, whole, related
        )


def spatial_tree(model: IfcModel, gridshell: Gridshell) -> Entity:
    """Write site, building and storey, and return the storey; its origin is that of the vault."""
    site_at = local_placement(model, None)
    site = model.file.create_entity(
        "IfcSite", guid(model.project_id, "site"), None, "Site", ObjectPlacement=site_at, CompositionType="ELEMENT"
    )
    building_at = local_placement(model, site_at)
    building = model.file.create_entity(
        "IfcBuilding", guid(model.project_id, "building"), None, gridshell.title,
        ObjectPlacement=building_at, CompositionType="ELEMENT", ElevationOfTerrain=gridshell.ground,
    )  # fmt: skip
    storey = model.file.create_entity(
        "IfcBuildingStorey", guid(model.project_id, "storey"), None, "Ground floor",
        ObjectPlacement=local_placement(model, building_at), CompositionType="ELEMENT", Elevation=0.0,
    )  # fmt: skip
    aggregate(model, "project", model.project, [site])
    aggregate(model, "site", site, [building])
    aggregate(model, "building", building, [storey])
    return storey
