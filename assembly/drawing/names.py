"""What parts, families and phases are called in print, in the language of the reader."""

from aag_cad.families import Family
from aag_cad.language import Language, printed, say
from aag_cad.parts.model import Part
from assembly.base.names import part_text
from assembly.base.phases import Phase, is_down


def phase_name(phase: Phase, language: Language = "en") -> str:
    """Return the short name of a phase, of putting together or of taking down."""
    return say(language, f"{'down' if is_down(phase) else 'phases'}.{phase}.name")


def family_name(family: Family, language: Language = "en") -> str:
    """Return the letters of a family of planks and what they are called: ``A1 lower beam``."""
    return f"{family} {say(language, f'parts.family.{family}')}"


def part_name(part: Part, language: Language = "en") -> str:
    """Return the name of ``part_text`` in a language."""
    return printed(part_text(part), language)
