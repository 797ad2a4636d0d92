"""Masses and lengths of what is carried: parts, beams, shells and segments."""

from aag_cad.parts.index import index_of
from aag_cad.parts.model import Gridshell, all_parts
from aag_cad.parts.quantities import mass, sizes
from assembly.base.part_groups import shell_kit
from assembly.base.segments import Segmentation, segments_of


def piece_weights(gridshell: Gridshell, segmentation: Segmentation | None = None) -> dict[str, tuple[float, float]]:
    """Return (mass in kg, length in mm) of every part, of every beam with its blocks and bolts, and of every shell.

    Of every segment of a cut shell as well, without its bracing. The length of shells and segments counts as 0.
    """
    weights = {part.mark: (mass(part, gridshell.timber), sizes(part)[0]) for part in all_parts(gridshell)}
    for shell in gridshell.shells:
        kit = shell_kit(shell)
        made = (*kit.beams.values(), *((stud, *bolts) for stud, bolts in kit.studs.items()), *kit.outside.values())
        made = (
            *made,
            *((edge, *screws) for edge, screws in kit.edges.items()),
            *kit.inside.values(),
            tuple(kit.outside),
        )
        weights[shell.mark] = sum(weights[mark][0] for group in made for mark in group), 0.0
        for beam, marks in kit.beams.items():
            weights[beam] = sum(weights[mark][0] for mark in marks), index_of(shell).beams[beam].curve.length
    return weights | segment_weights(gridshell, segmentation)


def segment_weights(gridshell: Gridshell, segmentation: Segmentation | None) -> dict[str, tuple[float, float]]:
    """Return (mass in kg, 0) of every segment of the shells that are cut, without its bracing."""
    cut = (segment for shell in gridshell.shells for segment in segments_of(segmentation, shell.mark))
    return {segment.name: (segment.mass, 0.0) for segment in cut}
