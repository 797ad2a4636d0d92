"""The words of the booklets in one language, for their templates."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any, Literal, TypeAlias

from aag_cad.findings import Finding
from aag_cad.language import Figure, Language, figure, say, words_table

Kind: TypeAlias = Literal["sequence", "disassembly"]


def booklet_words(language: Language) -> dict[str, Any]:
    """Return the words of the booklets in a language, as nested as their table."""

    def spoken(found: Any) -> Any:
        if language in found:
            return found[language]
        return {key: spoken(value) for key, value in found.items()}

    words: dict[str, Any] = spoken(words_table("booklet"))
    return words


def sheet_words(kind: Kind, language: Language, read: str = "") -> dict[str, Any]:
    """Return the words of a kind of booklet; its cards are ``read`` in a way of their own where words are given."""
    words, how = booklet_words(language), read or kind
    side = "up" if kind == "sequence" else "down"
    card = words["card"]
    return words | {
        "subtitle": words[kind],
        "foot": words[f"{kind}_foot"],
        "read": {"title": words["read"]["title"], "lines": words["read"][how]},
        "list": words["list"] | {"text": words["list"][how]},
        "card": card | {"extras": card[f"extras_{side}"], "counted": card["at_hand" if side == "up" else "stored"]},
    }


def finding_lines(findings: Iterable[Finding], language: Language) -> list[str]:
    """Return findings in lines of a language: those that say the same of several marks in one, each only once."""
    marks: dict[str, dict[str, None]] = {}
    for finding in findings:
        marks.setdefault(finding_line(replace(finding, mark="{mark}"), language), {})[finding.mark] = None
    return [line.replace("{mark}", ", ".join(named)) for line, named in marks.items()]


def finding_line(finding: Finding, language: Language) -> str:
    """Return a finding in one line of a language: mark, what was found, what is allowed, and the remedy."""
    unit = f" {finding.unit}" if finding.unit else ""
    found, allowed = (figure(f"{value:.4g}", language) + unit for value in (finding.found, finding.allowed))
    key = f"booklet.findings.{'line' if finding.allowed else 'none'}"
    told: dict[str, Figure] = {"mark": finding.mark, "what": finding.what, "remedy": finding.remedy}
    return say(language, key, found=found, allowed=allowed, **told)
