"""What parts are called in print, as sentences in no language yet."""

from collections.abc import Mapping
from typing import Any

from aag_cad.language import Sentence, Text, text, words_table
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


def kind_text(kind: str) -> Sentence:
    """Return the word for a kind of part; a kind that the tables do not know stands as it is."""
    return text(f"explain.kinds.{kind}") if kind in words_table("explain")["kinds"] else kind


def node_text(node: Mapping[str, Any]) -> Sentence:
    """Return what a part of a graph is called: a plank by its section where its node has one, and else by its kind."""
    width, depth = node.get("width_mm"), node.get("depth_mm")
    if width is None or depth is None:
        return kind_text(node["kind"])
    return text("parts.names.section", kind=kind_text(node["kind"]), width=max(width, depth), thick=min(width, depth))
