"""How a shell that is cut for the journey is made with its splices, and parted when it is stiff.

It is put together whole in the workshop, because only whole it takes its shape. Every part is added there once; what
the parting takes out and the joining puts in again are ``extras`` of these steps, and so is the bracing.
"""

from collections.abc import Collection, Iterable, Iterator
from dataclasses import replace
from typing import Literal

from aag_cad.language import text
from aag_cad.parts.marks import short_mark
from aag_cad.parts.model import Gridshell, Shell
from assembly.base.segments import Segment, Segmentation, Splice, segments_of
from assembly.base.steps import Bracing, Extra, FastenersPut, Lashing, SplicePut, Station
from assembly.plan.step_cards import card, fasteners_by_kind
from assembly.plan.work import EVERYONE, Work, props_under
from assembly.transport.seams import Seam, seams


def _put(work: Literal["made", "divide", "splice", "unmade"], splice: Splice) -> SplicePut:
    stations = tuple(Station(cut.plank, cut.station) for cut in splice.cuts)
    told = splice.member, splice.line, splice.joint, splice.kind, stations
    return SplicePut(work, *told, splice.length, splice.bolts, splice.diameter)


def seam_extras(seam: Seam, work: Literal["divide", "splice"]) -> Iterator[Extra]:
    """Yield what is taken out at a seam (``divide``) or put in again (``splice``): splices with bolts, fasteners."""
    for splice in seam.splices:
        yield _put(work, splice)
    if seam.fasteners:
        yield FastenersPut(work, seam.line, seam.fasteners)
    yield Lashing(work, seam.line, seam.keeper)


def brace_extras(segment: Segment, work: Literal["divide", "splice"]) -> Iterator[Extra]:
    """Yield the bracing of a segment that is put on (``divide``) or taken off (``splice``)."""
    for brace in segment.braces:
        yield Bracing(work, segment.name, brace)


def splice_extras(
    segmentation: Segmentation | None, planks: Collection[str], work: Literal["made", "unmade"]
) -> Iterator[Extra]:
    """Yield how planks are cut and spliced that are made into beams (``made``) or that leave (``unmade``)."""
    for splice in segmentation.splices if segmentation else ():
        if any(cut.plank in planks for cut in splice.cuts):
            yield _put(work, splice)


def made_with_splices(works: Iterable[Work], segmentation: Segmentation | None) -> Iterator[Work]:
    """Yield works in which beams and edge planks that are cut for the journey are made with their splices.

    The works that add their planks get an extra for each splice: where the planks are parted, block or plate, bolts.
    """
    for work in works:
        cut = tuple(splice_extras(segmentation, set(work.marks), "made"))
        yield replace(work, extras=(*work.extras, *cut)) if cut else work


def divide_works(gridshell: Gridshell, shell: Shell, segmentation: Segmentation | None, stiff: str) -> tuple[Work, ...]:
    """Return the work that parts a stiff shell into its segments for the journey; none if it travels whole.

    ``stiff`` is the id of the work after which it is stiff. Extras: the bracing of each segment, and what comes out of
    the splices and joints along each cut. Props: those that each segment bears on when it is parted.
    """
    own, cuts = segments_of(segmentation, shell.mark), seams(shell, segmentation)
    if not own:
        return ()
    lines = ", ".join(dict.fromkeys(short_mark(seam.line) for seam in cuts))
    braces = (extra for segment in own for extra in brace_extras(segment, "divide"))
    names = tuple(segment.name for segment in own)
    work = Work(
        f"{shell.mark}.divide",
        "divide",
        text("site.divide.title", shell=shell.mark, segments=names),
        card("divide", fasteners_by_kind(gridshell, (shell,))),
        shell.mark,
        after=(stiff,),
        assemblies=(shell.mark,),
        segments=names,
        least_crew=EVERYONE,
        props=tuple(prop for segment in own for prop in props_under(segment.props, segment.name)),
        extras=(*braces, *(extra for seam in cuts for extra in seam_extras(seam, "divide"))),
        notes=(text("site.divide.order", lines=lines),),
    )
    return (work,)
