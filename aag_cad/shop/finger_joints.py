"""Where planks that are longer than every board are finger-jointed, clear of their holes."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

from aag_cad.design_making import Stock
from aag_cad.findings import Finding
from aag_cad.parts.forms import Hole
from aag_cad.parts.model import FlatBar
from aag_cad.shop.stock import Piece, StockRules

Interval: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class FingerJoint:
    """A finger joint of a plank: station of its middle and the clear wood from its fingers to the nearest hole, mm."""

    mark: str
    station: float
    clear: float


def board_rules(stock: Stock) -> StockRules:
    """Return how planks are cut from boards."""
    return StockRules(stock.lengths, stock.kerf, stock.trim, stock.planks_per_board)


def _free(length: float, holes: Sequence[Hole], stock: Stock, clear: float, avoid: Iterable[float]) -> list[Interval]:
    """Return the stretches of a plank in which the middle of a finger joint may lie."""
    reach = stock.finger_length / 2.0 + clear
    barred = [(0.0, stock.finger_spacing), (length - stock.finger_spacing, length)]
    barred += [(station - stock.finger_spacing, station + stock.finger_spacing) for station in avoid]
    for hole in holes:
        half = (hole.diameter + hole.slot) / 2.0 + reach
        barred.append((hole.station - half, hole.station + half))
    free, start = [], 0.0
    for low, high in sorted(barred):
        if low >= start:
            free.append((start, low))
        start = max(start, high)
    return free


def _farthest_first(length: float, free: Sequence[Interval], stock: Stock, longest: float) -> list[float] | None:
    """Return the stations of the fewest joints, each as far on as the longest cut allows; None if it cannot be."""
    stations: list[float] = []
    at, half = 0.0, stock.finger_length / 2.0
    while length - at + (half if stations else 0.0) > longest:
        limit = at + longest - half - (half if stations else 0.0)
        least = at + stock.finger_spacing
        places = [min(high, limit) for low, high in free if low <= limit and min(high, limit) >= least]
        if not places or max(places) <= at:
            return None
        at = max(places)
        stations.append(at)
    return stations


def joint_stations(
    length: float, holes: Sequence[Hole], stock: Stock, avoid: Sequence[float] = ()
) -> tuple[FingerJoint, ...] | None:
    """Return the fewest finger joints that make a plank of a length from the longest boards, without a mark.

    Among these they lie as far from the holes as can be, to 1 mm: EN 15497 keeps three knot diameters between a knot
    and the fingers, here ``finger_clearance`` keeps clear of every hole. ``avoid`` are the joints of the sibling. None
    if there is no such place.
    """
    longest = board_rules(stock).longest_cut

    def stations(clear: float) -> list[float] | None:
        return _farthest_first(length, _free(length, holes, stock, clear, avoid), stock, longest)

    first = stations(stock.finger_clearance)
    if first is None:
        return None
    low, high = 0, math.ceil(length)
    while high - low > 1:
        middle = (low + high) // 2
        found = stations(stock.finger_clearance + middle)
        low, high = (middle, high) if found is not None and len(found) == len(first) else (low, middle)
    best = stations(stock.finger_clearance + low) or first
    return tuple(FingerJoint("", round(station, 1), stock.finger_clearance + low) for station in best)


def _pieces(mark: str, length: float, joints: Sequence[FingerJoint], stock: Stock) -> list[Piece]:
    """Return the pieces of a jointed plank: at each joint both reach half the fingers past its middle."""
    ends = [0.0, *(joint.station for joint in joints), round(length, 1)]
    half = stock.finger_length / 2.0
    pieces = []
    for number, (start, end) in enumerate(pairwise(ends), start=1):
        inner = (number > 1) + (number < len(ends) - 1)
        pieces.append(Piece(mark, round(end - start + inner * half, 1), number, len(ends) - 1))
    return pieces


def _too_long(plank: FlatBar, joints: Sequence[FingerJoint] | None, stock: Stock) -> Finding:
    longest = board_rules(stock).longest_cut
    if joints is None:
        remedy = (
            f"no place for a finger joint {stock.finger_clearance:g} mm clear of the holes and "
            f"{stock.finger_spacing:g} mm from ends and other joints: add a longer board to stock.lengths"
        )
    else:
        where = " and ".join(f"{joint.station:.0f} mm" for joint in joints)
        remedy = (
            f"finger-joint it at {where} from its start, {joints[0].clear:g} mm clear of the holes "
            "(stock.finger_joint = true), or add a longer board to stock.lengths"
        )
    what = "longer than what the longest board gives,"
    return Finding("AAG901", "error", plank.mark, what, plank.blank.length, longest, "mm", remedy)


def plank_pieces(
    planks: Iterable[FlatBar], stock: Stock
) -> tuple[tuple[Piece, ...], tuple[FingerJoint, ...], tuple[Finding, ...]]:
    """Return what is cut for planks, where they are finger-jointed, and those that cannot be made (AAG901).

    A plank that no board holds is jointed if the stock allows it; siblings of a beam are not jointed side by side.
    """
    longest = board_rules(stock).longest_cut
    pieces: list[Piece] = []
    placed: dict[str, list[FingerJoint]] = {}
    refused = []
    for plank in sorted(planks, key=lambda plank: plank.mark):
        length = round(plank.blank.length, 1)
        if length <= longest:
            pieces.append(Piece(plank.mark, length))
            continue
        avoid = [joint.station for joint in placed.get(plank.beam, [])]
        joints = joint_stations(length, plank.blank.holes, stock, avoid)
        if joints:
            placed.setdefault(plank.beam or plank.mark, []).extend(
                FingerJoint(plank.mark, joint.station, joint.clear) for joint in joints
            )
        if joints and stock.finger_joint:
            pieces += _pieces(plank.mark, length, joints, stock)
        else:
            refused.append(_too_long(plank, joints, stock))
    listed = [joint for group in placed.values() for joint in group if stock.finger_joint]
    return tuple(pieces), tuple(sorted(listed, key=lambda joint: (joint.mark, joint.station))), tuple(refused)
