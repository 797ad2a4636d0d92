"""Site, building and storey of an IFC file, and where the site lies on the map."""

import math

from aag_cad.design_tables import Site
from aag_cad.export.ifc.frame import Entity, IfcModel, aggregate, local_placement, rooted
from aag_cad.export.ifc.sets import Property, write_property_set
from aag_cad.parts.model import Gridshell
from aag_cad.units import MM_PER_M

_MM_IN_M = 0.001
_MILLIONTHS = 1_000_000


def degrees_minutes_seconds(angle_deg: float) -> tuple[int, int, int, int]:
    """Return an angle as degrees, minutes, seconds and millionths of a second, all of one sign."""
    sign = -1 if angle_deg < 0.0 else 1
    whole = round(abs(angle_deg) * 3600.0 * _MILLIONTHS)
    seconds, millionths = divmod(whole, _MILLIONTHS)
    minutes, seconds = divmod(seconds, 60)
    degrees, minutes = divmod(minutes, 60)
    return sign * degrees, sign * minutes, sign * seconds, sign * millionths


def _turned(angle_deg: float) -> tuple[float, float]:
    """Return the unit vector at an angle from the first axis."""
    angle = math.radians(angle_deg)
    return round(math.cos(angle), 12) + 0.0, round(math.sin(angle), 12) + 0.0


def true_north(site: Site) -> tuple[float, float] | None:
    """Return the direction of true north in vault coordinates; None if the site says nothing about it."""
    if site.true_north_deg is not None:
        return _turned(90.0 + site.true_north_deg)
    return None if site.epsg is None else _turned(90.0 - site.rotation_deg)


def _map_conversion(model: IfcModel, site: Site) -> None:
    """Write where vault coordinates lie in the projected system, whose unit is the metre."""
    metre = model.new("IfcSIUnit", None, "LENGTHUNIT", None, "METRE")
    name, (abscissa, ordinate) = f"EPSG:{site.epsg}", _turned(site.rotation_deg)
    if model.schema == "IFC2X3":
        _map_conversion_sets(model, site, metre)
        return
    target = model.new("IfcProjectedCRS", name, site.crs_name, VerticalDatum=site.vertical_datum, MapUnit=metre)
    model.new(
        "IfcMapConversion", model.context, target, site.eastings, site.northings, site.height, abscissa, ordinate,
        _MM_IN_M,
    )  # fmt: skip


def _map_conversion_sets(model: IfcModel, site: Site, metre: Entity) -> None:
    """Write the conversion as the two property sets that stand for it in IFC2X3."""
    abscissa, ordinate = _turned(site.rotation_deg)
    system: list[Property] = [("Name", "IfcLabel", f"EPSG:{site.epsg}"), ("MapUnit", "IfcLabel", "METRE")]
    named = (("Description", site.crs_name), ("VerticalDatum", site.vertical_datum))
    system += [(key, "IfcLabel", text) for key, text in named if text is not None]
    lengths = (("Eastings", site.eastings), ("Northings", site.northings), ("OrthogonalHeight", site.height))
    rest: list[Property] = [
        ("XAxisAbscissa", "IfcReal", abscissa),
        ("XAxisOrdinate", "IfcReal", ordinate),
        ("Scale", "IfcReal", _MM_IN_M),
    ]
    write_property_set(model, "ePSet_ProjectedCRS", "project", system, [model.project])
    definition = write_property_set(model, "ePSet_MapConversion", "project", rest, [model.project])
    measured = [
        model.new("IfcPropertySingleValue", key, None, model.new("IfcLengthMeasure", value), metre)
        for key, value in lengths
    ]
    definition.HasProperties = [*measured, *definition.HasProperties]


def _georeference(model: IfcModel, site: Site) -> None:
    north = true_north(site)
    if north is not None:
        model.context.TrueNorth = model.new("IfcDirection", north)
    if site.epsg is not None:
        _map_conversion(model, site)


def _site(model: IfcModel, site: Site) -> Entity:
    where: dict[str, object] = {}
    if site.latitude_deg is not None and site.longitude_deg is not None:
        where = {
            "RefLatitude": degrees_minutes_seconds(site.latitude_deg),
            "RefLongitude": degrees_minutes_seconds(site.longitude_deg),
        }
    if site.epsg is not None:
        where["RefElevation"] = round(site.height * MM_PER_M, 3) + 0.0
    return rooted(
        model, "IfcSite", ("site",), site.name, ObjectPlacement=local_placement(model, None), CompositionType="ELEMENT",
        **where,
    )  # fmt: skip


def _building(model: IfcModel, site: Site, gridshell: Gridshell, placement: Entity) -> Entity:
    """Write the building; IFC4X3 has the height of the ground and the address in property sets."""
    later = model.schema == "IFC4X3_ADD2"
    attributes: dict[str, object] = {} if later else {"ElevationOfTerrain": gridshell.ground}
    if site.address and not later:
        attributes["BuildingAddress"] = model.new("IfcPostalAddress", AddressLines=site.address)
    building = rooted(
        model, "IfcBuilding", ("building",), site.building or gridshell.title,
        ObjectPlacement=local_placement(model, placement), CompositionType="ELEMENT", **attributes,
    )  # fmt: skip
    if later:
        terrain: list[Property] = [("ElevationOfTerrain", "IfcLengthMeasure", gridshell.ground)]
        write_property_set(model, "Pset_BuildingCommon", "building", terrain, [building])
        if site.address:
            lines: list[Property] = [("AddressLines", "IfcLabel", site.address)]
            write_property_set(model, "Pset_Address", "building", lines, [building])
    return building


def spatial_tree(model: IfcModel, gridshell: Gridshell) -> Entity:
    """Write site, building and storey with the georeference, and return the storey; its origin is the vault's."""
    given = model.options.site or Site()
    _georeference(model, given)
    site = _site(model, given)
    building = _building(model, given, gridshell, site.ObjectPlacement)
    storey = rooted(
        model, "IfcBuildingStorey", ("storey",), "Ground floor", CompositionType="ELEMENT",
        ObjectPlacement=local_placement(model, building.ObjectPlacement),
        **({} if model.schema == "IFC4X3_ADD2" else {"Elevation": 0.0}),
    )  # fmt: skip
    aggregate(model, "project", model.project, [site])
    aggregate(model, "site", site, [building])
    aggregate(model, "building", building, [storey])
    return storey
