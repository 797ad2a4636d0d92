"""Optimise a web under the paper's energies: spline control points on a coarse web first, then the vertices themselves.

Measured and explained in docs/optimiser.md: fairness acts on displacements, steps are increments with true derivatives,
the normals are eliminated, symmetry is substituted, everything is scaled to a mean edge of 1.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.sparse import csr_array

from aag_cad.errors import DesignError
from aag_cad.units import Floats
from aag_cad.web.energies import a_net, bottom_curve, constant_angle, fairness, geodesic
from aag_cad.web.goals import Goals, Iteration, Optimised, PointGoal, Reason
from aag_cad.web.line_curvatures import largest_bending, largest_twist
from aag_cad.web.normal_equations import Factorisation, best_factorisation, gauss_newton_step
from aag_cad.web.quality import WebQuality, quality
from aag_cad.web.targets import bending_radius, closeness, height, held_points, span, twist
from aag_cad.web.terms import Term, stacked
from aag_cad.web.unknowns import control_map, mirrored
from aag_cad.web.web import Web

Report = Callable[[Iteration], None]

BOTTOM_WEIGHT = 10.0
_COARSE_COLUMNS = 30
_CONTROLS = 14
_SPLINE_STEPS = 40
_MESH_STEPS = 40
_FIRST_FAIRNESS = 1e-2
_LAST_FAIRNESS = 1e-8
_MESH_FAIRNESS = 1e-5
_DAMPING = 1e-12
_STILL = 1e-9

PLANARITY = 1e-7
GEODESIC_DEG = 1e-3
ANGLE_DEG = 1e-5
BOTTOM_PER_EDGE = 1e-6
SIZE = 0.01


@dataclass(frozen=True)
class Method:
    """How the steps are taken; ``fair_positions`` reads Eq. (6) literally, which collapses and is there to show it."""

    levenberg_marquardt: bool = False
    factorisation: Factorisation = "scipy"
    fair_positions: bool = False


@dataclass(frozen=True, eq=False)
class _Stage:
    """A web in the making: its name, the start, the goals in its scale, the bottom row, the map from the unknowns."""

    name: str
    start: Floats
    goals: Goals
    row: int
    to_vertices: csr_array
    fairness: tuple[float, float]
    steps: int


def mean_edge(vertices: Floats) -> float:
    """Return the mean length of the A edges (the diagonals) of a grid."""
    both = (vertices[1:, 1:] - vertices[:-1, :-1], vertices[1:, :-1] - vertices[:-1, 1:])
    return float(np.mean([np.linalg.norm(edges, axis=-1).mean() for edges in both]))


def _scaled(goals: Goals, factor: float) -> Goals:
    """Return goals with all lengths multiplied by a factor."""
    wishes = {name: getattr(goals, name) for name in ("height", "span", "min_radius")}
    lengths = {name: wish * factor for name, wish in wishes.items() if wish is not None}
    points = tuple(replace(p, point=tuple(x * factor for x in p.point)) for p in goals.points)  # type: ignore[arg-type]
    turn = None if goals.max_twist is None else goals.max_twist / factor
    return replace(goals, points=points, max_twist=turn, **lengths)


def _weighted(item: Term, weight: float) -> Term:
    root = math.sqrt(weight)
    return Term(item.residuals * root, csr_array(item.jacobian * root))


def _terms(web: Web, start: Floats, goals: Goals, row: int) -> dict[str, Term]:
    """Return the weighted terms of Eq. (7) but for fairness, and the designer's targets."""
    terms = {"A-net": a_net(web), "geodesic": geodesic(web)}
    if goals.angle is not None:
        terms["angle"] = constant_angle(web, goals.angle)
    if goals.bottom_row is not None:
        terms["bottom"] = bottom_curve(web, row)
    if goals.height is not None:
        terms["height"] = height(web, row, goals.height)
    if goals.span is not None:
        terms["span"] = span(web, row, goals.span)
    if goals.points:
        terms["points"] = held_points(web, goals.points)
    if goals.closeness > 0.0:
        terms["closeness"] = _weighted(closeness(web, start), goals.closeness)
    if goals.min_radius is not None:
        terms["radius"] = bending_radius(web, goals.min_radius)
    if goals.max_twist is not None:
        terms["twist"] = twist(web, goals.max_twist)
    weights = {"bottom": BOTTOM_WEIGHT, **goals.weights}
    return {name: _weighted(item, weights[name]) if name in weights else item for name, item in terms.items()}


def _linearised(stage: _Stage, vertices: Floats, weight: float, method: Method) -> tuple[Term, dict[str, float]]:
    """Return all residuals with their Jacobian by the unknowns, and the energies without fairness."""
    web = Web(vertices)
    terms = _terms(web, stage.start, stage.goals, stage.row)
    # The displacement is counted from the current web: fairness then smooths the step and never bends the solution.
    fair = fairness(web, np.zeros_like(vertices) if method.fair_positions else vertices)
    every = stacked([*terms.values(), _weighted(fair, weight)])
    by_unknowns = Term(every.residuals, csr_array(every.jacobian @ stage.to_vertices))
    return by_unknowns, {name: item.energy for name, item in terms.items()}


def _descend(stage: _Stage, vertices: Floats, method: Method, done: list[Iteration], report: Report) -> Floats:
    """Return the vertices after the steps of a stage, and add its iterations to ``done``.

    Fairness decays by half from step to step. Levenberg-Marquardt undoes a step that raises the energy and damps the
    next one tenfold. The stage ends when nothing moves, or when the energy at the last fairness has stopped falling.
    """
    weight, last = stage.fairness
    damping, best, slow = _DAMPING, math.inf, 0
    kept = vertices
    for _ in range(stage.steps):
        linear, energies = _linearised(stage, vertices, weight, method)
        energy = sum(energies.values())
        if method.levenberg_marquardt and energy > best * 1.001:
            vertices, damping = kept, damping * 10.0
            linear, energies = _linearised(stage, vertices, weight, method)
        elif method.levenberg_marquardt:
            kept, damping = vertices, max(damping / 5.0, _DAMPING)
        slow = slow + 1 if weight <= last and energy > 0.95 * best else 0
        best = min(best, energy)
        step = gauss_newton_step(linear.jacobian, linear.residuals, damping, method.factorisation)
        move = np.asarray(stage.to_vertices @ step).reshape(vertices.shape)
        largest = float(np.abs(move).max())
        done.append(Iteration(len(done), stage.name, energies, largest))
        report(done[-1])
        if not math.isfinite(largest):
            return vertices
        vertices = vertices + move
        weight = max(weight / 2.0, last)
        if largest < _STILL or slow >= 3:
            break
    return vertices


def _refinement(columns: int, rows_above: int) -> int:
    """Return how many fine cells make a coarse one: the divisor that comes nearest to 30 coarse columns."""
    divisors = [k for k in range(1, columns) if columns % k == 0 and rows_above % k == 0 and columns // k >= 8]
    return min(divisors, key=lambda k: abs(columns / k - _COARSE_COLUMNS), default=1)


def _coarse_points(points: tuple[PointGoal, ...], bottom: int, below: int, k: int) -> tuple[PointGoal, ...]:
    """Return the held points that are vertices of the coarse web; the others are met by the vertices' own stage."""
    return tuple(
        replace(p, row=(p.row - bottom) // k + below, column=p.column // k)
        for p in points
        if (p.row - bottom) % k == 0 and p.column % k == 0 and p.row >= bottom
    )


def _control_count(samples: int) -> int:
    """Return how many control points a direction gets: too many for its samples, and the spline can zigzag too."""
    return min(_CONTROLS, max(6, int(0.6 * samples)))


def _spline_stage(web: Floats, goals: Goals, method: Method, done: list[Iteration], report: Report) -> Floats:
    """Return the web after optimising the control points of a quintic B-spline on a web of about 900 vertices."""
    rows, columns, _ = web.shape
    bottom = goals.bottom_row or 0
    below = 0 if goals.bottom_row is None else 1
    k = _refinement(columns - 1, rows - 1 - bottom)
    coarse_rows = np.arange(-below * k, rows - bottom, k, dtype=np.float64)
    coarse_columns = np.arange(0, columns, k, dtype=np.float64)
    bounds = ((min(-float(bottom), coarse_rows[0]), rows - 1.0 - bottom), (0.0, columns - 1.0))
    controls = _control_count(len(coarse_rows)), _control_count(len(coarse_columns))
    free = mirrored(controls[0], controls[1], goals.symmetric)
    # The ghost row of the coarse web may lie under those of the given one: the start is continued there.
    fine_rows = np.arange(rows, dtype=np.float64) - bottom
    along = make_interp_spline(fine_rows, web, k=5)
    first = np.asarray(along(coarse_rows))[:, ::k]
    to_coarse = csr_array(control_map(coarse_rows, coarse_columns, bounds, controls) @ free)
    unknowns = -gauss_newton_step(to_coarse, first.ravel(), _DAMPING, "scipy")
    edge = mean_edge(first)
    start = np.asarray(to_coarse @ unknowns).reshape(first.shape) / edge
    scaled = replace(
        _scaled(goals, 1.0 / edge), points=_coarse_points(_scaled(goals, 1.0 / edge).points, bottom, below, k)
    )
    stage = _Stage("spline", start, scaled, below, to_coarse, (_FIRST_FAIRNESS, _LAST_FAIRNESS), _SPLINE_STEPS)
    solved = _descend(stage, start, method, done, report)
    unknowns = -gauss_newton_step(to_coarse, (solved * edge).ravel(), _DAMPING, "scipy")
    fine = control_map(fine_rows, np.arange(columns, dtype=np.float64), bounds, controls) @ free
    return np.asarray(fine @ unknowns).reshape(web.shape)


def _mesh_stage(
    web: Floats, start: Floats, goals: Goals, method: Method, done: list[Iteration], report: Report
) -> Floats:
    """Return the web after optimising its vertices, scaled to a mean edge of 1."""
    edge = mean_edge(web)
    free = mirrored(web.shape[0], web.shape[1], goals.symmetric)
    scaled, fair = _scaled(goals, 1.0 / edge), (_MESH_FAIRNESS, _MESH_FAIRNESS)
    stage = _Stage("mesh", start / edge, scaled, goals.bottom_row or 0, free, fair, _MESH_STEPS)
    return _descend(stage, web / edge, method, done, report) * edge


def _limits(web: Web, goals: Goals) -> list[tuple[str, float, float]]:
    """Return what is measured of a web against its goals: name, figure found, figure allowed."""
    measures, v = quality(web), web.vertices
    edge, row, middle = mean_edge(v), goals.bottom_row or 0, v.shape[1] // 2
    limits = [
        ("planarity per edge", measures.planarity_per_edge, PLANARITY),
        ("geodesic deviation in degrees", measures.geodesic_deviation_deg, GEODESIC_DEG),
    ]
    if goals.angle is not None:
        cosine = constant_angle(web, goals.angle).residuals + math.cos(goals.angle)
        error = np.abs(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)) - goals.angle)).max()
        limits.append(("angle error in degrees", float(error), ANGLE_DEG))
    if goals.bottom_row is not None:
        lift = float(np.abs(v[row, :, 2]).max()) / edge
        limits.append(("height of the bottom curve per edge", lift, BOTTOM_PER_EDGE))
    sizes = [
        ("height", goals.height, float(v[-1, middle, 2] - v[row, middle, 2])),
        ("span", goals.span, float(np.linalg.norm(v[row, -1] - v[row, 0]))),
    ]
    limits += [(f"{name} off by", abs(found / wish - 1.0), SIZE) for name, wish, found in sizes if wish is not None]
    misses = [float(np.linalg.norm(v[p.row, p.column] - p.point)) / edge for p in goals.points]
    if misses:
        limits.append(("distance of held points per edge", max(misses), SIZE))
    if goals.min_radius is not None:
        limits.append(
            (
                "curvature over that of the smallest radius",
                goals.min_radius * float(largest_bending(web).max()),
                1.0 + SIZE,
            )
        )
    if goals.max_twist is not None:
        limits.append(("twist over the largest", float(largest_twist(web).max()) / goals.max_twist, 1.0 + SIZE))
    return limits


def _verdict(web: Web, before: WebQuality, after: WebQuality, goals: Goals) -> tuple[Reason, str]:
    """Return why the optimiser stopped, and the measures that say so."""
    if after.normal_turning_deg < before.normal_turning_deg / 5.0:
        return "collapsed", (
            f"the normals turn by {after.normal_turning_deg:.1f} degrees, at the start by "
            f"{before.normal_turning_deg:.1f}: the web has become flat"
        )
    if not _in_range(web.vertices, before):
        found, asked = (" x ".join(f"{size:.0f}" for size in q.extent) for q in (after, before))
        return "left the design's range", f"the web measures {found} mm, at the start {asked} mm; goals may conflict"
    limits = _limits(web, goals)
    missed = [f"{name} {found:.1e}, allowed {allowed:.0e}" for name, found, allowed in limits if not found <= allowed]
    if missed:
        return "stalled", "; ".join(missed)
    return "converged", "; ".join(f"{name} {found:.1e}" for name, found, _ in limits)


def _in_range(vertices: Floats, before: WebQuality) -> bool:
    """Return whether the extent in every direction is between half and double that of the start."""
    extent = np.ptp(vertices.reshape(-1, 3), axis=0)
    return all(0.5 * b < a < 2.0 * b for a, b in zip(extent, before.extent, strict=True) if b > 0.0)


def optimise(
    web: Web, goals: Goals, report: Report = lambda iteration: None, method: Method | None = None
) -> Optimised:
    """Return the web that satisfies the goals, or the nearest that was reached with the reason (paper section 2.2).

    The vertices (rows, columns, 3) are in mm, with ghost rows under ``goals.bottom_row`` if there is one; symmetric
    webs are mirrored about their middle column. A web that satisfies its goals already comes back as it is.
    DesignError if the web is too small or the goals do not fit it.
    """
    rows, columns, _ = web.vertices.shape
    if rows < 8 or columns < 8:
        raise DesignError(f"optimise: a web of {rows} x {columns} vertices; at least 8 x 8 are needed")
    if goals.bottom_row is not None and not 1 <= goals.bottom_row <= rows - 8:
        raise DesignError(
            f"optimise.bottom_row: {goals.bottom_row}; allowed 1 to {rows - 8}: one ghost row under it at least"
        )
    chosen, before = method or Method(factorisation=best_factorisation()), quality(web)
    done: list[Iteration] = []
    found = web
    if any(not value <= allowed for _, value, allowed in _limits(web, goals)):
        smooth = _spline_stage(web.vertices, goals, chosen, done, report)
        found = Web(smooth)
        if np.all(np.isfinite(smooth)) and _in_range(smooth, before):
            found = Web(_mesh_stage(smooth, web.vertices, goals, chosen, done, report))
    if not np.all(np.isfinite(found.vertices)):
        return Optimised(web, "collapsed", "a step of the optimiser was not finite", tuple(done), web.vertices)
    reason, explanation = _verdict(found, before, quality(found), goals)
    return Optimised(found, reason, explanation, tuple(done), web.vertices)
