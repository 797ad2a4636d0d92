"""What each kind of part is in IFC, against the schemas."""

import ifcopenshell
import pytest

from aag_cad.export.ifc.options import IFC_SCHEMAS, IfcSchema
from aag_cad.export.ifc.schemas import attributes_of, type_entity, type_word
from aag_cad.parts.kinds import KINDS, IfcKind
from aag_cad.parts.model import Footing, Plank, Shoe

IFC_KINDS = [row.ifc for row in KINDS.values()]


@pytest.mark.parametrize("schema", IFC_SCHEMAS)
@pytest.mark.parametrize("kind", IFC_KINDS, ids=lambda kind: f"{kind.entity} {kind.predefined}")
def test_the_schema_knows_the_entity_and_the_predefined_type(kind: IfcKind, schema: IfcSchema) -> None:
    """Where a type object has a predefined type at all: IFC2X3 has none for fasteners, accessories and footings."""
    assert attributes_of(schema, kind.entity)
    declaration = ifcopenshell.schema_by_name(schema).declaration_by_name(type_entity(schema, kind))
    attributes = {each.name(): each for each in declaration.as_entity().all_attributes()}
    if "PredefinedType" in attributes:
        allowed = attributes["PredefinedType"].type_of_attribute().declared_type().as_enumeration_type()
        assert kind.predefined in allowed.enumeration_items()
    else:
        assert schema == "IFC2X3"
        assert kind.entity in ("IfcMechanicalFastener", "IfcDiscreteAccessory", "IfcFooting")


@pytest.mark.parametrize("kind", IFC_KINDS, ids=lambda kind: f"{kind.entity} {kind.predefined}")
def test_only_user_defined_types_have_a_word_of_their_own(kind: IfcKind) -> None:
    assert (kind.predefined == "USERDEFINED") == bool(kind.element_type)


def test_in_ifc2x3_a_word_stands_for_the_predefined_type_that_is_missing() -> None:
    assert type_word("IFC2X3", KINDS[Shoe].ifc) == "SHOE"
    assert type_word("IFC2X3", KINDS[Footing].ifc) == "PAD_FOOTING"
    assert type_word("IFC2X3", KINDS[Plank].ifc) is None
    assert type_word("IFC4", KINDS[Shoe].ifc) is None
