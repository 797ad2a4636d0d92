"""Rhino 3dm: the centre line of every plank as a NURBS curve under its mark, one layer for each family."""

import base64
import importlib
import os
import struct
import uuid
import zlib
from typing import Any

from aag_cad.colours import srgb
from aag_cad.errors import FileError
from aag_cad.families import FAMILIES
from aag_cad.files import write_bytes
from aag_cad.parts.mesh import frame_matrix, moved
from aag_cad.parts.model import FlatBar, Gridshell
from aag_cad.units import Floats

_NAMESPACE = uuid.uuid5(uuid.NAMESPACE_DNS, "aag-toolkit rhino")
# The chunk of an openNURBS archive that holds who made it and when: typecode, then length, then what it holds.
_REVISION_HISTORY = struct.pack("<I", 0x20008021)
# A C struct tm for 1 January 2000, midnight: seconds, minutes, hours, day, month, years since 1900, weekday, yearday.
_NO_CLOCK = struct.pack("<8i", 0, 0, 0, 1, 0, 100, 6, 0)


def write_3dm(gridshell: Gridshell, path: str | os.PathLike[str]) -> None:
    """Write the planks' centre lines for Rhino, in mm, as the quintic B-splines that they are in the model.

    Layers are the families A1, A2, G and E; objects are named by mark and carry ``mark``, ``beam`` and ``length_mm`` as
    user text. Equal models give equal bytes. FileError if rhino3dm is not installed or the file cannot be written.
    """
    try:
        # The stubs that rhino3dm brings contradict it: they call writable properties read-only and miss methods.
        rhino: Any = importlib.import_module("rhino3dm")
    except ImportError as error:
        raise FileError(
            f"{path}: Rhino files need rhino3dm, which is not installed; run: pip install 'aag-toolkit[rhino]'"
        ) from error
    archive = rhino.File3dm()
    archive.Settings.ModelUnitSystem = rhino.UnitSystem.Millimeters
    archive.Settings.ModelAbsoluteTolerance = 0.001
    layers = {}
    for family, row in FAMILIES.items():
        layer = rhino.Layer()
        layer.Name, layer.Color = family, (*(round(255.0 * value) for value in srgb(row.colour)), 255)
        layer.Id = uuid.uuid5(_NAMESPACE, f"{gridshell.name} layer {family}")
        layers[family] = archive.Layers.Add(layer)
    for shell in gridshell.shells:
        for plank in sorted(shell.planks, key=lambda plank: plank.mark):
            attributes = rhino.ObjectAttributes()
            attributes.Name, attributes.LayerIndex = plank.mark, layers[plank.family]
            attributes.Id = uuid.uuid5(_NAMESPACE, f"{gridshell.name} {plank.mark}")
            for key, text in _user_text(plank).items():
                attributes.SetUserString(key, text)
            archive.Objects.AddCurve(_nurbs(rhino, plank, frame_matrix(shell.placement)), attributes)
    # Encoding in memory leaves the path out, which the library's own writer prints into the file.
    write_bytes(path, _without_clock(base64.b64decode(archive.Encode())))


def _user_text(plank: FlatBar) -> dict[str, str]:
    texts = {"mark": plank.mark, "length_mm": f"{plank.blank.length:.3f}"}
    return {**texts, "beam": plank.beam} if plank.beam else texts


def _nurbs(rhino: Any, plank: FlatBar, placement: Floats) -> Any:
    """Return a plank's centre line, moved by a (4, 4) matrix, by arc length in mm."""
    spline = plank.curve.point_spline
    points = moved(spline.c, placement)
    curve = rhino.NurbsCurve(spline.k, len(points))
    for i, (x, y, z) in enumerate(points.tolist()):
        curve.Points[i] = rhino.Point4d(x, y, z, 1.0)
    # openNURBS leaves out the first and the last knot, which bear on no point of the curve.
    for i, knot in enumerate(spline.t[1:-1].tolist()):
        curve.Knots[i] = knot
    return curve


def _without_clock(data: bytes) -> bytes:
    """Return an archive with a fixed day in place of the times of writing, and the check sum mended."""
    start = data.index(_REVISION_HISTORY) + len(_REVISION_HISTORY)
    (length,) = struct.unpack_from("<Q", data, start)
    start += 8
    chunk = bytearray(data[start : start + length - 4])
    at = 1
    for _ in range(2):
        # Each time follows a name in UTF-16 that its count of characters stands before.
        (characters,) = struct.unpack_from("<I", chunk, at)
        at += 4 + 2 * characters
        chunk[at : at + len(_NO_CLOCK)] = _NO_CLOCK
        at += len(_NO_CLOCK)
    return data[:start] + bytes(chunk) + struct.pack("<I", zlib.crc32(chunk)) + data[start + length :]
