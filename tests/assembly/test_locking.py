"""The order of fixing the flat planks: greedy against all orders, soft modes against rigidity, and the vault."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations, pairwise, permutations
from xml.etree import ElementTree

import numpy as np
import pytest
from frame_modes import lowest_eigenvalues

from aag_cad.design import Design, load_design
from aag_cad.mechanics.frame.model import DOFS, FrameModel, FrameSection, NodalLoad, Support
from aag_cad.mechanics.frame.shell import ShellFrame, shell_frame
from aag_cad.mechanics.frame.statics import FrameResult, static_solution
from aag_cad.mechanics.frame.system import against_unknowns, frame_system, full_stiffness
from aag_cad.parts.model import Gridshell, Shell
from aag_cad.pipeline import gridshell_of
from aag_cad.units import Floats
from assembly.base.errors import PlanError
from assembly.base.locking_order import Group, LockingOrder, frequency
from assembly.locking.model import GRAVITY, LockingModel, locking_model, modes_of, sag_of
from assembly.locking.order import (
    SAG_LIMIT,
    Value,
    area_under,
    edge_groups,
    greedy_order,
    locking_order,
    locking_orders,
    lowest_eigenvalue,
    soft_mode_count,
)
from assembly.pictures.locking_chart import LOCKING_HEADER, locking_rows, locking_svg

BAY = 300.0


@pytest.fixture(scope="module")
def small() -> Gridshell:
    """The vault's design with six geodesics a shell."""
    data = load_design("vault").model_dump()
    data["pattern"]["geodesics"] = 6
    return gridshell_of(Design.model_validate(data))


@pytest.fixture(scope="module")
def vault_order(gridshell: Gridshell) -> LockingOrder:
    """The order of the first shell of the vault."""
    return locking_order(gridshell.shells[0], gridshell.timber)


def supported(shell: Shell, frame: ShellFrame, model: LockingModel) -> FrameModel:
    """Return the frame on its feet and on the props at the hoists, built anew and not from the locking model."""
    slaves = {link.slave for link in frame.model.links}
    held = [Support(node, ("x", "y", "z")) for foot in model.feet for node in frame.beam_nodes[foot]]
    held += [Support(n, ("z",)) for hoist in model.hoists for n in frame.beam_nodes[hoist] if n not in slaves]
    return replace(frame.model, supports=tuple(held))


def flat_planks(shell: Shell, *families: str) -> tuple[str, ...]:
    return tuple(plank.mark for plank in shell.planks if plank.family in families)


def self_weight(frame: ShellFrame) -> tuple[NodalLoad, ...]:
    nodes = [node.mark for node in frame.model.nodes]
    return tuple(
        NodalLoad(node, (0.0, 0.0, -GRAVITY * weight))
        for node, weight in zip(nodes, frame.masses.tolist(), strict=True)
    )


def best_order(groups: Sequence[Group], value: Value, first: Sequence[Group] = ()) -> tuple[Group, ...]:
    """Return the best of all orders that begin with ``first`` by its area; 2^n values for n groups left.

    Dynamic programming: the best order of a set ends with some group, and is the best order of the others before it.
    """
    left = [item for item in groups if item not in first]
    start = frozenset(first)
    best: dict[frozenset[Group], tuple[float, tuple[Group, ...]]] = {frozenset(): (0.0, ())}
    for size in range(1, len(left) + 1):
        for chosen in map(frozenset, combinations(left, size)):
            before = [(*best[chosen - {last}], last) for last in left if last in chosen]
            area, order, last = max(before, key=lambda item: item[0])
            best[chosen] = area + value(start | chosen), (*order, last)
    return (*first, *best[frozenset(left)][1])


def test_the_states_are_those_of_a_frame_built_anew_with_the_planks_that_are_fixed(small: Gridshell) -> None:
    """Eigenvalues and sag by adding up planks against ``lowest_eigenvalues`` and ``static_solution`` of the whole."""
    shell = small.shells[0]
    model = locking_model(shell, small.timber)
    for fixed in ((), model.lower, model.upper, ("S1-G-02", "S1-G-05"), (*model.upper, "S1-G-03")):
        frame = shell_frame(shell, small.timber, fixed=fixed)
        standing = supported(shell, frame, model)
        expected = lowest_eigenvalues(standing, 6, frame.masses)
        assert modes_of(model, fixed, 6)[0] == pytest.approx(expected, rel=1e-6)
        moved = static_solution(standing, self_weight(frame))
        assert sag_of(model, fixed, 1e9, 4).displacement == pytest.approx(largest_on_beams(frame, moved), rel=1e-6)


def largest_on_beams(frame: ShellFrame, result: FrameResult) -> float:
    at = [i for i, node in enumerate(frame.model.nodes) if "-A" in node.mark]
    return float(np.linalg.norm(result.displacements[at, :3], axis=1).max())


def test_proposed_props_hold_what_a_frame_with_supports_there_holds(small: Gridshell) -> None:
    shell = small.shells[0]
    model = locking_model(shell, small.timber)
    sag = sag_of(model, (), 0.2, 2)
    assert len(sag.props) == 2
    assert sag.props[0].sinking > 0.2
    frame = shell_frame(shell, small.timber, fixed=())
    standing = supported(shell, frame, model)
    slaves = {link.slave for link in frame.model.links}
    props = [n for prop in sag.props for n in frame.beam_nodes[prop.joint] if n not in slaves]
    propped = replace(standing, supports=(*standing.supports, *(Support(node, ("z",)) for node in props)))
    result = static_solution(propped, self_weight(frame))
    assert sag.propped == pytest.approx(largest_on_beams(frame, result), rel=1e-6)
    places = [node.mark for node in frame.model.nodes]
    reactions = [result.reactions[places.index(node), 2] for node in props]
    assert [prop.force for prop in sag.props] == pytest.approx(reactions, rel=1e-6)


def test_no_eigenvalue_falls_when_a_plank_is_fixed(small: Gridshell) -> None:
    """Courant's minimax principle: masses stay, stiffness is added."""
    model = locking_model(small.shells[0], small.timber)
    fixed: tuple[str, ...] = ()
    before = modes_of(model, fixed, 6)[0]
    for group in (*edge_groups(model), *model.geodesics):
        fixed = (*fixed, *group)
        after = modes_of(model, fixed, 6)[0]
        assert np.all(after > before * (1.0 - 1e-6))
        before = after


def test_the_greedy_order_comes_within_two_percent_of_the_best_of_all_720(small: Gridshell) -> None:
    """Six geodesics one by one after the edges: area under the lowest eigenvalue, greedy / best = 0.991."""
    model = locking_model(small.shells[0], small.timber, pairs=False)
    value, edges = lowest_eigenvalue(model), edge_groups(model)
    groups = (*edges, *model.geodesics)
    best = max(area_under((*edges, *order), value) for order in permutations(model.geodesics))
    assert area_under(best_order(groups, value, edges), value) == pytest.approx(best, rel=1e-12)
    ratio = area_under(greedy_order(groups, value, edges), value) / best
    assert ratio == pytest.approx(0.991, abs=0.005)


def test_in_pairs_the_greedy_order_is_the_best_of_all(small: Gridshell) -> None:
    model = locking_model(small.shells[0], small.timber)
    value = lowest_eigenvalue(model)
    groups = (*edge_groups(model), *model.geodesics)
    assert model.geodesics == (("S1-G-01", "S1-G-06"), ("S1-G-02", "S1-G-05"), ("S1-G-03", "S1-G-04"))
    assert greedy_order(groups, value) == best_order(groups, value)


def rigidity_matrix(model: FrameModel) -> Floats:
    """Return one row (6 n) for each thing that does not give when members are bars between pins.

    Planks do not stretch; arms, studs and supports are rigid; bending and torsion are free. Rotations are scaled by a
    bay's length. Written from the data of the model, without the engine.
    """
    place = {node.mark: i for i, node in enumerate(model.nodes)}
    points = np.array([node.point for node in model.nodes])
    rows: list[Floats] = []

    def row(*terms: tuple[int, Floats, Floats]) -> None:
        line = np.zeros((len(points), 6))
        for node, shift, turn in terms:
            line[node, :3] += shift
            line[node, 3:] += turn / BAY
        rows.append(line.ravel())

    none, axes = np.zeros(3), np.eye(3)
    for item in model.elements:
        i, j = place[item.start], place[item.end]
        a, b = np.array(item.start_offset), np.array(item.end_offset)
        chord = points[j] + b - points[i] - a
        along = chord / np.linalg.norm(chord)
        row((j, along, np.cross(b, along)), (i, -along, -np.cross(a, along)))
    for link in model.links:
        m, s = place[link.master], place[link.slave]
        arm = points[s] - points[m]
        square = axes if link.pin is None else np.linalg.svd(np.array([link.pin]))[2][1:]
        for axis in axes:
            row((s, axis, none), (m, -axis, -np.cross(arm, axis)))
        for axis in square:
            row((s, none, BAY * axis), (m, none, -BAY * axis))
    for support in model.supports:
        for dof in support.held:
            row((place[support.node], axes[DOFS.index(dof)], none))
    return np.array(rows)


@pytest.mark.parametrize(
    "fixed", [(), ("E",), ("S1-G-03",), ("S1-G-01", "S1-G-06"), ("E", "S1-G-02", "S1-G-05"), ("E", "G")]
)
def test_soft_modes_are_the_null_space_of_the_rigidity_matrix_when_bending_and_torsion_vanish(
    small: Gridshell, fixed: tuple[str, ...]
) -> None:
    """The shell on its feet; bending and torsion 1e-15 of what they are, against a dense SVD of bars and pins.

    The smallest singular value that is not 0 is 1e-2 of the largest: no tolerance decides.
    """
    shell = small.shells[0]
    screwed = [mark for name in fixed for mark in (flat_planks(shell, name) or (name,))]
    frame = shell_frame(shell, small.timber, fixed=screwed)
    feet = locking_model(shell, small.timber).feet
    held = tuple(Support(node, ("x", "y", "z")) for foot in feet for node in frame.beam_nodes[foot])
    model = replace(frame.model, supports=held)
    matrix = rigidity_matrix(model)
    singular = np.linalg.svd(matrix, compute_uv=False)
    rank = int(np.sum(singular > 1e-9 * singular[0]))
    assert singular[rank - 1] > 5e-3 * singular[0]
    bars = tuple(
        replace(item, section=FrameSection(item.section.area, *(1e-15 * v for v in bendings(item.section))))
        for item in model.elements
    )
    system = frame_system(replace(model, elements=bars))
    stiffness = against_unknowns(system, full_stiffness(system)).toarray()
    eigenvalues = np.linalg.eigvalsh(stiffness[np.ix_(system.free, system.free)])
    assert soft_mode_count(eigenvalues.tolist(), 1e-3) == matrix.shape[1] - rank


def bendings(section: FrameSection) -> tuple[float, float, float]:
    return section.torsion, section.inertia_y, section.inertia_z


def test_the_hoisted_vault_has_three_soft_modes_and_the_finished_one_none(vault_order: LockingOrder) -> None:
    hoisted, finished = vault_order.steps[0], vault_order.steps[-1]
    assert hoisted.marks == ()
    assert hoisted.soft_modes == 3
    assert finished.soft_modes == 0
    # The next mode is more than twice as fast: the count does not hang on where the threshold lies.
    assert frequency(hoisted.eigenvalues[3]) > 2.0 * frequency(hoisted.eigenvalues[2])


def test_the_vault_is_fixed_edges_first_then_the_side_geodesics(vault_order: LockingOrder) -> None:
    """Paper, section 3.2: planks at the lower and upper boundaries; then the sides, which hold the shape."""
    marks = [step.marks for step in vault_order.steps]
    assert marks[1:4] == [("S1-E-01",), ("S1-E-02", "S1-E-03"), ("S1-G-01", "S1-G-14")]
    fixed = [mark for step in marks for mark in step]
    assert len(fixed) == len(set(fixed)) == 17
    lowest = [step.eigenvalues[0] for step in vault_order.steps]
    assert all(b > a * (1.0 - 1e-6) for a, b in pairwise(lowest))
    assert lowest[3] > 3.0 * lowest[2]


def test_the_rule_that_edges_come_first_has_its_price(vault_order: LockingOrder) -> None:
    """15 % of the area under the lowest eigenvalue: the lower edge plank lies on feet that are held anyway.

    The search by subspace iteration agrees with the eigenvalues of the steps, which are Lanczos's.
    """
    assert vault_order.area == pytest.approx(sum(step.eigenvalues[0] for step in vault_order.steps[1:]), rel=1e-6)
    assert vault_order.rule_price == pytest.approx(0.15, abs=0.02)


def test_props_are_proposed_while_a_soft_mode_sags_too_far(vault_order: LockingOrder) -> None:
    for step in vault_order.steps:
        assert bool(step.props) == (step.soft_modes > 0 and step.displacement > SAG_LIMIT)
        assert step.propped <= step.displacement
    assert vault_order.steps[0].props[0].joint in ("S1-K-015", "S1-K-198")
    assert vault_order.steps[0].propped < SAG_LIMIT


def test_without_the_rule_edges_take_their_turn_and_it_costs_nothing(small: Gridshell) -> None:
    order = locking_order(small.shells[0], small.timber, edges_first=False)
    assert order.rule_price == 0.0
    assert order.steps[1].marks == ("S1-G-03", "S1-G-04")


def test_shells_alike_have_the_same_order_with_their_own_marks(small: Gridshell) -> None:
    first, _, third = locking_orders(small)
    assert third.shell == "S3"
    assert [step.marks for step in third.steps] == [
        tuple(mark.replace("S1", "S3") for mark in step.marks) for step in first.steps
    ]
    assert third.hoists == tuple(mark.replace("S1", "S3") for mark in first.hoists)
    own = locking_order(small.shells[2], small.timber)
    assert [step.marks for step in own.steps] == [step.marks for step in third.steps]


def test_the_table_has_a_line_for_every_step_and_the_released_shell(vault_order: LockingOrder) -> None:
    rows = locking_rows(vault_order)
    assert all(len(row) == len(LOCKING_HEADER) for row in rows)
    assert [row[1] for row in rows] == [*map(str, range(10)), "released"]
    assert rows[2][2] == "S1-E-02 S1-E-03"


def test_the_plot_shows_every_step_within_its_sheet(vault_order: LockingOrder) -> None:
    root = ElementTree.fromstring(locking_svg(vault_order))
    space = {"svg": "http://www.w3.org/2000/svg"}
    _, _, width, height = (float(value) for value in root.attrib["viewBox"].split())
    texts = {element.text for element in root.findall(".//svg:text", space)}
    assert {mark[3:] for step in vault_order.steps for mark in step.marks} <= texts
    circles = root.findall(".//svg:circle", space)
    assert len(circles) == 4 * len(vault_order.steps)
    assert all(0 < float(c.attrib["cx"]) < width and 0 < float(c.attrib["cy"]) < height for c in circles)


def test_a_hoist_that_is_no_stud_is_refused(small: Gridshell) -> None:
    with pytest.raises(PlanError, match=r"^S1-K-001: it is no stud of S1"):
        locking_order(small.shells[0], small.timber, hoists=("S1-K-001",))


@pytest.mark.parametrize(("soft", "limit"), [(0.0, 20.0), (1.5, 20.0), (0.5, 0.0)])
def test_thresholds_out_of_range_are_refused(small: Gridshell, soft: float, limit: float) -> None:
    with pytest.raises(PlanError, match=r"^S1: soft = .*limit more than 0 mm"):
        locking_order(small.shells[0], small.timber, soft=soft, limit=limit)


def test_a_shell_without_geodesics_is_refused(small: Gridshell) -> None:
    shell = small.shells[0]
    gone = {*flat_planks(shell, "G"), *(joint.mark for joint in shell.joints if joint.kind in ("AG", "foot", "ridge"))}
    bare = replace(
        shell,
        planks=tuple(plank for plank in shell.planks if plank.mark not in gone),
        joints=tuple(joint for joint in shell.joints if joint.kind in ("AA", "boundary")),
        straps=(),
        shoes=(),
        rods=(),
        footings=(),
    )
    named = {mark for joint in bare.joints for mark in (*joint.members, *joint.fasteners)}
    bare = replace(
        bare,
        blocks=tuple(block for block in bare.blocks if block.mark in named),
        bolts=tuple(bolt for bolt in bare.bolts if bolt.mark in named),
        screws=tuple(screw for screw in bare.screws if screw.mark in named),
        mullions=(),
        strips=(),
        clamps=(),
    )
    with pytest.raises(PlanError, match=r"^S1: it has no geodesic"):
        locking_order(bare, small.timber)
