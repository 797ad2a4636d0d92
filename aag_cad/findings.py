"""What a check finds: one record for the audit and for everything that feeds it."""

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any, Literal, TypeAlias

from aag_cad.language import Language, Sentence, figure, printed, say

Severity: TypeAlias = Literal["error", "warning", "note"]

_ORDER: dict[Severity, int] = {"error": 0, "warning": 1, "note": 2}


@dataclass(frozen=True)
class Finding:
    """One finding: a code, how bad it is, the mark, the figure found and allowed with its unit, and the remedy.

    What plans find is said in the language of the reader (``finding_row``); what the audit finds, in English.
    """

    code: str
    severity: Severity
    mark: str
    what: Sentence
    found: float
    allowed: float
    unit: str
    remedy: Sentence

    @property
    def text(self) -> str:
        """The finding in one line of English."""
        text: str = finding_row(self)["text"]
        return text


def finding_row(finding: Finding, language: Language = "en") -> dict[str, Any]:
    """Return a finding as plain data in a language: its fields, and ``text``, all of it in one line."""
    unit = f" {finding.unit}" if finding.unit else ""
    found, allowed = (figure(f"{value:.4g}", language) + unit for value in (finding.found, finding.allowed))
    what, remedy = printed(finding.what, language), printed(finding.remedy, language)
    line = say(
        language, "booklet.findings.line", mark=finding.mark, what=what, found=found, allowed=allowed, remedy=remedy
    )
    return {**asdict(finding), "what": what, "remedy": remedy, "text": line}


def worst_first(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """Return findings sorted: errors first, then by code and mark."""
    return tuple(sorted(findings, key=lambda f: (_ORDER[f.severity], f.code, f.mark, printed(f.what, "en"))))
