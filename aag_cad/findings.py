"""What a check finds: one record for the audit and for everything that feeds it."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, TypeAlias

Severity: TypeAlias = Literal["error", "warning", "note"]

_ORDER: dict[Severity, int] = {"error": 0, "warning": 1, "note": 2}


@dataclass(frozen=True)
class Finding:
    """One finding: a code, how bad it is, the mark, the figure found and allowed with its unit, and the remedy."""

    code: str
    severity: Severity
    mark: str
    what: str
    found: float
    allowed: float
    unit: str
    remedy: str

    @property
    def text(self) -> str:
        """The finding in one line."""
        unit = f" {self.unit}" if self.unit else ""
        return f"{self.mark}: {self.what} {self.found:.4g}{unit}, allowed {self.allowed:.4g}{unit}; {self.remedy}"


def worst_first(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """Return findings sorted: errors first, then by code and mark."""
    return tuple(sorted(findings, key=lambda f: (_ORDER[f.severity], f.code, f.mark, f.what)))
