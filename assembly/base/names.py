"""What parts, phases and figures are called in print, in the language of the reader."""

from typing import TypeAlias

from aag_cad.families import Family
from aag_cad.language import Language, figure, say
from aag_cad.parts.model import (
    Blade,
    Bolt,
    ClampingBar,
    CouplingBlock,
    Footing,
    Mullion,
    Part,
    Plank,
    Rod,
    Screw,
    Shoe,
    Strap,
    Strip,
    Stud,
)
from aag_cad.parts.quantities import sizes
from assembly.base.steps import DOWN_PHASES, Phase

_Bar: TypeAlias = Plank | Mullion | ClampingBar | Strap | Shoe | Blade
_BARS: dict[type[_Bar], str] = {
    Plank: "plank", Mullion: "mullion", ClampingBar: "clamp", Strap: "strap", Shoe: "shoe", Blade: "blade",
}  # fmt: skip


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

    def named(name: str, **figures: float) -> str:
        return say(language, f"parts.names.{name}", **{k: figure(f"{v:g}", language) for k, v in figures.items()})

    length, width, thick = sizes(part)
    match part:
        case Stud():
            return named("stud", across=part.across_flats, length=part.length)
        case CouplingBlock():
            return named("block", length=length, width=width, thick=thick)
        case Bolt():
            return named("bolt", diameter=part.diameter, length=length)
        case Screw():
            return named("screw", diameter=part.diameter, length=length)
        case Rod():
            return named("rod", diameter=part.diameter, length=length)
        case Footing():
            return named("footing", length=part.length, width=part.width, height=part.height)
        case Strip():
            return named("strip", thick=part.thickness)
        case _:
            return named(_BARS[type(part)], width=width, thick=thick)
