"""Frames as plain data: nodes, beam elements, rigid links with pins, supports, springs and loads; mm, N, N/mm2.

Every node has six degrees of freedom in global axes: x, y, z (displacements, mm) and rx, ry, rz (rotations, radians).
"""

from dataclasses import dataclass
from typing import Literal, TypeAlias

from aag_cad.errors import AagError
from aag_cad.units import Vector

Dof: TypeAlias = Literal["x", "y", "z", "rx", "ry", "rz"]
DOFS: tuple[Dof, ...] = ("x", "y", "z", "rx", "ry", "rz")
ORIGIN: Vector = (0.0, 0.0, 0.0)


class FrameError(AagError, ValueError):
    """A frame that is not well posed: a mechanism, an unknown node, an element without length."""


@dataclass(frozen=True)
class FrameSection:
    """A cross-section: area mm2, torsion constant mm4, second moments of area about local y and local z, mm4."""

    area: float
    torsion: float
    inertia_y: float
    inertia_z: float


@dataclass(frozen=True)
class FrameMaterial:
    """Young's modulus and shear modulus, N/mm2."""

    modulus: float
    shear_modulus: float


@dataclass(frozen=True)
class FrameNode:
    """A node: its mark and its point, mm."""

    mark: str
    point: Vector


@dataclass(frozen=True)
class FrameElement:
    """A straight beam from ``start`` to ``end`` (marks of nodes).

    The offsets are rigid arms from the nodes to the ends of the flexible part, in global axes, mm. Local x runs along
    it, local z is ``direction`` made square to x, local y = z x x. ``start_releases`` and ``end_releases`` are the
    local degrees of freedom that an end does not hand on to its node.
    """

    mark: str
    start: str
    end: str
    section: FrameSection
    material: FrameMaterial
    direction: Vector
    start_offset: Vector = ORIGIN
    end_offset: Vector = ORIGIN
    start_releases: tuple[Dof, ...] = ()
    end_releases: tuple[Dof, ...] = ()


@dataclass(frozen=True)
class RigidLink:
    """A rigid arm: ``slave`` moves with ``master``; with a ``pin`` it may still turn about that direction at its node.

    A slave has one master; a master may be the slave of another node.
    """

    master: str
    slave: str
    pin: Vector | None = None


@dataclass(frozen=True)
class Support:
    """The degrees of freedom that are held at a node which is no slave."""

    node: str
    held: tuple[Dof, ...] = DOFS


@dataclass(frozen=True)
class Spring:
    """A spring from a node to the ground along a direction, N/mm, or about it if it is ``turning``, N mm/rad."""

    node: str
    direction: Vector
    stiffness: float
    turning: bool = False


@dataclass(frozen=True)
class NodalLoad:
    """Force (N) and moment (N mm) on a node, in global axes."""

    node: str
    force: Vector
    moment: Vector = ORIGIN


@dataclass(frozen=True)
class LineLoad:
    """An even load on the flexible part of an element, N per mm of its length, in global axes."""

    element: str
    force: Vector


@dataclass(frozen=True)
class FrameModel:
    """A frame; the marks of its nodes are unique, and so are those of its elements."""

    nodes: tuple[FrameNode, ...]
    elements: tuple[FrameElement, ...]
    links: tuple[RigidLink, ...] = ()
    supports: tuple[Support, ...] = ()
    springs: tuple[Spring, ...] = ()


def rectangle_section(height: float, width: float) -> FrameSection:
    """Return the section of a rectangle, ``height`` along local z and ``width`` along local y, mm.

    The torsion constant is a b^3 (1/3 - 0.21 b/a (1 - b^4 / 12 a^4)), a the longer side (Roark, table 10.7, to 0.5 %).
    """
    long, short = max(height, width), min(height, width)
    slender = short / long
    torsion = long * short**3 * (1.0 / 3.0 - 0.21 * slender * (1.0 - slender**4 / 12.0))
    return FrameSection(height * width, torsion, width * height**3 / 12.0, height * width**3 / 12.0)
