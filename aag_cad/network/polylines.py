"""A network brought as polylines with normals (JSON), and a network written so: curves that another program optimised.

The text is ``{"schema": 1, "unit": "mm", "families": {"A1": [...], "A2": [...], "G": [...], "E": [...]}}``; E, the edge
planks, may be left out. A polyline is ``{"points": [[x, y, z], ...], "normals": [[x, y, z], ...]}``, with the stations
``start`` and ``end`` (mm) between which its plank lies, if that is not all of it. Polylines are numbered from 1 as they
stand; normals point outside, and G curves rise from the ground.
"""

import json
import math
from collections.abc import Iterator
from itertools import combinations
from typing import Any

import numpy as np
from scipy.interpolate import make_interp_spline

from aag_cad.errors import FileError, NetworkError
from aag_cad.families import BEAMS, EDGES, FAMILIES, Family
from aag_cad.files import json_object
from aag_cad.geometry.framed import FramedCurve, framed_curve, frames_at
from aag_cad.geometry.surface import dot, unit
from aag_cad.network.model import Crossing, CrossingKind, CurveId, CurveNetwork, NetworkCurve
from aag_cad.units import Floats, vector

SCHEMA_VERSION = 1
_SHORTEST = 100.0
_LARGEST_COORDINATE = 1e6
_MOST_POLYLINES, _MOST_POINTS = 500, 5000
_SHARPEST_KINK = math.radians(30.0)
_NORMAL_LEAN = math.radians(15.0)
_SAME_SIDE = math.radians(30.0)
_TOLERANCE, _PASS_BY = 5.0, 100.0
_END_SLACK = 1.0
_FLATTEST_SINE = 0.02


def polylines_json(network: CurveNetwork) -> str:
    """Return the curves of a network as JSON: their samples every 150 mm with normals, and where their planks lie."""
    families: dict[str, list[dict[str, Any]]] = {family: [] for family in FAMILIES}
    for item in sorted(network.curves, key=lambda item: item.id):
        families[item.id.family].append(
            {
                "start": item.start,
                "end": item.end,
                "points": item.curve.points.tolist(),
                "normals": item.curve.normals.tolist(),
            }
        )
    whole = {"schema": SCHEMA_VERSION, "unit": "mm", "families": families}
    return json.dumps(whole, allow_nan=False, separators=(",", ":")).replace('{"start"', '\n{"start"') + "\n"


def read_polylines(text: str, source: str) -> CurveNetwork:
    """Return the network of a JSON text; ``source`` names the file in errors.

    Curves are splines through the points; two of them cross where they come within 5 mm. FileError with the family, the
    polyline and what is wrong; NetworkError where the curves do not make one network.
    """
    items: list[NetworkCurve] = []
    for family, polylines in _families(text, source).items():
        for number, data in enumerate(polylines, start=1):
            items.append(_network_curve(CurveId(family, number), data, f"{source}: {family} polyline {number}"))
    crossings = _crossings(items, source)
    joined = {curve for crossing in crossings for curve in crossing.curves}
    for item in items:
        if item.id not in joined:
            raise NetworkError(
                f"{source}: {_name(item.id)} comes within {_TOLERANCE:g} mm of no curve of another family; leave it "
                "out or lengthen it to reach its neighbours"
            )
    return CurveNetwork(tuple(sorted(items, key=lambda item: item.id)), tuple(crossings))


def _name(curve: CurveId) -> str:
    return f"{curve.family} polyline {curve.number}"


def _families(text: str, source: str) -> dict[Family, list[Any]]:
    data = json_object(text, source)
    if not isinstance(data.get("families"), dict):
        raise FileError(f'{source}: expected an object with "schema", "unit" and "families"')
    if data.get("schema") != SCHEMA_VERSION:
        raise FileError(f"{source}: schema {data.get('schema')!r}, this program reads {SCHEMA_VERSION}")
    if data.get("unit") != "mm":
        raise FileError(f'{source}: unit {data.get("unit")!r}; scale the polylines to mm and say "unit": "mm"')
    families = data["families"]
    unknown = sorted(set(families) - set(FAMILIES))
    if unknown:
        raise FileError(f"{source}: no family called {', '.join(unknown)}; there are {', '.join(FAMILIES)}")
    for family in FAMILIES:
        polylines = families.get(family, [] if family in EDGES else None)
        if not isinstance(polylines, list) or (not polylines and family not in EDGES):
            raise FileError(f"{source}: family {family} has no polylines; A1, A2 and G need one at least")
        if len(polylines) > _MOST_POLYLINES:
            raise FileError(
                f"{source}: family {family} has {len(polylines)} polylines, at most {_MOST_POLYLINES} are read"
            )
    return {family: families.get(family, []) for family in FAMILIES}


def _vectors(data: object, where: str) -> Floats:
    """Return a list of vectors (n, 3)."""
    if not isinstance(data, list) or len(data) > _MOST_POINTS:
        raise FileError(f"{where}: expected a list of [x, y, z], at most {_MOST_POINTS}")
    for number, row in enumerate(data, start=1):
        if not isinstance(row, list) or len(row) != 3 or any(type(x) not in (int, float) for x in row):
            raise FileError(f"{where} {number}: expected three numbers [x, y, z], found {str(row)[:60]}")
        if not all(abs(x) <= _LARGEST_COORDINATE for x in row):
            raise FileError(f"{where} {number}: {row} is not finite or more than {_LARGEST_COORDINATE / 1e3:g} m away")
    return np.array(data, dtype=np.float64).reshape(-1, 3)


def _angles(a: Floats, b: Floats) -> Floats:
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), dot(a, b)))


def _checked_polyline(data: object, where: str) -> tuple[Floats, Floats, Floats]:
    """Return points (n, 3), unit normals (n, 3) and the chord lengths (n,) up to each point."""
    if not isinstance(data, dict) or not {"points", "normals"} <= set(data) <= {"points", "normals", "start", "end"}:
        raise FileError(f'{where}: expected an object with "points" and "normals", and "start" and "end" if wanted')
    points, normals = _vectors(data["points"], f"{where}, point"), _vectors(data["normals"], f"{where}, normal")
    if len(points) < 2 or len(points) != len(normals):
        raise FileError(f"{where}: {len(points)} points and {len(normals)} normals; it needs two or more, one each")
    edges = np.diff(points, axis=0)
    lengths = np.linalg.norm(edges, axis=1)
    if np.any(lengths < 1e-3):
        raise FileError(f"{where}: points {np.argmin(lengths) + 1} and {np.argmin(lengths) + 2} are one; remove one")
    if lengths.sum() < _SHORTEST:
        raise FileError(f"{where}: it is {lengths.sum():.3g} mm long; scale it to mm, or leave it out")
    kinks = _angles(edges[:-1], edges[1:])
    if kinks.size and kinks.max() > _SHARPEST_KINK:
        raise FileError(
            f"{where}: it kinks by {math.degrees(kinks.max()):.0f} degrees at point {np.argmax(kinks) + 2}, at most "
            f"{math.degrees(_SHARPEST_KINK):.0f} are a smooth curve; smooth it or use more points"
        )
    sizes = np.linalg.norm(normals, axis=1)
    if sizes.min() < 1e-9:
        raise FileError(f"{where}: normal {np.argmin(sizes) + 1} has no length")
    normals = unit(normals)
    turned = np.flatnonzero(dot(normals[:-1], normals[1:]) <= 0.0)
    if turned.size:
        raise FileError(f"{where}: normal {turned[0] + 2} points to the other side than the one before; flip it")
    tangents = unit(np.gradient(points, np.concatenate([[0.0], np.cumsum(lengths)]), axis=0))
    leans = np.abs(np.arcsin(np.clip(dot(tangents, normals), -1.0, 1.0)))
    if leans.max() > _NORMAL_LEAN:
        raise FileError(
            f"{where}: normal {np.argmax(leans) + 1} leans {math.degrees(leans.max()):.0f} degrees along the curve, at "
            f"most {math.degrees(_NORMAL_LEAN):.0f}; give the normal of the surface"
        )
    return points, normals, np.concatenate([[0.0], np.cumsum(lengths)])


def _network_curve(name: CurveId, data: Any, where: str) -> NetworkCurve:
    points, normals, chord = _checked_polyline(data, where)
    degree = min(5, len(points) - 1)
    place, side = make_interp_spline(chord, points, k=degree), make_interp_spline(chord, normals, k=degree)
    curve = framed_curve(lambda t: (place(t), unit(side(t))), 0.0, float(chord[-1]), float(chord[-1]))
    if curve.length > 1.1 * chord[-1]:
        raise FileError(
            f"{where}: the smooth curve through it is {curve.length:.0f} mm long, the polyline {chord[-1]:.0f}: "
            "its points zigzag or are spaced too unevenly: smooth it"
        )
    start, end = data.get("start", 0.0), data.get("end", curve.length)
    if any(type(x) not in (int, float) for x in (start, end)) or not (
        -_END_SLACK <= start < end <= curve.length + _END_SLACK
    ):
        raise FileError(
            f"{where}: start {start!r} and end {end!r} must rise and lie on its length, 0 to {curve.length:.1f} mm"
        )
    return NetworkCurve(name, curve, max(0.0, float(start)), min(curve.length, float(end)))


def _kind(a: CurveId, b: CurveId) -> CrossingKind | None:
    """Return what a crossing of two curves is; None for curves of one family, whose planks lie in one layer."""
    families = {a.family, b.family}
    if families <= set(EDGES):
        return "ridge" if min(a.number, b.number) > 1 else None
    if len(families) == 1:
        return None
    if families <= set(BEAMS):
        return "AA"
    edge = next((curve for curve in (a, b) if curve.family in EDGES), None)
    if edge and not families & set(BEAMS):
        return "foot" if edge.number == 1 else "ridge"
    return "boundary" if edge else "AG"


def _candidates(a: FramedCurve, b: FramedCurve) -> Floats:
    """Return stations (n, 2) near which the curves come closest, from the segments between their samples."""
    p, q = a.points[:-1, None], b.points[None, :-1]
    d, e = np.diff(a.points, axis=0)[:, None], np.diff(b.points, axis=0)[None]
    dd, ee, de = (d * d).sum(-1), (e * e).sum(-1), (d * e).sum(-1)
    gap = q - p
    gd, ge = (gap * d).sum(-1), (gap * e).sum(-1)
    determinant = dd * ee - de**2
    flat = determinant < _FLATTEST_SINE**2 * dd * ee
    determinant = np.where(flat, 1.0, determinant)
    s, t = (gd * ee - ge * de) / determinant, (gd * de - ge * dd) / determinant
    near = (np.abs(s - 0.5) < 1.0) & (np.abs(t - 0.5) < 1.0) & ~flat
    near &= np.linalg.norm(p + s[..., None] * d - q - t[..., None] * e, axis=-1) < 2.0 * _PASS_BY
    i, j = np.nonzero(near)
    step_a, step_b = a.stations[1], b.stations[1]
    return np.column_stack([(i + s[i, j]) * step_a, (j + t[i, j]) * step_b])


def _closest(a: FramedCurve, b: FramedCurve) -> Iterator[tuple[float, float]]:
    """Yield the stations of the closest approaches of two curves, each once, by Gauss-Newton from the candidates."""
    found: list[Floats] = []
    lengths = np.array([a.length, b.length])
    for start in _candidates(a, b):
        at = start
        for _ in range(20):
            gap = a.point_spline(at[0]) - b.point_spline(at[1])
            slopes = np.column_stack([a.point_spline(at[0], nu=1), -b.point_spline(at[1], nu=1)])
            step = np.linalg.lstsq(slopes, gap, rcond=None)[0]
            # Far beyond the ends a spline means nothing, and may overflow.
            at = np.clip(at - step, -_PASS_BY, lengths + _PASS_BY)
            if np.abs(step).max() < 1e-9:
                break
        inside = all(-_END_SLACK <= x <= curve.length + _END_SLACK for x, curve in zip(at, (a, b), strict=True))
        if inside and all(np.abs(at - other).max() > 1.0 for other in found):
            found.append(at)
            yield float(np.clip(at[0], 0.0, a.length)), float(np.clip(at[1], 0.0, b.length))


def _crossings(items: list[NetworkCurve], source: str) -> list[Crossing]:
    """Return all crossings in space, sorted by kind and place.

    G curves go on to the edge planks that cut them off; everywhere else a crossing counts where both planks lie.
    """
    crossings = []
    for a, b in combinations(sorted(items, key=lambda item: (list(FAMILIES).index(item.id.family), item.id.number)), 2):
        kind = _kind(a.id, b.id)
        for stations in _closest(a.curve, b.curve):
            on_planks = all(
                item.start - _END_SLACK <= s <= item.end + _END_SLACK for item, s in zip((a, b), stations, strict=True)
            )
            if on_planks or kind in ("foot", "ridge"):
                crossings += _crossing(kind, a, b, stations, source)
    return sorted(crossings, key=lambda c: (c.kind, c.curves, c.stations))


def _crossing(
    kind: CrossingKind | None, a: NetworkCurve, b: NetworkCurve, stations: tuple[float, float], source: str
) -> list[Crossing]:
    """Return the crossing at a closest approach, or none where the curves pass far from each other."""
    first, second = (frames_at(item.curve, np.array([s])) for item, s in zip((a, b), stations, strict=True))
    gap = float(np.linalg.norm(first.point - second.point))
    pair = f"{source}: {_name(a.id)} and {_name(b.id)}"
    if gap > _PASS_BY or (kind is None and a.id.family in EDGES):
        return []
    where = "({:.0f}, {:.0f}, {:.0f})".format(*first.point[0])
    if kind is None:
        raise NetworkError(f"{pair} cross near {where}; curves of one family never do: sort them into A1, A2 and G")
    if gap > _TOLERANCE:
        raise NetworkError(
            f"{pair} pass each other at {gap:.1f} mm near {where}, at most {_TOLERANCE:g} mm are a crossing; pull the "
            "curves onto one surface"
        )
    turn = float(_angles(first.normal, second.normal)[0])
    if turn > _SAME_SIDE:
        raise NetworkError(
            f"{pair}: their normals differ by {math.degrees(turn):.0f} degrees at their crossing {where}; give both "
            "the outward normal of the surface"
        )
    middle = (first.point[0] + second.point[0]) / 2.0
    normal = unit(first.normal + second.normal)[0]
    return [Crossing(kind, (a.id, b.id), stations, vector(middle), vector(normal))]
