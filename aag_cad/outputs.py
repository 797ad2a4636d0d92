"""Every output by name: what it writes into the folder of a build."""

from collections.abc import Callable, Iterable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from aag_cad.errors import DesignError
from aag_cad.network.polylines import polylines_json
from aag_cad.web.interpolation import interpolated_surface
from aag_cad.web.npz import web_npz
from aag_cad.web.obj import web_obj
from aag_cad.worked import Model

if TYPE_CHECKING:
    from assembly.plan import Plan


def _write_gridshell(model: Model, _plan: "Plan", folder: Path) -> None:
    from aag_cad.files import write_text
    from aag_cad.parts.store import gridshell_json

    write_text(folder / "gridshell.json", gridshell_json(model.gridshell))


def _write_step(model: Model, _plan: "Plan", folder: Path) -> None:
    from aag_cad.export.step import write_step

    write_step(model.gridshell, folder / f"{model.gridshell.name}.step")


def _write_ifc(model: Model, plan: "Plan", folder: Path) -> None:
    from aag_cad.export.ifc import write_ifc

    write_ifc(model.gridshell, folder / f"{model.gridshell.name}.ifc", plan.steps)


def _write_glb(model: Model, _plan: "Plan", folder: Path) -> None:
    from aag_cad.export.gltf import write_glb

    write_glb(model.gridshell, folder / f"{model.gridshell.name}.glb")


def _write_tables(model: Model, _plan: "Plan", folder: Path) -> None:
    from aag_cad.export.tables import write_checks_table, write_holes_table, write_parts_table

    write_parts_table(model.gridshell, folder / "tables" / "parts.csv")
    write_holes_table(model.gridshell, folder / "tables" / "holes.csv")
    write_checks_table(model.gridshell, folder / "tables" / "checks.csv")


def _write_shop(model: Model, _plan: "Plan", folder: Path) -> None:
    from aag_cad.export.prefabrication import write_drilling, write_prefabrication
    from aag_cad.export.purchases import write_cutting, write_purchases

    write_prefabrication(model.gridshell, folder / "tables" / "prefabrication.csv")
    write_drilling(model.gridshell, folder / "tables" / "drilling.csv")
    write_purchases(model.gridshell, model.design, folder / "tables" / "purchases.csv")
    write_cutting(model.gridshell, model.design, folder / "tables" / "cutting.csv")


def _write_blanks(model: Model, _plan: "Plan", folder: Path) -> None:
    from aag_cad.export.dxf import write_blank_dxfs

    write_blank_dxfs(model.gridshell, folder / "blanks")


def _write_templates(model: Model, _plan: "Plan", folder: Path) -> None:
    from aag_cad.export.templates import write_templates

    write_templates(model.gridshell, folder / "templates.pdf")


def _write_labels(model: Model, _plan: "Plan", folder: Path) -> None:
    from aag_cad.export.labels import write_labels

    write_labels(model.gridshell, folder / "labels.pdf")


def _write_btlx(model: Model, _plan: "Plan", folder: Path) -> None:
    from aag_cad.export.btlx import write_btlx

    write_btlx(model.gridshell, folder / f"{model.gridshell.name}.btlx")


def _write_passports(model: Model, _plan: "Plan", folder: Path) -> None:
    from aag_cad.export.passports import write_passports

    reuse = folder / "reuse"
    write_passports(model.gridshell, reuse / "passports.json", reuse / "passports.pdf", reuse / "reuse.csv")


def _write_facade(model: Model, _plan: "Plan", folder: Path) -> None:
    from aag_cad.export.facade import write_facade_table, write_flat_patterns

    write_flat_patterns(model.design, model.gridshell, folder / "facade")
    write_facade_table(model.design, model.gridshell, folder / "tables" / "facade.csv")


def _write_plan(_model: Model, plan: "Plan", folder: Path) -> None:
    from aag_cad.files import write_text
    from assembly.plan import plan_json

    write_text(folder / "plan.json", plan_json(plan))


def _write_sequence(model: Model, plan: "Plan", folder: Path) -> None:
    from assembly.printout import write_sequence

    write_sequence(plan, model.gridshell, folder / "sequence.pdf")


def _write_overview(model: Model, _plan: "Plan", folder: Path) -> None:
    from aag_cad.export.overview import write_overview

    write_overview(model.gridshell, folder / "overview.svg", folder / "overview.png")


def _write_web(model: Model, _plan: "Plan", folder: Path) -> None:
    from aag_cad.files import write_bytes, write_text

    write_text(folder / "web.obj", web_obj(model.net))
    write_bytes(folder / "web.npz", web_npz(model.net))


def _write_curves(model: Model, _plan: "Plan", folder: Path) -> None:
    from aag_cad.export.step_curves import write_step_curves
    from aag_cad.files import write_text

    surface = interpolated_surface(model.net, model.design.step)
    write_step_curves(model.network, surface, folder / "curves.step")
    write_text(folder / "curves.json", polylines_json(model.network))


def _write_rhino(model: Model, _plan: "Plan", folder: Path) -> None:
    from aag_cad.export.rhino import write_3dm

    write_3dm(model.gridshell, folder / f"{model.gridshell.name}.3dm")


OUTPUTS: dict[str, Callable[[Model, "Plan", Path], None]] = {
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
    "plan": _write_plan,
    "sequence": _write_sequence,
    "overview": _write_overview,
}
# Written only if named: for designers who go on in other programs.
EXTRA_OUTPUTS: dict[str, Callable[[Model, "Plan", Path], None]] = {
    "web": _write_web,
    "curves": _write_curves,
    "rhino": _write_rhino,
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
