"""Purchase list and cutting list as CSV: one header line, LF; lengths in mm or m as named, masses in kg."""

from collections.abc import Iterator
from pathlib import Path

from aag_cad.files import write_csv
from aag_cad.shop.purchases import CutStock, Purchase, Purchases

PURCHASES_HEADER = (
    "item", "size_mm", "standard", "quantity", "unit", "length_m", "volume_m3", "mass_kg", "for",
)  # fmt: skip
CUTTING_HEADER = (
    "stock", "number", "stock_length_mm", "position_mm", "cut_length_mm", "mark", "length_mm", "piece", "note",
)  # fmt: skip


def purchase_row(line: Purchase) -> tuple[str, ...]:
    """Return one line of the purchase list, in the order of ``PURCHASES_HEADER``."""
    return (
        line.item,
        line.size,
        line.standard,
        str(line.quantity),
        line.unit,
        f"{line.length_m:.3f}" if line.length_m else "",
        f"{line.volume_m3:.4f}" if line.volume_m3 else "",
        f"{line.mass_kg:.2f}",
        line.use,
    )


def _cut_rows(cut: CutStock) -> Iterator[tuple[str, ...]]:
    for number, board in enumerate(cut.plan.boards, start=1):
        for place in board.cuts:
            for piece in place.pieces:
                yield (
                    f"{cut.item} {cut.section}",
                    str(number),
                    f"{board.length:g}",
                    f"{place.position:.1f}",
                    f"{place.length:.1f}",
                    piece.mark,
                    f"{piece.length:.1f}",
                    f"{piece.number}/{piece.of}",
                    "" if piece.of == 1 else "finger-jointed",
                )


def cutting_rows(purchases: Purchases) -> Iterator[tuple[str, ...]]:
    """Yield the cutting list in the order of ``CUTTING_HEADER``: old planks, boards, bars, then sheets.

    Pieces with the same position on a board are split from one cut; each is then cut to its own length.
    """
    for item in purchases.reused:
        notes = [note for note, holds in (("turned", item.turned), ("face down", item.face_down)) if holds]
        length = f"{item.length:.1f}"
        yield "old plank", item.old, "", f"{item.start:.1f}", length, item.mark, length, "1/1", ", ".join(notes)
    for cut in purchases.cut:
        yield from _cut_rows(cut)
    name = f"{purchases.sheet} {purchases.sheets.width:g}"
    for number, sheet in enumerate(purchases.sheets.sheets, start=1):
        for strip in sheet.strips:
            note = f"across {strip.y:.1f}" + (", turned" if strip.turned else "")
            yield name, str(number), f"{sheet.length:g}", f"{strip.x:.1f}", "", strip.mark, "", "1/1", note


def write_purchases(purchases: Purchases, folder: Path) -> None:
    """Write the purchase list, without spares, and the cutting list, a line for every piece; FileError if it cannot."""
    write_csv(folder / "purchases.csv", PURCHASES_HEADER, map(purchase_row, purchases.lines))
    write_csv(folder / "cutting.csv", CUTTING_HEADER, cutting_rows(purchases))
