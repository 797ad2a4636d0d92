"""``web.npz`` holds a web bit for bit, as NumPy reads it."""

import io
import zipfile

import numpy as np

from aag_cad.web.npz import web_npz
from aag_cad.web.web import Web, crpc_web


def web() -> Web:
    return crpc_web(5100.0, 3.0, -8823.0, np.linspace(-0.3, 0.3, 5), 1, 4)


def test_numpy_reads_the_vertices_bit_for_bit() -> None:
    with np.load(io.BytesIO(web_npz(web())), allow_pickle=False) as archive:
        assert sorted(archive) == ["schema", "vertices"]
        assert archive["schema"] == 1
        assert np.array_equal(archive["vertices"], web().vertices)


def test_equal_webs_give_equal_bytes_without_a_clock() -> None:
    transposed = Web(np.asfortranarray(web().vertices))
    assert web_npz(web()) == web_npz(transposed)
    with zipfile.ZipFile(io.BytesIO(web_npz(web()))) as archive:
        assert {member.date_time for member in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
