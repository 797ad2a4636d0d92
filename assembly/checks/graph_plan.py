"""A second opinion on the plan of a graph: it is walked through step by step, without asking who planned it."""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from typing import Any

import networkx as nx

from aag_cad.parts.kinds import is_fastener
from assembly.base.any_graph import as_multigraph
from assembly.base.steps import Plan
from assembly.checks.walking import ancestors, crew_problems, numbering_problems, once_problems


def _nodes(graph: "nx.MultiGraph[str]") -> Mapping[str, Mapping[str, Any]]:
    nodes: Mapping[str, Mapping[str, Any]] = graph.nodes
    return nodes


def _flat(node: Mapping[str, Any]) -> bool:
    return node["kind"] == "plank" or "start" in node


def _buried(plan: Plan, graph: "nx.MultiGraph[str]", before: dict[str, set[str]]) -> Iterator[str]:
    """Yield the planks that would have to go under one that may lie already, by a step that does not slide them in."""
    step_of = {mark: step for step in plan.steps for mark in step.marks}
    for a, b, edge in graph.edges(data=True):
        if edge["kind"] != "crossing" or edge.get("above") == "" or a not in step_of or b not in step_of:
            continue
        layers = {mark: _nodes(graph)[mark].get("layer") or 0 for mark in (a, b)}
        upper = edge.get("above") or max((a, b), key=lambda mark: layers[mark])
        lower = b if upper == a else a
        below, over = step_of[lower], step_of[upper]
        if below.id in before[over.id]:
            continue
        if below.phase == "slide" and over.id in before[below.id]:
            continue
        yield f"{lower}: step {below.id} puts it under {upper}, which step {over.id} may have laid before"


def _unheld(plan: Plan, graph: "nx.MultiGraph[str]", before: dict[str, set[str]]) -> Iterator[str]:
    """Yield the parts that are put in before the planks that they are tied to, and fasteners before any member."""
    step_of = {mark: step for step in plan.steps for mark in step.marks}
    for step in plan.steps:
        done = before[step.id] | {step.id}
        for mark in (mark for mark in step.marks if mark in graph and not _flat(_nodes(graph)[mark])):
            home, fastens = _nodes(graph)[mark].get("beam"), is_fastener(_nodes(graph)[mark]["kind"])
            for other in sorted(graph[mark]):
                node = _nodes(graph)[other]
                # What is put together with a beam is fixed to that beam; the others come to it.
                needed = (
                    node.get("beam") == home if home else _flat(node) or (fastens and not is_fastener(node["kind"]))
                )
                if needed and (other not in step_of or step_of[other].id not in done):
                    yield f"{mark}: step {step.id} puts it in before {other} is there"


def _blocked(plan: Plan, graph: "nx.MultiGraph[str]", before: dict[str, set[str]]) -> Iterator[str]:
    """Yield the slides that come when a plank on their way may be fastened already: the others must lie loose."""
    tied: dict[str, list[tuple[str, str]]] = defaultdict(list)
    for step in (step for step in plan.steps if step.phase == "join"):
        for mark in step.marks:
            for other in graph[mark]:
                tied[other].append((mark, step.id))
    for step in (step for step in plan.steps if step.phase == "slide"):
        for mark in step.marks:
            ways = {other: [edge["kind"] for edge in edges.values()] for other, edges in graph[mark].items()}
            for other in sorted(other for other, kinds in ways.items() if "crossing" in kinds):
                for fastener, earlier in sorted(tied[other]):
                    if step.id not in before[earlier]:
                        yield f"{mark}: slid in by step {step.id}, but step {earlier} may fasten {other} by {fastener}"


def check_graph_plan(plan: Plan, graph: "nx.Graph[str]", people: int | None = None) -> list[str]:
    """Return what is wrong with the plan of any graph; nothing if it can be done as it stands, also side by side.

    Each part once; no step before what it waits for; no plank under one that lies unless it is slid in; nothing put in
    before the planks that it is tied to; the planks on the way of a slide loose; crews of 1 to ``people``.
    """
    several = as_multigraph(graph)
    named = "".join(f", {finding.mark}, " for finding in plan.findings if finding.severity == "error")
    homes = ((mark, node.get("beam") or mark) for mark, node in several.nodes(data=True))
    told = [mark for mark, home in homes if f", {mark}, " in named or f", {home}, " in named]
    faults = [*numbering_problems(plan), *once_problems(plan, several, told)]
    if faults:
        return faults
    before = ancestors(plan)
    faults += [*_buried(plan, several, before), *_unheld(plan, several, before), *_blocked(plan, several, before)]
    return [*faults, *crew_problems(plan, people)]
