"""What a receiving office checks in an IFC file, in every schema that is written.

Every check is a function that lists what is wrong, and is shown to find the fault in a damaged file.
"""

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

import ifcopenshell
import ifcopenshell.util.pset
import ifcopenshell.validate
import numpy as np
import pytest
from making import work_of
from test_ifc_sample import sampled, sampled_work

from aag_cad.design import load_design
from aag_cad.export.ifc.model import ifc_model, write_ifc
from aag_cad.export.ifc.options import IFC_SCHEMAS, IfcOptions, IfcSchema
from aag_cad.export.ifc.schemas import attributes_of
from aag_cad.parts.model import Gridshell
from aag_cad.pipeline import gridshell_of

File: TypeAlias = ifcopenshell.file
Edge: TypeAlias = tuple[int, int]

# The view definitions that a header may name, by schema.
VIEWS = {
    "IFC2X3": {"CoordinationView_V2.0"},
    "IFC4": {"ReferenceView_V1.2"},
    "IFC4X3": {"ReferenceView"},
}
BODY_TYPES = {
    "Tessellation": "IfcTriangulatedFaceSet",
    "SweptSolid": "IfcExtrudedAreaSolid",
    "Brep": "IfcFacetedBrep",
    "AdvancedBrep": "IfcAdvancedBrep",
}


@pytest.fixture(scope="module")
def sample(gridshell: Gridshell) -> Gridshell:
    return sampled(gridshell)


@pytest.fixture(scope="module")
def written(gridshell: Gridshell, sample: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> dict[IfcSchema, Path]:
    """Give the path of a file with its plan in every schema."""
    folder, work = tmp_path_factory.mktemp("ifc"), sampled_work(gridshell, sample)
    for schema in IFC_SCHEMAS:
        write_ifc(sample, folder / f"{schema}.ifc", work, IfcOptions(schema=schema))
    return {schema: folder / f"{schema}.ifc" for schema in IFC_SCHEMAS}


@pytest.fixture(scope="module")
def files(written: dict[IfcSchema, Path]) -> dict[IfcSchema, File]:
    return {schema: ifcopenshell.open(str(path)) for schema, path in written.items()}


@pytest.fixture
def damaged(written: dict[IfcSchema, Path]) -> File:
    """Give a second copy of the IFC4 file that a test may damage."""
    return ifcopenshell.open(str(written["IFC4"]))


def schema_faults(file: File, express_rules: bool = False) -> list[str]:
    """Return what the schema, and with ``express_rules`` its rules, find wrong."""
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(file, logger, express_rules=express_rules)
    return [str(statement) for statement in logger.statements]


def rule_faults(file: File) -> list[str]:
    """Return what the schema and its express rules find wrong."""
    return schema_faults(file, express_rules=True)


def bad_header(file: File) -> list[str]:
    """Return what is missing in the header, and a view definition that the schema does not have."""
    header, wrong = file.header, []
    views = [f"ViewDefinition [{view}]" for view in VIEWS[file.schema]]
    if len(header.file_description.description) != 1 or header.file_description.description[0] not in views:
        wrong.append("view definition")
    name = header.file_name
    filled = (name.name, name.time_stamp, name.preprocessor_version, name.originating_system, name.authorization)
    if not all(filled) or not all(name.author) or not all(name.organization):
        wrong.append("file name")
    if len(name.originating_system.split(" - ")) != 3:
        wrong.append("originating system")
    return wrong


def _face_sets(file: File) -> Iterator[tuple[int, np.ndarray, list[list[int]]]]:
    """Yield id, points (n, 3) and faces (from 0) of every body of plane faces."""
    if file.schema == "IFC2X3":
        for shell in file.by_type("IfcClosedShell"):
            loops = [[point.id() for point in face.Bounds[0].Bound.Polygon] for face in shell.CfsFaces]
            order = {ident: i for i, ident in enumerate(dict.fromkeys(p for loop in loops for p in loop))}
            points = np.array([file.by_id(ident).Coordinates for ident in order])
            yield shell.id(), points, [[order[ident] for ident in loop] for loop in loops]
        return
    for body in file.by_type("IfcTriangulatedFaceSet"):
        yield body.id(), np.array(body.Coordinates.CoordList), [[i - 1 for i in face] for face in body.CoordIndex]


def open_or_inverted(file: File) -> list[int]:
    """Return the bodies that are not closed (each edge once in each direction) or whose faces turn inwards."""
    wrong = []
    for ident, points, faces in _face_sets(file):
        edges = Counter(edge for face in faces for edge in zip(face, face[1:] + face[:1], strict=True))
        closed = all(count == 1 and edges[b, a] == 1 for (a, b), count in list(edges.items()))
        a, b, c = (points[np.array(faces)[:, i]] for i in range(3))
        if not closed or np.einsum("ij,ij->", a, np.cross(b, c)) <= 0.0:
            wrong.append(ident)
    wrong += [body.id() for body in _of_type(file, "IfcTriangulatedFaceSet") if not body.Closed]
    return wrong


def _of_type(file: File, entity: str) -> list[ifcopenshell.entity_instance]:
    """Return the instances of an entity, none if the schema does not have it."""
    return list(file.by_type(entity)) if attributes_of(file.schema_identifier, entity) else []


def repeated_points(file: File) -> list[int]:
    """Return the bodies and lines that name a place twice, within the 1e-3 mm of the model's precision."""
    lists = [(ident, points, False) for ident, points, _faces in _face_sets(file)]
    curves = _of_type(file, "IfcIndexedPolyCurve")
    lists += [(curve.id(), np.array(curve.Points.CoordList), False) for curve in curves]
    for line in file.by_type("IfcPolyline"):
        points = np.array([point.Coordinates for point in line.Points])
        lists.append((line.id(), points, bool(line.Points[0] == line.Points[-1])))
    wrong = []
    for ident, points, closed in lists:
        places = points[:-1] if closed else points
        if len({tuple(place) for place in np.round(places, 3).tolist()}) < len(places):
            wrong.append(ident)
    return wrong


def badly_contained(file: File) -> list[str]:
    """Return elements that hang in no or in two wholes, or are placed relative to something else than their whole."""
    wrong = []
    for element in file.by_type("IfcElement"):
        wholes = [relation.RelatingObject for relation in element.Decomposes]
        wholes += [relation.RelatingStructure for relation in element.ContainedInStructure]
        if len(wholes) != 1 or element.ObjectPlacement.PlacementRelTo != wholes[0].ObjectPlacement:
            wrong.append(element.Name)
    contained = [relation.RelatedElements for relation in file.by_type("IfcRelContainedInSpatialStructure")]
    if [[element.is_a() for element in elements] for elements in contained] != [["IfcElementAssembly"]]:
        wrong.append("the storey")
    return wrong


def badly_typed(file: File) -> list[str]:
    """Return parts without one type that says what they are, or that say it themselves; assemblies have no type.

    IFC2X3 has no predefined types for some kinds: there a word has to do.
    """
    wrong = []
    for element in file.by_type("IfcElement"):
        kinds = [kind for relation in element.IsDefinedBy for kind in [getattr(relation, "RelatingType", None)] if kind]
        kinds = kinds if file.schema == "IFC2X3" else [relation.RelatingType for relation in element.IsTypedBy]
        if element.is_a("IfcElementAssembly"):
            good = not kinds and element.PredefinedType == "USERDEFINED" and bool(element.ObjectType)
        else:
            good = len(kinds) == 1 and _says_what_it_is(file, element, kinds[0])
        if not good:
            wrong.append(element.Name)
    return wrong


def _says_what_it_is(file: File, element: ifcopenshell.entity_instance, kind: ifcopenshell.entity_instance) -> bool:
    predefined, word = getattr(kind, "PredefinedType", None), getattr(kind, "ElementType", None)
    if file.schema == "IFC2X3" and predefined is None:
        return bool(element.ObjectType) and kind.is_a("IfcTypeProduct")
    return bool(
        kind.is_a(f"{element.is_a()}Type")
        and predefined not in (None, "NOTDEFINED")
        and getattr(element, "PredefinedType", None) is None
        and element.ObjectType == word
        and (predefined == "USERDEFINED") == bool(word)
    )


def badly_represented(file: File) -> list[int]:
    """Return shapes outside of the Body and Axis sub-contexts, or of another type than their items say."""
    wrong = []
    for shape in file.by_type("IfcShapeRepresentation"):
        context = shape.ContextOfItems
        good = (
            context.is_a("IfcGeometricRepresentationSubContext")
            and context.ParentContext.ContextType == "Model"
            and (shape.RepresentationIdentifier, context.ContextIdentifier, context.TargetView)
            in (("Body", "Body", "MODEL_VIEW"), ("Axis", "Axis", "GRAPH_VIEW"))
        )
        kinds = {item.is_a() for item in shape.Items}
        if shape.RepresentationType == "MappedRepresentation":
            good = good and kinds == {"IfcMappedItem"}
        elif shape.RepresentationIdentifier == "Body":
            good = good and kinds == {BODY_TYPES.get(shape.RepresentationType)}
        else:
            good = good and shape.RepresentationType == "Curve3D"
        if not good:
            wrong.append(shape.id())
    return wrong


def repeated_guids(file: File) -> list[str]:
    counts = Counter(root.GlobalId for root in file.by_type("IfcRoot"))
    return [ident for ident, count in counts.items() if count > 1]


def unstyled(file: File) -> list[int]:
    """Return the body items that carry no colour themselves."""
    items = [item for entity in BODY_TYPES.values() for item in _of_type(file, entity)]
    return [item.id() for item in items if not any(each.is_a("IfcStyledItem") for each in file.get_inverse(item))]


QUANTITIES = {
    "Q_LENGTH": "IfcQuantityLength",
    "Q_AREA": "IfcQuantityArea",
    "Q_VOLUME": "IfcQuantityVolume",
    "Q_WEIGHT": "IfcQuantityWeight",
}
OWN_SETS = {"AAG_Fabrication", "AAG_Assembly", "AAG_Step"}


def _rows(file: File) -> Iterator[tuple[str, str, str, str, str]]:
    """Yield (set, entity that has it, its kind, property, measure) of everything in sets that are not our own."""
    for relation in file.by_type("IfcRelDefinesByProperties"):
        definition, owner = relation.RelatingPropertyDefinition, relation.RelatedObjects[0]
        quantities = definition.is_a("IfcElementQuantity")
        if definition.Name in OWN_SETS or (quantities and file.schema == "IFC2X3"):
            continue
        typed = [each.RelatingType for each in getattr(owner, "IsTypedBy", ())]
        kind = getattr(typed[0], "PredefinedType", "") if typed else ""
        for each in definition.Quantities if quantities else definition.HasProperties:
            measure = each.is_a() if quantities else getattr(each, "NominalValue", None) or each.ListValues[0]
            yield definition.Name, owner.is_a(), kind, each.Name, measure if quantities else measure.is_a()
    if file.schema != "IFC2X3":
        for each in file.by_type("IfcMaterialProperties"):
            kind = each.Material.Category.capitalize()
            for value in each.Properties:
                yield each.Name, "IfcMaterial", kind, value.Name, value.NominalValue.is_a()


def not_in_the_standard(file: File) -> list[str]:
    """Return the standard sets that the schema does not have or not for their entity, and properties of wrong measure.

    Against the set templates of buildingSMART; sets of our own must not look like standard ones.
    """
    templates = ifcopenshell.util.pset.PsetQto("IFC4X3" if file.schema == "IFC4X3" else file.schema)
    wrong = [name for name in OWN_SETS if name.lower().startswith(("pset", "qto"))]
    for title, entity, kind, name, measure in sorted(set(_rows(file))):
        template = templates.get_by_name(title)
        applicable = template and title in templates.get_applicable_names(entity, kind)
        row = next((each for each in template.HasPropertyTemplates if each.Name == name), None) if template else None
        expected = row and (QUANTITIES.get(row.TemplateType) or row.PrimaryMeasureType)
        if not applicable or measure != expected:
            wrong.append(f"{title}.{name} of {entity}: {measure}")
    return wrong


CHECKS: tuple[Callable[[File], list[object]], ...] = (
    bad_header, open_or_inverted, repeated_points, badly_contained, badly_typed, badly_represented, repeated_guids,
    unstyled, not_in_the_standard,
)  # fmt: skip


@pytest.mark.parametrize("schema", IFC_SCHEMAS)
@pytest.mark.parametrize("check", CHECKS)
def test_nothing_is_wrong_with_the_file(
    files: dict[IfcSchema, File], schema: IfcSchema, check: Callable[[File], list[object]]
) -> None:
    assert check(files[schema]) == []


@pytest.mark.parametrize("schema", IFC_SCHEMAS)
def test_the_file_keeps_all_rules_of_its_schema(files: dict[IfcSchema, File], schema: IfcSchema) -> None:
    assert rule_faults(files[schema]) == []


def _name_a_view_of_another_schema(file: File) -> None:
    file.header.file_description.description = ("ViewDefinition [CoordinationView_V2.0]",)


def _leave_the_author_out(file: File) -> None:
    file.header.file_name.author = ("",)


def _remove_title_of_assembly(file: File) -> None:
    file.by_type("IfcElementAssembly")[0].ObjectType = None


def _claim_own_type(file: File) -> None:
    file.by_type("IfcMember")[0].PredefinedType = "USERDEFINED"


def _leave_the_type_undefined(file: File) -> None:
    file.by_type("IfcPlateType")[0].PredefinedType = "NOTDEFINED"


def _turn_one_face(file: File) -> None:
    body = file.by_type("IfcTriangulatedFaceSet")[0]
    first, *rest = body.CoordIndex
    body.CoordIndex = [first[::-1], *rest]


def _leave_one_face_out(file: File) -> None:
    body = file.by_type("IfcTriangulatedFaceSet")[0]
    body.CoordIndex = body.CoordIndex[1:]


def _turn_inside_out(file: File) -> None:
    body = file.by_type("IfcTriangulatedFaceSet")[0]
    body.CoordIndex = [face[::-1] for face in body.CoordIndex]


def _repeat_a_point_of_a_body(file: File) -> None:
    points = file.by_type("IfcTriangulatedFaceSet")[0].Coordinates
    points.CoordList = [*points.CoordList, points.CoordList[0]]


def _repeat_a_point_of_an_axis(file: File) -> None:
    points = file.by_type("IfcIndexedPolyCurve")[0].Points
    points.CoordList = [points.CoordList[0], *points.CoordList]


def _contain_a_plank_as_well(file: File) -> None:
    relation = file.by_type("IfcRelContainedInSpatialStructure")[0]
    relation.RelatedElements = [*relation.RelatedElements, file.by_type("IfcMember")[0]]


def _place_a_plank_in_the_world(file: File) -> None:
    file.by_type("IfcMember")[0].ObjectPlacement.PlacementRelTo = None


def _draw_in_the_main_context(file: File) -> None:
    shape = file.by_type("IfcShapeRepresentation")[0]
    shape.ContextOfItems = shape.ContextOfItems.ParentContext


def _call_a_mesh_a_sweep(file: File) -> None:
    shapes = file.by_type("IfcShapeRepresentation")
    next(shape for shape in shapes if shape.RepresentationType == "Tessellation").RepresentationType = "SweptSolid"


def _repeat_a_guid(file: File) -> None:
    first, second, *_ = file.by_type("IfcMember")
    second.GlobalId = first.GlobalId


def _remove_a_colour(file: File) -> None:
    file.remove(file.by_type("IfcStyledItem")[0])


def _set_named(file: File, name: str) -> ifcopenshell.entity_instance:
    return next(each for each in file.by_type("IfcPropertySetDefinition") if each.Name == name)


def _invent_a_property(file: File) -> None:
    _set_named(file, "Pset_MemberCommon").HasProperties[0].Name = "Mark"


def _invent_a_standard_set(file: File) -> None:
    _set_named(file, "Pset_PlateCommon").Name = "Pset_Gridshell"


def _give_members_a_set_of_plates(file: File) -> None:
    _set_named(file, "Pset_MemberCommon").Name = "Pset_PlateCommon"


def _give_a_text_for_a_truth(file: File) -> None:
    rows = _set_named(file, "Pset_MemberCommon").HasProperties
    next(row for row in rows if row.Name == "LoadBearing").NominalValue = file.create_entity("IfcLabel", "yes")


@pytest.mark.parametrize(
    ("damage", "check"),
    [
        (_name_a_view_of_another_schema, bad_header),
        (_leave_the_author_out, bad_header),
        (_remove_title_of_assembly, rule_faults),
        (_turn_one_face, open_or_inverted),
        (_leave_one_face_out, open_or_inverted),
        (_turn_inside_out, open_or_inverted),
        (_repeat_a_point_of_a_body, repeated_points),
        (_repeat_a_point_of_an_axis, repeated_points),
        (_contain_a_plank_as_well, badly_contained),
        (_place_a_plank_in_the_world, badly_contained),
        (_claim_own_type, badly_typed),
        (_leave_the_type_undefined, badly_typed),
        (_draw_in_the_main_context, badly_represented),
        (_call_a_mesh_a_sweep, badly_represented),
        (_repeat_a_guid, repeated_guids),
        (_remove_a_colour, unstyled),
        (_invent_a_property, not_in_the_standard),
        (_invent_a_standard_set, not_in_the_standard),
        (_give_members_a_set_of_plates, not_in_the_standard),
        (_give_a_text_for_a_truth, not_in_the_standard),
    ],
)
def test_each_check_finds_its_fault_in_a_damaged_file(
    damaged: File, damage: Callable[[File], None], check: Callable[[File], list[object]]
) -> None:
    damage(damaged)
    assert check(damaged) != []


@pytest.mark.slow
def test_the_whole_vault_with_its_plan_is_valid_and_no_larger_than_8_mb(gridshell: Gridshell, tmp_path: Path) -> None:
    write_ifc(gridshell, tmp_path / "vault.ifc", work_of(gridshell, 6))
    assert (tmp_path / "vault.ifc").stat().st_size < 8e6
    file = ifcopenshell.open(str(tmp_path / "vault.ifc"))
    assert rule_faults(file) == []
    assert [fault for check in CHECKS for fault in check(file)] == []


@pytest.mark.parametrize("schema", ["IFC4", "IFC4X3_ADD2"])
def test_b_spline_bodies_keep_all_rules_too(gridshell: Gridshell, schema: IfcSchema) -> None:
    sample = sampled(gridshell, of_a_kind=1)
    one = replace(sample, shells=sample.shells[:1], blades=(), bolts=(), joints=())
    file = ifc_model(one, options=IfcOptions(schema=schema, geometry="brep")).file
    assert rule_faults(file) == []
    assert len(file.by_type("IfcAdvancedBrep")) > 0


@pytest.mark.parametrize("name", ["vault-optimised", "triple-arch", "half-roof", "column"])
def test_a_cut_of_every_shipped_design_is_valid_in_every_schema(name: str) -> None:
    """The web is not optimised first: that moves points, but makes no other parts."""
    cut = sampled(gridshell_of(load_design(name).model_copy(update={"optimise": None})), of_a_kind=1)
    for schema in IFC_SCHEMAS:
        file = ifc_model(cut, options=IfcOptions(schema=schema)).file
        assert schema_faults(file) == []
        assert [fault for check in CHECKS for fault in check(file)] == []
