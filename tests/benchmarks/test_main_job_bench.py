"""How long the model takes, and the main job from a cold start with its memory."""

import resource
import subprocess
import sys
from pathlib import Path

from pytest_benchmark.fixture import BenchmarkFixture

from aag_cad.audit import audit
from aag_cad.design import Design
from aag_cad.parts.model import Gridshell
from aag_cad.pipeline import gridshell_of
from aag_cad.shop.purchases import purchases_of


def test_gridshell_of_the_vault(benchmark: BenchmarkFixture, design: Design) -> None:
    assert benchmark(gridshell_of, design).shells


def test_audit_of_the_vault(benchmark: BenchmarkFixture, design: Design, gridshell: Gridshell) -> None:
    assert benchmark.pedantic(audit, (design, gridshell, purchases_of(gridshell, design)), rounds=2)


def test_build_of_the_vault_from_a_cold_start(benchmark: BenchmarkFixture, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "aag_cad", "build", "vault", "-o", str(tmp_path / "out"), "--json"]
    benchmark.pedantic(subprocess.run, (command,), {"check": True, "capture_output": True}, rounds=1)
    peak_mb = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    benchmark.extra_info["peak_mb"] = round(peak_mb)
    assert peak_mb < 2000
