"""Volumes, masses and the strain of the parts: the numbers of the part lists."""

import math
from functools import lru_cache
from typing import Literal, TypeAlias

import numpy as np

from aag_cad.geometry.framed import Curvatures, curvatures_at
from aag_cad.parts.model import (
    Blade,
    Bolt,
    ClampingBar,
    CouplingBlock,
    FlatBar,
    Footing,
    Mullion,
    Part,
    Plank,
    Rod,
    Screw,
    Shoe,
    Strap,
    Strip,
    Stud,
    Timber,
)
from aag_cad.parts.plates import developed_length, plate_volume
from aag_cad.parts.strips import strip_sizes, strip_volume
from aag_cad.units import MM3_PER_M3

STEEL_DENSITY = 7850.0
STRAIGHT = 1e-9
_STATIONS_PER_SAMPLE = 8
_CHORDS = 64
# The studs of a shell have few kinds of holes, and many lists ask for their masses.
_HOLES = 1024

Material: TypeAlias = Literal["timber", "steel", "aluminium", "polycarbonate", "concrete"]


_KINDS: dict[type[Part], tuple[str, Material]] = {
    Plank: ("plank", "timber"),
    Stud: ("stud", "timber"),
    CouplingBlock: ("coupling block", "timber"),
    Bolt: ("bolt", "steel"),
    Screw: ("screw", "steel"),
    Strap: ("strap", "steel"),
    Shoe: ("shoe", "steel"),
    Rod: ("threaded rod", "steel"),
    Footing: ("concrete block", "concrete"),
    Mullion: ("mullion", "aluminium"),
    Strip: ("strip", "polycarbonate"),
    ClampingBar: ("clamping bar", "aluminium"),
    Blade: ("blade", "steel"),
}
# kg/m3; concrete after EN 1991-1-1, table A.1. Sheets carry their own: they are hollow.
_DENSITIES: dict[Material, float] = {
    "steel": STEEL_DENSITY,
    "aluminium": 2700.0,
    "concrete": 2400.0,
}


def kind(part: Part) -> str:
    """Return the word for what a part is, as in the part lists."""
    return _KINDS[type(part)][0]


def material(part: Part) -> Material:
    """Return what a part is made of."""
    return _KINDS[type(part)][1]


def material_name(part: Part, timber: Timber) -> str:
    """Return the material as it is ordered, e.g. ``ash D50`` or ``steel``."""
    return f"{timber.species} {timber.strength_class}" if material(part) == "timber" else material(part)


def hole_count(part: Part) -> int:
    """Return how many holes are drilled in a part."""
    match part:
        case Plank() | Mullion() | ClampingBar() | Strap():
            return len(part.blank.holes)
        case Stud() | CouplingBlock():
            return len(part.holes)
        case Shoe() | Blade():
            return len(part.plate.holes)
        case _:
            return 0


def sizes(part: Part) -> tuple[float, float, float]:
    """Return (length, width, thickness) in mm; both are the distance across flats of a stud, the diameter of a bolt.

    Of a strip and of folded plates they are those of the flat pattern.
    """
    match part:
        case Plank() | Mullion() | ClampingBar() | Strap():
            return part.blank.length, part.blank.section.width, part.blank.section.thickness
        case Stud():
            return part.length, part.across_flats, part.across_flats
        case CouplingBlock():
            return part.length, part.width, part.thickness
        case Bolt() | Screw() | Rod():
            return part.length, part.diameter, part.diameter
        case Footing():
            return part.length, part.width, part.height
        case Shoe() | Blade():
            return developed_length(part.plate), part.plate.width, part.plate.thickness
        case Strip():
            return strip_sizes(part)


def hexagon_area(across_flats: float) -> float:
    """Return the area of a regular hexagon, mm2."""
    return math.sqrt(3.0) / 2.0 * across_flats**2


def circle_area(diameter: float) -> float:
    """Return the area of a circle, mm2."""
    return math.pi / 4.0 * diameter**2


def section_area(part: Part) -> float:
    """Return the area of the cross-section of a timber part, or of the shank of a fastener, mm2."""
    _length, width, thickness = sizes(part)
    match part:
        case Stud():
            return hexagon_area(part.across_flats)
        case Bolt() | Screw() | Rod():
            return circle_area(part.diameter)
        case _:
            return width * thickness


@lru_cache(maxsize=_HOLES)
def _cross_hole_volume(across_flats: float, angle: float, diameter: float) -> float:
    """Return what a hole through the axis of a hexagonal prism takes away: chords weighted by the hole's depth, mm3.

    Gauss-Chebyshev quadrature of the second kind: exact where the hole enters and leaves through single flats.
    """
    k = np.arange(1, _CHORDS + 1) * math.pi / (_CHORDS + 1)
    offset, weight = diameter / 2.0 * np.cos(k), math.pi / (_CHORDS + 1) * np.sin(k) ** 2
    towards = np.arange(6) * math.pi / 3.0 - angle
    towards = towards[np.cos(towards) > 1e-12]
    reach = (across_flats / 2.0 - np.multiply.outer(offset, np.sin(towards))) / np.cos(towards)
    chord = reach.min(axis=1) + reach[::-1].min(axis=1)
    return float(diameter**2 / 2.0 * (weight @ chord))


def gross_volume(part: Part) -> float:
    """Return the volume before drilling, mm3; of a bolt with head, nut and washers; of a screw as a plain cylinder.

    A plank keeps section x length when it is bent and twisted, because its centre line runs through the centroid of
    the section; end cuts turn about the ends of the centre line and so leave the volume alone.
    """
    length = sizes(part)[0]
    if isinstance(part, Strip):
        return strip_volume(part)
    if isinstance(part, Rod):
        nut_and_washer = (hexagon_area(part.across_flats) - circle_area(part.diameter)) * part.nut_height
        nut_and_washer += (circle_area(part.washer_diameter) - circle_area(part.diameter)) * part.washer_thickness
        return circle_area(part.diameter) * part.length + 2.0 * nut_and_washer
    if isinstance(part, Bolt):
        hexagons = hexagon_area(part.across_flats) * (part.head_height + part.nut_height)
        washers = 2.0 * circle_area(part.washer_diameter) * part.washer_thickness
        tip = max(0.0, part.length - part.grip - 2.0 * part.washer_thickness - part.nut_height)
        return hexagons + washers + circle_area(part.diameter) * (part.grip + tip)
    return section_area(part) * length


def volume(part: Part) -> float:
    """Return the volume less all holes, mm3; the holes of one part must not meet."""
    if isinstance(part, Shoe | Blade):
        return plate_volume(part.plate)
    match part:
        case Plank() | Mullion() | ClampingBar() | Strap():
            bored = part.blank.section.thickness * sum(
                circle_area(hole.diameter) + hole.slot * hole.diameter for hole in part.blank.holes
            )
        case CouplingBlock():
            bored = part.thickness * sum(circle_area(hole.diameter) for hole in part.holes)
        case Stud():
            bored = sum(_cross_hole_volume(part.across_flats, hole.angle, hole.diameter) for hole in part.holes)
        case _:
            bored = 0.0
    return gross_volume(part) - bored


def density(part: Part, timber: Timber) -> float:
    """Return the density of a part, kg/m3."""
    if isinstance(part, Strip):
        return part.density
    made_of = material(part)
    return timber.density if made_of == "timber" else _DENSITIES[made_of]


def mass(part: Part, timber: Timber) -> float:
    """Return the mass of a part less its holes, kg."""
    return volume(part) * density(part, timber) / MM3_PER_M3


def _curvatures(plank: FlatBar) -> Curvatures:
    count = _STATIONS_PER_SAMPLE * (len(plank.curve.stations) - 1) + 1
    return curvatures_at(plank.curve, np.linspace(0.0, plank.curve.length, count))


def smallest_radius(plank: FlatBar) -> float:
    """Return the smallest radius to which a plank or bar is bent about its weak axis, mm; infinite if straight."""
    curvatures = _curvatures(plank)
    bending = float(
        np.max(np.abs(curvatures.geodesic if isinstance(plank, Plank) and plank.upright else curvatures.normal))
    )
    return 1.0 / bending if bending > STRAIGHT else math.inf


def largest_twist(plank: Plank) -> float:
    """Return the largest twist of a plank, rad/mm, without sign."""
    return float(np.max(np.abs(_curvatures(plank).torsion)))
