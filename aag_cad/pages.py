"""HTML pages by jinja2, the one file that knows it: templates of ``printouts`` with their data and pictures."""

from collections.abc import Mapping
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from aag_cad.resources import template


def html_page(name: str, data: Mapping[str, Any], pictures: Mapping[str, str]) -> str:
    """Return the template ``printouts/name.html`` filled as HTML; the same data and pictures give the same text.

    Texts are escaped; ``pictures`` are SVG and go in as they are. FileError if there is no such template.
    """
    page = template("printouts", f"{name}.html")
    made = Environment(
        autoescape=True,
        loader=FileSystemLoader(page.parent),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    made.policies["json.dumps_kwargs"] = {"ensure_ascii": False, "separators": (",", ":")}
    drawn = {title: Markup(picture) for title, picture in pictures.items()}
    return made.get_template(page.name).render(data, pictures=drawn)
