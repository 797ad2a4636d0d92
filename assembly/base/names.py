"""What parts are called in print, as sentences in no language yet."""

from aag_cad.language import Text, text
from aag_cad.parts.kinds import kind_of
from aag_cad.parts.model import Part
from aag_cad.parts.quantities import sizes

# The key of the words that say where a layer lies.
LAYER_WORDS = {-1: "below", 0: "between", 1: "above"}


def part_text(part: Part) -> Text:
    """Return what pieces of one make have in common, whatever their lengths: e.g. ``Plank 100 x 12``, ``Bolt M8 x 80``.

    The names of the product in the language of the files are those of ``aag_cad.parts.products``.
    """
    length, width, thick = map(float, sizes(part))
    return text(f"parts.names.{kind_of(part).key}", length=length, width=width, thick=thick)
