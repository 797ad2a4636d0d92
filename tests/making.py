"""Steps for tests of what reads plans: only what a test is about has to be said."""

from typing import Any

from aag_cad.language import Sentence, text
from assembly.base.phases import Phase
from assembly.base.steps import Step


def a_step(number: int, title: Sentence = "", phase: Phase = "studs", **said: Any) -> Step:
    """Return a step of one person that adds nothing and waits for nothing, but for what is ``said``."""
    plain: dict[str, Any] = {
        "id": f"s{number}", "shell": "", "marks": (), "assemblies": (), "segments": (), "crew": 1, "gear": False,
        "predecessors": (), "card": text(f"phases.{phase}"),
    }  # fmt: skip
    return Step(number=number, title=title, phase=phase, **plain | said)
