"""The families of curves and planks: one row for each, which everything that differs by family reads."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

Family: TypeAlias = Literal["A1", "A2", "G", "E"]
CurveKind: TypeAlias = Literal["asymptotic", "geodesic", "edge"]


@dataclass(frozen=True)
class FamilyRow:
    """Which curves a family has, its layer (-1, 0 or +1 along the outward normal), and its colour in the legend.

    ``minutes`` is the key of the crew's time for handling one of its planks (``aag_cad.design_making.Minutes``). Its
    words in every language stand in ``templates/printouts/words/parts.toml`` under ``family``.
    """

    curve: CurveKind
    layer: int
    colour: str
    minutes: str

    @property
    def upright(self) -> bool:
        """Whether planks stand on the surface, coupled in pairs to beams; the others lie flat in it, one by one."""
        return self.curve == "asymptotic"


FAMILIES: dict[Family, FamilyRow] = {
    "A1": FamilyRow("asymptotic", -1, "#1d3a6b", "plank"),
    "A2": FamilyRow("asymptotic", 1, "#d9683a", "plank"),
    "G": FamilyRow("geodesic", 0, "#e3b040", "geodesic"),
    "E": FamilyRow("edge", 0, "#2f6c58", "edge_plank"),
}


def _along(curve: CurveKind) -> tuple[Family, ...]:
    return tuple(family for family, row in FAMILIES.items() if row.curve == curve)


# The family of each layer that is laid flat, from the lowest up.
LAYERS: dict[int, Family] = {FAMILIES[family].layer: family for family in ("A1", "G", "A2")}
BEAMS, GEODESICS, EDGES = _along("asymptotic"), _along("geodesic"), _along("edge")
