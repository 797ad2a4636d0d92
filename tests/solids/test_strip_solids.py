"""Solids of strips: volume, faces and corners against the flat pattern and the formed sheet."""

import numpy as np
import pytest
from OCP.BRep import BRep_Tool
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Shape, TopoDS_Solid
from solid_figures import signed_volume

from aag_cad.design import Design
from aag_cad.geometry.developable import ruled_edges
from aag_cad.geometry.framed import offset_curve
from aag_cad.network.model import CurveId, CurveNetwork
from aag_cad.parts.model import Strip
from aag_cad.parts.shapes.sheet import flat_pattern, sheet_of, strip_depth
from aag_cad.solids.strips import strip_solid


@pytest.fixture(scope="module", params=["square", "slanting", "peaked", "slanting at both ends"])
def strip(request: pytest.FixtureRequest, design: Design, network: CurveNetwork) -> Strip:
    """A sheet between two geodesics of the vault, 116 mm outside the surface, with various ends."""
    curves = {item.id: item.curve for item in network.curves}
    left, right = (
        offset_curve(curves[CurveId("G", number)], 116.0, gap, 0.0, 4000.0) for number, gap in ((4, 5.0), (5, -5.0))
    )
    ends = {
        "square": ((0.0, 0.0), (1.0, 1.0)),
        "slanting": ((0.0, 0.0), (0.9, 1.0)),
        "peaked": ((0.0, 0.0), (0.93, 1.0, 0.96)),
        "slanting at both ends": ((0.08, 0.0), (1.0, 0.85)),
    }
    edges = ruled_edges(left, right, 50.0, 3900.0, 150.0)
    return Strip("S1-P-04", *edges, 10.0, *ends[request.param])


@pytest.fixture(scope="module")
def solid(strip: Strip) -> TopoDS_Solid:
    return strip_solid(strip)


def pieces(shape: TopoDS_Shape, kind: TopAbs_ShapeEnum) -> list[TopoDS_Shape]:
    explorer, found = TopExp_Explorer(shape, kind), []
    while explorer.More():
        found.append(explorer.Current())
        explorer.Next()
    return found


def area(face: TopoDS_Shape) -> float:
    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face, properties, 1e-8)
    return float(properties.Mass())


def test_a_strip_solid_has_the_volume_of_its_flat_pattern(strip: Strip, solid: TopoDS_Solid) -> None:
    # The outline of the flat pattern is a polygon with a corner every 25 mm: 2e-6 of its area.
    assert signed_volume(solid) == pytest.approx(flat_pattern(strip).area * strip.thickness, rel=1e-5)


def test_a_strip_solid_has_one_face_for_each_side_and_cut(strip: Strip, solid: TopoDS_Solid) -> None:
    faces = pieces(solid, TopAbs_ShapeEnum.TopAbs_FACE)
    assert len(faces) == 4 + len(strip.lower) - 1 + len(strip.upper) - 1
    # Inner and outer face differ from the middle by the same area, one more, one less.
    wide = sorted(area(face) for face in faces)[-2:]
    assert sum(wide) / 2.0 == pytest.approx(flat_pattern(strip).area, rel=1e-5)


def test_corners_of_a_strip_solid_are_those_of_the_formed_sheet(strip: Strip, solid: TopoDS_Solid) -> None:
    corners = {
        tuple(round(c, 3) for c in (p.X(), p.Y(), p.Z()))
        for p in (BRep_Tool.Pnt_s(TopoDS.Vertex_s(vertex)) for vertex in pieces(solid, TopAbs_ShapeEnum.TopAbs_VERTEX))
    }
    assert len(corners) == 2 * (len(strip.lower) + len(strip.upper))
    assert np.abs(strip_depth(strip, np.array(sorted(corners)))).max() < 2e-3
    sheet = sheet_of(strip)
    for cut in (strip.lower, strip.upper):
        for height in (-5.0, 5.0):
            expected = sheet.formed(np.array(cut), np.linspace(0.0, 1.0, len(cut)), height)
            gaps = np.linalg.norm(expected[:, None] - np.array(sorted(corners))[None], axis=2)
            assert gaps.min(axis=1).max() < 2e-3
