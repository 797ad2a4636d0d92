"""Webs as ``web.npz``: the vertices as NumPy reads them, bit for bit, and equal bytes for equal webs."""

import io
import zipfile
import zlib

import numpy as np

from aag_cad.errors import FileError
from aag_cad.web.web import Web

SCHEMA_VERSION = 1
_LARGEST_BYTES = 100_000_000
# The ZIP format's first day stands in for a clock.
_NO_CLOCK = (1980, 1, 1, 0, 0, 0)


def web_npz(web: Web) -> bytes:
    """Return a web as an NPZ archive: ``vertices`` (rows, columns, 3) float64, mm, columns geodesic, and ``schema``."""
    stream = io.BytesIO()
    arrays = {"schema": np.array(SCHEMA_VERSION, dtype="<i8"), "vertices": web.vertices.astype("<f8")}
    with zipfile.ZipFile(stream, "w") as archive:
        for name, array in arrays.items():
            member = io.BytesIO()
            np.lib.format.write_array(member, np.asarray(array, order="C"), version=(1, 0), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy", _NO_CLOCK), member.getvalue())
    return stream.getvalue()


def _array(archive: zipfile.ZipFile, name: str) -> "np.ndarray[tuple[int, ...], np.dtype[np.generic]]":
    if f"{name}.npy" not in archive.namelist():
        held = ", ".join(archive.namelist())[:80] or "nothing"
        raise FileError(
            f"web.npz: no array {name!r} (it holds {held}); save it with numpy.savez(vertices=..., schema=1)"
        )
    size = archive.getinfo(f"{name}.npy").file_size
    if size > _LARGEST_BYTES:
        raise FileError(
            f"web.npz: {name!r} takes {size / 1e6:.0f} MB, over {_LARGEST_BYTES / 1e6:.0f} MB; coarsen the web"
        )
    try:
        return np.lib.format.read_array(io.BytesIO(archive.read(f"{name}.npy")), allow_pickle=False)
    except (ValueError, zipfile.BadZipFile, zlib.error) as error:
        raise FileError(f"web.npz: {name!r} cannot be read ({error}); save it again as plain numbers") from error


def read_web_npz(data: bytes) -> Web:
    """Return the web of an NPZ archive; FileError with what is wrong in it."""
    try:
        archive = zipfile.ZipFile(io.BytesIO(data))
    except zipfile.BadZipFile as error:
        raise FileError(f"web.npz: not an NPZ archive ({len(data)} bytes); save it with numpy.savez") from error
    with archive:
        version, vertices = _array(archive, "schema"), _array(archive, "vertices")
    if version.shape != () or version.item() != SCHEMA_VERSION:
        raise FileError(
            f"web.npz: schema {version.tolist()!r}, this program reads {SCHEMA_VERSION}; write the web again"
        )
    if vertices.ndim != 3 or vertices.shape[2] != 3 or min(vertices.shape[:2]) < 3:
        raise FileError(f"web.npz: vertices of shape {vertices.shape}; expected (rows, columns, 3) with 3 x 3 or more")
    if vertices.dtype.kind not in "fiu":
        raise FileError(f"web.npz: vertices of type {vertices.dtype}; expected numbers in mm")
    numbers = np.ascontiguousarray(vertices, dtype=np.float64)
    wrong = np.argwhere(~np.isfinite(numbers).all(axis=2))
    if len(wrong):
        row, column = wrong[0].tolist()
        raise FileError(f"web.npz: the vertex in row {row}, column {column} is not finite, {len(wrong)} such in all")
    return Web(numbers)
