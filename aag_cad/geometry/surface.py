"""Surfaces as 2-jets, and their normals."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from aag_cad.units import Floats


@dataclass(frozen=True, eq=False)
class Jet:
    """Point and partial derivatives to second order of a surface X(u, v); each (n, 3) float, mm."""

    point: Floats
    du: Floats
    dv: Floats
    duu: Floats
    duv: Floats
    dvv: Floats


class Surface(Protocol):
    """Any C2 surface X(u, v)."""

    def jet(self, u: Floats, v: Floats) -> Jet:
        """Return the 2-jet at the parameters u, v, each (n,) float."""
        ...


class Chart(Surface, Protocol):
    """A surface in the parameters (s, theta): A lines theta = c +- s, G lines theta = const, bottom curve s = 0."""

    @property
    def domain(self) -> tuple[float, float]:
        """The range of s."""
        ...


def dot(a: Floats, b: Floats) -> Floats:
    """Return the row-wise scalar product of two (n, 3) arrays as (n,)."""
    return np.asarray(np.einsum("ij,ij->i", a, b), dtype=np.float64)


def unit(a: Floats) -> Floats:
    """Return the rows of an (n, 3) array scaled to length 1."""
    return np.asarray(a / np.linalg.norm(a, axis=-1, keepdims=True), dtype=np.float64)


def unit_normals(jet: Jet) -> Floats:
    """Return the unit normals X_u x X_v / |X_u x X_v|, (n, 3)."""
    return unit(np.cross(jet.du, jet.dv))
