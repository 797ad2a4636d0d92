"""The files of a plan: what is done, when, in which order, in which segments; the booklets and the graph."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import networkx as nx

from aag_cad.design_making import Crew
from aag_cad.export.office.tables import write_locking_table, write_segment_tables
from aag_cad.files import write_csv, write_text
from aag_cad.language import Language
from aag_cad.parts.model import Gridshell
from assembly.base.segments import Limits
from assembly.base.steps import Plan
from assembly.booklet.calendar import write_calendar
from assembly.booklet.gantt import gantt_svg
from assembly.booklet.graph_page import graph_html
from assembly.booklet.pdf import write_booklets
from assembly.booklet.plan_file import graph_pieces, gridshell_pieces, plan_file, plan_json
from assembly.booklet.schedule_table import SCHEDULE_HEADER, schedule_rows
from assembly.graph.files import graph_json, graphml
from assembly.graph.gridshell_graph import assembly_graph
from assembly.pictures.laying_plan import laying_rows
from assembly.pictures.locking_chart import locking_svg
from assembly.plan.clock import clock_of
from assembly.plan.planned import Planned
from assembly.plan.schedule import Schedule
from assembly.transport.graph_groups import partition_graph

LAYING_HEADER = ("shell", "mark", "what", "x_mm", "y_mm", "end_x_mm", "end_y_mm")
GROUPS_HEADER = ("segment", "parts", "mass_kg", "marks")


@dataclass(frozen=True)
class PlanDossier:
    """What the files of a plan are written from."""

    planned: Planned
    gridshell: Gridshell
    crew: Crew
    language: Language = "en"


def write_schedule(plan: Plan, schedule: Schedule, title: str, crew: Crew, folder: Path, language: Language) -> None:
    """Write the schedule as table and chart and, if the crew has a first working day, as calendar."""
    write_csv(folder / "tables" / "schedule.csv", SCHEDULE_HEADER, schedule_rows(plan, schedule, language))
    write_text(folder / "schedule.svg", gantt_svg(plan, schedule, title, language))
    if clock := clock_of(schedule, crew):
        write_calendar(plan, schedule, clock, folder / "schedule.ics", language)


def _write_laying(dossier: PlanDossier, folder: Path) -> None:
    """Write where every member and stud lies on the floor, shell by shell, for setting out with tapes."""
    flat, language = dossier.planned.flat, dossier.language
    shells = [shell for shell in dossier.gridshell.shells if shell.mark in flat]
    rows = ((shell.mark, *row) for shell in shells for row in laying_rows(shell, flat[shell.mark], language))
    write_csv(folder / "tables" / "laying.csv", LAYING_HEADER, rows)


def _write_plan(dossier: PlanDossier, folder: Path) -> None:
    planned, gridshell, crew = dossier.planned, dossier.gridshell, dossier.crew
    pieces = gridshell_pieces(gridshell)
    up = plan_file(planned.plan, planned.schedule, crew, pieces, planned.segmentation)
    write_text(folder / "plan.json", plan_json(up))
    down = plan_file(planned.down, planned.down_schedule, crew, pieces, planned.segmentation)
    write_text(folder / "disassembly.json", plan_json(down))
    _write_laying(dossier, folder)


def _write_schedule(dossier: PlanDossier, folder: Path) -> None:
    planned = dossier.planned
    write_schedule(planned.plan, planned.schedule, dossier.gridshell.title, dossier.crew, folder, dossier.language)


def _write_locking(dossier: PlanDossier, folder: Path) -> None:
    orders = dossier.planned.locking
    write_locking_table(orders, folder / "tables" / "locking.csv")
    write_text(folder / "locking.svg", locking_svg(orders[0], dossier.language))


def _write_segments(dossier: PlanDossier, folder: Path) -> None:
    tables = folder / "tables"
    write_segment_tables(dossier.planned.segmentation, tables / "segments.csv", tables / "splices.csv")


def _write_sequence(dossier: PlanDossier, folder: Path) -> None:
    write_booklets(dossier.planned, dossier.gridshell, folder, dossier.language)


def _write_graph(dossier: PlanDossier, folder: Path) -> None:
    graph = assembly_graph(dossier.gridshell)
    write_text(folder / "graph.json", graph_json(graph))
    write_text(folder / "graph.graphml", graphml(graph))


PlanWriter: TypeAlias = Callable[[PlanDossier, Path], None]
PLAN_WRITERS: dict[str, PlanWriter] = {
    "plan": _write_plan,
    "schedule": _write_schedule,
    "locking": _write_locking,
    "segments": _write_segments,
    "sequence": _write_sequence,
    "graph": _write_graph,
}


def write_graph_groups(graph: "nx.MultiGraph[str]", limits: Limits, folder: Path) -> None:
    """Write the groups of parts of any graph that fit a transport, with their masses.

    PlanError if a part alone is too heavy.
    """
    rows = []
    for number, group in enumerate(partition_graph(graph, limits), start=1):
        mass = sum(float(graph.nodes[mark]["mass_kg"]) for mark in group)
        rows.append((str(number), str(len(group)), f"{mass:.1f}", " ".join(sorted(group))))
    write_csv(folder / "tables" / "segments.csv", GROUPS_HEADER, rows)


def write_graph_plan(
    graph: "nx.MultiGraph[str]", plan: Plan, schedule: Schedule, crew: Crew, folder: Path, language: Language
) -> None:
    """Write the files of the plan of any graph of parts: plan, schedule, page for phones, and the graph as GraphML."""
    write_text(folder / "plan.json", plan_json(plan_file(plan, schedule, crew, graph_pieces(graph))))
    write_schedule(plan, schedule, plan.name, crew, folder, language)
    write_text(folder / "sequence.html", graph_html(plan, schedule, graph, language))
    write_text(folder / "graph.graphml", graphml(graph))
