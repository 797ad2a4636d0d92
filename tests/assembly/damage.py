"""Plans damaged on purpose: steps left out or changed, parts moved to other steps."""

from dataclasses import replace

from assembly.base.steps import Plan


def without(plan: Plan, step_id: str) -> Plan:
    """Return a plan that lacks a step."""
    return replace(plan, steps=tuple(step for step in plan.steps if step.id != step_id))


def changed(plan: Plan, step_id: str, **changes: object) -> Plan:
    """Return a plan with a step changed."""
    steps = (replace(step, **changes) if step.id == step_id else step for step in plan.steps)  # type: ignore[arg-type]
    return replace(plan, steps=tuple(steps))


def moved(plan: Plan, mark: str, step_id: str) -> Plan:
    """Return a plan in which another step handles a part."""
    steps = (replace(step, marks=tuple(other for other in step.marks if other != mark)) for step in plan.steps)
    steps = (replace(step, marks=(*step.marks, mark)) if step.id == step_id else step for step in steps)
    return replace(plan, steps=tuple(steps))
