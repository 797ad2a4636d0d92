"""The set ``AAG_Assembly``: to which segment each part belongs, and in which step of the plan it is put in place."""

from collections.abc import Iterable, Mapping

from aag_cad.export.ifc.frame import Entity, IfcModel
from aag_cad.export.ifc.schedule import PlannedWork
from aag_cad.export.ifc.sets import Property, write_property_set
from aag_cad.parts.marks import shell_of, shells_of
from aag_cad.parts.model import Part
from assembly.base.segments import Segmentation
from assembly.base.steps import Step

ASSEMBLY = "AAG_Assembly"


def part_segments(segmentation: Segmentation | None) -> dict[str, str]:
    """Return the segment of each part of a cut shell: those in which a plank is cut are listed, ``S1.1 S1.2``."""
    found: dict[str, list[str]] = {}
    for segment in segmentation.segments if segmentation else ():
        for mark in (*segment.parts, *(piece.plank for piece in segment.pieces)):
            found.setdefault(mark, []).append(segment.name)
    return {mark: " ".join(names) for mark, names in found.items()}


def segment_of(mark: str, segments: Mapping[str, str]) -> str:
    """Return the segment of a part, or what it is added to on site: its shell, or the two that it lies between."""
    return segments.get(mark) or shell_of(mark) or "-".join(shells_of(mark))


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
    model: IfcModel, parts: Iterable[Part], occurrences: Mapping[str, Entity], work: PlannedWork | None
) -> None:
    """Write one set for all parts of a segment that are put in place in the same step."""
    step_of = {mark: step for step in work.plan.steps for mark in step.marks} if work else {}
    segments = part_segments(work.segmentation) if work else {}
    groups: dict[tuple[str, str], list[str]] = {}
    for part in parts:
        step = step_of.get(part.mark)
        groups.setdefault((segment_of(part.mark, segments), step.id if step else ""), []).append(part.mark)
    for (segment, ident), marks in groups.items():
        rows = _group_rows(segment, step_of.get(marks[0]))
        write_property_set(model, ASSEMBLY, f"{segment}/{ident}", rows, [occurrences[mark] for mark in marks])
