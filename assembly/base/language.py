"""The words of all that is printed, in English and in German, from one set of tables: ``templates/printouts/words``.

Each table is a TOML file; an entry has the same text once in each language, ``en`` and ``de``: a string or a list of
strings, with ``{names}`` where figures go.
"""

import tomllib
from functools import cache
from typing import Any, Literal, TypeAlias, get_args

from aag_cad.resources import template
from assembly.base.errors import PlanError

Language: TypeAlias = Literal["en", "de"]
LANGUAGES: tuple[Language, ...] = get_args(Language)


def language_of(text: str) -> Language:
    """Return the language with a code; PlanError with the codes that there are."""
    for language in LANGUAGES:
        if text == language:
            return language
    raise PlanError(f"--lang: {text!r}; there are {', '.join(LANGUAGES)}")


@cache
def words_table(name: str) -> dict[str, Any]:
    """Return a table of words as it is in its file."""
    with template("printouts", "words", f"{name}.toml").open("rb") as file:
        return tomllib.load(file)


def _entry(language: Language, key: str) -> Any:
    name, *path = key.split(".")
    found: Any = words_table(name)
    for part in path:
        found = found[part]
    return found[language]


def say(language: Language, key: str, **figures: object) -> str:
    """Return a text by its key, table and path parted by dots, with its figures filled in; KeyError without one."""
    text: str = _entry(language, key)
    return text.format_map(figures)


def says(language: Language, key: str, **figures: object) -> tuple[str, ...]:
    """Return a list of texts by its key, with its figures filled in; KeyError without one."""
    return tuple(text.format_map(figures) for text in _entry(language, key))
