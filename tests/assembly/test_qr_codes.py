"""QR codes of the cards: as an encoder of its own right makes them, small enough to be read from paper."""

import re

import numpy as np
import pytest
import segno

from aag_cad.parts.model import Gridshell
from assembly.base.errors import PlanError
from assembly.booklet.booklet_data import Booklet
from assembly.booklet.contents import common_of, sequence_booklet
from assembly.booklet.qr import MOST_CHARACTERS, qr_rows, qr_svg
from assembly.plan.planned import Planned

# The side of the code on a card, and the smallest module that a telephone reads at arm's length, mm.
SIDE, LEAST_MODULE = 21.0, 0.3


@pytest.mark.parametrize("content", ["vault S1.lay.1: A1-01 … A1-06", "x", "S1-G-05" * 20])
def test_a_code_is_one_of_the_eight_that_hold_its_text(content: str) -> None:
    rows = qr_rows(content)
    every = [segno.make_qr(content, error="m", mask=mask).matrix for mask in range(8)]
    assert rows in [[list(row) for row in matrix] for matrix in every]


def test_the_bars_of_the_picture_cover_the_dark_modules_and_no_others() -> None:
    rows = np.array(qr_rows("vault S1.hoist: S1"))
    drawn = np.zeros_like(rows)
    for x, y, width in re.findall(r"M(\d+) (\d+)h(\d+)v1", qr_svg("vault S1.hoist: S1")):
        drawn[int(y), int(x) : int(x) + int(width)] += 1
    assert np.array_equal(drawn, rows)


@pytest.mark.parametrize("content", ["", "x" * (MOST_CHARACTERS + 1)])
def test_nothing_and_too_much_are_refused(content: str) -> None:
    with pytest.raises(PlanError, match=f"allowed 1 to {MOST_CHARACTERS}"):
        qr_svg(content)


@pytest.fixture(scope="module")
def booklet(planned: Planned, gridshell: Gridshell) -> Booklet:
    return sequence_booklet(planned, common_of(gridshell, "en"))


def test_the_codes_of_the_cards_can_be_read_from_paper(booklet: Booklet) -> None:
    for card in booklet.data["cards"]:
        found = re.search(r'viewBox="0 0 (\d+) ', booklet.pictures[f"qr-{card['number']}"])
        assert found is not None
        assert SIDE / int(found[1]) >= LEAST_MODULE, card["id"]
