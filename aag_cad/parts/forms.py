"""What parts are made of: frames, sections, holes, straight blanks and folded plates, as plain data."""

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from aag_cad.units import Vector

HoleUse: TypeAlias = Literal["bolt", "screw"]


@dataclass(frozen=True)
class Frame:
    """A right-handed local frame; the axes are unit vectors. UNMOVED is that of what is given in vault coordinates."""

    origin: Vector
    x: Vector
    y: Vector
    z: Vector


UNMOVED = Frame((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(frozen=True)
class CrossSection:
    """Rectangle of a plank: width (the larger side) and thickness, mm."""

    width: float
    thickness: float


@dataclass(frozen=True)
class Hole:
    """A hole through the thickness of a blank: centre (station, offset), diameter, mm; for which joint.

    ``slot`` is how much longer than round it is, along the blank; 0 is round.
    """

    station: float
    offset: float
    diameter: float
    use: HoleUse
    joint: str
    slot: float = 0.0


@dataclass(frozen=True)
class EndCut:
    """The cut at an end of a blank: angle between the cut and the length in the width plane; 90 is square."""

    angle_deg: float = 90.0


@dataclass(frozen=True)
class Blank:
    """The straight plank as it is cut and drilled: the object of fabrication; holes sorted by station."""

    length: float
    section: CrossSection
    holes: tuple[Hole, ...] = field(repr=False)
    start_cut: EndCut = EndCut()
    end_cut: EndCut = EndCut()


@dataclass(frozen=True)
class CrossHole:
    """A hole across a stud or block: height along the frame's own axis, direction as an angle about it, diameter."""

    height: float
    angle: float
    diameter: float


@dataclass(frozen=True)
class PlateHole:
    """A round hole through a folded plate: station along its line, offset across it, diameter, mm."""

    station: float
    offset: float
    diameter: float


@dataclass(frozen=True)
class FoldedPlate:
    """A steel plate folded along parallel lines: its centre line (x, z) in the plane y = 0 of its frame; width along y.

    ``line`` is a polyline; a hole is square to the leg that it lies in.
    """

    line: tuple[tuple[float, float], ...]
    width: float
    thickness: float
    holes: tuple[PlateHole, ...]
