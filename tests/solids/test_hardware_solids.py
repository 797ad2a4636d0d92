"""Studs, bolts, screws and coupling blocks have the sizes of the parts and their holes where the parts say."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from OCP.Bnd import Bnd_Box
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.GeomAbs import GeomAbs_SurfaceType
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Shape, TopoDS_Solid
from solid_figures import signed_volume

from aag_cad.errors import SolidError
from aag_cad.parts.forms import CrossHole, Frame, Hole
from aag_cad.parts.model import Bolt, CouplingBlock, Screw, Stud
from aag_cad.solids.products import product_solid
from aag_cad.units import Floats

FRAME = Frame((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
STUD_HOLES = (
    CrossHole(-74.0, 0.0, 9.0),
    CrossHole(-38.0, 0.0, 9.0),
    CrossHole(38.0, math.pi / 3.0, 9.0),
    CrossHole(74.0, -2.0 * math.pi / 3.0, 9.0),
)
STUD = Stud("S1-N-001", FRAME, 220.0, 24.0, STUD_HOLES)
BOLT = Bolt("S1-N-001-B1", FRAME, 8.0, 65.0, 48.0, 13.0, 5.3, 6.8, 24.0, 2.0)
SCREW = Screw("S1-K-001-W1", FRAME, 6.0, 60.0, 12.0)
BLOCK_HOLES = (Hole(-20.0, -18.0, 9.0, "bolt", "S1-K-001"), Hole(30.0, 25.0, 6.5, "bolt", "S1-K-001"))
BLOCK = CouplingBlock("S1-K-001", FRAME, 120.0, 100.0, 24.0, BLOCK_HOLES)
MAKERS: dict[str, Callable[[], TopoDS_Solid]] = {
    "stud": lambda: product_solid(STUD),
    "bolt": lambda: product_solid(BOLT),
    "screw": lambda: product_solid(SCREW),
    "block": lambda: product_solid(BLOCK),
}


def hexagon(across_flats: float) -> float:
    return math.sqrt(3.0) / 2.0 * across_flats**2


def disc(diameter: float) -> float:
    return math.pi * diameter**2 / 4.0


def surfaces(shape: TopoDS_Shape, kind: GeomAbs_SurfaceType) -> list[BRepAdaptor_Surface]:
    explorer, found = TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_FACE), []
    while explorer.More():
        surface = BRepAdaptor_Surface(TopoDS.Face_s(explorer.Current()))
        if surface.GetType() == kind:
            found.append(surface)
        explorer.Next()
    return found


def bounds(shape: TopoDS_Shape) -> tuple[Floats, Floats]:
    box = Bnd_Box()
    BRepBndLib.AddOptimal_s(shape, box, False, False)
    low, high = box.CornerMin(), box.CornerMax()
    return np.array([low.X(), low.Y(), low.Z()]), np.array([high.X(), high.Y(), high.Z()])


def flats(shape: TopoDS_Shape) -> list[tuple[float, float, float]]:
    """Return angle about z in degrees, distance from the z axis and height of a point, for each plane along z."""
    found = []
    for surface in surfaces(shape, GeomAbs_SurfaceType.GeomAbs_Plane):
        normal, place = surface.Plane().Axis().Direction(), surface.Plane().Location()
        if abs(normal.Z()) < 1e-9:
            distance = place.X() * normal.X() + place.Y() * normal.Y()
            angle = math.degrees(math.atan2(normal.Y(), normal.X())) + (180.0 if distance < 0 else 0.0)
            found.append((round(angle, 6) % 360.0, abs(distance), place.Z()))
    return found


def cylinder_faces(shape: TopoDS_Shape) -> list[tuple[float, Floats, Floats]]:
    found = []
    for surface in surfaces(shape, GeomAbs_SurfaceType.GeomAbs_Cylinder):
        axis = surface.Cylinder().Axis()
        place, along = axis.Location(), axis.Direction()
        found.append(
            (
                surface.Cylinder().Radius(),
                np.array([place.X(), place.Y(), place.Z()]),
                np.array([along.X(), along.Y(), along.Z()]),
            )
        )
    return found


@pytest.mark.parametrize("name", MAKERS)
def test_hardware_is_one_valid_solid_with_positive_volume(name: str) -> None:
    shape = MAKERS[name]()
    assert shape.ShapeType() == TopAbs_ShapeEnum.TopAbs_SOLID
    assert BRepCheck_Analyzer(shape).IsValid()
    assert signed_volume(shape) > 0.0


def test_the_stud_is_24_mm_across_each_pair_of_flats_and_x_is_normal_to_one() -> None:
    angles = {angle for angle, _distance, _height in flats(product_solid(STUD))}
    assert angles == {0.0, 60.0, 120.0, 180.0, 240.0, 300.0}
    assert [distance for _angle, distance, _height in flats(product_solid(STUD))] == pytest.approx([12.0] * 6, abs=1e-9)
    low, high = bounds(product_solid(STUD))
    assert [low[2], high[2]] == pytest.approx([-110.0, 110.0], abs=1e-6)


def test_the_holes_of_a_stud_go_square_through_its_flats_at_their_heights() -> None:
    shape = product_solid(STUD)
    for hole, (radius, place, axis) in zip(
        STUD_HOLES, sorted(cylinder_faces(shape), key=lambda found: float(found[1][2])), strict=True
    ):
        assert radius == hole.diameter / 2.0
        assert place[2] == pytest.approx(hole.height, abs=1e-9)
        assert np.linalg.norm(np.cross(place - [0.0, 0.0, hole.height], axis)) < 1e-9
        assert abs(axis @ [math.cos(hole.angle), math.sin(hole.angle), 0.0]) == pytest.approx(1.0, abs=1e-12)
    solid_stud = hexagon(24.0) * 220.0
    assert signed_volume(shape, 1e-9) == pytest.approx(solid_stud - 4 * disc(9.0) * 24.0, rel=1e-9)


def test_an_m8_bolt_is_13_mm_across_flats_and_reaches_from_its_head_past_its_nut() -> None:
    shape = product_solid(BOLT)
    assert [distance for _angle, distance, _height in flats(shape)] == pytest.approx([6.5] * 12, abs=1e-9)
    low, high = bounds(shape)
    assert [low[2], high[2]] == pytest.approx([-2.0 - 5.3, 65.0 - 2.0], abs=1e-6)
    assert [low[0], high[0]] == pytest.approx([-12.0, 12.0], abs=1e-6)
    assert {round(radius, 9) for radius, _place, _axis in cylinder_faces(shape)} == {4.0, 12.0}


def test_a_bolt_has_the_volume_of_head_washers_shank_nut_and_tip() -> None:
    tip = 65.0 - 2.0 - (48.0 + 2.0 + 6.8)
    pieces = hexagon(13.0) * (5.3 + 6.8) + disc(24.0) * 4.0 + disc(8.0) * (48.0 + tip)
    assert signed_volume(product_solid(BOLT), 1e-9) == pytest.approx(pieces, rel=1e-9)


def test_a_bolt_that_ends_inside_its_nut_has_no_tip() -> None:
    short = Bolt("S1-N-001-B1", FRAME, 8.0, 55.0, 48.0, 13.0, 5.3, 6.8, 24.0, 2.0)
    low, high = bounds(product_solid(short))
    assert high[2] == pytest.approx(48.0 + 2.0 + 6.8, abs=1e-6)
    assert low[2] == pytest.approx(-7.3, abs=1e-6)


def test_a_countersunk_screw_is_flush_at_the_face_of_the_plank() -> None:
    shape = product_solid(SCREW)
    low, high = bounds(shape)
    assert [*low, *high] == pytest.approx([-6.0, -6.0, 0.0, 6.0, 6.0, 60.0], abs=1e-6)
    (cone,) = surfaces(shape, GeomAbs_SurfaceType.GeomAbs_Cone)
    assert abs(cone.Cone().SemiAngle()) == pytest.approx(math.radians(45.0))
    head = math.pi * 3.0 * (6.0**2 + 6.0 * 3.0 + 3.0**2) / 3.0
    assert signed_volume(shape, 1e-9) == pytest.approx(head + disc(6.0) * 57.0, rel=1e-9)


def test_a_coupling_block_is_drilled_through_the_gap_where_its_holes_say() -> None:
    shape = product_solid(BLOCK)
    low, high = bounds(shape)
    assert [*low, *high] == pytest.approx([-60.0, -50.0, -12.0, 60.0, 50.0, 12.0], abs=1e-6)
    for hole, (radius, place, axis) in zip(BLOCK_HOLES, cylinder_faces(shape), strict=True):
        assert [radius, *place[:2]] == [hole.diameter / 2.0, hole.station, hole.offset]
        assert axis.tolist() == [0.0, 0.0, 1.0]
    drilled = (disc(9.0) + disc(6.5)) * 24.0
    assert signed_volume(shape, 1e-10) == pytest.approx(120.0 * 100.0 * 24.0 - drilled, rel=1e-9)


def test_a_hole_that_cuts_a_stud_in_two_is_refused() -> None:
    with pytest.raises(SolidError, match="S1-N-001: 2 solids came out where one is due"):
        product_solid(Stud("S1-N-001", FRAME, 220.0, 24.0, (CrossHole(0.0, 0.0, 30.0),)))


def test_a_hole_that_breaks_out_of_a_block_is_refused() -> None:
    with pytest.raises(SolidError, match="S1-K-001: the hole of 9 mm for S1-K-001 at 58"):
        product_solid(CouplingBlock("S1-K-001", FRAME, 120.0, 100.0, 24.0, (Hole(58.0, 0.0, 9.0, "bolt", "S1-K-001"),)))
