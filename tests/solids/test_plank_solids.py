"""Formed planks enclose section x length less their holes, and hold what the forming map says."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.GeomAbs import GeomAbs_SurfaceType
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_ShapeEnum, TopAbs_State
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Shape, TopoDS_Solid
from solid_figures import signed_volume, straight_blank

from aag_cad.errors import SolidError
from aag_cad.geometry.framed import FramedCurve, framed_curve, offset_curve
from aag_cad.geometry.profiles import CrpcProfile
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface
from aag_cad.geometry.surface import unit_normals
from aag_cad.parts.forming import formed_points, plank_axes
from aag_cad.parts.forms import Blank, CrossSection, EndCut, Hole
from aag_cad.parts.model import Plank
from aag_cad.solids.brep import checked, solid
from aag_cad.solids.planks import formed_plank
from aag_cad.units import Floats

SECTION = CrossSection(width=100.0, thickness=12.0)
CHART = AsymptoticChart(RevolutionSurface(CrpcProfile(5100.0, 3.0), -8823.0))


def on_the_vault(slope: float, start: float, end: float) -> FramedCurve:
    """Return the curve theta = slope * s of the vault: a meridian (slope 0) or an asymptotic curve (slope +-1)."""

    def evaluate(s: Floats) -> tuple[Floats, Floats]:
        jet = CHART.jet(s, slope * s)
        return jet.point, unit_normals(jet)

    return framed_curve(evaluate, start, end, 5000.0)


def neck_circle() -> FramedCurve:
    def evaluate(theta: Floats) -> tuple[Floats, Floats]:
        jet = CHART.jet(np.zeros_like(theta), theta)
        return jet.point, unit_normals(jet)

    return framed_curve(evaluate, -0.5, 0.5, 5100.0)


def straight_line() -> FramedCurve:
    stations = np.linspace(0.0, 2000.0, 13)
    zero = np.zeros_like(stations)
    return FramedCurve(stations, np.column_stack([stations, zero, zero]), np.tile([0.0, 0.0, 1.0], (13, 1)))


def plank_on(curve: FramedCurve, upright: bool, pairs: int = 6) -> Plank:
    """Return a plank with pairs of bolt holes 18 mm off its centre line and a screw hole on it."""
    stations = np.linspace(80.0, curve.length - 80.0, pairs).tolist()
    holes = [Hole(x, y, 9.0, "bolt", "S1-N-001") for x in stations for y in (-18.0, 18.0)]
    holes.append(Hole(curve.length / 2.0 + 30.0, 0.0, 6.5, "screw", "S1-K-001"))
    blank = Blank(curve.length, SECTION, tuple(sorted(holes, key=lambda hole: hole.station)))
    return Plank("S1-A1-07-L", "A1", -1, upright, "S1-A1-07", curve, blank, ())


BEAM_LINE = on_the_vault(1.0, 0.02, 0.85)
CASES = {
    "bent geodesic": plank_on(on_the_vault(0.0, 0.02, 0.8), upright=False),
    "neck circle, lying flat": plank_on(neck_circle(), upright=False),
    "twisted asymptotic plank, 56 mm below and 18 mm beside the surface curve": plank_on(
        offset_curve(BEAM_LINE, -56.0, 18.0, 0.0, BEAM_LINE.length), upright=True
    ),
    "asymptotic plank of the other family": plank_on(on_the_vault(-1.0, 0.02, 0.85), upright=True),
    "straight, lying flat": plank_on(straight_line(), upright=False),
}
each_case = pytest.mark.parametrize("name", CASES)


@cache
def formed(name: str) -> TopoDS_Solid:
    return formed_plank(CASES[name])


def timber(plank: Plank) -> float:
    """Section x length, exact for a straight section square to a curve through its centroid, less the drilled cores."""
    section, holes = plank.blank.section, plank.blank.holes
    drilled = sum(math.pi * hole.diameter**2 / 4.0 for hole in holes) * section.thickness
    return section.width * section.thickness * plank.blank.length - drilled


def pieces(shape: TopoDS_Shape, kind: TopAbs_ShapeEnum) -> list[TopoDS_Shape]:
    explorer, found = TopExp_Explorer(shape, kind), []
    while explorer.More():
        found.append(explorer.Current())
        explorer.Next()
    return found


def faces(shape: TopoDS_Shape) -> list[TopoDS_Face]:
    return [TopoDS.Face_s(face) for face in pieces(shape, TopAbs_ShapeEnum.TopAbs_FACE)]


def of_type(shape: TopoDS_Shape, kind: GeomAbs_SurfaceType) -> list[BRepAdaptor_Surface]:
    return [surface for surface in map(BRepAdaptor_Surface, faces(shape)) if surface.GetType() == kind]


def cylinders(shape: TopoDS_Shape) -> list[tuple[float, Floats, Floats]]:
    """Radius, a point on the axis and its direction of each cylinder face."""
    found = []
    for surface in of_type(shape, GeomAbs_SurfaceType.GeomAbs_Cylinder):
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


def state(shape: TopoDS_Shape, place: Floats) -> TopAbs_State:
    return BRepClass3d_SolidClassifier(shape, gp_Pnt(*place.tolist()), 1e-6).State()


def material_normal(plank: Plank, hole: Hole) -> Floats:
    """Return the direction square to the bent and twisted middle surface at a hole, by differences over 2 mm."""
    steps = np.array([[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]])
    near = np.column_stack([np.array([hole.station, hole.offset]) + steps, np.zeros(4)])
    a, b, c, d = formed_points(plank, near)
    normal = np.cross(b - a, d - c)
    return np.asarray(normal / np.linalg.norm(normal))


@each_case
def test_a_formed_plank_encloses_section_times_length_less_its_holes(name: str) -> None:
    # 1e-7: ten times what the splines of the long edges and of the rims leave; the quadrature is set to 1e-8.
    assert signed_volume(formed(name), 1e-8) == pytest.approx(timber(CASES[name]), rel=1e-7)


@each_case
def test_a_formed_plank_is_valid_and_its_faces_turn_outwards(name: str) -> None:
    assert BRepCheck_Analyzer(formed(name)).IsValid()
    assert signed_volume(formed(name)) > 0.0
    plank = CASES[name]
    middle = formed_points(
        plank, np.array([[plank.blank.length / 2.0, 0.0, 0.0], [plank.blank.length / 2.0, 0.0, 6.1]])
    )
    assert [state(formed(name), place) for place in middle] == [TopAbs_State.TopAbs_IN, TopAbs_State.TopAbs_OUT]


@each_case
def test_four_ruled_faces_two_plane_ends_and_one_cylinder_for_each_hole(name: str) -> None:
    kinds = [BRepAdaptor_Surface(face).GetType() for face in faces(formed(name))]
    assert kinds.count(GeomAbs_SurfaceType.GeomAbs_BSplineSurface) == 4
    assert kinds.count(GeomAbs_SurfaceType.GeomAbs_Plane) == 2
    assert kinds.count(GeomAbs_SurfaceType.GeomAbs_Cylinder) == len(CASES[name].blank.holes)
    assert len(kinds) == 6 + len(CASES[name].blank.holes)


@each_case
def test_all_edges_meet_within_a_hundredth_of_a_millimetre(name: str) -> None:
    edges = pieces(formed(name), TopAbs_ShapeEnum.TopAbs_EDGE)
    corners = pieces(formed(name), TopAbs_ShapeEnum.TopAbs_VERTEX)
    assert max(BRep_Tool.Tolerance_s(TopoDS.Edge_s(edge)) for edge in edges) <= 0.01
    assert max(BRep_Tool.Tolerance_s(TopoDS.Vertex_s(corner)) for corner in corners) <= 0.01


@each_case
def test_the_holes_are_cylinders_where_the_blank_is_drilled_square_to_the_bent_face(name: str) -> None:
    plank = CASES[name]
    drilled = np.array([[hole.station, hole.offset, 0.0] for hole in plank.blank.holes])
    for hole, (radius, place, axis), centre in zip(
        plank.blank.holes, cylinders(formed(name)), formed_points(plank, drilled), strict=True
    ):
        assert radius == pytest.approx(hole.diameter / 2.0, abs=1e-12)
        assert np.linalg.norm(np.cross(centre - place, axis)) < 1e-4
        assert np.linalg.norm(np.cross(axis, material_normal(plank, hole))) < 1e-5
    assert state(formed(name), centre) == TopAbs_State.TopAbs_OUT


@each_case
def test_a_hole_leans_from_the_thickness_direction_by_no_more_than_offset_times_twist(name: str) -> None:
    # 19.5 deg/m over 18 mm is 0.35 degrees: over half the thickness 0.04 mm, against 0.5 mm of play around the bolt.
    plank = CASES[name]
    thickness = plank_axes(plank, np.array([hole.station for hole in plank.blank.holes]))[3]
    lean = [
        np.linalg.norm(np.cross(axis, along))
        for (_radius, _place, axis), along in zip(cylinders(formed(name)), thickness, strict=True)
    ]
    assert max(lean) <= math.radians(0.36)


@each_case
def test_the_ends_are_planes_square_to_the_centre_line(name: str) -> None:
    plank = CASES[name]
    points, tangents, _width, _thickness = plank_axes(plank, np.array([0.0, plank.blank.length]))
    ends = of_type(formed(name), GeomAbs_SurfaceType.GeomAbs_Plane)
    for surface, point, outward in zip(ends, points, (-tangents[0], tangents[1]), strict=True):
        plane = surface.Plane()
        normal = plane.Axis().Direction()
        assert plane.Distance(gp_Pnt(*point.tolist())) < 1e-6
        assert np.array([normal.X(), normal.Y(), normal.Z()]) == pytest.approx(outward, abs=1e-9)


@each_case
def test_the_faces_lie_where_the_forming_map_puts_the_faces_of_the_blank(name: str) -> None:
    plank = CASES[name]
    x = np.linspace(0.0, plank.blank.length, 23)[1:-1] + 11.0
    around = np.array([(-50.0, -6.0), (-31.0, -6.0), (33.0, 6.0), (50.0, 6.0), (50.0, 1.0), (-50.0, -2.0)])
    blank = np.column_stack([np.repeat(x, len(around)), np.tile(around, (len(x), 1))])
    outside = pieces(formed(name), TopAbs_ShapeEnum.TopAbs_SHELL)[0]
    away = [
        BRepExtrema_DistShapeShape(BRepBuilderAPI_MakeVertex(gp_Pnt(*place.tolist())).Vertex(), outside).Value()
        for place in formed_points(plank, blank)
    ]
    assert max(away) < 1e-4


@each_case
def test_the_straight_blank_is_a_box_less_its_holes(name: str) -> None:
    plank = CASES[name]
    blank = straight_blank(plank)
    assert BRepCheck_Analyzer(blank).IsValid()
    assert signed_volume(blank, 1e-10) == pytest.approx(timber(plank), rel=1e-9)
    assert len(of_type(blank, GeomAbs_SurfaceType.GeomAbs_Plane)) == 6
    for hole, (radius, place, axis) in zip(plank.blank.holes, cylinders(blank), strict=True):
        assert radius == hole.diameter / 2.0
        assert place.tolist() == [hole.station, hole.offset, 0.0]
        assert axis.tolist() == [0.0, 0.0, 1.0]


def test_a_straight_plank_is_formed_into_its_own_blank() -> None:
    blank = straight_blank(CASES["straight, lying flat"])
    assert signed_volume(formed("straight, lying flat"), 1e-9) == pytest.approx(signed_volume(blank, 1e-9), rel=1e-8)
    places, straight_places = (
        np.array([place for _radius, place, _axis in cylinders(shape)])
        for shape in (formed("straight, lying flat"), blank)
    )
    assert places == pytest.approx(straight_places, abs=1e-9)


def test_a_plank_without_holes_has_six_faces() -> None:
    plank = CASES["bent geodesic"]
    bare = replace(plank, blank=replace(plank.blank, holes=()))
    assert len(faces(formed_plank(bare))) == 6
    assert signed_volume(formed_plank(bare), 1e-9) == pytest.approx(timber(bare), rel=1e-7)


@pytest.mark.parametrize(
    ("damage", "complaint"),
    [
        (lambda whole: [face.Reversed() for face in whole], "inside out"),
        (lambda whole: [whole[0].Reversed(), *whole[1:]], "invalid"),
        (lambda whole: [*whole[:4], *whole[5:]], "invalid"),
        (lambda whole: whole[:-1], "invalid"),
        (lambda whole: [*whole[:-1], whole[-1].Reversed()], "invalid"),
    ],
    ids=["all faces turned", "one face turned", "an end missing", "a hole without wall", "the wall of a hole turned"],
)
def test_damage_is_found_and_the_mark_named(
    damage: Callable[[list[TopoDS_Face]], list[TopoDS_Face]], complaint: str
) -> None:
    with pytest.raises(SolidError, match=f"S1-G-05: the solid is {complaint}"):
        checked(solid(damage(faces(formed("bent geodesic")))), "S1-G-05")


def test_an_undamaged_plank_passes_the_same_check() -> None:
    again = solid(faces(formed("bent geodesic")))
    assert checked(again, "S1-G-05") is again


@pytest.mark.parametrize("make", [formed_plank, straight_blank])
@pytest.mark.parametrize(
    ("hole", "what"),
    [
        (Hole(900.0, 46.0, 9.0, "bolt", "S1-N-009"), "S1-A1-07-L: the hole of 9 mm for S1-N-009 at 900.0 mm"),
        (Hole(4.0, 0.0, 9.0, "bolt", "S1-N-009"), "S1-A1-07-L: the hole of 9 mm for S1-N-009 at 4.0 mm"),
    ],
    ids=["over the long edge", "over the end"],
)
def test_a_hole_that_breaks_out_is_refused(make: Callable[[Plank], TopoDS_Solid], hole: Hole, what: str) -> None:
    plank = CASES["asymptotic plank of the other family"]
    with pytest.raises(SolidError, match=what):
        make(replace(plank, blank=replace(plank.blank, holes=(hole,))))


@pytest.mark.parametrize("make", [formed_plank, straight_blank])
def test_holes_that_run_into_each_other_are_refused(make: Callable[[Plank], TopoDS_Solid]) -> None:
    plank = CASES["bent geodesic"]
    pair = (Hole(900.0, 0.0, 9.0, "bolt", "S1-N-009"), Hole(906.0, 0.0, 9.0, "bolt", "S1-N-010"))
    with pytest.raises(SolidError, match="S1-A1-07-L: the solid is invalid"):
        make(replace(plank, blank=replace(plank.blank, holes=pair)))


def test_a_skew_end_is_refused_rather_than_drawn_square() -> None:
    plank = CASES["bent geodesic"]
    with pytest.raises(SolidError, match="S1-A1-07-L: an end is cut at 60 degrees"):
        formed_plank(replace(plank, blank=replace(plank.blank, end_cut=EndCut(60.0))))
