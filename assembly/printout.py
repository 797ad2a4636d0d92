"""The assembly sequence as a printed booklet: one card a step, by the template ``printouts/sequence.typ``."""

import json
import os
import shutil
import tempfile
from pathlib import Path
from typing import Any

import typst

from aag_cad.files import write_bytes
from aag_cad.parts.model import Gridshell, all_parts
from aag_cad.resources import template
from assembly.cards import PHASE_NAMES, step_card, totals
from assembly.perspective import perspective_svg
from assembly.plan import piece_weights
from assembly.scenes import Sheets, key_svg, legend_svgs, phase_svg, sheets_of, step_pictures
from assembly.sections import block_section_svg, node_section_svg
from assembly.steps import Plan


def _write_pictures(folder: Path, pictures: dict[str, str]) -> None:
    for name, picture in pictures.items():
        (folder / f"{name}.svg").write_text(picture, encoding="utf-8")


def _cover(plan: Plan, gridshell: Gridshell, sheets: Sheets) -> dict[str, str]:
    """Return the pictures of the first pages by file name."""
    first = gridshell.shells[0]
    pictures = {"vault": perspective_svg(gridshell)}
    if first.studs:
        pictures["node"] = node_section_svg(first)
    if first.blocks and first.screws:
        pictures["block"] = block_section_svg(first)
    pictures |= {f"legend-{name}": picture for name, picture in legend_svgs().items()}
    pictures |= {f"key-{shell.mark}": key_svg(gridshell, shell.mark) for shell in gridshell.shells}
    lasts = {step.phase: step for step in plan.steps if step.shell == first.mark}
    return pictures | {f"phase-{i}": phase_svg(sheets, plan, step) for i, step in enumerate(lasts.values())}


def sequence_data(plan: Plan, gridshell: Gridshell, folder: Path) -> dict[str, Any]:
    """Write the pictures of a booklet to a folder and return the data that its template prints."""
    weights = piece_weights(gridshell)
    parts = {part.mark: part for part in all_parts(gridshell)}
    sheets = sheets_of(plan, gridshell)
    cards: list[dict[str, Any]] = []
    stood: list[str] = []
    for step in plan.steps:
        card = step_card(gridshell, plan, step, parts, weights)
        pictures = {f"step-{step.number}-{i}": svg for i, svg in enumerate(step_pictures(sheets, step, stood))}
        _write_pictures(folder, pictures)
        cards.append(card | {"pictures": [f"{name}.svg" for name in pictures]})
        stood += list(step.assemblies) if step.phase == "stand" else []
    cover = _cover(plan, gridshell, sheets)
    _write_pictures(folder, cover)
    lasts = {step.phase: step for step in plan.steps if step.shell == gridshell.shells[0].mark}
    phases = [
        {"picture": f"phase-{i}.svg", "phase": phase, "name": PHASE_NAMES[phase]} for i, phase in enumerate(lasts)
    ]
    return {
        "title": gridshell.title,
        "name": gridshell.name,
        "people": max((step.crew for step in plan.steps), default=0),
        "totals": totals(gridshell, weights),
        "phases": phases,
        "sections": [f"{name}.svg" for name in ("node", "block") if name in cover],
        "steps": cards,
    }


def sequence_pdf(plan: Plan, gridshell: Gridshell) -> bytes:
    """Return the booklet as PDF; the same plan gives the same bytes."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        data = sequence_data(plan, gridshell, folder)
        (folder / "data.json").write_text(json.dumps(data, ensure_ascii=False), encoding="utf-8")
        main = folder / "sequence.typ"
        shutil.copyfile(template("printouts", "sequence.typ"), main)
        pdf: bytes = typst.compile(str(main), root=str(folder), ignore_system_fonts=True, format="pdf")
    return pdf


def write_sequence(plan: Plan, gridshell: Gridshell, path: str | os.PathLike[str]) -> None:
    """Write the booklet as an A4 PDF file; FileError if it cannot be written, and then nothing is left behind."""
    write_bytes(path, sequence_pdf(plan, gridshell))
