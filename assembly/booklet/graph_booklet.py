"""The booklet of any graph of parts: the weave from above, its pieces, its steps with their pictures."""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from typing import Any

import networkx as nx

from aag_cad.language import Language, figure, printed, say
from aag_cad.parts.kinds import is_fastener
from aag_cad.units import MM_PER_M
from assembly.base.mark_ranges import short_in
from assembly.base.names import node_text
from assembly.base.steps import Plan, Step
from assembly.booklet.booklet_data import Booklet, Handled, booklet_data, card_lines, sheet_words
from assembly.booklet.cards import Known, card_table, length_words, mass_words, step_card
from assembly.booklet.qr import qr_svg
from assembly.booklet.step_words import step_title
from assembly.graph.interlacing import interlacing
from assembly.graph.laying_units import is_laid, units_of
from assembly.graph.whole import whole_graph
from assembly.pictures.weave_pictures import (
    Floor,
    cover_svg,
    floor_of,
    floor_svg,
    joints_of_step,
    map_svg,
    units_of_step,
)
from assembly.plan.graph_plan import unit_kits, unit_weights
from assembly.plan.schedule import Schedule

# With more rows the pieces of a section stand in one line, and with more names a map can no longer be read.
_MOST_ROWS, _MOST_NAMES = 14, 150


def _known(graph: "nx.MultiGraph[str]", floor: Floor, language: Language) -> Known:
    """Return what cards know of the parts: a fastener is found at the first of its joints."""
    names = {mark: printed(node_text(node), language) for mark, node in graph.nodes(data=True)}
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

    def word(key: str, **figures: int) -> str:
        return say(language, f"cards.whole.{key}", **figures)

    language, nodes = known.language, graph.nodes
    groups: dict[str, dict[int, list[float]]] = defaultdict(lambda: defaultdict(list))
    for mark in sorted(graph, key=lambda mark: (not is_laid(nodes[mark]), known.names[mark], mark)):
        groups[known.names[mark]][round(nodes[mark]["length_mm"])].append(nodes[mark]["mass_kg"])
    brief = sum(map(len, groups.values())) > _MOST_ROWS
    rows = []
    for name, lengths in groups.items():
        for alike in [sorted(lengths)] if brief else [[length] for length in sorted(lengths)]:
            masses = [mass for length in alike for mass in lengths[length]]
            told = " … ".join(dict.fromkeys((f"{alike[0]}", f"{alike[-1]}")))
            rows.append([name, f"{told} mm", str(len(masses)), mass_words(sum(masses), language)])
    laid = [node for _, node in nodes(data=True) if is_laid(node)]
    metres = sum(node["length_mm"] for node in laid) / MM_PER_M
    heaviest = max(known.weights, key=lambda mark: (known.weights[mark][0], mark))
    whole = mass_words(sum(node["mass_kg"] for _, node in nodes(data=True)), language)
    rows.append([word("all"), "", str(len(graph)), whole])
    facts = [
        [word("laid"), str(len(laid))],
        [word("metres"), figure(f"{metres:.1f} m", language)],
        [word("crossings"), str(sum(edge["kind"] == "crossing" for _, _, edge in graph.edges(data=True)))],
        [word("slid"), str(len(floor.slides))],
        [word("heaviest"), f"{heaviest}, {mass_words(known.weights[heaviest][0], language)}"],
    ]
    return card_table(language, "whole", rows) | {"facts": facts}


def _cards(
    words: Mapping[str, Any], plan: Plan, floor: Floor, known: Known, pictures: dict[str, str]
) -> Iterator[dict[str, Any]]:
    """Yield the cards of all steps; their pictures are added to ``pictures``."""
    there: list[str] = []
    for step in plan.steps:
        own, name = units_of_step(floor, step), f"step-{step.number}"
        listed = [mark for mark in step.marks if mark not in own]
        card = step_card(plan, step, known, _table(floor, step, known), listed)
        pictures |= {name: floor_svg(floor, step, there), f"qr-{step.number}": qr_svg(card["qr"])}
        there += own
        yield card | card_lines("sequence", words, step, card) | {
            "pictures": [name],
            "caption": words["captions"][f"graph {step.phase}"],
            "qr": f"qr-{step.number}",
            "key": "",
        }  # fmt: skip


def _handled(graph: "nx.MultiGraph[str]", plan: Plan, floor: Floor, language: Language) -> Iterator[Handled]:
    """Yield for each step its number, title and what it handles: its parts, beams, joints, and what these tie."""
    for step in plan.steps:
        joints = joints_of_step(floor, step)
        tied = (
            {floor.planks.get(other, other) for mark in step.marks for other in graph[mark]} if joints else set[str]()
        )
        yield step.number, step_title(step, language), sorted({*step.marks, *step.assemblies, *joints, *tied})


def graph_booklet(graph: "nx.Graph[str]", plan: Plan, schedule: Schedule, language: Language = "en") -> Booklet:
    """Return the booklet of the plan of any graph of parts; the same plan gives the same booklet."""
    whole = whole_graph(graph)
    units = units_of(whole)
    floor = floor_of(whole, units, interlacing(whole, later=()))
    known, words = _known(whole, floor, language), sheet_words("sequence", language, "graph")
    pictures = {"cover": cover_svg(floor)}
    data, pictures["schedule"] = booklet_data(
        "sequence",
        plan.name,
        words,
        plan,
        schedule,
        _totals(whole, floor, known),
        _cards(words, plan, floor, known, pictures),
        language,
        cover="cover",
        rest=plan.name,
    )
    if len(units) <= _MOST_NAMES:
        pictures["map"] = map_svg(floor)
        data["maps"] = [words["floor"] | {"picture": "map", "legend": ""}]
    return Booklet(data, pictures, tuple(_handled(whole, plan, floor, language)), next(iter(units), ""))
