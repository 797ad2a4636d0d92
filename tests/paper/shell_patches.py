"""The shells of a design as patches: which operations on its surface make its form (paper, Fig. 2)."""

from dataclasses import replace

from patches import Patch, cropped, cropped_by_plane, flipped, intersected, polar_array

from aag_cad.design import Design
from aag_cad.design_tables import LevelShells, MirrorShells
from aag_cad.geometry.profiles import SplineProfile
from aag_cad.geometry.revolution import AsymptoticChart
from aag_cad.network.edges import bottom_coordinate, top_coordinate

_PAST_THE_RIDGE = 1.05


def shell_patches(design: Design, chart: AsymptoticChart) -> tuple[Patch, ...]:
    """Return the patches of a design where they stand, in the parameters (s, theta) of its chart.

    ridge: polar copies, intersected and cropped; mirror: cropped by the plane x = 0, and flipped across it; level:
    cropped at heights, and rotated; what is below the neck is the surface flipped down, after the patches above.
    """
    half = design.half_sector
    highest = max(top_coordinate(design, chart, theta) for theta in (0.0, half))
    whole = Patch(chart, (0.0, highest), (-half, half))
    match design.shells:
        case LevelShells() as shells:
            depth = -bottom_coordinate(design, chart)
            if isinstance(chart.surface.profile, SplineProfile):
                # A drawn meridian need not be symmetric about its ground line: what is below belongs to the same patch.
                return polar_array(replace(whole, u=(-depth, highest)), shells.count)
            below = (flipped(cropped(whole, u=(0.0, depth))),) if depth > 0.0 else ()
            return tuple(copy for patch in (whole, *below) for copy in polar_array(patch, shells.count))
        case MirrorShells():
            first = cropped_by_plane(whole, (0.0, 0.0, 0.0), (-1.0, 0.0, 0.0))
            return first, flipped(first, normal=(1.0, 0.0, 0.0))
        case _:
            reaching = Patch(chart, (0.0, _PAST_THE_RIDGE * highest), (-half, half))
            return intersected(polar_array(reaching, design.shells.count))
