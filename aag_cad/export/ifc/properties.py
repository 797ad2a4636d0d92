"""The set ``AAG_Fabrication``: what the workshop needs to make and find each part."""

import math
from collections.abc import Iterable, Mapping, Sequence

from aag_cad.export.ifc.frame import Entity, IfcModel
from aag_cad.export.ifc.sets import Property, write_property_set
from aag_cad.parts.forms import CrossHole, Hole, PlateHole
from aag_cad.parts.kinds import kind_of, shaped
from aag_cad.parts.marks import parse_mark
from aag_cad.parts.model import Part, Plank, Timber
from aag_cad.parts.products import product_name
from aag_cad.parts.quantities import hole_count, largest_twist, mass, sizes, smallest_radius
from aag_cad.parts.shapes.bar import BAR
from aag_cad.units import deg_per_m

FABRICATION = "AAG_Fabrication"


def hole_text(number: int, hole: Hole | PlateHole | CrossHole) -> str:
    """Return a hole as it stands in the hole table: number, place and diameter, of what is drilled use and joint."""
    if isinstance(hole, CrossHole):
        return f"{number}: z {hole.height:+.1f}, at {math.degrees(hole.angle):.1f} deg, d {hole.diameter:g}"
    text = f"{number}: x {hole.station:.1f}, y {round(hole.offset, 1) + 0.0:+.1f}, d {hole.diameter:g}"
    if isinstance(hole, PlateHole):
        return text
    return f"{text}{f' slot {hole.slot:g}' if hole.slot else ''} {hole.use} {hole.joint}"


def hole_table(part: Part) -> str:
    """Return the holes of a part as one text, in mm, separated by semicolons; empty if it has none.

    x and y of a hole are those of the blank, the block or the unfolded plate; z is along a stud from its centre.
    """
    shape, form = shaped(part)
    return "; ".join(hole_text(number, hole) for number, hole in enumerate(shape.holes(form), start=1))


def make(part: Part, timber: Timber) -> list[Property]:
    """Return what all parts of one product share: kind, product, sizes (mm), holes and mass (kg)."""
    length, width, thickness = (round(size, 3) for size in sizes(part))
    blank = "Blank" if kind_of(part).shape is BAR else ""
    return [
        ("Kind", "IfcLabel", kind_of(part).name),
        ("Product", "IfcLabel", product_name(part)),
        (f"{blank}Length", "IfcPositiveLengthMeasure", length),
        (f"{blank}Width", "IfcPositiveLengthMeasure", width),
        (f"{blank}Thickness", "IfcPositiveLengthMeasure", thickness),
        ("HoleCount", "IfcInteger", hole_count(part)),
        ("NetWeight", "IfcMassMeasure", round(mass(part, timber), 6)),
    ]


def strain(plank: Plank) -> list[Property]:
    """Return layer, largest twist (degrees per metre) and, unless it is straight, smallest radius (mm) of a plank."""
    rows: list[Property] = [
        ("Layer", "IfcInteger", plank.layer),
        ("LargestTwistDegPerM", "IfcReal", round(deg_per_m(largest_twist(plank)), 6)),
    ]
    if math.isfinite(radius := smallest_radius(plank)):
        rows.append(("SmallestRadius", "IfcPositiveLengthMeasure", round(radius, 3)))
    return rows


def fabrication(part: Part, made: Sequence[Property], drilling_group: str = "") -> list[Property]:
    """Return the properties of ``AAG_Fabrication`` of one piece; planks name the template that they are drilled by.

    ``made`` are those that it shares with all pieces of its product.
    """
    mark = parse_mark(part.mark)
    rows: list[Property] = [
        ("Mark", "IfcIdentifier", part.mark),
        ("Family", "IfcLabel", mark.family),
        ("Index", "IfcInteger", mark.index),
        *made,
    ]
    if holes := hole_table(part):
        rows.append(("Holes", "IfcText", holes))
    if isinstance(part, Plank):
        rows += strain(part)
    if drilling_group:
        rows.append(("DrillingGroup", "IfcIdentifier", drilling_group))
    return rows


def write_fabrication(
    model: IfcModel,
    products: Iterable[tuple[str, Sequence[Part]]],
    occurrences: Mapping[str, Entity],
    timber: Timber,
    groups: Mapping[str, str],
) -> None:
    """Write the fabrication set of every part; ``products`` gives the parts of each product's key.

    ``groups`` holds the drilling group of each plank by mark.
    """
    for key, parts in products:
        made = make(parts[0], timber)
        if kind_of(parts[0]).role == "fastener":
            # Out of a box: they share one set for each product, which therefore holds no mark.
            write_property_set(model, FABRICATION, key, made, [occurrences[part.mark] for part in parts])
            continue
        for part in parts:
            rows = fabrication(part, made, groups.get(part.mark, ""))
            write_property_set(model, FABRICATION, part.mark, rows, [occurrences[part.mark]])
