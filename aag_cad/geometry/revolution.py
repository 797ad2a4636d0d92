"""Surfaces of revolution in the chart (s, theta) whose diagonals are the asymptotic curves."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from aag_cad.errors import SurfaceError
from aag_cad.geometry.profiles import ClosedForm, Profile
from aag_cad.geometry.surface import Jet
from aag_cad.units import Floats

_PANELS = 400
_GAUSS = np.polynomial.legendre.leggauss(8)


@dataclass(frozen=True, eq=False)
class RevolutionSurface:
    """A meridian turned about the vertical axis through (axis_x, 0), in the parameters (u, theta).

    theta = 0 is the direction +x; X_u x X_theta points to the axis and up, which is the vault's outside.
    """

    profile: Profile
    axis_x: float = 0.0

    def jet(self, u: Floats, v: Floats) -> Jet:
        """Return the 2-jet at meridian parameter u and angle v = theta, each (n,) float."""
        r, z = self.profile.meridian(u)
        cos, sin, zero = np.cos(v), np.sin(v), np.zeros_like(u)
        return Jet(
            point=np.column_stack([self.axis_x + r[0] * cos, r[0] * sin, z[0]]),
            du=np.column_stack([r[1] * cos, r[1] * sin, z[1]]),
            dv=np.column_stack([-r[0] * sin, r[0] * cos, zero]),
            duu=np.column_stack([r[2] * cos, r[2] * sin, z[2]]),
            duv=np.column_stack([-r[1] * sin, r[1] * cos, zero]),
            dvv=np.column_stack([-r[0] * cos, -r[0] * sin, zero]),
        )


def asymptotic_rate(profile: Profile, u: Floats) -> tuple[Floats, Floats]:
    """Return (du/ds)^2 = -N/L and its derivative by u, each (n,), where s is the asymptotic coordinate.

    SurfaceError with the height where the Gaussian curvature is not negative: no asymptotic curve passes there.
    """
    r, z = profile.meridian(u)
    top, bottom = r[0] * z[1], r[2] * z[1] - z[2] * r[1]
    wrong = (top <= 0) | (bottom <= 0)
    if np.any(wrong):
        first = int(np.argmax(wrong))
        raise SurfaceError(
            f"surface: Gaussian curvature K >= 0 at height z = {z[0][first]:.0f} mm (radius {r[0][first]:.0f} mm); "
            "asymptotic curves need K < 0: let the meridian bulge towards the axis there"
        )
    square = top / bottom
    slope = (r[1] * z[1] + r[0] * z[2]) / bottom - top * (r[3] * z[1] - z[3] * r[1]) / bottom**2
    return square, slope


@dataclass(frozen=True, eq=False)
class AsymptoticChart:
    """A surface of revolution in the parameters (s, theta), s = integral sqrt(-L/N) du from the ground line.

    Its G lines are theta = const (meridians), its A lines theta -+ s = const.
    """

    surface: RevolutionSurface

    @cached_property
    def _splines(self) -> tuple[BSpline, BSpline]:
        """The splines s(u) and u(s) by quadrature, where the profile has no closed form."""
        profile = self.surface.profile
        low, high = profile.domain
        edges = np.linspace(low, high, _PANELS + 1)
        nodes, weights = _GAUSS
        half = np.diff(edges) / 2.0
        u = edges[:-1, None] + half[:, None] * (nodes + 1.0)
        rate, _ = asymptotic_rate(profile, u.ravel())
        pieces = half * ((1.0 / np.sqrt(rate)).reshape(u.shape) @ weights)
        s = np.concatenate([[0.0], np.cumsum(pieces)])
        forward = make_interp_spline(edges, s, k=5)
        s = s - float(forward(0.0))
        return make_interp_spline(edges, s, k=5), make_interp_spline(s, edges, k=5)

    def meridian_parameter(self, s: Floats) -> Floats:
        """Return the meridian parameter u at the asymptotic coordinate s, (n,); SurfaceError outside the meridian."""
        profile = self.surface.profile
        low, high = self.domain
        if np.any((s < low) | (s > high)):
            raise SurfaceError(
                f"surface: the web asks for the asymptotic coordinate {float(np.max(np.abs(s))):.3f}, the meridian "
                f"ends at [{low:.3f}, {high:.3f}]; lengthen the meridian or lower the shell"
            )
        if isinstance(profile, ClosedForm):
            return profile.from_asymptotic(s)
        forward, inverse = self._splines
        u = np.asarray(inverse(s))
        for _ in range(3):
            rate, _slope = asymptotic_rate(profile, u)
            u = u - (np.asarray(forward(u)) - s) * np.sqrt(rate)
        return u

    @property
    def domain(self) -> tuple[float, float]:
        """The range of s."""
        profile = self.surface.profile
        if isinstance(profile, ClosedForm):
            low, high = profile.asymptotic(np.array(profile.domain))
            return float(low), float(high)
        inverse = self._splines[1]
        return float(inverse.t[0]), float(inverse.t[-1])

    def jet(self, u: Floats, v: Floats) -> Jet:
        """Return the 2-jet by (s, theta) at s = u and theta = v, each (n,) float."""
        meridian = self.meridian_parameter(u)
        square, slope = asymptotic_rate(self.surface.profile, meridian)
        rate = np.sqrt(square)[:, None]
        jet = self.surface.jet(meridian, v)
        return Jet(
            point=jet.point,
            du=jet.du * rate,
            dv=jet.dv,
            duu=jet.duu * square[:, None] + jet.du * (slope / 2.0)[:, None],
            duv=jet.duv * rate,
            dvv=jet.dvv,
        )


def turn(angle: float) -> Floats:
    """Return the rotation (4, 4) by an angle in radians about the vertical axis through the origin."""
    motion = np.eye(4)
    cos, sin = math.cos(angle), math.sin(angle)
    motion[:2, :2] = [[cos, -sin], [sin, cos]]
    return motion
