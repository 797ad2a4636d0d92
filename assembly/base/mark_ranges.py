"""Lists of marks in short: neighbours become a range."""

from collections import defaultdict
from collections.abc import Iterable, Sequence

from aag_cad.errors import MarkError
from aag_cad.parts.marks import Mark, parse_mark, short_mark

_PAIR = 2


def _neighbours(numbers: Iterable[int]) -> list[tuple[int, ...]]:
    """Return numbers singly, and first and last of three neighbours or more."""
    rows: list[list[int]] = []
    for number in sorted(numbers):
        if rows and number == rows[-1][-1] + 1:
            rows[-1].append(number)
        else:
            rows.append([number])
    pieces = ([(row[0], row[-1])] if len(row) > _PAIR else [(number,) for number in row] for row in rows)
    return [piece for listed in pieces for piece in listed]


def mark_ranges(marks: Sequence[str]) -> tuple[str, ...]:
    """Return marks without their shell, sorted; three neighbours or more as a range: ``A1-01 … A1-04 L+R``.

    Marks of several shells keep theirs.
    """
    parsed = [parse_mark(mark) for mark in marks]
    alone = len({mark.shell for mark in parsed}) <= 1
    sides: dict[tuple[int, str, int], list[str]] = defaultdict(list)
    for mark in sorted(set(parsed)):
        sides[mark.shell, mark.family, mark.index].append(mark.part)
    groups: dict[tuple[int, str, str], list[int]] = defaultdict(list)
    for (shell, family, index), parts in sides.items():
        groups[shell, family, "+".join(part for part in parts if part)].append(index)
    texts = []
    for (shell, family, part), numbers in groups.items():
        for row in _neighbours(numbers):
            ends = [str(Mark(shell, family, number)) for number in row]
            text = " … ".join(short_mark(end) if alone else end for end in ends)
            texts.append(f"{text} {part}" if part else text)
    return tuple(texts)


def joined_ranges(marks: Sequence[str]) -> str:
    """Return the ranges of marks as one text."""
    return ", ".join(mark_ranges(marks))


def named_in(marks: Sequence[str], shell: str) -> str:
    """Return marks as one text for a card: in ranges and short if they belong to a shell, and else whole."""
    return named_marks(marks) if shell else ", ".join(marks)


def ranges_of(marks: Sequence[str]) -> tuple[str, ...]:
    """Return the ranges of marks if they are those of a gridshell, and else the marks as they are."""
    try:
        return mark_ranges(marks)
    except MarkError:
        return tuple(marks)


def named_marks(marks: Sequence[str]) -> str:
    """Return marks as one text: in ranges if they are those of a gridshell, and else as they are."""
    return ", ".join(ranges_of(marks))
