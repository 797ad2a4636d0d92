"""From a design to the web that the optimiser starts with, and from the optimised web back to a chart."""

import math
from dataclasses import dataclass

import numpy as np

from aag_cad.design import Design
from aag_cad.design_tables import Optimise
from aag_cad.geometry.revolution import AsymptoticChart
from aag_cad.geometry.surface import Jet
from aag_cad.units import Floats
from aag_cad.web.goals import Goals, PointGoal
from aag_cad.web.interpolation import InterpolatedSurface, interpolated_surface
from aag_cad.web.web import Web, sampled_web

_MARGIN_STEPS = 2


@dataclass(frozen=True, eq=False)
class WebChart:
    """The smooth surface through a web in the parameters (s, theta): A lines theta = c +- s, G lines theta = const.

    s = 0 is the bottom curve, theta = 0 the plane of symmetry; they are labels, no longer lengths or angles.
    """

    surface: InterpolatedSurface
    first_s: float
    first_theta: float

    @property
    def domain(self) -> tuple[float, float]:
        """The range of s."""
        low, high = self.surface.domain[0]
        return low + self.first_s, high + self.first_s

    def jet(self, u: Floats, v: Floats) -> Jet:
        """Return the 2-jet at s = u and theta = v, each (n,) float; SurfaceError outside the web."""
        return self.surface.jet(u - self.first_s, v - self.first_theta)


@dataclass(frozen=True, eq=False)
class StartWeb:
    """A web over a shell and two steps more on every side, with the goals of its design, and where row 0 begins."""

    web: Web
    goals: Goals
    step: float
    first_s: float
    first_theta: float


def start_web(design: Design, wish: Optimise, chart: AsymptoticChart, crown: float) -> StartWeb:
    """Return the web that the optimiser starts with; ``crown`` is s on the middle line where the shells meet.

    Each step of the pattern is cut into ``wish.cells``; the crown is a vertex and is held over the centre of the
    vault at the height that the design asks for. SurfaceError if the meridian is too short for the margins.
    """
    cell = design.step / wish.cells
    margin = _MARGIN_STEPS * wish.cells
    crown_row = margin + round(crown / cell)
    above = math.ceil((crown / cell + margin) / wish.cells) * wish.cells
    columns = (design.pattern.geodesics - 1) * wish.cells + 2 * margin + 1
    first_theta = -design.half_sector - margin * cell
    s = cell * np.arange(-margin, above + 1, dtype=np.float64)
    theta = first_theta + cell * np.arange(columns, dtype=np.float64)
    web = sampled_web(chart, s, theta)
    points: tuple[PointGoal, ...] = ()
    if wish.crown_height is not None:
        points = (PointGoal(crown_row, columns // 2, (0.0, 0.0, wish.crown_height)),)
    goals = Goals(
        angle=math.radians(180.0 - wish.node_angle_deg),
        bottom_row=margin,
        points=points,
        closeness=wish.closeness,
        min_radius=wish.min_radius,
        weights={str(name): weight for name, weight in wish.weights.items()},
        max_twist=None if wish.max_twist_deg_per_m is None else math.radians(wish.max_twist_deg_per_m) / 1000.0,
    )
    return StartWeb(web, goals, cell, -margin * cell, first_theta)


def web_chart(start: StartWeb, web: Web) -> WebChart:
    """Return the chart of the surface interpolated through an optimised web."""
    return WebChart(interpolated_surface(web, start.step), start.first_s, start.first_theta)
