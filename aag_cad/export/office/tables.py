"""Part and hole tables as CSV: one header line, LF, sorted by mark; lengths in mm, masses in kg."""

import math
from pathlib import Path

from aag_cad.files import write_csv
from aag_cad.mechanics.checks.lamella import lamella_stress
from aag_cad.parts.index import index_of, sorted_planks
from aag_cad.parts.kinds import kind_of
from aag_cad.parts.marks import parse_mark, shell_of
from aag_cad.parts.model import FlatBar, Gridshell, Part, Timber, all_parts
from aag_cad.parts.products import product_name
from aag_cad.parts.quantities import hole_count, largest_twist, mass, material_name, sizes, smallest_radius
from aag_cad.units import deg_per_m

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


def write_tables(gridshell: Gridshell, folder: Path) -> None:
    """Write a line for every part, every hole and every plank's forming stresses; FileError if a file cannot be."""
    parts, planks = sorted(all_parts(gridshell), key=lambda part: part.mark), sorted_planks(gridshell)
    write_csv(folder / "parts.csv", PARTS_HEADER, (part_row(part, gridshell) for part in parts))
    write_csv(folder / "holes.csv", HOLES_HEADER, (row for plank in planks for row in hole_rows(plank)))
    write_csv(folder / "checks.csv", CHECKS_HEADER, (check_row(plank, gridshell.timber) for plank in planks))
