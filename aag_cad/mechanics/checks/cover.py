"""The checks of the cover: sheets against their stock and their bending, gaps against heat, bars and screws."""

from collections.abc import Iterator
from itertools import pairwise

from aag_cad.design import Design
from aag_cad.findings import Finding
from aag_cad.parts.facade import FREE_END
from aag_cad.parts.model import FlatBar, Gridshell, Shell
from aag_cad.parts.quantities import smallest_radius
from aag_cad.parts.shapes.sheet import flat_pattern, sheet_radius
from aag_cad.units import MM_PER_M

# Cold bending along the ribs: makers of multiwall polycarbonate ask for 150 t, a few for 175 t.
BENDING_RATIO = 150.0
# 0.065 mm/(m K) over about 50 K, rounded up as the makers do.
THERMAL_MOVEMENT = 3.0 / MM_PER_M
# What the makers ask of a glazing bar for sheets of 10 mm.
EDGE_GRIP = 20.0
# EN 1999-1-1: modulus of aluminium; proof strength of EN AW-6060 T66 (EN 755-2), N/mm2.
ALUMINIUM_MODULUS = 70000.0
ALUMINIUM_PROOF = 150.0
# EN 1995-1-1, 8.7.2: penetration of the threaded part, in diameters.
PENETRATION = 6.0
_ROUNDING = 0.05


def _covered(gridshell: Gridshell) -> Iterator[Shell]:
    return (shell for shell in gridshell.shells if shell.strips)


def sheet_checks(design: Design, gridshell: Gridshell) -> Iterator[Finding]:
    """Yield AAG851 (width), AAG852 (length) and AAG853 (bending radius) of strips that no stock sheet can make."""
    facade = design.facade
    longest, least = max(facade.sheet_lengths), BENDING_RATIO * facade.sheet_thickness
    for shell in _covered(gridshell):
        for strip in shell.strips:
            flat, radius = flat_pattern(strip), sheet_radius(strip)
            for code, what, found, allowed, remedy in (
                ("AAG851", "flat strip is wider than the stock sheet:", flat.width, facade.sheet_width,
                 "take more geodesics or a wider facade.sheet_width"),
                ("AAG852", "flat strip is longer than the longest stock sheet:", flat.length, longest,
                 "order longer sheets and add them to facade.sheet_lengths"),
            ):  # fmt: skip
                if found > allowed:
                    yield Finding(code, "error", strip.mark, what, found, allowed, "mm", remedy)
            if radius < least:
                what, remedy = "bending radius of the sheet", "take thinner sheets or flatten the surface there"
                yield Finding("AAG853", "error", strip.mark, what, radius, least, "mm", remedy)


def thermal_checks(design: Design, gridshell: Gridshell) -> Iterator[Finding]:
    """Yield AAG854 and AAG855: gaps beside and above a strip that are less than it grows by, 3 mm/m; AAG856: its grip.

    The worst case counts: one edge stuck, all movement at the other.
    """
    facade = design.facade
    side = facade.edge_gap - facade.screw_diameter / 2.0
    for shell in _covered(gridshell):
        for strip in shell.strips:
            flat = flat_pattern(strip)
            across, along = THERMAL_MOVEMENT * flat.width, THERMAL_MOVEMENT * flat.length
            if side < across:
                remedy = "widen facade.edge_gap"
                what = "room between the sheet's edge and the screws"
                yield Finding("AAG854", "error", strip.mark, what, side, across, "mm", remedy)
            if design.shells.top != "level" and facade.ridge_clearance < along:
                what, remedy = "room between the sheet's end and the ridge", "enlarge facade.ridge_clearance"
                yield Finding("AAG855", "error", strip.mark, what, facade.ridge_clearance, along, "mm", remedy)
        grip = min(facade.mullion[0], facade.clamp[0]) / 2.0 - facade.edge_gap
        if grip < EDGE_GRIP - _ROUNDING:
            what, remedy = "grip of the bars on the edges of the sheets", "widen facade.mullion and facade.clamp"
            yield Finding("AAG856", "warning", shell.mark, what, grip, EDGE_GRIP, "mm", remedy)


def bar_checks(design: Design, gridshell: Gridshell) -> Iterator[Finding]:
    """Yield AAG857 (bending stress E t / 2 r of a bar), AAG858 (what its screws leave free).

    AAG859 and AAG860: the screws hold too little in the blocks, or run into the bolts across them.
    """
    facade = design.facade
    for shell in _covered(gridshell):
        bars: tuple[FlatBar, ...] = (*shell.mullions, *shell.clamps)
        for bar in bars:
            blank = bar.blank
            stress = ALUMINIUM_MODULUS * blank.section.thickness / 2.0 / smallest_radius(bar)
            if stress > ALUMINIUM_PROOF:
                what, remedy = "stress of bending the bar", "take a thinner bar, or have it rolled to its radius"
                yield Finding("AAG857", "error", bar.mark, what, stress, ALUMINIUM_PROOF, "N/mm2", remedy)
            stations = [hole.station for hole in blank.holes]
            reach = max(stations[0], blank.length - stations[-1])
            apart = max((b - a for a, b in pairwise(stations)), default=0.0)
            for what, found, allowed in (
                ("length of the bar past its last screw", reach, FREE_END * facade.support_spacing),
                ("distance between two screws of the bar", apart, facade.support_spacing),
            ):
                if found > allowed + _ROUNDING:
                    remedy = "no block fits between beams and fittings there; allow a wider facade.support_spacing"
                    yield Finding("AAG858", "warning", bar.mark, what, found, allowed, "mm", remedy)
        depth, least = facade.screw_length - facade.build_up, PENETRATION * facade.screw_diameter
        room = design.timber.width / 2.0 - design.joints.bolt_offset - design.joints.bolt_hole / 2.0
        if depth > room:
            what, remedy = "depth of the facade screws, to the bolt across the block", "take shorter screws"
            yield Finding("AAG860", "error", shell.mark, what, depth, room, "mm", remedy)
        if depth < least - _ROUNDING:
            what, remedy = "penetration of the facade screws in the blocks", "take longer or thinner screws"
            yield Finding("AAG859", "warning", shell.mark, what, depth, least, "mm", remedy)


FACADE_CHECKS = (sheet_checks, thermal_checks, bar_checks)
