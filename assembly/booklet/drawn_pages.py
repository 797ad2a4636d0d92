"""Pages of the booklet that are no cards: maps of the marks, laying plans, locking, segments."""

from collections.abc import Sequence
from typing import Any

from aag_cad.language import Language, figure, say
from aag_cad.parts.index import index_of
from aag_cad.parts.model import Gridshell
from assembly.base.locking_order import LockingOrder
from assembly.base.mark_ranges import joined_ranges
from assembly.base.segments import Segmentation
from assembly.booklet.segment_cards import segment_cards
from assembly.pictures.label_map import MAP_SIZE, label_map_svg
from assembly.pictures.layer_legend import layer_legend_svg
from assembly.pictures.laying_plan import laying_header, laying_plan_svg, laying_rows
from assembly.pictures.locking_chart import locking_svg, locking_table
from assembly.pictures.segment_picture import segment_svg
from assembly.plan.planned import Planned

# The joints on each map: those that a crew looks for on the whole shell, and the many blocks on one of their own.
_MAPS = (("N", "F", "R"), ("K",))
# The first stands above the legend on an upright page, at nine tenths of this size (tenths of a mm).
_MAP_SIZES = ((2000.0, 1660.0), MAP_SIZE)

Made = tuple[dict[str, Any], dict[str, str]]


def _twins(gridshell: Gridshell) -> dict[str, str]:
    """Return for each first shell of twins the names of all of them, as one text."""
    groups: dict[str, list[str]] = {}
    for shell, first in index_of(gridshell).twins.items():
        groups.setdefault(first, []).append(shell)
    return {first: ", ".join(shells) for first, shells in groups.items()}


def map_pages(gridshell: Gridshell, language: Language) -> Made:
    """Return the maps of the marks of each kind of shell, the first with the legend of the layers."""
    pages, pictures = [], dict[str, str]()
    for mark, names in _twins(gridshell).items():
        shell = index_of(gridshell).shells[mark]
        for i, families in enumerate(_MAPS):
            picture, legend = f"map-{shell.mark}-{i}", f"layers-{shell.mark}" if i == 0 else ""
            pictures[picture] = label_map_svg(shell, families, language, _MAP_SIZES[i])
            if legend:
                pictures[legend] = layer_legend_svg(shell, language)
            pages.append({
                "title": say(language, "booklet.map.title" if i == 0 else "booklet.map.blocks", shells=names),
                "note": say(language, "booklet.map.note", prefix=shell.mark),
                "picture": picture,
                "legend": legend,
            })  # fmt: skip
    return {"maps": pages}, pictures


def laying_pages(gridshell: Gridshell, planned: Planned, language: Language) -> Made:
    """Return the flat laying plans with their coordinates, of members and of single points; and their pictures."""
    pages, pictures = [], dict[str, str]()
    for mark, names in _twins(gridshell).items():
        shell = index_of(gridshell).shells[mark]
        if shell.mark not in planned.flat:
            continue
        state, order = planned.flat[shell.mark], planned.orders[shell.mark]
        pictures[f"laying-{shell.mark}"] = laying_plan_svg(shell, state, order, language)
        rows, head = laying_rows(shell, state, language), laying_header(language)
        pages.append({
            "title": say(language, "booklet.laying.title", shells=names),
            "table_title": say(language, "booklet.laying.table", shells=names),
            "note": say(language, "booklet.laying.note"),
            "picture": f"laying-{shell.mark}",
            "members": {"head": list(head), "rows": [list(row) for row in rows if row[-1]]},
            "points": {"head": [*head[:2], "x mm", "y mm"], "rows": [list(row[:4]) for row in rows if not row[-1]]},
        })  # fmt: skip
    return {"layings": pages}, pictures


def locking_pages(gridshell: Gridshell, orders: Sequence[LockingOrder], language: Language) -> Made:
    """Return the locking order of each kind of shell as table and plot."""
    names, pages, pictures = _twins(gridshell), [], dict[str, str]()
    for order in (order for order in orders if order.shell in names):
        pictures[f"locking-{order.shell}"] = locking_svg(order, language)
        price = figure(f"{100.0 * order.rule_price:.1f}", language)
        pages.append({
            "title": say(language, "booklet.locking.title", shells=names[order.shell]),
            "picture": f"locking-{order.shell}",
            "table": locking_table(order, language),
            "price": say(language, "booklet.locking.price", price=price) if order.edges_first else "",
            "hoists": say(language, "booklet.locking.hoists", joints=joined_ranges(order.hoists)),
        })  # fmt: skip
    return {"lockings": pages}, pictures


def segment_pages(gridshell: Gridshell, segmentation: Segmentation, language: Language) -> Made:
    """Return the pages of all segments, one each, with their pictures."""
    pages, pictures = [], dict[str, str]()
    for segment, card in zip(segmentation.segments, segment_cards(segmentation, language), strict=True):
        name = f"segment-{segment.name.replace('.', '-')}"
        pictures[name] = segment_svg(gridshell, segmentation, segment, language)
        pages.append(card | {"picture": name})
    return {"segments": pages}, pictures
