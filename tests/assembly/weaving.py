"""Weaves to test with, random and drawn, and what can be said of them by other means than the planner's."""

import math
from dataclasses import dataclass
from itertools import combinations, pairwise

import networkx as nx
import numpy as np
from hypothesis import strategies as st

Point = tuple[float, float]
Graph = nx.MultiGraph


@dataclass(frozen=True)
class Member:
    """A unit of a random weave: one plank, or two siblings 36 mm apart."""

    mark: str
    start: Point
    end: Point
    upright: bool
    coupled: bool
    radius: float

    @property
    def depth(self) -> float:
        """Its size along the surface normal, mm."""
        return 100.0 if self.upright else 12.0

    @property
    def length(self) -> float:
        """Its length, mm."""
        return math.dist(self.start, self.end)


@dataclass(frozen=True)
class Weave:
    """Members and for each crossing the lower, the upper, and how far along them it lies."""

    members: tuple[Member, ...]
    crossings: tuple[tuple[str, str, float, float], ...]

    def of(self, mark: str) -> Member:
        """Return the member of a mark."""
        return next(member for member in self.members if member.mark == mark)


def met(a: tuple[Point, Point], b: tuple[Point, Point]) -> tuple[float, float] | None:
    """Cramer's rule: the shares of two lines at which they cross, or None if they are parallel."""
    (ax, ay), (bx, by) = (np.subtract(line[1], line[0]) for line in (a, b))
    gx, gy = np.subtract(b[0], a[0])
    turn = ax * by - ay * bx
    if abs(turn) < 1e-6 * math.hypot(ax, ay) * math.hypot(bx, by):
        return None
    return float((gx * by - gy * bx) / turn), float((gx * ay - gy * ax) / turn)


@st.composite
def weaves(draw: st.DrawFn, most: int = 9) -> Weave:
    place = st.integers(0, 40).map(lambda i: 100.0 * i)
    anywhere = st.tuples(st.tuples(place, place), st.tuples(place, place))
    # From side to side of the floor, so that most lines cross.
    across = st.tuples(place, place).map(lambda y: ((0.0, y[0]), (4000.0, y[1])))
    along = st.tuples(place, place).map(lambda x: ((x[0], 0.0), (x[1], 4000.0)))
    members = []
    for i, line in enumerate(draw(st.lists(st.one_of(across, along, anywhere), min_size=3, max_size=most))):
        start, end = line
        if math.dist(start, end) > 500.0:
            upright = draw(st.sampled_from([False, False, True]))
            kind = (upright, upright and draw(st.booleans()), draw(st.sampled_from([100.0, 900.0, 4000.0])))
            # Odd shifts keep lines from meeting in their ends, where touching is a matter of rounding.
            shift = 7.0 * i + 3.0
            moved = [(x + shift, y - 0.7 * shift) for x, y in (start, end)]
            members.append(Member(f"U{i}", moved[0], moved[1], *kind))
    crossings = []
    for a, b in combinations(members, 2):
        shares = met((a.start, a.end), (b.start, b.end))
        if shares and all(0.02 < share < 0.98 for share in shares):
            at = ((a, shares[0]), (b, shares[1]))
            (low, x), (high, y) = at if draw(st.booleans()) else at[::-1]
            crossings.append((low.mark, high.mark, x * low.length, y * high.length))
    return Weave(tuple(members), tuple(crossings))


def planks_of(member: Member) -> dict[str, float]:
    """Return the planks of a member and how far each lies left of its line, mm."""
    return {f"{member.mark}-L": 18.0, f"{member.mark}-R": -18.0} if member.coupled else {member.mark: 0.0}


def graph_of(weave: Weave) -> "Graph[str]":
    graph: Graph[str] = Graph(name="weave")
    for member in weave.members:
        across = np.array([member.start[1] - member.end[1], member.end[0] - member.start[0]]) / member.length
        for plank, aside in planks_of(member).items():
            start, end = ((*np.add(point, aside * across).tolist(), 0.0) for point in (member.start, member.end))
            graph.add_node(
                plank, kind="plank", mass_kg=1.0, length_mm=member.length, start=start, end=end, upright=member.upright,
                depth_mm=member.depth, min_radius_mm=member.radius, beam=member.mark if member.coupled else "",
            )  # fmt: skip
    for i, (low, high, x, y) in enumerate(weave.crossings):
        for a in planks_of(weave.of(low)):
            for b in planks_of(weave.of(high)):
                graph.add_edge(a, b, key=f"J{i}", kind="crossing", joint=f"J{i}", above=b, below_mm=x, above_mm=y)
    return graph


def radius_of(weave: Weave, mark: str) -> float:
    """The smallest radius of a member: two equal arcs wherever it changes sides, the others lie in one level."""
    places = sorted(
        (x if mark == low else y, mark == high, weave.of(high if mark == low else low).depth)
        for low, high, x, y in weave.crossings
        if mark in (low, high)
    )
    own = weave.of(mark).depth
    radii = [
        (y - x) ** 2 / (4.0 * (one / 2.0 + own + other / 2.0))
        for (x, over, one), (y, next_over, other) in pairwise(places)
        if over != next_over
    ]
    return min(radii, default=math.inf)


def free_beyond(weave: Weave, mark: str) -> dict[str, float]:
    """The way to the nearest line beyond each end of a member, those that it crosses at a joint left aside."""
    member = weave.of(mark)
    partners = {end for low, high, _, _ in weave.crossings if mark in (low, high) for end in (low, high)}
    free = {"start": math.inf, "end": math.inf}
    for other in weave.members:
        if other.mark in partners | {mark}:
            continue
        shares = met((member.start, member.end), (other.start, other.end))
        if shares is None:
            continue
        if -1.0 / other.length <= shares[1] <= 1.0 + 1.0 / other.length:
            if shares[0] <= 0.0:
                free["start"] = min(free["start"], -shares[0] * member.length)
            if shares[0] >= 1.0:
                free["end"] = min(free["end"], (shares[0] - 1.0) * member.length)
    return free


def can_slide(weave: Weave, mark: str) -> bool:
    member = weave.of(mark)
    return (
        not member.upright
        and radius_of(weave, mark) >= member.radius
        and max(free_beyond(weave, mark).values()) >= member.length
    )


def is_acyclic(weave: Weave, marks: set[str]) -> bool:
    edges = [(low, high) for low, high, _, _ in weave.crossings if low in marks and high in marks]
    return nx.is_directed_acyclic_graph(nx.DiGraph(edges))


def ambiguous(weave: Weave) -> bool:
    """Whether a line runs just past the end of another one, or lies along it: then rounding decides what is free."""
    for a, b in combinations(weave.members, 2):
        shares = met((a.start, a.end), (b.start, b.end))
        if shares is None:
            (x, y), (gx, gy) = np.subtract(a.end, a.start) / a.length, np.subtract(b.start, a.start)
            if abs(gx * y - gy * x) < 5.0:
                return True
            continue
        for share, member in zip(shares, (a, b), strict=True):
            if min(abs(share), abs(share - 1.0)) * member.length < 5.0:
                return True
    return False


def flat(mark: str, start: Point, end: Point, radius: float = 1700.0) -> Member:
    return Member(mark, start, end, upright=False, coupled=False, radius=radius)


def square(radius: float, *strays: Member) -> Weave:
    """Four planks round a square of 1 m, each over the next, all of them 1.4 m long."""
    lines = [((-200.0, 0.0), (1200.0, 0.0)), ((1000.0, -200.0), (1000.0, 1200.0))]
    lines += [((1200.0, 1000.0), (-200.0, 1000.0)), ((0.0, 1200.0), (0.0, -200.0))]
    members = [flat(f"Q{i + 1}", start, end, radius) for i, (start, end) in enumerate(lines)]
    crossings = [(f"Q{(i + 1) % 4 + 1}", f"Q{i + 1}", 200.0, 1200.0) for i in range(4)]
    return Weave((*members, *strays), tuple(crossings))


def walls(gap: float) -> list[Member]:
    """Two long planks on each side of the square, the gap beyond the ends of its planks."""
    low, high = -200.0 - gap, 1200.0 + gap
    lines = [
        ((low, -3e3), (low, 4e3)),
        ((high, -3e3), (high, 4e3)),
        ((-3e3, low), (4e3, low)),
        ((-3e3, high), (4e3, high)),
    ]
    return [flat(f"W{i}", start, end) for i, (start, end) in enumerate(lines)]
