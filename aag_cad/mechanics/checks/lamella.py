"""Stresses that bending and twisting a straight plank into its place leave in it."""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import cumulative_trapezoid

from aag_cad.geometry.framed import curvatures_at
from aag_cad.parts.model import FlatBar, Timber
from aag_cad.units import Floats

_SPACING = 20.0


@dataclass(frozen=True)
class LamellaStress:
    """What a plank carries from being formed: mm, rad/mm, N/mm2; largest values along it.

    ``combined`` is the largest sum of bending and helix stress at one section. ``bow`` is how far the centre line
    of the unrolled plank leaves its chord, ``edgewise`` the stress of forcing it straight.
    """

    mark: str
    smallest_radius: float
    largest_twist: float
    bending: float
    torsion: float
    helix: float
    combined: float
    bow: float
    edgewise: float


def unrolled_bow(curvature: Floats, stations: Floats) -> float:
    """Return the largest distance from its chord, mm, of the plane curve of curvature (n,) over stations (n,)."""
    angle = cumulative_trapezoid(curvature, stations, initial=0)
    x = cumulative_trapezoid(np.cos(angle), stations, initial=0)
    y = cumulative_trapezoid(np.sin(angle), stations, initial=0)
    chord = np.hypot(x[-1], y[-1])
    return float(np.abs(x * y[-1] - y * x[-1]).max() / chord)


def lamella_stress(plank: FlatBar, timber: Timber) -> LamellaStress:
    """Return the forming stresses of a plank of thickness t and width b.

    Bending sigma = E t kappa / 2 about the weak axis; torsion tau = G t theta'; helix (Wagner) stress at the edges
    sigma = E theta'^2 b^2 / 12; edgewise sigma = E b kappa_edge / 2 about the strong axis (paper section 3:
    r_min = 1.7 m is f_m = 50 N/mm2 for t = 12 mm).
    """
    count = max(25, int(plank.curve.length / _SPACING) + 1)
    stations = np.linspace(0.0, plank.curve.length, count)
    curvatures = curvatures_at(plank.curve, stations)
    weak, strong = curvatures.normal, curvatures.geodesic
    if plank.upright:
        weak, strong = strong, weak
    twist = np.abs(curvatures.torsion)
    width, thickness = plank.blank.section.width, plank.blank.section.thickness
    bending = timber.modulus * thickness * np.abs(weak) / 2.0
    helix = timber.modulus * twist**2 * width**2 / 12.0
    return LamellaStress(
        mark=plank.mark,
        smallest_radius=float(1.0 / max(np.abs(weak).max(), 1e-12)),
        largest_twist=float(twist.max()),
        bending=float(bending.max()),
        torsion=float(timber.shear_modulus * thickness * twist.max()),
        helix=float(helix.max()),
        combined=float((bending + helix).max()),
        bow=unrolled_bow(strong, stations),
        edgewise=float(timber.modulus * width / 2.0 * np.abs(strong).max()),
    )
