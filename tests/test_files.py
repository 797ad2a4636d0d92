"""A file appears whole or not at all, and a refusal names the path and the remedy."""

import os
from pathlib import Path

import pytest

from aag_cad.errors import FileError
from aag_cad.files import replacing, write_bytes, write_text


def test_text_is_written_as_utf8_with_its_own_line_ends(tmp_path: Path) -> None:
    write_text(tmp_path / "list.csv", "mark,name\nS1,Löwe\n")
    assert (tmp_path / "list.csv").read_bytes() == b"mark,name\nS1,L\xc3\xb6we\n"


def test_missing_folders_are_made_and_nothing_else_stays_behind(tmp_path: Path) -> None:
    write_bytes(tmp_path / "tables" / "inner" / "parts.bin", b"\x00\x01")
    assert [path.name for path in (tmp_path / "tables" / "inner").iterdir()] == ["parts.bin"]


def test_the_draft_keeps_the_name_and_lies_on_the_same_file_system(tmp_path: Path) -> None:
    with replacing(tmp_path / "vault.ifc") as draft:
        assert draft.name == "vault.ifc"
        assert os.stat(draft.parent).st_dev == os.stat(tmp_path).st_dev
        draft.write_text("x")


def test_a_file_that_fails_half_way_leaves_the_old_one_untouched(tmp_path: Path) -> None:
    path = tmp_path / "vault.ifc"
    write_text(path, "old")

    def write_half() -> None:
        with replacing(path) as draft:
            draft.write_text("half of the n")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        write_half()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_new_file_is_as_readable_as_any_other(tmp_path: Path) -> None:
    write_text(tmp_path / "ours", "")
    (tmp_path / "plain").touch()
    assert os.stat(tmp_path / "ours").st_mode == os.stat(tmp_path / "plain").st_mode


def test_a_folder_that_is_a_file_is_refused_with_the_path_and_a_remedy(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("")
    with pytest.raises(FileError, match=r"out/parts\.csv: cannot be written .*; choose a folder"):
        write_text(tmp_path / "out" / "parts.csv", "")


def test_a_folder_of_the_same_name_is_refused_and_kept(tmp_path: Path) -> None:
    (tmp_path / "parts.csv" / "kept").mkdir(parents=True)
    with pytest.raises(FileError, match=r"parts\.csv: cannot be written"):
        write_text(tmp_path / "parts.csv", "text")
    assert (tmp_path / "parts.csv" / "kept").is_dir()
    assert len(list(tmp_path.iterdir())) == 1


def test_a_block_that_wrote_nothing_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"empty\.txt: cannot be written"), replacing(tmp_path / "empty.txt"):
        pass


def test_an_error_that_already_names_its_file_passes_unchanged(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"^other$"), replacing(tmp_path / "a.txt"):
        raise FileError("other")
