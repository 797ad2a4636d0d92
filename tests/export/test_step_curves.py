"""The STEP file of the network, read back by the kernel, holds the surface and each plank's line under its name."""

from pathlib import Path

import numpy as np
import pytest
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.Geom import Geom_BSplineSurface
from OCP.GeomAbs import GeomAbs_CurveType
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopoDS import TopoDS, TopoDS_Iterator, TopoDS_Shape
from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from aag_cad.design import Design
from aag_cad.errors import FileError
from aag_cad.export.cad.step_curves import curve_edge, surface_face, write_step_curves
from aag_cad.geometry.revolution import AsymptoticChart
from aag_cad.network.model import CurveNetwork
from aag_cad.pipeline import web_of
from aag_cad.web.interpolation import InterpolatedSurface, interpolated_surface


@pytest.fixture(scope="module")
def surface(design: Design, chart: AsymptoticChart) -> InterpolatedSurface:
    return interpolated_surface(web_of(design, chart), design.step / 2.0)


@pytest.fixture(scope="module")
def path(network: CurveNetwork, surface: InterpolatedSurface, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("curves") / "curves.step"
    write_step_curves(network, surface, path)
    return path


def name_of(label: TDF_Label) -> str:
    name = TDataStd_Name()
    assert label.FindAttribute(TDataStd_Name.GetID_s(), name)
    return str(name.Get().ToExtString())


def simple_shapes(tool: XCAFDoc_ShapeTool, label: TDF_Label, above: str = "") -> dict[str, TopoDS_Shape]:
    """Return the shapes below an assembly by their path of names."""
    found: dict[str, TopoDS_Shape] = {}
    components = TDF_LabelSequence()
    XCAFDoc_ShapeTool.GetComponents_s(label, components)
    for i in range(1, components.Length() + 1):
        component, product = components.Value(i), TDF_Label()
        XCAFDoc_ShapeTool.GetReferredShape_s(component, product)
        here = f"{above}/{name_of(component)}"
        if XCAFDoc_ShapeTool.IsAssembly_s(product):
            found |= simple_shapes(tool, product, here)
        else:
            found[here] = XCAFDoc_ShapeTool.GetShape_s(product)
    return found


@pytest.fixture(scope="module")
def shapes(path: Path) -> dict[str, TopoDS_Shape]:
    reader = STEPCAFControl_Reader()
    reader.SetNameMode(True)
    reader.ReadFile(str(path))
    document = TDocStd_Document(TCollection_ExtendedString("XmlOcaf"))
    assert reader.Transfer(document)
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    free = TDF_LabelSequence()
    tool.GetFreeShapes(free)
    assert free.Length() == 1
    return simple_shapes(tool, free.Value(1), name_of(free.Value(1)))


def test_every_curve_is_an_edge_under_its_name_in_the_group_of_its_family(
    network: CurveNetwork, shapes: dict[str, TopoDS_Shape]
) -> None:
    names = {f"Network/{i.id.family}/{i.id.family}-{i.id.number:02d}" for i in network.curves}
    assert set(shapes) == {"Network/Surface", *names}
    for name in names:
        assert BRepCheck_Analyzer(shapes[name]).IsValid()


def test_the_edges_are_the_splines_between_the_ends_of_the_planks(
    network: CurveNetwork, shapes: dict[str, TopoDS_Shape]
) -> None:
    """B-splines of degree five at the same arc length; STEP text keeps about 15 digits, so 1e-6 mm."""
    for item in network.curves:
        edge = BRepAdaptor_Curve(
            TopoDS.Edge_s(_only(shapes[f"Network/{item.id.family}/{item.id.family}-{item.id.number:02d}"]))
        )
        assert edge.GetType() == GeomAbs_CurveType.GeomAbs_BSplineCurve
        assert edge.Degree() == 5
        ends = edge.FirstParameter(), edge.LastParameter()
        assert ends == pytest.approx((item.start, item.end), abs=1e-6)
        stations = np.linspace(*ends, 9)
        found = [[p.X(), p.Y(), p.Z()] for p in (edge.Value(float(s)) for s in stations)]
        np.testing.assert_allclose(found, item.curve.point_spline(stations), rtol=0.0, atol=1e-6)


def _only(shape: TopoDS_Shape) -> TopoDS_Shape:
    """Return the one edge or face of a shape that the reader may have wrapped."""
    while shape.ShapeType() not in (TopAbs_ShapeEnum.TopAbs_EDGE, TopAbs_ShapeEnum.TopAbs_FACE):
        shape = TopoDS_Iterator(shape).Value()
    return shape


def test_the_face_is_the_interpolated_surface(surface: InterpolatedSurface, shapes: dict[str, TopoDS_Shape]) -> None:
    face = TopoDS.Face_s(_only(shapes["Network/Surface"]))
    assert BRepCheck_Analyzer(face).IsValid()
    spline = BRep_Tool.Surface_s(face)
    assert isinstance(spline, Geom_BSplineSurface)
    assert (spline.UDegree(), spline.VDegree()) == (5, 5)
    (low, high), (left, right) = surface.ranges
    grid = np.meshgrid(np.linspace(low, high, 6), np.linspace(left, right, 6))
    u, v = (part.ravel() for part in grid)
    points = (spline.Value(float(a), float(b)) for a, b in zip(u, v, strict=True))
    np.testing.assert_allclose([[p.X(), p.Y(), p.Z()] for p in points], surface.jet(u, v).point, rtol=0.0, atol=1e-6)


def test_the_curves_lie_on_the_surface_of_the_web(network: CurveNetwork, surface: InterpolatedSurface) -> None:
    """The discrete web of the vault differs from the smooth surface of the curves by less than a millimetre."""
    face = surface_face(surface)
    for item in network.curves[::7]:
        assert BRepExtrema_DistShapeShape(face, curve_edge(item)).Value() < 1.0


def test_equal_models_give_equal_bytes(
    network: CurveNetwork, surface: InterpolatedSurface, path: Path, tmp_path: Path
) -> None:
    write_step_curves(network, surface, tmp_path / "curves.step")
    assert (tmp_path / "curves.step").read_bytes() == path.read_bytes()


def test_a_network_without_a_surface_holds_curves_only(network: CurveNetwork, tmp_path: Path) -> None:
    """Polylines of another program bring no surface."""
    write_step_curves(network, None, tmp_path / "curves.step")
    text = (tmp_path / "curves.step").read_text(encoding="ascii")
    assert "'A1-01'" in text
    assert "B_SPLINE_SURFACE" not in text


def test_a_folder_that_cannot_be_written_is_named(network: CurveNetwork, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(FileError, match="cannot be written"):
        write_step_curves(network, None, tmp_path / "file" / "curves.step")
