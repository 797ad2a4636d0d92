"""Marks that pictures name: numbers of joints, feet of a shell, one of several like pieces."""

from collections.abc import Sequence
from typing import TypeVar

from aag_cad.parts.marks import number_of
from aag_cad.parts.model import Shell

_T = TypeVar("_T")


def numbers_of(marks: Sequence[str]) -> dict[str, str]:
    """Return marks with their last numbers."""
    return {mark: number_of(mark) for mark in marks}


def middle_of(pieces: Sequence[_T]) -> Sequence[_T]:
    """Return the middle one of pieces as a list, an empty list without any."""
    return pieces[len(pieces) // 2 : len(pieces) // 2 + 1]


def feet_of(shell: Shell) -> tuple[str, ...]:
    """Return the joints at which a shell stands on its shoes."""
    return tuple(joint.mark for joint in shell.joints if joint.kind == "foot")
