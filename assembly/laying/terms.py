"""Residuals of a net that is laid flat, with sparse Jacobians: stretch, bending, turn of nodes, straight rays.

The unknowns are the coordinates x, y of point 0, then 1, ...; then the angle and offset of the line of each ray.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, vstack

from aag_cad.units import Floats, Ints
from assembly.laying.net import Net


@dataclass(frozen=True)
class Stiffness:
    """What a change costs: of length (N), of curvature (N mm2), of a node's angle (N mm), of a crossing off its line.

    The last (N/mm) is the spring by which a crossing is held to the straight line of its geodesic.
    """

    axial: float
    bending: float
    turning: float
    sideways: float


@dataclass(frozen=True, eq=False)
class Residuals:
    """Residuals (m,), square roots of energies in N mm times two, with their Jacobian (m, unknowns)."""

    values: Floats
    jacobian: csr_array


@dataclass(frozen=True, eq=False)
class Arrays:
    """A net as arrays: indices and rest values of chords, bends, scissors and crossings; a pivot of each ray."""

    points: int
    chords: Ints
    lengths: Floats
    bends: Ints
    turns: Floats
    spacing: Floats
    scissors: Ints
    angles: Floats
    crossings: Ints
    rays: Ints
    pivots: Floats


def net_arrays(net: Net) -> Arrays:
    """Return a net as arrays; a ray of fewer than two crossings takes no part."""
    chains = net.chains
    used = [ray for ray in net.rays if len(ray.points) > 1]
    pivots = [net.start[ray.points].mean(axis=0) for ray in used]
    return Arrays(
        points=len(net.start),
        chords=np.concatenate([np.column_stack([c.points[:-1], c.points[1:]]) for c in chains]),
        lengths=np.concatenate([c.chords for c in chains]),
        bends=np.concatenate([np.column_stack([c.points[:-2], c.points[1:-1], c.points[2:]]) for c in chains]),
        turns=np.concatenate([c.turns for c in chains]),
        spacing=np.concatenate([(c.chords[:-1] + c.chords[1:]) / 2.0 for c in chains]),
        scissors=np.array([(*s.lower, *s.upper) for s in net.scissors], dtype=np.int64).reshape(-1, 4),
        angles=np.array([s.chords for s in net.scissors]),
        crossings=np.concatenate([np.zeros(0, dtype=np.int64), *(ray.points for ray in used)]),
        rays=np.repeat(np.arange(len(used)), np.array([len(ray.points) for ray in used], dtype=np.int64)),
        pivots=np.array(pivots).reshape(-1, 2),
    )


def started(net: Net) -> Floats:
    """Return the unknowns to begin with: the points of the net and the best line through each ray's crossings."""
    lines = []
    for ray in net.rays:
        if len(ray.points) > 1:
            away = net.start[ray.points] - net.start[ray.points].mean(axis=0)
            angle = 0.5 * np.arctan2(2.0 * (away[:, 0] @ away[:, 1]), away[:, 0] @ away[:, 0] - away[:, 1] @ away[:, 1])
            lines += [float(angle), 0.0]
    return np.concatenate([net.start.ravel(), lines])


def _rows(values: Floats, parts: Sequence[tuple[Ints, Floats]], unknowns: int) -> Residuals:
    """Return residuals from pairs of first unknown (m,) and gradient by it and the next ones (m, k)."""
    count = len(values)
    rows = np.concatenate([np.repeat(np.arange(count), grad.shape[1]) for _, grad in parts])
    columns = np.concatenate([(first[:, None] + np.arange(grad.shape[1])).ravel() for first, grad in parts])
    entries = np.concatenate([grad.ravel() for _, grad in parts])
    return Residuals(values, csr_array((entries, (rows, columns)), shape=(count, unknowns)))


def _heading(start: Floats, end: Floats) -> tuple[Floats, Floats]:
    """Return the angles (m,) of the lines from start to end (m, 2), and their gradients (m, 2) by the end."""
    way = end - start
    square = (way**2).sum(axis=1)[:, None]
    return np.arctan2(way[:, 1], way[:, 0]), np.column_stack([-way[:, 1], way[:, 0]]) / square


def _wrapped(angle: Floats) -> Floats:
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


def stretch(arrays: Arrays, unknowns: Floats) -> Residuals:
    """Return how much longer than their lengths the chords are, (m,) mm."""
    at = unknowns[: 2 * arrays.points].reshape(-1, 2)
    a, b = arrays.chords.T
    way = at[b] - at[a]
    length = np.linalg.norm(way, axis=1)
    along = way / length[:, None]
    return _rows(length - arrays.lengths, [(2 * a, -along), (2 * b, along)], len(unknowns))


def bending(arrays: Arrays, unknowns: Floats) -> Residuals:
    """Return how much more the beams turn at their points than they were made to, (m,) radians."""
    at = unknowns[: 2 * arrays.points].reshape(-1, 2)
    a, b, c = arrays.bends.T
    before, by_b = _heading(at[a], at[b])
    after, by_c = _heading(at[b], at[c])
    values = _wrapped(after - before - arrays.turns)
    return _rows(values, [(2 * a, by_b), (2 * b, -by_b - by_c), (2 * c, by_c)], len(unknowns))


def turning(arrays: Arrays, unknowns: Floats) -> Residuals:
    """Return how much wider the nodes' angles from lower to upper beam are than in the shell, (m,) radians."""
    at = unknowns[: 2 * arrays.points].reshape(-1, 2)
    a, b, c, d = arrays.scissors.T
    lower, by_b = _heading(at[a], at[b])
    upper, by_d = _heading(at[c], at[d])
    values = _wrapped(upper - lower - arrays.angles)
    return _rows(values, [(2 * a, by_b), (2 * b, -by_b), (2 * c, -by_d), (2 * d, by_d)], len(unknowns))


def sideways(arrays: Arrays, unknowns: Floats) -> Residuals:
    """Return how far to the left of the line of its geodesic each crossing is, (m,) mm."""
    at, lines = unknowns[: 2 * arrays.points].reshape(-1, 2), unknowns[2 * arrays.points :].reshape(-1, 2)
    angle, offset = lines[arrays.rays].T
    away = at[arrays.crossings] - arrays.pivots[arrays.rays]
    left = np.column_stack([-np.sin(angle), np.cos(angle)])
    ahead = np.column_stack([np.cos(angle), np.sin(angle)])
    by_line = np.column_stack([-(away * ahead).sum(axis=1), -np.ones(len(angle))])
    first = 2 * arrays.points + 2 * arrays.rays
    values = (away * left).sum(axis=1) - offset
    return _rows(values, [(2 * arrays.crossings, left), (first, by_line)], len(unknowns))


def residuals(arrays: Arrays, stiffness: Stiffness, unknowns: Floats) -> Residuals:
    """Return all residuals; half their sum of squares is the energy in N mm."""
    terms = (
        (stretch(arrays, unknowns), np.sqrt(stiffness.axial / arrays.lengths)),
        (bending(arrays, unknowns), np.sqrt(stiffness.bending / arrays.spacing)),
        (turning(arrays, unknowns), np.full(len(arrays.angles), np.sqrt(stiffness.turning))),
        (sideways(arrays, unknowns), np.full(len(arrays.crossings), np.sqrt(stiffness.sideways))),
    )
    return Residuals(
        np.concatenate([term.values * weight for term, weight in terms]),
        csr_array(vstack([term.jacobian.multiply(weight[:, None]) for term, weight in terms], format="csr")),
    )
