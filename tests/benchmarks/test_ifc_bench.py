"""How long the whole vault takes to write as IFC and GLB."""

from pathlib import Path

from pytest_benchmark.fixture import BenchmarkFixture

from aag_cad.export.gltf import write_glb
from aag_cad.export.ifc import write_ifc
from aag_cad.parts.model import Gridshell


def test_write_three_shells_with_every_bolt_as_ifc(
    benchmark: BenchmarkFixture, gridshell: Gridshell, tmp_path: Path
) -> None:
    benchmark(write_ifc, gridshell, tmp_path / "vault.ifc")
    assert 1e6 < (tmp_path / "vault.ifc").stat().st_size < 8e6


def test_write_three_shells_with_every_bolt_as_glb(
    benchmark: BenchmarkFixture, gridshell: Gridshell, tmp_path: Path
) -> None:
    benchmark(write_glb, gridshell, tmp_path / "vault.glb")
    assert 1e5 < (tmp_path / "vault.glb").stat().st_size < 2e6
