"""Volumes, masses and the strain of the parts: the numbers of the part lists."""

import math

import numpy as np

from aag_cad.geometry.framed import Curvatures, curvatures_at
from aag_cad.parts.kinds import Material, kind_of, shaped
from aag_cad.parts.model import FlatBar, Part, Timber
from aag_cad.units import MM3_PER_M3

STEEL_DENSITY = 7850.0
STRAIGHT = 1e-9
_STATIONS_PER_SAMPLE = 8
# kg/m3; concrete after EN 1991-1-1, table A.1. Timber has that of its species; sheets carry their own: they are hollow.
_DENSITIES: dict[Material, float] = {"steel": STEEL_DENSITY, "aluminium": 2700.0, "concrete": 2400.0}


def material_name(part: Part, timber: Timber) -> str:
    """Return the material as it is ordered, e.g. ``ash D50`` or ``steel``."""
    made_of = kind_of(part).material
    return f"{timber.species} {timber.strength_class}" if made_of == "timber" else made_of


def hole_count(part: Part) -> int:
    """Return how many holes are drilled in a part."""
    shape, form = shaped(part)
    return len(shape.holes(form))


def sizes(part: Part) -> tuple[float, float, float]:
    """Return (length, width, thickness) in mm; both are the distance across flats of a stud, the diameter of a bolt.

    Of a strip and of folded plates they are those of the flat pattern.
    """
    shape, form = shaped(part)
    return shape.sizes(form)


def section_area(part: Part) -> float:
    """Return the area of the cross-section of a timber part, or of the shank of a fastener, mm2."""
    shape, form = shaped(part)
    return shape.section(form)


def gross_volume(part: Part) -> float:
    """Return the volume before drilling, mm3; of a bolt with head, nut and washers; of a screw as a plain cylinder."""
    shape, form = shaped(part)
    return shape.gross_volume(form) if shape.gross_volume else shape.section(form) * shape.sizes(form)[0]


def volume(part: Part) -> float:
    """Return the volume less all holes, mm3; the holes of one part must not meet."""
    shape, form = shaped(part)
    return shape.volume(form)


def density(part: Part, timber: Timber) -> float:
    """Return the density of a part, kg/m3."""
    made_of = kind_of(part).material
    own: float | None = getattr(part, "density", None)
    return own or (timber.density if made_of == "timber" else _DENSITIES[made_of])


def mass(part: Part, timber: Timber) -> float:
    """Return the mass of a part less its holes, kg."""
    return volume(part) * density(part, timber) / MM3_PER_M3


def _curvatures(plank: FlatBar) -> Curvatures:
    count = _STATIONS_PER_SAMPLE * (len(plank.curve.stations) - 1) + 1
    return curvatures_at(plank.curve, np.linspace(0.0, plank.curve.length, count))


def smallest_radius(plank: FlatBar) -> float:
    """Return the smallest radius to which a plank or bar is bent about its weak axis, mm; infinite if straight."""
    curvatures = _curvatures(plank)
    bending = float(np.max(np.abs(curvatures.geodesic if plank.upright else curvatures.normal)))
    return 1.0 / bending if bending > STRAIGHT else math.inf


def largest_twist(plank: FlatBar) -> float:
    """Return the largest twist of a plank, rad/mm, without sign."""
    return float(np.max(np.abs(_curvatures(plank).torsion)))
