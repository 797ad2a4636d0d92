"""Shapes of the products in IFC: triangulated or B-spline bodies, extruded fasteners, axes of planks, colours."""

import numpy as np

from aag_cad.export.ifc.brep import advanced_brep
from aag_cad.export.ifc.frame import Entity, IfcModel
from aag_cad.parts.forming import plank_axes
from aag_cad.parts.kinds import colour, colour_name, kind_of, shaped
from aag_cad.parts.model import FlatBar, Part
from aag_cad.parts.shapes.bar import BAR, MESH_SPACING
from aag_cad.parts.shapes.threaded import THREADED, Threaded
from aag_cad.parts.triangles import Mesh, regular_polygon
from aag_cad.units import Floats

_DIGITS = 3


def _coordinates(points: Floats) -> list[list[float]]:
    """Return points as lists, rounded to 1e-3 mm and without negative zeros."""
    rows: list[list[float]] = (np.round(points, _DIGITS) + 0.0).tolist()
    return rows


def welded(mesh: Mesh) -> Mesh:
    """Return a closed mesh with one vertex for all that are written as the same point, and without flattened faces.

    Where the ends of two cuts of a sheet meet, its mesh has such vertices.
    """
    _, first, place = np.unique(np.round(mesh.vertices, _DIGITS), axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    faces = rank[place.reshape(-1)][mesh.faces]
    a, b, c = faces.T
    return Mesh(mesh.vertices[first[order]], faces[(a != b) & (b != c) & (c != a)])


def face_set(model: IfcModel, mesh: Mesh) -> Entity:
    """Return a closed mesh as a triangulated face set."""
    points = model.new("IfcCartesianPointList3D", _coordinates(mesh.vertices))
    return model.new("IfcTriangulatedFaceSet", points, None, True, (mesh.faces + 1).tolist())


def faceted_brep(model: IfcModel, mesh: Mesh) -> Entity:
    """Return a closed mesh as a faceted boundary representation: IFC2X3 has no face sets."""
    new = model.new
    points = [new("IfcCartesianPoint", point) for point in _coordinates(mesh.vertices)]
    faces = []
    for face in mesh.faces.tolist():
        bound = new("IfcFaceOuterBound", new("IfcPolyLoop", [points[corner] for corner in face]), True)
        faces.append(new("IfcFace", [bound]))
    return new("IfcFacetedBrep", new("IfcClosedShell", faces))


def _hexagon(model: IfcModel, across_flats: float) -> Entity:
    corners = _coordinates(regular_polygon(6, across_flats))
    points = [model.new("IfcCartesianPoint", corner) for corner in corners]
    outline = model.new("IfcPolyline", [*points, points[0]])
    return model.new("IfcArbitraryClosedProfileDef", "AREA", None, outline)


def _circle(model: IfcModel, diameter: float) -> Entity:
    # Only IFC2X3 demands a position, which is no other than the origin.
    centre = model.new("IfcCartesianPoint", (0.0, 0.0)) if model.schema == "IFC2X3" else None
    position = centre and model.new("IfcAxis2Placement2D", centre)
    return model.new("IfcCircleProfileDef", "AREA", None, position, diameter / 2.0)


def extrusion(model: IfcModel, profile: Entity, low: float, high: float) -> Entity:
    """Return a profile extruded along z between two heights."""
    origin = model.new("IfcCartesianPoint", (0.0, 0.0, low))
    up = model.new("IfcDirection", (0.0, 0.0, 1.0))
    at = model.new("IfcAxis2Placement3D", origin)
    return model.new("IfcExtrudedAreaSolid", profile, at, up, high - low)


def _threaded_solids(model: IfcModel, form: Threaded) -> list[Entity]:
    """Return the pieces of a fastener, one upon the other, so that nothing overlaps."""
    return [
        extrusion(model, _hexagon(model, p.size) if p.hexagonal else _circle(model, p.size), p.low, p.high)
        for p in form.pieces
    ]


def _body(model: IfcModel, part: Part) -> tuple[str, list[Entity]]:
    """Return the representation type and the items of a part's product."""
    shape, form = shaped(part)
    if shape is THREADED:
        return "SweptSolid", _threaded_solids(model, form)
    if shape is BAR and model.options.geometry == "brep":
        return "AdvancedBrep", [advanced_brep(model, form)]
    mesh = welded(shape.mesh(form))
    if model.schema == "IFC2X3":
        return "Brep", [faceted_brep(model, mesh)]
    return "Tessellation", [face_set(model, mesh)]


def _axis(model: IfcModel, plank: FlatBar) -> Entity:
    """Return the centre line of a formed plank through the centres of the rings of its body."""
    count = max(2, int(np.ceil(plank.blank.length / MESH_SPACING)) + 1)
    centres = plank_axes(plank, np.linspace(0.0, plank.blank.length, count))[0]
    if model.schema == "IFC2X3":
        corners = [model.new("IfcCartesianPoint", point) for point in _coordinates(centres)]
        return model.new("IfcPolyline", corners)
    points = model.new("IfcCartesianPointList3D", _coordinates(centres))
    return model.new("IfcIndexedPolyCurve", points)


def surface_style(model: IfcModel, part: Part) -> Entity:
    """Return the surface style of a part's colour, as the schema assigns it to items.

    Viewers show the numbers of ``IfcColourRgb`` as they are, as those of 8 bits over 255: sRGB.
    """
    rgb = model.new("IfcColourRgb", None, *(round(value, 4) for value in colour(part)))
    see_through = () if model.schema == "IFC2X3" else (0.0,)
    shading = model.new("IfcSurfaceStyleShading", rgb, *see_through)
    style = model.new("IfcSurfaceStyle", colour_name(part), "BOTH", [shading])
    return style if model.schema != "IFC2X3" else model.new("IfcPresentationStyleAssignment", [style])


def representation_maps(model: IfcModel, part: Part, style: Entity) -> list[Entity]:
    """Return the maps of a product: its body, and for planks their axis; every item carries the style itself."""
    kind, items = _body(model, part)
    for item in items:
        model.new("IfcStyledItem", item, [style])
    shapes = [model.new("IfcShapeRepresentation", model.body, "Body", kind, items)]
    if kind_of(part).ifc.predefined == "MEMBER":
        axis = _axis(model, kind_of(part).form(part))
        shapes.append(model.new("IfcShapeRepresentation", model.axis, "Axis", "Curve3D", [axis]))
    return [model.new("IfcRepresentationMap", model.identity, shape) for shape in shapes]


def mapped_shape(model: IfcModel, maps: tuple[Entity, ...], unmoved: Entity) -> Entity:
    """Return the shape of one occurrence: the type's maps where they are; ``unmoved`` is the identity operator."""
    shapes = []
    for source in maps:
        drawn = source.MappedRepresentation
        item = model.new("IfcMappedItem", source, unmoved)
        shapes.append(
            model.new(
                "IfcShapeRepresentation", drawn.ContextOfItems, drawn.RepresentationIdentifier,
                "MappedRepresentation", [item],
            )
        )  # fmt: skip
    return model.new("IfcProductDefinitionShape", None, None, shapes)
