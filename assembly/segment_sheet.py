"""The segments as rows of a table and as cards of a printed sheet: plain text and numbers."""

import math
from typing import TypeAlias

from aag_cad.parts.marks import parse_mark
from assembly.ranges import joined_ranges
from assembly.segments import Segment, Segmentation
from assembly.splices import Splice

SEGMENTS_HEADER = (
    "segment", "shell", "geodesics", "parts", "plank_pieces", "mass_kg", "timber_kg", "steel_kg", "centre_x_mm",
    "centre_y_mm", "centre_z_mm", "length_mm", "width_mm", "height_mm", "turned_deg", "fits", "over_length_mm",
    "over_width_mm", "over_height_mm", "over_mass_kg", "lifting_studs", "lifting_margin_mm", "braces", "splice_blocks",
)  # fmt: skip
SPLICES_HEADER = (
    "member", "line", "joint", "kind", "plank", "station_mm", "clear_mm", "required_mm", "length_mm", "bolts",
    "bolt_diameter_mm", "left_out", "fits",
)  # fmt: skip
_PLANKS = ("A1", "A2", "G", "E")
BRACE_WORDS = {
    "bar": "bar along the bare beam ends, screwed to each",
    "tie": "straight tie beside the cut",
    "diagonal": "diagonal from corner to corner",
}

Row: TypeAlias = tuple[str, ...]
Card: TypeAlias = dict[str, str | list[str] | list[dict[str, str]]]


def _number(value: float, digits: int = 0) -> str:
    """Return a number as printed, without a minus before zero and empty where there is none."""
    return f"{round(value, digits) + 0.0:.{digits}f}" if math.isfinite(value) else ""


def segment_row(segment: Segment) -> Row:
    """Return one line of the segment table, in the order of ``SEGMENTS_HEADER``; lists are parted by spaces."""
    return (
        segment.name,
        segment.shell,
        " ".join(segment.geodesics),
        str(len(segment.parts)),
        str(len(segment.pieces)),
        _number(segment.mass, 1),
        _number(segment.timber, 1),
        _number(segment.mass - segment.timber, 1),
        *(_number(value) for value in segment.centre),
        *(_number(value) for value in segment.pose.size),
        _number(math.degrees(segment.tilt), 1),
        "yes" if segment.fits else "no",
        *(_number(value) for value in segment.over[:3]),
        _number(segment.over[3], 1),
        " ".join(segment.lifting.studs),
        _number(segment.lifting.margin),
        str(len(segment.braces)),
        str(len(segment.splices)),
    )


def segment_rows(plan: Segmentation) -> list[Row]:
    """Return the lines of ``tables/segments.csv`` under ``SEGMENTS_HEADER``, in the order of the segments."""
    return [segment_row(segment) for segment in plan.segments]


def splice_rows(plan: Segmentation) -> list[Row]:
    """Return one line for each cut plank under ``SPLICES_HEADER``: where it is cut and what joins it again."""
    return [
        (
            splice.member,
            splice.line,
            splice.joint,
            splice.kind,
            cut.plank,
            _number(cut.station, 1),
            _number(cut.clear, 1),
            _number(splice.required),
            _number(splice.length),
            str(splice.bolts),
            f"{splice.diameter:g}",
            " ".join(splice.left_out),
            "yes" if splice.fits else "no",
        )
        for splice in plan.splices
        for cut in splice.cuts
    ]


def _size(segment: Segment) -> str:
    return " x ".join(_number(value) for value in segment.pose.size) + " mm"


def _room(segment: Segment) -> str:
    """Return whether a segment fits, and the room that is left or missing."""
    if segment.fits:
        left = " x ".join(_number(-value) for value in segment.over[:3])
        return f"fits; {left} mm and {_number(-segment.over[3])} kg to spare"
    units = ("mm too long", "mm too wide", "mm too high", "kg too heavy")
    over = ", ".join(f"{_number(value)} {unit}" for value, unit in zip(segment.over, units, strict=True) if value > 0.0)
    return f"does not fit: {over}"


def _lifting(segment: Segment) -> str:
    if not segment.lifting.studs:
        return "no three studs around the centre of gravity: sling the beams under a spreader"
    hold = "above" if segment.lifting.above else "below"
    return (
        f"{', '.join(segment.lifting.studs)}; {hold} the centre of gravity, its plumb line "
        f"{_number(segment.lifting.margin)} mm inside"
    )


def _splice_words(splice: Splice) -> str:
    """Return what a splice is made of, as an instruction."""
    bolts = f"{splice.bolts} x M{splice.diameter:g}"
    if splice.kind == "block":
        return f"splice block {_number(splice.length)} mm in the gap at {splice.joint}, {bolts}"
    return f"steel plate {_number(splice.length)} mm, {bolts}"


def segment_cards(plan: Segmentation) -> list[Card]:
    """Return one card for each segment, ready for a printed sheet: facts as text, splices and braces as lists.

    Keys: name, shell, geodesics, parts, planks (whole) and cut_planks as ranges of marks, mass, centre, size, turned,
    room, lifting, braces (kind, text, from, to, length), splices (member, line, text, stations) whose blocks it
    carries, and loose_ends: its other cut beams and edge planks.
    """
    return [_card(plan, segment) for segment in plan.segments]


def _card(plan: Segmentation, segment: Segment) -> Card:
    own = set(segment.splices)
    planks = {piece.plank for piece in segment.pieces}
    cut = [s for s in plan.splices if any(c.plank in planks and _touches(segment, c.plank, c.station) for c in s.cuts)]
    carried = [s for s in cut if (s.member, s.joint) in own]
    x, y, z = (_number(value) for value in segment.centre)
    return {
        "name": segment.name,
        "shell": segment.shell,
        "geodesics": list(segment.geodesics),
        "parts": f"{len(segment.parts)} whole parts, {len(segment.pieces)} pieces of cut planks",
        "planks": joined_ranges([mark for mark in segment.parts if parse_mark(mark).family in _PLANKS]),
        "cut_planks": joined_ranges(sorted(planks)),
        "mass": f"{_number(segment.mass)} kg, {_number(segment.mass - segment.timber)} kg of it steel",
        "centre": f"x {x}, y {y}, z {z} mm",
        "size": _size(segment),
        "turned": f"turned over by {_number(math.degrees(segment.tilt))} degrees from standing",
        "room": _room(segment),
        "lifting": _lifting(segment),
        "braces": [
            {
                "kind": brace.kind,
                "text": BRACE_WORDS[brace.kind],
                "from": brace.start,
                "to": brace.end,
                "length": f"{_number(brace.length)} mm",
            }
            for brace in segment.braces
        ],
        "splices": [
            {
                "member": splice.member,
                "line": splice.line,
                "text": _splice_words(splice),
                "stations": ", ".join(f"{c.plank} at {_number(c.station, 1)} mm" for c in splice.cuts),
            }
            for splice in carried
        ],
        "loose_ends": [f"{splice.member} at {splice.line}" for splice in cut if splice not in carried],
    }


def _touches(segment: Segment, plank: str, station: float) -> bool:
    """Return whether a segment has the piece of a plank on one side of a cut."""
    return any(piece.plank == plank and station in (piece.start, piece.end) for piece in segment.pieces)
