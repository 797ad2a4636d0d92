"""What is made once for an object and kept as long as the object lives."""

import weakref
from collections.abc import Callable
from functools import wraps
from typing import TypeVar

_Whole = TypeVar("_Whole")
_Made = TypeVar("_Made")


def once(make: Callable[[_Whole], _Made]) -> Callable[[_Whole], _Made]:
    """Return a function that answers the same object with the same result, made at the first call.

    Objects are told apart by identity, not by value: to hash a gridshell takes longer than most of what is made of it.
    The result must not hold the object itself, or neither would ever be let go.
    """
    kept: dict[int, _Made] = {}

    @wraps(make)
    def made(whole: _Whole) -> _Made:
        if id(whole) not in kept:
            kept[id(whole)] = make(whole)
            weakref.finalize(whole, kept.pop, id(whole))
        return kept[id(whole)]

    return made
