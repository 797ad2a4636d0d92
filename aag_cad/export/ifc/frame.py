"""The frame of an IFC file: header, units, contexts, owner, placements and GUIDs."""

import uuid
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeAlias

import ifcopenshell
import ifcopenshell.guid

from aag_cad import __version__
from aag_cad.export.ifc.options import IfcOptions, IfcSchema, view_definition
from aag_cad.export.ifc.schemas import known
from aag_cad.parts.forms import Frame
from aag_cad.parts.model import Gridshell
from aag_cad.units import Vector

Entity: TypeAlias = ifcopenshell.entity_instance

# A file must not change when nothing but the day has changed.
TIMESTAMP = "2000-01-01T00:00:00"
_TIMESTAMP_SECONDS = 946_684_800
_NAMESPACE = uuid.uuid5(uuid.NAMESPACE_DNS, "aag-toolkit")
_ORIGIN = (0.0, 0.0, 0.0)
_TOOLKIT = "AAG toolkit"


@dataclass(frozen=True, eq=False)
class IfcModel:
    """An open file with what every entity needs: the project's id, the contexts, the shared identity placement.

    ``owner`` is the owner history that IFC2X3 demands of every rooted entity; None in later schemas.
    """

    file: ifcopenshell.file
    options: IfcOptions
    project_id: uuid.UUID
    owner: Entity | None
    project: Entity
    context: Entity
    body: Entity
    axis: Entity
    identity: Entity

    def new(self, entity: str, *values: object, **attributes: object) -> Entity:
        """Write an entity with its first attributes in their order and others by name; RuntimeError if one is unknown.

        ``file.create_entity`` takes twice as long: it looks for transactions and writes what is empty as empty again.
        """
        made = self.file.create(entity, -1)
        for i, value in enumerate(values):
            if value is not None:
                made.set_attribute_value_py(i, value)
        for name, value in attributes.items():
            made.set_attribute_value_py(made.get_argument_index(name), value)
        return made

    @property
    def schema(self) -> IfcSchema:
        """The schema that the file follows."""
        return self.options.schema


def project_id(name: str) -> uuid.UUID:
    """Return the id that all GUIDs of a project's files derive from."""
    return uuid.uuid5(_NAMESPACE, name)


def guid(project: uuid.UUID, *names: str) -> str:
    """Return the compressed GUID of what the names say, e.g. a mark, or ("type", product key)."""
    return str(ifcopenshell.guid.compress(uuid.uuid5(project, "/".join(names)).hex))


def rooted(model: IfcModel, entity: str, names: tuple[str, ...], *values: object, **attributes: object) -> Entity:
    """Write a rooted entity whose GUID derives from ``names``; values and attributes follow its owner history.

    Attributes that the schema does not have are left out.
    """
    return model.new(
        entity, guid(model.project_id, *names), model.owner, *values, **known(model.schema, entity, **attributes)
    )


def _fill_header(file: ifcopenshell.file, gridshell: Gridshell, options: IfcOptions) -> None:
    file.header.file_description.description = (view_definition(options),)
    name = file.header.file_name
    name.name = f"{gridshell.name}.ifc"
    name.time_stamp = TIMESTAMP
    name.author = (options.author or _TOOLKIT,)
    name.organization = (options.organisation or _TOOLKIT,)
    name.preprocessor_version = f"IfcOpenShell {ifcopenshell.version}"
    name.originating_system = f"{_TOOLKIT} - aag-toolkit - {__version__}"
    name.authorization = "none"


def _owner(file: ifcopenshell.file, options: IfcOptions) -> Entity | None:
    if options.schema != "IFC2X3":
        return None
    organisation = file.create_entity("IfcOrganization", Name=options.organisation or _TOOLKIT)
    person = file.create_entity("IfcPerson", FamilyName=options.author or _TOOLKIT)
    user = file.create_entity("IfcPersonAndOrganization", person, organisation)
    application = file.create_entity("IfcApplication", organisation, __version__, _TOOLKIT, "aag-toolkit")
    return file.create_entity(
        "IfcOwnerHistory", user, application, ChangeAction="ADDED", CreationDate=_TIMESTAMP_SECONDS
    )


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


def start_file(gridshell: Gridshell, options: IfcOptions) -> IfcModel:
    """Return a new file with header, project, units and contexts."""
    file = ifcopenshell.file(schema=options.schema)
    _fill_header(file, gridshell, options)
    owner, ident = _owner(file, options), project_id(gridshell.name)
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
        "IfcProject", guid(ident, "project"), owner, gridshell.name, LongName=gridshell.title,
        RepresentationContexts=[context], UnitsInContext=_units(file),
    )  # fmt: skip
    return IfcModel(file, options, ident, owner, project, context, body, axis, identity)


def _rounded(values: Vector, digits: int) -> Vector:
    x, y, z = (round(value, digits) + 0.0 for value in values)
    return x, y, z


def local_placement(model: IfcModel, parent: Entity | None, frame: Frame | None = None) -> Entity:
    """Return a placement relative to the parent's; the parent's own origin and axes if no frame is given.

    Origins are rounded to 1e-4 mm and directions to 1e-9.
    """
    place = model.identity
    if frame is not None:
        place = model.new(
            "IfcAxis2Placement3D",
            model.new("IfcCartesianPoint", _rounded(frame.origin, 4)),
            model.new("IfcDirection", _rounded(frame.z, 9)),
            model.new("IfcDirection", _rounded(frame.x, 9)),
        )
    return model.new("IfcLocalPlacement", parent, place)


def aggregate(model: IfcModel, name: str, whole: Entity, parts: Iterable[Entity]) -> None:
    """Write that a whole consists of its parts, if it has any."""
    if related := list(parts):
        rooted(model, "IfcRelAggregates", ("aggregates", name), None, None, whole, related)


def declare(model: IfcModel, name: str, definitions: list[Entity]) -> None:
    """Declare definitions in the project, if there are any and the schema knows declarations."""
    if definitions and model.schema != "IFC2X3":
        rooted(model, "IfcRelDeclares", ("declares", name), None, None, model.project, definitions)
