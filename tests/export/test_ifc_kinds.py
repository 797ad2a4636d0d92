"""What each kind of part is in IFC, against the IFC4 schema."""

from typing import get_args

import ifcopenshell
import pytest

from aag_cad.export.ifc_kinds import IFC_KINDS, IfcKind
from aag_cad.parts.model import Part

SCHEMA = ifcopenshell.schema_by_name("IFC4")


def test_every_kind_of_part_has_an_entity() -> None:
    assert set(IFC_KINDS) == set(get_args(Part))


@pytest.mark.parametrize("kind", IFC_KINDS.values(), ids=lambda kind: f"{kind.entity} {kind.predefined}")
def test_the_schema_knows_the_entity_and_the_predefined_type(kind: IfcKind) -> None:
    attributes = SCHEMA.declaration_by_name(f"{kind.entity}Type").as_entity().all_attributes()
    allowed = next(each for each in attributes if each.name() == "PredefinedType").type_of_attribute()
    assert kind.predefined in allowed.declared_type().as_enumeration_type().enumeration_items()


@pytest.mark.parametrize("kind", IFC_KINDS.values(), ids=lambda kind: f"{kind.entity} {kind.predefined}")
def test_only_user_defined_types_have_a_word_of_their_own(kind: IfcKind) -> None:
    assert (kind.predefined == "USERDEFINED") == bool(kind.element_type)
