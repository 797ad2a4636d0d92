"""What parts, phases and figures are called in print, in the language of the reader."""

from aag_cad.families import Family
from aag_cad.language import Language, figure, say
from aag_cad.parts.kinds import kind_of
from aag_cad.parts.model import Part
from aag_cad.parts.quantities import sizes
from assembly.base.steps import DOWN_PHASES, Phase

# The key of the words that say where a layer lies.
LAYER_WORDS = {-1: "below", 0: "between", 1: "above"}


def phase_name(phase: Phase, language: Language = "en") -> str:
    """Return the short name of a phase, of putting together or of taking down."""
    return say(language, f"{'down' if phase in DOWN_PHASES else 'phases'}.{phase}.name")


def family_name(family: Family, language: Language = "en") -> str:
    """Return the letters of a family of planks and what they are called: ``A1 lower beam``."""
    return f"{family} {say(language, f'parts.family.{family}')}"


def part_name(part: Part, language: Language = "en") -> str:
    """Return what pieces of one make have in common, whatever their lengths: e.g. ``Plank 100 x 12``, ``Bolt M8 x 80``.

    The names of the product in the language of the files are those of ``aag_cad.parts.products``.
    """
    length, width, thick = (figure(f"{size:g}", language) for size in sizes(part))
    return say(language, f"parts.names.{kind_of(part).key}", length=length, width=width, thick=thick)
