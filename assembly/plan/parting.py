"""How a shell that is cut for the journey is made with its splices, and parted when it is stiff.

It is put together whole in the workshop, because only whole it takes its shape. Every part is added there once; what
the parting takes out and the joining puts in again are ``extras`` of these steps, and so is the bracing.
"""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace

from aag_cad.language import Figure, Language, say
from aag_cad.parts.marks import joint_of, parse_mark, short_mark
from aag_cad.parts.model import Shell
from assembly.base.mark_ranges import joined_ranges
from assembly.base.segments import Segment, Segmentation, Splice, segments_of
from assembly.plan.shell_work import EVERYONE, Work
from assembly.transport.seams import Seam, seams
from assembly.transport.segment_sheet import brace_words

_KINDS = {"W": "screw", "B": "bolt", "K": "block", "R": "strap", "N": "stud"}


def _fasteners(language: Language, marks: Sequence[str]) -> str:
    """Return how many fasteners of each kind there are, in words."""
    kinds = Counter(_KINDS.get(parse_mark(mark).letter, "bolt") for mark in marks)
    counted = ((kind if count == 1 else f"{kind}s", count) for kind, count in sorted(kinds.items()))
    return ", ".join(say(language, f"site.count.{kind}", count=count) for kind, count in counted)


def _figures(splice: Splice) -> dict[str, Figure]:
    """Return what every sentence about a splice may say: marks without their shell, length, bolts."""
    return {
        "line": short_mark(splice.line),
        "beam": short_mark(splice.member),
        "joint": short_mark(splice.joint) if splice.joint else "",
        "length": splice.length,
        "bolts": splice.bolts,
        "diameter": splice.diameter,
    }


def seam_extras(language: Language, seam: Seam, chapter: str) -> Iterator[str]:
    """Yield what is taken out at a seam (``divide``) or put in again (``splice``): splices with bolts, fasteners."""
    for splice in seam.splices:
        side = "inside" if parse_mark(splice.member).family == "A1" else "outside"
        yield say(
            language,
            f"site.{chapter}.{splice.kind}",
            **_figures(splice),
            side=say(language, f"site.{chapter}.{side}"),
        )
    if seam.fasteners:
        joints = joined_ranges(tuple(dict.fromkeys(map(joint_of, seam.fasteners))))
        told = _fasteners(language, seam.fasteners)
        yield say(language, f"site.{chapter}.fasteners", line=short_mark(seam.line), fasteners=told, joints=joints)
    yield say(language, f"site.{chapter}.lash", line=short_mark(seam.line), keeper=seam.keeper)


def brace_extras(language: Language, segment: Segment, chapter: str) -> Iterator[str]:
    """Yield the bracing of a segment that is put on (``divide``) or taken off (``splice``)."""
    for brace in segment.braces:
        yield say(language, f"site.{chapter}.brace", segment=segment.name, brace=brace_words(brace, language))


def splice_extras(
    language: Language, segmentation: Segmentation | None, planks: Collection[str], chapter: str
) -> Iterator[str]:
    """Yield how planks are cut and spliced that are made into beams (``made``) or that leave (``unmade``)."""
    for splice in segmentation.splices if segmentation else ():
        if any(cut.plank in planks for cut in splice.cuts):
            yield _spliced(language, splice, chapter)


def _spliced(language: Language, splice: Splice, chapter: str) -> str:
    stations = [cut.station for cut in splice.cuts]
    return say(
        language,
        f"site.{chapter}.{splice.kind}",
        **_figures(splice),
        left=stations[0],
        right=stations[-1],
    )


def made_with_splices(
    works: Iterable[Work], segmentation: Segmentation | None, language: Language = "en"
) -> Iterator[Work]:
    """Yield works in which beams and edge planks that are cut for the journey are made with their splices.

    The works that add their planks get an extra for each splice: where the planks are parted, block or plate, bolts.
    """
    for work in works:
        cut = tuple(splice_extras(language, segmentation, set(work.marks), "made"))
        yield replace(work, extras=(*work.extras, *cut)) if cut else work


def divide_works(shell: Shell, segmentation: Segmentation | None = None, language: Language = "en") -> tuple[Work, ...]:
    """Return the work that parts a stiff shell into its segments for the journey; none if it travels whole.

    Extras: the bracing of each segment, and what comes out of the splices and joints along each cut. Props: those that
    each segment bears on when it is parted.
    """
    own, cuts = segments_of(segmentation, shell.mark), seams(shell, segmentation)
    if not own:
        return ()
    lines = ", ".join(dict.fromkeys(short_mark(seam.line) for seam in cuts))
    braces = (extra for segment in own for extra in brace_extras(language, segment, "divide"))
    names = ", ".join(segment.name for segment in own)
    work = Work(
        f"{shell.mark}.divide",
        "divide",
        say(language, "site.divide.title", shell=shell.mark, segments=names),
        after=(f"{shell.mark}.tighten",),
        assemblies=(shell.mark,),
        least_crew=EVERYONE,
        props=tuple(dict.fromkeys(mark for segment in own for mark in segment.props)),
        extras=(*braces, *(extra for seam in cuts for extra in seam_extras(language, seam, "divide"))),
        notes=(say(language, "site.divide.order", lines=lines),),
    )
    return (work,)
