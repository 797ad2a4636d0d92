"""Why a part comes when it does: what must be there before it, what waits for it, what locks it, what time it has."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches

import networkx as nx

from aag_cad.language import Text, text
from aag_cad.parts.kinds import is_fastener
from assembly.base.any_graph import as_multigraph
from assembly.base.errors import PlanError
from assembly.base.locking_order import LockingOrder, frequency
from assembly.base.mark_ranges import named_marks
from assembly.base.names import kind_text
from assembly.base.steps import Plan, Step
from assembly.graph.laying_units import joint_name
from assembly.plan.schedule import Schedule

_MOST_SHOWN = 8
# What a step may have to do with a part; the first that holds is said.
_RELATIONS = ("under", "over", "joined", "fastened")


def _beams(graph: "nx.MultiGraph[str]") -> dict[str, str]:
    """Return the coupled beam of each part, or ""."""
    return {mark: str(values.get("beam", "")) for mark, values in graph.nodes(data=True)}


def step_of_parts(plan: Plan, graph: "nx.MultiGraph[str]") -> dict[str, Step]:
    """Return the step in which each part comes to its place; parts of a coupled beam come when the beam is laid."""
    at = {mark: step for step in plan.steps for mark in step.marks}
    laid = {beam: step for step in plan.steps if step.phase in ("lay A1", "lay A2", "lay") for beam in step.assemblies}
    return at | {mark: laid[beam] for mark, beam in _beams(graph).items() if beam in laid}


def _piece(graph: "nx.MultiGraph[str]", mark: str) -> tuple[str, ...]:
    """Return the parts of a mark: those of a coupled beam, or the part itself; PlanError if there is none."""
    if mark in graph:
        return (mark,)
    parts = tuple(node for node, beam in _beams(graph).items() if beam == mark)
    if not parts:
        near = get_close_matches(mark, sorted({*graph, *_beams(graph).values()} - {""}), _MOST_SHOWN, 0.0)
        raise PlanError(f"--explain {mark}: no part or beam has this mark; the nearest are {', '.join(near)}")
    return parts


def _neighbours(graph: "nx.MultiGraph[str]", parts: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield (relation, mark) of what meets some parts: it lies under or over them, or is joined to them."""
    own, beam = set(parts), graph.nodes[parts[0]].get("beam", "")
    for part in parts:
        for _, other, edge in graph.edges(part, data=True):
            home = graph.nodes[other].get("beam", "")
            if other in own or (beam and home == beam):
                continue
            above = edge.get("above", "")
            relation = "joined" if not above else "over" if above == other else "under"
            yield relation, home or other


def _around(
    graph: "nx.MultiGraph[str]", parts: Sequence[str], at: Mapping[str, Step]
) -> dict[tuple[int, str], list[str]]:
    """Return what meets some parts by the number of the step in which it comes, and by relation."""
    homes = {beam: mark for mark, beam in _beams(graph).items()}
    found: dict[tuple[int, str], list[str]] = defaultdict(list)
    for relation, mark in _neighbours(graph, parts):
        step = at.get(mark) or at.get(homes.get(mark, ""))
        if step is not None and mark not in found[step.number, relation]:
            found[step.number, relation].append(mark)
    return found


def _fastened(
    graph: "nx.MultiGraph[str]", parts: Sequence[str], plan: Plan, step: Step
) -> dict[tuple[int, str], list[str]]:
    """Return the fasteners at the joints of some parts by the number of the step that puts them in, if another one."""
    joints = {joint_name(*edge) for edge in graph.edges(parts, keys=True, data=True)}
    fasteners = {mark for mark, node in graph.nodes(data=True) if is_fastener(node["kind"])} - set(parts)
    at_joints = {edge[0] for edge in graph.edges(fasteners, keys=True, data=True) if joint_name(*edge) in joints}
    found: dict[tuple[int, str], list[str]] = defaultdict(list)
    for other in plan.steps:
        marks = [mark for mark in other.marks if mark in at_joints]
        if other is not step and marks:
            found[other.number, "fastened"] = marks
    return found


def _locked(mark: str, orders: Sequence[LockingOrder]) -> Iterator[Text]:
    """Yield when a flat plank is fixed in the locking order, and what that does."""
    for order in orders:
        for i, step in enumerate(order.steps):
            if mark in step.marks:
                before = order.steps[i - 1]
                yield text(
                    "explain.fixed", place=i, count=len(order.steps) - 1,
                    before=before.soft_modes, after=step.soft_modes,
                    low=frequency(before.eigenvalues[0]), high=frequency(step.eigenvalues[0]),
                )  # fmt: skip


def _line(step: Step, around: Mapping[tuple[int, str], Sequence[str]], otherwise: str) -> Text:
    """Return the line about a step: the first relation that it has to a part, else that one waits for the other."""
    for relation in _RELATIONS:
        marks = around.get((step.number, relation), ())
        if marks:
            more = " …" if len(marks) > _MOST_SHOWN else ""
            shown = f"{named_marks(marks[:_MOST_SHOWN])}{more}"
            return text(f"explain.{relation}", number=step.number, title=step.title, marks=shown)
    return text(f"explain.{otherwise}", number=step.number, title=step.title)


def _reasons(plan: Plan, step: Step, around: Mapping[tuple[int, str], Sequence[str]], later: bool) -> list[Text]:
    """Return why a step cannot come earlier (or later), one line for each step that it touches."""
    touched = {number for number, relation in around if later or relation != "fastened"}
    found = []
    for other in plan.steps:
        if other.number > step.number if later else other.number < step.number:
            linked = step.id in other.predecessors if later else other.id in step.predecessors
            if linked or other.number in touched:
                found.append(_line(other, around, "awaited" if later else "waits"))
    return found


def explanation(
    any_graph: "nx.Graph[str]",
    plan: Plan,
    mark: str,
    schedule: Schedule | None = None,
    locking: Sequence[LockingOrder] = (),
) -> list[Text]:
    """Return why a part or beam comes when it does, one line each.

    ``any_graph`` is that of a gridshell, or any other that a plan was made of. PlanError if no part has the mark, or no
    step handles it.
    """
    graph = as_multigraph(any_graph)
    parts = _piece(graph, mark)
    at, node = step_of_parts(plan, graph), graph.nodes[parts[0]]
    made = next((step for step in plan.steps if parts[0] in step.marks), None)
    step = at.get(parts[0])
    if step is None:
        raise PlanError(f"--explain {mark}: no step of the plan handles it; see the findings of the plan")
    length = max(float(graph.nodes[part]["length_mm"]) for part in parts)
    mass = sum(float(graph.nodes[part]["mass_kg"]) for part in parts)
    lines = [text("explain.part", mark=mark, kind=kind_text(node["kind"]), length=length, mass=mass)]
    beam = node.get("beam", "")
    if beam and beam != mark:
        lines.append(text("explain.of_beam", beam=beam))
    if made is not None and made is not step:
        lines.append(text("explain.made", number=made.number, title=made.title, beam=beam))
    lines.append(text("explain.comes", number=step.number, title=step.title))
    if step.phase == "slide":
        lines.append(text("explain.slid"))
    around = _around(graph, parts, at) | _fastened(graph, parts, plan, step)
    earlier = _reasons(plan, step, around, later=False)
    lines += [text("explain.before"), *(text("explain.line", line=line) for line in earlier)] if earlier else []
    lines += [] if earlier else [text("explain.first")]
    later = _reasons(plan, step, around, later=True)
    lines += [text("explain.after"), *(text("explain.line", line=line) for line in later)] if later else []
    lines += _locked(mark, locking)
    if schedule is not None:
        when = next(found for found in schedule.steps if found.id == step.id)
        key = "explain.critical" if when.critical else "explain.slack"
        lines.append(text(key, slack=when.slack))
    return lines
