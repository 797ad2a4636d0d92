"""The sliding in of a piece between others that lie already: told alike of a shell and of any weave."""

from dataclasses import replace
from math import isfinite

from aag_cad.language import Text, text
from aag_cad.parts.marks import short_in
from assembly.base.mark_ranges import named_in
from assembly.graph.interlacing import Slide
from assembly.plan.work import PAIR, Work


def slide_title(slide: Slide, shell: str) -> Text:
    """Return the title of a slide's step in a shell, or in none."""
    return text("steps.slide.title", marks=named_in((slide.unit,), shell))


def told_slide(work: Work, slide: Slide, length: float) -> Work:
    """Return the work of a slide with what its card says: where the piece, ``length`` mm long, is laid down and pushed.

    At every crossing in turn, whether it lies over or under the other.
    """
    free = text("steps.slide.free", free=slide.free) if isfinite(slide.free) else text("steps.slide.open")
    crossings = []
    for at in slide.passed:
        side, other = ("over", at.lower) if at.upper == slide.unit else ("under", at.upper)
        joint, passed = short_in(at.joint, work.shell), short_in(other, work.shell)
        crossings.append(text(f"steps.slide.{side}", joint=joint, other=passed))
    notes = (
        text("steps.slide.place", end=text(f"steps.slide.{slide.end}"), needed=length, free=free),
        text("steps.slide.way", crossings=tuple(crossings)),
    )
    return replace(work, least_crew=PAIR, notes=notes)
