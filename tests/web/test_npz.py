"""``web.npz`` holds a web bit for bit, and says what is wrong where it does not."""

import io
import zipfile
from typing import Any

import numpy as np
import pytest

from aag_cad.errors import FileError
from aag_cad.units import Floats
from aag_cad.web.npz import read_web_npz, web_npz
from aag_cad.web.web import Web, crpc_web


def web() -> Web:
    return crpc_web(5100.0, 3.0, -8823.0, np.linspace(-0.3, 0.3, 5), 1, 4)


def saved(**arrays: Any) -> bytes:
    """Return an archive as NumPy itself writes it."""
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    return stream.getvalue()


def with_vertex(row: int, column: int, value: float) -> Floats:
    vertices = web().vertices.copy()
    vertices[row, column, 1] = value
    return vertices


def test_a_web_comes_back_bit_for_bit() -> None:
    assert np.array_equal(read_web_npz(web_npz(web())).vertices, web().vertices)


def test_numpy_reads_the_vertices() -> None:
    with np.load(io.BytesIO(web_npz(web())), allow_pickle=False) as archive:
        assert sorted(archive) == ["schema", "vertices"]
        assert np.array_equal(archive["vertices"], web().vertices)


def test_equal_webs_give_equal_bytes_without_a_clock() -> None:
    transposed = Web(np.asfortranarray(web().vertices))
    assert web_npz(web()) == web_npz(transposed)
    with zipfile.ZipFile(io.BytesIO(web_npz(web()))) as archive:
        assert {member.date_time for member in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}


def test_what_numpy_saves_is_read() -> None:
    assert np.array_equal(read_web_npz(saved(schema=1, vertices=web().vertices)).vertices, web().vertices)


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"", r"not an NPZ archive \(0 bytes\)"),
        (b"solid web", r"not an NPZ archive"),
        (web_npz(web())[:-40], r"not an NPZ archive"),
        (saved(schema=1), r"no array 'vertices' \(it holds schema\.npy\)"),
        (saved(vertices=web().vertices), r"no array 'schema'"),
        (saved(schema=7, vertices=web().vertices), r"schema 7, this program reads 1"),
        (saved(schema=1, vertices=web().vertices[:, :, :2]), r"shape \(6, 5, 2\); expected \(rows, columns, 3\)"),
        (saved(schema=1, vertices=web().vertices[:2]), r"shape \(2, 5, 3\)"),
        (saved(schema=1, vertices=with_vertex(2, 3, np.nan)), r"row 2, column 3 is not finite, 1 such"),
        (saved(schema=1, vertices=np.full((3, 3, 3), "x")), r"of type <U1; expected numbers"),
        (saved(schema=1, vertices=np.full((3, 3, 3), None)), r"'vertices' cannot be read .*plain numbers"),
        (saved(schema=1, vertices=np.zeros((3000, 3000, 3))), r"takes 216 MB, over 100 MB"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_another_file_is_refused_with_its_reason(data: bytes, reason: str) -> None:
    with pytest.raises(FileError, match=reason):
        read_web_npz(data)
