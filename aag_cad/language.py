"""Sentences as data, and their words in English and in German, from one set of tables: ``templates/printouts/words``.

Each table is a TOML file; an entry has the same text once in each language, ``en`` and ``de``: a string or a list of
strings, with ``{names}`` where figures go. What is planned holds a ``Text``, a key with its figures; a sentence is made
of it only where it is printed.
"""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any, Literal, TypeAlias, get_args

from aag_cad.errors import DesignError, FileError
from aag_cad.resources import template

Language: TypeAlias = Literal["en", "de"]
LANGUAGES: tuple[Language, ...] = get_args(Language)

Figure: TypeAlias = "str | int | float | Text | tuple[Text | str, ...]"


@dataclass(frozen=True)
class Text:
    """A sentence in no language yet: the key of its words, table and path parted by dots, and the figures in them.

    A figure is a number, a text that is the same in all languages, another ``Text``, or a list of these, which is
    joined by the words under the key in the place's format (``{bolts:phases.words.and}``), else by commas. Decimal
    signs are those of the language.
    """

    key: str
    figures: Mapping[str, Figure] = field(default_factory=dict, hash=False)


Sentence: TypeAlias = Text | str


def text(key: str, **figures: Figure) -> Text:
    """Return a sentence as data, by the key of its words and its figures."""
    return Text(key, figures)


def language_of(code: str) -> Language:
    """Return the language with a code; DesignError with the codes that there are."""
    for language in LANGUAGES:
        if code == language:
            return language
    raise DesignError(f"--lang: {code!r}; there are {', '.join(LANGUAGES)}")


@cache
def words_table(name: str) -> dict[str, Any]:
    """Return a table of words as it is in its file."""
    with template("printouts", "words", f"{name}.toml").open("rb") as file:
        return tomllib.load(file)


@cache
def _entry(language: Language, key: str) -> Any:
    name, *path = key.split(".")
    found: Any = words_table(name)
    for part in path:
        found = found[part]
    return found[language]


def has_words(key: str) -> bool:
    """Return whether a table has words under a key, in any language."""
    try:
        _entry(LANGUAGES[0], key)
    except (KeyError, TypeError, FileError):
        return False
    return True


def figure(number: str, language: Language) -> str:
    """Return a printed number with the decimal sign of a language."""
    return number.replace(".", ",") if language == "de" else number


@dataclass(frozen=True)
class _Printed:
    """A figure that is printed when its place in a text is filled."""

    value: Figure
    language: Language

    def __format__(self, spec: str) -> str:
        match self.value:
            case Text() as told:
                return printed(told, self.language)
            case tuple() as listed:
                joiner = _entry(self.language, spec) if spec else ", "
                return str(joiner).join(printed(told, self.language) for told in listed)
            case float() as number:
                return figure(format(number, spec or "g"), self.language)
            case value:
                return format(value, spec)


def printed(sentence: Sentence, language: Language) -> str:
    """Return a sentence in a language; KeyError if no table has its words. A plain string stands as it is."""
    if isinstance(sentence, str):
        return sentence
    return say(language, sentence.key, **sentence.figures)


def say(language: Language, key: str, **figures: Figure) -> str:
    """Return a text by its key with its figures filled in; KeyError without one."""
    words: str = _entry(language, key)
    return words.format_map({name: _Printed(value, language) for name, value in figures.items()})


def says(language: Language, key: str, **figures: Figure) -> tuple[str, ...]:
    """Return a list of texts by its key, with its figures filled in; KeyError without one."""
    filled = {name: _Printed(value, language) for name, value in figures.items()}
    return tuple(words.format_map(filled) for words in _entry(language, key))
