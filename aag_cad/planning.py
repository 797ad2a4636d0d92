"""Planning alone: a design, a gridshell.json or any graph of parts -> plan -> files; or why a part comes then."""

from dataclasses import dataclass, replace
from pathlib import Path

import networkx as nx

from aag_cad.design import load_design
from aag_cad.design_making import Crew
from aag_cad.errors import DesignError, FileError
from aag_cad.export.office.plan_files import (
    PLAN_OUTPUTS,
    PlanDossier,
    graph_dossier,
    gridshell_dossier,
    write_plan_output,
)
from aag_cad.files import json_object, publishing, read_text, sizes_below
from aag_cad.findings import Finding
from aag_cad.language import Language, printed
from aag_cad.parts.model import Gridshell
from aag_cad.parts.store import read_gridshell
from aag_cad.pipeline import Report, checked_plans, gridshell_of
from assembly.base.errors import PlanError
from assembly.base.phases import is_down
from assembly.base.segments import Limits
from assembly.booklet.plan_file import PlanFile, read_plan
from assembly.checks.findings import disassembly_faults, graph_plan_faults, plan_faults, schedule_faults
from assembly.graph.files import graph_text, read_graph, read_graphml, shipped_graphs
from assembly.graph.whole import whole_graph
from assembly.plan.durations import step_minutes
from assembly.plan.explain import explanation
from assembly.plan.graph_plan import graph_plan
from assembly.plan.planned import NO_LIMITS, limits_of, planned_of
from assembly.plan.schedule import schedule_of

# For what names no crew: four people who lift 25 kg each (EN 1005-2, the mass that most adults may lift).
FOUR = Crew.model_validate({"people": 4, "lift_limit": 25.0})
_GRAPHML = (".graphml", ".xml")
STAGES = 2 + len(PLAN_OUTPUTS)


@dataclass(frozen=True)
class Source:
    """What is planned, a gridshell or any networkx graph of parts, by which crew and for which transport."""

    name: str
    crew: Crew
    limits: Limits
    whole: "Gridshell | nx.Graph[str]"


def read_source(source: str, people: int | None = None, limits: Limits | None = None) -> Source:
    """Return what a design (file or shipped name), a gridshell.json, or a graph (file or shipped name) asks to plan.

    ``people`` and ``limits`` stand in place of the crew and the transport of the design. FileError, DesignError or
    PlanError where the source cannot be read.
    """
    ending, crew = Path(source).suffix.lower(), _crew_with(FOUR, people)
    if source in shipped_graphs() or ending in (".json", *_GRAPHML):
        text = graph_text(source) if source in shipped_graphs() else read_text(source)
        keys = {"graphml"} if ending in _GRAPHML else set(json_object(text, source))
        if "shells" in keys:
            gridshell = read_gridshell(text)
            return Source(gridshell.name, crew, limits or NO_LIMITS, gridshell)
        if keys & {"nodes", "graphml"}:
            graph = read_graphml(text) if "graphml" in keys else read_graph(text)
            return Source(Path(source).stem, crew, limits or NO_LIMITS, graph)
        raise FileError(f"{source}: neither a gridshell (key shells) nor a graph of parts (keys nodes and edges)")
    design = load_design(source)
    crew = _crew_with(design.crew, people)
    return Source(design.project.name, crew, limits or limits_of(design.transport), gridshell_of(design))


def _crew_with(crew: Crew, people: int | None) -> Crew:
    if people is None:
        return crew
    least, most = 1, 40
    if not least <= people <= most:
        raise DesignError(f"--crew: {people} people; allowed {least} to {most}")
    return crew.model_copy(update={"people": people})


def planned_source(source: Source, language: Language = "en", edges_first: bool = True) -> PlanDossier:
    """Return the plan of a source with what its files are written from; PlanError where it cannot be planned.

    ``edges_first``: edge planks are fixed before all geodesics, as in the paper.
    """
    whole, crew = source.whole, source.crew
    if isinstance(whole, Gridshell):
        return gridshell_dossier(checked_plans(whole, crew, source.limits, edges_first), whole, crew, language)
    graph = whole_graph(whole)
    plan = graph_plan(graph, crew.people, crew.lift_limit)
    plan = replace(plan, findings=(*plan.findings, *graph_plan_faults(plan, graph, crew.people)))
    schedule = schedule_of(plan, step_minutes(plan, graph, crew.minutes), crew.people, crew.hours_per_day)
    return graph_dossier(plan, schedule, graph, crew, language, source.limits)


def plan_in(path: str) -> PlanFile:
    """Return the plan in a file; FileError if the file cannot be read, PlanError with its path if it is no plan."""
    try:
        return read_plan(read_text(path))
    except PlanError as error:
        raise PlanError(f"{path}: {error}") from error


def file_faults(file: PlanFile, gridshell: Gridshell, crew: Crew, limits: Limits) -> tuple[Finding, ...]:
    """Return what independent walks find wrong with the plan of a file, of putting a gridshell together or down.

    ``limits`` are those of the transport that it is cut for.
    """
    plan, times = file.plan, {each.step.id: (each.time.start_minute, each.time.end_minute) for each in file.steps}
    timed = schedule_faults(plan, times, file.people)
    if any(is_down(step.phase) for step in plan.steps):
        return (*disassembly_faults(plan, gridshell), *timed)
    planned = planned_of(gridshell, crew, limits)
    return (*plan_faults(plan, gridshell, planned.segmentation, planned.locking), *timed)


def write_plan(dossier: PlanDossier, folder: Path, report: Report = lambda stage: None) -> dict[str, int]:
    """Write the files of a plan into a folder, all or none; return their sizes. FileError if it cannot be written."""
    with publishing(folder) as staging:
        for output in PLAN_OUTPUTS:
            report(output)
            write_plan_output(dossier, output, staging)
        return sizes_below(staging)


def explained(dossier: PlanDossier, mark: str) -> list[str]:
    """Return why a part or beam comes when it does, one line each; PlanError if nothing has the mark."""
    lines = explanation(dossier.graph(), dossier.plan, mark, dossier.schedule, dossier.locking)
    return [printed(line, dossier.language) for line in lines]
