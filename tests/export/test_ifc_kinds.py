"""What each kind of part is in IFC, against the schemas."""

from typing import get_args

import ifcopenshell
import pytest

from aag_cad.export.ifc.kinds import IFC_KINDS, IfcKind
from aag_cad.export.ifc.options import IFC_SCHEMAS, IfcSchema
from aag_cad.export.ifc.schemas import attributes_of, type_entity, type_word
from aag_cad.parts.model import Footing, Part, Plank, Shoe


def test_every_kind_of_part_has_an_entity() -> None:
    assert set(IFC_KINDS) == set(get_args(Part))


@pytest.mark.parametrize("schema", IFC_SCHEMAS)
@pytest.mark.parametrize("kind", IFC_KINDS.values(), ids=lambda kind: f"{kind.entity} {kind.predefined}")
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


@pytest.mark.parametrize("kind", IFC_KINDS.values(), ids=lambda kind: f"{kind.entity} {kind.predefined}")
def test_only_user_defined_types_have_a_word_of_their_own(kind: IfcKind) -> None:
    assert (kind.predefined == "USERDEFINED") == bool(kind.element_type)


def test_in_ifc2x3_a_word_stands_for_the_predefined_type_that_is_missing() -> None:
    assert type_word("IFC2X3", IFC_KINDS[Shoe]) == "SHOE"
    assert type_word("IFC2X3", IFC_KINDS[Footing]) == "PAD_FOOTING"
    assert type_word("IFC2X3", IFC_KINDS[Plank]) is None
    assert type_word("IFC4", IFC_KINDS[Shoe]) is None
