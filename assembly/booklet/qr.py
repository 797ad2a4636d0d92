"""QR codes as SVG, one module a unit, without a quiet zone: the page around them is white."""

import segno

from assembly.base.errors import PlanError

MOST_CHARACTERS = 600
_MASK = 2


def qr_rows(content: str) -> list[list[int]]:
    """Return a QR code as rows of modules, 1 dark and 0 light, error correction M or better.

    PlanError if there is nothing to say, or more than a telephone reads from a square of 20 mm.
    """
    if not 0 < len(content) <= MOST_CHARACTERS:
        raise PlanError(f"QR code: {len(content)} characters; allowed 1 to {MOST_CHARACTERS}: shorten the text")
    # Any mask can be read; to weigh all eight against each other would take most of the time of a booklet.
    return [list(row) for row in segno.make_qr(content, error="m", mask=_MASK).matrix]


def _bars(rows: list[list[int]]) -> list[tuple[int, int, int]]:
    """Return the dark modules as bars (column, row, width): fewer shapes, and no seams along a row."""
    bars = []
    for y, row in enumerate(rows):
        start = None
        for x, dark in enumerate([*row, 0]):
            if dark and start is None:
                start = x
            elif not dark and start is not None:
                bars.append((start, y, x - start))
                start = None
    return bars


def qr_svg(content: str) -> str:
    """Return the QR code of a text as SVG; PlanError if it is empty or too long."""
    rows = qr_rows(content)
    bars = "".join(f"M{x} {y}h{width}v1h-{width}z" for x, y, width in _bars(rows))
    size = len(rows)
    view = f'width="{size}" height="{size}" viewBox="0 0 {size} {size}" shape-rendering="crispEdges"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {view}><path d="{bars}"/></svg>\n'
