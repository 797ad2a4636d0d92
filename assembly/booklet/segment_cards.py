"""The segments as rows of a table and as cards of a printed sheet: plain text and numbers."""

import math
from collections.abc import Iterator, Sequence
from typing import TypeAlias

from aag_cad.families import FAMILIES
from aag_cad.language import Figure, Language, Text, printed, say, says, text
from aag_cad.parts.marks import parse_mark, short_mark
from assembly.base.mark_ranges import joined_ranges
from assembly.base.segments import Brace, Limits, Segment, Segmentation, Splice, splices_of

SEGMENTS_HEADER = (
    "segment", "shell", "geodesics", "parts", "plank_pieces", "mass_kg", "timber_kg", "steel_kg", "centre_x_mm",
    "centre_y_mm", "centre_z_mm", "length_mm", "width_mm", "height_mm", "turned_deg", "fits", "over_length_mm",
    "over_width_mm", "over_height_mm", "over_mass_kg", "lifting_studs", "lifting_margin_mm", "braces",
)  # fmt: skip
SPLICES_HEADER = (
    "member", "line", "joint", "kind", "plank", "station_mm", "clear_mm", "required_mm", "length_mm", "bolts",
    "bolt_diameter_mm", "left_out", "fits",
)  # fmt: skip

Row: TypeAlias = tuple[str, ...]
Card: TypeAlias = dict[str, str | list[str] | list[list[str]]]


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


def _say(language: Language, key: str, **figures: Figure) -> str:
    return say(language, f"segments.{key}", **figures)


def brace_text(brace: Brace) -> Text:
    """Return what a brace is, from where to where, and how long."""
    kind, start, end = text(f"segments.brace.{brace.kind}"), short_mark(brace.start), short_mark(brace.end)
    return text("segments.brace.line", kind=kind, start=start, end=end, length=brace.length)


def _room(segment: Segment, limits: Limits, language: Language) -> str:
    """Return whether a segment fits, and the room that is left or missing."""
    room = [*limits.room, limits.load]
    if not any(math.isfinite(size) for size in room):
        return _say(language, "value.free")
    if segment.fits:
        left = " x ".join(_number(-value) or "…" for value in segment.over[:3])
        mass = _number(-segment.over[3])
        return _say(language, "value.fits" if mass else "value.fits_room", left=left, mass=mass)
    sizes = zip(("length", "width", "height", "mass"), segment.over, strict=True)
    over = [_say(language, f"value.{key}_over", over=_number(value)) for key, value in sizes if value > 0.0]
    return _say(language, "value.not_fits", over=", ".join(over))


def _lifting(segment: Segment, language: Language) -> str:
    if not segment.lifting.studs:
        return _say(language, "value.no_sling")
    return _say(
        language,
        "value.sling",
        studs=joined_ranges(segment.lifting.studs),
        hold=_say(language, "value.above" if segment.lifting.above else "value.below"),
        margin=_number(segment.lifting.margin),
    )


def splice_words(splice: Splice, language: Language = "en") -> str:
    """Return what a splice is made of."""
    joint = short_mark(splice.joint) if splice.joint else ""
    figures: dict[str, Figure] = {"length": _number(splice.length), "bolts": splice.bolts, "diameter": splice.diameter}
    return _say(language, f"value.{splice.kind}", joint=joint, **figures)


def segment_cards(plan: Segmentation, language: Language = "en") -> list[Card]:
    """Return one card for each segment, ready for a printed sheet, all words in a language.

    Keys: name, shell, title; facts, rows of (what, value): geodesics, parts, whole and cut planks as ranges of marks,
    mass, centre of gravity, size, turn, room in the transport, lifting studs, props; braces, lines of text under the
    heading braces_title; splices along its geodesics, as rows (number as on its picture, member, line, text, stations)
    under splices_title and splices_head; loose_ends, lines of text under loose_title: its other cut beams and edge
    planks.
    """
    return [_card(plan, segment, language) for segment in plan.segments]


def _facts(plan: Segmentation, segment: Segment, language: Language) -> Iterator[tuple[str, str]]:
    """Yield (key of what, value) for the head of a card."""
    x, y, z = (_number(value) for value in segment.centre)
    whole = [mark for mark in segment.parts if parse_mark(mark).family in FAMILIES]
    steel = _number(segment.mass - segment.timber)
    yield "geodesics", joined_ranges(segment.geodesics)
    key = "value.parts" if segment.pieces else "value.all_parts"
    yield "parts", _say(language, key, parts=len(segment.parts), pieces=len(segment.pieces))
    yield "planks", joined_ranges(whole)
    yield "cut_planks", joined_ranges(sorted({piece.plank for piece in segment.pieces}))
    yield "mass", _say(language, "value.mass", mass=_number(segment.mass), steel=steel)
    yield "centre", _say(language, "value.centre", x=x, y=y, z=z)
    yield "size", _say(language, "finding.box", sizes=" x ".join(_number(size) for size in segment.pose.size))
    yield "turned", _say(language, "value.turned", degrees=_number(math.degrees(segment.tilt)))
    yield "room", _room(segment, plan.limits, language)
    yield "lifting", _lifting(segment, language)
    yield "props", joined_ranges(segment.props)


def _loose(splices: Sequence[Splice], language: Language) -> Iterator[str]:
    for line in dict.fromkeys(splice.line for splice in splices):
        members = joined_ranges([splice.member for splice in splices if splice.line == line])
        yield _say(language, "value.loose", members=members, line=short_mark(line))


def _card(plan: Segmentation, segment: Segment, language: Language) -> Card:
    carried, loose = splices_of(plan, segment)
    whole = segment.name == segment.shell
    rows = [
        [
            str(i),
            short_mark(splice.member),
            short_mark(splice.line),
            splice_words(splice, language),
            ", ".join(
                _say(language, "value.station", plank=short_mark(cut.plank), station=_number(cut.station))
                for cut in splice.cuts
            ),
        ]
        for i, splice in enumerate(carried, start=1)
    ]
    return {
        "name": segment.name,
        "shell": segment.shell,
        "title": _say(language, "card.whole" if whole else "card.title", segment=segment.name),
        "facts": [[_say(language, f"card.{key}"), value] for key, value in _facts(plan, segment, language) if value],
        "braces_title": _say(language, "card.braces"),
        "braces": [printed(brace_text(brace), language) for brace in segment.braces],
        "splices_title": _say(language, "card.splices"),
        "splices_head": list(says(language, "segments.card.table")),
        "splices": rows,
        "loose_title": _say(language, "card.loose_ends"),
        "loose_ends": list(_loose(loose, language)),
    }
