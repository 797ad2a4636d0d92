"""Twins: shells that were made as copies of another one, and what is worked out for one of them and holds for all.

Nobody compares shells to find out: ``Shell.twin_of`` says it, which stands where the copies are made
(``aag_cad.parts.build``). A gridshell from elsewhere that says nothing has no twins.
"""

from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass, replace
from functools import partial
from typing import Any, TypeVar

from aag_cad.geometry.framed import FramedCurve
from aag_cad.parts.index import index_of
from aag_cad.parts.marks import in_other_shell
from aag_cad.parts.model import Gridshell, Shell

_T = TypeVar("_T")


def renamed(value: _T, rename: Callable[[str], str]) -> _T:
    """Return plain data with every text in it renamed, keys too; curves and arrays are shared, not copied."""
    new: Any = value
    if isinstance(value, str):
        new = rename(value)
    elif isinstance(value, tuple):
        new = tuple(renamed(item, rename) for item in value)
    elif isinstance(value, Mapping):
        new = {renamed(key, rename): renamed(item, rename) for key, item in value.items()}
    elif is_dataclass(value) and not isinstance(value, type | FramedCurve):
        new = replace(value, **{f.name: renamed(getattr(value, f.name), rename) for f in fields(value)})
    return new  # type: ignore[no-any-return]


def made_for_each(gridshell: Gridshell, make: Callable[[Shell], _T]) -> dict[str, _T]:
    """Return what is made of each shell, by its mark: of a twin that of its first shell, with its own number in marks.

    What is made must be in the coordinates of the shell, in which twins are equal.
    """
    made: dict[str, _T] = {}
    for mark, shell in index_of(gridshell).shells.items():
        first = index_of(gridshell).twins[mark]
        own = partial(in_other_shell, shell=first, other=mark)
        made[mark] = make(shell) if first == mark else renamed(made[first], own)
    return made
