"""Pictures for one page in a browser: shapes and whole pictures that come more than once are written once."""

import re
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

_PATH = re.compile(r'<path d="[^"]{40,}"/>')
_HEAD = re.compile(r"<svg [^>]*?(viewBox=\"[^\"]*\")[^>]*>")


@dataclass(frozen=True)
class Shared:
    """What comes more than once, for a ``<defs>`` of the page; and the pictures by name, which use it."""

    defs: str
    pictures: dict[str, str]


def _parts(picture: str) -> tuple[str, str]:
    """Return the view box of an SVG file and what is in it."""
    head = _HEAD.match(picture)
    if head is None:
        raise ValueError(f"not an SVG file with a view box: {picture[:60]!r}")
    return head.group(1), picture[head.end() : picture.rindex("</svg>")]


def shared_pictures(pictures: Mapping[str, str], shown: Iterable[str]) -> Shared:
    """Return pictures for a page on which each is ``shown`` as often as it is named.

    A path that comes again becomes a ``use`` of one in ``defs``: it takes its paint from where it is used. So does a
    whole picture that is shown again. ValueError if a picture is no SVG file with a view box.
    """
    times = Counter(list(shown))
    parts = {name: _parts(pictures[name]) for name in times}
    paths = Counter(found for _, inner in parts.values() for found in _PATH.findall(inner))
    names = {found: f"p{i}" for i, found in enumerate(found for found, count in paths.items() if count > 1)}

    def brief(inner: str) -> str:
        return _PATH.sub(lambda m: f'<use href="#{names[m[0]]}"/>' if m[0] in names else m[0], inner)

    defs = [found.replace("<path ", f'<path id="{name}" ', 1) for found, name in names.items()]
    made = {}
    for name, (view, inner) in parts.items():
        if times[name] > 1:
            defs.append(f'<g id="pic-{name}">{brief(inner)}</g>')
        body = f'<use href="#pic-{name}"/>' if times[name] > 1 else brief(inner)
        made[name] = f"<svg {view}>{body}</svg>"
    return Shared("".join(defs), made)
