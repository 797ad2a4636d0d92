"""The set ``AAG_Assembly``: to which segment each part belongs, and in which step of the plan it is put in place."""

from collections.abc import Iterable, Mapping, Sequence

from aag_cad.export.ifc.frame import Entity, IfcModel
from aag_cad.export.ifc.sets import Property, write_property_set
from aag_cad.parts.marks import shells_of
from aag_cad.parts.model import Part
from assembly.base.steps import Step

ASSEMBLY = "AAG_Assembly"


def segment_of(mark: str) -> str:
    """Return the segment of a part: the mark of its shell, or of the two shells that it lies between, as S1-S2."""
    return "-".join(shells_of(mark))


def _group_rows(segment: str, step: Step | None) -> list[Property]:
    rows: list[Property] = [("Segment", "IfcLabel", segment)]
    if step is not None:
        rows += [
            ("Step", "IfcIdentifier", step.id),
            ("StepNumber", "IfcInteger", step.number),
            ("Phase", "IfcLabel", step.phase),
        ]
    return rows


def write_assembly_sets(
    model: IfcModel, parts: Iterable[Part], occurrences: Mapping[str, Entity], steps: Sequence[Step]
) -> None:
    """Write one set for all parts of a segment that are put in place in the same step."""
    step_of = {mark: step for step in steps for mark in step.marks}
    groups: dict[tuple[str, str], list[str]] = {}
    for part in parts:
        step = step_of.get(part.mark)
        groups.setdefault((segment_of(part.mark), step.id if step else ""), []).append(part.mark)
    for (segment, ident), marks in groups.items():
        rows = _group_rows(segment, step_of.get(marks[0]))
        write_property_set(model, ASSEMBLY, f"{segment}/{ident}", rows, [occurrences[mark] for mark in marks])
