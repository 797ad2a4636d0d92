"""The whole way in one place: design -> surface -> web -> curves -> parts -> findings and plan -> files."""

import json
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from aag_cad.audit import audit
from aag_cad.design import Design
from aag_cad.design_making import Crew
from aag_cad.design_tables import (
    ArcSurface,
    CatenoidSurface,
    CrpcSurface,
    HyperboloidSurface,
    Optimise,
    SplineSurface,
)
from aag_cad.errors import DesignError
from aag_cad.export.ifc.options import IfcOptions, require_known
from aag_cad.export.office.optimise_report import write_report
from aag_cad.export.office.plan_files import gridshell_dossier
from aag_cad.export.office.summary import summary_of
from aag_cad.files import publishing, read_text, sizes_below, write_bytes, write_text
from aag_cad.findings import Finding, worst_first
from aag_cad.geometry.profiles import ArcProfile, CrpcProfile, HyperboloidProfile, Profile, SplineProfile
from aag_cad.geometry.revolution import AsymptoticChart, RevolutionSurface
from aag_cad.geometry.surface import Chart
from aag_cad.language import language_of
from aag_cad.model import Model
from aag_cad.network.build import shell_network
from aag_cad.network.edges import bottom_coordinate, top_coordinate
from aag_cad.network.extent import shell_extent
from aag_cad.network.model import CurveNetwork
from aag_cad.network.polylines import read_polylines
from aag_cad.parts.build import gridshell_from
from aag_cad.parts.model import Gridshell
from aag_cad.shop.purchases import purchases_of
from aag_cad.web.goals import Goals, Iteration, Optimised
from aag_cad.web.interpolation import interpolated_surface
from aag_cad.web.normal_equations import best_factorisation
from aag_cad.web.npz import web_npz
from aag_cad.web.obj import read_web_obj, web_obj
from aag_cad.web.optimise import Method, optimise
from aag_cad.web.quality import quality
from aag_cad.web.start import StartWeb, start_web
from aag_cad.web.web import Web, crpc_web, sampled_web
from assembly.base.segments import Limits
from assembly.checks.findings import disassembly_faults, plan_faults
from assembly.plan.planned import Planned, limits_of, planned_of

Report = Callable[[str], None]
IterationReport = Callable[[Iteration], None]


@dataclass(frozen=True)
class Build:
    """A model with its findings, what is planned for it, and the summary that was written beside the files."""

    model: Model
    findings: tuple[Finding, ...]
    planned: Planned
    summary: dict[str, Any]


def profile_of(design: Design) -> Profile:
    """Return the meridian that the design asks for."""
    match design.surface:
        case CrpcSurface() as surface:
            return CrpcProfile(surface.neck_radius, surface.ratio)
        case CatenoidSurface() as surface:
            return CrpcProfile(surface.neck_radius, 1.0)
        case HyperboloidSurface() as surface:
            return HyperboloidProfile(surface.neck_radius, surface.semi_axis)
        case ArcSurface() as surface:
            return ArcProfile(surface.neck_radius, surface.meridian_radius)
        case SplineSurface() as surface:
            return SplineProfile(surface.points)


def chart_of(design: Design) -> AsymptoticChart:
    """Return the surface of one shell in its asymptotic chart; its axis stands outside the vault, on -x."""
    return AsymptoticChart(RevolutionSurface(profile_of(design), -design.shells.axis_distance))


def web_of(design: Design, chart: AsymptoticChart) -> Web:
    """Return the web over the sector, from one step under the ground line to the top, in half steps of the pattern.

    On a CRPC surface it is the exact discrete web, on others the smooth chart is sampled.
    """
    step = design.step / 2.0
    rows = int(np.ceil(top_coordinate(design, chart, 0.0) / step))
    below = int(np.ceil(-bottom_coordinate(design, chart) / step))
    columns = round(2.0 * design.half_sector / step)
    theta = np.linspace(-design.half_sector, design.half_sector, columns + 1)
    profile = chart.surface.profile
    if isinstance(profile, CrpcProfile):
        return crpc_web(profile.neck_radius, profile.ratio, chart.surface.axis_x, theta, max(2, below), rows)
    return sampled_web(chart, step * np.arange(-below, rows + 1, dtype=np.float64), np.asarray(theta, dtype=np.float64))


def _optimised(design: Design, wish: Optimise, report: IterationReport) -> tuple[StartWeb, Optimised]:
    chart = chart_of(design)
    start = start_web(design, wish, chart, top_coordinate(design, chart, 0.0))
    method = Method(wish.method == "levenberg-marquardt", best_factorisation())
    return start, optimise(start.web, start.goals, report, method)


def optimised_design(design: Design, report: IterationReport = lambda iteration: None) -> tuple[Optimised, Goals]:
    """Return the optimised web of a design and its goals; DesignError if the design has no table [optimise]."""
    if design.optimise is None:
        raise DesignError("optimise: the design has no table [optimise]; add one, or build the design as it is")
    start, found = _optimised(design, design.optimise, report)
    return found, start.goals


def optimised_mesh(path: str, goals: Goals, report: IterationReport = lambda iteration: None) -> Optimised:
    """Return the optimised web of a quad mesh in an OBJ file; FileError if it cannot be read or is no grid."""
    return optimise(read_web_obj(read_text(path), path), goals, report)


def worked_surface(design: Design) -> tuple[Chart, Web]:
    """Return the surface that a design is built on and its web: as designed, or optimised if it asks for that.

    DesignError with the optimiser's reason if the goals are not reached.
    """
    if design.optimise is None:
        chart = chart_of(design)
        return chart, web_of(design, chart)
    start, found = _optimised(design, design.optimise, lambda iteration: None)
    if not found.success:
        raise DesignError(
            f"optimise: {found.reason}: {found.explanation}; change the goals, or look at `aag optimise` of this design"
        )
    return interpolated_surface(found.web, start.step, start.origin), found.web


def write_optimised(found: Optimised, goals: Goals, folder: Path) -> dict[str, int]:
    """Write web.obj and web.npz without the ghost rows, and the report, into a folder; return the files' sizes."""
    web = Web(found.web.vertices[goals.bottom_row or 0 :])
    write_text(folder / "web.obj", web_obj(web))
    write_bytes(folder / "web.npz", web_npz(web))
    write_report(found, goals, folder / "optimise.html")
    return {name: (folder / name).stat().st_size for name in ("optimise.html", "web.npz", "web.obj")}


def curves_from(path: str) -> CurveNetwork:
    """Return the curve network in a JSON file of polylines; FileError or NetworkError where it does not fit."""
    return read_polylines(read_text(path), path)


def model_of(design: Design, report: Report = lambda stage: None, given_curves: CurveNetwork | None = None) -> Model:
    """Return a design worked out to its gridshell, on its own curves or on given ones.

    SurfaceError, NetworkError or DesignError where it cannot be built.
    """
    report("web")
    chart, web = worked_surface(design)
    report("curves")
    network = given_curves or shell_network(design, chart)
    extent = shell_extent(design, chart, network)
    report("parts")
    return Model(design, web, quality(web), network, extent, gridshell_from(design, network))


def gridshell_of(design: Design) -> Gridshell:
    """Return the gridshell of a design: design -> surface -> curves -> parts."""
    return model_of(design).gridshell


def checked_plans(gridshell: Gridshell, crew: Crew, limits: Limits, edges_first: bool = True) -> Planned:
    """Return all plans for a gridshell, with what independent walks find wrong with them among their findings.

    PlanError and FrameError as ``planned_of``.
    """
    planned = planned_of(gridshell, crew, limits, edges_first=edges_first)
    up = plan_faults(planned.plan, gridshell, planned.segmentation, planned.locking)
    down = disassembly_faults(planned.down, gridshell)
    return replace(
        planned,
        plan=replace(planned.plan, findings=(*planned.plan.findings, *up)),
        down=replace(planned.down, findings=(*planned.down.findings, *down)),
    )


MODEL_STAGES = ("web", "curves", "parts", "stock", "audit", "assembly")


def build(
    design: Design,
    folder: Path,
    only: Iterable[str] = (),
    report: Report = lambda stage: None,
    given_curves: CurveNetwork | None = None,
    ifc: IfcOptions | None = None,
    language: str = "en",
) -> Build:
    """Build a design into a folder and return what was built.

    Every file is written into a temporary folder first and moved when all are whole, so that an error leaves nothing
    behind. ``report`` is called with the name of each stage as it begins. FileError if the folder cannot be written,
    DesignError if nothing is printed in ``language``.
    """
    # The libraries of the formats take a second to load.
    from aag_cad.outputs import EVERY_OUTPUT, Dossier, chosen_outputs

    outputs, ifc_options = chosen_outputs(only), ifc or IfcOptions()
    require_known(ifc_options)
    printed = language_of(language)
    begun: list[tuple[str, float]] = []

    def begin(stage: str) -> None:
        begun.append((stage, time.perf_counter()))
        report(stage)

    model = model_of(design, begin, given_curves)
    with publishing(folder) as staging:
        begin("stock")
        purchases = purchases_of(model.gridshell, design)
        begin("audit")
        checked = audit(design, model.gridshell, purchases)
        begin("assembly")
        planned = checked_plans(model.gridshell, design.crew, limits_of(design.transport))
        findings = worst_first([*checked, *planned.findings])
        plan = gridshell_dossier(planned, model.gridshell, design.crew, printed)
        dossier = Dossier(model, plan, purchases, ifc_options)
        for output in outputs:
            begin(output)
            EVERY_OUTPUT[output](dossier, staging)
        ends = [start for _, start in begun[1:]] + [time.perf_counter()]
        seconds = {stage: end - start for (stage, start), end in zip(begun, ends, strict=True)}
        summary = summary_of(model, findings, planned.plan, purchases, sizes_below(staging), seconds, printed)
        write_text(staging / "summary.json", json.dumps(summary, indent=1, ensure_ascii=False) + "\n")
    return Build(model, findings, planned, summary)
