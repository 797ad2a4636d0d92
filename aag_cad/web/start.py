"""From a design to the web that the optimiser starts with."""

import math
from dataclasses import dataclass

import numpy as np

from aag_cad.design import Design
from aag_cad.design_tables import Optimise
from aag_cad.geometry.revolution import AsymptoticChart
from aag_cad.web.goals import Goals, PointGoal
from aag_cad.web.web import Web, sampled_web

_MARGIN_STEPS = 2


@dataclass(frozen=True, eq=False)
class StartWeb:
    """A web over a shell and two steps more on every side, with the goals of its design.

    ``step`` is that of the cells in s and theta, ``origin`` where row and column 0 begin: s = 0 is the bottom curve,
    theta = 0 the plane of symmetry. On the optimised web these are labels, no longer lengths or angles.
    """

    web: Web
    goals: Goals
    step: float
    origin: tuple[float, float]


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
    return StartWeb(web, goals, cell, (-margin * cell, first_theta))
