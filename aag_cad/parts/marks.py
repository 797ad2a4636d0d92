"""The grammar of marks: the one place that prints and parses them.

S1 shell; S1-A1-07 beam, S1-A1-07-L and -R its planks; S1-G-05 geodesic; S1-E-02 edge plank; S1-N-031 stud and AA joint;
S1-K-012 coupling block and its joint; S1-F-05 shoe and foot joint; S1-R-05 strap and ridge joint of a geodesic;
S1-C-05 concrete block; S1-P-05 strip; S1-M-05 mullion; S1-D-05 clamping bar; S1-V-012 joint of mullion, strips and
clamping bar on a block; R12-03 ridge blade and its joint; a bolt, screw or threaded rod adds -B1, -W1 or -T1 to the
mark of its joint.
"""

import re
from dataclasses import dataclass, replace
from functools import cache

from aag_cad.errors import MarkError
from aag_cad.families import BEAMS, FAMILIES
from aag_cad.parts.kinds import KINDS

# The joints of the cover, which are no parts.
_COVER = {"V": 3}
_BLADE = re.compile(r"R(?P<pair>[1-9][1-9])-(?P<index>\d{2,5})(?:-(?P<part>B[1-9]\d?))?")
_OWNER = re.compile(r"(?:S(?P<shell>[1-9]\d?)(?=-|$)|R(?P<pair>[1-9][1-9])(?=-))")
_ADDED = re.compile(r"(?P<joint>.+)-(?P<letter>[A-Z])[1-9]\d?")


@dataclass(frozen=True, eq=False)
class _Letters:
    """The letters of all kinds: the digits of each family, the letters of fasteners, the pattern of a mark."""

    digits: dict[str, int]
    fasteners: str
    pattern: re.Pattern[str]


@cache
def _letters_of(kinds: tuple[type, ...]) -> _Letters:
    rows = [KINDS[kind] for kind in kinds if KINDS[kind].letter]
    fasteners = "".join(row.letter for row in rows if row.role == "fastener")
    digits = dict.fromkeys(FAMILIES, 2) | _COVER | {row.letter: row.digits for row in rows if row.role != "fastener"}
    family = rf"(?P<family>{'|'.join(digits)})-(?P<index>\d{{2,5}})(?:-(?P<part>[LR]|[{fasteners}][1-9]\d?))?"
    return _Letters(digits, fasteners, re.compile(rf"S(?P<shell>[1-9]\d?)(?:-{family})?"))


def _letters() -> _Letters:
    return _letters_of(tuple(KINDS))


@dataclass(frozen=True, order=True)
class Mark:
    """A parsed mark: shell number (0 for a blade), family ("" for a shell), index, and what it adds ("L", "B1"...).

    A blade has the family "R12" of the pair of shells that it joins.
    """

    shell: int
    family: str = ""
    index: int = 0
    part: str = ""

    @property
    def letter(self) -> str:
        """That of a fastener, such as B for a bolt, else the family."""
        return self.part[0] if self.part and self.part[0] in _letters().fasteners else self.family

    def __str__(self) -> str:
        """Return the mark as it is printed everywhere."""
        if self.shell == 0:
            return f"{self.family}-{self.index:02d}" + (f"-{self.part}" if self.part else "")
        text = f"S{self.shell}"
        if self.family:
            text += f"-{self.family}-{self.index:0{_letters().digits[self.family]}d}"
        return text + (f"-{self.part}" if self.part else "")


@cache
def parse_mark(text: str) -> Mark:
    """Return the parsed mark; MarkError if the text is not one, or not printed as we print it."""
    if blade := _BLADE.fullmatch(text):
        mark = Mark(0, f"R{blade['pair']}", int(blade["index"]), blade["part"] or "")
    elif found := _letters().pattern.fullmatch(text):
        mark = Mark(int(found["shell"]), found["family"] or "", int(found["index"] or 0), found["part"] or "")
    else:
        raise MarkError(
            f"{text!r} is not a mark; marks look like S1, S1-A1-07, S1-A1-07-L, S1-G-05, S1-N-031 or R12-03"
        )
    if not mark.shell and mark.family[1] == mark.family[2]:
        raise MarkError(f"{text!r} is not a mark: a ridge blade joins two different shells, as in R12-03")
    if mark.part and (mark.part in "LR") != (mark.family in BEAMS):
        raise MarkError(f"{text!r} is not a mark: only planks of A beams end in L or R, only fasteners in B1, W1 or T1")
    if str(mark) != text or (mark.family and mark.index == 0):
        raise MarkError(f"{text!r} is not a mark as it is printed; {str(mark)!r} would be, with indices from 1")
    return mark


def shell_of(text: str) -> str:
    """Return the mark of the shell that a part belongs to, or "" for a ridge blade."""
    mark = parse_mark(text)
    return f"S{mark.shell}" if mark.shell else ""


def shells_of(text: str) -> tuple[str, ...]:
    """Return the marks of the shells that a part belongs to: its own, or the two that a ridge blade joins."""
    mark = parse_mark(text)
    return (f"S{mark.shell}",) if mark.shell else tuple(f"S{number}" for number in mark.family[1:])


def family_mark(text: str) -> str:
    """Return shell and family of a part, as S1-G."""
    mark = parse_mark(text)
    return f"S{mark.shell}-{mark.family}"


def is_in_shell(text: str, shell: str) -> bool:
    """Return whether a mark is that of a shell, of something in it, or the name of a segment of it."""
    return text == shell or text.startswith((f"{shell}-", f"{shell}."))


def in_other_shell(text: str, shell: str, other: str) -> str:
    """Return a mark of one shell as that of its twin in another; what is not in the first shell as it is."""
    return other + text.removeprefix(shell) if is_in_shell(text, shell) else text


def turned_mark(text: str, places: int, count: int) -> str:
    """Return a mark of a shell or ridge as that of the one some places on, of ``count`` about the centre.

    Every other text comes back as it is.
    """
    found = _OWNER.match(text)
    if found is None:
        return text
    numbers = ((int(number) - 1 + places) % count + 1 for number in (found["pair"] or (found["shell"],)))
    return "".join((text[0], *map(str, numbers), text[found.end() :]))


def ridge_name(first: int, second: int) -> str:
    """Return the family of the blades between two shells, given by their numbers: R12."""
    return f"R{first}{second}"


def short_mark(text: str) -> str:
    """Return a mark without its shell, as it stands on a drawing of that shell."""
    mark = parse_mark(text)
    return text.removeprefix(f"S{mark.shell}-") if mark.shell and mark.family else text


def number_of(text: str) -> str:
    """Return the number of a mark as it is printed in it: 031 of S1-N-031."""
    mark = parse_mark(text)
    return f"{mark.index:0{_letters().digits.get(mark.family, 2)}d}"


def part_mark(whole: str | Mark, part: str) -> str:
    """Return the mark of a plank (L, R) of a beam or of a fastener (B1, W1, T1) of a joint."""
    return f"{whole}-{part}"


def whole_of(text: str) -> str:
    """Return the mark of the beam or joint that a plank or fastener belongs to, of all else its own."""
    return str(replace(parse_mark(text), part=""))


def piece_mark(plank: str, segment: str) -> str:
    """Return the name of the piece of a cut plank that is in a segment."""
    return f"{plank}@{segment}"


def plank_of(text: str) -> str:
    """Return the mark of the plank of a piece, or of a whole plank itself."""
    return text.partition("@")[0]


def joint_of(text: str) -> str:
    """Return the mark of the joint that a bolt, screw or threaded rod belongs to, or "" for what is none."""
    found = _ADDED.fullmatch(text)
    return found["joint"] if found and found["letter"] in _letters().fasteners else ""


def short_in(mark: str, shell: str) -> str:
    """Return a mark as it stands on a card of a shell: without the shell's own in front, and all others whole."""
    return mark.removeprefix(f"{shell}-") if shell else mark
