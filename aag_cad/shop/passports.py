"""Reuse passports: what a plank was, carried and kept, so that the next design can cut from it."""

from dataclasses import dataclass

import numpy as np

from aag_cad.geometry.framed import curvatures_at
from aag_cad.mechanics.checks.lamella import LamellaStress, lamella_stress
from aag_cad.parts.forms import Blank, CrossSection
from aag_cad.parts.index import sorted_planks
from aag_cad.parts.model import FlatBar, Gridshell, Timber
from aag_cad.parts.quantities import largest_twist, smallest_radius
from aag_cad.units import Floats

# The paper, section 5: the gridshell is to be taken down after two years and its planks to be reused.
SERVICE_LIFE_YEARS = 2.0
SAW_KERF = 1.0
REUSE_HEADER = ("mark", "length_mm", "width_mm", "thickness_mm", "species", "strength_class", "holes")
_SPACING = 20.0


@dataclass(frozen=True)
class Stretch:
    """A length of a blank that no hole touches, over its whole width: from and to, mm from the start."""

    start: float
    end: float

    @property
    def length(self) -> float:
        """Length in mm."""
        return self.end - self.start


@dataclass(frozen=True, eq=False)
class Strain:
    """Bending curvature about the weak axis and twist along a plank: stations (n,) mm, the others (n,) 1/mm, rad/mm.

    Both carry a sign: bending is positive where the face z > 0 of the blank is hollow, twist where the plank is a
    right-handed screw.
    """

    stations: Floats
    bending: Floats
    twist: Floats


@dataclass(frozen=True)
class Passport:
    """What is known of one plank when it is taken down; mm, rad/mm, N/mm2, from the model and not measured.

    ``smallest_radius`` is infinite for a plank that stays straight; its station and that of the largest twist are the
    first within a thousandth of them. ``clear`` lists the stretches without holes, the longest first. The set that
    creep leaves is not known before the plank is measured, so there is no figure for it.
    """

    plank: FlatBar
    timber: Timber
    design: str
    smallest_radius: float
    smallest_radius_station: float
    largest_twist: float
    largest_twist_station: float
    stress: LamellaStress
    clear: tuple[Stretch, ...]

    @property
    def bending_utilisation(self) -> float:
        """Bending and helix stress together by the characteristic strength f_m."""
        return self.stress.combined / self.timber.bending_strength

    @property
    def shear_utilisation(self) -> float:
        """Torsion stress by the characteristic strength f_v."""
        return self.stress.torsion / self.timber.shear_strength


def strain_along(plank: FlatBar, spacing: float = _SPACING) -> Strain:
    """Return how a plank is bent and twisted, sampled about every ``spacing`` mm from end to end."""
    stations = np.linspace(0.0, plank.curve.length, max(2, round(plank.curve.length / spacing) + 1))
    curvatures = curvatures_at(plank.curve, stations)
    # The thickness of an upright plank points against the binormal, that of a flat one along the normal.
    bending = -curvatures.geodesic if plank.upright else curvatures.normal
    return Strain(stations, bending, curvatures.torsion)


def clear_stretches(blank: Blank) -> tuple[Stretch, ...]:
    """Return the lengths between the edges of neighbouring holes and to the ends, the longest first."""
    stretches, reached = [], 0.0
    for hole in sorted(blank.holes, key=lambda hole: hole.station - (hole.diameter + hole.slot) / 2.0):
        half = (hole.diameter + hole.slot) / 2.0
        edge = min(hole.station - half, blank.length)
        if edge > reached:
            stretches.append(Stretch(reached, edge))
        reached = max(reached, hole.station + half)
    if blank.length > reached:
        stretches.append(Stretch(reached, blank.length))
    return tuple(sorted(stretches, key=lambda stretch: (-stretch.length, stretch.start)))


def stock_origin(section: CrossSection) -> str:
    """Return what a plank was cut from: a board split in two by a saw cut of 1 mm.

    The paper, section 3: boards of 25 x 100 mm were bought and split to two planks of 12 x 100 mm.
    """
    return f"half of a board {2.0 * section.thickness + SAW_KERF:g} x {section.width:g} mm, split in two"


def _first_peak(stations: Floats, values: Floats) -> float:
    """Return the first station at which the values come within a thousandth of their largest size."""
    sizes = np.abs(values)
    # On a plank of one curvature the very largest is a matter of rounding.
    return float(stations[np.argmax(sizes >= 0.999 * sizes.max())])


def passport(plank: FlatBar, timber: Timber, design: str) -> Passport:
    """Return the passport of a plank."""
    strain = strain_along(plank)
    return Passport(
        plank=plank,
        timber=timber,
        design=design,
        smallest_radius=smallest_radius(plank),
        smallest_radius_station=_first_peak(strain.stations, strain.bending),
        largest_twist=largest_twist(plank),
        largest_twist_station=_first_peak(strain.stations, strain.twist),
        stress=lamella_stress(plank, timber),
        clear=clear_stretches(plank.blank),
    )


def passports(gridshell: Gridshell) -> tuple[Passport, ...]:
    """Return the passports of all planks of all shells, by mark."""
    return tuple(passport(plank, gridshell.timber, gridshell.name) for plank in sorted_planks(gridshell))


def reuse_row(held: Passport) -> tuple[str, ...]:
    """Return a plank as stock for the next design, in the order of ``REUSE_HEADER``.

    Holes are station:offset:diameter, stations from the start, joined by semicolons, to 0.1 mm. The format knows round
    holes only: a slot is given as the round hole that holds it.
    """
    blank, timber = held.plank.blank, held.timber
    holes = (f"{h.station:.1f}:{round(h.offset, 1) + 0.0:.1f}:{h.diameter + h.slot:g}" for h in blank.holes)
    sizes = (f"{blank.length:.1f}", f"{blank.section.width:g}", f"{blank.section.thickness:g}")
    return (held.plank.mark, *sizes, timber.species, timber.strength_class, ";".join(holes))
