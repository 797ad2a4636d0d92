"""What a designer asks of an optimised web, and what the optimiser tells of its way there."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from aag_cad.units import Floats, Vector
from aag_cad.web.web import Web

Reason: TypeAlias = Literal["converged", "stalled", "collapsed", "left the design's range"]


@dataclass(frozen=True)
class PointGoal:
    """A vertex (row, column) that is held at a point, mm."""

    row: int
    column: int
    point: Vector


@dataclass(frozen=True)
class Goals:
    """The wishes; None leaves a thing free.

    ``angle`` is between the A lines that run up right and up left, radians (120 degrees give 60 degree nodes with the
    geodesics); ``bottom_row`` is the row of the planar, geodesic bottom curve, with ghost rows under it; ``height`` and
    ``span`` (mm) hold the top of the middle column over the bottom and the width of the bottom row; ``points`` are
    held where they are said; ``closeness`` weighs the distance from the start; ``min_radius`` (mm) and ``max_twist``
    (rad/mm) are one-sided; ``symmetric`` mirrors the web in the plane y = 0. ``weights`` replaces those of Eq. (7)
    by the name of an energy: A-net, geodesic, angle, bottom, height, span, points, radius, twist.
    """

    angle: float | None
    bottom_row: int | None = None
    height: float | None = None
    span: float | None = None
    points: tuple[PointGoal, ...] = ()
    closeness: float = 0.0
    min_radius: float | None = None
    max_twist: float | None = None
    symmetric: bool = True
    weights: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Iteration:
    """One Gauss-Newton step: its stage, the energies before it, the largest move per edge."""

    number: int
    stage: str
    energies: Mapping[str, float]
    step: float


@dataclass(frozen=True, eq=False)
class Optimised:
    """A web with the reason why the optimiser stopped; only ``converged`` is a success."""

    web: Web
    reason: Reason
    explanation: str
    iterations: tuple[Iteration, ...]
    start: Floats = field(repr=False)

    @property
    def success(self) -> bool:
        """Whether the web satisfies the goals."""
        return self.reason == "converged"
