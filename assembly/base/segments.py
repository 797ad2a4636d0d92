"""The segments in which a gridshell travels, and the splices between them, as plain data."""

import math
from dataclasses import dataclass
from typing import Literal

from aag_cad.findings import Finding
from aag_cad.units import Vector


@dataclass(frozen=True)
class PlankCut:
    """Where a plank is cut: station from its start, and how far off the nearest hole is that stays, mm."""

    plank: str
    station: float
    clear: float


@dataclass(frozen=True)
class Splice:
    """A cut beam or edge plank: cuts of its planks, and what joins it again on site; lengths in mm.

    ``line`` is the geodesic along which the cut runs. A ``block`` lies in the gap of a beam, a ``plate`` on an edge
    plank; ``bolts`` is the count of both sides, ``columns`` how many stand one behind the other on each side;
    ``required`` is the least ``clear``; ``room`` how far a block may reach from the cut and ``reach`` how far it does;
    ``left_out`` are the marks that it stands for.
    """

    member: str
    line: str
    joint: str
    kind: Literal["block", "plate"]
    cuts: tuple[PlankCut, ...]
    required: float
    length: float
    columns: int
    bolts: int
    diameter: float
    left_out: tuple[str, ...]
    room: float = float("inf")
    reach: float = 0.0

    @property
    def clear(self) -> float:
        """The distance from its cuts to the nearest hole that stays, mm."""
        return min(cut.clear for cut in self.cuts)

    @property
    def fits(self) -> bool:
        """Whether bolts, cuts and holes keep their distances and the block has room."""
        return self.clear >= self.required and self.room >= self.reach


@dataclass(frozen=True)
class PlankPiece:
    """A piece of a cut plank: from one station of the whole blank to another, mm."""

    plank: str
    start: float
    end: float


@dataclass(frozen=True)
class Pose:
    """How a body lies in a box: unit axes along its length, width and height, and its extents along them, mm.

    ``filling`` is the largest of extent / room of the three: at most 1 if the body fits.
    """

    axes: tuple[Vector, Vector, Vector]
    size: Vector
    filling: float


@dataclass(frozen=True)
class Lifting:
    """Joints to sling a segment by, standing as in the vault; ``margin`` is how far inside them its plumb line is, mm.

    ``above`` says whether the plane of the studs passes above the centre of gravity: then it hangs without tipping
    even from short slings. They are studs, coupling blocks where studs will not do. Without three joints around the
    plumb line there are none, and the margin is negative.
    """

    studs: tuple[str, ...]
    margin: float
    above: bool


@dataclass(frozen=True)
class Brace:
    """A temporary piece between two joints: length between them and 100 mm past each, mm.

    A ``bar`` is a plank bent along the bare beam ends of a cut, fixed to each of them; a ``tie`` the straight chord
    from the lowest to the highest stud beside a cut; a ``diagonal`` goes from corner to corner. Ties and diagonals are
    two planks screwed to a T: one plank of 4 m buckles at 140 N, less than what segments press it with.
    """

    kind: Literal["bar", "tie", "diagonal"]
    start: str
    end: str
    length: float

    @property
    def planks(self) -> int:
        """Of how many planks it is made."""
        return 1 if self.kind == "bar" else 2


@dataclass(frozen=True)
class Limits:
    """The largest piece that travels: inner length, width and height of the transport, mm; its load and a crane's, kg.

    ``crane`` is None where none limits the mass.
    """

    length: float
    width: float
    height: float
    mass: float
    crane: float | None = None

    @property
    def room(self) -> Vector:
        """Length, width and height, mm."""
        return self.length, self.width, self.height

    @property
    def load(self) -> float:
        """The mass that both transport and crane carry, kg."""
        return self.mass if self.crane is None else min(self.mass, self.crane)


_ROUNDING = 1e-9


@dataclass(frozen=True)
class Segment:
    """What travels in one piece, without shoes, rods, blocks, cover and blades: those are fixed on site.

    ``parts`` are the marks of whole parts, ``pieces`` what it has of cut planks. ``mass`` in kg, without bracing;
    ``timber`` of it is timber; ``centre`` of gravity and the axes of ``pose`` are in vault coordinates, mm. ``over`` is
    what length, width, height (mm) and mass (kg) exceed the transport by, negative where there is room. ``props`` are
    the joints under which a segment of a cut shell is propped wherever it stands alone on its feet, and
    ``standing_margin`` how far its plumb line then runs inside feet and props, mm, negative outside.
    """

    name: str
    shell: str
    geodesics: tuple[str, ...]
    parts: tuple[str, ...]
    pieces: tuple[PlankPiece, ...]
    mass: float
    timber: float
    centre: Vector
    pose: Pose
    over: tuple[float, float, float, float]
    lifting: Lifting
    braces: tuple[Brace, ...]
    props: tuple[str, ...]
    standing_margin: float = math.inf

    @property
    def fits(self) -> bool:
        """Whether the segment fits the transport."""
        return self.pose.filling <= 1.0 + _ROUNDING and self.over[3] <= 0.0

    @property
    def tilt(self) -> float:
        """The angle by which the segment is turned over for transport, from standing as in the vault, radians."""
        return math.acos(min(1.0, max(-1.0, self.pose.axes[2][2])))


@dataclass(frozen=True)
class Segmentation:
    """How a gridshell is divided: segments, splices, and the fasteners put in on site because they join segments.

    ``changes`` are warnings: what a shell that is cut would need to travel whole; ``problems`` are what must change
    because it cannot be cut or spliced so (errors), or cannot be slung by three joints (warnings).
    """

    limits: Limits
    segments: tuple[Segment, ...]
    splices: tuple[Splice, ...]
    site: tuple[str, ...]
    changes: tuple[Finding, ...]
    problems: tuple[Finding, ...]


def segments_of(segmentation: Segmentation | None, shell: str) -> tuple[Segment, ...]:
    """Return the segments of a shell from the first geodesic to the last; none if it travels whole."""
    own = tuple(segment for segment in segmentation.segments if segment.shell == shell) if segmentation else ()
    return own if len(own) > 1 else ()


def splices_of(plan: Segmentation, segment: Segment) -> tuple[tuple[Splice, ...], tuple[Splice, ...]]:
    """Return the splices of a segment: those along its own geodesics, and those along its neighbours'."""
    planks = {piece.plank for piece in segment.pieces}
    cut = [s for s in plan.splices if any(c.plank in planks and _touches(segment, c.plank, c.station) for c in s.cuts)]
    own = set(segment.geodesics)
    return tuple(s for s in cut if s.line in own), tuple(s for s in cut if s.line not in own)


def _touches(segment: Segment, plank: str, station: float) -> bool:
    """Return whether a segment has the piece of a plank on one side of a cut."""
    return any(piece.plank == plank and station in (piece.start, piece.end) for piece in segment.pieces)
