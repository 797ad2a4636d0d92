"""The booklet of any graph of parts: the weave from above, its pieces, its steps with their pictures."""

from collections import defaultdict
from collections.abc import Iterable, Iterator
from itertools import chain
from typing import Any

import networkx as nx

from aag_cad.language import Language, figure, printed, say
from aag_cad.parts.kinds import is_fastener
from aag_cad.parts.marks import short_in
from aag_cad.units import MM_PER_M
from assembly.base.names import node_text
from assembly.base.steps import Plan, Step
from assembly.booklet.booklet_data import Booklet, booklet_of
from assembly.booklet.cards import Known, Sheets, card_table, length_words, mass_words, step_card
from assembly.booklet.words import sheet_words
from assembly.graph.interlacing import interlacing
from assembly.graph.laying_units import units_of
from assembly.graph.whole import whole_graph
from assembly.pictures.floor import Floor, floor_of, joints_of_step, units_of_step
from assembly.pictures.weave_pictures import cover_svg, floor_svg, key_svg, map_svg
from assembly.plan.graph_plan import unit_kits, unit_weights
from assembly.plan.schedule import Schedule

# With more rows the pieces of a section stand in one line, and with more names a map can no longer be read.
_MOST_ROWS, _MOST_NAMES = 14, 150


def _known(graph: "nx.MultiGraph[str]", floor: Floor, language: Language) -> Known:
    """Return what cards know of the parts: a fastener is found at the first of its joints."""
    names = {}
    for mark, node in graph.nodes(data=True):
        long = "" if mark in floor.planks else f" {length_words(node['length_mm'])}"
        names[mark] = printed(node_text(node), language) + long
    joints = {
        mark: floor.joints[mark][0] for mark in graph if is_fastener(graph.nodes[mark]["kind"]) and floor.joints[mark]
    }
    return Known(names, joints, unit_weights(graph, unit_kits(graph, floor.units), floor.units), language)


def _table(floor: Floor, step: Step, known: Known) -> dict[str, Any] | None:
    """Return what a step lays or slides in: what it is, its length and mass, and where its ends lie on the floor."""
    rows = []
    for mark in units_of_step(floor, step):
        unit, (mass, length) = floor.units[mark], known.weights[mark]
        name = known.names[unit.parts[0]]
        if len(unit.parts) > 1:
            name = say(known.language, "cards.pieces.beam", count=len(unit.parts), name=name)
        ends = [f"{x:.0f}, {y:.0f}" for x, y in (floor.ends[mark] + 0.0).tolist()]
        rows.append([short_in(mark, step.shell), name, length_words(length), mass_words(mass, known.language), *ends])
    return card_table(known.language, "pieces", rows) if rows else None


def _totals(graph: "nx.MultiGraph[str]", floor: Floor, known: Known) -> dict[str, Any]:
    """Return the parts of a graph by section and length with counts and masses, and the whole in short."""
    language, nodes, laid = known.language, graph.nodes, floor.planks.keys()
    groups: dict[str, dict[int, list[str]]] = defaultdict(lambda: defaultdict(list))
    for mark in sorted(graph, key=lambda mark: (mark not in laid, known.names[mark], nodes[mark]["length_mm"])):
        groups[printed(node_text(nodes[mark]), language)][round(nodes[mark]["length_mm"])].append(mark)
    brief = sum(map(len, groups.values())) > _MOST_ROWS
    listed = [
        (name, alike)
        for name, lengths in groups.items()
        for alike in ([[*chain.from_iterable(lengths.values())]] if brief else lengths.values())
    ]
    rows = []
    for name, marks in listed:
        first, last = (f"{nodes[mark]['length_mm']:.0f}" for mark in (marks[0], marks[-1]))
        mass = mass_words(sum(nodes[mark]["mass_kg"] for mark in marks), language)
        rows.append([name, f"{first} mm" if first == last else f"{first} … {last} mm", str(len(marks)), mass])
    mass = mass_words(sum(node["mass_kg"] for node in nodes.values()), language)
    rows.append([say(language, "cards.whole.all"), "", str(len(graph)), mass])
    heaviest = max(known.weights, key=lambda mark: (known.weights[mark][0], mark))
    facts = {
        "laid": str(len(laid)),
        "metres": figure(f"{sum(nodes[mark]['length_mm'] for mark in laid) / MM_PER_M:.1f} m", language),
        "crossings": str(sum(edge["kind"] == "crossing" for _, _, edge in graph.edges(data=True))),
        "slid": str(len(floor.slides)),
        "heaviest": f"{heaviest}: {mass_words(known.weights[heaviest][0], language)}",
    }
    told = [[say(language, f"cards.whole.{key}"), value] for key, value in facts.items()]
    return card_table(language, "whole", rows) | {"facts": told}


def _handled(graph: "nx.MultiGraph[str]", floor: Floor, step: Step) -> Iterable[str]:
    """Return what a step handles: its parts, beams and joints, and the pieces that these tie."""
    joints = joints_of_step(floor, step)
    tied = (floor.planks.get(other, other) for mark in step.marks for other in (graph[mark] if joints else ()))
    return (*step.marks, *step.assemblies, *joints, *tied)


def _cards(
    sheets: Sheets, graph: "nx.MultiGraph[str]", floor: Floor, pictures: dict[str, str]
) -> Iterator[dict[str, Any]]:
    """Yield the cards of all steps; their pictures are added to ``pictures``."""
    there: list[str] = []
    for step in sheets.plan.steps:
        own, name, key = units_of_step(floor, step), f"step-{step.number}", key_svg(floor, step)
        listed = [mark for mark in step.marks if mark not in own]
        pictures |= {name: floor_svg(floor, step, there)} | ({f"key-{step.number}": key} if key else {})
        there += own
        yield step_card(sheets, step, _table(floor, step, sheets.known), listed, _handled(graph, floor, step)) | {
            "caption": sheets.words["captions"][f"graph {step.phase}"],
            "pictures": [name],
            "key": f"key-{step.number}" if key else "",
        }


def graph_booklet(graph: "nx.Graph[str]", plan: Plan, schedule: Schedule, language: Language = "en") -> Booklet:
    """Return the booklet of the plan of any graph of parts; the same plan gives the same booklet."""
    whole = whole_graph(graph)
    units = units_of(whole)
    floor = floor_of(whole, units, interlacing(whole, later=()))
    known, words = _known(whole, floor, language), sheet_words("sequence", language, "graph")
    sheets, pictures = Sheets("sequence", plan.name, plan, schedule, known, words), {"cover": cover_svg(floor)}
    booklet = booklet_of(
        sheets,
        _totals(whole, floor, known),
        _cards(sheets, whole, floor, pictures),
        pictures,
        cover="cover",
        rest=plan.name,
        example=next(iter(units), ""),
    )
    if len(units) > _MOST_NAMES:
        return booklet
    maps = [words["floor"] | {"picture": "map", "legend": ""}]
    return Booklet(booklet.data | {"maps": maps}, pictures | {"map": map_svg(floor)})
