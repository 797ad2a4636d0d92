"""Every output by name: what it writes into the folder of a build."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from aag_cad.errors import DesignError
from aag_cad.export.ifc.options import IfcOptions
from aag_cad.language import Language
from aag_cad.model import Model
from aag_cad.network.polylines import polylines_json
from aag_cad.shop.purchases import Purchases
from aag_cad.web.interpolation import interpolated_surface
from aag_cad.web.npz import web_npz
from aag_cad.web.obj import web_obj

if TYPE_CHECKING:
    from assembly.plan.planned import Planned


@dataclass(frozen=True)
class Dossier:
    """What the outputs of a build are written from: the model, what is planned and what is bought for it."""

    model: Model
    planned: "Planned"
    purchases: Purchases
    ifc: IfcOptions
    language: Language = "en"


Writer: TypeAlias = Callable[[Dossier, Path], None]


def _write_gridshell(dossier: Dossier, folder: Path) -> None:
    from aag_cad.files import write_text
    from aag_cad.parts.store import gridshell_json

    write_text(folder / "gridshell.json", gridshell_json(dossier.model.gridshell))


def _write_step(dossier: Dossier, folder: Path) -> None:
    from aag_cad.export.cad.step import write_step

    write_step(dossier.model.gridshell, folder / f"{dossier.model.gridshell.name}.step")


def _write_ifc(dossier: Dossier, folder: Path) -> None:
    from aag_cad.export.ifc.model import write_ifc
    from aag_cad.export.ifc.schedule import PlannedWork

    gridshell, design = dossier.model.gridshell, dossier.model.design
    project = design.project
    options = replace(dossier.ifc, site=design.site, author=project.author, organisation=project.organisation)
    planned = dossier.planned
    work = PlannedWork(planned.plan, planned.schedule, design.crew, planned.segmentation)
    write_ifc(gridshell, folder / f"{gridshell.name}.ifc", work, options)


def _write_glb(dossier: Dossier, folder: Path) -> None:
    from aag_cad.export.cad.gltf import write_glb

    write_glb(dossier.model.gridshell, folder / f"{dossier.model.gridshell.name}.glb")


def _write_tables(dossier: Dossier, folder: Path) -> None:
    from aag_cad.export.office.tables import write_checks_table, write_holes_table, write_parts_table

    write_parts_table(dossier.model.gridshell, folder / "tables" / "parts.csv")
    write_holes_table(dossier.model.gridshell, folder / "tables" / "holes.csv")
    write_checks_table(dossier.model.gridshell, folder / "tables" / "checks.csv")


def _write_shop(dossier: Dossier, folder: Path) -> None:
    from aag_cad.export.office.purchases import write_cutting, write_purchases
    from aag_cad.export.workshop.prefabrication import write_drilling, write_prefabrication

    write_prefabrication(dossier.model.gridshell, folder / "tables" / "prefabrication.csv")
    write_drilling(dossier.model.gridshell, folder / "tables" / "drilling.csv")
    write_purchases(dossier.purchases, folder / "tables" / "purchases.csv")
    write_cutting(dossier.purchases, folder / "tables" / "cutting.csv")


def _write_blanks(dossier: Dossier, folder: Path) -> None:
    from aag_cad.export.workshop.dxf import write_blank_dxfs

    write_blank_dxfs(dossier.model.gridshell, folder / "blanks")


def _write_templates(dossier: Dossier, folder: Path) -> None:
    from aag_cad.export.workshop.drill_templates import write_templates

    write_templates(dossier.model.gridshell, folder / "templates.pdf", dossier.model.design.stock.template_paper)


def _write_labels(dossier: Dossier, folder: Path) -> None:
    from aag_cad.export.workshop.labels import write_labels

    write_labels(dossier.model.gridshell, folder / "labels.pdf")


def _write_btlx(dossier: Dossier, folder: Path) -> None:
    from aag_cad.export.workshop.btlx import write_btlx

    write_btlx(dossier.model.gridshell, folder / f"{dossier.model.gridshell.name}.btlx")


def _write_passports(dossier: Dossier, folder: Path) -> None:
    from aag_cad.export.workshop.passports import write_passports

    reuse = folder / "reuse"
    write_passports(dossier.model.gridshell, reuse / "passports.json", reuse / "passports.pdf", reuse / "reuse.csv")


def _write_facade(dossier: Dossier, folder: Path) -> None:
    from aag_cad.export.workshop.facade_patterns import write_facade_table, write_flat_patterns

    write_flat_patterns(dossier.model.design, dossier.model.gridshell, folder / "facade")
    write_facade_table(dossier.model.design, dossier.model.gridshell, folder / "tables" / "facade.csv")


def _plan_writer(name: str) -> Writer:
    """Return the writer of an output of the plan."""

    def write(dossier: Dossier, folder: Path) -> None:
        from aag_cad.export.office.plan_files import PLAN_WRITERS, PlanDossier

        model = dossier.model
        own = PlanDossier(dossier.planned, model.gridshell, model.design.crew, dossier.language)
        PLAN_WRITERS[name](own, folder)

    return write


def _write_overview(dossier: Dossier, folder: Path) -> None:
    from aag_cad.export.office.overview import write_overview

    write_overview(dossier.model.gridshell, folder / "overview.svg", folder / "overview.png")


def _write_web(dossier: Dossier, folder: Path) -> None:
    from aag_cad.files import write_bytes, write_text

    write_text(folder / "web.obj", web_obj(dossier.model.web))
    write_bytes(folder / "web.npz", web_npz(dossier.model.web))


def _write_curves(dossier: Dossier, folder: Path) -> None:
    from aag_cad.export.cad.step_curves import write_step_curves
    from aag_cad.files import write_text

    surface = interpolated_surface(dossier.model.web, dossier.model.design.step)
    write_step_curves(dossier.model.network, surface, folder / "curves.step")
    write_text(folder / "curves.json", polylines_json(dossier.model.network))


def _write_rhino(dossier: Dossier, folder: Path) -> None:
    from aag_cad.export.cad.rhino import write_3dm

    write_3dm(dossier.model.gridshell, folder / f"{dossier.model.gridshell.name}.3dm")


OUTPUTS: dict[str, Writer] = {
    "gridshell": _write_gridshell,
    "step": _write_step,
    "ifc": _write_ifc,
    "glb": _write_glb,
    "tables": _write_tables,
    "shop": _write_shop,
    "blanks": _write_blanks,
    "templates": _write_templates,
    "labels": _write_labels,
    "btlx": _write_btlx,
    "passports": _write_passports,
    "facade": _write_facade,
    "plan": _plan_writer("plan"),
    "schedule": _plan_writer("schedule"),
    "locking": _plan_writer("locking"),
    "segments": _plan_writer("segments"),
    "sequence": _plan_writer("sequence"),
    "overview": _write_overview,
}
# Written only if named: for designers who go on in other programs.
EXTRA_OUTPUTS: dict[str, Writer] = {
    "web": _write_web,
    "curves": _write_curves,
    "rhino": _write_rhino,
    "graph": _plan_writer("graph"),
}
EVERY_OUTPUT = OUTPUTS | EXTRA_OUTPUTS
# Outputs whose library comes with an extra of the package, by output: (module, extra).
OPTIONAL = {"btlx": ("compas_timber", "btlx")}


def chosen_outputs(only: Iterable[str]) -> tuple[str, ...]:
    """Return the outputs to write, all but the extra ones if none is named; DesignError on an unknown name."""
    wanted, every = list(only), EVERY_OUTPUT
    unknown = sorted(set(wanted) - set(every))
    if unknown:
        raise DesignError(f"--only: no output called {', '.join(unknown)}; there are {', '.join(every)}")
    missing = left_out()
    return tuple(name for name in every if (name in wanted if wanted else name in OUTPUTS and name not in missing))


def left_out() -> dict[str, str]:
    """Return the outputs that a build leaves out unless they are named, with what to install for each."""
    return {
        name: f"pip install 'aag-toolkit[{extra}]'"
        for name, (module, extra) in OPTIONAL.items()
        if find_spec(module) is None
    }
