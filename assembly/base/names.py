"""What parts, phases and figures are called in print, in the language of the reader."""

from aag_cad.families import Family
from aag_cad.language import Language, Text, printed, say, text
from aag_cad.parts.kinds import kind_of
from aag_cad.parts.model import Part
from aag_cad.parts.quantities import sizes
from assembly.base.phases import Phase, is_down

# The key of the words that say where a layer lies.
LAYER_WORDS = {-1: "below", 0: "between", 1: "above"}


def phase_name(phase: Phase, language: Language = "en") -> str:
    """Return the short name of a phase, of putting together or of taking down."""
    return say(language, f"{'down' if is_down(phase) else 'phases'}.{phase}.name")


def family_name(family: Family, language: Language = "en") -> str:
    """Return the letters of a family of planks and what they are called: ``A1 lower beam``."""
    return f"{family} {say(language, f'parts.family.{family}')}"


def part_name(part: Part, language: Language = "en") -> str:
    """Return the name of ``part_text`` in a language."""
    return printed(part_text(part), language)


def part_text(part: Part) -> Text:
    """Return what pieces of one make have in common, whatever their lengths: e.g. ``Plank 100 x 12``, ``Bolt M8 x 80``.

    The names of the product in the language of the files are those of ``aag_cad.parts.products``.
    """
    length, width, thick = map(float, sizes(part))
    return text(f"parts.names.{kind_of(part).key}", length=length, width=width, thick=thick)
