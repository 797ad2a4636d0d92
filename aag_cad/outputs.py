"""Every output by name: what it writes into the folder of a build."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from importlib.util import find_spec
from pathlib import Path
from typing import TypeAlias

from aag_cad.errors import DesignError
from aag_cad.export.cad.gltf import write_glb
from aag_cad.export.cad.rhino import write_3dm
from aag_cad.export.cad.step import write_step
from aag_cad.export.cad.step_curves import write_step_curves
from aag_cad.export.ifc.model import write_ifc
from aag_cad.export.ifc.options import IfcOptions
from aag_cad.export.ifc.schedule import PlannedWork
from aag_cad.export.office.overview import write_overview
from aag_cad.export.office.plan_files import PlanDossier, write_plan_output
from aag_cad.export.office.purchases import write_purchases
from aag_cad.export.office.tables import write_tables
from aag_cad.export.workshop.btlx import write_btlx
from aag_cad.export.workshop.drill_templates import write_templates
from aag_cad.export.workshop.dxf import write_blank_dxfs
from aag_cad.export.workshop.facade_patterns import write_facade_table, write_flat_patterns
from aag_cad.export.workshop.labels import write_labels
from aag_cad.export.workshop.passports import write_passports
from aag_cad.export.workshop.prefabrication import write_prefabrication
from aag_cad.files import write_bytes, write_text
from aag_cad.model import Model
from aag_cad.network.polylines import polylines_json
from aag_cad.parts.model import Gridshell
from aag_cad.parts.store import gridshell_json
from aag_cad.shop.purchases import Purchases
from aag_cad.web.interpolation import interpolated_surface
from aag_cad.web.npz import web_npz
from aag_cad.web.obj import web_obj


@dataclass(frozen=True)
class Dossier:
    """What the outputs of a build are written from: the model, what is planned and what is bought for it."""

    model: Model
    plan: PlanDossier
    purchases: Purchases
    ifc: IfcOptions

    @property
    def gridshell(self) -> Gridshell:
        """The gridshell of the model."""
        return self.model.gridshell


Writer: TypeAlias = Callable[[Dossier, Path], None]


def _write_ifc(dossier: Dossier, folder: Path) -> None:
    gridshell, design, plan = dossier.gridshell, dossier.model.design, dossier.plan
    project = design.project
    options = replace(dossier.ifc, site=design.site, author=project.author, organisation=project.organisation)
    work = PlannedWork(plan.plan, plan.schedule, plan.crew, plan.segmentation)
    write_ifc(gridshell, folder / f"{gridshell.name}.ifc", work, options)


def _write_shop(dossier: Dossier, folder: Path) -> None:
    write_prefabrication(dossier.gridshell, folder / "tables")
    write_purchases(dossier.purchases, folder / "tables")


def _write_passports(dossier: Dossier, folder: Path) -> None:
    reuse = folder / "reuse"
    write_passports(dossier.gridshell, reuse / "passports.json", reuse / "passports.pdf", reuse / "reuse.csv")


def _write_facade(dossier: Dossier, folder: Path) -> None:
    write_flat_patterns(dossier.model.design, dossier.gridshell, folder / "facade")
    write_facade_table(dossier.model.design, dossier.gridshell, folder / "tables" / "facade.csv")


def _plan_writer(name: str) -> Writer:
    """Return the writer of an output of the plan."""
    return lambda dossier, folder: write_plan_output(dossier.plan, name, folder)


def _write_web(dossier: Dossier, folder: Path) -> None:
    write_text(folder / "web.obj", web_obj(dossier.model.web))
    write_bytes(folder / "web.npz", web_npz(dossier.model.web))


def _write_curves(dossier: Dossier, folder: Path) -> None:
    surface = interpolated_surface(dossier.model.web, dossier.model.design.step)
    write_step_curves(dossier.model.network, surface, folder / "curves.step")
    write_text(folder / "curves.json", polylines_json(dossier.model.network))


OUTPUTS: dict[str, Writer] = {
    "gridshell": lambda dossier, to: write_text(to / "gridshell.json", gridshell_json(dossier.gridshell)),
    "step": lambda dossier, to: write_step(dossier.gridshell, to / f"{dossier.gridshell.name}.step"),
    "ifc": _write_ifc,
    "glb": lambda dossier, to: write_glb(dossier.gridshell, to / f"{dossier.gridshell.name}.glb"),
    "tables": lambda dossier, to: write_tables(dossier.gridshell, to / "tables"),
    "shop": _write_shop,
    "blanks": lambda dossier, to: write_blank_dxfs(dossier.gridshell, to / "blanks"),
    "templates": lambda dossier, to: write_templates(
        dossier.gridshell, to / "templates.pdf", dossier.model.design.stock.template_paper
    ),
    "labels": lambda dossier, to: write_labels(dossier.gridshell, to / "labels.pdf"),
    "btlx": lambda dossier, to: write_btlx(dossier.gridshell, to / f"{dossier.gridshell.name}.btlx"),
    "passports": _write_passports,
    "facade": _write_facade,
    **{name: _plan_writer(name) for name in ("plan", "schedule", "locking", "segments", "sequence")},
    "overview": lambda dossier, to: write_overview(dossier.gridshell, to / "overview.svg", to / "overview.png"),
}
# Written only if named: for designers who go on in other programs.
EXTRA_OUTPUTS: dict[str, Writer] = {
    "web": _write_web,
    "curves": _write_curves,
    "rhino": lambda dossier, to: write_3dm(dossier.gridshell, to / f"{dossier.gridshell.name}.3dm"),
    "graph": _plan_writer("graph"),
}
EVERY_OUTPUT = OUTPUTS | EXTRA_OUTPUTS
# Outputs whose library comes with an extra of the package, by output: (module, extra).
OPTIONAL = {"btlx": ("compas_timber", "btlx")}


def chosen_outputs(only: Iterable[str]) -> tuple[str, ...]:
    """Return the outputs to write, all but the extra ones if none is named; DesignError on an unknown name."""
    wanted = list(only)
    if unknown := sorted(set(wanted) - set(EVERY_OUTPUT)):
        raise DesignError(f"--only: no output called {', '.join(unknown)}; there are {', '.join(EVERY_OUTPUT)}")
    return tuple(name for name in EVERY_OUTPUT if name in (wanted or OUTPUTS.keys() - left_out().keys()))


def left_out() -> dict[str, str]:
    """Return the outputs that a build leaves out unless they are named, with what to install for each."""
    return {
        name: f"pip install 'aag-toolkit[{extra}]'"
        for name, (module, extra) in OPTIONAL.items()
        if find_spec(module) is None
    }
