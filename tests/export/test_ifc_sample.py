"""A small cut of a gridshell for the tests of the IFC file: some joints of every kind and all that they hold."""

from collections.abc import Sequence
from dataclasses import replace

from making import a_crew, planned_work

from aag_cad.export.ifc.schedule import PlannedWork
from aag_cad.parts.kinds import KINDS
from aag_cad.parts.model import Gridshell, Joint, Part, Shell, all_parts
from assembly.base.steps import Step
from assembly.plan.assembly_plan import plan_of

OF_A_KIND = 2


def _some(joints: Sequence[Joint], of_a_kind: int) -> tuple[Joint, ...]:
    by_kind: dict[str, list[Joint]] = {}
    for joint in joints:
        by_kind.setdefault(joint.kind, []).append(joint)
    return tuple(joint for group in by_kind.values() for joint in group[:of_a_kind])


def _held(joints: Sequence[Joint]) -> set[str]:
    return {mark for joint in joints for mark in (*joint.members, *joint.fasteners)}


def _of_shell(shell: Shell, marks: set[str], joints: tuple[Joint, ...]) -> Shell:
    marks = marks | _held(joints)
    beams = tuple(beam for beam in shell.beams if marks & set(beam.planks))
    marks = marks | {plank for beam in beams for plank in beam.planks}

    def kept(parts: Sequence[Part]) -> tuple[Part, ...]:
        return tuple(part for part in parts if part.mark in marks)

    return replace(
        shell, beams=beams, joints=joints, planks=kept(shell.planks), studs=kept(shell.studs),
        blocks=kept(shell.blocks), bolts=kept(shell.bolts), screws=kept(shell.screws), straps=kept(shell.straps),
        shoes=kept(shell.shoes), rods=kept(shell.rods), footings=kept(shell.footings), mullions=kept(shell.mullions),
        strips=kept(shell.strips), clamps=kept(shell.clamps),
    )  # type: ignore[arg-type] # fmt: skip


def sampled(gridshell: Gridshell, of_a_kind: int = OF_A_KIND) -> Gridshell:
    """Return a gridshell with some joints of each kind in each shell and between shells, and the parts they hold."""
    ridge = _some(gridshell.joints, of_a_kind)
    held = _held(ridge)
    return replace(
        gridshell,
        shells=tuple(_of_shell(shell, held, _some(shell.joints, of_a_kind)) for shell in gridshell.shells),
        blades=tuple(blade for blade in gridshell.blades if blade.mark in held),
        bolts=tuple(bolt for bolt in gridshell.bolts if bolt.mark in held),
        joints=ridge,
    )


def sampled_steps(gridshell: Gridshell, sample: Gridshell) -> tuple[Step, ...]:
    """Return the plan of a gridshell as far as it handles parts of its sample."""
    kept = {part.mark for part in all_parts(sample)} | {shell.mark for shell in sample.shells}
    kept |= {beam.mark for shell in sample.shells for beam in shell.beams}
    return tuple(
        replace(
            step,
            marks=tuple(mark for mark in step.marks if mark in kept),
            assemblies=tuple(mark for mark in step.assemblies if mark in kept),
        )
        for step in plan_of(gridshell, 4, 25.0).steps
    )


def sampled_work(gridshell: Gridshell, sample: Gridshell) -> PlannedWork:
    """Return what a file says of the plan of a gridshell as far as it handles parts of its sample, by four people."""
    return planned_work(sample, sampled_steps(gridshell, sample), a_crew(4))


def test_the_sample_of_the_vault_has_every_kind_of_part(gridshell: Gridshell) -> None:
    sample = all_parts(sampled(gridshell))
    assert {type(part) for part in sample} == {row.part for row in KINDS.values()}
    assert len(sample) < 0.1 * len(all_parts(gridshell))
