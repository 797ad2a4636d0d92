"""Steps and planned work for tests of what reads plans: only what a test is about has to be said."""

from collections.abc import Sequence
from typing import Any

from aag_cad.design_making import Crew
from aag_cad.export.ifc.schedule import PlannedWork
from aag_cad.language import Sentence, Text, text
from aag_cad.parts.model import Gridshell
from assembly.base.phases import Phase, is_down
from assembly.base.steps import Plan, Step
from assembly.booklet.cards import Known, Sheets
from assembly.booklet.words import sheet_words
from assembly.plan.assembly_plan import plan_of
from assembly.plan.durations import step_minutes
from assembly.plan.schedule import Schedule, schedule_of
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


def a_crew(people: int, **said: Any) -> Crew:
    """Return a crew who lift 25 kg each."""
    return Crew.model_validate({"people": people, "lift_limit": 25.0} | said)


def planned_work(gridshell: Gridshell, steps: Sequence[Step], crew: Crew) -> PlannedWork:
    """Return the steps of a gridshell with their schedule for a crew."""
    plan = Plan(gridshell.name, tuple(steps))
    minutes = step_minutes(plan, gridshell, crew.minutes)
    return PlannedWork(plan, schedule_of(plan, minutes, crew.people, crew.hours_per_day), crew)


def work_of(gridshell: Gridshell, people: int) -> PlannedWork:
    """Return the whole plan of a gridshell with its schedule for a crew."""
    return planned_work(gridshell, plan_of(gridshell, people, 25.0).steps, a_crew(people))


def sheets_for(plan: Plan, known: Known) -> Sheets:
    """Return what the cards of a plan are made from, without its schedule."""
    words = sheet_words("disassembly" if is_down(plan.steps[0].phase) else "sequence", known.language)
    return Sheets("sequence", plan.name, plan, Schedule(plan.name, 4, 480, (), (), 0), known, words)
