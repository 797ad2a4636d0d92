"""What is bought for a gridshell and how it is cut: boards, bars, sheets, fasteners and what comes ready made."""

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from aag_cad.design import Design
from aag_cad.findings import Finding
from aag_cad.parts.index import index_of
from aag_cad.parts.kinds import kind_of, shaped
from aag_cad.parts.model import FlatBar, Gridshell, JointKind, Part, all_parts
from aag_cad.parts.quantities import STEEL_DENSITY, density, mass, material_name, sizes, volume
from aag_cad.parts.shapes.folded_plate import FOLDED_PLATE
from aag_cad.parts.shapes.prism import PRISM
from aag_cad.parts.shapes.sheet import flat_pattern
from aag_cad.parts.shapes.threaded import BoltPiece
from aag_cad.parts.triangles import circle_area
from aag_cad.shop.finger_joints import FingerJoint, board_rules, plank_pieces
from aag_cad.shop.offcuts import Reused, fitting_planks, read_offcuts, reused_planks
from aag_cad.shop.sheets import SheetPlan, SheetRules, SheetUse, sheet_plan
from aag_cad.shop.stock import Board, CuttingPlan, Piece, StockRules, cutting_plan
from aag_cad.units import MM3_PER_M3, MM_PER_M

_USES: dict[JointKind, str] = {
    "AA": "AA nodes",
    "AG": "AG crossings",
    "boundary": "edge planks",
    "foot": "feet",
    "footing": "footings",
    "ridge": "ridge ends",
    "blade": "ridge blades",
    "cover": "cover",
}


@dataclass(frozen=True)
class Purchase:
    """A line of the purchase list; lengths and volumes are 0 where nobody buys by them."""

    item: str
    size: str
    standard: str
    quantity: int
    unit: str
    length_m: float
    volume_m3: float
    mass_kg: float
    use: str


@dataclass(frozen=True)
class CutStock:
    """Boards or bars of one section: what they are, width and thickness in mm, density in kg/m3, and their cuts.

    ``standing`` is the volume of the parts before drilling that come out of them, mm3.
    """

    item: str
    width: float
    thickness: float
    standard: str
    density: float
    use: str
    plan: CuttingPlan
    standing: float

    @property
    def section(self) -> str:
        """The section as it is ordered, thickness first."""
        return f"{self.thickness:g} x {self.width:g}"


@dataclass(frozen=True)
class Purchases:
    """All that is bought, how it is cut, what is cut from old planks, and what the stock cannot give."""

    cut: tuple[CutStock, ...]
    sheets: SheetPlan
    sheet: str
    reused: tuple[Reused, ...]
    finger_joints: tuple[FingerJoint, ...]
    refused: tuple[Finding, ...]
    lines: tuple[Purchase, ...]


def _section(part: Part) -> tuple[float, float]:
    """Return width and thickness of the bar that a part is cut from.

    A hexagonal stud is planed from a bar as thick as its flats are apart and as wide as its corners.
    """
    _length, width, thickness = sizes(part)
    return float(math.ceil(width * 2.0 / math.sqrt(3.0))) if kind_of(part).shape is PRISM else width, thickness


def _plural(parts: Iterable[Part]) -> str:
    return ", ".join(f"{name}s" for name in sorted({kind_of(part).name for part in parts}))


def _bars(gridshell: Gridshell, design: Design) -> tuple[list[CutStock], list[Finding]]:
    """Return the bars of timber, aluminium and steel with their cuts, and the parts that are longer than all bars."""
    stock = design.stock
    groups: dict[tuple[str, float, float, str], list[Part]] = defaultdict(list)
    for part in all_parts(gridshell):
        if (bought := kind_of(part).bought).source == "bar":
            groups[bought.item, *_section(part), bought.standard].append(part)
    bars, refused = [], []
    for (item, width, thickness, standard), parts in sorted(groups.items()):
        key = "bar_lengths" if item == "timber bar" else "metal_lengths"
        rules = StockRules(stock.bar_lengths if key == "bar_lengths" else stock.metal_lengths, stock.kerf, stock.trim)
        plan = cutting_plan((Piece(part.mark, sizes(part)[0]) for part in parts), rules)
        name = item.replace("timber", material_name(parts[0], gridshell.timber))
        held = {piece.mark for piece in plan.refused}
        net = math.fsum(volume(part) for part in parts if part.mark not in held)
        bars.append(
            CutStock(name, width, thickness, standard, density(parts[0], gridshell.timber), _plural(parts), plan, net)
        )
        remedy = f"add a longer bar to stock.{key}"
        refused += [
            Finding("AAG901", "error", piece.mark, f"longer than what the longest {item} gives,", piece.length,
                    rules.longest_cut, "mm", remedy)
            for piece in plan.refused
        ]  # fmt: skip
    return bars, refused


def _boards(
    planks: Sequence[FlatBar], gridshell: Gridshell, design: Design
) -> tuple[CutStock, tuple[FingerJoint, ...], tuple[Finding, ...]]:
    """Return the boards for new planks with their cuts, their finger joints, and the planks that no board gives."""
    stock, timber, bought = design.stock, design.timber, kind_of(gridshell.shells[0].planks[0]).bought
    pieces, joints, refused = plank_pieces(planks, stock)
    made = {piece.mark for piece in pieces}
    thick = stock.planks_per_board * timber.thickness + (stock.planks_per_board - 1) * stock.split_kerf
    board = CutStock(
        item=f"{gridshell.timber.species} {gridshell.timber.strength_class} {bought.item}",
        width=timber.width,
        thickness=stock.board_thickness or thick,
        standard=bought.standard,
        density=gridshell.timber.density,
        use="planks",
        plan=cutting_plan(pieces, board_rules(stock)),
        standing=math.fsum(volume(plank) for plank in planks if plank.mark in made),
    )
    return board, joints, refused


def _by_length(
    bought: Iterable[Board | SheetUse], item: str, section: tuple[float, float], standard: str, density: float, use: str
) -> list[Purchase]:
    """Return a line for each length of boards, bars or sheets of one section (width, thickness)."""
    lines, (width, thickness) = [], section
    for length, count in sorted(Counter(board.length for board in bought).items()):
        cubic = count * length * width * thickness / MM3_PER_M3
        size, metres = f"{thickness:g} x {width:g} x {length:g}", count * length / MM_PER_M
        lines.append(Purchase(item, size, standard, count, "pcs", metres, cubic, cubic * density, use))
    return lines


def _in_boxes(part: Part) -> Iterator[tuple[tuple[str, str, str], int, float]]:
    """Yield ((item, size, standard), quantity, volume of all in mm3) of what is bought for a fastener."""
    bought, (_shape, form) = kind_of(part).bought, shaped(part)
    shank, thread = circle_area(form.diameter), f"M{form.diameter:g}"
    named: dict[str, list[BoltPiece]] = defaultdict(list)
    for piece in form.pieces:
        named[piece.name].append(piece)
    size = f"{thread if named['nut'] else f'{form.diameter:g}'} x {form.length:g}"
    yield (bought.item, size, bought.standard), 1, shank * form.length + sum(head.volume for head in named["head"])
    for name, item, standard in (("nut", "hexagon nut", "ISO 4032"), ("washer", "washer", bought.washers)):
        if around := named[name]:
            yield (item, thread, standard), len(around), sum(p.volume - shank * (p.high - p.low) for p in around)


def _fastener_lines(gridshell: Gridshell) -> list[Purchase]:
    joints = index_of(gridshell).joint_of_fastener
    counts: Counter[tuple[str, str, str]] = Counter()
    volumes: dict[tuple[str, str, str], list[float]] = defaultdict(list)
    uses: dict[tuple[str, str, str], set[str]] = defaultdict(set)
    for part in (part for part in all_parts(gridshell) if kind_of(part).bought.source == "box"):
        for key, quantity, cubic in _in_boxes(part):
            counts[key] += quantity
            volumes[key].append(cubic)
            uses[key] |= {_USES[joints[part.mark].kind]} if part.mark in joints else set()
    return [
        Purchase(*key, counts[key], "pcs", 0.0, 0.0, math.fsum(volumes[key]) * STEEL_DENSITY / MM3_PER_M3,
                 ", ".join(sorted(uses[key])))
        for key in sorted(counts)
    ]  # fmt: skip


def _ready_made_lines(gridshell: Gridshell) -> list[Purchase]:
    """Return what is ordered by the piece: folded steel plates by their flat size, concrete blocks."""
    groups: dict[tuple[str, str, str], list[Part]] = defaultdict(list)
    for part in all_parts(gridshell):
        row, (length, width, thickness) = kind_of(part), sizes(part)
        if row.bought.source == "piece":
            flat = row.shape is FOLDED_PLATE
            size = f"{thickness:g} x {width:g} x {length:.0f}" if flat else f"{length:g} x {width:g} x {thickness:g}"
            groups[row.bought.item, size, row.bought.standard].append(part)
    lines = []
    for (item, size, standard), parts in sorted(groups.items()):
        cubic = math.fsum(volume(part) for part in parts) / MM3_PER_M3
        weight = math.fsum(mass(part, gridshell.timber) for part in parts)
        use = f"{kind_of(parts[0]).key}s"
        lines.append(Purchase(item, size, standard, len(parts), "pcs", 0.0, cubic, weight, use))
    return lines


def purchases_of(gridshell: Gridshell, design: Design) -> Purchases:
    """Return what is bought for a gridshell, without spares, and how it is cut.

    Planks come from the old planks of ``stock.offcuts`` first, as many metres as these give, then from boards.
    FileError if the table of old planks cannot be read.
    """
    stock = design.stock
    planks = tuple(index_of(gridshell).planks.values())
    strips = [strip for shell in gridshell.shells for strip in shell.strips]
    old, refused_old = fitting_planks(read_offcuts(Path(stock.offcuts)) if stock.offcuts else (), design.timber)
    reused = reused_planks(planks, old, stock) if old else ()
    done = {item.mark for item in reused}
    board, joints, too_long = _boards([plank for plank in planks if plank.mark not in done], gridshell, design)
    bars, too_long_bars = _bars(gridshell, design)
    outlines = [(strip.mark, flat_pattern(strip).outline) for strip in strips]
    sheets = sheet_plan(outlines, SheetRules(design.facade.sheet_width, design.facade.sheet_lengths, stock.sheet_gap))
    lines: list[Purchase] = []
    for cut in (board, *bars):
        section = cut.width, cut.thickness
        lines += _by_length(cut.plan.boards, cut.item, section, cut.standard, cut.density, cut.use)
    sheet = kind_of(strips[0]).bought if strips else None
    if sheet:
        section = sheets.width, strips[0].thickness
        lines += _by_length(sheets.sheets, sheet.item, section, sheet.standard, strips[0].density, _plural(strips))
    if reused:
        timber = design.timber
        metres = math.fsum(item.length for item in reused) / MM_PER_M
        cubic = metres * timber.thickness * timber.width / 1e6
        count = len({item.old for item in reused})
        size, weight = f"{timber.thickness:g} x {timber.width:g}", cubic * timber.density
        lines.append(Purchase("old plank", size, "", count, "pcs", metres, cubic, weight, "planks"))
    lines += _fastener_lines(gridshell) + _ready_made_lines(gridshell)
    refused = (*refused_old, *too_long, *too_long_bars)
    return Purchases((board, *bars), sheets, sheet.item if sheet else "", reused, joints, refused, tuple(lines))


def _bought_summary(plan: CuttingPlan | SheetPlan, pieces: Sequence[Board | SheetUse], **own: float) -> dict[str, Any]:
    """Return how much is bought in which lengths, what is ``own`` to boards or sheets, the bound, and its proof."""
    return {
        "bought_m": round(plan.bought / MM_PER_M, 3),
        **own,
        "pieces": {f"{length:g}": count for length, count in sorted(Counter(p.length for p in pieces).items())},
        "bound_m": round(plan.bound / MM_PER_M, 3),
        "proven": plan.proven,
        "first_fit_decreasing_m": round(plan.first_fit_decreasing / MM_PER_M, 3),
        "refused": len(plan.refused),
    }


def _cut_summary(cut: CutStock) -> dict[str, Any]:
    plan = cut.plan
    bought = plan.bought * cut.width * cut.thickness
    return _bought_summary(
        plan,
        plan.boards,
        used_m=round(plan.used / MM_PER_M, 3),
        waste_m=round(plan.waste / MM_PER_M, 3),
        waste_percent=round(plan.waste_percent, 2),
        waste_percent_of_volume=round(100.0 * (1.0 - cut.standing / bought), 2) if bought else 0.0,
    )


def stock_summary(purchases: Purchases) -> dict[str, Any]:
    """Return for each thing that is cut how much is bought, used and wasted, with the bound and whether it is proven.

    Lengths in metres; those of boards and bars are of the board or bar, those of sheets along the ribs.
    """
    table: dict[str, Any] = {f"{cut.item} {cut.section}": _cut_summary(cut) for cut in purchases.cut}
    sheets = purchases.sheets
    if sheets.sheets:
        waste = round(sheets.waste_percent, 2)
        table[f"{purchases.sheet} {sheets.width:g}"] = _bought_summary(
            sheets, sheets.sheets, waste_percent_of_area=waste
        )
    table["old planks"] = {
        "planks": len(purchases.reused),
        "used_m": round(math.fsum(item.length for item in purchases.reused) / MM_PER_M, 3),
    }
    table["finger joints"] = len(purchases.finger_joints)
    return table
