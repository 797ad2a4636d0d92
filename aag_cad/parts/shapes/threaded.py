"""Bolts, screws and threaded rods: pieces one upon the other along their axis."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal, TypeAlias

import numpy as np

from aag_cad.once import once
from aag_cad.parts.model import Bolt, Rod, Screw
from aag_cad.parts.shapes.prism import column_points
from aag_cad.parts.shapes.shape import Shape
from aag_cad.parts.triangles import Mesh, circle_area, hexagon_area, joined, prism, regular_polygon, round_polygon
from aag_cad.units import Floats

# Bolts and rods come in a few sizes, thousands of times.
_SIZES = 64
_PieceName: TypeAlias = Literal["head", "washer", "shank", "nut"]


@dataclass(frozen=True)
class BoltPiece:
    """A stretch between two heights: head and nut are hexagons (size across flats), the others round (diameter).

    ``countersunk`` is the diameter of a head at 90 degrees in the low end of a shank; only solids show it.
    """

    name: _PieceName
    size: float
    low: float
    high: float
    countersunk: float = 0.0

    @property
    def hexagonal(self) -> bool:
        """Whether it is turned by a spanner."""
        return self.name in ("head", "nut")

    @property
    def volume(self) -> float:
        """Its volume as a whole, without a hole for a shank and without a countersunk head, mm3."""
        return (hexagon_area if self.hexagonal else circle_area)(self.size) * (self.high - self.low)


@dataclass(frozen=True)
class Threaded:
    """A fastener: its nominal diameter and length, and its pieces along z, each on top of the one before."""

    diameter: float
    length: float
    pieces: tuple[BoltPiece, ...]


@once
def bolt_form(bolt: Bolt) -> Threaded:
    """Return head, washer, shank, washer, nut and tip of a bolt; z = 0 is the face of the first plank."""
    t, nut = bolt.washer_thickness, bolt.grip + bolt.washer_thickness
    pieces = (
        BoltPiece("head", bolt.across_flats, -t - bolt.head_height, -t),
        BoltPiece("washer", bolt.washer_diameter, -t, 0.0),
        BoltPiece("shank", bolt.diameter, 0.0, bolt.grip),
        BoltPiece("washer", bolt.washer_diameter, bolt.grip, nut),
        BoltPiece("nut", bolt.across_flats, nut, nut + bolt.nut_height),
        BoltPiece("shank", bolt.diameter, nut + bolt.nut_height, bolt.length - t),
    )
    return Threaded(bolt.diameter, bolt.length, tuple(piece for piece in pieces if piece.high > piece.low))


@once
def rod_form(rod: Rod) -> Threaded:
    """Return shank, nuts and washers of a threaded rod from its lower end upwards."""
    (low, high), t, m, d = rod.nuts, rod.washer_thickness, rod.nut_height, rod.diameter
    pieces = (
        BoltPiece("shank", d, 0.0, low - t - m),
        BoltPiece("nut", rod.across_flats, low - t - m, low - t),
        BoltPiece("washer", rod.washer_diameter, low - t, low),
        BoltPiece("shank", d, low, high),
        BoltPiece("washer", rod.washer_diameter, high, high + t),
        BoltPiece("nut", rod.across_flats, high + t, high + t + m),
        BoltPiece("shank", d, high + t + m, rod.length),
    )
    return Threaded(d, rod.length, pieces)


@once
def screw_form(screw: Screw) -> Threaded:
    """Return a screw as its plain shank, from the face of the plank."""
    shank = BoltPiece("shank", screw.diameter, 0.0, screw.length, screw.head_diameter)
    return Threaded(screw.diameter, screw.length, (shank,))


def _volume(form: Threaded) -> float:
    return sum(piece.volume for piece in form.pieces)


@lru_cache(maxsize=_SIZES)
def _mesh(form: Threaded) -> Mesh:
    return joined(
        [
            prism(regular_polygon(6, p.size) if p.hexagonal else round_polygon(p.size), p.low, p.high)
            for p in form.pieces
        ]
    )


def _depths(form: Threaded, points: Floats) -> Floats:
    radius, height = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    depths = [np.minimum.reduce([p.size / 2.0 - radius, height - p.low, p.high - height]) for p in form.pieces]
    return np.asarray(np.maximum.reduce(depths))


THREADED = Shape[Threaded](
    name="threaded",
    sizes=lambda form: (form.length, form.diameter, form.diameter),
    section=lambda form: circle_area(form.diameter),
    gross_volume=_volume,
    volume=_volume,
    mesh=_mesh,
    points=lambda form: column_points(_mesh(form)),
    depths=_depths,
)
