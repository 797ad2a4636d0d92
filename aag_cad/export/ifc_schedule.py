"""The assembly plan in IFC: one task for each step, in a work schedule."""

from collections.abc import Mapping, Sequence

from aag_cad.export.ifc_base import TIMESTAMP, Entity, IfcModel, guid
from assembly.steps import Step


def _task(model: IfcModel, step: Step) -> Entity:
    return model.file.create_entity(
        "IfcTask", guid(model.project_id, "task", step.id), None, step.title, " ".join(step.instructions) or None,
        step.phase, step.id, IsMilestone=False, PredefinedType="INSTALLATION",
    )  # fmt: skip


def _write_step(model: IfcModel, step: Step, tasks: Mapping[str, Entity], elements: Mapping[str, Entity]) -> None:
    """Write what a step puts into place and what must be finished before it."""
    for before in step.predecessors:
        model.file.create_entity(
            "IfcRelSequence", guid(model.project_id, "sequence", before, step.id), None, None, None,
            tasks[before], tasks[step.id], None, "FINISH_START",
        )  # fmt: skip
    for mark in dict.fromkeys((*step.marks, *step.assemblies)):
        model.file.create_entity(
            "IfcRelAssignsToProduct", guid(model.project_id, "built", step.id, mark), None, None, None,
            [tasks[step.id]], None, elements[mark],
        )  # fmt: skip


def write_schedule(model: IfcModel, name: str, steps: Sequence[Step], elements: Mapping[str, Entity]) -> None:
    """Write the steps in their order; ``elements`` holds parts and assemblies by mark.

    The schedule says what follows what; the dates that IFC demands of it are the file's neutral time stamp.
    """
    schedule = model.file.create_entity(
        "IfcWorkSchedule", guid(model.project_id, "schedule"), None, f"Assembly of {name}",
        CreationDate=TIMESTAMP, StartTime=TIMESTAMP, PredefinedType="PLANNED",
    )  # fmt: skip
    model.file.create_entity(
        "IfcRelDeclares", guid(model.project_id, "declares", "schedule"), None, None, None, model.project, [schedule]
    )
    tasks = {step.id: _task(model, step) for step in steps}
    if tasks:
        model.file.create_entity(
            "IfcRelAssignsToControl", guid(model.project_id, "scheduled"), None, None, None,
            list(tasks.values()), None, schedule,
        )  # fmt: skip
    for step in steps:
        _write_step(model, step, tasks, elements)
