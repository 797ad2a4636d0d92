"""Meridians of surfaces of revolution: constant-ratio (CRPC), catenoid, hyperboloid of one sheet, arc, spline."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, TypeAlias

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline
from scipy.optimize import brentq

from aag_cad.errors import SurfaceError
from aag_cad.units import Floats

_GAUSS = np.polynomial.legendre.leggauss(60)


class Profile(Protocol):
    """A meridian (r(u), z(u)) that rises with u; u = 0 is the ground line (z = 0)."""

    def meridian(self, u: Floats) -> tuple[Floats, Floats]:
        """Return r and z, each with its first three derivatives by u as (4, n), mm."""
        ...

    @property
    def domain(self) -> tuple[float, float]:
        """The range of u."""
        ...


@dataclass(frozen=True)
class CrpcProfile:
    """Meridian of the surface whose principal curvatures keep the ratio k_meridian / k_parallel = -ratio.

    r = r0 cosh(u)^(1/n), z' = (r0/n) cosh(u)^(1/n - 1); the neck (u = 0) is a planar geodesic. n = 1 is the catenoid.
    """

    neck_radius: float
    ratio: float
    domain: tuple[float, float] = (-8.0, 8.0)

    def meridian(self, u: Floats) -> tuple[Floats, Floats]:
        """Return r and z, each with its first three derivatives by u as (4, n), mm; z by Gauss-Legendre quadrature."""
        a = 1.0 / self.ratio
        tanh, sech2 = np.tanh(u), 1.0 / np.cosh(u) ** 2
        r = self.neck_radius * np.cosh(u) ** a
        bend = a * tanh**2 + sech2
        dddr = a * r * (a * tanh * bend + 2.0 * (a - 1.0) * sech2 * tanh)
        nodes, weights = _GAUSS
        half = np.multiply.outer(u / 2.0, nodes + 1.0)
        z = a * self.neck_radius * (u / 2.0) * (np.cosh(half) ** (a - 1.0) @ weights)
        dz = a * self.neck_radius * np.cosh(u) ** (a - 1.0)
        ddz = (a - 1.0) * tanh * dz
        dddz = (a - 1.0) * (sech2 * dz + tanh * ddz)
        return np.array([r, a * r * tanh, a * r * bend, dddr]), np.array([z, dz, ddz, dddz])

    def asymptotic(self, u: Floats) -> Floats:
        """Return the asymptotic coordinate s = u / sqrt(n)."""
        return u / math.sqrt(self.ratio)

    def from_asymptotic(self, s: Floats) -> Floats:
        """Return u = s sqrt(n)."""
        return s * math.sqrt(self.ratio)


@dataclass(frozen=True)
class HyperboloidProfile:
    """Meridian r = r0 cosh u, z = c sinh u of the hyperboloid of one sheet; its asymptotic curves are its rulings."""

    neck_radius: float
    semi_axis: float
    domain: tuple[float, float] = (-3.0, 3.0)

    def meridian(self, u: Floats) -> tuple[Floats, Floats]:
        """Return r and z, each with its first three derivatives by u as (4, n), mm."""
        cosh, sinh = np.cosh(u), np.sinh(u)
        return self.neck_radius * np.array([cosh, sinh] * 2), self.semi_axis * np.array([sinh, cosh] * 2)

    def asymptotic(self, u: Floats) -> Floats:
        """Return the asymptotic coordinate, the Gudermannian s = 2 arctan tanh(u/2)."""
        return 2.0 * np.arctan(np.tanh(u / 2.0))

    def from_asymptotic(self, s: Floats) -> Floats:
        """Return u = 2 artanh tan(s/2), for |s| < pi/2."""
        return 2.0 * np.arctanh(np.tan(s / 2.0))


# The profiles that know their asymptotic coordinate in closed form.
ClosedForm: TypeAlias = CrpcProfile | HyperboloidProfile


@dataclass(frozen=True)
class ArcProfile:
    """Meridian of one radius R, r = r0 + R (1 - cos u), z = R sin u: vertical at the neck, bulging to the axis."""

    neck_radius: float
    meridian_radius: float
    domain: tuple[float, float] = (-1.5, 1.5)

    def meridian(self, u: Floats) -> tuple[Floats, Floats]:
        """Return r and z, each with its first three derivatives by u as (4, n), mm."""
        cos, sin = self.meridian_radius * np.cos(u), self.meridian_radius * np.sin(u)
        radius = self.neck_radius + self.meridian_radius - cos
        return np.array([radius, sin, cos, -sin]), np.array([sin, cos, -sin, -cos])


@dataclass(frozen=True)
class SplineProfile:
    """Meridian through given points (r, z) in mm, lowest first, as a quintic spline over the chord length.

    The points must reach below the ground line z = 0, because beams end a little below it; SurfaceError if not.
    """

    points: tuple[tuple[float, float], ...]

    @cached_property
    def _spline(self) -> tuple[BSpline, float]:
        points = np.array(self.points, dtype=float)
        if len(points) < 6:
            raise SurfaceError(f"surface.points: {len(points)} points; a quintic meridian needs at least 6")
        if np.any(np.diff(points[:, 1]) <= 0):
            raise SurfaceError("surface.points: heights must rise from point to point; sort them by z")
        if points[0, 1] >= 0 or points[-1, 1] <= 0:
            raise SurfaceError(
                f"surface.points: heights run from {points[0, 1]:g} to {points[-1, 1]:g} mm; "
                "they must reach from below the ground line (z < 0) to above it"
            )
        chord = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        spline = make_interp_spline(chord, points, k=5)
        ground = brentq(lambda u: float(spline(u)[1]), chord[0], chord[-1], xtol=1e-12)
        return spline, float(ground)

    @property
    def domain(self) -> tuple[float, float]:
        """The range of u, the chord length from the ground line in mm."""
        spline, ground = self._spline
        return float(spline.t[0]) - ground, float(spline.t[-1]) - ground

    def meridian(self, u: Floats) -> tuple[Floats, Floats]:
        """Return r and z, each with its first three derivatives by u as (4, n), mm."""
        spline, ground = self._spline
        both = np.array([spline(u + ground, nu=order) for order in range(4)])
        return both[..., 0], both[..., 1]
