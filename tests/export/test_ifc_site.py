"""Where the IFC file says that the gridshell stands."""

import math
from dataclasses import replace

import ifcopenshell
import ifcopenshell.util.geolocation
import pytest
from pydantic import ValidationError

from aag_cad.design import Design
from aag_cad.design_tables import Site
from aag_cad.export.ifc.model import ifc_model
from aag_cad.export.ifc.options import IFC_SCHEMAS, IfcOptions, IfcSchema
from aag_cad.export.ifc.site import degrees_minutes_seconds, true_north
from aag_cad.parts.model import Gridshell

MEADOW = Site(
    name="Meadow",
    building="Pavilion",
    address=("1 Lane", "80333 Town"),
    epsg=25832,
    crs_name="ETRS89 / UTM zone 32N",
    vertical_datum="DHHN2016",
    eastings=691_234.5,
    northings=5_334_567.25,
    height=515.0,
    rotation_deg=30.0,
    latitude_deg=48.15,
    longitude_deg=-11.5671,
)


@pytest.fixture
def empty(gridshell: Gridshell) -> Gridshell:
    return replace(gridshell, shells=(), blades=(), bolts=(), joints=())


def site_file(empty: Gridshell, site: Site | None, schema: IfcSchema = "IFC4") -> ifcopenshell.file:
    return ifc_model(empty, options=IfcOptions(schema=schema, site=site)).file


@pytest.mark.parametrize("schema", IFC_SCHEMAS)
def test_a_point_of_the_vault_goes_to_its_place_on_the_map(empty: Gridshell, schema: IfcSchema) -> None:
    """Read with IfcOpenShell: 10 m along x, turned by 30 degrees; 2 m up. Doubles hold a northing to 1e-9 m."""
    file = site_file(empty, MEADOW, schema)
    east, north, height = ifcopenshell.util.geolocation.auto_xyz2enh(file, 10_000.0, 0.0, 2_000.0)
    assert east == pytest.approx(691_234.5 + 10.0 * math.cos(math.pi / 6.0), abs=1e-6)
    assert north == pytest.approx(5_334_567.25 + 10.0 * math.sin(math.pi / 6.0), abs=1e-6)
    assert height == pytest.approx(517.0, abs=1e-6)


def test_the_coordinate_system_is_named_by_its_epsg_number(empty: Gridshell) -> None:
    file = site_file(empty, MEADOW)
    (system,) = file.by_type("IfcProjectedCRS")
    named = (system.Name, system.Description, system.VerticalDatum)
    assert named == ("EPSG:25832", "ETRS89 / UTM zone 32N", "DHHN2016")
    assert (system.MapUnit.Name, system.MapUnit.Prefix) == ("METRE", None)


def test_grid_north_lies_turned_back_by_the_rotation(empty: Gridshell) -> None:
    """The x axis points 30 degrees north of east, so north is 60 degrees from x."""
    file = site_file(empty, MEADOW)
    (context,) = file.by_type("IfcGeometricRepresentationContext", include_subtypes=False)
    assert context.TrueNorth.DirectionRatios == pytest.approx((math.cos(math.pi / 3.0), math.sin(math.pi / 3.0)))
    assert true_north(Site(true_north_deg=0.0)) == pytest.approx((0.0, 1.0))
    assert true_north(Site(true_north_deg=90.0)) == pytest.approx((-1.0, 0.0))
    assert true_north(Site()) is None


@pytest.mark.parametrize("schema", IFC_SCHEMAS)
def test_site_and_building_have_their_names(empty: Gridshell, schema: IfcSchema) -> None:
    file = site_file(empty, MEADOW, schema)
    (site,), (building,) = file.by_type("IfcSite"), file.by_type("IfcBuilding")
    assert (site.Name, building.Name) == ("Meadow", "Pavilion")
    assert site.RefLatitude == (48, 9, 0, 0)
    assert site.RefLongitude == (-11, -34, -1, -560_000)
    assert site.RefElevation == 515_000.0


def test_the_address_stands_at_the_building_and_in_ifc4x3_in_a_set(empty: Gridshell) -> None:
    file, later = site_file(empty, MEADOW), site_file(empty, MEADOW, "IFC4X3_ADD2")
    assert file.by_type("IfcBuilding")[0].BuildingAddress.AddressLines == MEADOW.address
    assert later.by_type("IfcBuilding")[0].BuildingAddress is None
    (lines,) = later.by_type("IfcPropertyListValue")
    assert tuple(line.wrappedValue for line in lines.ListValues) == MEADOW.address


def test_without_a_site_there_is_no_georeference_and_the_building_has_the_title(empty: Gridshell) -> None:
    file = site_file(empty, None)
    assert not file.by_type("IfcMapConversion")
    assert file.by_type("IfcGeometricRepresentationContext")[0].TrueNorth is None
    assert file.by_type("IfcBuilding")[0].Name == empty.title


@pytest.mark.parametrize("angle", [0.0, 48.15, -11.5671, 179.999999, -0.0001])
def test_degrees_minutes_and_seconds_add_up_to_the_angle(angle: float) -> None:
    degrees, minutes, seconds, millionths = degrees_minutes_seconds(angle)
    assert degrees + minutes / 60 + (seconds + millionths / 1e6) / 3600 == pytest.approx(angle, abs=1e-9)
    assert len({value > 0 for value in (degrees, minutes, seconds, millionths) if value}) <= 1


def test_a_site_of_the_design_file_is_read_and_half_a_georeference_refused(design: Design) -> None:
    described = Design.model_validate({**design.model_dump(), "site": MEADOW.model_dump()})
    assert described.site == MEADOW
    with pytest.raises(ValidationError, match="northings: missing; epsg, eastings, northings are given together"):
        Site(epsg=25832, eastings=1.0)
