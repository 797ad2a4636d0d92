"""The booklets of putting together and taking down: one card a step, read back with pypdf."""

import math
import re
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from making import sheets_for
from pdf_texts import page_texts
from pypdf import PdfReader

from aag_cad.design import Design
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Gridshell, all_parts
from assembly.base.segments import Limits
from assembly.base.steps import Plan, Step
from assembly.booklet.card_tables import gridshell_known, step_table, totals
from assembly.booklet.cards import part_rows, step_card
from assembly.booklet.contents import common_of, sequence_booklet
from assembly.booklet.pdf import booklet_pdf
from assembly.booklet.step_words import step_title, step_words
from assembly.plan.assembly_plan import plan_of
from assembly.plan.durations import step_minutes
from assembly.plan.planned import Planned
from assembly.plan.schedule import schedule_of
from assembly.transport.segments import segments

# Cover, how a shell is made, map of marks, map of blocks, list of steps, laying plan, its coordinates, schedule.
FIRST_PAGES = 8
ACROSS = (3, 5, 7)
# Cover, how to read the cards, list of steps, schedule.
FIRST_PAGES_DOWN = 4


@pytest.fixture(scope="module")
def plan(planned: Planned) -> Plan:
    return planned.plan


def sequence_pdf(planned: Planned, gridshell: Gridshell) -> bytes:
    return booklet_pdf(sequence_booklet(planned, common_of(gridshell, "en")))


@pytest.fixture(scope="module")
def pages(vault_build: Path) -> list[str]:
    return page_texts((vault_build / "sequence.pdf").read_bytes())


@pytest.fixture(scope="module")
def down_pages(vault_build: Path) -> list[str]:
    return page_texts((vault_build / "disassembly.pdf").read_bytes())


@pytest.fixture(scope="module")
def one_shell(gridshell: Gridshell) -> Gridshell:
    return replace(gridshell, shells=gridshell.shells[:1], blades=(), bolts=(), joints=())


@pytest.fixture(scope="module")
def alone(planned: Planned, one_shell: Gridshell) -> Planned:
    """The plan of one shell of the vault, on its own."""
    locking, segments = planned.locking[:1], planned.segmentation.segments[:1]
    steps = tuple(step for step in planned.down.steps if step.shell == "S1")
    return replace(
        planned,
        plan=plan_of(one_shell, 4, 25.0, locking=locking),
        locking=locking,
        segmentation=replace(planned.segmentation, segments=segments),
        down=replace(planned.down, steps=steps),
    )


def says_all(step: Step, titles: dict[str, str], page: str) -> bool:
    """Whether a page has the title, the tools, what comes before, the instructions and the hold point of a step."""
    # A line may end after a hyphen.
    squeezed, told = page.replace(" ", ""), step_words(step, "en")
    words = (*told.tools, *(titles[before] for before in step.predecessors))
    # Line ends and ligatures may fall into a sentence; its first words tell that it is there.
    begun = all(" ".join(line.split()[:2]) in page for line in told.instructions)
    return (
        page.startswith(f"{step.number} {told.title}")
        and all(word.replace(" ", "") in squeezed for word in words)
        and begun
        and ("HOLD" in page) == bool(told.hold) == step.held
    )


def test_each_card_says_what_to_do_with_what_and_after_what(plan: Plan, pages: list[str]) -> None:
    titles = {step.id: step_title(step, "en") for step in plan.steps}
    cards = pages[FIRST_PAGES : FIRST_PAGES + len(plan.steps)]
    silent = [s.number for s, page in zip(plan.steps, cards, strict=True) if not says_all(s, titles, page)]
    assert silent == []


def test_the_cards_of_taking_down_follow_their_plan_to_the_passports(planned: Planned, down_pages: list[str]) -> None:
    plan = planned.down
    titles = {step.id: step_title(step, "en") for step in plan.steps}
    assert len(down_pages) == FIRST_PAGES_DOWN + len(plan.steps)
    cards = down_pages[FIRST_PAGES_DOWN:]
    assert [s.number for s, page in zip(plan.steps, cards, strict=True) if not says_all(s, titles, page)] == []
    assert plan.steps[-1].phase == "passports"
    assert "passport" in down_pages[-1]


def test_the_list_of_steps_names_every_step(plan: Plan, pages: list[str]) -> None:
    listing = " ".join(pages[:FIRST_PAGES])
    assert all(f"{step.number} {step_title(step, 'en')}" in listing for step in plan.steps)


def test_locking_and_segments_close_the_booklet(planned: Planned, pages: list[str]) -> None:
    """The three shells are alike: one locking page for all, and a sheet for each with its own centre of gravity."""
    last = pages[FIRST_PAGES + len(planned.plan.steps) :]
    assert last[0].startswith("Locking: S1, S2, S3")
    assert len(last) == 1 + len(planned.segmentation.segments)
    for segment, page in zip(planned.segmentation.segments, last[1:], strict=True):
        assert segment.name in page
        assert f"{segment.mass:.0f} kg" in page


def test_the_coordinates_of_the_laying_plan_name_every_beam_geodesic_and_stud(
    gridshell: Gridshell, pages: list[str]
) -> None:
    shell = gridshell.shells[0]
    page = pages[6]
    marks = [*(beam.mark for beam in shell.beams), *(stud.mark for stud in shell.studs)]
    marks += [plank.mark for plank in shell.planks if plank.family == "G"]
    assert [mark for mark in marks if mark.removeprefix("S1-") not in page] == []


def test_the_cover_counts_the_parts_of_the_vault(pages: list[str], gridshell: Gridshell) -> None:
    beams = sum(len(shell.beams) for shell in gridshell.shells)
    assert f"coupled beams {beams}" in pages[0]
    assert f"planks {sum(len(shell.planks) for shell in gridshell.shells)}" in pages[0]
    assert gridshell.title in pages[0]


def test_pages_are_a4_one_a_step_for_a_single_shell_too(alone: Planned, one_shell: Gridshell) -> None:
    reader = PdfReader(BytesIO(sequence_pdf(alone, one_shell)))
    assert len(reader.pages) == FIRST_PAGES + len(alone.plan.steps) + 2
    feet = next(step for step in alone.plan.steps if step.phase == "feet")
    assert step_title(feet, "en") in " ".join(reader.pages[FIRST_PAGES + feet.number - 1].extract_text().split())
    for i, page in enumerate(reader.pages):
        size = sorted((float(page.mediabox.width), float(page.mediabox.height)), reverse=i in ACROSS)
        # 210 x 297 mm in points, to the rounding of the writer.
        assert size == pytest.approx([841.89, 595.28] if i in ACROSS else [595.28, 841.89], abs=0.01)
        assert (float(page.mediabox.width) > float(page.mediabox.height)) == (i in ACROSS)


def test_the_laying_plan_is_printed_to_the_scale_that_it_states(alone: Planned, one_shell: Gridshell) -> None:
    """The numbers 0 to 3 of its bar stand a metre apart at that scale, measured in the file on the page's paper."""
    page = PdfReader(BytesIO(sequence_pdf(alone, one_shell))).pages[ACROSS[1]]
    rows: dict[float, list[tuple[float, str]]] = {}

    def collect(text: str, cm: list[float], *_: object) -> None:
        if text.strip():
            rows.setdefault(round(cm[5], 1), []).append((cm[4], text.strip()))

    page.extract_text(visitor_text=collect)
    scale = re.search(r"1 : (\d+)", " ".join(page.extract_text().split()))
    assert scale is not None
    bars = [row for row in rows.values() if [text for _, text in sorted(row)] == ["0", "1", "2", "3"]]
    assert bars
    points_a_metre = 1000.0 / int(scale[1]) * 72.0 / 25.4
    for bar in bars:
        steps = np.diff([x for x, _ in sorted(bar)])
        # A thousandth: what the writer rounds coordinates to.
        assert steps == pytest.approx([points_a_metre] * 3, rel=1e-3)


def test_every_card_of_a_shell_in_segments_is_one_page(alone: Planned, one_shell: Gridshell, design: Design) -> None:
    """For the lorry of 12 x 2.4 x 2.6 m it is cut in three: what is opened and braced is long to tell."""
    cut = segments(one_shell, Limits(12000.0, 2400.0, 2600.0, math.inf, math.inf))
    plan = plan_of(one_shell, 4, 25.0, locking=alone.locking, segmentation=cut)
    when = schedule_of(plan, step_minutes(plan, one_shell, design.crew.minutes), 4, design.crew.hours_per_day)
    pages = page_texts(sequence_pdf(replace(alone, plan=plan, schedule=when, segmentation=cut), one_shell))
    assert len(cut.segments) == 3
    assert len(pages) == FIRST_PAGES + len(plan.steps) + 1 + len(cut.segments)
    cards = pages[FIRST_PAGES : FIRST_PAGES + len(plan.steps)]
    titles = {step.id: step_title(step, "en") for step in plan.steps}
    assert [s.number for s, page in zip(plan.steps, cards, strict=True) if not says_all(s, titles, page)] == []
    for segment in cut.segments:
        (card,) = (card for card in cards if f"Stand segment {segment.name}" in card.split("step site")[0])
        heaviest = re.search(rf"Heaviest piece {re.escape(segment.name)}: ([\d.]+) kg", card)
        assert heaviest is not None
        # From 100 kg on the card gives whole kilograms.
        assert float(heaviest[1]) == pytest.approx(segment.mass, abs=0.5)


def test_the_same_plan_gives_the_same_bytes_without_a_date(alone: Planned, one_shell: Gridshell) -> None:
    common = common_of(one_shell, "en")
    pdf = booklet_pdf(sequence_booklet(alone, common))
    assert pdf == booklet_pdf(sequence_booklet(alone, common_of(one_shell, "en")))
    metadata = PdfReader(BytesIO(pdf)).metadata
    assert metadata is not None
    assert metadata.creation_date is None
    assert not re.search(rb"(CreationDate|ModDate|CreateDate)", pdf)


def test_shells_alike_share_their_pictures(planned: Planned, gridshell: Gridshell) -> None:
    """What is drawn for S1 serves for S2 and S3: on the cards of a shell marks stand without its number."""
    cards = sequence_booklet(planned, common_of(gridshell, "en")).data["cards"]
    drawn = {shell: [card["pictures"] for card in cards if card["shell"] == shell] for shell in ("S1", "S2", "S3")}
    assert drawn["S1"] == drawn["S2"] == drawn["S3"]
    assert len({card["key"] for card in cards if card["shell"]}) == 3


def test_fasteners_are_counted_by_size_with_their_joints(plan: Plan, gridshell: Gridshell) -> None:
    known = gridshell_known(gridshell)
    marks = tuple(f"S1-N-{i:03d}-B{j}" for i in (1, 2, 3) for j in (1, 2, 3, 4))
    bolt = gridshell.shells[0].bolts[0]
    assert part_rows(known, marks) == [["12", f"Bolt M{bolt.diameter:g} x {bolt.length:g}", "at N-001 … N-003, 4 each"]]


def test_steel_and_concrete_are_listed_by_make_with_their_marks(plan: Plan, gridshell: Gridshell) -> None:
    """One line a make: straps of all lengths in one; rods at their blocks, shoes and blocks by their own marks."""
    known, steps = gridshell_known(gridshell), {step.id: step for step in plan.steps}

    def rows(step: str, shell: str) -> dict[str, tuple[str, str]]:
        marks = tuple(mark for mark in steps[step].marks if mark.startswith(shell))
        return {name: (count, where) for count, name, where in part_rows(known, marks)}

    feet = rows("site.feet", "S1")
    assert feet["Concrete block 400 x 380 x 300"] == ("14", "C-01 … C-14")
    assert feet["Shoe 90 x 6"] == ("14", "F-01 … F-14")
    (rod,) = (row for name, row in feet.items() if name.startswith("Threaded rod M16"))
    assert rod == ("14", "at C-01 … C-14")
    assert rows("site.stand.S1", "S1")["Bolt M8 x 40"] == ("56", "at F-01 … F-14, 4 each")
    assert rows("S1.edge.upper", "S1")["Strap 50 x 3"] == ("15", "R-01 … R-15")
    ridge = rows("site.ridge.S1.S2", "R12")
    assert ridge == {
        "Ridge blade 100 x 5": ("7", "R12-01 … R12-07"),
        "Bolt M8 x 40": ("28", "at R12-01 … R12-07, 4 each"),
    }


def test_the_cover_is_listed_by_make_whatever_the_lengths(plan: Plan, gridshell: Gridshell) -> None:
    """One line each for strips, mullions and clamping bars; screws by the side that they are driven from."""
    step = next(step for step in plan.steps if step.id == "site.cover.S1")
    rows = {name: (count, where) for count, name, where in part_rows(gridshell_known(gridshell), step.marks)}
    assert rows["Strip 10 thick"] == ("13", "P-01 … P-13")
    assert rows["Mullion 50 x 3"] == ("14", "M-01 … M-14")
    assert rows["Clamping bar 50 x 2"] == ("14", "D-01 … D-14")
    joints = [joint.mark for joint in gridshell.shells[0].joints if joint.kind == "cover"]
    outside = [count for name, (count, _) in rows.items() if name.startswith("Screw") and name.endswith("outside")]
    assert outside == [str(len(joints))]


def test_the_table_of_the_feet_sets_out_the_concrete_blocks(plan: Plan, gridshell: Gridshell) -> None:
    """Its x and y are those of the middle of each block, where the rod stands, and not of the timber beside it."""
    step = next(step for step in plan.steps if step.phase == "feet")
    table = step_table(gridshell, plan, step, gridshell_known(gridshell))
    assert table is not None
    rows = {mark: (float(x), float(y)) for mark, x, y in table["rows"]}
    assert len(rows) == 42
    for shell in gridshell.shells:
        turn = frame_matrix(shell.placement)[:3, :3]
        for rod in shell.rods:
            place = turn @ np.array(rod.frame.origin)
            assert rows[rod.mark.rpartition("-")[0]] == pytest.approx(place[:2], abs=0.51)


def test_the_parts_of_a_card_add_up_to_its_step(plan: Plan, gridshell: Gridshell) -> None:
    known = gridshell_known(gridshell)
    for step in plan.steps:
        card = step_card(sheets_for(plan, known), step, None, step.marks, ())
        assert sum(int(row[0]) for row in card["parts"]) == len(step.marks)
        assert f": {len(step.marks)} pieces" in card["added"]


def test_the_totals_count_each_part_once(gridshell: Gridshell) -> None:
    table = totals(gridshell, gridshell_known(gridshell))
    *kinds, whole = table["rows"]
    assert sum(int(row[1]) for row in kinds) == int(whole[1])
    assert sum(int(row[2]) for row in kinds) == int(whole[2])
    assert int(whole[2]) == len(all_parts(gridshell))
