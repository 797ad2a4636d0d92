"""Tables for making the coupled beams: what the drilling embeds, stands to sag them on, over-drilled stations."""

import math
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import TypeAlias

from aag_cad.files import write_csv
from aag_cad.mechanics.sag import StandLayout, flat_pair, stand_layout
from aag_cad.mechanics.siblings import (
    CoupledPair,
    HoleErrorEffect,
    SprungShape,
    coupled_pair,
    hole_error_effect,
    node_differences,
    over_drill_shift,
    sprung_shape,
)
from aag_cad.parts.forms import Hole
from aag_cad.parts.index import index_of
from aag_cad.parts.model import FlatBar, Gridshell, Shell, Timber
from aag_cad.parts.twins import made_for_each

PREFABRICATION_HEADER = (
    "beam", "length_mm", "studs", "blocks", "right_minus_left_mm", "least_per_bay_mm", "most_per_bay_mm",
    "target_sagitta_mm", "sprung_sagitta_mm", "sprung_deviation_mm", "over_drilled_deviation_mm",
    "sigma_middle_mm", "sigma_end_mm", "sigma_curvature_percent", "locked_force_n",
    "upper_plank", "overhang_start_mm", "overhang_end_mm", "stand_spacing_mm", "sag_mm", "slope_deg", "added_load_kg",
    "hole_gap_mm", "largest_hole_gap_mm",
)  # fmt: skip
DRILLING_HEADER = (
    "beam", "joint", "left_offset_mm", "right_offset_mm", "left_mm", "right_mm", "right_minus_left_mm",
    "left_over_drilled_mm", "right_over_drilled_mm",
)  # fmt: skip
Row: TypeAlias = tuple[str, ...]


@dataclass(frozen=True)
class Prefabrication:
    """All that the workshop needs to make one coupled beam."""

    pair: CoupledPair
    drilled: SprungShape
    corrected: SprungShape
    errors: HoleErrorEffect
    stands: StandLayout


def prefabrication_of(shell: Shell, pair: CoupledPair, timber: Timber) -> Prefabrication:
    """Return what drilling, releasing, over-drilling and sagging give for one beam of a shell."""
    shift = over_drill_shift(pair)
    return Prefabrication(
        pair=pair,
        drilled=sprung_shape(pair, pair.left, pair.right, timber.modulus),
        corrected=sprung_shape(pair, pair.left - shift, pair.right + shift, timber.modulus),
        errors=hole_error_effect(pair),
        stands=stand_layout(pair, flat_pair(shell, pair, timber)),
    )


def _paired_planks(shell: Shell) -> Iterator[tuple[CoupledPair, FlatBar, FlatBar]]:
    """Yield every beam of a shell by mark: its couplings, its left and right plank."""
    for beam in sorted(shell.beams, key=lambda beam: beam.mark):
        left, right = (index_of(shell).planks[mark] for mark in beam.planks)
        yield coupled_pair(beam, left, right), left, right


def prefabrication_row(made: Prefabrication) -> Row:
    """Return one line of the prefabrication table, in the order of ``PREFABRICATION_HEADER``.

    Deviations are the largest distances after the best rigid motion; sigmas belong to hole errors of 0.3 mm. A straight
    beam leaves the share of its curvature empty.
    """
    pair, stands = made.pair, made.stands
    studs = sum(holes > 1 for holes in pair.holes)
    bays = node_differences(pair).tolist()
    difference = pair.right - pair.left
    differences = (float(difference[-1] - difference[0]), min(bays, key=abs), max(bays, key=abs))
    share = made.errors.curvature
    return (
        pair.beam.mark,
        f"{pair.beam.curve.length:.1f}",
        str(studs),
        str(len(pair.joints) - studs),
        *(f"{round(figure, 1) + 0.0:.1f}" for figure in differences),
        f"{made.drilled.target_sagitta:.1f}",
        f"{made.drilled.sagitta:.1f}",
        f"{made.drilled.fitted:.1f}",
        f"{made.corrected.fitted:.1f}",
        f"{made.errors.middle:.1f}",
        f"{made.errors.end:.1f}",
        "" if math.isinf(share) else f"{100.0 * share:.0f}",
        f"{made.drilled.force:.0f}",
        stands.upper,
        f"{stands.stands.start:.0f}",
        f"{stands.stands.end:.0f}",
        f"{stands.spacing:.0f}",
        f"{stands.sag:.0f}",
        f"{math.degrees(stands.slope):.0f}",
        f"{stands.added:.1f}",
        f"{stands.gap:.1f}",
        f"{stands.largest_gap:.1f}",
    )


def _bolt_holes(plank: FlatBar) -> dict[str, list[Hole]]:
    """Return the bolt holes of each joint of a plank, from the lower edge up."""
    found: dict[str, list[Hole]] = defaultdict(list)
    for hole in sorted(plank.blank.holes, key=lambda hole: hole.offset):
        if hole.use == "bolt":
            found[hole.joint].append(hole)
    return found


def drilling_rows(pair: CoupledPair, left: FlatBar, right: FlatBar) -> list[Row]:
    """Return one line for every bolt of a beam, both planks side by side, in the order of ``DRILLING_HEADER``.

    The over-drilled stations stand in for the nominal ones if the beam is to spring to its curve by itself; the
    difference is that of the printed stations.
    """
    on_left, on_right = _bolt_holes(left), _bolt_holes(right)
    rows: list[Row] = []
    for joint, shift in zip(pair.joints, over_drill_shift(pair).tolist(), strict=True):
        for first, second in zip(on_left[joint], on_right[joint], strict=True):
            places = [round(hole.station, 1) for hole in (first, second)]
            rows.append((
                pair.beam.mark,
                joint,
                *(f"{round(hole.offset, 1) + 0.0:.1f}" for hole in (first, second)),
                *(f"{place:.1f}" for place in places),
                f"{round(places[1] - places[0], 1) + 0.0:.1f}",
                f"{first.station - shift:.1f}",
                f"{second.station + shift:.1f}",
            ))  # fmt: skip
    return rows


def write_prefabrication(gridshell: Gridshell, folder: Path) -> None:
    """Write a line for every coupled beam and one for every bolt of it, drilled as built and over-drilled, as CSV.

    FileError if a file cannot be written.
    """

    def rows(shell: Shell) -> tuple[tuple[Row, ...], tuple[Row, ...]]:
        paired = list(_paired_planks(shell))
        beams = (prefabrication_row(prefabrication_of(shell, pair, gridshell.timber)) for pair, _, _ in paired)
        return tuple(beams), tuple(row for item in paired for row in drilling_rows(*item))

    beams, bolts = zip(*(made for _, made in sorted(made_for_each(gridshell, rows).items())), strict=True)
    write_csv(folder / "prefabrication.csv", PREFABRICATION_HEADER, chain.from_iterable(beams))
    write_csv(folder / "drilling.csv", DRILLING_HEADER, chain.from_iterable(bolts))
