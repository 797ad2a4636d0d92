"""A vault whose start is not CRPC: optimised, then built like any other; and meshes from other programs."""

import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from builds import aag, small_vault

from aag_cad.audit import audit
from aag_cad.design import design_text, load_design, parse_design
from aag_cad.errors import DesignError, FileError
from aag_cad.geometry.framed import curvatures_at
from aag_cad.network.build import shell_network
from aag_cad.network.edges import top_coordinate
from aag_cad.network.model import CurveNetwork
from aag_cad.network.polylines import polylines_json
from aag_cad.parts.build import gridshell_from
from aag_cad.pipeline import chart_of, optimised_design, optimised_mesh, web_of, worked_surface, write_optimised
from aag_cad.shop.purchases import purchases_of
from aag_cad.web.goals import Goals
from aag_cad.web.obj import read_web_obj, web_obj
from aag_cad.web.optimise import optimise
from aag_cad.web.quality import quality
from aag_cad.web.web import crpc_web


def _aag(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "aag_cad", *arguments]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, check=False)


def test_the_optimised_vault_has_60_degree_nodes_its_height_and_buildable_parts() -> None:
    """Paper section 2.2 on a meridian of one radius: 22 beams a shell, no error finding, crown at 3.7 m."""
    design = load_design("vault-optimised")
    before = quality(web_of(design, chart_of(design)))
    assert before.angle_aa_deg.max - before.angle_aa_deg.min > 30.0
    chart, web = worked_surface(design)
    after = quality(web).angle_aa_deg
    assert (after.min, after.max) == pytest.approx((60.0, 60.0), abs=1e-5)
    crown = top_coordinate(design, chart, 0.0)
    point = chart.jet(np.array([crown]), np.zeros(1)).point[0]
    np.testing.assert_allclose(point, (0.0, 0.0, 3700.0), atol=0.01)
    network = shell_network(design, chart)
    for item in network.curves:
        curvatures = curvatures_at(item.curve, np.linspace(item.start, item.end, 100))
        stray = curvatures.normal if item.id.family in ("A1", "A2") else curvatures.geodesic
        # The web has about 1 600 vertices: the interpolated surface follows it to about 1e-4 1/m.
        assert np.abs(stray).max() < 2e-7
    gridshell = gridshell_from(design, network)
    assert len(gridshell.shells[0].beams) == 22
    assert [f.text for f in audit(design, gridshell, purchases_of(gridshell, design)) if f.severity == "error"] == []


def test_goals_out_of_reach_are_refused_with_the_reason() -> None:
    text, source = design_text("vault-optimised"), "vault-optimised"
    stiff = parse_design(text.replace("cells = 2 ", "closeness = 1.0\ncells = 2 "), source)
    with pytest.raises(DesignError, match=r"optimise: (stalled|left the design's range): "):
        worked_surface(stiff)


def test_a_design_without_the_table_and_one_that_cannot_be_optimised_are_said_so() -> None:
    with pytest.raises(DesignError, match=r"no table \[optimise\]"):
        optimised_design(load_design("vault"))
    text, source = design_text("column"), "column"
    with pytest.raises(DesignError, match=r"optimise: only shells with shells\.top"):
        parse_design(text + "\n[optimise]\ncells = 2\n", source)


def test_a_mesh_from_another_program_is_optimised_and_written_back(tmp_path: Path) -> None:
    theta = np.radians(30.0) * np.linspace(-1.0, 1.0, 21)
    exact = crpc_web(5100.0, 3.0, -8823.0, theta, 1, 19)
    shaken = exact.vertices + 5.0 * np.sin(np.arange(exact.vertices.size)).reshape(exact.vertices.shape)
    path = tmp_path / "mesh.obj"
    path.write_text(web_obj(type(exact)(shaken)), encoding="utf-8")
    run = _aag(
        "optimise", "mesh.obj", "--node-angle", "60", "--bottom-row", "1", "--no-symmetric", "--json", cwd=tmp_path
    )
    assert run.returncode == 0, run.stderr
    assert json.loads(run.stdout)["reason"] == "converged"
    found = read_web_obj((tmp_path / "mesh-web" / "web.obj").read_text(encoding="utf-8"), "web.obj")
    assert quality(found).planarity_per_edge < 1e-7
    assert found.vertices.shape == (20, 21, 3), "the ghost row under the bottom curve is removed"
    assert np.abs(found.vertices[0, :, 2]).max() < 1e-4
    assert (tmp_path / "mesh-web" / "optimise.html").read_text(encoding="utf-8").count("<svg") >= 5


def test_a_mesh_that_is_missing_or_no_grid_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"missing\.obj: cannot be read"):
        optimised_mesh(str(tmp_path / "missing.obj"), Goals(angle=None))
    (tmp_path / "triangle.obj").write_text("v 0 0 0\nv 1000 0 0\nv 0 1000 0\nf 1 2 3\n")
    run = aag("optimise", "triangle.obj", cwd=tmp_path)
    assert run.exit_code == 2
    assert not (tmp_path / "triangle-web").exists()


def test_an_angle_out_of_range_is_refused(tmp_path: Path) -> None:
    run = aag("optimise", "mesh.obj", "--node-angle", "200", cwd=tmp_path)
    assert run.exit_code == 2
    assert "--node-angle: 200" in run.stderr


def test_the_files_of_an_optimised_web_are_the_same_bytes_twice(tmp_path: Path) -> None:
    theta = np.radians(30.0) * np.linspace(-1.0, 1.0, 21)
    web = crpc_web(5100.0, 3.0, -8823.0, theta, 1, 19)
    goals = Goals(angle=math.radians(120.0), bottom_row=1, height=float(web.vertices[-1, 10, 2]) + 100.0)
    found = optimise(web, goals)
    write_optimised(found, goals, tmp_path / "a")
    write_optimised(optimise(web, goals), goals, tmp_path / "b")
    for name in ("web.obj", "web.npz", "optimise.html"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_what_other_programs_read_is_written_if_it_is_asked_for(tmp_path: Path) -> None:
    (tmp_path / "small.toml").write_text(small_vault(cover=False), encoding="utf-8")
    out = _aag("build", "small.toml", "-o", "a", "--only", "curves,web,rhino", cwd=tmp_path)
    assert out.returncode == 0, out.stderr
    names = {path.name for path in (tmp_path / "a").iterdir()}
    assert names == {"curves.json", "curves.step", "web.obj", "web.npz", "vault.3dm", "summary.json"}


def test_curves_go_out_to_other_programs_and_come_back_as_the_same_planks(
    network: CurveNetwork, vault_build: Path, tmp_path: Path
) -> None:
    (tmp_path / "curves.json").write_text(polylines_json(network), encoding="utf-8")
    back = _aag("build", "vault", "-o", "b", "--only", "tables", "--curves", "curves.json", "--json", cwd=tmp_path)
    assert back.returncode == 0, back.stderr
    assert json.loads(back.stdout)["counts"] == json.loads((vault_build / "summary.json").read_text())["counts"]
    holes = [(folder / "tables" / "holes.csv").read_text().splitlines() for folder in (vault_build, tmp_path / "b")]
    stations = [np.array([float(line.split(",")[2]) for line in lines[1:]]) for lines in holes]
    # Printed to 0.1 mm: the last digit may turn over.
    np.testing.assert_allclose(stations[0], stations[1], atol=0.11)


def test_curves_that_cannot_be_read_are_refused(tmp_path: Path) -> None:
    run = aag("build", "vault", "-o", "a", "--curves", "none.json", cwd=tmp_path)
    assert run.exit_code == 2
    assert "none.json: cannot be read" in run.stderr
    assert not (tmp_path / "a").exists()
