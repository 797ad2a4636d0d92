"""What a check finds: one record for the audit and for everything that feeds it."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

Severity: TypeAlias = Literal["error", "warning", "note"]


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
