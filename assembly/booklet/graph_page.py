"""The plan of any graph of parts as one HTML page: its members as lines in plan, and one section a step."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from math import ceil
from typing import Any

import networkx as nx
import numpy as np

from aag_cad.language import Language
from aag_cad.units import Floats
from assembly.base.steps import Plan, Step
from assembly.booklet.contents import Booklet
from assembly.booklet.phone_page import filled_page
from assembly.booklet.step_words import step_title, step_words
from assembly.booklet.words import booklet_words, finding_lines
from assembly.drawing.names import phase_name
from assembly.drawing.svg import Style, circle, group, label_svg, path, placed_labels, places_along, polylines, svg
from assembly.graph.interlacing import Interlacing, interlacing
from assembly.graph.laying_units import Unit, units_of
from assembly.graph.sliding import End
from assembly.pictures.step_pictures import slide_arrow
from assembly.plan.schedule import Schedule

_WIDTH, _MARGIN = 1800.0, 70.0
_SIZE = 36.0
_MOST_NAMES = 40
# On a larger plan the grey of what is laid already would make every step as heavy as the whole.
_MOST_LAID = 400
_SHARES = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8)
_ALL, _NEW = Style("none", "#b0b0b0", 3.0, "5 6"), Style("none", "#000", 11.0)
_LAID = Style("none", "#999", 7.0)
_DOT, _RING = Style("#000", "#fff", 2.0), Style("#fff", "#000", 4.0)


@dataclass(frozen=True)
class _Way:
    """How a unit is slid in: the end that lies outside longest, and what it passes as shares of its length."""

    end: End
    passed: tuple[float, ...]


def _ways(woven: Interlacing, units: Mapping[str, Unit]) -> dict[str, _Way]:
    stations = {
        (unit, overlap.joint): mm / units[unit].length
        for overlap in woven.overlaps
        for unit, mm in ((overlap.lower, overlap.lower_mm), (overlap.upper, overlap.upper_mm))
    }
    return {s.unit: _Way(s.end, tuple(stations[s.unit, joint] for joint in s.joints)) for s in woven.slides}


def _on_sheet(graph: "nx.MultiGraph[str]", units: Mapping[str, Unit]) -> tuple[dict[str, Floats], float]:
    """Return lines (2, 2) of units and places (1, 2) of other parts on the sheet, y down; and the sheet's height."""
    raw = {mark: np.array([unit.start[:2], unit.end[:2]]) for mark, unit in units.items()}
    raw |= {mark: np.array([graph.nodes[mark]["position"][:2]]) for mark in sorted(graph) if mark not in raw}
    points = np.concatenate(list(raw.values())) * [1.0, -1.0]
    low, high = points.min(axis=0), points.max(axis=0)
    scale = (_WIDTH - 2.0 * _MARGIN) / max(float((high - low)[0]), 1.0)
    lines = {mark: (found * [1.0, -1.0] - low) * scale + _MARGIN for mark, found in raw.items()}
    return lines, float((high - low)[1]) * scale + 2.0 * _MARGIN


def _line(points: Floats) -> str:
    return path(points, closed=False)


def _step_svg(
    step: Step,
    lines: Mapping[str, Floats],
    height: float,
    units: Mapping[str, Unit],
    slides: Mapping[str, _Way],
    laid: Collection[str],
) -> str:
    """Return the plan with what a step lays, slides in or joins over all members: dotted, or grey if ``laid``."""
    own = [mark for mark in dict.fromkeys((*step.assemblies, *step.marks)) if mark in units]
    dots = [lines[mark][0] for mark in step.marks if mark not in units and mark in lines and not own]
    passed = [point for mark in own if mark in slides for point in places_along(lines[mark], slides[mark].passed)]
    wanted = [(mark, places_along(lines[mark], _SHARES)) for mark in own[:_MOST_NAMES]]
    items = [
        group([polylines(lines[mark] for mark in units)], _ALL),
        group((_line(lines[mark]) for mark in laid), _LAID),
        group((_line(lines[mark]) for mark in own), _NEW),
        group((circle(point, 9.0) for point in dots), _DOT),
        group((circle(point, 11.0) for point in passed), _RING),
        *(slide_arrow(lines[mark], slides[mark].end) for mark in own if mark in slides),
        label_svg(placed_labels(wanted, _SIZE, (0.0, 0.0, _WIDTH, height))),
    ]
    return svg(_WIDTH, height, items)


def _card(plan: Plan, step: Step, words: Mapping[str, Any], picture: str, language: Language) -> dict[str, Any]:
    """Return what the section of a step says, as of a gridshell's step, with its marks in a table."""
    titles = {other.id: f"{other.number}  {step_title(other, language)}" for other in plan.steps}
    phase, said = phase_name(step.phase, language), step_words(step, language)
    marks = ", ".join(dict.fromkeys((*step.assemblies, *step.marks)))
    return {
        "number": step.number, "id": step.id, "title": said.title, "shell": step.shell, "phase": step.phase, "key": "",
        "line": f"{phase} · ", "pictures": [picture], "caption": words["captions"].get(f"graph {step.phase}", ""),
        "instructions": said.instructions, "table": {"head": [words["page"]["marks"]], "rows": [[marks]]}, "parts": [],
        "extras": said.extras, "propped": ", ".join(step.propped), "crew": step.crew, "tools": said.tools,
        "after": [titles[before] for before in step.predecessors], "hold": said.hold, "heaviest": "", "added": "",
    }  # fmt: skip


def _chapters(plan: Plan, words: Mapping[str, Any], language: Language) -> list[dict[str, Any]]:
    names = dict.fromkeys(step.shell for step in plan.steps)
    shell = words["list"]["shell"]
    return [
        {
            "name": shell.format(shell=name) if name else plan.name,
            "steps": [
                {"number": step.number, "title": step_title(step, language), "hold": step.held}
                for step in plan.steps
                if step.shell == name
            ],
        }
        for name in names
    ]


def graph_html(plan: Plan, schedule: Schedule, graph: "nx.MultiGraph[str]", language: Language = "en") -> str:
    """Return the plan of a graph of parts as one HTML page without links to anything else; same plan, same text.

    Every section has the members in plan as lines from start to end, those of the step heavy and named.
    """
    words, units = booklet_words(language), units_of(graph)
    lines, height = _on_sheet(graph, units)
    slid = any(step.phase == "slide" for step in plan.steps)
    slides = _ways(interlacing(graph, later=()), units) if slid else {}
    drawn, laid = {}, dict[str, None]()
    for step in plan.steps:
        shown = laid if len(units) <= _MOST_LAID else ()
        drawn[f"step-{step.number}"] = _step_svg(step, lines, height, units, slides, shown)
        laid |= dict.fromkeys(mark for mark in (*step.assemblies, *step.marks) if mark in units)
    card = words["card"] | {"counted": words["card"]["at_hand"], "extras": words["card"]["extras_up"]}
    people = max((step.crew for step in plan.steps), default=0)
    told = words["cover"]["crew"].format(steps=len(plan.steps), people=people, days=ceil(schedule.days))
    data = {
        "kind": "graph",
        "language": language,
        "title": plan.name,
        "name": plan.name,
        "words": words
        | {"foot": words["sequence_foot"], "subtitle": words["sequence"], "card": card, "read": {"lines": []}},
        "cover": {"picture": "", "told": told, "totals": None},
        "findings": finding_lines(plan.findings, language),
        "chapters": _chapters(plan, words, language),
        "schedule": "",
        "cards": [_card(plan, step, words, f"step-{step.number}", language) for step in plan.steps],
        **dict.fromkeys(("phases", "maps", "layings", "lockings", "segments"), ()),
    }
    handled = ((s.number, step_title(s, language), dict.fromkeys((*s.assemblies, *s.marks))) for s in plan.steps)
    return filled_page(Booklet(data, drawn), handled, next(iter(units), ""))
