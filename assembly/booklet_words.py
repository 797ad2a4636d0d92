"""The words of the booklets in one language, for their templates."""

from typing import Any

from assembly.language import Language, words_table


def booklet_words(language: Language) -> dict[str, Any]:
    """Return the words of the booklets in a language, as nested as their table."""

    def spoken(found: Any) -> Any:
        if language in found:
            return found[language]
        return {key: spoken(value) for key, value in found.items()}

    words: dict[str, Any] = spoken(words_table("booklet"))
    return words
