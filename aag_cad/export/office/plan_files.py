"""The files of what is planned, alike for gridshells and for any graph of parts: steps, schedule, booklets, graph."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TypeAlias

import networkx as nx

from aag_cad.design_making import Crew
from aag_cad.files import write_csv, write_text
from aag_cad.findings import Finding, worst_first
from aag_cad.language import Language
from aag_cad.parts.model import Gridshell
from assembly.base.locking_order import LockingOrder
from assembly.base.segments import Limits, Segmentation
from assembly.base.steps import Plan
from assembly.booklet.calendar import write_calendar
from assembly.booklet.contents import common_of, disassembly_booklet, sequence_booklet
from assembly.booklet.gantt import gantt_svg
from assembly.booklet.graph_booklet import graph_booklet
from assembly.booklet.pdf import write_booklets
from assembly.booklet.plan_file import Piece, PlanFile, graph_pieces, gridshell_pieces, plan_file, plan_json
from assembly.booklet.schedule_table import SCHEDULE_HEADER, schedule_rows
from assembly.booklet.segment_cards import SEGMENTS_HEADER, SPLICES_HEADER, segment_rows, splice_rows
from assembly.graph.files import graph_json, graphml
from assembly.graph.gridshell_graph import assembly_graph
from assembly.pictures.laying_plan import laying_rows
from assembly.pictures.locking_chart import LOCKING_HEADER, locking_rows, locking_svg
from assembly.plan.clock import clock_of
from assembly.plan.planned import NO_LIMITS, Planned
from assembly.plan.schedule import Schedule
from assembly.transport.graph_groups import partition_graph

LAYING_HEADER = ("shell", "mark", "what", "x_mm", "y_mm", "end_x_mm", "end_y_mm")
GROUPS_HEADER = ("segment", "parts", "mass_kg", "marks")

_Write: TypeAlias = Callable[[Path], None]


@dataclass(frozen=True)
class PlanDossier:
    """What is planned of a gridshell or of any graph of parts, for whom, and what its files are written from.

    ``pieces`` makes its parts, ``graph`` their graph; ``own`` are the files that only its kind has, by output.
    """

    title: str
    plan: Plan
    schedule: Schedule
    crew: Crew
    language: Language
    findings: tuple[Finding, ...]
    pieces: Callable[[], tuple[Piece, ...]]
    graph: Callable[[], "nx.MultiGraph[str]"]
    own: Mapping[str, _Write]
    locking: tuple[LockingOrder, ...] = ()
    segmentation: Segmentation | None = None

    @property
    def file(self) -> PlanFile:
        """What plan.json holds."""
        return plan_file(self.plan, self.schedule, self.crew, self.pieces(), self.segmentation)


def _write_plan(dossier: PlanDossier, folder: Path) -> None:
    write_text(folder / "plan.json", plan_json(dossier.file))


def _write_schedule(dossier: PlanDossier, folder: Path) -> None:
    """Write the schedule as table and chart and, if the crew has a first working day, as calendar."""
    plan, schedule, language = dossier.plan, dossier.schedule, dossier.language
    write_csv(folder / "tables" / "schedule.csv", SCHEDULE_HEADER, schedule_rows(plan, schedule, language))
    write_text(folder / "schedule.svg", gantt_svg(plan, schedule, dossier.title, language))
    if clock := clock_of(schedule, dossier.crew):
        write_calendar(plan, schedule, clock, folder / "schedule.ics", language)


def _write_graph(dossier: PlanDossier, folder: Path) -> None:
    graph = dossier.graph()
    write_text(folder / "graph.json", graph_json(graph))
    write_text(folder / "graph.graphml", graphml(graph))


# By output, what is written alike of all that is planned: of gridshells and of graphs.
_ALIKE: dict[str, Callable[[PlanDossier, Path], None]] = {
    "plan": _write_plan, "schedule": _write_schedule, "graph": _write_graph,
}  # fmt: skip
PLAN_OUTPUTS = ("plan", "schedule", "locking", "segments", "sequence", "graph")


def write_plan_output(dossier: PlanDossier, output: str, folder: Path) -> None:
    """Write the files of one of ``PLAN_OUTPUTS`` into a folder; FileError if one cannot be written."""
    if output in _ALIKE:
        _ALIKE[output](dossier, folder)
    if output in dossier.own:
        dossier.own[output](folder)


def gridshell_dossier(planned: Planned, gridshell: Gridshell, crew: Crew, language: Language = "en") -> PlanDossier:
    """Return all that is planned for a gridshell with its own files: taking down, laying, locking, segments."""

    def write_others(folder: Path) -> None:
        pieces = gridshell_pieces(gridshell)
        down = plan_file(planned.down, planned.down_schedule, crew, pieces, planned.segmentation)
        write_text(folder / "disassembly.json", plan_json(down))
        # Where every member and stud lies on the floor, shell by shell, for setting out with tapes.
        laid = ((shell, planned.flat[shell.mark]) for shell in gridshell.shells if shell.mark in planned.flat)
        rows = ((shell.mark, *row) for shell, state in laid for row in laying_rows(shell, state, language))
        write_csv(folder / "tables" / "laying.csv", LAYING_HEADER, rows)

    def write_locking(folder: Path) -> None:
        steps = (row for order in planned.locking for row in locking_rows(order))
        write_csv(folder / "tables" / "locking.csv", LOCKING_HEADER, steps)
        write_text(folder / "locking.svg", locking_svg(planned.locking[0], language))

    def write_sequence(folder: Path) -> None:
        common = common_of(gridshell, language)
        makers = {"sequence": sequence_booklet, "disassembly": disassembly_booklet}
        write_booklets(folder, {name: partial(make, planned, common) for name, make in makers.items()})

    def write_segments(folder: Path) -> None:
        tables = folder / "tables"
        write_csv(tables / "segments.csv", SEGMENTS_HEADER, segment_rows(planned.segmentation))
        write_csv(tables / "splices.csv", SPLICES_HEADER, splice_rows(planned.segmentation))

    return PlanDossier(
        title=gridshell.title,
        plan=planned.plan,
        schedule=planned.schedule,
        crew=crew,
        language=language,
        findings=worst_first(planned.findings),
        pieces=lambda: gridshell_pieces(gridshell),
        graph=lambda: assembly_graph(gridshell),
        own={
            "plan": write_others,
            "locking": write_locking,
            "segments": write_segments,
            "sequence": write_sequence,
        },
        locking=planned.locking,
        segmentation=planned.segmentation,
    )


def graph_dossier(
    plan: Plan,
    schedule: Schedule,
    graph: "nx.MultiGraph[str]",
    crew: Crew,
    language: Language = "en",
    limits: Limits = NO_LIMITS,
) -> PlanDossier:
    """Return all that is planned for a graph of parts; with the groups of its parts that fit a transport, if limited.

    Their writer raises PlanError if a part alone is too heavy.
    """

    def write_groups(folder: Path) -> None:
        rows = []
        for number, group in enumerate(partition_graph(graph, limits), start=1):
            mass = sum(float(graph.nodes[mark]["mass_kg"]) for mark in group)
            rows.append((str(number), str(len(group)), f"{mass:.1f}", " ".join(sorted(group))))
        write_csv(folder / "tables" / "segments.csv", GROUPS_HEADER, rows)

    def write_sequence(folder: Path) -> None:
        write_booklets(folder, {"sequence": partial(graph_booklet, graph, plan, schedule, language)})

    limited: dict[str, _Write] = {} if limits == NO_LIMITS else {"segments": write_groups}
    return PlanDossier(
        title=plan.name,
        plan=plan,
        schedule=schedule,
        crew=crew,
        language=language,
        findings=worst_first(plan.findings),
        pieces=lambda: graph_pieces(graph),
        graph=lambda: graph,
        own={"sequence": write_sequence} | limited,
    )
