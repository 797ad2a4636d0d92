"""The ``aag`` command; heavy imports happen inside the commands."""

import json
import math
import os
import sys
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Annotated, Any, ParamSpec, cast

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Column, Table

from aag_cad import __version__
from aag_cad.errors import AagError, DesignError, FileError

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    help="Strained timber gridshells from straight planks: design, fabrication files, assembly plan.",
)
_P = ParamSpec("_P")
_USER_ERROR = 2
_MOST_ROWS = 12
_MOST_FILES = 12

DesignName = Annotated[str, typer.Argument(metavar="DESIGN", help="a design file (TOML) or a shipped name: vault")]
Folder = Annotated[Path | None, typer.Option("-o", "--output", help="folder for the files; default: the design's name")]
Language = Annotated[str, typer.Option("--lang", help="of the printed sheets: en or de")]
AsJson = Annotated[bool, typer.Option("--json", help="print the summary as JSON and nothing else")]


def _user_errors(command: Callable[_P, None]) -> Callable[_P, None]:
    """Print what a user can mend as one message and leave with exit code 2."""

    @wraps(command)
    def run(*args: _P.args, **kwargs: _P.kwargs) -> None:
        try:
            command(*args, **kwargs)
        except AagError as error:
            print(f"aag: {error}", file=sys.stderr)
            raise typer.Exit(_USER_ERROR) from None

    return run


def _version(asked: bool) -> None:
    if asked:
        print(f"aag {__version__}")
        raise typer.Exit


@app.callback()
def main(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="print the version")
    ] = False,
) -> None:
    """Take the options that stand before a command."""


@contextmanager
def _progress(stages: int, quiet: bool) -> Iterator[Callable[[str], None]]:
    """Yield the function that is called with the name of each stage as it begins."""
    if quiet:
        yield lambda stage: None
        return
    columns = (TextColumn("{task.description:<10}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True)) as bar:
        task = bar.add_task("start", total=stages, completed=-1)
        yield lambda stage: bar.update(task, advance=1, description=stage)
        bar.update(task, completed=stages, description="done")


def _findings_table(findings: list[dict[str, Any]]) -> Table:
    """Return one row per kind of finding: how many, and the worst in full."""
    headers = ("code", "severity", "count", "the furthest from what is allowed")
    table = Table(*headers, title="Findings", title_justify="left")
    kinds: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for finding in findings:
        kinds.setdefault((finding["severity"], finding["code"]), []).append(finding)
    for (severity, code), group in list(kinds.items())[:_MOST_ROWS]:
        worst = max(group, key=lambda f: abs(f["found"] - f["allowed"]))
        table.add_row(code, severity, str(len(group)), worst["text"])
    if len(kinds) > _MOST_ROWS:
        table.caption = f"and {len(kinds) - _MOST_ROWS} more kinds"
    return table


def _exit_on_errors(findings: list[dict[str, Any]], where: str) -> None:
    """End with exit code 1 if there is a finding of severity error."""
    errors = sum(finding["severity"] == "error" for finding in findings)
    if errors:
        print(f"aag: {errors} error{'s' if errors > 1 else ''} in {where}", file=sys.stderr)
        raise typer.Exit(1)


def _files_table(files: dict[str, int], folder: Path, summary: bool = True) -> Table:
    table = Table("file", Column("kB", justify="right"), title=f"Files in {folder}", title_justify="left")
    series: dict[tuple[str, str], list[str]] = {}
    for name in files:
        series.setdefault((str(Path(name).parent), Path(name).suffix), []).append(name)
    for names in series.values():
        alike = len(names) > _MOST_FILES
        for group in [names] if alike else [[name] for name in names]:
            title = f"{group[0]} to {Path(group[-1]).name}, {len(group)} files" if alike else group[0]
            table.add_row(title, f"{sum(files[name] for name in group) / 1000:.0f}")
    if summary:
        table.add_row("summary.json", "")
    return table


def _key_figures(summary: dict[str, Any]) -> str:
    figures, number = summary["figures"], summary["counts"]
    mass = summary["mass_per_shell_kg"]["S1"]
    return (
        f"{summary['title']}: {number['shells']} shells, {number['coupled beams']} coupled beams, "
        f"{number['planks']} planks, {figures['plan_area_m2']:.2f} m2 in plan, "
        f"crown {figures['crown_height_mm']:.0f} mm\n"
        f"smallest bending radius {figures['smallest_bending_radius_mm']:.0f} mm, "
        f"largest twist {figures['largest_twist_deg_per_m']:.1f} deg/m, "
        f"per shell {mass['all timber']:.0f} kg timber and {mass['all steel']:.0f} kg steel"
    )


def _tell(as_json: bool, data: Any, *shown: str | Table) -> None:
    """Print data as JSON and nothing else, or what is shown of it to people."""
    if as_json:
        print(json.dumps(data, indent=1, ensure_ascii=False))
        return
    console = Console()
    for item in shown:
        console.print(item, highlight=False)


@app.command()
@_user_errors
def build(
    design: DesignName,
    output: Folder = None,
    only: Annotated[
        str,
        typer.Option(
            help="comma-separated outputs, such as step,ifc; web, curves, rhino and graph are written only if named"
        ),
    ] = "",
    curves: Annotated[
        str, typer.Option(metavar="FILE", help="polylines (JSON) of another program in place of the design's curves")
    ] = "",
    ifc_schema: Annotated[str, typer.Option(help="IFC4, IFC4X3_ADD2 or IFC2X3")] = "IFC4",
    ifc_geometry: Annotated[str, typer.Option(help="mesh, or brep for B-spline faces of planks and bars")] = "mesh",
    lang: Language = "en",
    as_json: AsJson = False,
) -> None:
    """Build a design into a folder of STEP, IFC, shop files, tables, assembly plan and pictures."""
    from aag_cad.design import load_design

    read = load_design(design)
    from aag_cad.export.ifc.options import IfcGeometry, IfcOptions, IfcSchema
    from aag_cad.outputs import chosen_outputs, left_out
    from aag_cad.pipeline import MODEL_STAGES, curves_from
    from aag_cad.pipeline import build as run

    # What cannot be written is refused, with what there is, before anything is built.
    options = IfcOptions(cast("IfcSchema", ifc_schema), cast("IfcGeometry", ifc_geometry))
    wanted = [name.strip() for name in only.split(",") if name.strip()]
    stages = len(MODEL_STAGES) + len(chosen_outputs(wanted))
    folder = output or Path(read.project.name)
    with _progress(stages, as_json) as report:
        summary = run(read, folder, wanted, report, curves_from(curves) if curves else None, options, lang).summary
    left = [f"Left out: {name}; for it {remedy}" for name, remedy in left_out().items() if not wanted]
    tables = _findings_table(summary["findings"]), _files_table(summary["files"], folder)
    _tell(as_json, summary, _key_figures(summary), *tables, *left)
    _exit_on_errors(summary["findings"], design)


@app.command()
@_user_errors
def check(
    design: DesignName,
    as_json: AsJson = False,
    plan: Annotated[str, typer.Option(metavar="FILE", help="a plan.json or disassembly.json to walk through too")] = "",
) -> None:
    """Audit a design without writing files; exit code 1 if there is a finding of severity error."""
    from aag_cad.design import load_design

    read = load_design(design)
    if plan:
        from aag_cad.planning import file_faults, plan_in
        from assembly.plan.planned import limits_of

        # What is no plan is refused before anything is built.
        given = plan_in(plan)
    from aag_cad.audit import audit
    from aag_cad.findings import finding_row, worst_first
    from aag_cad.pipeline import gridshell_of
    from aag_cad.shop.purchases import purchases_of

    with _progress(3, as_json) as report:
        report("parts")
        gridshell = gridshell_of(read)
        report("stock")
        purchases = purchases_of(gridshell, read)
        report("audit")
        found = [*audit(read, gridshell, purchases)]
        if plan:
            found += file_faults(given, gridshell, read.crew, limits_of(read.transport))
        findings = [finding_row(finding) for finding in worst_first(found)]
    _tell(as_json, findings, _findings_table(findings))
    _exit_on_errors(findings, design)


@app.command()
@_user_errors
def plan(
    source: Annotated[
        str,
        typer.Argument(
            metavar="DESIGN|gridshell.json|graph.json|graph.graphml",
            help="a design, a gridshell that a build wrote, or any graph of parts (shipped: kagome, impossible)",
        ),
    ],
    output: Folder = None,
    crew: Annotated[int | None, typer.Option(help="people, in place of those of the design")] = None,
    transport: Annotated[
        str, typer.Option(help="LENGTHxWIDTHxHEIGHT in mm, with xKG of load and xKG of the crane if they limit it")
    ] = "",
    lang: Language = "en",
    edges_first: Annotated[
        bool, typer.Option(help="fix the edge planks before all geodesics, as the paper does")
    ] = True,
    explain: Annotated[str, typer.Option(metavar="MARK", help="only say why this part comes when it does")] = "",
    as_json: AsJson = False,
) -> None:
    """Plan the assembly, the locking, the journey and the taking down; exit code 1 on a finding of severity error."""
    from aag_cad.findings import finding_row
    from aag_cad.language import language_of
    from aag_cad.planning import STAGES, explained, planned_source, read_source, write_plan
    from assembly.booklet.plan_file import plan_json
    from assembly.transport.search import limits_from

    printed, limits = language_of(lang), limits_from(transport) if transport else None
    with _progress(2 if explain else STAGES, as_json) as report:
        report("read")
        read = read_source(source, crew, limits)
        report("plan")
        result = planned_source(read, printed, edges_first)
        folder = output or Path(read.name)
        files = {} if explain else write_plan(result, folder, report)
    if explain:
        print("\n".join(explained(result, explain)))
        return
    findings = [finding_row(finding, printed) for finding in result.findings]
    if as_json:
        print(plan_json(result.file), end="")
    else:
        steps = len(result.plan.steps)
        shown = [f"{steps} step{'s' * (steps != 1)}, {result.schedule.days:.1f} days for {read.crew.people}"]
        for order in result.locking[:1] if edges_first else ():
            price = f"{100.0 * order.rule_price:.0f} %"
            shown.append(f"Edge planks before geodesics cost {price} of the stiffness on the way")
        _tell(False, None, *shown, _findings_table(findings), _files_table(files, folder, summary=False))
    _exit_on_errors(findings, f"the plan of {source}")


@app.command()
@_user_errors
def optimise(
    source: Annotated[
        str, typer.Argument(metavar="DESIGN|MESH.obj", help="a design with a table [optimise], or a quad mesh")
    ],
    output: Folder = None,
    node_angle: Annotated[
        float | None, typer.Option(help="mesh: degrees between A lines, across the geodesics; 60 is the tri-hex")
    ] = None,
    bottom_row: Annotated[
        int | None, typer.Option(help="mesh: row of the flat geodesic bottom, ghost rows under it")
    ] = None,
    height: Annotated[float | None, typer.Option(help="mesh: height of the top over the bottom, mm")] = None,
    symmetric: Annotated[bool, typer.Option(help="mesh: keep it mirrored in the plane y = 0")] = True,
    as_json: AsJson = False,
) -> None:
    """Optimise a web to planar stars, geodesics and a constant angle; exit code 1 if the goals are not reached."""
    from aag_cad.design import load_design
    from aag_cad.pipeline import optimised_design, optimised_mesh, write_optimised
    from aag_cad.web.goals import Goals

    def progress(iteration: Any) -> None:
        if not as_json:
            energies = "  ".join(f"{name} {value:.1e}" for name, value in iteration.energies.items())
            print(f"{iteration.number:3d} {iteration.stage:<6} {energies}", file=sys.stderr)

    if source.lower().endswith(".obj"):
        if node_angle is not None and not 0.0 < node_angle < 180.0:
            raise DesignError(f"--node-angle: {node_angle:g}; allowed between 0 and 180 degrees")
        angle = None if node_angle is None else math.radians(180.0 - node_angle)
        goals = Goals(angle=angle, bottom_row=bottom_row, height=height, symmetric=symmetric)
        name, found = Path(source).stem, optimised_mesh(source, goals, progress)
    else:
        read = load_design(source)
        name, (found, goals) = read.project.name, optimised_design(read, progress)
    folder = output or Path(f"{name}-web")
    files = write_optimised(found, goals, folder)
    data = {"reason": found.reason, "explanation": found.explanation, "files": files}
    _tell(as_json, data, f"{found.reason}: {found.explanation}", _files_table(files, folder, summary=False))
    if not found.success:
        print(f"aag: {source}: {found.reason}: {found.explanation}", file=sys.stderr)
        raise typer.Exit(1)


@app.command()
@_user_errors
def new(
    name: Annotated[str, typer.Argument(help="name of the new design: small letters, digits, - and _")],
    template: Annotated[str, typer.Option(help="the shipped design to start from")] = "vault",
) -> None:
    """Write NAME.toml, a commented copy of a shipped design, to edit."""
    from aag_cad.design import design_text, parse_design

    text = design_text(template)
    shipped = tomllib.loads(text)["project"]["name"]
    text = text.replace(f'name = "{shipped}"', f'name = "{name}"', 1)
    parse_design(text, f"aag new {name}")
    path = Path(f"{name}.toml")
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except OSError as error:
        raise FileError(
            f"{path}: not written: {os.strerror(error.errno or 0)}; choose another name or folder"
        ) from error
    print(f"{path} written; build it with: aag build {path}")


@app.command()
@_user_errors
def schema(
    of: Annotated[str, typer.Argument(metavar="design|plan", help="the design file, or plan.json")] = "design",
) -> None:
    """Print the JSON Schema of the design file, or that of plan.json and disassembly.json."""
    if of == "design":
        from aag_cad.design import Design

        found = Design.model_json_schema()
    elif of == "plan":
        from assembly.booklet.plan_file import plan_schema

        found = plan_schema()
    else:
        raise DesignError(f"aag schema: no schema of {of!r}; there are design and plan")
    print(json.dumps(found, indent=1))
