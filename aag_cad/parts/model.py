"""The gridshell as plain data: every part and every joint, in mm, in the coordinates of its shell.

The truth of a plank is its blank (straight, with holes); ``curve`` says how the blank is bent. A point (x, y, z) of the
blank, x along it from its start, y across its width and z through its thickness, both from the centre line, goes to
``curve(x) + y * width_direction(x) + z * thickness_direction(x)``: see ``aag_cad.parts.forming``.
"""

from dataclasses import dataclass, field
from typing import ClassVar, Literal, Protocol, TypeAlias

from aag_cad.families import Family
from aag_cad.geometry.framed import FramedCurve
from aag_cad.parts.forms import Blank, CrossHole, FoldedPlate, Frame, Hole
from aag_cad.units import Vector

SCHEMA_VERSION = 2
JointKind: TypeAlias = Literal["AA", "AG", "boundary", "foot", "footing", "ridge", "blade", "cover"]


class Part(Protocol):
    """What is made and put in place under its own mark; ``aag_cad.parts.kinds`` describes every kind."""

    @property
    def mark(self) -> str:
        """Its mark, which no other part has."""


@dataclass(frozen=True)
class JointStation:
    """Where a joint sits on a curve: its mark and the arc length from the curve's start, mm."""

    joint: str
    station: float


@dataclass(frozen=True)
class Plank:
    """One plank; ``upright`` planks stand on the surface (asymptotic), the others lie flat in it (geodesic).

    ``curve`` is its centre line by its own arc length (length = blank.length); ``layer`` is -1, 0 or +1 along the
    outward normal; ``beam`` is the mark of the coupled beam that it belongs to, or "".
    """

    mark: str
    family: Family
    layer: int
    upright: bool
    beam: str
    curve: FramedCurve = field(repr=False)
    blank: Blank
    joints: tuple[JointStation, ...] = field(repr=False)


@dataclass(frozen=True)
class Beam:
    """A coupled beam: two sibling planks (left and right of its direction, seen from outside) and what joins them."""

    mark: str
    family: Family
    layer: int
    planks: tuple[str, str]
    curve: FramedCurve = field(repr=False)
    joints: tuple[JointStation, ...] = field(repr=False)


@dataclass(frozen=True)
class Stud:
    """A hexagonal stud: centre and axis z of its frame; x is the outward normal of one of its six flats.

    A hole's height is along z from the centre, its angle is about z from x.
    """

    mark: str
    frame: Frame = field(repr=False)
    length: float
    across_flats: float
    holes: tuple[CrossHole, ...] = field(repr=False)


@dataclass(frozen=True)
class CouplingBlock:
    """A timber block in the gap of a beam: x along the beam, y along the surface normal, z through the gap.

    ``holes`` go through the gap (along z) at (along x, along y) from the centre.
    """

    mark: str
    frame: Frame = field(repr=False)
    length: float
    width: float
    thickness: float
    holes: tuple[Hole, ...] = field(repr=False)


@dataclass(frozen=True)
class Bolt:
    """A hexagon bolt with a washer at each end and a nut: ``frame.origin`` is the outer face of the first plank.

    z of the frame points from the head to the nut; ``grip`` is the timber that it clamps; sizes in mm.
    """

    mark: str
    frame: Frame = field(repr=False)
    diameter: float
    length: float
    grip: float
    across_flats: float
    head_height: float
    nut_height: float
    washer_diameter: float
    washer_thickness: float


@dataclass(frozen=True)
class Screw:
    """A countersunk wood screw, head flush: ``frame.origin`` is the outer face of the plank, z points into it."""

    mark: str
    frame: Frame = field(repr=False)
    diameter: float
    length: float
    head_diameter: float


@dataclass(frozen=True)
class Rod:
    """A threaded rod with a nut and a washer under and over a plate: ``frame.origin`` is its lower end, z points up.

    ``nuts`` are the heights at which the lower nut's washer carries the plate and the upper nut's washer presses on it.
    """

    mark: str
    frame: Frame = field(repr=False)
    diameter: float
    length: float
    nuts: tuple[float, float]
    across_flats: float
    nut_height: float
    washer_diameter: float
    washer_thickness: float


@dataclass(frozen=True)
class Strip:
    """A sheet between two neighbouring geodesics, bent along them: a developable surface by its straight rulings.

    ``left`` and ``right`` are its edges at mid-thickness, with equally many samples: sample i of both are the ends of
    ruling i; their normals are those of the sheet, outwards. The rulings have the parameter 0 (first) to 1 (last).
    ``lower`` and ``upper`` are the parameters at which the sheet ends, at equal fractions of the rulings from left to
    right; in between the ends are straight in the flat pattern. ``density`` (kg/m3) counts the hollow sheet as a whole.
    """

    mark: str
    left: FramedCurve = field(repr=False)
    right: FramedCurve = field(repr=False)
    thickness: float
    lower: tuple[float, ...] = field(repr=False)
    upper: tuple[float, ...] = field(repr=False)
    density: float = 170.0


@dataclass(frozen=True)
class MetalBar:
    """A flat bar of metal: it lies flat, as planks may, and in no beam."""

    mark: str
    curve: FramedCurve = field(repr=False)
    blank: Blank
    upright: ClassVar[bool] = False
    beam: ClassVar[str] = ""


class Mullion(MetalBar):
    """An aluminium bar along a geodesic, bent flat-ways over the outer beams; two strips lie on it."""


class ClampingBar(MetalBar):
    """An aluminium bar over a mullion that clamps the edges of the strips."""


class Strap(MetalBar):
    """A flat steel bar on the end of a geodesic and the edge plank that it stops at, bent flat-ways to both."""


@dataclass(frozen=True)
class Shoe:
    """The steel shoe at the foot of a geodesic: an upright on geodesic and edge plank, a foot over the block.

    z of the frame is up, x the outward normal of the shell made level, the origin the foot joint.
    """

    mark: str
    frame: Frame = field(repr=False)
    plate: FoldedPlate = field(repr=False)


@dataclass(frozen=True)
class Footing:
    """A precast concrete block under a shoe; ``frame.origin`` is the centre of its top, z points up."""

    mark: str
    frame: Frame = field(repr=False)
    length: float
    width: float
    height: float


@dataclass(frozen=True)
class Blade:
    """A folded steel plate between the ridge planks of two shells; its frame is in vault coordinates.

    y of the frame runs along the fold in the ridge plane, z points outwards in that plane.
    """

    mark: str
    frame: Frame = field(repr=False)
    plate: FoldedPlate = field(repr=False)


@dataclass(frozen=True)
class Joint:
    """What meets where: the members joined (planks, studs, blocks, bars, plates) and the fasteners, by mark.

    AA: two beams on a stud; AG: a geodesic on a coupling block of a beam; boundary: an edge plank on such a block;
    foot: the end of a geodesic and the bottom plank in a shoe; footing: a shoe on its concrete block; ridge: the end
    of a geodesic at an edge plank, by a strap; blade: two shells at the ridge; cover: strips between mullion and
    clamping bar on a coupling block.
    """

    mark: str
    kind: JointKind
    point: Vector = field(repr=False)
    normal: Vector = field(repr=False)
    members: tuple[str, ...]
    fasteners: tuple[str, ...]


@dataclass(frozen=True)
class Shell:
    """One shell: where it stands in the vault, and all its parts in its own coordinates.

    ``more`` holds the parts of kinds that have no field here. ``twin_of`` is the shell that it is a copy of, "" if it
    is none: turned about the centre, equal in its own coordinates but for the numbers in its marks. Who changes a copy
    takes the record away.
    """

    mark: str
    placement: Frame
    planks: tuple[Plank, ...]
    beams: tuple[Beam, ...]
    studs: tuple[Stud, ...]
    blocks: tuple[CouplingBlock, ...]
    bolts: tuple[Bolt, ...]
    screws: tuple[Screw, ...]
    joints: tuple[Joint, ...]
    straps: tuple[Strap, ...] = ()
    shoes: tuple[Shoe, ...] = ()
    rods: tuple[Rod, ...] = ()
    footings: tuple[Footing, ...] = ()
    mullions: tuple[Mullion, ...] = ()
    strips: tuple[Strip, ...] = ()
    clamps: tuple[ClampingBar, ...] = ()
    more: tuple[Part, ...] = ()
    twin_of: str = ""

    def __repr__(self) -> str:
        """Return how much there is of what, in short."""
        flat = sum(not plank.upright for plank in self.planks)
        return f"Shell {self.mark}: {len(self.beams)} beams, {flat} flat planks, {len(self.joints)} joints"


@dataclass(frozen=True)
class Timber:
    """The timber of all planks: densities in kg/m3, moduli and characteristic strengths in N/mm2, limits."""

    species: str
    strength_class: str
    density: float
    modulus: float
    shear_modulus: float
    bending_strength: float
    shear_strength: float
    min_bending_radius: float
    max_twist: float


@dataclass(frozen=True)
class Gridshell:
    """The whole structure; ``ground`` is the height of the ground in vault coordinates, mm.

    Blades, their bolts and their joints are in vault coordinates.
    """

    schema_version: int
    name: str
    title: str
    timber: Timber
    ground: float
    shells: tuple[Shell, ...]
    blades: tuple[Blade, ...] = ()
    bolts: tuple[Bolt, ...] = ()
    joints: tuple[Joint, ...] = ()
    more: tuple[Part, ...] = ()

    def __repr__(self) -> str:
        """Return how much there is of what, in short."""
        return f"Gridshell {self.name}: {len(self.shells)} shells, {len(all_parts(self))} parts"


FlatBar: TypeAlias = Plank | MetalBar
Member: TypeAlias = Plank | Beam


def shell_parts(shell: Shell) -> tuple[Part, ...]:
    """Return every part of a shell, in the order of its fields; beams are assemblies of planks and not parts."""
    return (
        *shell.planks, *shell.studs, *shell.blocks, *shell.bolts, *shell.screws, *shell.straps, *shell.shoes,
        *shell.rods, *shell.footings, *shell.mullions, *shell.strips, *shell.clamps, *shell.more,
    )  # fmt: skip


def ridge_parts(gridshell: Gridshell) -> tuple[Part, ...]:
    """Return the parts between the shells, in vault coordinates: blades, their bolts, and what else there is."""
    return (*gridshell.blades, *gridshell.bolts, *gridshell.more)


def all_parts(gridshell: Gridshell) -> tuple[Part, ...]:
    """Return every part of the gridshell, shell by shell, then those between the shells."""
    return (*(part for shell in gridshell.shells for part in shell_parts(shell)), *ridge_parts(gridshell))


def all_joints(gridshell: Gridshell) -> tuple[Joint, ...]:
    """Return every joint, shell by shell, then those between the shells."""
    return (*(joint for shell in gridshell.shells for joint in shell.joints), *gridshell.joints)
