"""Bolts and screws of standard sizes, placed by their axes."""

import tomllib
from functools import cache
from typing import Any

import numpy as np

from aag_cad.errors import DesignError
from aag_cad.geometry.surface import unit
from aag_cad.parts.forms import Frame
from aag_cad.parts.model import Bolt, Rod, Screw
from aag_cad.resources import template
from aag_cad.units import Floats, vector

_SCREW_HEAD = 2.0
_THREAD_PAST_NUT = 2.0


@cache
def _catalogue() -> dict[str, dict[str, Any]]:
    with template("fasteners.toml").open("rb") as file:
        return tomllib.load(file)


def _of_size(diameter: float, *names: str) -> dict[str, Any]:
    size = _catalogue()[f"M{diameter:g}"]
    return {name: size[name] for name in ("across_flats", "nut_height", "washer_diameter", "washer_thickness", *names)}


def axis_frame(origin: Floats, direction: Floats, side: Floats) -> Frame:
    """Return the frame with z along ``direction`` and x as near to ``side`` as it can be; all (3,)."""
    z = unit(direction)
    x = unit(side - (side @ z) * z)
    return Frame(vector(origin), vector(x), vector(np.cross(z, x)), vector(z))


def hexagon_bolt(mark: str, diameter: float, grip: float, frame: Frame) -> Bolt:
    """Return the shortest ISO 4014 bolt for a grip in mm, with ISO 7093-1 washers and an ISO 4032 nut.

    DesignError if the catalogue has none that is long enough.
    """
    size = _catalogue()[f"M{diameter:g}"]
    needed = grip + 2 * size["washer_thickness"] + size["nut_height"] + _THREAD_PAST_NUT
    lengths = [length for length in size["lengths"] if length >= needed]
    if not lengths:
        raise DesignError(
            f"joints.bolt_diameter: no M{diameter:g} bolt of {needed:.0f} mm in the catalogue, the longest is "
            f"{max(size['lengths'])} mm; narrow joints.gap or take a larger bolt"
        )
    return Bolt(
        mark=mark,
        frame=frame,
        diameter=float(diameter),
        length=float(lengths[0]),
        grip=grip,
        **_of_size(diameter, "head_height"),
    )


def threaded_rod(mark: str, diameter: float, length: float, nuts: tuple[float, float], frame: Frame) -> Rod:
    """Return a threaded rod (DIN 976-1) with ISO 4032 nuts and ISO 7089 washers at two heights over its lower end."""
    sizes = _of_size(diameter)
    return Rod(mark=mark, frame=frame, diameter=float(diameter), length=length, nuts=nuts, **sizes)


def wood_screw(mark: str, diameter: float, length: float, frame: Frame) -> Screw:
    """Return a countersunk wood screw; its head is twice as wide as its shank."""
    return Screw(mark, frame, diameter, length, _SCREW_HEAD * diameter)
