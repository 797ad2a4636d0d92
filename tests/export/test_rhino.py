"""The 3dm file, read back with rhino3dm, holds each plank's centre line on the layer of its family under its mark."""

import hashlib
import sys
import uuid
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm

from aag_cad.colours import srgb
from aag_cad.errors import FileError
from aag_cad.export.cad.rhino import write_3dm
from aag_cad.families import FAMILIES
from aag_cad.parts.mesh import frame_matrix
from aag_cad.parts.model import Gridshell


@pytest.fixture(scope="module")
def path(gridshell: Gridshell, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("rhino") / "vault.3dm"
    write_3dm(gridshell, path)
    return path


@pytest.fixture(scope="module")
def archive(path: Path) -> Any:
    return rhino3dm.File3dm.Read(str(path))


def test_every_plank_is_a_valid_curve_under_its_mark_on_the_layer_of_its_family(
    gridshell: Gridshell, archive: Any
) -> None:
    layers = [layer.Name for layer in archive.Layers]
    assert layers == list(FAMILIES)
    assert [layer.Color[:3] for layer in archive.Layers] == [
        tuple(round(255.0 * value) for value in srgb(row.colour)) for row in FAMILIES.values()
    ]
    found = {item.Attributes.Name: layers[item.Attributes.LayerIndex] for item in archive.Objects}
    assert found == {plank.mark: plank.family for shell in gridshell.shells for plank in shell.planks}
    assert len(archive.Objects) == len(found)
    assert all(item.Geometry.IsValid for item in archive.Objects)


def test_the_file_is_in_millimetres(archive: Any) -> None:
    assert archive.Settings.ModelUnitSystem == rhino3dm.UnitSystem.Millimeters


def test_the_curves_are_those_of_the_planks_in_the_vault(gridshell: Gridshell, archive: Any) -> None:
    """The same quintic spline by the same arc length: equal to rounding, 1e-6 mm."""
    curves = {item.Attributes.Name: item.Geometry for item in archive.Objects}
    for shell in gridshell.shells:
        placement = frame_matrix(shell.placement)
        for plank in shell.planks:
            curve = curves[plank.mark]
            assert curve.Degree == 5
            assert pytest.approx((0.0, plank.blank.length), abs=1e-9) == (curve.Domain.T0, curve.Domain.T1)
            stations = np.linspace(0.0, plank.curve.length, 7)
            points = plank.curve.point_spline(stations) @ placement[:3, :3].T + placement[:3, 3]
            found = [[p.X, p.Y, p.Z] for p in (curve.PointAt(s) for s in stations)]
            np.testing.assert_allclose(found, points, rtol=0.0, atol=1e-6)


def test_user_text_says_beam_and_length(gridshell: Gridshell, archive: Any) -> None:
    texts = {item.Attributes.Name: dict(item.Attributes.GetUserStrings()) for item in archive.Objects}
    for plank in gridshell.shells[0].planks:
        assert texts[plank.mark]["mark"] == plank.mark
        assert texts[plank.mark].get("beam", "") == plank.beam
        assert float(texts[plank.mark]["length_mm"]) == pytest.approx(plank.blank.length, abs=1e-3)


def test_the_same_model_gives_the_same_bytes_whatever_the_day_and_the_folder(
    gridshell: Gridshell, path: Path, archive: Any, tmp_path: Path
) -> None:
    write_3dm(gridshell, tmp_path / "elsewhere" / "another.3dm")
    digests = [hashlib.sha256(p.read_bytes()).hexdigest() for p in (path, tmp_path / "elsewhere" / "another.3dm")]
    assert digests[0] == digests[1]
    assert {when.year for when in (archive.Created, archive.LastEdited)} == {2000}


def test_each_object_keeps_its_identity(archive: Any) -> None:
    identities = [item.Attributes.Id for item in archive.Objects]
    assert len(set(identities)) == len(identities)
    assert {uuid.UUID(str(identity)).version for identity in identities} == {5}


def test_without_rhino3dm_the_error_says_how_to_get_it(
    gridshell: Gridshell, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """None in the table of modules is how Python marks a module that cannot be imported."""
    monkeypatch.setitem(sys.modules, "rhino3dm", None)
    with pytest.raises(FileError, match=r"pip install 'aag-toolkit\[rhino\]'"):
        write_3dm(gridshell, tmp_path / "vault.3dm")
    assert list(tmp_path.iterdir()) == []
