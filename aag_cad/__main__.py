"""``python -m aag_cad`` is the ``aag`` command."""

from aag_cad.cli import app

app(prog_name="aag")
