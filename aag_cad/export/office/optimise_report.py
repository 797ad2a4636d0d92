"""The report of an optimised web as one HTML file that needs no other: verdict, goals, quality, history and maps."""

import math
import os
from collections.abc import Callable

import numpy as np

from aag_cad.export.office.web_pictures import NOISE, Map, energy_chart, web_map
from aag_cad.files import write_text
from aag_cad.pages import html_page
from aag_cad.units import MM_PER_M, Floats, deg_per_m
from aag_cad.web.energies import constant_angle, symmetry
from aag_cad.web.goals import Goals, Optimised
from aag_cad.web.line_curvatures import LINES, geodesic_curvature, largest_bending, largest_twist, normal_curvature
from aag_cad.web.quality import WebQuality, quality
from aag_cad.web.web import Web

_NONE = "\N{EN DASH}"


def _number(value: float) -> str:
    """Return a figure as text: to 3 decimals or fewer, or as a power of ten; one without a bound is a dash."""
    if not math.isfinite(value):
        return _NONE
    if value == 0.0 or 1e-3 <= abs(value) < 1e5:
        return f"{value:.3f}" if abs(value) < 10.0 else f"{value:.2f}" if abs(value) < 1000.0 else f"{value:.0f}"
    return f"{value:.1e}"


def _radius(curvature: float) -> float:
    """Return the radius in m of a curvature in 1/m, without a bound where the line is straight."""
    return 1.0 / curvature if curvature > NOISE else math.inf


def _quality_rows(before: WebQuality, after: WebQuality) -> list[tuple[str, ...]]:
    def both(name: str, value: Callable[[WebQuality], str]) -> tuple[str, ...]:
        return name, value(before), value(after)

    return [
        both("Vertices", lambda q: str(q.vertices)),
        both("Planarity of the A stars, per edge, largest", lambda q: _number(q.planarity_per_edge)),
        both("Turn of a G line in the tangent plane, largest, deg", lambda q: _number(q.geodesic_deviation_deg)),
        both("Acute angle A to A, smallest, deg", lambda q: _number(q.angle_aa_deg.min)),
        both("Acute angle A to A, largest, deg", lambda q: _number(q.angle_aa_deg.max)),
        both("Acute angle A to G, smallest, deg", lambda q: _number(q.angle_ag_deg.min)),
        both("Acute angle A to G, largest, deg", lambda q: _number(q.angle_ag_deg.max)),
        both("Checkerboard, per edge, largest", lambda q: _number(q.parity_per_edge)),
        both("Turning of the normals along G, largest, deg", lambda q: _number(q.normal_turning_deg)),
        both("Extent x, m", lambda q: _number(q.extent[0] / MM_PER_M)),
        both("Extent y, m", lambda q: _number(q.extent[1] / MM_PER_M)),
        both("Extent z, m", lambda q: _number(q.extent[2] / MM_PER_M)),
        both("Radius of A lines, smallest, m", lambda q: _number(q.smallest_radius_a / MM_PER_M)),
        both("Radius of G lines, smallest, m", lambda q: _number(q.smallest_radius_g / MM_PER_M)),
        both("Twist, largest, deg/m", lambda q: _number(q.largest_twist_deg_per_m)),
    ]


def _angle_deg(web: Web) -> Floats:
    """Return the angle between the A lines upwards at the inner vertices, (rows - 2, columns - 2) degrees."""
    cosine = np.clip(constant_angle(web, math.pi / 2.0).residuals, -1.0, 1.0)
    return np.degrees(np.arccos(cosine)).reshape(web.vertices.shape[0] - 2, web.vertices.shape[1] - 2)


def _goal_rows(web: Web, start: Web, goals: Goals) -> list[tuple[str, ...]]:
    """Return each wish with what was asked for and what was reached."""
    v, row, middle = web.vertices, goals.bottom_row or 0, web.vertices.shape[1] // 2
    rows: list[tuple[str, ...]] = []
    if goals.angle is not None:
        angle = _angle_deg(web)
        reached = f"{_number(float(angle.min()))} to {_number(float(angle.max()))}"
        rows.append(("Angle between the A lines, deg", _number(math.degrees(goals.angle)), reached))
    if goals.bottom_row is not None:
        lift = float(np.abs(v[row, :, 2]).max())
        rows.append((f"Bottom curve, row {row}: largest |z|, mm", _number(0.0), _number(lift)))
    if goals.height is not None:
        rows.append(("Height, mm", _number(goals.height), _number(float(v[-1, middle, 2] - v[row, middle, 2]))))
    if goals.span is not None:
        rows.append(("Span, mm", _number(goals.span), _number(float(np.linalg.norm(v[row, -1] - v[row, 0])))))
    for goal in goals.points:
        off = float(np.linalg.norm(v[goal.row, goal.column] - np.array(goal.point)))
        rows.append((f"Vertex {goal.row}, {goal.column}: distance from its point, mm", _number(0.0), _number(off)))
    if goals.closeness > 0.0:
        off = float(np.linalg.norm(v - start.vertices, axis=-1).max())
        rows.append((f"Close to the start (weight {goals.closeness:g}): largest move, mm", _NONE, _number(off)))
    if goals.min_radius is not None:
        reached = _number(_radius(float(largest_bending(web).max()) * MM_PER_M) * MM_PER_M)
        rows.append(("Smallest bending radius, mm, at least", _number(goals.min_radius), reached))
    if goals.max_twist is not None:
        reached = _number(deg_per_m(float(largest_twist(web).max())))
        rows.append(("Largest twist, deg/m, at most", _number(deg_per_m(goals.max_twist)), reached))
    if goals.symmetric:
        off = float(np.abs(symmetry(web).residuals).max())
        rows.append(("Mirror symmetry: largest difference, mm", _number(0.0), _number(off)))
    return rows


def _maps(web: Web, goals: Goals) -> list[Map]:
    shape = (web.vertices.shape[0] - 2, web.vertices.shape[1] - 2)
    per_m, angle = MM_PER_M, _angle_deg(web)
    on_a = [np.abs(normal_curvature(web, line).residuals) for line in LINES[:2]]
    asked = float(angle.mean()) if goals.angle is None else math.degrees(goals.angle)
    named = f"from the mean, {asked:.2f} deg" if goals.angle is None else f"from {asked:.2f} deg"
    return [
        Map(
            "Normal curvature of A lines, 1/m",
            "|kappa_n|, larger of both families; zero on asymptotic lines",
            np.maximum(*on_a).reshape(shape) * per_m,
            _number,
        ),
        Map(
            "Geodesic curvature of G lines, 1/m",
            "|kappa_g|; zero on geodesics",
            np.abs(geodesic_curvature(web, "G").residuals).reshape(shape) * per_m,
            _number,
        ),
        Map(
            "Twist, deg/m",
            "|tau_g|, largest of A and G planks at the vertex",
            np.degrees(largest_twist(web)) * per_m,
            _number,
        ),
        Map(
            "Bending radius, m",
            "smallest of A (on edge) and G (flat); dark is tight",
            largest_bending(web) * per_m,
            lambda curvature: _number(_radius(curvature)),
        ),
        Map("Angle error, deg", f"angle between the A lines, {named}", np.abs(angle - asked), _number),
    ]


def report_html(optimised: Optimised, goals: Goals) -> str:
    """Return the report of an optimised web as HTML, the same text for the same web and history."""
    web, start, steps = optimised.web, Web(optimised.start), optimised.iterations
    fields = _maps(web, goals)
    maps = [
        {
            "title": field.title,
            "note": field.note,
            "worst": field.label(float(field.values.max())),
            "row": field.worst[0],
            "column": field.worst[1],
        }
        for field in fields
    ]
    data = {
        "success": optimised.success,
        "reason": optimised.reason,
        "explanation": optimised.explanation,
        "iterations": len(steps),
        "moved": _number(steps[-1].step) if steps else "",
        "goals": _goal_rows(web, start, goals),
        "quality": _quality_rows(quality(start), quality(web)),
        "maps": maps,
    }
    pictures = {field.title: web_map(field, web, goals.bottom_row) for field in fields}
    return html_page("optimise", data, pictures | {"chart": energy_chart(steps)})


def write_report(optimised: Optimised, goals: Goals, path: str | os.PathLike[str]) -> None:
    """Write the report as one HTML file; FileError if it cannot be written."""
    write_text(path, report_html(optimised, goals))
