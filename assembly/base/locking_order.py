"""The order in which the flat planks of a hoisted shell are fixed, as plain data."""

import math
from dataclasses import dataclass
from typing import TypeAlias


@dataclass(frozen=True)
class Prop:
    """A prop proposed under a joint: how far it sinks without it, mm, and the force on it with all props, N."""

    joint: str
    sinking: float
    force: float


Group: TypeAlias = tuple[str, ...]


@dataclass(frozen=True)
class LockingStep:
    """A shell after a step: the planks fixed in it (none: just hoisted), and what that leaves.

    ``eigenvalues`` are the lowest ones of K v = lambda M v, 1/s2; ``soft_modes`` how many are below the threshold of
    the order; ``displacement`` the largest under self-weight, mm, at joint ``at``. ``props`` are proposed where a soft
    mode is left and the displacement exceeds the limit; ``propped`` is the displacement with them, mm.
    """

    marks: Group
    eigenvalues: tuple[float, ...]
    soft_modes: int
    displacement: float
    at: str
    props: tuple[Prop, ...]
    propped: float


@dataclass(frozen=True)
class LockingOrder:
    """The order of fixing of a shell: first the state after hoisting, then a step for each group of planks.

    ``feet`` are held in x, y and z, the studs ``hoists`` in z. A mode is soft if its eigenvalue is below ``threshold``,
    1/s2. ``released`` is the shell with all planks fixed, all bolts tightened and the props at the hoists away.
    ``area`` is the sum of the lowest eigenvalue over the steps, ``free_area`` that of the order found without the rule
    that edge planks come first: ``rule_price`` is the share that the rule costs.
    """

    shell: str
    feet: tuple[str, ...]
    hoists: tuple[str, ...]
    edges_first: bool
    threshold: float
    limit: float
    steps: tuple[LockingStep, ...]
    released: LockingStep
    area: float
    free_area: float

    @property
    def rule_price(self) -> float:
        """The share of the area under the lowest eigenvalue that is lost by fixing the edge planks first."""
        return 1.0 - self.area / self.free_area


def frequency(eigenvalue: float) -> float:
    """Return the frequency in Hz of an eigenvalue in 1/s2; 0 for one that rounding left below 0."""
    return math.sqrt(max(0.0, eigenvalue)) / (2.0 * math.pi)
