"""Reuse passports as files: JSON for programs, an A4 booklet for people, and reuse.csv as stock of the next design."""

import json
import math
import os
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from aag_cad.files import write_bytes, write_csv, write_text
from aag_cad.parts.forms import Blank, Hole
from aag_cad.parts.marks import short_mark
from aag_cad.parts.model import Gridshell
from aag_cad.shop.passports import (
    REUSE_HEADER,
    SERVICE_LIFE_YEARS,
    Passport,
    Strain,
    passports,
    reuse_row,
    stock_origin,
    strain_along,
)
from aag_cad.typesetting import printout_pdf
from aag_cad.units import MM_PER_M, Floats, deg_per_m
from assembly.booklet.qr import qr_svg
from assembly.drawing.svg import UNITS_PER_MM, Style, group, line, polygon, rectangle, svg

PASSPORTS_VERSION = 1
_DRAWING = 180.0
_SCALES = (5, 10, 15, 20, 25, 30, 40, 50, 60, 75, 100, 150, 200, 250, 500)
_ACROSS = 10.0
_CHART = 9.0
_GAP = 1.5
_CHART_SPACING = 100.0
# Less twist than this is none: what is left of it comes from rounding.
_NO_TWIST_DEG_PER_M = 0.01
_SHARES = (0.1, 0.25, 0.5, 1.0, 1.5, 2.0, 5.0)
_EDGE, _FRAME, _BORE = Style("none", "#000", 2.0), Style("none", "#000", 1.0), Style("#000")
_BENDING, _TWIST = Style("#c9c4b8", "#6b665a", 2.0), Style("none", "#12507b", 3.5)


def write_passports(
    gridshell: Gridshell,
    json_path: str | os.PathLike[str],
    pdf_path: str | os.PathLike[str],
    csv_path: str | os.PathLike[str],
) -> None:
    """Write the passports of all planks as JSON, as PDF and as stock rows; equal gridshells give equal bytes.

    FileError if a file cannot be written.
    """
    held = passports(gridshell)
    write_text(json_path, passports_json(held, gridshell))
    write_csv(csv_path, REUSE_HEADER, map(reuse_row, held))
    write_bytes(pdf_path, passports_pdf(held, gridshell))


def passports_json(held: Iterable[Passport], gridshell: Gridshell) -> str:
    """Return the passports as JSON text, in mm; what a straight or untwisted plank has not is null."""
    data = {
        "schema_version": PASSPORTS_VERSION,
        "design": gridshell.name,
        "title": gridshell.title,
        "planks": [_plain(passport) for passport in held],
    }
    return json.dumps(data, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _plain(held: Passport) -> dict[str, Any]:
    bent, blank = math.isfinite(held.smallest_radius), held.plank.blank
    twist = deg_per_m(held.largest_twist)
    return {
        "mark": held.plank.mark,
        "species": held.timber.species,
        "strength_class": held.timber.strength_class,
        "length_mm": round(blank.length, 3),
        "width_mm": blank.section.width,
        "thickness_mm": blank.section.thickness,
        "stock_origin": stock_origin(blank.section),
        "service_life_years": SERVICE_LIFE_YEARS,
        "smallest_radius_mm": round(held.smallest_radius, 1) if bent else None,
        "smallest_radius_at_mm": round(held.smallest_radius_station, 1) if bent else None,
        "largest_twist_deg_per_m": round(twist, 3),
        "largest_twist_at_mm": round(held.largest_twist_station, 1) if twist >= _NO_TWIST_DEG_PER_M else None,
        "bending_n_mm2": round(held.stress.combined, 3),
        "bending_utilisation": round(held.bending_utilisation, 4),
        "shear_n_mm2": round(held.stress.torsion, 3),
        "shear_utilisation": round(held.shear_utilisation, 4),
        "clear_stretches": [
            {"from_mm": round(each.start, 3), "to_mm": round(each.end, 3), "length_mm": round(each.length, 3)}
            for each in held.clear
        ],
        "holes": [
            {
                "station_mm": round(hole.station, 3),
                "offset_mm": round(hole.offset, 3) + 0.0,
                "diameter_mm": hole.diameter,
                "slot_mm": hole.slot,
                "use": hole.use,
                "joint": hole.joint,
            }
            for hole in blank.holes
        ],
    }


def passports_pdf(held: Sequence[Passport], gridshell: Gridshell) -> bytes:
    """Return the passports as a booklet of A4 sheets; the same passports give the same bytes."""
    scale = _scale(max((each.plank.blank.length for each in held), default=0.0))
    pictures: dict[str, str] = {}
    cards = [_card(each, scale, pictures) for each in held]
    data = {
        "title": gridshell.title,
        "radius": f"{gridshell.timber.min_bending_radius / MM_PER_M:g}\u00a0m",
        "twist": f"{deg_per_m(gridshell.timber.max_twist):.3g}\u00a0°/m",
        "scale": scale,
        "across": _ACROSS,
        "cards": cards,
    }
    return printout_pdf("passports", data, pictures)


def _scale(longest: float) -> int:
    """Return the scale 1 : n at which the longest plank fits on the sheet, one for all sheets."""
    return next((n for n in _SCALES if longest / n <= _DRAWING), math.ceil(longest / _DRAWING))


def _card(held: Passport, scale: int, pictures: dict[str, str]) -> dict[str, Any]:
    """Return what the card of a passport prints; its pictures are added to ``pictures``."""
    plank, strain = held.plank, strain_along(held.plank, _CHART_SPACING)
    shares = (strain.bending * held.timber.min_bending_radius, strain.twist / held.timber.max_twist)
    most = max(float(abs(share).max()) for share in shares)
    limit = next((share for share in _SHARES if most <= share), math.ceil(most))
    pictures[plank.mark] = _drawing(plank.blank, strain, shares, limit, scale)
    pictures[f"{plank.mark}-qr"] = qr_svg(plank.mark)
    return {
        "mark": plank.mark,
        "facts": _facts(held),
        "holes": _holes(plank.blank),
        "length": plank.blank.length / scale,
        "metres": [MM_PER_M / scale * metre for metre in range(1, int(plank.blank.length / MM_PER_M) + 1)],
        "limit": f"±{100.0 * limit:.3g} %",
        "height": plank.blank.section.width / _ACROSS,
        "chart": _CHART,
    }


def _facts(held: Passport) -> list[tuple[str, str]]:
    """Return the lines of a passport: what it is, what it carried, where it is clear."""
    blank, twist = held.plank.blank, deg_per_m(held.largest_twist)
    twisted = f"{twist:.1f} °/m at {held.largest_twist_station:.0f} mm" if twist >= _NO_TWIST_DEG_PER_M else "nothing"
    radius = f"{held.smallest_radius / MM_PER_M:.2f} m at {held.smallest_radius_station:.0f} mm"
    clear = ", ".join(f"{each.start:.0f}\N{EN DASH}{each.end:.0f} ({each.length:.0f})" for each in held.clear[:3])
    return [
        (
            "plank",
            f"{held.timber.species} {held.timber.strength_class}, {blank.section.thickness:g} x "
            f"{blank.section.width:g} mm, {blank.length:.1f} mm long, {len(blank.holes)} holes",
        ),
        ("cut from", stock_origin(blank.section)),
        ("planned use", f"{SERVICE_LIFE_YEARS:g} years in {held.design}"),
        ("bent to radius", radius if math.isfinite(held.smallest_radius) else "straight"),
        ("twisted by", twisted),
        ("bending", f"{held.stress.combined:.1f} N/mm², {held.bending_utilisation:.2f} of the strength"),
        ("shear", f"{held.stress.torsion:.1f} N/mm², {held.shear_utilisation:.2f} of the strength"),
        ("longest clear", clear),
    ]


def _holes(blank: Blank) -> list[dict[str, Any]]:
    """Return the holes by joint, in the order of a tape along the plank."""
    listed: list[dict[str, Any]] = []
    for hole in blank.holes:
        joint = short_mark(hole.joint)
        slot = f" x {hole.diameter + hole.slot:g}" if hole.slot else ""
        bore = f"{hole.use} ⌀{hole.diameter:g}{slot}"
        if not listed or (listed[-1]["joint"], listed[-1]["bore"]) != (joint, bore):
            listed.append({"joint": joint, "bore": bore, "places": []})
        offset = f"{round(hole.offset, 1) + 0.0:+.1f}".replace("-", "\N{MINUS SIGN}").replace("+0.0", "0")
        listed[-1]["places"].append(f"{hole.station:.1f} {offset}")
    return listed


def _drawing(blank: Blank, strain: Strain, shares: tuple[Floats, Floats], limit: float, scale: int) -> str:
    """Return the blank with its holes and under it the chart of bending and twist, as SVG."""
    length, width = UNITS_PER_MM * blank.length / scale, UNITS_PER_MM * blank.section.width / _ACROSS
    chart, top = UNITS_PER_MM * _CHART, width + UNITS_PER_MM * _GAP
    zero = top + chart / 2.0
    along = UNITS_PER_MM * strain.stations / scale
    bending, twist = (np.column_stack([along, zero - chart / 2.0 * share / limit]) for share in shares)
    axis = np.array([(0.0, zero), (length, zero)])
    items = (
        group([rectangle(1.0, 1.0, length - 2.0, width - 2.0)], _EDGE),
        group((_bore(hole, width, scale) for hole in blank.holes), _BORE),
        polygon(np.concatenate([axis[:1], bending, axis[1:]]), _BENDING),
        line(twist, _TWIST),
        line(axis, _FRAME),
        group([rectangle(0.5, top, length - 1.0, chart - 1.0)], _FRAME),
    )
    return svg(UNITS_PER_MM * _DRAWING, top + chart, items)


def _bore(hole: Hole, width: float, scale: int) -> str:
    """Return a hole in the drawing of a blank; its round ends are to the scale across, to be seen at all."""
    x, y = UNITS_PER_MM * hole.station / scale, width / 2.0 - UNITS_PER_MM * hole.offset / _ACROSS
    across = UNITS_PER_MM * hole.diameter / _ACROSS
    along = across + UNITS_PER_MM * hole.slot / scale
    return rectangle(x - along / 2.0, y - across / 2.0, along, across, across / 2.0)
