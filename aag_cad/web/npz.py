"""Webs as ``web.npz``: the vertices as NumPy reads them, bit for bit, and equal bytes for equal webs."""

import io

import numpy as np

from aag_cad.web.web import Web

SCHEMA_VERSION = 1


def web_npz(web: Web) -> bytes:
    """Return a web as an NPZ archive: ``vertices`` (rows, columns, 3) float64, mm, columns geodesic, and ``schema``."""
    stream = io.BytesIO()
    np.savez(stream, schema=np.array(SCHEMA_VERSION, dtype="<i8"), vertices=web.vertices.astype("<f8", order="C"))
    return stream.getvalue()
