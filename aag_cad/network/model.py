"""The curve network of one shell as plain data: curves, where their planks end, and their crossings."""

from dataclasses import dataclass
from typing import Literal, NamedTuple, TypeAlias

from aag_cad.families import Family
from aag_cad.geometry.framed import FramedCurve
from aag_cad.units import Vector

CrossingKind: TypeAlias = Literal["AA", "AG", "boundary", "foot", "ridge"]


class CurveId(NamedTuple):
    """Family and number (from 1) of a curve; E 1 is the bottom, E 2 and E 3 are the ridge planks of a ridge.

    On a level top E goes on from the bottom to the top, each with one plank, or with several where it is a closed ring.
    Numbers rise with theta: from left to right for someone who stands inside, at the centre of the vault.
    """

    family: Family
    number: int


BOTTOM = CurveId("E", 1)
LEFT_RIDGE = CurveId("E", 2)
RIGHT_RIDGE = CurveId("E", 3)


@dataclass(frozen=True)
class NetworkCurve:
    """A curve on the reference surface that reaches past its plank; the plank lies over stations [start, end]."""

    id: CurveId
    curve: FramedCurve
    start: float
    end: float


@dataclass(frozen=True)
class Crossing:
    """Where two curves are joined: the stations on each, the point and the surface normal there.

    AA: A1 and A2; AG: A and G; boundary: A and E; foot: G and bottom; ridge: G and top or
    ridge plank, or two ridge planks.
    """

    kind: CrossingKind
    curves: tuple[CurveId, CurveId]
    stations: tuple[float, float]
    point: Vector
    normal: Vector

    def station_on(self, curve: CurveId) -> float:
        """Return the station on one of its curves."""
        return self.stations[self.curves.index(curve)]


@dataclass(frozen=True)
class CurveNetwork:
    """All curves and joined crossings of one shell, in shell coordinates, sorted by id and by place."""

    curves: tuple[NetworkCurve, ...]
    crossings: tuple[Crossing, ...]

    def __repr__(self) -> str:
        """Return how many curves and crossings there are."""
        return f"CurveNetwork of {len(self.curves)} curves, {len(self.crossings)} crossings"
