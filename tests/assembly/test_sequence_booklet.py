"""The booklet: one card a step, read back with pypdf."""

import re
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from pypdf import PdfReader

from aag_cad.errors import FileError
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Gridshell, Part, all_parts
from assembly.cards import part_rows, step_card, step_table, totals
from assembly.plan import piece_weights, plan_of
from assembly.printout import sequence_pdf, write_sequence
from assembly.steps import Plan, Step

FIRST_PAGES = 3


@pytest.fixture(scope="module")
def plan(gridshell: Gridshell) -> Plan:
    return plan_of(gridshell, 4, 25.0)


@pytest.fixture(scope="module")
def pages(plan: Plan, gridshell: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    path = tmp_path_factory.mktemp("booklet") / "sequence.pdf"
    write_sequence(plan, gridshell, path)
    found = list(PdfReader(path).pages)
    assert len(found) == FIRST_PAGES + len(plan.steps)
    read = [*range(FIRST_PAGES), *(FIRST_PAGES + step.number - 1 for step in shown(plan))]
    return [" ".join(found[i].extract_text().split()) for i in read]


def shown(plan: Plan) -> list[Step]:
    """The steps whose cards are read: those of the first shell, which the others repeat, and those on site."""
    return [step for step in plan.steps if step.shell in ("S1", "")]


@pytest.fixture(scope="module")
def one_shell(gridshell: Gridshell) -> Gridshell:
    return replace(gridshell, shells=gridshell.shells[:1], blades=(), bolts=(), joints=())


def test_each_card_says_what_to_do_with_what_and_after_what(plan: Plan, pages: list[str]) -> None:
    titles = {step.id: step.title for step in plan.steps}
    for step, page in zip(shown(plan), pages[FIRST_PAGES:], strict=True):
        assert page.startswith(f"{step.number} {step.title}")
        # A line may end after a hyphen.
        squeezed = page.replace(" ", "")
        for words in (*step.tools, *(titles[before] for before in step.predecessors)):
            assert words.replace(" ", "") in squeezed
        assert ("HOLD" in page) == bool(step.hold)
        # Line ends and ligatures may fall into a sentence; its first words tell that it is there.
        assert all(" ".join(line.split()[:2]) in page for line in step.instructions)


def test_the_list_of_steps_names_every_step(plan: Plan, pages: list[str]) -> None:
    listing = " ".join(pages[:FIRST_PAGES])
    assert all(f"{step.number} {step.title}" in listing for step in plan.steps)


def test_the_cover_counts_the_parts_of_the_vault(pages: list[str], gridshell: Gridshell) -> None:
    beams = sum(len(shell.beams) for shell in gridshell.shells)
    assert f"coupled beams {beams}" in pages[0]
    assert f"planks {sum(len(shell.planks) for shell in gridshell.shells)}" in pages[0]
    assert gridshell.title in pages[0]


def test_pages_are_a4_one_a_step_for_a_single_shell_too(one_shell: Gridshell) -> None:
    plan = plan_of(one_shell, 4, 25.0)
    reader = PdfReader(BytesIO(sequence_pdf(plan, one_shell)))
    assert len(reader.pages) == FIRST_PAGES + len(plan.steps)
    feet = next(step for step in plan.steps if step.phase == "feet")
    words = " ".join(reader.pages[FIRST_PAGES + feet.number - 1].extract_text().split())
    assert "Set out the feet of the vault" in words
    for page in reader.pages:
        # 210 x 297 mm in points, to the rounding of the writer.
        assert float(page.mediabox.width) == pytest.approx(595.28, abs=0.01)
        assert float(page.mediabox.height) == pytest.approx(841.89, abs=0.01)


def test_the_same_plan_gives_the_same_bytes_without_a_date(one_shell: Gridshell) -> None:
    plan = plan_of(one_shell, 4, 25.0)
    pdf = sequence_pdf(plan, one_shell)
    assert pdf == sequence_pdf(plan, one_shell)
    metadata = PdfReader(BytesIO(pdf)).metadata
    assert metadata is not None
    assert metadata.creation_date is None
    assert not re.search(rb"(CreationDate|ModDate|CreateDate)", pdf)


def test_fasteners_are_counted_by_size_with_their_joints(plan: Plan, gridshell: Gridshell) -> None:
    parts: dict[str, Part] = {bolt.mark: bolt for shell in gridshell.shells for bolt in shell.bolts}
    marks = tuple(f"S1-N-{i:03d}-B{j}" for i in (1, 2, 3) for j in (1, 2, 3, 4))
    bolt = gridshell.shells[0].bolts[0]
    assert part_rows(parts, marks) == [
        ["12", f"Bolt M{bolt.diameter:g} x {bolt.length:g}", "at N-001 to N-003, 4 each"]
    ]


def test_steel_and_concrete_are_listed_by_make_with_their_marks(plan: Plan, gridshell: Gridshell) -> None:
    """One line a make: straps of all lengths in one; rods at their blocks, shoes and blocks by their own marks."""
    parts = {part.mark: part for part in all_parts(gridshell)}
    steps = {step.id: step for step in plan.steps}

    def rows(step: str, shell: str) -> dict[str, tuple[str, str]]:
        marks = tuple(mark for mark in steps[step].marks if mark.startswith(shell))
        return {name: (count, where) for count, name, where in part_rows(parts, marks)}

    feet = rows("site.feet", "S1")
    assert feet["Concrete block 400 x 380 x 300"] == ("14", "C-01 to C-14")
    assert feet["Shoe 90 x 6"] == ("14", "F-01 to F-14")
    (rod,) = (row for name, row in feet.items() if name.startswith("Threaded rod M16"))
    assert rod == ("14", "at C-01 to C-14")
    assert rows("site.stand.S1", "S1")["Bolt M8 x 40"] == ("56", "at F-01 to F-14, 4 each")
    assert rows("S1.edge.upper", "S1")["Strap 50 x 3"] == ("15", "R-01 to R-15")
    ridge = rows("site.ridge.S1.S2", "R12")
    assert ridge == {
        "Ridge blade 100 x 5": ("7", "R12-01 to R12-07"),
        "Bolt M8 x 40": ("28", "at R12-01 to R12-07, 4 each"),
    }


def test_the_cover_is_listed_by_make_whatever_the_lengths(plan: Plan, gridshell: Gridshell) -> None:
    """One line each for strips, mullions and clamping bars; screws by the side that they are driven from."""
    parts = {part.mark: part for part in all_parts(gridshell)}
    step = next(step for step in plan.steps if step.id == "site.cover.S1")
    card = step_card(gridshell, plan, step, parts, piece_weights(gridshell))
    rows = {name: (count, where) for count, name, where in card["parts"]}
    assert rows["Strip 10 thick"] == ("13", "P-01 to P-13")
    assert rows["Mullion 50 x 3"] == ("14", "M-01 to M-14")
    assert rows["Clamping bar 50 x 2"] == ("14", "D-01 to D-14")
    joints = [joint.mark for joint in gridshell.shells[0].joints if joint.kind == "cover"]
    outside = [count for name, (count, _) in rows.items() if name.startswith("Screw") and name.endswith("outside")]
    assert outside == [str(len(joints))]


def test_the_table_of_the_feet_sets_out_the_concrete_blocks(plan: Plan, gridshell: Gridshell) -> None:
    """Its x and y are those of the middle of each block, where the rod stands, and not of the timber beside it."""
    step = next(step for step in plan.steps if step.phase == "feet")
    table = step_table(gridshell, plan, step, piece_weights(gridshell))
    assert table is not None
    rows = {mark: (float(x), float(y)) for mark, x, y in table["rows"]}
    assert len(rows) == 42
    for shell in gridshell.shells:
        turn = frame_matrix(shell.placement)[:3, :3]
        for rod in shell.rods:
            place = turn @ np.array(rod.frame.origin)
            assert rows[rod.mark.rpartition("-")[0]] == pytest.approx(place[:2], abs=0.51)


def test_the_parts_of_a_card_add_up_to_its_step(plan: Plan, gridshell: Gridshell) -> None:
    weights = piece_weights(gridshell)
    parts = {part.mark: part for part in all_parts(gridshell)}
    for step in plan.steps:
        card = step_card(gridshell, plan, step, parts, weights)
        if card["parts"]:
            assert sum(int(row[0]) for row in card["parts"]) == len(step.marks)


def test_the_totals_count_each_part_once(gridshell: Gridshell) -> None:
    table = totals(gridshell, piece_weights(gridshell))
    *kinds, whole = table["rows"]
    assert sum(int(row[1]) for row in kinds) == int(whole[1])
    assert sum(int(row[2]) for row in kinds) == int(whole[2])
    assert int(whole[2]) == len(all_parts(gridshell))


def test_a_folder_in_the_way_is_an_error_and_nothing_is_left_behind(one_shell: Gridshell, tmp_path: Path) -> None:
    target = tmp_path / "sequence.pdf"
    target.mkdir()
    (target / "kept.txt").write_text("kept", encoding="utf-8")
    with pytest.raises(FileError, match=r"sequence\.pdf"):
        write_sequence(plan_of(one_shell, 4, 25.0), one_shell, target)
    assert [path.name for path in tmp_path.iterdir()] == ["sequence.pdf"]
    assert (target / "kept.txt").read_text(encoding="utf-8") == "kept"
