"""What a shell weighs, by what it is made of, beside the figures of the built vault (paper section 3.2)."""

from collections import Counter
from dataclasses import dataclass

from aag_cad.parts.kinds import Material, kind_of
from aag_cad.parts.model import Gridshell, ridge_parts, shell_parts
from aag_cad.parts.quantities import mass

# kg a shell: "approx. 300 kg for timber, 30 kg for steel screws and plates, and 40 kg for facade panels and aluminum
# profiles", 1100 kg for 100 m2 of roof.
PAPER_SHELL = {"timber": 300.0, "steel": 30.0, "facade": 40.0}
PAPER_ROOF_KG_PER_M2 = 11.0
PAPER_ROOF_M2 = 100.0

_GROUPS: dict[Material, str] = {"timber": "timber", "steel": "steel", "aluminium": "facade", "polycarbonate": "facade"}


@dataclass(frozen=True)
class Weight:
    """A group of materials of one shell with its share of the ridges: kg here and in the paper, and what it is."""

    group: str
    kg: float
    paper_kg: float
    parts: tuple[tuple[str, float], ...]

    @property
    def why(self) -> str:
        """What the group consists of, the heaviest first, and what is left over or short against the paper."""
        listed = ", ".join(f"{name} {kg:.0f} kg" for name, kg in self.parts)
        return f"{listed}; {self.kg - self.paper_kg:+.0f} kg against the paper's {self.paper_kg:.0f} kg"


def shell_weights(gridshell: Gridshell) -> tuple[Weight, ...]:
    """Return the weights of one shell by group: timber, steel and facade; the concrete blocks are left out.

    A shell carries its share of the blades and their bolts.
    """
    totals: dict[str, Counter[str]] = {group: Counter() for group in PAPER_SHELL}
    share = 1.0 / len(gridshell.shells)
    weighed = [(part, 1.0) for part in shell_parts(gridshell.shells[0])]
    weighed += [(part, share) for part in ridge_parts(gridshell)]
    for part, amount in weighed:
        row = kind_of(part)
        if row.material in _GROUPS:
            totals[_GROUPS[row.material]][f"{row.name}s"] += amount * mass(part, gridshell.timber)  # type: ignore[assignment]
    return tuple(
        Weight(group, float(sum(parts.values())), PAPER_SHELL[group], tuple(parts.most_common()))
        for group, parts in totals.items()
    )


def roof_weight(gridshell: Gridshell, roof_m2: float) -> float:
    """Return the weight of all shells by the area of the roof, kg/m2, without concrete blocks."""
    return len(gridshell.shells) * sum(weight.kg for weight in shell_weights(gridshell)) / roof_m2
