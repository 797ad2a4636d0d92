"""Steps for tests of what reads plans: only what a test is about has to be said."""

from typing import Any

from aag_cad.language import Sentence, Text, text
from assembly.base.phases import Phase, is_down
from assembly.base.steps import Step
from assembly.plan.step_cards import card, spanners


def a_card(phase: Phase) -> Text:
    """Return the card of a phase for a gridshell of which nothing is known."""
    if is_down(phase):
        return text(f"down.{phase}", spanners=spanners(()), spring="", studs=text("down.words.studs_stay"))
    return card(phase, {})


def a_step(number: int, title: Sentence = "", phase: Phase = "studs", **said: Any) -> Step:
    """Return a step of one person that adds nothing and waits for nothing, but for what is ``said``."""
    plain: dict[str, Any] = {
        "id": f"s{number}", "shell": "", "marks": (), "assemblies": (), "segments": (), "crew": 1, "gear": False,
        "predecessors": (), "card": a_card(phase),
    }  # fmt: skip
    return Step(number=number, title=title, phase=phase, **plain | said)
