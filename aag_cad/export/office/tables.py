"""Part and hole tables as CSV: one header line, LF, sorted by mark; lengths in mm, masses in kg."""

import math
import os
from collections.abc import Iterable

from aag_cad.files import write_csv
from aag_cad.mechanics.checks.lamella import lamella_stress
from aag_cad.parts.index import index_of, sorted_planks
from aag_cad.parts.kinds import kind_of
from aag_cad.parts.marks import parse_mark, shell_of
from aag_cad.parts.model import FlatBar, Gridshell, Part, Timber, all_parts
from aag_cad.parts.products import product_name
from aag_cad.parts.quantities import hole_count, largest_twist, mass, material_name, sizes, smallest_radius
from aag_cad.units import deg_per_m
from assembly.base.locking_order import LockingOrder
from assembly.base.segments import Segmentation
from assembly.booklet.segment_cards import SEGMENTS_HEADER, SPLICES_HEADER, segment_rows, splice_rows
from assembly.pictures.locking_chart import LOCKING_HEADER, locking_rows

PARTS_HEADER = (
    "mark", "kind", "product", "family", "shell", "beam", "length_mm", "width_mm", "thickness_mm", "holes",
    "mass_kg", "min_radius_mm", "max_twist_deg_per_m", "material", "quantity",
)  # fmt: skip
CHECKS_HEADER = (
    "mark", "min_radius_mm", "max_twist_deg_per_m", "bending_n_mm2", "helix_n_mm2", "bending_and_helix_n_mm2",
    "bending_utilisation", "torsion_n_mm2", "torsion_utilisation", "bow_mm", "edgewise_n_mm2",
)  # fmt: skip
HOLES_HEADER = ("mark", "number", "station_mm", "offset_mm", "diameter_mm", "use", "joint", "spacing_mm")


def _strain(plank: FlatBar | None) -> tuple[str, str]:
    """Return smallest radius and largest twist as printed; a straight plank and every other part leaves them empty."""
    if plank is None:
        return "", ""
    radius = smallest_radius(plank)
    return "" if math.isinf(radius) else f"{radius:.0f}", f"{deg_per_m(largest_twist(plank)):.2f}"


def part_row(part: Part, gridshell: Gridshell) -> tuple[str, ...]:
    """Return one line of the part table, in the order of ``PARTS_HEADER``."""
    (length, width, thickness), plank = sizes(part), index_of(gridshell).planks.get(part.mark)
    return (
        part.mark,
        kind_of(part).name,
        product_name(part),
        parse_mark(part.mark).family,
        shell_of(part.mark),
        plank.beam if plank else "",
        f"{length:.1f}",
        f"{width:g}",
        f"{thickness:g}",
        str(hole_count(part)),
        f"{mass(part, gridshell.timber):.4f}",
        *_strain(plank),
        material_name(part, gridshell.timber),
        "1",
    )


def hole_rows(plank: FlatBar) -> list[tuple[str, ...]]:
    """Return the holes of a plank in the order of ``HOLES_HEADER``, numbered from its start.

    The spacing is the difference of the printed stations, so that a tape along the plank agrees with the table.
    """
    rows: list[tuple[str, ...]] = []
    last: float | None = None
    for number, hole in enumerate(plank.blank.holes, start=1):
        station = round(hole.station, 1)
        spacing = "" if last is None else f"{station - last:.1f}"
        offset = round(hole.offset, 1) + 0.0
        where = (f"{station:.1f}", f"{offset:.1f}", f"{hole.diameter:g}")
        rows.append((plank.mark, str(number), *where, hole.use, hole.joint, spacing))
        last = station
    return rows


def write_parts_table(gridshell: Gridshell, path: str | os.PathLike[str]) -> None:
    """Write one line for every part; FileError if the file cannot be written."""
    rows = (part_row(part, gridshell) for part in sorted(all_parts(gridshell), key=lambda part: part.mark))
    write_csv(path, PARTS_HEADER, rows)


def write_holes_table(gridshell: Gridshell, path: str | os.PathLike[str]) -> None:
    """Write one line for every hole of every plank, from its start; FileError if the file cannot be written."""
    write_csv(path, HOLES_HEADER, (row for plank in sorted_planks(gridshell) for row in hole_rows(plank)))


def write_locking_table(orders: Iterable[LockingOrder], path: str | os.PathLike[str]) -> None:
    """Write the order in which geodesics lock each shell, a line for each step; FileError if it cannot be written."""
    write_csv(path, LOCKING_HEADER, (row for order in orders for row in locking_rows(order)))


def write_segment_tables(
    segmentation: Segmentation, path: str | os.PathLike[str], splices_path: str | os.PathLike[str]
) -> None:
    """Write what travels in one piece, and the splices where shells are cut; FileError if they cannot be written."""
    write_csv(path, SEGMENTS_HEADER, segment_rows(segmentation))
    write_csv(splices_path, SPLICES_HEADER, splice_rows(segmentation))


def check_row(plank: FlatBar, timber: Timber) -> tuple[str, ...]:
    """Return the forming stresses of a plank in the order of ``CHECKS_HEADER``; utilisations by f_m and f_v."""
    stress = lamella_stress(plank, timber)
    return (
        plank.mark,
        f"{stress.smallest_radius:.0f}",
        f"{deg_per_m(stress.largest_twist):.2f}",
        f"{stress.bending:.2f}",
        f"{stress.helix:.2f}",
        f"{stress.combined:.2f}",
        f"{stress.combined / timber.bending_strength:.3f}",
        f"{stress.torsion:.2f}",
        f"{stress.torsion / timber.shear_strength:.3f}",
        f"{stress.bow:.1f}",
        f"{stress.edgewise:.2f}",
    )


def write_checks_table(gridshell: Gridshell, path: str | os.PathLike[str]) -> None:
    """Write one line of forming stresses for every plank; FileError if the file cannot be written."""
    write_csv(path, CHECKS_HEADER, (check_row(plank, gridshell.timber) for plank in sorted_planks(gridshell)))
